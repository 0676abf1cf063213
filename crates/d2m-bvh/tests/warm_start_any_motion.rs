//! Caches and `contact_exists` for motions whose twists are not constant: the answers are those without a cache, bit by bit, and most of
//! those that find nothing need no search.

use d2m_bvh::{
    Evidence, MeshTree, Moving, PairCache, QueryOptions, Solid, StartState, TimeOfContact, TriMesh, Window,
    contact_exists, time_of_contact, time_of_contact_counted, time_of_contact_with,
};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{Chain, ConstantTwist, Joint, JointKind, JointValue, RigidMotion};
use d2m_testing::{Blurred, Draw, KnuthRandom, Opaque, Surface};
use glam::{DQuat, DVec3};

fn torus(rings: u32, sides: u32) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, 0.3).into_mesh(TriMesh::try_new))
}

fn value(coefficients: &[f64]) -> JointValue {
    JointValue::try_polynomial(coefficients.to_vec()).unwrap()
}

fn revolute(position: DVec3, axis: DVec3, coefficients: &[f64]) -> Joint {
    let kind = JointKind::Revolute { axis, value: value(coefficients) };
    Joint::try_new(position, DQuat::IDENTITY, kind).unwrap()
}

fn prismatic(axis: DVec3, coefficients: &[f64]) -> Joint {
    let kind = JointKind::Prismatic { axis, value: value(coefficients) };
    Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()
}

/// The body at the end of an arm passes another one, faster and faster, `away` from its middle.
fn passing(random: &mut KnuthRandom, away: f64, bend: f64) -> Chain {
    let jitter = 1e-3 * random.signed();
    Chain::try_new(vec![
        prismatic(DVec3::X, &[-2.0, 4.0, bend]),
        prismatic(DVec3::Z, &[away, jitter, 0.3 * bend]),
        revolute(DVec3::ZERO, DVec3::new(0.3, 1.0, 0.2), &[0.3, 0.4, bend]),
    ])
    .unwrap()
}

/// The answer of a query, and whether there was a search.
fn searched<T>(cache: &mut PairCache, ask: impl FnOnce(&mut PairCache) -> T) -> (T, bool) {
    let before = cache.work();
    (ask(cache), cache.work() != before)
}

#[test]
fn no_cache_changes_an_answer_of_any_motion() {
    let mut random = KnuthRandom(44);
    let trees = [torus(24, 10), torus(20, 8)];
    let rest = ConstantTwist::REST;
    let (mut free, mut saved, mut met) = (0, 0, 0);
    for round in 0..12 {
        let options = QueryOptions::default()
            .with_solid([Solid::Filled, Solid::Surface][round % 2])
            .with_min_separation([0.0, 0.05][round / 2 % 2]);
        let bend = [0.0, 0.02, -0.1][round % 3];
        let (mut cache, mut exists, mut stale) = (PairCache::new(), PairCache::new(), PairCache::new());
        stale.remember([3, 5]);
        for step in 0..40 {
            let away = 1.5 - f64::from(step) * [0.002, 0.03][round / 3 % 2];
            let motion = passing(&mut random, away, bend);
            // Every third motion gives nothing but its enclosures.
            let hidden = Opaque(passing(&mut random, away, bend));
            let motion: &dyn RigidMotion = if round % 3 == 2 && step % 8 == 0 { &hidden } else { &motion };
            let [a, b] = [Moving::new(&trees[0], motion), Moving::new(&trees[1], &rest)];
            let wanted = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            let (got, by_search) = searched(&mut cache, |cache| {
                time_of_contact_with(a, b, Window::UNIT, &options, cache).unwrap()
            });
            assert_eq!(got, wanted, "round {round}, step {step}");
            for cache in [&mut exists, &mut stale, &mut PairCache::new()] {
                let is_met = contact_exists(a, b, Window::UNIT, &options, cache).unwrap();
                assert_eq!(is_met, Some(wanted.contact().is_some()), "round {round}, step {step}");
            }
            match wanted {
                TimeOfContact::Separated => (free, saved) = (free + 1, saved + u32::from(!by_search)),
                TimeOfContact::Contact(_) => met += 1,
                TimeOfContact::Undecided { .. } => panic!("round {round}, step {step}"),
            }
        }
    }
    assert!(free > 200 && saved > free / 2 && met > 60, "{free} {saved} {met}");
}

