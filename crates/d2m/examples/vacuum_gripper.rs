//! A vacuum gripper lifts a part from a table: the cup touches the part, the part the table, and only what comes after counts.
//!
//! `cargo run -p d2m --example vacuum_gripper`

use d2m::bvh::{Start, TriMesh};
use d2m::glam::DVec3;
use d2m::{Body, ConstantTwist, FirstContact, MeshTree, PlannedMotion, QueryOptions, Window, World};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let slab = |x: f64, z: f64| d2m::shapes::mesh(&format!("box?x={x}&y={x}&z={z}")).map(MeshTree::new);
    let at = |z: f64| ConstantTwist::REST.with_position(DVec3::Z * z);
    let mut world = World::new(QueryOptions::default().with_tolerance(1e-9));
    let table = world.add(Body::new(Arc::new(slab(1.0, 0.5)?), at(-0.5)));
    let part = world.add(Body::new(Arc::new(slab(0.1, 0.05)?), at(0.05)));
    // The cup is a rounded rod: everything within 3 cm of a segment.
    let rod = MeshTree::new(TriMesh::segment(DVec3::ZERO, DVec3::Z * 0.2)?);
    let cup = world.add(Body::new(Arc::new(rod), at(0.13)).with_radius(0.03));
    let shelf = world.add(Body::new(Arc::new(slab(0.5, 0.02)?), at(0.72)));
    // What is held moves with the cup; what stands on the table is to leave it.
    world.ignore_pair(cup, part, true);
    world.set_start(part, table, Some(Start::Leave));
    let lift = |speed: f64| {
        let plan = |body, z: f64| {
            let motion = at(z).with_linear_velocity(DVec3::Z * speed);
            PlannedMotion { body, motion: Arc::new(motion) }
        };
        [plan(part, 0.05), plan(cup, 0.13)]
    };
    assert_eq!(world.first_contact_of(&lift(0.3), Window::UNIT)?, FirstContact::Separated);
    // Lifted higher the cup, whose top is at 0.36, meets the shelf at 0.7; the part stays below.
    let FirstContact::Contact { a, b, contact, .. } = world.first_contact_of(&lift(0.5), Window::UNIT)?
    else {
        return Err("the shelf is in the way".into());
    };
    println!("bodies {} and {} meet at {}", a.index(), b.index(), contact.time_lo);
    assert_eq!((a, b), (cup, shelf));
    assert!((contact.time_lo - 0.68).abs() < 1e-6 && contact.time_lo <= 0.68);
    // Pressed down instead the part never leaves the table.
    let pressed = world.first_contact_of(&lift(-0.1), Window::UNIT)?;
    assert!(matches!(pressed, FirstContact::Contact { contact, .. } if contact.time_lo == 0.0));
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
