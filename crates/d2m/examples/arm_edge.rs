//! A planner's edge: may an arm go straight from one configuration to another? `cargo run -p d2m --example arm_edge`
use d2m::glam::{DAffine3, DQuat, DVec3};
use d2m::motion::{Arm, Joint, JointKind, JointPoints, JointValue};
use d2m::{Body, ConstantTwist, FirstContact, MeshTree, QueryOptions, Window, World};
use std::{error::Error, sync::Arc};

fn is_free(from: [f64; 3], to: [f64; 3]) -> Result<bool, Box<dyn Error>> {
    let mut arm = Arm::default();
    for (k, (from, to)) in from.into_iter().zip(to).enumerate() {
        let value = JointValue::through(JointPoints::new(vec![0.0, 1.0], vec![from, to]))?;
        let place = if k == 0 { DVec3::ZERO } else { DVec3::X };
        let joint = Joint::try_new(place, DQuat::IDENTITY, JointKind::Revolute { axis: DVec3::Z, value })?;
        arm.add(format!("link {k}"), k.checked_sub(1), joint)?;
    }
    let bar = d2m::shapes::mesh("box?x=0.4&y=0.08&z=0.08")?;
    let bar = Arc::new(MeshTree::new(bar.transformed(&DAffine3::from_translation(DVec3::X * 0.5))?));
    let mut world = World::new(QueryOptions::default().with_min_separation(1e-3));
    for link in arm.links()? {
        world.add(Body::new(Arc::clone(&bar), link));
    }
    let post = ConstantTwist::REST.with_position(DVec3::new(1.0, 1.8, 0.0));
    world.add(Body::new(Arc::new(MeshTree::new(d2m::shapes::mesh("box?x=0.2&y=0.2&z=1")?)), post));
    Ok(matches!(world.first_contact(Window::UNIT)?, FirstContact::Separated))
}

#[test]
fn the_stretched_arm_meets_the_post() {
    main().unwrap();
}

fn main() -> Result<(), Box<dyn Error>> {
    let (home, folded, beyond) = ([0.0; 3], [0.0, -1.4, -1.4], [1.9, -1.4, -1.4]);
    let answers = [is_free(home, [1.5, 0.0, 0.0])?, is_free(home, folded)?, is_free(folded, beyond)?];
    assert_eq!(answers, [false, true, true]);
    Ok(())
}
