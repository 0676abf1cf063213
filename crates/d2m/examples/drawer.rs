//! A drawer that stands at the back of its cabinet is pulled out: when it leaves the back, and how near it comes to the sides.
//!
//! `cargo run -p d2m --example drawer`

use d2m::bvh::{ClearanceOptions, Start};
use d2m::glam::DVec3;
use d2m::{Body, ConstantTwist, FirstContact, MeshTree, QueryOptions, Window, World};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let panel = |half: [f64; 3], center: [f64; 3]| -> Result<Body, Box<dyn Error>> {
        let [x, y, z] = half;
        let tree = MeshTree::new(d2m::shapes::mesh(&format!("box?x={x}&y={y}&z={z}"))?);
        Ok(Body::new(Arc::new(tree), ConstantTwist::REST.with_position(center.into())))
    };
    let mut world = World::new(QueryOptions::default());
    // The drawer is 40 cm wide with 2 mm of air to the left and 3 mm to the right, and touches the back.
    let drawer = world.add(panel([0.2, 0.1, 0.25], [0.0, 0.0, 0.0])?);
    let left = world.add(panel([0.01, 0.2, 0.25], [-0.212, 0.0, 0.0])?);
    let right = world.add(panel([0.01, 0.2, 0.25], [0.213, 0.0, 0.0])?);
    let back = world.add(panel([0.3, 0.2, 0.125], [0.0, 0.0, -0.375])?);
    for side in [left, right] {
        world.ignore_pair(side, back, true);
    }
    let pulled = ConstantTwist::REST.with_linear_velocity(DVec3::Z * 0.5);
    world.set_motion(drawer, pulled);
    let FirstContact::Contact { b, .. } = world.first_contact(Window::UNIT)? else {
        return Err("it stands at the back".into());
    };
    assert_eq!(b, back);
    // That is no news: what does it meet after it has left?
    world.set_start(drawer, back, Some(Start::Leave));
    assert_eq!(world.first_contact(Window::UNIT)?, FirstContact::Separated);
    world.ignore_pair(drawer, back, true);
    let nearest = world.nearest_pair(Window::UNIT, &ClearanceOptions::default())?.ok_or("two sides")?;
    let air = nearest.clearance;
    println!("body {} is nearest: between {} and {}", nearest.b.index(), air.lower, air.upper);
    assert_eq!((nearest.a, nearest.b), (drawer, left));
    assert!(air.lower <= 0.002 + 1e-9 && air.upper >= 0.002 - 1e-9 && air.upper - air.lower < 3e-9);
    assert_eq!(world.clearances_below(0.0025, Window::UNIT, &ClearanceOptions::default())?.len(), 1);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
