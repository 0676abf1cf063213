//! A cache changes no bit of any answer, whatever it holds; and it does save searches.

use d2m_bvh::{
    Budget, MeshTree, Mode, Moving, PairCache, QueryOptions, Solid, TimeOfContact, TriMesh, Window,
    contact_exists, time_of_contact, time_of_contact_with,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion, ScrewMotion, Twist};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

fn pick(random: &mut KnuthRandom, count: usize) -> usize {
    (random.signed().abs() * count as f64) as usize % count
}

fn torus(rings: u32, sides: u32, tube: f64) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, tube).into_mesh(TriMesh::try_new))
}

/// The motion of a step of a sequence.
#[derive(Clone, Copy)]
enum StepMotion {
    Linear(ConstantTwist),
    Screw(ScrewMotion),
}

impl StepMotion {
    fn motion(&self) -> &dyn RigidMotion {
        match self {
            Self::Linear(motion) => motion,
            Self::Screw(motion) => motion,
        }
    }
}

/// The same answer from caches that are empty, from the sequence itself, from another one, and full of nonsense.
#[test]
fn no_cache_changes_a_bit() {
    let mut random = KnuthRandom(1);
    let trees = [torus(12, 6, 0.3), torus(20, 8, 0.2), torus(5, 3, 0.45)];
    let mut stale = PairCache::new();
    let (mut contacts, mut separated, mut undecided) = (0, 0, 0);
    for sequence in 0..160 {
        let (a, b) = (&trees[pick(&mut random, 3)], &trees[pick(&mut random, 3)]);
        let spin = [0.0, 0.5, 8.0][sequence % 3];
        let place = random.vector().normalize() * (1.5 + 2.5 * random.signed().abs());
        let speed = [0.01, 1.0, 4.0][pick(&mut random, 3)];
        let (towards, turn) =
            (-place.normalize() * speed + random.vector() * 0.5 * speed, random.vector() * spin);
        let q = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.2);
        let change = 10f64.powi(-1 - pick(&mut random, 5) as i32);
        let options = QueryOptions::default()
            .with_solid([Solid::Filled, Solid::Surface][pick(&mut random, 2)])
            .with_mode([Mode::Accurate, Mode::Accurate, Mode::Exists, Mode::Capoeira][pick(&mut random, 4)])
            .with_min_separation([0.0, 0.0, 0.05][pick(&mut random, 3)])
            .with_tolerance([1e-10, 1e-6, 1e-3][pick(&mut random, 3)]);
        let budget = [None, None, Some(40), Some(400)][pick(&mut random, 4)];
        let options = match budget {
            Some(tests) => options.with_budget(Budget::UNLIMITED.with_node_tests(tests)),
            None => options,
        };
        let screws = sequence % 4 == 3;
        let (mut warm, mut exists) = (PairCache::new(), PairCache::new());
        for step in 0..24 {
            // Mostly small changes, now and then a jump.
            let drift = if step == 15 { 1.0 } else { change };
            let x = place + (random.vector() + towards * f64::from(step)) * drift;
            let course = if screws {
                let pose = Pose { rotation: q.normalize(), translation: x, at: DVec3::ZERO };
                let twist = Twist { linear: towards, angular: turn + random.vector() * change };
                StepMotion::Screw(ScrewMotion::try_from_twist(pose, twist, 0.0).unwrap())
            } else {
                let v = towards + random.vector() * change;
                StepMotion::Linear(
                    ConstantTwist::try_new(x, q, v, turn + random.vector() * change * spin).unwrap(),
                )
            };
            let other = ConstantTwist::REST.with_angular_velocity(random.vector() * change);
            let window = Window::try_new(0.0, 1.0 + f64::from(step % 2) * 1e-3).unwrap();
            let (a, b) = (Moving::new(a, course.motion()), Moving::new(b, &other));
            let cold = time_of_contact(a, b, window, &options).unwrap();
            let mut nonsense = PairCache::new();
            nonsense.remember([pick(&mut random, 400) as u32, u32::MAX >> pick(&mut random, 32)]);
            let mut empty = PairCache::new();
            for cache in [&mut warm, &mut stale, &mut nonsense, &mut empty] {
                let answer = time_of_contact_with(a, b, window, &options, cache).unwrap();
                assert_eq!(answer, cold, "sequence {sequence}, step {step}");
            }
            let asked = options.with_mode(Mode::Exists);
            let yes = match time_of_contact(a, b, window, &asked).unwrap() {
                TimeOfContact::Contact(_) => Some(true),
                TimeOfContact::Separated => Some(false),
                TimeOfContact::Undecided { .. } => None,
            };
            for cache in [&mut exists, &mut warm, &mut stale, &mut nonsense, &mut PairCache::new()] {
                let answer = contact_exists(a, b, window, &options, cache).unwrap();
                assert_eq!(answer, yes, "sequence {sequence}, step {step}");
            }
            match cold {
                TimeOfContact::Contact(_) => contacts += 1,
                TimeOfContact::Separated => separated += 1,
                TimeOfContact::Undecided { .. } => undecided += 1,
            }
        }
    }
    assert!(contacts > 500 && separated > 500 && undecided > 100, "{contacts} {separated} {undecided}");
}

/// Bodies that are deformed are other bodies: what was proven before does not count.
#[test]
fn a_refit_is_noticed() {
    let (mut a, b) = (torus(12, 6, 0.3), torus(12, 6, 0.3));
    let motion = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::X * 0.1);
    let mut cache = PairCache::new();
    let ask = |a: &MeshTree, cache: &mut PairCache| {
        let options = QueryOptions::default();
        let (a, b) = (Moving::new(a, &motion), Moving::new(&b, &ConstantTwist::REST));
        time_of_contact_with(a, b, Window::UNIT, &options, cache).unwrap()
    };
    for _ in 0..5 {
        assert!(ask(&a, &mut cache).is_separated());
    }
    let tall = a.mesh().vertices().iter().map(|p| *p * DVec3::new(1.0, 1.0, 9.0)).collect();
    a.refit(tall).unwrap();
    assert!(ask(&a, &mut cache).contact().is_some());
}

/// What the cache is for: few of the queries of a slow sequence search at all.
#[test]
fn coherent_queries_are_answered_without_a_search() {
    let (a, b) = (torus(40, 20, 0.3), torus(40, 20, 0.2));
    let options = QueryOptions::default();
    let searches = |height: f64, drop: f64, exists: bool| {
        let mut cache = PairCache::new();
        let mut searches = 0;
        for step in 0..200 {
            let x = DVec3::new(0.7, 0.0, height - drop * f64::from(step));
            let falling = ConstantTwist::REST
                .with_position(x)
                .with_linear_velocity(DVec3::new(0.0, 0.2, -0.5))
                .with_angular_velocity(DVec3::new(0.1, 0.2, 0.3));
            let (a, b) = (Moving::new(&a, &falling), Moving::new(&b, &ConstantTwist::REST));
            let before = cache.work();
            if exists {
                contact_exists(a, b, Window::UNIT, &options, &mut cache).unwrap();
            } else {
                let _ = time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap();
            }
            searches += u32::from(cache.work() != before);
        }
        searches
    };
    assert!(searches(1.8, 1e-4, false) < 30, "no contact");
    assert!(searches(0.6, 1e-4, true) < 10, "a contact each time");
}
