//! Prints how far a screw can be turned in its nut: with the pitch of the thread for a quarter of a turn, with a wrong one not.
//!
//! `cargo run -p d2m --example screw_and_nut`

use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, Pose, QueryOptions, ScrewMotion, Twist, Window, time_of_contact};
use std::error::Error;
use std::f64::consts::TAU;

/// How far the thread rises in one turn: 0.2 before both shapes are scaled alike, as `d2m info --shapes` says.
const PITCH: f64 = 0.192_227_732_532_885_13;

fn main() -> Result<(), Box<dyn Error>> {
    let tree = |shape: &str| d2m::shapes::mesh(shape).map(MeshTree::new);
    let (screw, nut) = (tree("screw?triangles=4000")?, tree("nut?triangles=3000&clearance=0.02")?);
    // One turn a unit of time about z, and so much along z.
    let ask = |rise: f64| {
        let twist = Twist { linear: DVec3::Z * rise, angular: DVec3::Z * TAU };
        let turning = ScrewMotion::try_from_twist(Pose::IDENTITY, twist, 0.0)?;
        let [a, b] = [Moving::new(&screw, &turning), Moving::new(&nut, &ConstantTwist::REST)];
        let answer = time_of_contact(a, b, Window::try_new(0.0, 0.25)?, &QueryOptions::default())?;
        Ok::<_, Box<dyn Error>>(answer)
    };
    let right = ask(PITCH)?;
    println!("with the pitch of the thread: {right:?}");
    let wrong = ask(0.0)?;
    let contact = wrong.contact().ok_or("the flanks meet")?;
    println!("without moving along: free until {:.9} turns", contact.time_lo);
    assert!(right.is_separated() && contact.time_lo > 0.0 && contact.time_lo < 0.25);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
