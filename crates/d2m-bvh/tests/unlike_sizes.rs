//! Bodies whose sizes, or speeds, differ by so much that numbers of the node tests overflow.

use d2m_bvh::{
    MeshTree, Moving, Posed, QueryOptions, Solid, TimeOfContact, TriMesh, Window, collide, distance,
    time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// A closed cube.
fn cube(half: f64) -> MeshTree {
    MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
}

/// A tetrahedron with its first vertex at the origin.
fn tetrahedron(size: f64) -> MeshTree {
    let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * size).to_vec();
    MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap())
}

/// A sphere of 128 triangles: an octahedron divided twice.
fn sphere(radius: f64) -> MeshTree {
    let mut triangles = Vec::new();
    for octant in 0..8u32 {
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let [x, y, z] = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
        triangles.push(if octant.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] });
    }
    for _ in 0..2 {
        let halves = triangles.iter().flat_map(|&[p, q, r]| {
            let [pq, qr, rp] = [p + q, q + r, r + p].map(DVec3::normalize);
            [[p, pq, rp], [pq, q, qr], [rp, qr, r], [pq, qr, rp]]
        });
        triangles = halves.collect();
    }
    let vertices = triangles.into_iter().flatten().map(|p| p * radius);
    MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new))
}

/// A cube that a face of the large sphere cuts: both orders say so, and no distance is proven.
#[test]
fn bodies_that_cross_are_never_apart_however_unlike_their_sizes() {
    let mut random = KnuthRandom(171);
    let small = cube(0.5);
    for step in 300..800 {
        let large = sphere(10f64.powf(f64::from(step) / 20.0));
        for _ in 0..4 {
            let corners = large.mesh().corners((random.signed().abs() * 127.9) as usize);
            let rotation =
                DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.0).normalize();
            let translation = (corners[0] + corners[1] + corners[2]) / 3.0;
            let placed = Pose { rotation, translation, at: DVec3::ZERO };
            let [a, b] = [Posed::new(&small, placed), Posed::at_rest(&large)];
            for (a, b) in [(a, b), (b, a)] {
                assert_eq!(collide(a, b, Solid::Surface), Ok(true), "10^{step}/20");
                let found = distance(a, b, Solid::Surface).unwrap();
                assert!(found.lower == 0.0, "10^{step}/20: {found:?}");
            }
        }
    }
}

/// No lower bound of a distance is above the distance of two vertices, from near to further away than squares of `f32` reach.
#[test]
fn bounds_of_distances_hold_however_unlike_sizes_and_distances() {
    let mut random = KnuthRandom(173);
    let small = cube(0.5);
    for step in 0..800 {
        let size = 10f64.powf(f64::from(step) / 20.0);
        let large = sphere(size);
        for _ in 0..4 {
            let rotation =
                DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.0).normalize();
            let away = (1.0 + size) * (1.0 + 10f64.powf(40.0 * random.signed().max(-0.1)));
            let translation = random.vector().normalize() * away;
            let placed = Pose { rotation, translation, at: DVec3::ZERO };
            let near = small.mesh().vertices().iter().flat_map(|&v| {
                let v = translation + rotation * v;
                large.mesh().vertices().iter().map(move |w| v.distance(*w))
            });
            let near = near.fold(f64::INFINITY, f64::min) + 1e-12 * away;
            let [a, b] = [Posed::new(&small, placed), Posed::at_rest(&large)];
            for (a, b) in [(a, b), (b, a)] {
                let found = distance(a, b, Solid::Filled).unwrap();
                assert!(found.lower <= near && found.upper < f64::INFINITY, "{size:e} {away:e}: {found:?}");
            }
        }
    }
}

/// Straight through the other body, from near or from far away, at any speed, past large bodies and small ones: no answer says
/// that they do not meet.
#[test]
fn nothing_is_too_fast_to_be_noticed() {
    let mut random = KnuthRandom(172);
    let target = cube(0.5);
    let mut found = 0;
    for step in 0..1200 {
        let size = 10f64.powf(39.0 * random.signed().max(0.0));
        let other = if step % 2 == 0 { cube(size) } else { sphere(size) };
        let speed = 10f64.powf(f64::from(step) / 8.0 - 60.0);
        let towards = random.vector().normalize();
        let turn = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.0).normalize();
        let from = (2.0 + 2.0 * size) * if step % 3 == 0 { 1.0 } else { 1.0 + random.signed().abs() };
        // Its center is at the target's at from / speed, however it spins. (Motions whose rounding hides the bodies are refused.)
        let until = (2.0 * from / speed).min(1.0);
        if until < from / speed {
            continue;
        }
        let window = Window::try_new(0.0, until).unwrap();
        let spin = random.vector() * ([0.0, 1.0, 300.0, 20_000.0][step as usize / 2 % 4] / until);
        let motion = ConstantTwist::try_new(-towards * from, turn, towards * speed, spin).unwrap();
        let [a, b] = [Moving::new(&target, &ConstantTwist::REST), Moving::new(&other, &motion)];
        for (a, b) in [(a, b), (b, a)] {
            match time_of_contact(a, b, window, &QueryOptions::default()) {
                Ok(TimeOfContact::Separated) => panic!("{step}: size {size:e}, speed {speed:e}"),
                Ok(TimeOfContact::Contact(contact)) => {
                    assert!(contact.time_lo <= from / speed, "{step}: {contact:?}");
                    found += 1;
                }
                Ok(_) | Err(_) => {}
            }
        }
    }
    assert!(found > 600, "{found}");
}

