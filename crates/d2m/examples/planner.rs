//! A planner's question: is this motion of an arm free of contact, and if not, until when?
//!
//! `cargo run -p d2m --example planner`

use d2m::glam::{DQuat, DVec3};
use d2m::motion::{Chain, Joint, JointKind, JointValue};
use d2m::{
    Body, BodyId, ConstantTwist, FirstContact, Group, MeshTree, PlannedMotion, QueryOptions, Window, World,
};
use std::error::Error;
use std::sync::Arc;

/// Joint angles at the start and at the end of the planned motion, shoulder first.
type Angles = [f64; 3];

/// The motion of each link while all joints turn at constant rates.
fn links(start: Angles, end: Angles) -> Result<Vec<Chain>, Box<dyn Error>> {
    let mut joints = Vec::new();
    let mut links = Vec::new();
    for (k, (&from, &to)) in start.iter().zip(&end).enumerate() {
        // Each joint sits at the end of the link before, one unit further out.
        let place = if k == 0 { DVec3::ZERO } else { DVec3::X };
        let value = JointValue::try_polynomial(vec![from, to - from])?;
        joints.push(Joint::try_new(place, DQuat::IDENTITY, JointKind::Revolute { axis: DVec3::Z, value })?);
        links.push(Chain::try_new(joints.clone())?);
    }
    Ok(links)
}

/// Asks for the whole arm at once; links that a joint connects are ignored.
fn ask(world: &World, arm: &[BodyId], start: Angles, end: Angles) -> Result<FirstContact, Box<dyn Error>> {
    let motions = links(start, end)?;
    let planned = |(&body, motion): (&BodyId, Chain)| PlannedMotion { body, motion: Arc::new(motion) };
    let plan: Vec<_> = arm.iter().zip(motions).map(planned).collect();
    Ok(world.first_contact_of(&plan, Window::UNIT)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let tree = |shape: &str| d2m::shapes::mesh(shape).map(|mesh| Arc::new(MeshTree::new(mesh)));
    // A link reaches from its joint to the next one.
    let mut bar = d2m::shapes::mesh("box?x=0.5&y=0.08&z=0.08")?;
    let moved = bar.vertices().iter().map(|&corner| corner + DVec3::X * 0.5).collect();
    bar = d2m::TriMesh::try_new(moved, bar.triangles().to_vec())?;
    let bar = Arc::new(MeshTree::new(bar));

    // Ten micrometers are kept free, were the unit a meter.
    let mut world = World::new(QueryOptions::default().with_min_separation(1e-5));
    let home = [0.0, 0.0, 0.0];
    let arm: Vec<BodyId> = links(home, home)?
        .into_iter()
        .map(|motion| world.add(Body::new(Arc::clone(&bar), motion).with_group(Group(0))))
        .collect();
    for pair in arm.windows(2) {
        world.ignore_pair(pair[0], pair[1], true);
    }
    let post = ConstantTwist::REST.with_position(DVec3::new(1.0, 1.8, 0.0));
    let post = world.add(Body::new(tree("box?x=0.2&y=0.2&z=1")?, post));

    // The stretched arm sweeps into the post; folded it passes.
    let stretched = ask(&world, &arm, home, [1.5, 0.0, 0.0])?;
    let FirstContact::Contact { a, b, contact, .. } = &stretched else { panic!("{stretched:?}") };
    println!("stretched: link {} meets the post; free until t = {:.9}", a.index(), contact.time_lo);
    assert!(arm.contains(a) && *b == post && contact.time_lo > 0.5 && contact.time_hi < 1.0);

    let fold = ask(&world, &arm, home, [0.0, -1.4, -1.4])?;
    let sweep = ask(&world, &arm, [0.0, -1.4, -1.4], [1.9, -1.4, -1.4])?;
    println!("fold: {fold:?}; then sweep: {sweep:?}");
    assert_eq!((fold, sweep), (FirstContact::Separated, FirstContact::Separated));
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
