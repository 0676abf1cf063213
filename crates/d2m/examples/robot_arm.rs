//! Prints when the hand of an arm of two links, which turn along given joint angles, meets a post.
//!
//! `cargo run -p d2m --example robot_arm`

use d2m::glam::{DQuat, DVec3};
use d2m::{
    Arm, ConstantTwist, Joint, JointKind, JointPoints, JointValue, MeshTree, Moving, QueryOptions, Window,
    time_of_contact,
};
use std::error::Error;

/// A joint at `place` in the frame before, which turns about z through these angles (radians) at 0, 1 and 2 seconds.
fn turning(place: DVec3, angles: [f64; 3]) -> Result<Joint, Box<dyn Error>> {
    let value = JointValue::through(JointPoints::new(vec![0.0, 1.0, 2.0], angles.to_vec()))?;
    Ok(Joint::try_new(place, DQuat::IDENTITY, JointKind::Revolute { axis: DVec3::Z, value })?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arm = Arm::default();
    let shoulder = arm.add("upper arm", None, turning(DVec3::ZERO, [0.0, 0.8, 1.6])?)?;
    let hand = arm.add("hand", Some(shoulder), turning(DVec3::X, [0.0, -0.4, 0.0])?)?;
    let links = arm.links()?;

    let block = MeshTree::new(d2m::shapes::mesh("box?x=0.2&y=0.05&z=0.05")?);
    let post = MeshTree::new(d2m::shapes::mesh("box?x=0.1&y=0.1&z=1")?);
    let standing = ConstantTwist::REST.with_position(DVec3::new(0.0, 1.2, 0.0));
    let (a, b) = (Moving::new(&block, &links[hand]), Moving::new(&post, &standing));
    let answer = time_of_contact(a, b, Window::try_new(0.0, 2.0)?, &QueryOptions::default())?;
    let contact = answer.contact().ok_or("the hand meets the post")?;
    println!(
        "{}: free until {:.9} s, then {:?} at {}",
        arm.name(hand),
        contact.time_lo,
        contact.feature,
        contact.point_b
    );
    assert!(contact.time_lo > 1.5 && contact.time_hi < 2.0);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
