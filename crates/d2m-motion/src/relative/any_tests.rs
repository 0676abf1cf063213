//! Jets of any motion against closed forms and double-double: never beyond the remainder, somewhere near it; mutants
//! of the bounds that the same samples refute.
use super::any::RelativeState;
use crate::{Ball, CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use core::ops::Add;
use core::ops::{Mul, Sub};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_lanes::DoubleDouble;
use d2m_testing::{Draw, Random};
use glam::{DMat3, DQuat, DVec3};

fn linear(random: &mut Random, speed: f64) -> ConstantTwist {
    let place = random.vector();
    ConstantTwist::try_new(place, random.quaternion(), random.vector() * speed, random.vector() * speed)
        .unwrap()
        .with_at(random.vector())
}

/// Only what a motion must say; everything else by default.
struct Opaque(ConstantTwist);

impl RigidMotion for Opaque {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist_rate(t)
    }
}

/// Frobenius distance of a matrix from the true rotation, and the distance of the position.
fn errors(motion: &ConstantTwist, t: f64, state: &CertifiedState) -> (f64, f64) {
    let (r, x) = (motion.rotation_dd(t).0, motion.position_dd(t));
    let mut square = 0.0;
    for (i, row) in r.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            square += entry.add_f64(-state.rotation.col(j)[i]).hi.powi(2);
        }
    }
    let moved = [0, 1, 2].map(|i| x[i].add_f64(-state.position[i]).hi);
    (square.sqrt(), DVec3::from_array(moved).length())
}

#[test]
fn states_are_within_their_radii() {
    let mut random = Random(21);
    let mut largest = [[0.0_f64; 2]; 2];
    for i in 0..20_000 {
        let speed = [0.0, 3.0, 100.0][i % 3];
        let motion = linear(&mut random, speed).with_reference_time([0.0, random.signed() * 10.0][i % 2]);
        let t = random.signed() * 10.0;
        for (which, state) in [motion.enclose_state(t), Opaque(motion).enclose_state(t)].iter().enumerate() {
            let (turn, moved) = errors(&motion, t, state);
            assert!(turn <= state.rotation_radius && moved <= state.position_radius, "{motion:?} {t}");
            largest[which][0] = largest[which][0].max(turn / state.rotation_radius);
            largest[which][1] = largest[which][1].max(moved / state.position_radius);
            assert!(state.rotation_radius < 1e-15 * (100.0 + 20.0 * speed * 20.0), "{state:?}");
        }
    }
    // The counted roundings are not empty: a radius of a tenth would be refuted for the position, a fiftieth for the rotation.
    assert!(largest.iter().all(|[turn, moved]| *turn > 0.02 && *moved > 0.1), "{largest:?}");
}

#[test]
fn extreme_quaternions_and_times_are_not_trusted_to_plain_arithmetic() {
    for scale in [1e-140, 1e140] {
        let q = DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5) * scale;
        let state = ConstantTwist::REST.with_orientation(q).enclose_state(0.0);
        assert!(state.rotation_radius < 1e-14 && (state.rotation * DVec3::X - DVec3::Y).length() < 1e-14);
    }
    // Beyond the kernel's range the enclosure says how little is known.
    let fast = ConstantTwist::REST.with_angular_velocity(DVec3::new(1.0, 2.0, 2.0) * 1e16);
    assert!(fast.enclose_state(1.0).rotation_radius >= 1.0);
    let lost = ConstantTwist::REST.with_linear_velocity(DVec3::X * 1e300).enclose_state(1e300);
    assert!(lost.position_radius == f64::INFINITY);
}

/// q(t) in double-double, from B's body frame.
fn exact(a: &ConstantTwist, b: &ConstantTwist, p: DVec3, t: DoubleDouble) -> [DoubleDouble; 3] {
    // Motions with reference time 0, so that t needs no rounding.
    let place = |m: &ConstantTwist| {
        let turn = crate::rotation::rotate_dd(m.angular_velocity(), t, m.orientation());
        let x = [0, 1, 2].map(|i| t.mul(m.linear_velocity()[i]).add_f64(m.position()[i]));
        (turn, x)
    };
    let ((ra, xa), (rb, xb)) = (place(a), place(b));
    let arm = ra.apply([0, 1, 2].map(|i| DoubleDouble::from_difference(p[i], a.at()[i])));
    let x = [0, 1, 2].map(|i| xa[i].sub(xb[i]).add(arm[i]));
    let back = rb.apply_transposed(x);
    [0, 1, 2].map(|i| back[i].add_f64(b.at()[i]))
}

