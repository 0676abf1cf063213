//! Every bound of the relative motion, sampled: never above 1 of the bound, somewhere above 0.9 of it; and mutants of
//! the bounds that the same samples refute.
use super::{OffsetRange, RelativeMotion};
use crate::rotation::exponential_dd;
use crate::{ConstantTwist, EdgeJets, PathJet, Remainder};
use d2m_lanes::DoubleDouble;
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};

/// A relative motion with magnitudes that make each term of the bounds matter in turn.
fn sample(random: &mut Random, i: usize) -> (RelativeMotion, DVec3) {
    let (mut w_a, mut w_b) =
        (random.vector() * random.log_between(0.01, 30.0), random.vector() * random.log_between(0.01, 30.0));
    let mut g = random.vector() * random.log_between(1e-3, 10.0);
    let mut u = random.vector() * random.log_between(1e-3, 30.0);
    let mut arm = random.vector() * random.log_between(1e-3, 3.0);
    match i % 8 {
        // One term alone, and orthogonal vectors: where the bounds are sharp.
        0 => w_b = DVec3::ZERO,
        1 => w_a = DVec3::ZERO,
        2 => (u, g) = (u * 1e-3, g * 1e-3),
        3 => arm *= 1e-3,
        4 => {
            // ω_A = r × …: everything perpendicular.
            (w_b, arm) = (DVec3::Z * w_b.length(), DVec3::X * arm.length());
            w_a = DVec3::new(0.0, 1e-6, 1.0) * w_a.length();
            (u, g) = (DVec3::ZERO, DVec3::ZERO);
        }
        5 => {
            // |q″| of u alone: u perpendicular to ω_B, no arm.
            (w_b, u, g, arm) = (DVec3::Z * w_b.length(), DVec3::X * u.length(), DVec3::ZERO, DVec3::ZERO);
        }
        6 => {
            // ω_A perpendicular to ω_B.
            (w_a, w_b) = (DVec3::X * w_a.length(), DVec3::Z * w_b.length());
        }
        _ => {}
    }
    let a = ConstantTwist::try_new(g, DQuat::IDENTITY, u, w_a).unwrap();
    let b = ConstantTwist::REST.with_angular_velocity(w_b);
    (RelativeMotion::new(&a, &b, 0.0, random.log_between(1e-3, 1.0)), arm)
}

/// First to fourth derivative of a point at τ, by the same recursion again and again.
fn derivatives(motion: &RelativeMotion, r: DVec3, tau: f64) -> [DVec3; 4] {
    let omega = motion.spin_b.omega;
    let (turn_a, turn_b) = (motion.spin_a.rotation(tau), motion.spin_b.rotation(tau));
    let back = turn_b.transpose();
    let p = back * (motion.offset + motion.velocity * tau);
    let u = back * motion.velocity;
    let p1 = u - omega.cross(p);
    let p2 = -omega.cross(u + p1);
    let p3 = omega.cross(omega.cross(u)) - omega.cross(p2);
    let p4 = -omega.cross(omega.cross(omega.cross(u)) + p3);
    let [z1, z2, z3, z4] = direction_derivatives(motion, back * (turn_a * r), back);
    [p1 + z1, p2 + z2, p3 + z3, p4 + z4]
}

fn direction_derivatives(motion: &RelativeMotion, z: DVec3, back: glam::DMat3) -> [DVec3; 4] {
    let omega = motion.spin_b.omega;
    let w = back * motion.spin_difference;
    let w1 = -omega.cross(w);
    let w2 = -omega.cross(w1);
    let w3 = -omega.cross(w2);
    let z1 = w.cross(z);
    let z2 = w1.cross(z) + w.cross(z1);
    let z3 = w2.cross(z) + 2.0 * w1.cross(z1) + w.cross(z2);
    [z1, z2, z3, w3.cross(z) + 3.0 * (w2.cross(z1) + w1.cross(z2)) + w.cross(z3)]
}

