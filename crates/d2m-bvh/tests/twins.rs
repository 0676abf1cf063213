//! The same scene by two ways: whatever is promised of the answer holds by both, and they agree.

use d2m_bvh::{
    Contact, MeshTree, Mode, Moving, PairCache, Posed, QueryOptions, Solid, TimeOfContact, TriMesh, Window,
    contact_exists, distance, time_of_contact, time_of_contact_batch, time_of_contact_with,
};
use d2m_feature::triangle_distance;
use d2m_motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Keyframes, Pose, RigidMotion, Span, Spline,
    SplineDegree,
};
use d2m_testing::{Draw, KnuthRandom, Opaque, Surface};
use glam::{DQuat, DVec3};

fn tree(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> MeshTree {
    MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap())
}

fn cube(half: f64) -> MeshTree {
    MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
}

fn random_pose(random: &mut KnuthRandom, spread: f64) -> Pose {
    let rotation = DQuat::from_scaled_axis(random.vector());
    Pose { translation: random.vector() * spread, rotation, at: DVec3::ZERO }
}

/// Motions from one side of the origin to the other, of every kind, over [0, 1].
fn motions(random: &mut KnuthRandom) -> Vec<Box<dyn RigidMotion + Send>> {
    let from = random.vector().normalize() * 4.0;
    let middle = random_pose(random, 0.3);
    let pose = |random: &mut KnuthRandom, translation| Pose { translation, ..random_pose(random, 0.0) };
    let frames = [(0.0, pose(random, from)), (0.5, middle), (1.0, pose(random, -from))];
    let twist = ConstantTwist::REST
        .with_position(from + middle.translation)
        .with_linear_velocity(-2.0 * from)
        .with_angular_velocity(random.vector() * 2.0);
    let turn = JointValue::try_polynomial(vec![0.3, 2.0, -1.5]).unwrap();
    let slide = JointValue::try_polynomial(vec![-4.0, 6.0, 2.0]).unwrap();
    let joint = |kind| Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap();
    let chain = Chain::try_new(vec![
        joint(JointKind::Prismatic { axis: from, value: slide }),
        joint(JointKind::Revolute { axis: random.vector(), value: turn }),
    ]);
    let mut all: Vec<Box<dyn RigidMotion + Send>> = vec![Box::new(twist), Box::new(Opaque(twist))];
    all.push(Box::new(chain.unwrap()));
    if let Ok(spline) = Spline::try_through(&frames, SplineDegree::Cubic) {
        all.push(Box::new(spline));
    }
    if let Ok(spline) = Spline::try_through(&frames, SplineDegree::Quintic) {
        all.push(Box::new(Opaque(spline)));
    }
    if let Ok(keyframes) = Keyframes::try_new(&frames, Span::Screw) {
        all.push(Box::new(keyframes.clone()));
        all.push(Box::new(Opaque(keyframes)));
    }
    all
}

/// The distance of the reported triangles at `time_lo`, by plain arithmetic.
fn separation_of_triangles(trees: [&MeshTree; 2], motions: [&dyn RigidMotion; 2], contact: &Contact) -> f64 {
    let corners = |k: usize, triangle: u32| {
        let pose = motions[k].pose_and_twist(contact.time_lo).0;
        trees[k].mesh().corners(triangle as usize).map(|p| pose.transform_point(p))
    };
    triangle_distance(&corners(0, contact.triangle_a), &corners(1, contact.triangle_b)).upper
}

/// `Contact::separation` is the distance of the reported triangles as the motions themselves place them, not as a twist that is near
/// them does; an early stop leaves no more above the minimum separation than it says.
#[test]
fn separations_are_those_of_the_true_motions() {
    let mut random = KnuthRandom(5);
    let cube = cube(0.5);
    let rest = ConstantTwist::REST;
    // Sum of the radii of the boxes of two triangles.
    let boxes = 2.0 * 0.5_f64.sqrt();
    let mut met = [0; 2];
    for round in 0..120 {
        let separation = [0.0, 0.0, 0.25, 3.0][round % 4];
        let tolerance = [1e-2, 1e-4, 1e-8][round % 3];
        for motion in motions(&mut random) {
            let (a, b) = (Moving::new(&cube, &*motion), Moving::new(&cube, &rest));
            for (k, mode) in [Mode::Accurate, Mode::Capoeira].into_iter().enumerate() {
                let options = QueryOptions::default()
                    .with_tolerance(tolerance)
                    .with_min_separation(separation)
                    .with_mode(mode);
                let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
                let Some(contact) = answer.contact() else { continue };
                met[k] += 1;
                let true_one = separation_of_triangles([&cube, &cube], [&*motion, &rest], contact);
                let off = (contact.separation - true_one).abs();
                assert!(off <= 1e-12, "round {round}: {off:e} off {contact:?}");
                let most = match mode {
                    Mode::Capoeira => (boxes * (1.0 + 1.0 / 15.0)).max(3.3 * contact.tolerance),
                    _ => 3.3 * contact.tolerance,
                };
                assert!(
                    contact.separation - separation <= most + 1e-12,
                    "round {round} {mode:?}: {contact:?}"
                );
            }
        }
    }
    assert!(met.iter().all(|&met| met > 300), "{met:?}");
}

