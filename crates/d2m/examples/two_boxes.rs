//! Prints when, where and along which normal a box that flies meets one at rest.
//!
//! `cargo run -p d2m --example two_boxes`

use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, TimeOfContact, Window, time_of_contact};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // Half sizes: a cube whose edges are 2 long. Any unit of length will do, and any unit of time.
    let cube = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1")?);
    let flying = ConstantTwist::REST.with_position(DVec3::X * -5.0).with_linear_velocity(DVec3::X * 6.0);
    let [a, b] = [Moving::new(&cube, &flying), Moving::new(&cube, &ConstantTwist::REST)];
    match time_of_contact(a, b, Window::UNIT, &QueryOptions::default())? {
        TimeOfContact::Separated => return Err("they meet".into()),
        TimeOfContact::Undecided { clear_until } => {
            return Err(format!("only with a budget; free until {clear_until}").into());
        }
        TimeOfContact::Contact(contact) => {
            println!("free until {:.12}, in contact by {:.12}", contact.time_lo, contact.time_hi);
            println!("at {}, normal {} from A to B, {:?}", contact.point_b, contact.normal, contact.feature);
            assert!(contact.time_lo <= 0.5 && 0.5 - 1e-9 < contact.time_lo);
            assert!((contact.normal - DVec3::X).length() < 1e-9);
        }
    }
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
