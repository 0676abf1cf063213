//! Motions whose velocities jump: no expansion about the start of a span holds beyond a joint.

use d2m_bvh::{MeshTree, Mode, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact};
use d2m_interval::Interval;
use d2m_motion::{ConstantTwist, Keyframes, Pose, RigidMotion, Span};
use d2m_paper::{
    BodyOverDomain, PaperOptions, RelativeMotion, Sphere, SphereTree, edge_edge, point_triangle,
    sphere_sphere, test_sphere_pair,
};
use d2m_root::RootSearch;
use d2m_testing::{Draw, Random, Surface};
use glam::{DQuat, DVec3};

/// Poses at random places, at 0, 0.3, 0.7 and 1.
fn zigzag(random: &mut Random, reach: f64, turns: bool) -> Keyframes {
    let poses = [0.0, 0.3, 0.7, 1.0].map(|time| {
        let rotation = if turns { random.quaternion() } else { DQuat::IDENTITY };
        (time, Pose { translation: random.vector() * reach, rotation, at: DVec3::ZERO })
    });
    Keyframes::try_new(&poses, Span::Linear).unwrap()
}

/// A quarter of these were said to stay apart: the body went on as it had begun.
#[test]
fn bodies_meet_after_a_joint() {
    let mut random = Random::new(7);
    let mesh: TriMesh = Surface::cube(0.5).into_mesh(TriMesh::try_new);
    let (reference, boxes) = (SphereTree::new(mesh.clone()), MeshTree::new(mesh));
    let (options, mut met, mut apart) = (QueryOptions::default(), 0, 0);
    for case in 0..200 {
        let motion = zigzag(&mut random, 3.0, case % 2 == 0);
        let found = time_of_contact(
            Moving::new(&boxes, &motion),
            Moving::new(&boxes, &ConstantTwist::REST),
            Window::UNIT,
            &options,
        )
        .unwrap();
        for mode in [Mode::Accurate, Mode::Capoeira] {
            let own = d2m_paper::time_of_contact(
                d2m_paper::Moving::new(&reference, &motion),
                d2m_paper::Moving::new(&reference, &ConstantTwist::REST),
                Window::UNIT,
                &options.with_mode(mode),
            )
            .unwrap();
            match (&own, &found) {
                (TimeOfContact::Contact(own), TimeOfContact::Contact(found)) => {
                    assert!(own.time_lo <= found.time_hi, "{case} {mode:?}: {own:?} {found:?}");
                    let is_near = mode == Mode::Capoeira || own.time_hi >= found.time_lo - 1e-9;
                    assert!(is_near, "{case}: {own:?} {found:?}");
                    met += 1;
                }
                (TimeOfContact::Separated, TimeOfContact::Separated) => apart += 1,
                (TimeOfContact::Contact(_), TimeOfContact::Separated) if mode == Mode::Capoeira => {}
                _ => panic!("{case} {mode:?}: {own:?} {found:?}"),
            }
        }
    }
    assert!(met > 100 && apart > 20, "{met} {apart}");
}

/// What is found in all of the window is what is found in its first piece with a contact.
#[test]
fn features_meet_after_a_joint() {
    const ENDS: [f64; 4] = [0.0, 0.3, 0.7, 1.0];
    let mut random = Random::new(11);
    let options = PaperOptions::DEFAULT;
    let mut met = [0; 3];
    for case in 0..900 {
        let zigzag = zigzag(&mut random, 2.0, true);
        let motion = RelativeMotion::new(&zigzag, &ConstantTwist::REST);
        let [p, q, r, s, t] = [(); 5].map(|()| random.vector() * 1.5);
        let ball = |center: DVec3| Sphere { center, radius: 0.3 };
        let search = |kind: usize, window: Interval| match kind {
            0 => point_triangle(&motion, p, &[q, r, s], window, &options),
            1 => edge_edge(&motion, &[p, t], &[q, r], window, &options),
            _ => sphere_sphere(&motion, &ball(p), &ball(q), window, &options),
        };
        for (kind, count) in met.iter_mut().enumerate() {
            let piece = |k: usize| search(kind, Interval::new(ENDS[k], ENDS[k + 1]));
            let first = (0..3).map(piece).find(|found| *found != RootSearch::None);
            match (search(kind, Interval::UNIT), first) {
                (RootSearch::None, None) => {}
                (RootSearch::Bracket(whole), Some(RootSearch::Bracket(part))) => {
                    let is_same = whole.lo() <= part.hi() + 1e-9 && part.lo() - 1e-9 <= whole.hi();
                    assert!(is_same, "{case} {kind}: {whole} {part}");
                    *count += 1;
                }
                other => panic!("{case} {kind}: {other:?}"),
            }
        }
    }
    assert!(met.iter().all(|count| *count > 20), "{met:?}");
}

/// Spheres over a span with a joint: where they meet after it is not left out, though they part at the start.
#[test]
fn bodies_over_a_joint_are_where_they_are() {
    let at = |time: f64, x: f64| (time, Pose { translation: DVec3::X * x, ..Pose::IDENTITY });
    let back = Keyframes::try_new(&[at(0.0, 3.0), at(0.5, 4.0), at(1.0, 0.0)], Span::Linear).unwrap();
    let over = |motion: &dyn RigidMotion| {
        BodyOverDomain::new(motion, Interval::UNIT, DVec3::ZERO).sphere(DVec3::ZERO, 0.5)
    };
    let part = test_sphere_pair(&over(&back), &over(&ConstantTwist::REST), 0.0, Interval::UNIT);
    assert!(part.is_some_and(|part| part.contains(0.875)), "{part:?}");
    // Where one goes on smoothly, and the other has the joint.
    let along = ConstantTwist::REST.with_linear_velocity(DVec3::X);
    let part = test_sphere_pair(&over(&along), &over(&back), 0.0, Interval::UNIT);
    assert!(part.is_some_and(|part| part.contains(0.8)), "{part:?}");
}

/// Pieces that meet up to the rounding that is accepted of files: a sheet between their ends is not jumped over.
#[test]
fn nothing_is_jumped_over() {
    let corners = [DVec3::new(0.0, -1.0, -1.0), DVec3::new(0.0, 1.0, -1.0), DVec3::new(0.0, 0.0, 1.0)];
    let mesh = TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let sheet = SphereTree::new(mesh);
    for half in [4e-10, 1e-11, 1e-12] {
        let flight = |x: f64, v: f64, t: f64| {
            let flight = ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
            flight.with_reference_time(t)
        };
        let spans = vec![flight(-3.0, 3.0 - half, 0.0), flight(half, 3.0, 1.0)];
        let motion = Keyframes::try_from_spans(vec![0.0, 1.0, 2.0], spans).unwrap();
        let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(1e-13);
        let bodies = [&motion as &dyn RigidMotion, &ConstantTwist::REST]
            .map(|motion| d2m_paper::Moving::new(&sheet, motion));
        for [a, b] in [bodies, [bodies[1], bodies[0]]] {
            let window = Window::try_new(0.0, 2.0).unwrap();
            match d2m_paper::time_of_contact(a, b, window, &options).unwrap() {
                TimeOfContact::Contact(contact) => assert!(contact.time_lo <= 1.0, "{half:e}: {contact:?}"),
                TimeOfContact::Undecided { clear_until } => {
                    assert!(clear_until <= 1.0, "{half:e}: {clear_until}");
                }
                TimeOfContact::Separated => panic!("{half:e}: it was jumped over"),
            }
        }
    }
}
