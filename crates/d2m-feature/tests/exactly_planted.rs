//! Contacts whose time is exact by construction, in integers: no oracle is needed. Never clear,
//! never late, never undecided after the contact; features down to a few units in the last place of their coordinates,
//! grazing and coplanar ones, needles, far reference points and spins of any rate.

use d2m_feature::{ContactOptions, FirstContact, PairMotion, StraightPaths};
use d2m_motion::ConstantTwist;
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};

/// Queries of one kind; straight paths are quick.
const COUNT: usize = 5_000;
const STRAIGHT: usize = 40_000;

/// An integer up to `size` in magnitude.
fn integer(random: &mut Random, size: f64) -> f64 {
    (random.signed() * size).round()
}

/// Integers, some of them zero or alike, of one size in the plane z = 0 or in space.
fn vector(random: &mut Random, size: f64, flat: bool) -> DVec3 {
    let v = DVec3::new(integer(random, size), integer(random, size), integer(random, size));
    let zero = random.index(6);
    let v = if zero < 2 { v * [DVec3::X, DVec3::Y][zero] } else { v };
    if flat { DVec3::new(v.x, v.y, 0.0) } else { v }
}

/// A power of two up to 2ⁿ.
fn power(random: &mut Random, n: usize) -> f64 {
    2.0_f64.powi(random.index(n + 1) as i32)
}

fn not_behind(answer: FirstContact, time: f64, what: &dyn std::fmt::Debug) {
    let until = match answer {
        FirstContact::Clear => f64::INFINITY,
        FirstContact::Contact(contact) => contact.lo,
        FirstContact::Undecided { clear_until } => clear_until,
    };
    assert!(until <= time, "{answer:?}, contact at {time}: {what:?}");
}

/// Four points that touch at a time j/2ᵏ on straight paths, all numbers integers below 2⁵³ times a power of two.
#[test]
fn straight_paths_that_touch_exactly() {
    let mut random = Random::new(20);
    for i in 0..STRAIGHT {
        let edges = i % 2 == 0;
        let flat = random.index(4) == 0;
        let (length, speed) = (power(&mut random, 20), power(&mut random, 20));
        let denominator = power(&mut random, 10);
        let time = (random.unit() * (denominator + 1.0)).floor() / denominator;
        // Where they touch: multiples of 4, so that parameters in quarters give integers.
        let at = |random: &mut Random| vector(random, length, flat) * 4.0;
        let [p, q, r] = [at(&mut random), at(&mut random), at(&mut random)];
        let weights = [[4.0, 0.0, 0.0], [2.0, 2.0, 0.0], [1.0, 1.0, 2.0], [0.0, 1.0, 3.0], [3.0, 1.0, 0.0]];
        let w = weights[random.index(5)].map(|w| w / 4.0);
        let mut there = if edges {
            // The middle or an end of one edge on the line of the other.
            let touch = p * w[0] + q * (1.0 - w[0]);
            let e = r - touch;
            let (s, t) = [(1.0, 1.0), (1.0, 0.0), (2.0, 1.0), (1.0, 3.0)][random.index(4)];
            [p, q, touch - e * s, touch + e * t]
        } else {
            [p * w[0] + q * w[1] + r * w[2], p, q, r]
        };
        // Flat ones are moved apart by the separation, across their plane.
        let separation = if random.index(4) == 0 { 1.0 + integer(&mut random, length).abs() } else { 0.0 };
        if flat {
            let apart = separation * DVec3::Z;
            there[0] += apart;
            there[1] += if edges { apart } else { DVec3::ZERO };
        }
        let (fast, far) = (power(&mut random, 35), power(&mut random, 45));
        let common = vector(&mut random, fast, false) * denominator;
        let offset = vector(&mut random, far, false);
        let unit = 2.0_f64.powi([0, 0, -1000, -60, 70, 900][random.index(6)]);
        let paths = there.map(|x| {
            let v = vector(&mut random, speed, flat && i % 3 == 0) * denominator + common;
            (x + offset - v * time, x + offset + v * (1.0 - time))
        });
        let (start, end) = (paths.map(|x| x.0 * unit), paths.map(|x| x.1 * unit));
        let query = StraightPaths::new(start, end);
        let options = ContactOptions::new().with_min_separation(separation * unit).with_max_evaluations(4096);
        let answer = if edges { query.edge_edge(&options) } else { query.point_triangle(&options) };
        not_behind(answer, time, &(query, w));
    }
}

