//! Prints how a stack of three boxes settles and how far apart the boxes stay: they never pass through each other.
//!
//! `cargo run -p d2m --features dynamics --example simulation`

use d2m::MeshTree;
use d2m::dynamics::{Body, Kind, Simulation, SimulationOptions};
use d2m::glam::DVec3;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    // Meters, seconds and kilograms; y is up, the gap that contacts keep is a millimeter.
    let options = SimulationOptions::default().with_gap(1e-3);
    let mut simulation = Simulation::new(options)?;
    let tree = |shape: &str| d2m::shapes::mesh(shape).map(|mesh| Arc::new(MeshTree::new(mesh)));
    let (floor, cube) = (tree("box?x=5&y=0.5&z=5")?, tree("box?x=0.5&y=0.5&z=0.5")?);
    simulation.add(&Body::new("floor", floor).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
    let mut stack = Vec::new();
    for (name, height) in [("lower", 0.6), ("middle", 1.7), ("upper", 2.8)] {
        stack.push(simulation.add(&Body::new(name, Arc::clone(&cube)).with_position(DVec3::Y * height))?);
    }
    let mut impulses = 0;
    while simulation.time() < 1.0 {
        // Each flight between two contacts is certified before the bodies fly it.
        impulses += simulation.step()?.contacts().count();
    }
    let heights: Vec<f64> = stack.iter().map(|&body| simulation.position(body).y).collect();
    println!("after {:.2} s and {impulses} impulses the boxes are at {heights:.4?}", simulation.time());
    for (k, height) in (0..).zip(&heights) {
        let resting = 0.5 + f64::from(k);
        assert!(*height >= resting && *height < resting + 0.01, "box {k} at {height}");
    }
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