#[test]
fn bounds_of_the_derivatives_hold_and_are_nearly_reached() {
    let mut random = Random(11);
    let (mut point, mut direction) = ([0.0_f64; 3], [0.0_f64; 3]);
    // Mutants: K3 = w³; no 3U in M3; no bY in V; half of K3; K4 = w⁴; no 4U in M4; the velocity along B's axis in place
    // of across it.
    let mut mutants = [0.0_f64; 7];
    for i in 0..40_000 {
        let (motion, arm) = sample(&mut random, i);
        let (rho, k) = (arm.length(), &motion.bounds);
        let fourth = motion.bound_fourth_derivative_within(rho, f64::INFINITY);
        let bounds = [motion.bound_speed(rho), motion.bound_jerk_within(rho, f64::INFINITY), fourth];
        for j in 0..4 {
            let tau = motion.duration() * f64::from(j) / 3.0;
            let [q1, _, q3, q4] = derivatives(&motion, arm, tau).map(DVec3::length);
            let back = motion.spin_b.rotation(tau).transpose();
            let z = back * (motion.spin_a.rotation(tau) * arm);
            let [e1, _, e3, e4] = direction_derivatives(&motion, z, back).map(DVec3::length);
            for (order, q) in [q1, q3, q4].into_iter().enumerate() {
                point[order] = point[order].max(q / bounds[order]);
            }
            for (order, (e, bound)) in [(e1, k.w), (e3, k.k3), (e4, k.k4)].into_iter().enumerate() {
                if bound * rho > 0.0 {
                    direction[order] = direction[order].max(e / (bound * rho));
                }
            }
            let base = k.b * (3.0 * k.across + k.b * k.swept);
            mutants[0] = mutants[0].max(q3 / (base + k.w.powi(3) * rho));
            mutants[1] = mutants[1].max(q3 / (k.b * k.b * k.swept + k.k3 * rho));
            mutants[2] = mutants[2].max(q1 / (k.speed + k.w * rho));
            mutants[3] = mutants[3].max(q3 / (base + 0.5 * k.k3 * rho));
            let base = k.b * k.b * (4.0 * k.across + k.b * k.swept);
            mutants[4] = mutants[4].max(q4 / (base + k.w.powi(4) * rho));
            mutants[5] = mutants[5].max(q4 / (k.b.powi(3) * k.swept + k.k4 * rho));
            let along = motion.velocity.dot(motion.spin_b.axis).abs();
            let base = k.b * k.b * (3.0 * along + k.swept);
            mutants[6] = mutants[6].max(q3 / (base + k.k3 * rho));
        }
    }
    for ratio in point.into_iter().chain(direction) {
        assert!((0.9..=1.0 + 1e-9).contains(&ratio), "point {point:?} direction {direction:?}");
    }
    assert!(mutants.iter().all(|ratio| *ratio > 1.01), "{mutants:?}");
}

/// q(τ) in double-double from the placed vector.
fn exact(motion: &RelativeMotion, r: DVec3, tau: DoubleDouble) -> [DoubleDouble; 3] {
    let turn_a = exponential_dd(motion.spin_a.omega, tau);
    let turn_b = exponential_dd(motion.spin_b.omega, tau);
    let z = turn_a.apply([r.x, r.y, r.z].map(DoubleDouble::from_f64));
    let x = [0, 1, 2].map(|i| motion.exact.offset[i] + motion.exact.velocity[i] * tau + z[i]);
    turn_b.apply_transposed(x)
}

/// How far x is from the jet at s.
fn off(x: [DoubleDouble; 3], jet: &PathJet, s: f64) -> f64 {
    let third = jet.j * (s * s * s / 6.0);
    difference([0, 1, 2].map(|i| x[i].add_f64(-third[i])), jet.p, jet.v, jet.a, s)
}

fn difference(x: [DoubleDouble; 3], p: DVec3, v: DVec3, a: DVec3, s: f64) -> f64 {
    let d = [0, 1, 2].map(|i| {
        let jet = ((DoubleDouble::from_f64(a[i]) * (0.5 * s)).add_f64(v[i]) * s).add_f64(p[i]);
        (x[i] - jet).hi
    });
    DVec3::from_array(d).length()
}

