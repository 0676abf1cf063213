//! Arguments of questions about many bodies: scenes, robots and simulations.

use super::StartChoice;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
A scene: {\"bodies\": [{\"name\", \"mesh\", \"scale\", \"kind\": \"dynamic\" | \"kinematic\" | \"static\", \"pose\": {\"x\", \"q\"},
\"velocity\": {\"v\", \"w\"}, \"motion\", \"density\" or \"mass\", \"center\", \"inertia\", \"restitution\", \"friction\", \"group\",
\"solid\", \"radius\", \"damping\": {\"linear\", \"angular\"}}], \"ignore\": [[name or group, name or group]], \"pairs\": [{\"a\", \"b\", \"restitution\", \"friction\"}],
\"joints\": [{\"kind\": \"fixed\" | \"revolute\" | \"prismatic\" | \"spherical\", \"a\", \"b\": name or null (the world), \"point\", \"axis\", \"limits\": [lo, hi],
\"motor\": {\"velocity\" or \"position\", \"max\", \"stiffness\", \"damping\"}, \"spring\": {\"stiffness\", \"damping\", \"rest\"}, \"friction\", \"collide\"}],
\"simulation\": {\"gravity\", \"step\", \"end\", \"gap\", \"max_events\", \"sleep\", \"threads\"}}. What is left out: dynamic, at rest at the origin, density 1000, no
restitution, no friction; gravity [0, -9.81, 0], step 0.01, end 5, gap (between bodies that rest on each other) 0.001, max_events
(contact events a step) 128, sleep true. A body with a radius is everything within that distance of its mesh, whose mass it has or that is
given; velocities fade by a factor of exp(-damping) in a unit of time. A kinematic body follows its motion, which has any JSON form of d2m toc; it has no pose and no
velocity besides. Without a motion it rests in its pose. The value of a joint, which its limits, motor and spring are about, is how far b has turned (radians) or moved
against a since the start, about or along the axis; point and axis are given in the world at the start.
A run: a line with the bodies' masses, then a line for each segment, in which every body flies a constant twist about its
center of mass: {\"t0\", \"t1\", \"bodies\" or \"changed\", \"contacts\", \"skipped\", \"wall\"}; skipped is the time for which bodies stood
still because max_events were used up, wall the seconds that it took.
No two bodies ever share a point in a segment. A run that cannot go on ends with exit code 3 and the segments so far.

Exit codes: 0 done, 2 bad usage, 3 bad input or a run that cannot go on.

Example:
  d2m simulate docs/scenes/pile.json --out run.jsonl
  d2m simulate docs/scenes/door.json --out door.jsonl
  d2m view run.jsonl --out run.html")]
pub(crate) struct SimulateArguments {
    /// Scene, JSON
    #[arg(value_name = "SCENE.json")]
    pub(crate) scene: PathBuf,
    /// Run, one JSON object a line; packed by gzip if its name ends in .gz; - for standard output
    #[arg(long, value_name = "RUN.jsonl")]
    pub(crate) out: String,
    /// Only one segment every so much time, for viewing: such a run is small and proves nothing
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) every: Option<String>,
    /// Threads; the run has the same numbers at any number of them [default: as the scene says, or 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A scene: {\"window\": [0, 1], \"bodies\": [{\"name\", \"mesh\", \"scale\", \"radius\", \"motion\", \"group\", \"solid\"}, ...],
\"ignore\": [[\"arm\", \"base\"], ...], \"min_separation\": 0, \"tolerance\": 1e-10, \"start\": \"report\" or \"leave\",
\"pairs\": [{\"a\", \"b\", \"start\", \"min_separation\"}, ...]}. A mesh is a file, relative to the scene's folder, or shape:...;
scale is one number or three; a body is everything within radius of its mesh; a motion has any JSON form of d2m toc, at rest if left out;
solid is whether the mesh is watertight if left out, and what is inside a solid body is in contact with it; ignore lists pairs of names
of bodies or groups; pairs states what two bodies have of their own. With start leave a contact at the start is let go until the bodies
are proven apart (\"left\": [lo, hi]), and the answer is what they meet then; those that never part are in contact from the start.

The answer lists the first contact of each pair, sorted by time; pairs that are proven apart all the time are left out. With --first the
search stops at the first contact of all; contacts whose time brackets overlap its bracket are listed too, and of several at the very
start at least one. Before a bracket nothing of the pair meets: that is proven. The answers are bitwise the same at any number of threads.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated, 12 undecided.

Example:
  d2m scene docs/scenes/robot-arm.json --first")]
pub(crate) struct SceneArguments {
    /// Scene file, JSON
    #[arg(value_name = "SCENE.json")]
    pub(crate) scene: PathBuf,
    /// Stop at the first contact of all
    #[arg(long)]
    pub(crate) first: bool,
    /// What counts of bodies that are in contact at the start, instead of what the file says of the scene (pairs may have their own)
    #[arg(long, value_enum)]
    pub(crate) start: Option<StartChoice>,
    /// Threads [default: all of the machine]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Most seconds of the search, which then runs on one thread; pairs that are not decided by then are "undecided"
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub(crate) time_limit: Option<String>,
    /// With --first: prove the answer again by the independent verifier, pair by pair, and say whether it could
    #[arg(long, requires = "first")]
    pub(crate) verify: bool,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Exit with 10 if there is a contact, 11 if all pairs are separated, 12 if undecided
    #[arg(long)]
    pub(crate) exit_status: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A path is {\"joint_names\": [...], \"points\": [{\"positions\", \"velocities\", \"accelerations\", \"time_from_start\"}, ...], \"interpolation\":
\"linear\", \"cubic\" or \"quintic\"}: a JointTrajectory of ROS, whose times {\"sec\", \"nanosec\"} are read as well as seconds, and whose header is ignored.
Positions are radians, or the robot's unit of length. It is cubic where velocities are given and nothing is said, else linear. Joints that it does not name stay at zero, or in the middle of their limits where zero is outside; joints that mimic others follow. Limits are not enforced: a path that leaves
them gets a warning.

A scene is that of d2m scene: bodies at rest by \"pose\": {\"x\", \"q\"}, or with a motion in the time of the path; with \"attach\": \"link\" a body is
carried by that link, and its pose is in the link's frame.

Checked are all pairs of links that have collision geometry, but those that a joint joins directly and those that the SRDF disables; every link and
attached body against every obstacle; and attached bodies against every link but their own. The answer says how many pairs these are.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 free, 12 undecided.

Example:
  d2m robot arm.urdf --srdf arm.srdf --path path.json --scene cell.json --package arm_description=../arm_description
  d2m robot arm.urdf --path path.json --view path.html")]
pub(crate) struct RobotArguments {
    /// Robot, URDF
    #[arg(value_name = "ROBOT.urdf")]
    pub(crate) robot: PathBuf,
    /// Path of the joints, JSON
    #[arg(long, value_name = "PATH.json")]
    pub(crate) path: PathBuf,
    /// Pairs of links that are not checked, SRDF
    #[arg(long, value_name = "R.srdf")]
    pub(crate) srdf: Option<PathBuf>,
    /// Obstacles and attached bodies, JSON
    #[arg(long, value_name = "SCENE.json")]
    pub(crate) scene: Option<PathBuf>,
    /// Folder of a package: package://NAME/rest is rest in DIR. Packages that are not given are looked for beside the robot
    #[arg(long, value_name = "NAME=DIR")]
    pub(crate) package: Vec<String>,
    /// Distance at which bodies count as in contact; they are proven further apart before
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true)]
    pub(crate) min_separation: Option<String>,
    /// Of a free path, how near it comes to a contact: the least distance of all pairs, less the minimum separation
    #[arg(long)]
    pub(crate) clearance: bool,
    /// Prove the answer again by the independent verifier, pair by pair, and say whether it could
    #[arg(long)]
    pub(crate) verify: bool,
    /// Page of HTML to write that shows the robot on its path and what is proven of it
    #[arg(long, value_name = "view.html")]
    pub(crate) view: Option<String>,
    /// Most seconds of the search; what is not decided by then is "undecided". The search takes time for each turn of a joint
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub(crate) time_limit: Option<String>,
    /// Threads [default: all of the machine]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Exit with 10 if there is a contact, 11 if the path is free, 12 if undecided
    #[arg(long)]
    pub(crate) exit_status: bool,
}
