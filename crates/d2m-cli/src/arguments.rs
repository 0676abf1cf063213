//! The command line.

mod at_rest;
mod moving;
mod scenes;

pub(crate) use at_rest::{CollideArguments, DistanceArguments, PosedArguments, ProximitiesArguments};
pub(crate) use moving::{
    ClearanceArguments, FurtherArguments, MotionArguments, PairArguments, SpansArguments, StartChoice,
    TocArguments, VerifyArguments,
};
pub(crate) use scenes::{RobotArguments, SceneArguments, SimulateArguments};

use clap::{Args, Parser, Subcommand, ValueEnum};
use d2m_io::MeshFormat;
use std::path::PathBuf;

/// Certified continuous collision detection: when do two moving rigid bodies first touch?
#[derive(Debug, Parser)]
#[command(name = "d2m", version, about, propagate_version = true, arg_required_else_help = true)]
#[command(
    after_help = "Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated, 12 undecided.

Examples:
  d2m demo
  d2m toc part.stl shape:gear --motion-a 'x=-3,0,0;v=4,0,0;w=0,0,90deg'
  d2m view part.stl shape:gear --motion-a 'x=-3,0,0;v=4,0,0;w=0,0,90deg' --out view.html

d2m toc --help explains motions; d2m completions and d2m man are for the shell."
)]
pub(crate) struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// First time of contact of two moving meshes
    #[command(mut_arg("b", |b| b.required(true)))]
    Toc(TocArguments),
    /// Least distance of two moving meshes, or of all bodies of a scene, over a window, with its time and points
    #[command(mut_arg("a", |a| a.help(MESH_OR_SCENE_HELP)), mut_arg("b", |b| b.help(SECOND_HELP)))]
    #[command(mut_arg("mode", |mode| mode.hide(true)), mut_arg("min_separation", |distance| distance.hide(true)))]
    #[command(after_help = "\
Motions are written as d2m toc --help explains. The least distance over the window is proven to lie within [lo, hi], and hi is attained by the
points at the time that is given; hi - lo is at most max(R * hi, 4 tolerances). Bodies that meet have the clearance [0, 0] and the time of contact.
A budget or time limit that runs out leaves a wider interval that still holds: undecided.

A scene (.json, as for d2m scene) in place of A and B: the pair of bodies that comes nearest, of all that are not ignored; \"a\" and \"b\" name
them. With --below D also all pairs that are not proven to stay at least D apart, by their distances (\"pairs\").

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 clear, 12 undecided.

Examples:
  d2m clearance shape:gear shape:torus --motion-a 'x=-3,0,2.5;v=6,0,0;w=0,0,5'
  d2m clearance docs/scenes/robot-arm.json --below 0.1")]
    Clearance(ClearanceArguments),
    /// Which times of a window are proven clear, and which are in contact, of two meshes or of a scene
    #[command(mut_arg("a", |a| a.help(MESH_OR_SCENE_HELP)), mut_arg("b", |b| b.help(SECOND_HELP)))]
    #[command(mut_arg("mode", |mode| mode.hide(true)))]
    #[command(after_help = "\
Motions are written as d2m toc --help explains. The spans are joined, in order, and cover the window. clear: proven further apart than
--min-separation at every time of the closed span. contact: begins and ends at the window's ends or within the resolution of a time at which the
bodies are proven within --min-separation plus the tolerance; clear times shorter than the resolution may be inside. undecided: neither is proven.

A scene (.json, as for d2m scene) in place of A and B: the spans in which all pairs are clear, and under \"pairs\" those of each pair that is not
clear all the time.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 if some span is contact, 11 if all is clear, 12 otherwise.

Examples:
  d2m spans shape:box shape:box --motion-a 'x=-4,0,0;v=8,0,0'
  d2m spans docs/scenes/conveyor.json")]
    Spans(SpansArguments),
    /// Whether an answer of toc --json can be proven again, independently
    Verify(VerifyArguments),
    /// Many trials of one pair of meshes, from a CSV file to a CSV file
    Batch(BatchArguments),
    /// First contacts of moving points, triangles, edges and spheres, from JSON lines to JSON lines
    Features(FeaturesArguments),
    /// Distance of two bodies at rest, with the closest points
    Distance(DistanceArguments),
    /// Whether two bodies at rest share a point
    Collide(CollideArguments),
    /// All places where two bodies at rest are locally closest, within a margin: their contact manifold
    Proximities(ProximitiesArguments),
    /// Rigid bodies under gravity, contacts and friction, from a scene file to a run file
    Simulate(SimulateArguments),
    /// Contacts of many moving bodies, from a scene file
    Scene(SceneArguments),
    /// Whether a planned path of a robot (URDF) is free of contact, and until when
    Robot(RobotArguments),
    /// What is in a mesh, or which shapes are built in
    Info(InfoArguments),
    /// Saves the search tree of a mesh; the file is a mesh argument like any other
    Tree(TreeArguments),
    /// A page of HTML that shows two moving meshes and their contact, or a scene, or a simulation
    View(ViewArguments),
    /// The main job on built-in shapes: six scenes with their commands and answers
    #[command(after_help = "\
Exit codes: 0 answered.

Example:
  d2m demo")]
    Demo,
    /// What a shell needs to complete this command's words
    Completions(CompletionsArguments),
    /// The manual page of this command, or of one of its subcommands
    Man(ManArguments),
}

