//! rapier3d-f64 on the same boxes, as its own cuboids, which are its fastest shapes.
use super::measure::Run;
use super::scene::{FRICTION, HALF, RATE, places};
use rapier3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder};
use std::time::Instant;

/// Boxes that fall into a pile for two seconds.
pub(super) fn boxes(count: usize) -> Run {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / RATE;
    let floor = RigidBodyBuilder::fixed().translation(Vector::new(0.0, -0.5, 0.0));
    world.insert(floor, ColliderBuilder::cuboid(100.0, 0.5, 100.0).friction(FRICTION));
    let mut handles = Vec::new();
    for (place, q) in places(count, 1.4) {
        let turn = Rotation::from_xyzw(q.x, q.y, q.z, q.w);
        let pose = Pose::from_parts(Vector::new(place.x, place.y, place.z), turn);
        let collider = ColliderBuilder::cuboid(HALF, HALF, HALF).friction(FRICTION).density(1000.0);
        handles.push(world.insert(RigidBodyBuilder::dynamic().pose(pose), collider).0);
    }
    let seconds = 2.0;
    let mut microseconds = Vec::new();
    for _ in 0..(seconds * RATE) as usize {
        let start = Instant::now();
        world.step();
        microseconds.push(start.elapsed().as_secs_f64() * 1e6);
    }
    let lost = handles.iter().filter(|&&handle| world.bodies[handle].translation().y < 0.0).count();
    let fault = if lost > 0 { format!("{lost} bodies fell through the floor") } else { String::new() };
    Run {
        scene: format!("boxes {count}"),
        by: "rapier",
        threads: 1,
        bodies: count,
        triangles: 12,
        microseconds,
        simulated: seconds,
        events: 0,
        fault,
    }
}