#[test]
fn remainders_hold_and_are_nearly_reached() {
    let mut random = Random(12);
    // To second order (frames) and to third order (single jets).
    let (mut taylor, mut rounding, mut without) = ([0.0_f64; 2], [0.0_f64; 2], [0; 2]);
    for i in 0..6000 {
        let (motion, arm) = sample(&mut random, i / 2);
        let second = motion.point_remainder(arm.length(), 0.0);
        let tau = motion.duration() * random.unit();
        let order = i % 2;
        let jet = if order == 0 {
            motion.frame(tau).point_jet(arm, second)
        } else {
            let fourth = motion.bound_fourth_derivative_within(arm.length(), f64::INFINITY);
            let third = motion.point_remainder_third_order(second, fourth);
            motion.point_jet(tau, &motion.arm(arm), third)
        };
        let remainder = jet.remainder;
        let room = (motion.duration() - tau).min(tau);
        for h in [0.0, room * 1e-3, room * 0.05, room] {
            for s in [-h, h] {
                let at = DoubleDouble::from_f64(tau).add_f64(s);
                let error = off(exact(&motion, arm, at), &jet, s);
                let bound = remainder.bound(h);
                assert!(error <= bound, "{error:e} > {bound:e} at {h}");
                let terms = [remainder.m3 * h * h * h / 6.0, remainder.m4 * h * h * h * h / 24.0];
                if h == 0.0 {
                    rounding[order] = rounding[order].max(error / remainder.e0);
                    without[order] += usize::from(error > 0.0);
                } else if terms[order] > 1e6 * remainder.e0 {
                    taylor[order] = taylor[order].max(error / bound);
                }
            }
        }
    }
    assert!(taylor.iter().all(|t| *t >= 0.9), "the last term is far from sharp: {taylor:?}");
    // The counted rounding is at most 250 times the largest one measured; without it more than half of the jets would be wrong.
    assert!(rounding.iter().all(|r| (0.004..=1.0).contains(r)), "{rounding:?}");
    assert!(without.iter().all(|n| *n > 3000), "a mutant without E survives: {without:?}");
}

#[test]
fn directions_and_anchors_keep_their_remainders() {
    let mut random = Random(13);
    for i in 0..1500 {
        let (motion, arm) = sample(&mut random, i);
        let tau = motion.duration() * random.unit();
        let remainder = motion.direction_remainder(arm.length());
        let third = motion.direction_remainder_third_order(arm.length());
        // In world axes: turned back for the comparison.
        let (mine, theirs) = (motion.arms_a(arm, arm), motion.arms_b(DVec3::ZERO, arm));
        let EdgeJets { jets, half_b: half } =
            motion.edge_jets(tau, &mine, &theirs, [Remainder::default(), third]);
        let [point, mut jet] = jets.split();
        let back = motion.spin_b.rotation(tau).transpose();
        assert!((back * half - arm).length() <= 1e-14 * arm.length());
        let single = motion.point_jet(tau, &motion.arm(arm), Remainder::default());
        for (mine, theirs) in
            [(point.p, single.p), (point.v, single.v), (point.a, single.a), (point.j, single.j)]
        {
            assert!((back * mine - theirs).length() <= 1e-12 * (1.0 + theirs.length()));
        }
        let n = random.vector().normalize();
        let along = motion.point_along(tau, &motion.arm(arm), n);
        for (mine, theirs) in along.into_iter().zip([single.p, single.v, single.a, single.j]) {
            assert!((mine - n.dot(theirs)).abs() <= 1e-12 * (1.0 + theirs.length()), "{along:?}");
        }
        (jet.p, jet.v, jet.a, jet.j) = (back * jet.p, back * jet.v, back * jet.a, back * jet.j);
        let other = motion.frame(tau).direction_jet(arm, remainder);
        assert!((jet.a - other.a).length() <= 1e-12 * (1.0 + jet.a.length()));
        let turned = |tau: DoubleDouble| {
            let z = exponential_dd(motion.spin_a.omega, tau)
                .apply([arm.x, arm.y, arm.z].map(DoubleDouble::from_f64));
            exponential_dd(motion.spin_b.omega, tau).apply_transposed(z)
        };
        let h = motion.duration() * 0.01;
        for jet in [jet, other] {
            let error = off(turned(DoubleDouble::from_f64(tau).add_f64(h)), &jet, h);
            assert!(error <= jet.remainder.bound(h), "{error:e}");
        }

        // The same point through an anchor a million units out, on a motion about a far center.
        let far = random.vector() * 1e6;
        let a = ConstantTwist::REST
            .with_position(random.vector() - far)
            .with_angular_velocity(motion.spin_a.omega)
            .with_linear_velocity(random.vector());
        let b = ConstantTwist::REST.with_angular_velocity(motion.spin_b.omega * 1e-3);
        let plain = RelativeMotion::new(&a, &b, 0.0, 1e-3);
        let anchored = plain.anchored(far, DVec3::ZERO);
        let r = anchored.place_a(far + arm);
        let small = anchored.point_remainder(r.length(), 0.0);
        let tau = 1e-3 * random.unit();
        let jet = anchored.frame(tau).point_jet(r, small);
        let x = exact(&plain, far, DoubleDouble::from_f64(tau));
        let q = exponential_dd(motion.spin_a.omega, DoubleDouble::from_f64(tau))
            .apply([r.x, r.y, r.z].map(DoubleDouble::from_f64));
        let q = exponential_dd(b_spin(&plain), DoubleDouble::from_f64(tau)).apply_transposed(q);
        let sum = [0, 1, 2].map(|k| x[k] + q[k]);
        let error = difference(sum, jet.p, DVec3::ZERO, DVec3::ZERO, 0.0);
        assert!(error <= jet.remainder.bound(0.0), "{error:e} {:e}", jet.remainder.e0);
        assert!(jet.remainder.e0 < 0.1 * plain.point_remainder(1e6, 0.0).e0);
    }
}