#[derive(Debug, Args)]
#[command(after_help = "\
Exit codes: 0 written, 2 bad usage.

Examples:
  d2m completions bash > ~/.local/share/bash-completion/completions/d2m
  d2m completions zsh > \"${fpath[1]}/_d2m\"
  d2m completions fish > ~/.config/fish/completions/d2m.fish")]
pub(crate) struct CompletionsArguments {
    /// Shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Exit codes: 0 written, 2 bad usage, 3 no such subcommand.

Examples:
  d2m man | man -l -
  d2m man toc > /usr/local/share/man/man1/d2m-toc.1")]
pub(crate) struct ManArguments {
    /// Subcommand; the whole command if not given
    #[arg(value_name = "COMMAND")]
    pub(crate) command: Option<String>,
}

const MESH_OR_SCENE_HELP: &str =
    "Mesh, as for d2m toc, or a scene (.json, as for d2m scene) in place of A and B";
const SECOND_HELP: &str = "Second mesh; none beside a scene";

fn mesh_help() -> String {
    let files = MeshFormat::EXTENSIONS;
    format!("Mesh file ({files}), saved tree (.d2mtree) or built-in shape such as shape:gear?triangles=5000")
}

#[derive(Debug, Args)]
#[command(after_help = "\
Trials: 26 numbers a line (a header line is allowed): qA(w,x,y,z), xA, vA, wA, qB(w,x,y,z), xB, vB, wB; time runs over [0, 1]. Or JSON lines
{\"a\": motion, \"b\": motion, \"window\": [t0, t1]} with motions of any form of d2m toc.
Results: trial,status,toc,toc_hi,separation,microseconds,normal_x,normal_y,normal_z,point_x,point_y,point_z,feature,
triangle_a,triangle_b,evidence,tolerance. toc is the certified start of the time bracket (inf: separated; undecided: the window is
proven free until then); the point lies on A; evidence is crossing, near or early and tolerance the one that was used, as
d2m toc --help explains. What an answer does not have is empty. With --start leave two columns left_lo,left_hi follow (when the bodies had
parted; empty where they never did), with --clearance two columns clearance_lo,clearance_hi (of bodies that stay apart).

Exit codes: 0 answered, 2 bad usage, 3 bad input. No results are written unless all trials are answered. With --resume the answers so far stay
in R.csv.part if the run is ended, and the next run with --resume and the same inputs goes on behind them; with --verify it asks those of them
again that it has to prove.

Examples:
  d2m batch A.obj B.obj --trials trials.csv --out results.csv --threads 8
  d2m batch A.obj B.obj --trials trials.jsonl --out results.csv --resume")]
pub(crate) struct BatchArguments {
    #[arg(value_name = "A", help = mesh_help())]
    pub(crate) a: String,
    #[arg(value_name = "B", help = mesh_help())]
    pub(crate) b: String,
    /// Trials, CSV or JSON lines; - for standard input
    #[arg(long, value_name = "T.csv")]
    pub(crate) trials: PathBuf,
    /// Results, CSV; - for standard output
    #[arg(long, value_name = "R.csv")]
    pub(crate) out: String,
    /// Trials that are answered at the same time
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: u16,
    /// Keep the answers of a run that is ended, and go on behind those of an earlier one
    #[arg(long)]
    pub(crate) resume: bool,
    /// Prove this share of the answers again (1: all); an answer that is refuted ends the command with exit code 20
    #[arg(long, value_name = "SHARE", num_args = 0..=1, default_missing_value = "1")]
    pub(crate) verify: Option<String>,
    #[command(flatten)]
    pub(crate) further: FurtherArguments,
    #[command(flatten)]
    pub(crate) query: QueryArguments,
}

#[derive(Debug, Clone, Args)]
pub(crate) struct QueryArguments {
    /// Method; capoeira stops early: what it calls contact may be none
    #[arg(long, value_enum, default_value_t = Method::Accurate)]
    pub(crate) mode: Method,
    /// Distance that counts as contact [default: 1e-10 of the scene's length]
    #[arg(long, value_name = "DELTA", allow_hyphen_values = true)]
    pub(crate) tolerance: Option<String>,
    /// Most node tests of a query; when they are used up the answer is "undecided" [default: a cap of 2^30]
    #[arg(long, value_name = "NODES", value_parser = whole_number, allow_hyphen_values = true)]
    pub(crate) budget: Option<u64>,
    /// Most seconds of a query; when they are used up the answer is "undecided"
    #[arg(long, value_name = "SECONDS", default_value = "60", allow_hyphen_values = true)]
    pub(crate) time_limit: String,
    /// Distance at which bodies count as in contact; they are proven further apart before
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true)]
    pub(crate) min_separation: Option<String>,
    #[command(flatten)]
    pub(crate) solid: SolidArguments,
    #[command(flatten)]
    pub(crate) sizes: SizeArguments,
}

