//! Crates on a belt under a gate: which pairs meet, and in which spans of time the gate is clear and may be closed.
//!
//! `cargo run -p d2m --example conveyor`

use d2m::bvh::{SpanStatus, Start};
use d2m::glam::DVec3;
use d2m::{Body, ConstantTwist, MeshTree, QueryOptions, Window, World, join_spans};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let solid = |shape: &str| Ok::<_, Box<dyn Error>>(Arc::new(MeshTree::new(d2m::shapes::mesh(shape)?)));
    let (belt, case) = (solid("box?x=6&y=0.1&z=1")?, solid("box?x=0.3&y=0.2&z=0.3")?);
    let at = |x: f64, y: f64| ConstantTwist::REST.with_position(DVec3::new(x, y, 0.0));
    // What stands on the belt touches it from the start on, and that is no news; 10 cm of the gate are to be kept.
    let mut world = World::new(QueryOptions::default());
    let belt = world.add(Body::new(belt, at(0.0, -0.1)));
    let gate = world.add(Body::new(solid("box?x=0.05&y=0.5&z=1")?, at(0.0, 0.5)));
    world.ignore_pair(belt, gate, true);
    for k in 0..3 {
        let moving = at(-1.5 - 1.5 * f64::from(k), 0.2).with_linear_velocity(DVec3::X);
        let body = world.add(Body::new(Arc::clone(&case), moving));
        world.ignore_pair(belt, body, true);
        world.set_min_separation(gate, body, Some(0.1));
        world.set_start(gate, body, Some(Start::Report));
    }
    let shift = Window::try_new(0.0, 6.0)?;
    let pairs = world.contact_spans(shift, Some(1e-3))?;
    let gate_spans = join_spans(shift, &pairs);
    for span in &gate_spans {
        println!("{:?} from {:.3} to {:.3}", span.status, span.from, span.to);
    }
    let clear: Vec<_> = gate_spans.iter().filter(|span| span.status == SpanStatus::Clear).collect();
    // Half a case, half a gate and the 10 cm on both sides: 0.9 of every 1.5.
    assert_eq!((pairs.len(), clear.len(), gate_spans.len()), (3, 4, 7));
    for between in &clear[1..3] {
        assert!((between.to - between.from - 0.6).abs() < 4e-3, "{between:?}");
    }
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
