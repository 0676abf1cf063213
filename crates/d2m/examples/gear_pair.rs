//! Prints whether two gears turn into each other without touching, in step and half a tooth out of step.
//!
//! `cargo run -p d2m --example gear_pair`

use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, Pose, QueryOptions, TimeOfContact, Window, time_of_contact};
use std::error::Error;
use std::f64::consts::{PI, TAU};

const TEETH: f64 = 16.0;

fn main() -> Result<(), Box<dyn Error>> {
    let gear = MeshTree::new(d2m::shapes::mesh("gear?teeth=16&triangles=2000")?);
    let radius = gear.mesh().vertices().iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    // A tip reaches a third of the depth (0.15 of the radius) into the gap of the other gear.
    let distance = DVec3::X * radius * 1.95;
    // One turn in a unit of time, about z, in opposite directions.
    let left = ConstantTwist::REST.with_angular_velocity(DVec3::Z * TAU);
    let ask = |phase: f64| {
        let turned = Pose::from_axis_angle(distance, DVec3::Z, phase);
        let right = ConstantTwist::REST
            .with_position(turned.translation)
            .with_orientation(turned.rotation)
            .with_angular_velocity(DVec3::Z * -TAU);
        let [a, b] = [Moving::new(&gear, &left), Moving::new(&gear, &right)];
        time_of_contact(a, b, Window::UNIT, &QueryOptions::default())
    };
    let in_step = ask(PI / TEETH)?;
    println!("in step: {}", if in_step.is_separated() { "proven free for a whole turn" } else { "contact" });
    let TimeOfContact::Contact(contact) = ask(0.0)? else { return Err("teeth on teeth do not meet".into()) };
    println!("half a tooth out of step: free until {:.9}", contact.time_lo);
    assert!(in_step.is_separated() && contact.time_lo < 1.0 / TEETH);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