/// Paths that pass by at a distance which is well above the minimum separation are no contacts of an early stop either, whatever that is.
#[test]
fn early_stops_count_above_the_minimum_separation() {
    let half = 0.05;
    let small = cube(half);
    let boxes = 2.0 * half * 2.0_f64.sqrt();
    for (separation, pass) in [(0.0, 0.3), (0.0, 0.2), (1.0, 1.2), (1.0, 1.3), (10.0, 10.2), (10.0, 12.5)] {
        let scale = 1.0 + pass;
        let pose = |(t, dy): (f64, f64)| {
            let translation = DVec3::new(3.0 * t * scale, pass + 2.0 * half + 3.0 * dy * scale, 0.0);
            (t, Pose { translation, ..Pose::IDENTITY })
        };
        let frames = [(-1.0, 0.35), (-0.5, 0.08), (0.0, 0.0), (0.5, 0.08), (1.0, 0.35)].map(pose);
        let spline = Spline::try_through(&frames, SplineDegree::Cubic).unwrap();
        let options = QueryOptions::default().with_min_separation(separation).with_mode(Mode::Capoeira);
        let (a, b) = (Moving::new(&small, &spline), Moving::new(&small, &ConstantTwist::REST));
        let answer = time_of_contact(a, b, Window::try_new(-1.0, 1.0).unwrap(), &options).unwrap();
        assert!(pass - separation > boxes * (1.0 + 1.0 / 15.0));
        assert!(answer.is_separated(), "{separation} {pass}: {answer:?}");
    }
}

/// A batch, a cache that is cold or warm, swapped or not, and one query after the other.
#[test]
fn batches_and_caches_change_nothing() {
    let mut random = KnuthRandom(11);
    let (ring, cube) = (MeshTree::new(Surface::cone(24, 0.7, 0.9).into_mesh(TriMesh::try_new)), cube(0.5));
    let rest = ConstantTwist::REST;
    let mut met = 0;
    for round in 0..30 {
        let moved = motions(&mut random);
        let pairs: Vec<_> =
            moved.iter().map(|motion| (Moving::new(&ring, &**motion), Moving::new(&cube, &rest))).collect();
        let options = QueryOptions::default().with_min_separation([0.0, 0.4][round % 2]);
        let batch = time_of_contact_batch(&pairs, Window::UNIT, &options);
        let mut warm = PairCache::new();
        for (&(a, b), answer) in pairs.iter().zip(batch) {
            let one = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            assert_eq!(answer, Ok(one));
            for _ in 0..3 {
                let cached = time_of_contact_with(a, b, Window::UNIT, &options, &mut warm);
                assert_eq!(cached, Ok(one));
                let exists = contact_exists(a, b, Window::UNIT, &options, &mut warm).unwrap();
                let cold = contact_exists(a, b, Window::UNIT, &options, &mut PairCache::new()).unwrap();
                assert_eq!(exists, cold, "round {round}");
                assert_eq!(exists, Some(!one.is_separated()), "round {round}: {one:?}");
            }
            met += u32::from(!one.is_separated());
        }
    }
    assert!(met > 100, "{met}");
}