/// The sizes of two meshes.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct SizeArguments {
    /// Scale of A: one number, or three with commas between them
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub(crate) scale_a: Option<String>,
    /// Scale of B
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub(crate) scale_b: Option<String>,
    /// Unit of the numbers of A (mm, cm, m or in), which become meters [default: as the file states, or none]
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit_a: Option<String>,
    /// Unit of the numbers of B
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit_b: Option<String>,
    /// Radius of A: it is everything within this distance of its mesh (a point with a radius is a sphere, a segment a capsule)
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) radius_a: Option<String>,
    /// Radius of B
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) radius_b: Option<String>,
}

/// The size of one mesh.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct SizeArgument {
    /// Scale of the mesh: one number, or three with commas between them
    #[arg(long, value_name = "S", allow_hyphen_values = true, conflicts_with = "shapes")]
    pub(crate) scale: Option<String>,
    /// Unit of its numbers (mm, cm, m or in), which become meters [default: as the file states, or none]
    #[arg(long, value_name = "UNIT", conflicts_with = "shapes")]
    pub(crate) unit: Option<String>,
}

/// What counts as a body.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct SolidArguments {
    /// Bodies are solid: one inside the other is in contact [default of each mesh that is watertight]
    #[arg(long, conflicts_with = "surface")]
    pub(crate) solid: bool,
    /// Only surfaces count [default of each mesh that is open]
    #[arg(long)]
    pub(crate) surface: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The file holds the mesh and its boxes bit for bit, with a checksum, and is the same on every platform. Reading it checks that
the boxes enclose the mesh, so a damaged or forged file is refused.

Exit codes: 0 written, 2 bad usage, 3 bad input.

Example:
  d2m tree bunny.obj --out bunny.d2mtree
  d2m toc bunny.d2mtree shape:gear --motion-a 'x=-3,0,0;v=4,0,0'")]
pub(crate) struct TreeArguments {
    #[arg(value_name = "A", help = mesh_help())]
    pub(crate) mesh: String,
    /// File to write, with the extension .d2mtree; - for standard output
    #[arg(long, value_name = "A.d2mtree")]
    pub(crate) out: String,
}

/// A count, also written as 1e6.
fn whole_number(text: &str) -> Result<u64, String> {
    /// Doubles are whole numbers without gaps up to this one.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let written = text.parse::<f64>().ok().filter(|n| n.fract() == 0.0 && (0.0..=EXACT).contains(n));
    text.parse()
        .ok()
        .or(written.map(|n| n as u64))
        .ok_or_else(|| "not a whole number such as 1000000 or 1e6".to_owned())
}