/// A grain of dust flies straight into the inside of a triangle, obliquely, from up to 2²⁴ of its sizes away in a window; it is a
/// 2⁵⁰th to a 2⁶³rd of it. The products of its speed with the line to the triangle overflow in the unit of its boxes.
#[test]
fn a_grain_of_dust_meets_what_it_hits() {
    let mut random = KnuthRandom(174);
    let mut found = 0;
    for round in 0..4000 {
        let size = 0.5f64.powi(50 + round % 14);
        let speed = 2f64.powi(round / 14 % 25);
        let velocity = DVec3::new(1.0, 0.5 * random.signed(), 0.5 * random.signed()) * speed;
        let mut triangles = Vec::new();
        for number in 0..=round as u32 % 4 {
            // The first in the plane x = 0, and some behind it.
            let shift = DVec3::new(-1.5 * f64::from(number), random.signed(), random.signed());
            triangles.push([0; 3].map(|_| shift + DVec3::new(0.0, random.signed(), random.signed())));
        }
        let mut weights = [0; 3].map(|_| random.signed().abs() + 0.01);
        let sum: f64 = weights.iter().sum();
        weights = weights.map(|w| w / sum);
        let hit: DVec3 = (0..3).map(|k| triangles[0][k] * weights[k]).sum();
        let plate = MeshTree::new(Surface::soup(triangles.concat()).into_mesh(TriMesh::try_new));
        let grain = tetrahedron(size);
        let time = 0.5 + 0.4 * random.signed();
        let flight = ConstantTwist::try_new(hit, DQuat::IDENTITY, velocity, DVec3::ZERO)
            .unwrap()
            .with_reference_time(time);
        let window = Window::try_new(0.0, 1.0).unwrap();
        let [a, b] = [Moving::new(&plate, &ConstantTwist::REST), Moving::new(&grain, &flight)];
        for (a, b) in [(a, b), (b, a)] {
            let options = QueryOptions::default().with_solid(Solid::Surface);
            match time_of_contact(a, b, window, &options).unwrap() {
                // Vertices of the triangle are rounded, so the vertex is hit up to a rounding of that.
                TimeOfContact::Contact(contact) => {
                    assert!(contact.time_lo <= time + 4.0 * f64::EPSILON, "{round}: {contact:?}");
                    found += 1;
                }
                other => panic!("{round}: size {size:e}, speed {speed:e}: {other:?}"),
            }
        }
    }
    assert_eq!(found, 8000);
}

/// A grain flies towards one end of a long triangle. Along the line from the triangle's middle to it, it comes nearer by y and z
/// and parts by x, in all nearer; in the unit of its boxes the product of x alone may overflow.
#[test]
fn products_of_speeds_that_overflow_prove_nothing() {
    let across = DVec3::new(0.0, 0.5, -0.5);
    let corners = vec![across + DVec3::X * 0.2, DVec3::X * 0.2 - across, DVec3::X * -5.2];
    let plate = MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap());
    for step in 0..4000 {
        let grain = tetrahedron(0.5f64.powi(58 + step % 10));
        // Up to 2²⁵ in steps of 2^(1/16).
        let speed = 2f64.powf(f64::from(step / 10) / 16.0);
        let flight = ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, DVec3::splat(speed), DVec3::ZERO)
            .unwrap()
            .with_reference_time(1.0 / speed);
        let window = Window::try_new(0.0, 1.0).unwrap();
        let options = QueryOptions::default().with_solid(Solid::Surface);
        let [a, b] = [Moving::new(&plate, &ConstantTwist::REST), Moving::new(&grain, &flight)];
        let found = time_of_contact(a, b, window, &options).unwrap();
        let TimeOfContact::Contact(contact) = found else { panic!("{step}: {found:?}") };
        assert!(contact.time_lo <= (1.0 + f64::EPSILON) / speed, "{step}: {contact:?}");
    }
}
