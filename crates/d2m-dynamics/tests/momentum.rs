//! Contacts move momentum from body to body and make none.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, ContactImpulse, Simulation, SimulationOptions};
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bodies that fly into each other, with spin and friction, far from everything else.
fn crowd(restitution: f64) -> Simulation {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let shapes = ["box?x=0.3&y=0.5&z=0.4", "torus?triangles=300", "icosphere?triangles=80&scale=0.5"];
    let trees = shapes.map(|shape| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap())));
    for k in 0..9 {
        let side = |n: u32| f64::from(k / 3u32.pow(n) % 3) - 1.0;
        let place = DVec3::new(2.5 * side(0), 2.6 * side(1), 0.4 * side(0));
        let body = Body::new(format!("body {k}"), Arc::clone(&trees[k as usize % 3]))
            .with_position(place)
            .with_orientation(DQuat::from_xyzw(0.1 * f64::from(k), 0.3, -0.2, 1.0))
            .with_linear_velocity(place * -1.2 + DVec3::Z * 0.1 * side(1))
            .with_angular_velocity(DVec3::new(0.5, 0.2 * f64::from(k), -0.3))
            .with_restitution(restitution)
            .with_friction(0.3);
        simulation.add(&body).unwrap();
    }
    simulation
}

/// Linear and angular momentum about the origin, of all bodies together; and their sums of magnitudes.
fn momenta(simulation: &Simulation) -> [(DVec3, f64); 2] {
    let (mut linear, mut angular) = ((DVec3::ZERO, 0.0), (DVec3::ZERO, 0.0));
    for id in simulation.ids() {
        let p = simulation.mass_properties(id).unwrap();
        let momentum = simulation.linear_velocity(id) * p.mass;
        let r = DMat3::from_quat(simulation.orientation(id));
        let scale = (r * p.inertia * simulation.angular_velocity(id)).length();
        let arm = simulation.position(id).cross(momentum);
        linear = (linear.0 + momentum, linear.1 + momentum.length());
        angular = (angular.0 + arm + simulation.angular_momentum(id), angular.1 + arm.length() + scale);
    }
    [linear, angular]
}

#[test]
fn contacts_make_no_momentum() {
    for restitution in [0.4, 0.0] {
        let mut simulation = crowd(restitution);
        let mut contacts = 0;
        simulation.step().unwrap();
        let before = momenta(&simulation);
        while simulation.time() < 3.0 {
            simulation.step_with(&mut |_: &ContactImpulse| contacts += 1).unwrap();
        }
        let after = momenta(&simulation);
        assert!(contacts > 20, "{contacts}");
        let drift: Vec<f64> = before.iter().zip(after).map(|(b, a)| (a.0 - b.0).length() / b.1).collect();
        assert!(drift[0] < 1e-12, "{restitution}: {drift:?}");
        // What makes room moves the bodies and leaves no momentum: their centers, of which angular momenta are the arms,
        // shift by parts of the gap.
        assert!(drift[1] < 1e-3, "{restitution}: {drift:?}");
        println!("{drift:?}");
    }
}

/// What listeners hear is what the run file holds: each impulse once, in the order of time, and by it alone bodies without
/// forces change their velocities.
#[test]
fn listeners_hear_every_impulse_of_the_segments() {
    let mut simulation = crowd(0.4);
    let (mut heard, mut written) = (Vec::new(), Vec::new());
    while simulation.time() < 2.0 {
        let report = simulation.step_with(&mut |contact: &ContactImpulse| heard.push(*contact)).unwrap();
        written.extend(report.contacts().copied());
    }
    written.extend(simulation.finish().into_iter().flat_map(|segment| segment.contacts));
    assert!(!heard.is_empty());
    assert_eq!(heard, written);
    assert!(heard.is_sorted_by(|one, two| one.time <= two.time));
    let mut pairs: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for contact in &heard {
        assert!(contact.a < contact.b && (contact.normal.length() - 1.0).abs() < 1e-12);
        // What acts on a pushes it away from b.
        assert!(contact.impulse.dot(contact.normal) <= 0.0);
        *pairs.entry((contact.a.index(), contact.b.index())).or_default() += 1;
    }
    assert!(pairs.len() > 2, "{pairs:?}");
}
