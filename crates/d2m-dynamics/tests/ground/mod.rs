//! What bodies of tests stand on, and how they come to rest.
#![allow(dead_code)] // not every test needs all of it

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, BodyId, Kind, Simulation};
use d2m_motion::Pose;
use glam::{DQuat, DVec3};
use std::sync::Arc;

pub(crate) fn tree(shape: &str) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()))
}

pub(crate) fn cube() -> Arc<MeshTree> {
    tree("box?x=0.5&y=0.5&z=0.5")
}

pub(crate) fn floor() -> Body {
    let floor = Body::new("floor", tree("box?x=20&y=0.5&z=20")).with_kind(Kind::Static).with_friction(0.5);
    floor.with_position(DVec3::Y * -0.5)
}

pub(crate) fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(DVec3::new(x, y, z), DQuat::IDENTITY)
}

pub(crate) fn rest(simulation: &mut Simulation, body: BodyId) {
    while !simulation.is_asleep(body) {
        simulation.step().unwrap();
        assert!(simulation.time() < 20.0, "it does not come to rest");
    }
}
