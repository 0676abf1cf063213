//! Prints when a body that swings by a formula of its own meets a wall.
//!
//! `cargo run -p d2m --example own_motion`

use d2m::glam::DVec3;
use d2m::interval::{Interval, IntervalVec3};
use d2m::motion::{IntervalPose, IntervalTwist, check_motion};
use d2m::{ConstantTwist, MeshTree, Moving, Pose, QueryOptions, RigidMotion, Twist, Window, time_of_contact};
use std::error::Error;

/// Swings along x: x = 2 sin t. A motion is its values, and three functions that enclose it over an interval of time.
struct Swing;

fn along_x(x: Interval) -> IntervalVec3 {
    IntervalVec3 { x, ..IntervalVec3::ZERO }
}

impl RigidMotion for Swing {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let pose = Pose { translation: DVec3::X * (2.0 * t.sin()), ..Pose::IDENTITY };
        (pose, Twist { linear: DVec3::X * (2.0 * t.cos()), ..Twist::ZERO })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        IntervalPose { translation: along_x(t.sin() * 2.0), ..IntervalPose::IDENTITY }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        IntervalTwist { linear: along_x(t.cos() * 2.0), angular: IntervalVec3::ZERO }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        IntervalTwist { linear: along_x(t.sin() * -2.0), angular: IntervalVec3::ZERO }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // Samples the motion: a promise that it breaks would be named.
    assert_eq!(check_motion(&Swing, Interval::new(0.0, 3.0), 200), []);

    let cube = MeshTree::new(d2m::shapes::mesh("box?x=0.5&y=0.5&z=0.5")?);
    let wall = ConstantTwist::REST.with_position(DVec3::X * 2.0); // its face is at 1.5
    let (a, b) = (Moving::new(&cube, &Swing), Moving::new(&cube, &wall));
    let answer = time_of_contact(a, b, Window::try_new(0.0, 3.0)?, &QueryOptions::default())?;
    let contact = answer.contact().ok_or("it reaches the wall")?;
    println!("free until {:.12}; 2 sin t = 1 at {:.12}", contact.time_lo, 0.5f64.asin());
    assert!(contact.time_lo <= 0.5f64.asin() && contact.time_lo > 0.5f64.asin() - 1e-9);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
