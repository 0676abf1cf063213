//! Prints the first contact among a hundred stones that fly about, and then every contact of a stone that was stopped.
//!
//! `cargo run -p d2m --example world`

use d2m::glam::DVec3;
use d2m::{Body, ConstantTwist, FirstContact, MeshTree, QueryOptions, Window, World};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    // One tree for all of them.
    let stone = Arc::new(MeshTree::new(d2m::shapes::mesh("pebble?triangles=500")?));
    let mut world = World::new(QueryOptions::default());
    for k in 0..100 {
        // On a grid, all towards the middle, the outer ones faster.
        let place = DVec3::new(f64::from(k % 10) - 4.5, f64::from(k / 10) - 4.5, 0.0) * 3.0;
        let motion = ConstantTwist::REST
            .with_position(place)
            .with_linear_velocity(-place * (0.1 + 0.001 * f64::from(k)))
            .with_angular_velocity(DVec3::new(0.3, 0.1, 0.2) * f64::from(k % 7));
        world.add(Body::new(Arc::clone(&stone), motion));
    }
    let window = Window::try_new(0.0, 5.0)?;
    let FirstContact::Contact { a, b, contact, .. } = world.first_contact(window)? else {
        return Err("they meet in the middle".into());
    };
    println!("stones {} and {} meet first: free until {:.9}", a.index(), b.index(), contact.time_lo);
    assert!(contact.time_lo > 0.0 && contact.time_hi < 5.0);

    // Only the pairs of the stone that changes are searched anew.
    let before = world.contacts(window)?;
    let pose = world.body(a).motion().pose_and_twist(contact.time_lo).0;
    world.set_motion(a, ConstantTwist::REST.with_position(pose.translation).with_orientation(pose.rotation));
    let after = world.contacts(window)?;
    println!("{} pairs come into contact; with stone {} at rest {}", before.len(), a.index(), after.len());
    assert!(before.iter().all(|pair| pair.clear_until() >= contact.time_lo));
    assert!(after.iter().any(|pair| pair.a == a || pair.b == a));
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