#[test]
fn jets_of_constant_twists_keep_their_remainders() {
    let mut random = Random(22);
    let (mut taylor, mut rounding) = (0.0_f64, 0.0_f64);
    for i in 0..6000 {
        let speed = random.log_between(0.01, 30.0);
        let (mut a, mut b) = (linear(&mut random, speed), linear(&mut random, speed));
        if i % 2 == 0 {
            // The spinning axes and arms that reach the bounds.
            let axis = random.axis();
            a = a
                .with_angular_velocity(axis * random.log_between(0.1, 30.0))
                .with_linear_velocity(DVec3::ZERO);
            b = b.with_angular_velocity(DVec3::ZERO);
        }
        let p = random.vector() * 2.0;
        let (at, half) = (random.signed(), random.log_between(1e-6, 0.1) / (1.0 + speed));
        let state = if i % 4 < 2 {
            RelativeState::new(&a, &b, Interval::new(at - half, at + half), at)
        } else {
            RelativeState::new(&Opaque(a), &Opaque(b), Interval::new(at - half, at + half), at)
        };
        let arm = p - a.at();
        let jet = state.point_jet(arm, arm.length() * (1.0 + 1e-15), 0.0);
        for s in [-half, 0.0, half] {
            let x = exact(&a, &b, p, DoubleDouble::from_f64(at).add_f64(s));
            let d = [0, 1, 2].map(|i| {
                let polynomial = DoubleDouble::from_f64(jet.a[i]).mul(0.5 * s).add_f64(jet.v[i]);
                x[i].sub(polynomial.mul(s).add_f64(jet.p[i])).hi
            });
            let (error, bound) = (DVec3::from_array(d).length(), jet.remainder.bound(s.abs()));
            assert!(error <= bound, "{error:e} > {bound:e} at {s} {a:?} {b:?}");
            if s == 0.0 {
                rounding = rounding.max(error / bound);
            } else if jet.remainder.m3 * half.powi(3) > 1e6 * jet.remainder.e0 {
                taylor = taylor.max(error / bound);
            }
        }
    }
    assert!(taylor >= 0.9 && rounding >= 0.01, "{taylor} {rounding}");
}

/// Spins up about a fixed axis by the angle w·t + α·t²/2 + κ·t³/6, on a cubic.
struct SpinUp {
    start: DQuat,
    axis: DVec3,
    rates: [f64; 3],
    path: [DVec3; 4],
}

impl SpinUp {
    fn random(random: &mut Random) -> Self {
        let size = random.log_between(0.01, 30.0);
        Self {
            start: random.quaternion().normalize(),
            axis: random.axis(),
            rates: [
                random.signed() * size,
                random.signed() * size * size,
                random.signed() * size * size * size,
            ],
            path: [0, 1, 2, 3].map(|k| random.vector() * size.powi(k)),
        }
    }
    fn angle(&self, t: Interval) -> Interval {
        let [w, alpha, kappa] = self.rates;
        t * (w + t * (0.5 * alpha + t * (kappa * Interval::point(1.0) / 6.0)))
    }
}

impl RigidMotion for SpinUp {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let [w, alpha, kappa] = self.rates;
        let angle = t * (w + t * (0.5 * alpha + t * (kappa / 6.0)));
        let [c0, c1, c2, c3] = self.path;
        let rotation = DQuat::from_axis_angle(self.axis, angle) * self.start;
        let pose = Pose { rotation, translation: c0 + (c1 + (c2 + c3 * t) * t) * t, at: DVec3::ZERO };
        let linear = c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t;
        (pose, Twist { linear, angular: self.axis * (w + t * (alpha + t * (0.5 * kappa))) })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let start = IntervalMat3::from_quat_normalized(self.start);
        let rotation = IntervalMat3::rotation(self.axis, self.angle(t)).mul_mat(start);
        let [c0, c1, c2, c3] = self.path.map(IntervalVec3::point);
        IntervalPose { rotation, translation: c0 + (c1 + (c2 + c3 * t) * t) * t, at: DVec3::ZERO }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let [w, alpha, kappa] = self.rates;
        let [_, c1, c2, c3] = self.path.map(IntervalVec3::point);
        let angular = IntervalVec3::point(self.axis) * (w + t * (alpha + t * (0.5 * kappa)));
        IntervalTwist { linear: c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t, angular }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let [_, alpha, kappa] = self.rates;
        let [_, _, c2, c3] = self.path.map(IntervalVec3::point);
        IntervalTwist {
            linear: c2 * 2.0 + c3 * (6.0 * t),
            angular: IntervalVec3::point(self.axis) * (alpha + t * kappa),
        }
    }
}

