//! Two bodies at rest, as `d2m distance`, `d2m collide` and `d2m proximities` take them.

use crate::arguments::{PosedArguments, SolidArguments};
use crate::engine::{choose_solid, read_radii};
use crate::failure::Failure;
use crate::motion::parse_motion;
use crate::output::printable;
use crate::sizes::{load_both, sizes_line};
use crate::unlike_sizes::warn_of_sizes;
use d2m::bvh::{MeshTree, Posed, QueryError, Solid};
use d2m::motion::Pose;
use d2m_io::pose_at_rest;

/// A tree in a pose, with the name that the user gave it.
pub(crate) struct Body {
    pub(crate) name: String,
    pub(crate) tree: MeshTree,
    pose: Pose,
}

impl Body {
    pub(crate) fn posed(&self) -> Posed<'_> {
        Posed::new(&self.tree, self.pose)
    }
}

/// Two bodies, A and B.
pub(crate) struct PosedBodies {
    pub(crate) both: [Body; 2],
    /// Each body is everything within this distance of its mesh.
    pub(crate) radii: [f64; 2],
}

impl PosedBodies {
    /// Reads poses, then meshes.
    pub(crate) fn new(arguments: &PosedArguments) -> Result<Self, Failure> {
        let poses = [parse_pose("--pose-a", &arguments.pose_a)?, parse_pose("--pose-b", &arguments.pose_b)?];
        let radii = read_radii(&arguments.sizes)?;
        let [a, b] = load_both(&arguments.a, &arguments.b, &arguments.sizes)?;
        let [pose_a, pose_b] = poses;
        let both = [(a, pose_a), (b, pose_b)].map(|(loaded, pose)| Body {
            name: loaded.name.clone(),
            tree: loaded.into_tree(),
            pose,
        });
        let bodies = Self { both, radii };
        let [size_a, size_b] = bodies.sizes();
        warn_of_sizes(size_a, size_b);
        Ok(bodies)
    }

    /// The names of the bodies, with their sizes.
    pub(crate) fn lines(&self, line: &mut dyn FnMut(&str, String)) {
        for (label, body) in ["A", "B"].into_iter().zip(&self.both) {
            line(
                label,
                format!("{} · {} triangles", printable(&body.name), body.tree.mesh().triangle_count()),
            );
        }
    }

    /// The last line of a text: how large the bodies are.
    pub(crate) fn sizes_line(&self) -> String {
        sizes_line(self.sizes(), None)
    }

    fn sizes(&self) -> [f64; 2] {
        [0, 1].map(|k| self.both[k].tree.mesh().size() + 2.0 * self.radii[k])
    }

    /// What counts as a body, of each.
    pub(crate) fn solids(&self, arguments: SolidArguments) -> Result<[Solid; 2], Failure> {
        let [a, b] =
            self.both.each_ref().map(|body| choose_solid(&body.name, body.tree.is_watertight(), arguments));
        Ok([a?, b?])
    }

    /// An error of a query, with the option that it comes from.
    pub(crate) fn failure(&self, error: QueryError) -> Failure {
        match error {
            QueryError::BadPose { body } => {
                let (option, pose) =
                    [("--pose-a", 0), ("--pose-b", 1)].map(|(o, i)| (o, self.both[i].pose))[body.min(1)];
                let [x, at] = [pose.translation, pose.at].map(|v| format!("{:?}", v.to_array()));
                let longest = QueryError::LONGEST_AT_REST;
                Failure::at(option, format!("x = {x}, at = {at}: lengths above {longest:e} cannot be used"))
            }
            other => Failure::Input(other.to_string()),
        }
    }
}

/// Reads `x=…;q=…[;at=…]` or `@file.json` with these keys.
fn parse_pose(option: &str, text: &str) -> Result<Pose, Failure> {
    let motion = parse_motion(option, text)?;
    pose_at_rest(&motion).map_err(|error| Failure::at(text.strip_prefix('@').unwrap_or(option), error))
}