fn b_spin(motion: &RelativeMotion) -> DVec3 {
    motion.spin_b.omega
}

#[test]
fn the_epoch_and_the_clock_are_rounded_outward() {
    let a = ConstantTwist::REST.with_linear_velocity(DVec3::X);
    let motion = RelativeMotion::new(&a, &ConstantTwist::REST, 0.1, 1e5);
    assert!(motion.duration() >= 1e5 - 0.1);
    for tau in [0.0, 1e-17, 0.3, 99_999.9] {
        assert!(motion.time_down(tau) <= 0.1 + tau && motion.time_down(tau) >= 0.1);
        assert!(motion.time_up(tau) >= motion.time_down(tau) && motion.time_up(tau) <= 1e5);
    }
    assert_eq!(motion.time_down(1e-17), 0.1);
    assert!(motion.time_up(1e-17) > 0.1);
    // Too many turns for a counted error: nothing can be excluded.
    let spinning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 2e9);
    let lost = RelativeMotion::new(&spinning, &ConstantTwist::REST, 0.0, 1.0);
    assert_eq!(lost.point_remainder(1.0, 1.0).e0, f64::INFINITY);
}

#[test]
fn the_part_of_the_window_within_reach_is_whole_and_its_remainders_hold() {
    let mut random = Random(14);
    let (mut never, mut part, mut inside) = (0, 0, 0);
    for i in 0..20_000 {
        let (motion, arm) = sample(&mut random, i);
        let distance = motion.bounds.reach * random.unit();
        let times = motion.times_within(distance);
        match times {
            None => never += 1,
            Some(times) => part += usize::from(times.to - times.from < 0.8 * motion.duration()),
        }
        let remainder = motion.point_remainder_within(arm.length(), 0.0, distance * (1.0 + 1e-12));
        for j in 0..=8 {
            let tau = motion.duration() * f64::from(j) / 8.0;
            let at = DoubleDouble::from_f64(tau);
            let x = [0, 1, 2].map(|i| (motion.exact.offset[i] + motion.exact.velocity[i] * at).hi);
            if DVec3::from_array(x).length() > distance * (1.0 - 1e-15) {
                continue;
            }
            inside += 1;
            let OffsetRange { from, to } = times.expect("a time within the distance");
            assert!(from <= tau && tau <= to, "{motion:?} {distance} {tau}");
            let fourth = motion.bound_fourth_derivative_within(arm.length(), distance * (1.0 + 1e-12));
            let remainder = motion.point_remainder_third_order(remainder, fourth);
            let jet = motion.point_jet(tau, &motion.arm(arm), remainder);
            let h = 0.01 * motion.duration();
            for s in [-h, h] {
                let near = DoubleDouble::from_f64(tau).add_f64(s);
                let y = [0, 1, 2].map(|i| (motion.exact.offset[i] + motion.exact.velocity[i] * near).hi);
                if DVec3::from_array(y).length() <= distance {
                    let error = off(exact(&motion, arm, near), &jet, s);
                    assert!(error <= remainder.bound(h), "{error:e}");
                }
            }
            let now = difference(exact(&motion, arm, at), jet.p, jet.v, jet.a, 0.0);
            assert!(now <= remainder.e0, "{now:e} {:e}", remainder.e0);
        }
    }
    assert!(never > 1000 && part > 1000 && inside > 10_000, "{never} {part} {inside}");
}

