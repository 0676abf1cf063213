//! Every query of moving bodies refuses times that a motion does not cover, and names body, times and window.

use d2m_bvh::{
    MeshTree, Mode, Moving, PairCache, ProximityOptions, QueryError, QueryOptions, Window, contact_exists,
    time_of_contact, time_of_contact_batch, time_of_contact_with,
};
use d2m_interval::Interval;
use d2m_motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Keyframes, OutsideDomain, Pose, Retimed, Span,
    Spline, SplineDegree,
};
use d2m_testing::Bounded;
use d2m_world::{Body, BodyId, FirstContact, PlannedMotion, SharedMotion, World, WorldError};
use glam::{DQuat, DVec3};
use std::sync::Arc;

fn cube() -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()))
}

/// One unit along x, over the times from 0 to 1.
fn motions() -> Vec<SharedMotion> {
    let pose = |x: f64| Pose { translation: DVec3::X * x, rotation: DQuat::IDENTITY, at: DVec3::ZERO };
    let poses = [0.0, 0.5, 1.0].map(|t| (t, pose(t)));
    let value = JointValue::try_pieces(vec![0.0, 1.0], vec![vec![0.0, 1.0]]).unwrap();
    let joint = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, JointKind::Prismatic { axis: DVec3::X, value });
    let flight = ConstantTwist::REST.with_linear_velocity(DVec3::X);
    vec![
        Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap()),
        Arc::new(Spline::try_through(&poses, SplineDegree::Cubic).unwrap()),
        Arc::new(Chain::try_new(vec![joint.unwrap()]).unwrap()),
        Arc::new(Retimed::try_new(Bounded(flight, Interval::new(0.0, 1.0)), 1.0, 0.0).unwrap()),
        Arc::new(Bounded(flight, Interval::new(0.0, 1.0))),
    ]
}

fn window(start: f64, end: f64) -> Window {
    Window::try_new(start, end).unwrap()
}

fn named(body: BodyId, from: f64, to: f64) -> WorldError {
    WorldError::OutsideMotion { body, outside: OutsideDomain { start: 0.0, end: 1.0, from, to } }
}

/// A wall that the motions do not reach within their times, and one that they would meet at once after.
fn world(motion: &SharedMotion) -> (World, BodyId) {
    let mut world = World::new(QueryOptions::default());
    world.add(Body::new(cube(), ConstantTwist::REST.with_position(DVec3::X * 2.25)));
    let id = world.add(Body::with_shared(cube(), Arc::clone(motion)));
    (world, id)
}

#[test]
fn no_query_of_a_world_goes_past_a_motion() {
    let near = ProximityOptions::new(0.1);
    for motion in motions() {
        for (from, to) in [(0.0, 10.0), (-1.0, 0.5), (0.0, 1.0_f64.next_up()), (7.0, 9.0)] {
            let beyond = window(from, to);
            let (mut world, id) = world(&motion);
            let error = named(id, from, to);
            assert_eq!(world.first_contact(beyond), Err(error));
            assert_eq!(world.contacts(beyond), Err(error));
            assert_eq!(world.candidates(beyond), Err(error));
            let plan = [PlannedMotion { body: id, motion: Arc::clone(&motion) }];
            assert_eq!(world.first_contact_of(&plan, beyond), Err(error));
            assert!(error.to_string().contains(&format!("window from {from:?} to {to:?}")), "{error}");
            // Within the times everything is answered, before and after.
            assert_eq!(world.first_contact(Window::UNIT), Ok(FirstContact::Separated));
            assert_eq!(world.first_contact_of(&plan, Window::UNIT), Ok(FirstContact::Separated));
            assert_eq!(world.first_contact(beyond), Err(error));
            assert_eq!(world.first_contact_of(&plan, beyond), Err(error));
            assert_eq!(world.contacts(Window::UNIT), Ok(Vec::new()));
        }
        let (world, id) = world(&motion);
        assert_eq!(world.proximities(1.5, &near), Err(named(id, 1.5, 1.5)));
        assert_eq!(world.proximities(1.0, &near), Ok(Vec::new()));
        assert!(matches!(world.proximities(f64::NAN, &near), Err(WorldError::OutsideMotion { .. })));
    }
}

/// Boxes are kept for a longer span than a later query is about: a new motion need not cover all of that.
#[test]
fn new_motions_are_held_against_the_window_of_the_query() {
    for motion in motions() {
        let mut world = World::new(QueryOptions::default());
        world.add(Body::new(cube(), ConstantTwist::REST.with_position(DVec3::X * 1.6)));
        let id = world.add(Body::new(cube(), ConstantTwist::REST.with_position(DVec3::Y * 9.0)));
        assert_eq!(world.first_contact(window(0.0, 10.0)), Ok(FirstContact::Separated));
        world.set_shared_motion(id, Arc::clone(&motion));
        assert_eq!(world.first_contact(window(0.0, 10.0)), Err(named(id, 0.0, 10.0)));
        for _ in 0..2 {
            let found = world.first_contact(Window::UNIT).unwrap();
            let FirstContact::Contact { contact, .. } = found else { panic!("{found:?}") };
            assert!((contact.time_lo - 0.6).abs() < 1e-6, "{contact:?}");
        }
        // The same without the failure in between.
        let mut world = World::new(QueryOptions::default());
        world.add(Body::new(cube(), ConstantTwist::REST.with_position(DVec3::X * 1.6)));
        let id = world.add(Body::new(cube(), ConstantTwist::REST.with_position(DVec3::Y * 9.0)));
        assert_eq!(world.first_contact(window(0.0, 10.0)), Ok(FirstContact::Separated));
        world.set_shared_motion(id, Arc::clone(&motion));
        let found = world.first_contact(Window::UNIT).unwrap();
        assert!(matches!(found, FirstContact::Contact { .. }), "{found:?}");
        assert_eq!(world.contacts(Window::UNIT).unwrap().len(), 1);
        let plan = [PlannedMotion { body: id, motion: Arc::clone(&motion) }];
        assert_eq!(world.first_contact_of(&plan, window(0.5, 1.5)), Err(named(id, 0.5, 1.5)));
    }
}

#[test]
fn no_pair_query_goes_past_a_motion() {
    let (tree, rest) = (cube(), ConstantTwist::REST.with_position(DVec3::X * 2.25));
    for motion in motions() {
        let (a, b) = (Moving::new(&*tree, &rest), Moving::new(&*tree, &*motion));
        for mode in [Mode::Accurate, Mode::Capoeira, Mode::Exists] {
            let options = QueryOptions::default().with_mode(mode);
            let beyond = window(0.0, 2.0);
            let outside = OutsideDomain { start: 0.0, end: 1.0, from: 0.0, to: 2.0 };
            let error = QueryError::OutsideMotion { body: 1, outside };
            assert_eq!(time_of_contact(a, b, beyond, &options), Err(error));
            let mut cache = PairCache::new();
            for _ in 0..2 {
                assert_eq!(time_of_contact_with(a, b, beyond, &options, &mut cache), Err(error));
                assert_eq!(contact_exists(a, b, beyond, &options, &mut cache), Err(error));
                assert!(
                    time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap().is_separated()
                );
            }
            let batch = time_of_contact_batch(&[(a, b), (a, a)], beyond, &options);
            assert_eq!(batch[0], Err(error));
            assert!(batch[1].is_ok());
        }
    }
}
