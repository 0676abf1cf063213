//! Prints how far a controller drives in each cycle when every query has a small budget: only through what is proven free.
//!
//! `cargo run -p d2m --example real_time`

use d2m::glam::DVec3;
use d2m::{Budget, ConstantTwist, MeshTree, Moving, QueryOptions, TimeOfContact, Window, time_of_contact};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let gear = MeshTree::new(d2m::shapes::mesh("gear?triangles=2000")?);
    let driving: ConstantTwist = "x=-4,0.1,0;v=1,0,0;w=0,0,2".parse()?;
    let standing = ConstantTwist::REST.with_angular_velocity(DVec3::Z * -1.0);
    let (a, b) = (Moving::new(&gear, &driving), Moving::new(&gear, &standing));
    // A number of node tests gives the same cycles on every machine; `with_wall_clock` keeps a deadline instead.
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(40));

    let (mut time, end, mut cycles) = (0.0, 4.0, 0);
    let stop = loop {
        cycles += 1;
        match time_of_contact(a, b, Window::try_new(time, end)?, &options)? {
            TimeOfContact::Separated => break end,
            TimeOfContact::Contact(contact) => break contact.time_lo,
            // Nothing meets before `clear_until`: drive there, and look again from there on.
            TimeOfContact::Undecided { clear_until } if clear_until > time => time = clear_until,
            // Nothing is proven with this budget: wait where it is safe.
            TimeOfContact::Undecided { .. } => break time,
        }
        println!("cycle {cycles}: drives until {time:.6}");
    };
    println!("stops at {stop:.6} after {cycles} cycles");

    let TimeOfContact::Contact(contact) =
        time_of_contact(a, b, Window::try_new(0.0, end)?, &QueryOptions::default())?
    else {
        return Err("the gears meet".into());
    };
    assert!(0.0 < stop && stop <= contact.time_hi, "it never drives into the contact");
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