/// Bodies that spin about axes of the world through the place of the contact: no rotation moves it.
#[test]
fn spins_that_leave_the_contact_in_place() {
    let mut random = Random::new(21);
    for i in 0..COUNT {
        let edges = i % 2 == 0;
        let spin = |random: &mut Random| match random.index(4) {
            0 => 0.0,
            1 => random.signed() * 1e3,
            2 => power(random, 26),
            _ => random.signed() * 1e7,
        };
        let (denominator, length) = (power(&mut random, 10), power(&mut random, 7));
        let (t0, width) = (integer(&mut random, 1.0) * 1024.0, power(&mut random, 6));
        let time = t0 + (random.unit() * (width * denominator + 1.0)).floor() / denominator;
        let time = time.min(t0 + width);
        let turned =
            [[DVec3::X, DVec3::Y, DVec3::Z], [DVec3::Y, DVec3::Z, DVec3::X], [DVec3::Z, DVec3::X, DVec3::Y]]
                [random.index(3)];
        let world = |v: DVec3| turned[0] * v.x + turned[1] * v.y + turned[2] * v.z;
        let speed = integer(&mut random, 64.0);
        // Both bodies drift along, B's plane z = 0 follows; A comes along z, and slides in the plane by a little.
        let drift = vector(&mut random, 8.0, false);
        let away = power(&mut random, 20);
        let place = vector(&mut random, away, false);
        let a_velocity = drift + DVec3::new(0.0, 0.0, speed);
        // Far reference points on the axes of the spins.
        let far = |random: &mut Random| {
            let size = power(random, 23);
            integer(random, size)
        };
        let (along_a, along_b) = (far(&mut random), far(&mut random));
        let axis_a = if edges { DVec3::X } else { DVec3::Z };
        let (at_a, at_b) = (axis_a * along_a, DVec3::Z * along_b);
        let motion = |at: DVec3, velocity: DVec3, omega: DVec3| {
            // At the time of the contact the body point 0 is at `place`.
            let position = place + at + velocity * (0.0 - time);
            ConstantTwist::REST
                .with_position(world(position))
                .with_linear_velocity(world(velocity))
                .with_angular_velocity(world(omega))
                .with_at(world(at))
        };
        let a = motion(at_a, a_velocity, axis_a * spin(&mut random));
        let b = motion(at_b, drift, DVec3::Z * spin(&mut random));
        let half_turn = DQuat::from_xyzw(0.0, 0.0, 0.0, 1.0);
        let (a, b) = (a.with_orientation(half_turn), b.with_orientation(half_turn));
        let pair = PairMotion::new(&a, &b, t0, t0 + width);
        let separation = if random.index(4) == 0 { length * random.unit() } else { 0.0 };
        let options = ContactOptions::new().with_min_separation(separation).with_max_evaluations(4096);
        let answer = if edges {
            let edge_a = [DVec3::X * -length, DVec3::X * length * (random.index(4) as f64)];
            let tip = vector(&mut random, length, true);
            let edge_b = [tip, -tip * (random.index(3) as f64)];
            pair.edge_edge(edge_a.map(world), edge_b.map(world), &options)
        } else {
            let (p, q) = (vector(&mut random, length, true), vector(&mut random, length, true));
            // Its vertices add up to zero, so that it holds the axis.
            let triangle = [p, q, -(p + q)].map(world);
            if random.index(3) == 0 {
                let swapped = PairMotion::new(&b, &a, t0, t0 + width);
                swapped.triangle_point(&triangle, DVec3::ZERO, &options)
            } else {
                pair.point_triangle(DVec3::ZERO, &triangle, &options)
            }
        };
        not_behind(answer, time, &(a, b, t0, width, i));
    }
}
