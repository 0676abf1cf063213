//! A peg is drawn out of its hole: whether it jams, how much air it has, and when it has left.
//!
//! `cargo run -p d2m --example peg`

use d2m::bvh::{ClearanceOptions, Start, StartState, clearance, departure};
use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, Window, time_of_contact};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // A shaft of radius 0.5 along z and the ring about it, with an air of 0.01 all around.
    let [peg, ring] =
        ["shaft", "bearing?clearance=0.01"].map(|shape| d2m::shapes::mesh(shape).map(MeshTree::new));
    let (peg, ring) = (peg?, ring?);
    let drawn = |drift: f64| ConstantTwist::REST.with_linear_velocity(DVec3::new(drift, 0.0, 3.0));
    let hole = Moving::new(&ring, &ConstantTwist::REST);
    let straight = drawn(0.0);
    let moving = Moving::new(&peg, &straight);
    let options = QueryOptions::default();
    assert!(time_of_contact(hole, moving, Window::UNIT, &options)?.is_separated());
    let air = clearance(hole, moving, Window::UNIT, &ClearanceOptions::default())?;
    println!("drawn straight it has an air of {} at least", air.lower);
    assert!(air.lower > 0.009 && air.upper < 0.011, "{air:?}");

    // A drift of a hundredth of the way makes it touch the rim.
    let askew = drawn(0.1);
    let jams = time_of_contact(hole, Moving::new(&peg, &askew), Window::UNIT, &options)?;
    let contact = jams.contact().ok_or("it drifts into the rim")?;
    println!("with a drift it meets the rim at {}", contact.time_lo);
    assert!((contact.time_lo - 0.1).abs() < 0.02 && contact.start == StartState::Apart);

    // Within 0.05 of the hole it counts as in it: when has it left?
    let near = options.with_min_separation(0.05).with_start(Start::Leave);
    let found = departure(hole, moving, Window::UNIT, &near)?;
    let left = found.left.ok_or("it comes out")?;
    println!("it is out between {} and {}", left.lo, left.hi);
    assert!(left.lo <= left.hi && left.hi - left.lo < 1e-4 && left.hi < 1.0 && found.answer.is_separated());
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
