//! Joints and kinds that change between two steps: what is gone is gone, what is refused changes nothing, and what is let go goes on as it moved.

mod ground;

use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
use glam::DVec3;
use ground::cube;

fn weightless() -> Simulation {
    Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap()
}

/// The body of the last place goes, and its place with it: the step after was a panic, since the joint still looked for it there.
#[test]
fn joints_of_the_last_body_go_with_it() {
    for with_others in [false, true] {
        let mut simulation = weightless();
        let [a, b] = [0.0, 2.0]
            .map(|x| simulation.add(&Body::new("cube", cube()).with_position(DVec3::X * x)).unwrap());
        let joint = simulation.add_joint(&Joint::new(JointKind::Spherical, a, Some(b), DVec3::X)).unwrap();
        if with_others {
            let third = Body::new("third", cube()).with_position(DVec3::X * 6.0);
            let third = simulation.add(&third).unwrap();
            let far = Joint::new(JointKind::Spherical, b, Some(third), DVec3::X * 4.0);
            simulation.add_joint(&far).unwrap();
            simulation.step().unwrap();
            simulation.remove(third);
        }
        simulation.remove(b);
        simulation.step().unwrap();
        assert!(simulation.joint(joint).is_none() && simulation.ids().eq([a]));
        let after = simulation.snapshot();
        simulation.restore(&after).unwrap();
        simulation.step().unwrap();
    }
}
