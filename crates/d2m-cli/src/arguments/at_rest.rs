//! Options of the commands for bodies at rest.

use super::{SizeArguments, SolidArguments, mesh_help};
use clap::Args;

/// Help after the options of a command that takes poses: what a pose is, and then the text.
macro_rules! with_pose_help {
    ($text:literal) => {
        concat!(
            "A pose is x=1,2,3;q=w,x,y,z[;at=1,2,3]: where the body point at (the origin if left out) is, and how the body is turned.\n\
             @FILE reads the same keys from JSON.\n\n",
            $text
        )
    };
}

/// Two bodies at rest.
#[derive(Debug, Args)]
pub(crate) struct PosedArguments {
    #[arg(value_name = "A", help = mesh_help())]
    pub(crate) a: String,
    #[arg(value_name = "B", help = mesh_help())]
    pub(crate) b: String,
    #[command(flatten)]
    pub(crate) sizes: SizeArguments,
    /// Pose of A; the mesh as it is if not given
    #[arg(long, value_name = "P", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) pose_a: String,
    /// Pose of B; the mesh as it is if not given
    #[arg(long, value_name = "P", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    pub(crate) pose_b: String,
    /// Answer as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Exit with 10 if the bodies share a point (or cannot be distinguished from bodies that do), with 11 if they are apart
    #[arg(long)]
    pub(crate) exit_status: bool,
}

#[derive(Debug, Args)]
#[command(after_help = with_pose_help!("\
The answer holds the distance, the certified interval [lower, upper] that the true distance lies in, the closest points with
their triangles, and the unit normal from A to B. Bodies that touch, cross or contain each other are at distance zero.
status (in JSON): separated if the distance is proven to be above zero, contact otherwise; state says which kind.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated.

Example:
  d2m distance shape:gear shape:torus --pose-a 'x=-3,0,0;q=0.7,0,0,0.7'"))]
pub(crate) struct DistanceArguments {
    #[command(flatten)]
    pub(crate) posed: PosedArguments,
    #[command(flatten)]
    pub(crate) solid: SolidArguments,
}

#[derive(Debug, Args)]
#[command(after_help = with_pose_help!("\
separated is proven. contact is said whenever that cannot be proven: bodies that share a point, and bodies that are apart by
less than the rounding of placing them. triangles names a pair of triangles that are not proven apart; there is none if one
body is inside the other.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated.

Example:
  d2m collide shape:gear shape:torus --pose-a 'x=0.5,0,0' --exit-status"))]
pub(crate) struct CollideArguments {
    #[command(flatten)]
    pub(crate) posed: PosedArguments,
    #[command(flatten)]
    pub(crate) solid: SolidArguments,
}

#[derive(Debug, Args)]
#[command(after_help = with_pose_help!("\
A pair of points is locally closest when no point of A next to the one is nearer to the other, and none of B next to the other is
nearer to the one. The answer lists all such pairs within the margin, the closest first, each with its points, the unit normal from A to B,
the distance, the features (vertex and face, or two edges) and the triangles that hold the points: what a contact manifold is made of.
Only surfaces count. Where faces lie parallel, the corners of the patch stand for it. --reduce keeps at most four of the pairs
whose normals differ by less than the angle: the closest and those that span the largest area. tilt (in JSON) is above zero only
for pairs that --cone-slack lets in: the sine of the angle by which the direction leaves the cone of normals.
Surfaces that meet have no closest features: status (in JSON) is contact then, and separated otherwise.

Exit codes: 0 answered, 2 bad usage, 3 bad input; with --exit-status 10 contact, 11 separated.

Example:
  d2m proximities shape:box shape:gear --pose-b 'x=0,0,1' --margin 0.5 --reduce"))]
pub(crate) struct ProximitiesArguments {
    #[command(flatten)]
    pub(crate) posed: PosedArguments,
    /// Distance up to which features are listed
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true)]
    pub(crate) margin: String,
    /// List also features whose direction leaves the cone of normals by less than this sine of an angle
    #[arg(long, value_name = "SINE", allow_hyphen_values = true)]
    pub(crate) cone_slack: Option<String>,
    /// At most four pairs of those with the same normal, up to this angle in radians
    #[arg(long, value_name = "ANGLE", num_args = 0..=1, default_missing_value = "0.1")]
    pub(crate) reduce: Option<String>,
}