/// Two fans, of which all triangles share an apex and one more is nearer to the other fan than the apex by parts of the tolerance: what a
/// plane parts and what a cache remembers is the same distance.
#[test]
fn crowds_and_caches_prove_the_same() {
    let n = 1000_u32;
    let fan = |up: f64, tip: Option<DVec3>| {
        let rim = (0..n).map(|i| {
            let angle = f64::from(i) * core::f64::consts::TAU / f64::from(n);
            DVec3::new(angle.cos(), angle.sin(), up)
        });
        let mut vertices: Vec<_> = std::iter::once(DVec3::ZERO).chain(rim).collect();
        let mut triangles: Vec<_> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
        if let Some(tip) = tip {
            let first = vertices.len() as u32;
            vertices.extend(
                [DVec3::ZERO, DVec3::new(0.05, 0.02, -0.5), DVec3::new(0.05, -0.02, -0.5)].map(|p| tip + p),
            );
            triangles.push([first, first + 1, first + 2]);
        }
        tree(vertices, triangles)
    };
    let other = fan(1.0, None);
    let rest = ConstantTwist::REST;
    let mut answers = [0; 2];
    for tolerance in [1e-3, 1e-5, 1e-8] {
        for part in [0.3, 0.4, 0.5, 0.7, 0.9, 1.1, 1.5] {
            for height in [3.0, 10.0] {
                let a = fan(-1.0, Some(DVec3::new(0.02, 0.0, (height - part) * tolerance)));
                let passing = |height: f64| {
                    let place = DVec3::new(-0.5, 0.0, height * tolerance);
                    ConstantTwist::REST.with_position(place).with_linear_velocity(DVec3::X)
                };
                let (far, near) = (passing(height), passing(height - 0.5 * part));
                let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(tolerance);
                let exists = |motion: &ConstantTwist, cache: &mut PairCache| {
                    let (a, b) = (Moving::new(&a, &rest), Moving::new(&other, motion));
                    contact_exists(a, b, Window::UNIT, &options, cache).unwrap()
                };
                let cold = exists(&far, &mut PairCache::new());
                let mut warm = PairCache::new();
                let seeded = exists(&near, &mut warm);
                assert_eq!(exists(&far, &mut warm), cold, "{tolerance:e} {part} {height} {seeded:?}");
                answers[usize::from(cold == Some(true))] += 1;
            }
        }
    }
    assert!(answers.iter().all(|&count| count > 3), "{answers:?}");
}

/// The minimum separation as an option, and as the distance of the bodies at rest at the reported time; the window as one, and in two
/// parts that meet at any time, joints among them; the first body's view and the second's.
#[test]
fn windows_in_parts_and_bodies_swapped_agree() {
    let mut random = KnuthRandom(23);
    let (big, small) = (cube(0.5), cube(0.3));
    let rest = ConstantTwist::REST;
    let mut met = 0;
    for round in 0..40 {
        let separation = [0.0, 0.3][round % 2];
        let options = QueryOptions::default().with_min_separation(separation).with_tolerance(1e-9);
        for motion in motions(&mut random) {
            let (a, b) = (Moving::new(&small, &*motion), Moving::new(&big, &rest));
            let whole = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            let swapped = time_of_contact(b, a, Window::UNIT, &options).unwrap();
            assert_eq!(whole.is_separated(), swapped.is_separated(), "round {round}");
            for cut in [0.5, 0.5_f64.next_down(), 0.5_f64.next_up(), random.unit()] {
                let part = |start, end| {
                    let window = Window::try_new(start, end).unwrap();
                    time_of_contact(a, b, window, &options).unwrap()
                };
                let first = match part(0.0, cut) {
                    TimeOfContact::Separated => part(cut, 1.0),
                    met => met,
                };
                match (whole.contact(), first.contact()) {
                    (Some(x), Some(y)) => {
                        // Brackets of one contact, each within the tolerance of the other's.
                        assert!(
                            x.time_lo <= y.time_hi.max(y.time_lo) + 1e-7,
                            "round {round} {cut}: {x:?} {y:?}"
                        );
                        assert!(
                            y.time_lo <= x.time_hi.max(x.time_lo) + 1e-7,
                            "round {round} {cut}: {x:?} {y:?}"
                        );
                    }
                    (None, None) => {}
                    (x, y) => panic!("round {round} {cut}: {x:?} {y:?}"),
                }
            }
            if let Some(contact) = whole.contact() {
                met += 1;
                let pose = motion.pose_and_twist(contact.time_lo).0;
                let apart = distance(Posed::new(&small, pose), Posed::at_rest(&big), Solid::Filled).unwrap();
                assert!(apart.upper >= separation, "round {round}: {contact:?}");
                assert!(apart.lower <= contact.separation + 1e-12, "round {round}: {contact:?}");
            }
        }
    }
    assert!(met > 100, "{met}");
}
