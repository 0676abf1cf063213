//! Queries of two trees that move, and their certified distance at one time.

use d2m_bvh::{
    Distance, MeshTree, Moving, Posed, QueryOptions, Solid, TimeOfContact, Window, distance, time_of_contact,
};
use d2m_motion::{Pose, RigidMotion};
use glam::{DQuat, DVec3};

pub(crate) fn query(
    trees: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    window: Window,
    options: &QueryOptions,
) -> TimeOfContact {
    time_of_contact(Moving::new(trees[0], motions[0]), Moving::new(trees[1], motions[1]), window, options)
        .unwrap()
}

/// Certified distance of the bodies at a time, expressed near `origin` so that the judge's own rounding does not matter.
pub(crate) fn distance_at(
    trees: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    t: f64,
    origin: DVec3,
) -> Distance {
    let posed = [0, 1].map(|k| {
        let state = motions[k].enclose_state_about(t, origin);
        let rotation = DQuat::from_mat3(&state.rotation);
        Posed::new(trees[k], Pose { rotation, translation: state.position, at: state.at })
    });
    distance(posed[0], posed[1], Solid::Filled).unwrap()
}
