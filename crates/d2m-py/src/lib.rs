//! Python bindings of d2m: the extension module `d2m_ccd._d2m`. What users see of it, `d2m_ccd`, is in `python/`.

mod answer;
mod arrays;
mod batch;
mod fault;
mod files;
mod frozen;
mod joint;
mod mesh;
mod motion;
mod options;
mod path_answer;
mod pose;
mod query;
mod questions;
mod record;
mod resting;
mod robot;
mod robot_edges;
mod robot_input;
mod robot_questions;
mod robot_recipe;
mod segment;
mod simulation;
mod simulation_live;
mod snapshot;
mod supervise;
mod trajectory;
mod verify;
mod witness;
mod world;
mod world_answer;

use pyo3::prelude::*;

/// The extension module of `d2m_ccd`.
#[pymodule]
mod _d2m {
    #[pymodule_export]
    use crate::answer::{Answer, Contact, Separated, Undecided};
    #[pymodule_export]
    use crate::batch::batch;
    #[pymodule_export]
    use crate::frozen::{Frozen, RayAnswer};
    #[pymodule_export]
    use crate::joint::{Motor, Spring};
    #[pymodule_export]
    use crate::mesh::{Mesh, Tree};
    #[pymodule_export]
    use crate::motion::{Chain, ConstantTwist, Joint, Keyframes, Motion, Screw, Spline};
    #[pymodule_export]
    use crate::path_answer::{PathAnswer, PathClearance};
    #[pymodule_export]
    use crate::pose::Pose;
    #[pymodule_export]
    use crate::query::{contact_exists_py, time_of_contact_py};
    #[pymodule_export]
    use crate::questions::{Clearance, Departure, clearance_py, departure_py, spans};
    #[pymodule_export]
    use crate::record::feature_text_py;
    #[pymodule_export]
    use crate::resting::{Distance, collide, distance, proximities};
    #[pymodule_export]
    use crate::robot::Robot;
    #[pymodule_export]
    use crate::segment::{Impulse, Segment, TouchEvent};
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::snapshot::Snapshot;
    #[pymodule_export]
    use crate::trajectory::{JointTrajectories, PoseTrajectories};
    #[pymodule_export]
    use crate::verify::{Verdict, verify};
    #[pymodule_export]
    use crate::witness::Witness;
    #[pymodule_export]
    use crate::world::World;
    #[pymodule_export]
    use crate::world_answer::{BodyId, FirstContact, PairContact};
}
