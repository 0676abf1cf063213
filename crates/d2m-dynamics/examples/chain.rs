//! Links hang from a fixed one by their shape alone: there are no joints.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
use glam::{DQuat, DVec3};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::new(SimulationOptions::default())?;
    let link = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=400&tube=0.15")?));
    // Every other link is turned by a quarter about the chain; neighbours are a little closer than they will hang.
    let quarter = DQuat::from_xyzw(1.0, 0.0, 0.0, 1.0).normalize();
    let mut links = Vec::new();
    for k in 0..5 {
        let body =
            Body::new(format!("link {k}"), Arc::clone(&link)).with_position(DVec3::X * 1.2 * f64::from(k));
        let body = if k % 2 == 1 { body.with_orientation(quarter) } else { body };
        let kind = if k == 0 { Kind::Static } else { Kind::Dynamic };
        links.push(simulation.add(&body.with_kind(kind).with_friction(0.2))?);
    }
    while simulation.time() < 3.0 {
        simulation.step()?;
    }
    for pair in links.windows(2) {
        let distance = simulation.position(pair[0]).distance(simulation.position(pair[1]));
        println!("{} to {}: {distance:.4}", simulation.name(pair[0]), simulation.name(pair[1]));
        assert!(distance < 1.41, "the chain has come apart");
    }
    Ok(())
}
