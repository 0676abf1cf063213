//! A ball meets a triangle of ten others: every impact at its certified time.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, Simulation, SimulationOptions};
use glam::DVec3;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    // Seen from above, without a table: the balls fly.
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(1e-4).with_step(1.0 / 64.0);
    let mut simulation = Simulation::new(options)?;
    let ball = Arc::new(MeshTree::new(d2m_shapes::mesh("icosphere?triangles=320&scale=0.0286")?));
    let body = |name: String, place: DVec3| {
        Body::new(name, Arc::clone(&ball)).with_position(place).with_restitution(0.95)
    };
    for row in 0..4 {
        for k in 0..=row {
            let place = DVec3::new(0.052 * f64::from(row), 0.06 * (f64::from(k) - 0.5 * f64::from(row)), 0.0);
            simulation.add(&body(format!("ball {row}.{k}"), place))?;
        }
    }
    let cue = body("cue ball".to_owned(), DVec3::X * -0.5).with_linear_velocity(DVec3::new(8.0, 0.01, 0.0));
    let cue = simulation.add(&cue)?;
    while simulation.time() < 0.5 {
        for contact in simulation.step()?.contacts() {
            let (a, b) = (simulation.name(contact.a), simulation.name(contact.b));
            println!("{:.6} s: {a} and {b}, impulse {:.4}", contact.time, contact.impulse.length());
        }
    }
    println!("the cue ball goes on at {:.3} m/s", simulation.linear_velocity(cue).length());
    Ok(())
}