/// How a query is answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// The default engine, to the tolerance
    Accurate,
    /// The default engine, stopped at leaf boxes: earlier by a bounded amount, faster
    Capoeira,
    /// The reference method: the paper's, with its errata repaired
    Paper,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A case: {\"id\", \"kind\", \"A\", \"B\", \"motionA\", \"motionB\", \"t0\", \"t1\"} with the kinds
  point_triangle   A {\"p\": [x,y,z]}               B {\"tri\": [p,q,r]}
  edge_edge        A {\"edge\": [p,q]}              B {\"edge\": [p,q]}
  sphere_sphere    A {\"c\": [x,y,z], \"r\": radius}  B {\"c\", \"r\"}
and motions {\"q\": [w,x,y,z], \"x\": [3], \"v\": [3], \"w\": [3]}; or, for four points that each move straight from t = 0 to 1,
  {\"id\", \"kind\": \"point_triangle_linear\" or \"edge_edge_linear\", \"t0_points\": [4 points], \"t1_points\": [4 points]}.
A result: {\"id\", \"status\": \"hit\", \"miss\" or \"undecided\", \"t_lo\", \"t_hi\", \"evidence\": \"crossing\" or \"near\",
\"tolerance\", \"microseconds\"}: nothing touches before t_lo; evidence and tolerance (of hits) are as d2m toc --help explains.

Exit codes: 0 answered, 2 bad usage, 3 bad input.

Example:
  echo '{\"id\": \"1\", \"kind\": \"sphere_sphere\", \"A\": {\"c\": [0,0,0], \"r\": 1}, \"B\": {\"c\": [4,0,0], \"r\": 1}, \"motionA\": {\"v\": [4,0,0]}, \"motionB\": {}, \"t0\": 0, \"t1\": 1}' |
    d2m features - --out -")]
pub(crate) struct FeaturesArguments {
    /// Cases, one JSON object a line
    #[arg(value_name = "CASES.jsonl")]
    pub(crate) cases: PathBuf,
    /// Results, one JSON object a line; - for standard output
    #[arg(long, value_name = "R.jsonl")]
    pub(crate) out: String,
    /// Distance up to which features may be reported as touching [default: 1e-10 times their size]
    #[arg(long, value_name = "DELTA", allow_hyphen_values = true)]
    pub(crate) tolerance: Option<String>,
    /// Distance at which features count as touching
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true)]
    pub(crate) min_separation: Option<String>,
    /// Evaluations after which a case is left undecided
    #[arg(long, value_name = "COUNT", default_value_t = d2m::feature::ContactOptions::new().max_evaluations)]
    pub(crate) budget: u32,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Exit codes: 0 answered, 2 bad usage, 3 bad input.

Examples:
  d2m info part.stl
  d2m info part.stl --unit mm --ply part-in-meters.ply
  d2m info 'shape:gear?teeth=24' --glb gear.glb
  d2m info --shapes")]
pub(crate) struct InfoArguments {
    #[arg(value_name = "A", help = mesh_help(), required_unless_present = "shapes")]
    pub(crate) mesh: Option<String>,
    #[command(flatten)]
    pub(crate) size: SizeArgument,
    /// List the built-in shapes with their parameters
    #[arg(long, conflicts_with = "mesh")]
    pub(crate) shapes: bool,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Also write the mesh as an OBJ file
    #[arg(long, value_name = "FILE.obj", requires = "mesh")]
    pub(crate) obj: Option<String>,
    /// Also write the mesh as a binary PLY file of doubles
    #[arg(long, value_name = "FILE.ply", requires = "mesh")]
    pub(crate) ply: Option<String>,
    /// Also write the mesh as a binary glTF file, in single precision: for viewers
    #[arg(long, value_name = "FILE.glb", requires = "mesh")]
    pub(crate) glb: Option<String>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The page is one file that needs no network: a time slider, the moving meshes, contact points with their normals.
A scene states motions, window, sizes and separations itself; a run is shown as it is: such options are refused beside them.

Exit codes: 0 written, 2 bad usage, 3 bad input.

Examples:
  d2m view shape:gear shape:torus --motion-a 'x=-2,0,0;v=3,0,0;w=0,0,5' --out view.html
  d2m view scene.json --out view.html
  d2m view run.jsonl --out view.html")]
pub(crate) struct ViewArguments {
    /// Mesh as for d2m toc, a scene (.json) or a simulation (.jsonl, .jsonl.gz)
    #[arg(value_name = "A")]
    pub(crate) a: String,
    /// The second mesh
    #[arg(value_name = "B", help = mesh_help())]
    pub(crate) b: Option<String>,
    /// Page to write; - for standard output
    #[arg(long, value_name = "view.html", required_unless_present = "png")]
    pub(crate) out: Option<String>,
    /// Still picture to write, drawn without a browser
    #[arg(long, value_name = "view.png")]
    pub(crate) png: Option<String>,
    /// Time of the still picture [default: the first contact, or the start; the end of a simulation]
    #[arg(long, value_name = "T", allow_hyphen_values = true, requires = "png")]
    pub(crate) at: Option<String>,
    /// Pixels of the still picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800")]
    pub(crate) size: String,
    /// The axis that points up [default: z for arms and where gravity says so, else y]
    #[arg(long, value_enum)]
    pub(crate) up: Option<crate::view::Up>,
    #[command(flatten)]
    pub(crate) motions: MotionArguments,
    #[command(flatten)]
    pub(crate) query: QueryArguments,
}
