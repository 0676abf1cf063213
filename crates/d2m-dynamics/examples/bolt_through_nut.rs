//! A screw turns down through a fixed nut by its own weight: threads of triangles, no joint and no friction.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
use glam::DVec3;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let options = SimulationOptions::default().with_gravity(DVec3::Z * -9.81).with_gap(5e-4);
    let mut simulation = Simulation::new(options)?;
    let tree = |shape: &str| d2m_shapes::mesh(shape).map(|mesh| Arc::new(MeshTree::new(mesh)));
    simulation.add(&Body::new("nut", tree("nut?triangles=8000&clearance=0.03")?).with_kind(Kind::Static))?;
    let screw = simulation.add(&Body::new("screw", tree("screw?triangles=8000")?))?;
    let start = simulation.position(screw).z;
    while simulation.time() < 0.5 {
        simulation.step()?;
        let (depth, spin) = (start - simulation.position(screw).z, simulation.angular_velocity(screw).z);
        println!("{:.2} s: {depth:.5} down, {spin:+.3} rad/s", simulation.time());
    }
    Ok(())
}
