//! A row of dominoes: the first one is pushed, the last one falls.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
use glam::DVec3;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gap(1e-4))?;
    let floor = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=5&y=0.5&z=1")?));
    let floor = Body::new("floor", floor).with_kind(Kind::Static).with_position(DVec3::Y * -0.5);
    simulation.add(&floor.with_friction(0.5))?;
    let stone = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.01&y=0.1&z=0.05")?));
    let mut row = Vec::new();
    for k in 0..12 {
        let place = DVec3::new(0.08 * f64::from(k), 0.1001, 0.0);
        let body =
            Body::new(format!("stone {k}"), Arc::clone(&stone)).with_position(place).with_friction(0.3);
        row.push(simulation.add(&body)?);
    }
    // A push at the top of the first stone.
    let mass = simulation.mass_properties(row[0]).ok_or("a stone has mass")?.mass;
    let push = DVec3::X * (0.6 * mass);
    simulation.apply_impulse(row[0], push, (DVec3::Y * 0.09).cross(push))?;
    while simulation.time() < 3.0 {
        let report = simulation.step()?;
        if report.events > 0 {
            println!("{:6.3} s: {} events", simulation.time(), report.events);
        }
    }
    let fallen = row.iter().filter(|&&id| (simulation.orientation(id) * DVec3::Y).y < 0.9).count();
    println!("{fallen} of {} stones have fallen", row.len());
    Ok(())
}
