//! What static queries promise wherever the frames of bodies and poses are, and when the bodies are exchanged.

use d2m_mesh::{MeshTree, Posed, Solid, StartState, TriMesh, distance};
use d2m_motion::Pose;
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// 2⁻⁵³.
const UNIT: f64 = 0.5 * f64::EPSILON;

fn tree(surface: Surface) -> MeshTree {
    MeshTree::new(surface.into_mesh(TriMesh::try_new))
}

fn rotation(random: &mut KnuthRandom) -> DQuat {
    DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), random.signed()).normalize()
}

/// The sum of the lengths that enter a distance.
fn lengths([a, b]: [Posed<'_>; 2]) -> f64 {
    let arm = |posed: Posed<'_>| posed.body.center().distance(posed.pose.at);
    let between = a.pose.translation.distance(b.pose.translation);
    a.body.radius() + b.body.radius() + arm(a) + arm(b) + between
}

/// Enclosures are as wide as documented, however far the meshes are from their frames' origins, the reference points from
/// the bodies, and both bodies from the origin of the world.
#[test]
fn enclosures_are_as_wide_as_the_lengths_that_enter() {
    let mut random = KnuthRandom(77);
    let (mut widest, mut widest_alike) = (0.0_f64, 0.0_f64);
    for round in 0..6000 {
        let far = [10.0, 1500.0, 1e6][round % 3];
        let size = [1.0, 0.01, 100.0][round / 3 % 3];
        let place = |random: &mut KnuthRandom, bit: usize| {
            if (round / 9) & bit == 0 { DVec3::ZERO } else { random.vector() * far }
        };
        let [origin, world, at] = [1, 2, 4].map(|bit| place(&mut random, bit));
        let [a, b] = [(); 2].map(|()| tree(Surface::soup((0..6).map(|_| random.vector() * size + origin))));
        let alike = round / 72 % 2 == 0;
        let first = rotation(&mut random);
        let second = if alike { first } else { rotation(&mut random) };
        let shift = random.vector() * 3.0 * size;
        // The point `origin` of A comes to `world`, that of B beside it.
        let pose = |rotation: DQuat, place: DVec3| Pose {
            rotation,
            translation: place - rotation * (origin - at),
            at,
        };
        let bodies = [Posed::new(&a, pose(first, world)), Posed::new(&b, pose(second, world + shift))];
        let found = distance(bodies[0], bodies[1], Solid::Surface).unwrap();
        if found.state == StartState::Apart {
            let width = (found.upper - found.lower) / (UNIT * lengths(bodies));
            widest = widest.max(width);
            widest_alike = if alike { widest_alike.max(width) } else { widest_alike };
        }
    }
    assert!(widest < 2200.0 && widest > 1000.0, "{widest}");
    assert!(widest_alike < 700.0 && widest_alike > 300.0, "{widest_alike}");
}

/// A vertex on a vertex, an edge or a face of the other body: exchanged, the bodies are not apart either, and what is proven of one
/// distance holds for the other. Where one order is judged touching, the other is, too.
#[test]
fn exchanged_bodies_differ_by_roundings_only() {
    let mut random = KnuthRandom(78);
    let (mut same, mut exchanged) = (0, 0);
    for round in 0..6000 {
        let [a, b] = [(); 2].map(|()| tree(Surface::tetrahedron([(); 4].map(|()| random.vector()))));
        let [first, second] = [(); 2].map(|()| rotation(&mut random));
        let [p, q, r] = b.mesh().corners(round / 4 % 4);
        let point = [p, p.lerp(q, 0.5), p * 0.5 + (q + r) * 0.25][round % 3];
        // Or apart by a few roundings.
        let gap = random.vector() * [0.0, 0.0, 1e-15, 1e-14, 1e-13, 1e-12][round % 6];
        let translation = second * point - first * a.mesh().vertices()[round % 4] + gap;
        let posed_a = Posed::new(&a, Pose { rotation: first, translation, at: DVec3::ZERO });
        let posed_b = Posed::new(&b, Pose { rotation: second, translation: DVec3::ZERO, at: DVec3::ZERO });
        let found = distance(posed_a, posed_b, Solid::Filled).unwrap();
        let back = distance(posed_b, posed_a, Solid::Filled).unwrap();
        let what = format!("{round}: {found:?} {back:?}");
        assert!(found.lower <= back.upper && back.lower <= found.upper, "{what}");
        let width = 2200.0 * UNIT * lengths([posed_a, posed_b]);
        for one in [&found, &back] {
            assert!(found.state == back.state || one.lower <= width, "{what}");
            assert!(one.upper <= 2e-12 + width, "{what}");
        }
        same += u32::from(found.state == back.state);
        let meet = |state| matches!(state, StartState::Touching | StartState::Overlapping);
        exchanged += u32::from(found.state != back.state && meet(found.state) && meet(back.state));
    }
    // Apart or touching up to rounding; whether they touch or overlap hardly ever depends on the order.
    assert!(same > 5900 && exchanged < 10, "{same} {exchanged}");
}
