//! Arguments of questions about two moving meshes.

use super::{QueryArguments, mesh_help};
use crate::failure::Failure;
use crate::motion::parse_motions;
use clap::{Args, ValueEnum};
use d2m::Window;
use d2m::bvh::Start;
use d2m::motion::AnyMotion;

#[derive(Debug, Args)]
#[command(after_help = "\
A motion is x=1,2,3;q=w,x,y,z;v=1,2,3;w=1,2,3[;at=1,2,3][;t=0]: position, orientation, velocity, angular velocity
(radians, or degrees as 90deg, per unit of time, world axes), the body point that x and v belong to, and the time that x and q belong to.
What is left out is zero (q: not turned). rpy=roll,pitch,yaw may stand for q (as in URDF). @FILE reads a JSON form: the same keys, without rpy and with
angles in radians; {\"times\", \"poses\": [{\"x\", \"q\"}, ...], \"join\": \"linear\" or \"screw\"} or {\"times\", \"spans\": [constant twists]} for keyframes, with
\"join\": \"cubic\" or \"quintic\" for a smooth path (and \"twists\" at the poses if known); {\"chain\": [{\"x\", \"q\", \"joint\", \"axis\", \"value\"}, ...]} for a link of an arm, with joint
fixed, revolute or prismatic and value a polynomial [c0, c1, ...] or {\"times\", \"pieces\"}. The window must lie within the times.

The answer is contact, separated or undecided. That nothing meets before the bracket is proven, and so is separated, in
every mode. What is proven of a contact itself is its evidence:
  crossing  the bodies share a point at a time of the bracket
  near      at a time of the bracket their distance is at most --min-separation plus the tolerance
  early     nothing more; there may be no contact at all. The usual case of --mode capoeira, which stops at the first
            triangles that come as close as their own size; rare otherwise
With --min-separation D contact means a distance of at most D: bodies are further apart than D before the bracket. The tolerance is
raised where the rounding of large lengths or times forbids it, and the answer states the one that was used. A bracket has no width
where its end could not be shown (early), and where the bodies meet at the start of the window. undecided holds the time until which the
window is proven free: the budget or the time limit was used up, or, without them, a cap of 2^30 node tests.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated, 12 undecided.

Example:
  d2m toc shape:gear 'shape:torus-knot?triangles=70000' --motion-a 'x=-2,0,0;v=3,0,0;w=0,0,5' --motion-b 'w=0,1,0'")]
pub(crate) struct TocArguments {
    #[command(flatten)]
    pub(crate) pair: PairArguments,
    /// Also write both meshes, posed at the contact, as an OBJ file
    #[arg(long, value_name = "FILE.obj")]
    pub(crate) obj: Option<String>,
    #[command(flatten)]
    pub(crate) further: FurtherArguments,
}

/// Two moving meshes, how they are asked about and how the answer is given: what all questions about them share.
#[derive(Debug, Args)]
pub(crate) struct PairArguments {
    #[arg(value_name = "A", help = mesh_help())]
    pub(crate) a: String,
    #[arg(value_name = "B", help = mesh_help())]
    pub(crate) b: Option<String>,
    #[command(flatten)]
    pub(crate) motions: MotionArguments,
    #[command(flatten)]
    pub(crate) query: QueryArguments,
    /// Prove the answer again by the independent verifier, and say whether it could
    #[arg(long)]
    pub(crate) verify: bool,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Exit with 10 on contact, 11 if separated, 12 if undecided
    #[arg(long)]
    pub(crate) exit_status: bool,
}

/// How two bodies move, and when.
#[derive(Debug, Args)]
pub(crate) struct MotionArguments {
    /// Motion of A; at rest if not given
    #[arg(long, value_name = "M", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) motion_a: String,
    /// Motion of B; at rest if not given
    #[arg(long, value_name = "M", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) motion_b: String,
    /// First and last time [default: 0,1]
    #[arg(long, value_name = "T0,T1", allow_hyphen_values = true)]
    pub(crate) window: Option<String>,
}

impl MotionArguments {
    pub(crate) fn parse(&self) -> Result<(Window, [AnyMotion; 2]), Failure> {
        parse_motions(self.window.as_deref().unwrap_or("0,1"), [&self.motion_a, &self.motion_b])
    }
}

/// Questions besides that of the first contact.
#[derive(Debug, Clone, Copy, Default, Args)]
pub(crate) struct FurtherArguments {
    /// Of bodies that stay apart also state how near they come: "clearance": [lo, hi]
    #[arg(long)]
    pub(crate) clearance: bool,
    /// Bodies in contact at the start: report it, or let it go until they are proven apart ("left": [lo, hi]) and find what they meet then
    /// [default: report]
    #[arg(long, value_enum)]
    pub(crate) start: Option<StartChoice>,
}

impl FurtherArguments {
    pub(crate) fn leaves(self) -> bool {
        self.start == Some(StartChoice::Leave)
    }
}

impl From<StartChoice> for Start {
    fn from(choice: StartChoice) -> Self {
        match choice {
            StartChoice::Report => Self::Report,
            StartChoice::Leave => Self::Leave,
        }
    }
}

/// What counts of bodies that are in contact at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StartChoice {
    /// It is the answer
    Report,
    /// The first contact after they have parted is the answer
    Leave,
}

#[derive(Debug, Args)]
pub(crate) struct SpansArguments {
    #[command(flatten)]
    pub(crate) pair: PairArguments,
    /// Clear times shorter than this may be inside a contact span [default: 1e-6 of the window]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) resolution: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct ClearanceArguments {
    #[command(flatten)]
    pub(crate) pair: PairArguments,
    /// The enclosure is at most this part of the distance wide (or four tolerances)
    #[arg(long, value_name = "R", default_value = "1e-6", allow_hyphen_values = true)]
    pub(crate) accuracy: String,
    /// Of a scene: list all pairs that are not proven to stay at least this far apart
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true)]
    pub(crate) below: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The answer is what d2m toc, d2m clearance or d2m spans printed with --json for the same bodies, motions, window and options. It is proven
again from the meshes and the motions alone, by interval arithmetic that shares nothing with the search.

Exit codes: 0 verified, 20 refuted, with a time and a distance that show it, 21 not proven, with the reason; 2 bad usage, 3 bad input, also an
answer about other bodies or one that contradicts itself.

Example:
  d2m toc shape:gear shape:torus --motion-a 'x=-3,0,0;v=4,0,0' --json > answer.json
  d2m verify shape:gear shape:torus --motion-a 'x=-3,0,0;v=4,0,0' --answer answer.json")]
pub(crate) struct VerifyArguments {
    #[arg(value_name = "A", help = mesh_help())]
    pub(crate) a: String,
    #[arg(value_name = "B", help = mesh_help())]
    pub(crate) b: String,
    /// Answer of d2m toc, d2m clearance or d2m spans with --json; - for standard input
    #[arg(long, value_name = "ANSWER.json")]
    pub(crate) answer: String,
    #[command(flatten)]
    pub(crate) motions: MotionArguments,
    /// What the answer is of: with leave it has to say when the bodies had parted
    #[arg(long, value_enum)]
    pub(crate) start: Option<StartChoice>,
    #[command(flatten)]
    pub(crate) query: QueryArguments,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
