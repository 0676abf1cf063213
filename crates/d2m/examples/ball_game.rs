//! A game's frames: a ball that passes a wall within one of them, and never does. `cargo run -p d2m --example ball_game`
use d2m::bvh::Start;
use d2m::glam::DVec3;
use d2m::{Body, ConstantTwist, MeshTree, QueryOptions, TriMesh, Window, World};
use std::{error::Error, sync::Arc};

fn main() -> Result<(), Box<dyn Error>> {
    // What the ball has bounced off is let go.
    let mut world = World::new(QueryOptions::default().with_start(Start::Leave));
    let wall = Arc::new(MeshTree::new(d2m::shapes::mesh("box?x=0.01&y=2&z=2")?));
    for x in [-1.0, 1.0] {
        world.add(Body::new(Arc::clone(&wall), ConstantTwist::REST.with_position(DVec3::X * x)));
    }
    // A point with a radius is a sphere.
    let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO)?));
    let ball = world.add(Body::new(point, ConstantTwist::REST).with_radius(0.1));
    let (mut place, mut velocity, mut bounces) = (DVec3::ZERO, DVec3::new(150.0, 0.5, 0.0), 0);
    for _ in 0..60 {
        let mut left = 1.0 / 60.0;
        while left > 0.0 {
            world.set_motion(ball, ConstantTwist::REST.with_position(place).with_linear_velocity(velocity));
            let found = world.first_contact(Window::try_new(0.0, left)?)?;
            // What has not parted yet has not met again.
            let met = found.contact().filter(|contact| contact.left.is_some());
            let time = met.map_or(left, |contact| contact.time_lo);
            (place, left) = (place + velocity * time, left - time);
            let Some(contact) = met else { break };
            velocity -= 2.0 * velocity.dot(contact.normal) * contact.normal;
            bounces += 1;
        }
    }
    println!("{bounces} bounces, the ball is at {place:.3}");
    assert!(bounces == 84 && place.x.abs() < 0.89);
    Ok(())
}

#[test]
fn it_never_leaves() {
    main().unwrap();
}