#[test]
fn what_lies_along_the_axis_of_both_spins_does_not_turn() {
    // Bodies that spin together and approach along their axis: in B's frame nothing but a translation.
    let spin = 58_747.322_521_259_95 * DVec3::Z;
    let a = ConstantTwist::try_new(64.0 * DVec3::Z, DQuat::IDENTITY, -8.0 * DVec3::Z, spin).unwrap();
    let b = ConstantTwist::REST.with_angular_velocity(spin);
    let motion = RelativeMotion::new(&a, &b, 0.0, 8.0);
    assert!(motion.bound_speed(1.0) < 8.0 * (1.0 + 1e-12), "{}", motion.bound_speed(1.0));
    assert!(
        motion.bound_jerk_within(1.0, 64.0) == 0.0 && motion.bound_fourth_derivative_within(1.0, 64.0) == 0.0
    );
    // The same two bodies one unit beside each other turn about each other.
    let beside = RelativeMotion::new(&a.with_position(DVec3::X), &b, 0.0, 8.0);
    assert!(beside.bound_speed(1.0) > 58_747.0);
}

#[test]
fn rotations_are_the_same_in_every_unit_of_time() {
    let omega = DVec3::new(0.3, -1.2, 0.7);
    let turned = exponential_dd(omega, DoubleDouble::from_f64(1.5)).to_mat3();
    for k in [-1000, -600, -300, 300, 600, 1000] {
        let (faster, shorter) = (2.0_f64.powi(k), 2.0_f64.powi(-k));
        let same = exponential_dd(omega * faster, DoubleDouble::from_f64(1.5 * shorter)).to_mat3();
        assert_eq!(turned, same, "2^{k}");
    }
}

/// Where the square of a distance times a speed is no number, times near each other are not left out.
#[test]
fn times_within_a_distance_are_found_in_any_unit() {
    let passing = ConstantTwist::REST.with_position(DVec3::new(-4.0, 0.25, 0.0));
    let passing = passing.with_linear_velocity(DVec3::X * 8.0);
    let times = |meter: i32, second: i32, distance: f64| {
        let (meter, second) = (2f64.powi(meter), 2f64.powi(second));
        let there = passing.with_position(passing.position() * meter);
        let there = there.with_linear_velocity(passing.linear_velocity() * (meter / second));
        let relative = RelativeMotion::new(&there, &ConstantTwist::REST, 0.0, second);
        let times = relative.times_within(distance * meter)?;
        Some([times.from / second, times.to / second])
    };
    let usual = times(0, 0, 0.5).expect("they pass at 0.5");
    assert!(usual[0] <= 0.45 && usual[1] >= 0.55 && usual[1] - usual[0] < 0.2, "{usual:?}");
    for (meter, second) in [
        (-660, 0),
        (-330, 0),
        (250, 0),
        (330, 0),
        (660, 0),
        (-450, 450),
        (450, -450),
        (-900, -900),
        (900, 900),
    ] {
        let found = times(meter, second, 0.5).expect("they pass at 0.5");
        let off = (found[0] - usual[0]).abs().max((found[1] - usual[1]).abs());
        assert!(off < 1e-12, "{meter} {second}: {found:?}");
        assert_eq!(times(meter, second, 0.2), None, "{meter} {second}");
    }
}