/// Whether there is a contact takes less than its time: one search, and steps to where the two triangles are near in truth.
#[test]
fn existence_takes_less_than_the_time() {
    let mut random = KnuthRandom(45);
    let trees = [torus(24, 10), torus(20, 8)];
    let rest = ConstantTwist::REST;
    let options = QueryOptions::default();
    let (mut whole, mut short) = (0, 0);
    for _ in 0..20 {
        let motion = passing(&mut random, 0.4, 1.5);
        let [a, b] = [Moving::new(&trees[0], &motion), Moving::new(&trees[1], &rest)];
        let asked = time_of_contact_counted(a, b, Window::UNIT, &options).unwrap();
        assert!(asked.answer.contact().is_some());
        whole += asked.work.work();
        let mut cache = PairCache::new();
        assert_eq!(contact_exists(a, b, Window::UNIT, &options, &mut cache), Ok(Some(true)));
        short += cache.work();
        // The same triangles meet again: no search at all.
        let (again, by_search) =
            searched(&mut cache, |cache| contact_exists(a, b, Window::UNIT, &options, cache));
        assert!(again == Ok(Some(true)) && !by_search);
    }
    assert!(4 * short < 3 * whole, "{short} of {whole}");
}

/// Bodies that overlap at the start cross in truth, not only as fitted.
#[test]
fn true_crossings_are_evidence() {
    let tree = torus(16, 8);
    let moving = Chain::try_new(vec![
        prismatic(DVec3::X, &[0.25, 1.0, 3.0]),
        revolute(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.2), &[0.4, 1.0, 2.0]),
    ])
    .unwrap();
    let [a, b] = [Moving::new(&tree, &moving as &dyn RigidMotion), Moving::new(&tree, &ConstantTwist::REST)];
    let options = QueryOptions::default().with_solid(Solid::Surface);
    let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
    let contact = answer.contact().unwrap();
    assert_eq!((contact.start, contact.evidence), (StartState::Overlapping, Evidence::Crossing));
}

/// Where enclosures allow a contact that truth does not have, nothing is claimed: not by two triangles that met in an earlier
/// query, nor by the fitted motions, which do meet.
#[test]
fn wide_enclosures_prove_no_meeting() {
    let tree = torus(16, 8);
    let options = QueryOptions::default().with_solid(Solid::Surface);
    let rest = ConstantTwist::REST;
    // Comes down to where it touches.
    let falling = |height: f64| {
        ConstantTwist::REST.with_position(DVec3::Z * (height + 1.0)).with_linear_velocity(DVec3::NEG_Z)
    };
    let b = Moving::new(&tree, &rest);
    let touching = time_of_contact(Moving::new(&tree, &falling(0.2)), b, Window::UNIT, &options).unwrap();
    let height = 1.2 - touching.contact().unwrap().time_lo;
    for vague in [1e-2, 1e-4, 1e-6] {
        let mut cache = PairCache::new();
        let low = falling(height - vague);
        assert_eq!(
            contact_exists(Moving::new(&tree, &low), b, Window::UNIT, &options, &mut cache),
            Ok(Some(true))
        );
        // Enclosed up to twice a distance downwards; the true motion is at the upper end of that.
        let below = IntervalVec3::new(Interval::ZERO, Interval::ZERO, Interval::new(-2.0 * vague, 0.0));
        let high = Blurred::new(falling(height + 0.5 * vague), below);
        for cache in [&mut cache, &mut PairCache::new()] {
            let answer = contact_exists(Moving::new(&tree, &high), b, Window::UNIT, &options, cache);
            assert_eq!(answer, Ok(None), "{vague}");
        }
    }
}

/// A body that comes down at both ends of the window, while the twist of the middle stays up: what the cache knows of that twist
/// says nothing of the ends.
#[test]
fn what_the_fitted_twist_leaves_out_counts() {
    let tree = torus(24, 10);
    let rest = ConstantTwist::REST;
    let options = QueryOptions::default();
    let mut cache = PairCache::new();
    let (mut free, mut met) = (0, 0);
    for step in 0..80 {
        let height = 1.0 - 0.004 * f64::from(step);
        // h − 0.4 (t − ½)².
        let motion = Chain::try_new(vec![
            prismatic(DVec3::Z, &[height - 0.1, 0.4, -0.4]),
            prismatic(DVec3::X, &[-0.1, 0.2]),
        ])
        .unwrap();
        let [a, b] = [Moving::new(&tree, &motion as &dyn RigidMotion), Moving::new(&tree, &rest)];
        let wanted = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let got = time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap();
        assert_eq!(got, wanted, "{step}");
        if wanted.is_separated() { free += 1 } else { met += 1 }
    }
    assert!(free > 10 && met > 10, "{free} {met}");
}