#[test]
fn jets_of_accelerating_motions_keep_their_remainders() {
    let mut random = Random(23);
    let mut reached = 0.0_f64;
    for _ in 0..40_000 {
        let (a, b) = (SpinUp::random(&mut random), SpinUp::random(&mut random));
        let size = a.rates[0].abs().max(b.rates[0].abs()).max(1.0);
        let (at, half) = (random.signed() / size, random.log_between(1e-3, 0.3) / size);
        let state = RelativeState::new(&a, &b, Interval::new(at - half, at + half), at);
        let (p, d) = (random.vector(), random.vector());
        let (point, direction) = (state.point_jet(p, p.length(), 0.0), state.direction_jet(d, d.length()));
        for j in -4..=4 {
            let s = half * f64::from(j) / 4.0;
            let ((pose_a, _), (pose_b, _)) = (a.pose_and_twist(at + s), b.pose_and_twist(at + s));
            let q = pose_b.inverse_transform_point(pose_a.transform_point(p));
            let e = pose_b.rotation.conjugate() * (pose_a.rotation * d);
            for (jet, truth) in [(point, q), (direction, e)] {
                let (error, bound) = ((truth - jet.at(s)).length(), jet.remainder.bound(s.abs()));
                // What plain poses are off by.
                let slack = 1e-13 * (1.0 + pose_a.translation.length() + pose_b.translation.length());
                assert!(error <= bound + slack, "{error:e} > {bound:e} at {s}");
                if bound > 1e4 * slack {
                    reached = reached.max(error / bound);
                }
            }
        }
    }
    assert!(reached > 0.5, "{reached}");
}

/// What a mutant leaves out of the bound of the third derivative.
const TERMS: [&str; 8] = ["none", "3βU", "βb(Y⊥ + 2Y)", "3bA", "b²(3U⊥ + bY⊥)", "βw", "2bλ", "3wλ"];

#[test]
fn the_third_derivative_is_bounded_with_every_term() {
    let mut random = Random(24);
    let mut largest = [0.0_f64; TERMS.len()];
    let still = Ball::point;
    for _ in 0..300_000 {
        let mut v = || random.axis() * if random.unit() < 0.3 { 0.0 } else { random.log_between(1e-3, 1e3) };
        let [g, u, a, z, omega_a, omega_b, alpha_a, alpha_b] = [v(), v(), v(), v(), v(), v(), v(), v()];
        let state = |position, linear, angular| CertifiedState {
            rotation: DMat3::IDENTITY,
            position,
            at: DVec3::ZERO,
            linear,
            angular,
            rotation_radius: 0.0,
            position_radius: 0.0,
            linear_radius: 0.0,
            angular_radius: 0.0,
        };
        let (sa, sb) = (state(g, u, omega_a), state(DVec3::ZERO, DVec3::ZERO, omega_b));
        let relative = RelativeState::from_balls(
            &sa,
            &sb,
            [still(a), still(DVec3::ZERO)],
            [still(alpha_a), still(alpha_b)],
            0.0,
        );
        // With constant rates, by the product rule in world axes, without Ω.
        let z1 = omega_a.cross(z);
        let z2 = alpha_a.cross(z) + omega_a.cross(z1);
        let z3 = 2.0 * alpha_a.cross(z1) + omega_a.cross(z2);
        let (x, x1, x2) = (g + z, u + z1, a + z2);
        let second = x2 - alpha_b.cross(x) - 2.0 * omega_b.cross(x1) + omega_b.cross(omega_b.cross(x));
        let third = z3 - 3.0 * alpha_b.cross(x1) - 2.0 * omega_b.cross(x2)
            + alpha_b.cross(omega_b.cross(x))
            + omega_b.cross(alpha_b.cross(x) + omega_b.cross(x1))
            - omega_b.cross(second);
        let jet = relative.point_jet(z, z.length(), 0.0);
        assert!(
            (jet.a - second).length()
                <= 1e-12 * (1.0 + second.length()) + relative.remainder(z.length(), 0.0).e2
        );
        let (beta, b, w) = (alpha_b.length(), omega_b.length(), (omega_a - omega_b).length());
        let (lambda, y, speed, rho) = ((alpha_a - alpha_b).length(), g.length(), u.length(), z.length());
        let bound = jet.remainder.m3;
        let left_out = [
            0.0,
            3.0 * beta * speed,
            beta * (omega_b.cross(g).length() + 2.0 * b * y),
            3.0 * b * a.length(),
            b * (3.0 * omega_b.cross(u).length() + b * omega_b.cross(g).length()),
            beta * w * rho,
            2.0 * b * lambda * rho,
            3.0 * w * lambda * rho,
        ];
        for (ratio, term) in largest.iter_mut().zip(left_out) {
            if bound - term > 1e-9 * bound && bound > 0.0 {
                *ratio = ratio.max(third.length() / (bound - term));
            }
        }
    }
    assert!((0.9..=1.0 + 1e-9).contains(&largest[0]), "{largest:?}");
    for (ratio, term) in largest.iter().zip(TERMS).skip(1) {
        assert!(*ratio > 1.01, "without {term}: {ratio}");
    }
}
