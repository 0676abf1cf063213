//! Boxes that move over a span of time: are two of them apart at all times of it?

use crate::body_box::BodyBox;
use d2m_motion::SpanMotion;
use glam::{DMat3, DVec3};

/// More than the roundings of a gap along a direction add up to, in parts of the lengths that are added: differences and products
/// of three coordinates, turned axes and their sums, fewer than 64 times half a unit in the last place.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;
/// Sums and products of non-negative bounds, rounded up: fewer than 32 of them.
const UP: f64 = 1.0 + 16.0 * f64::EPSILON;
/// Square of the sine below which the axis across two edges is left out: 2⁻²⁰. One box turned by that angle, 2⁻¹⁰, has an edge
/// parallel to one of the other, and faces separate such boxes; so the gap that is found is less by 2⁻¹⁰ of the radius at most.
const LEAST_SINE_SQUARED: f64 = 1.0 / 1_048_576.0;

/// A box over a span of time, in the frame that it is seen from. Its center is at c + τv at the time τ from the middle of the
/// span, a point of it at R(τ)e from there; what that leaves out is within `blur`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SweptBox {
    center: DVec3,
    velocity: DVec3,
    spin: DVec3,
    axes: DMat3,
    half: DVec3,
    radius: f64,
    /// Bound of what center and turn leave out, over the span.
    blur: f64,
}

/// What is known of two boxes over a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sweep {
    /// Proven: further apart than the separation at all times of the span.
    Apart,
    /// Not proven. In the middle of the span the boxes seem apart, and motion takes so many times the room between them.
    Near { taken: f64 },
    /// Not proven, and in the middle of the span the boxes seem to meet.
    Meeting,
}

impl SweptBox {
    /// A box that `carrier` carries, over a span that reaches `half` to either side of its middle.
    ///
    /// With R₀ the true rotation in the middle, within r of the given one, ω̃ the middle of the angular velocities, which are within w
    /// of it, Ω = |ω̃| + w and |e| ≤ ρ: R(τ)e − R₀e = ∫ω × Re, so it differs from τ·ω̃ × R̃e by at most
    /// |τ|wρ + ½τ²|ω̃|Ωρ + |τ||ω̃|rρ, and R₀e from R̃e by rρ.
    pub(crate) fn carried(body: &BodyBox, carrier: &SpanMotion, half: f64) -> Self {
        let seen = carrier.following(body.center);
        let (turn, speed) = (seen.rotation_radius, seen.angular.center.length() * UP);
        let (wide, most) = (seen.angular.radius, speed + seen.angular.radius);
        let turned = turn + half * (wide + speed * turn + 0.5 * half * speed * most);
        let rounded = ROUNDINGS * (body.radius * (1.0 + half * speed) + seen.position.center.length());
        let moved = seen.position.radius + half * seen.linear.radius;
        Self {
            center: seen.position.center,
            velocity: seen.linear.center,
            spin: seen.angular.center,
            axes: seen.rotation * body.axes,
            half: body.half,
            radius: body.radius,
            blur: (moved + turned * (body.radius + body.blur) + body.blur + rounded) * UP,
        }
    }

    /// Are the two further apart than `separation` at all times of the span?
    ///
    /// Along a fixed direction n two points are at n·(d + τv) + n·(R_b(τ)e_b − R_a(τ)e_a), at least
    /// n·d + τn·v − Σ half_a|axis_a·(n + τn × ω_a)| − Σ half_b|axis_b·(n + τn × ω_b)| less both blurs times |n|: concave in τ, so that
    /// what holds at both ends of the span holds between them. The direction is the one of those of the boxes at rest (centers, faces,
    /// pairs of edges) along which most is left.
    pub(crate) fn against(&self, other: &Self, half: f64, separation: f64) -> Sweep {
        let (d, v) = (other.center - self.center, other.velocity - self.velocity);
        let blur = (self.blur + other.blur + separation) * UP;
        let apart = d.length();
        // Spheres first: no direction is needed, and most pairs are far from each other.
        let closing = half * v.length();
        let reach = self.radius + other.radius + blur;
        if (apart - closing) > reach + ROUNDINGS * (apart + closing + reach) {
            return Sweep::Apart;
        }
        let best = self.best_direction(other, [d, v], half);
        if self.is_apart_along(best.along, other, half, blur) {
            return Sweep::Apart;
        }
        let room = best.gap - separation;
        let taken = best.closing + self.blur + other.blur;
        if room > 0.0 { Sweep::Near { taken: taken / room } } else { Sweep::Meeting }
    }

    /// The direction along which most is left of the gap of the boxes after what their centers' motion takes.
    fn best_direction(&self, other: &Self, [d, v]: [DVec3; 2], half: f64) -> Direction {
        let mut best =
            Direction { along: DVec3::X, gap: f64::NEG_INFINITY, closing: 0.0, left: f64::NEG_INFINITY };
        let turning = |of: &Self| of.spin.length() * of.radius;
        let turning = turning(self) + turning(other);
        let mut consider = |direction: DVec3, gap: f64| {
            let closing = half * (direction.dot(v).abs() + turning);
            let left = gap - closing;
            if left > best.left {
                best = Direction { along: direction, gap, closing, left };
            }
        };
        let between = self.axes.transpose() * other.axes;
        let spread = DMat3::from_cols(between.x_axis.abs(), between.y_axis.abs(), between.z_axis.abs());
        let (da, db) = (self.axes.transpose() * d, other.axes.transpose() * d);
        let along_a = spread * other.half;
        let along_b = spread.transpose() * self.half;
        for k in 0..3 {
            consider(self.axes.col(k) * da[k].signum(), da[k].abs() - self.half[k] - along_a[k]);
            consider(other.axes.col(k) * db[k].signum(), db[k].abs() - other.half[k] - along_b[k]);
        }
        let apart = d.length();
        if apart > 0.0 {
            let n = d / apart;
            let reach = |of: &Self| (of.axes.transpose() * n).abs().dot(of.half);
            consider(n, apart - reach(self) - reach(other));
        }
        for i in 0..3 {
            for j in 0..3 {
                let square = 1.0 - between.col(j)[i] * between.col(j)[i];
                if square < LEAST_SINE_SQUARED {
                    continue;
                }
                let n = self.axes.col(i).cross(other.axes.col(j)) / square.sqrt();
                let at = n.dot(d);
                let reach = |of: &Self| (of.axes.transpose() * n).abs().dot(of.half);
                consider(n * at.signum(), at.abs() - reach(self) - reach(other));
            }
        }
        best
    }

    /// The proof of [`SweptBox::against`] for one direction, which need not be of length one.
    fn is_apart_along(&self, n: DVec3, other: &Self, half: f64, blur: f64) -> bool {
        let (d, v) = (other.center - self.center, other.velocity - self.velocity);
        let long = n.length() * UP;
        let size = d.abs().element_sum() + half * v.abs().element_sum();
        let turned = |of: &Self| of.half.element_sum() * (1.0 + half * of.spin.length());
        let lost = long * (blur + ROUNDINGS * (size + turned(self) + turned(other))) * UP + f64::MIN_POSITIVE;
        [-half, half].into_iter().all(|time| {
            let reach = |of: &Self| {
                let direction = n + n.cross(of.spin) * time;
                (of.axes.transpose() * direction).abs().dot(of.half)
            };
            // What is not a number is not apart.
            n.dot(d) + time * n.dot(v) - reach(self) - reach(other) > lost
        })
    }
}

/// A direction, and the gap of two boxes along it in the middle of a span.
struct Direction {
    along: DVec3,
    gap: f64,
    /// About what the motion takes of it.
    closing: f64,
    left: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::{ConstantTwist, CoveredMotion, RigidMotion};
    use d2m_testing::{Draw, Random};
    use glam::DQuat;

    const HALF: f64 = 0.5;

    /// A box that flies and turns, by its corners.
    struct Flying {
        corners: Vec<DVec3>,
        motion: ConstantTwist,
    }

    impl Flying {
        fn random(random: &mut Random) -> Self {
            let half = DVec3::new(0.5, 0.1, 0.05) + 0.1 * random.unit();
            let side = |bit: usize, k: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corners = (0..8).map(|k| half * DVec3::new(side(0, k), side(1, k), side(2, k)));
            let motion = ConstantTwist::REST
                .with_position(random.vector() * 1.2)
                .with_orientation(DQuat::from_scaled_axis(random.vector() * 2.0))
                .with_linear_velocity(random.vector() * [0.0, 0.5, 2.0][random.index(3)])
                .with_angular_velocity(random.vector() * [0.0, 0.5, 2.0][random.index(3)])
                .with_at(random.vector());
            Self { corners: corners.collect(), motion }
        }

        fn swept(&self) -> SweptBox {
            let body = BodyBox::around(&self.corners, &ConstantTwist::REST.enclose_state(0.0));
            let covered = CoveredMotion::try_new(&self.motion, -HALF, HALF).unwrap();
            SweptBox::carried(&body, &covered.span_motion(0.0).unwrap(), HALF)
        }

        fn placed(&self, time: f64) -> Vec<DVec3> {
            let pose = self.motion.pose_and_twist(time).0;
            self.corners.iter().map(|&corner| pose.transform_point(corner)).collect()
        }
    }

    /// The largest gap of two boxes along any of the fifteen directions that can separate boxes: above zero exactly when they are.
    fn gap(a: &[DVec3], b: &[DVec3]) -> f64 {
        let edges = |of: &[DVec3]| [of[1] - of[0], of[2] - of[0], of[4] - of[0]].map(DVec3::normalize);
        let (ea, eb) = (edges(a), edges(b));
        let across = ea.iter().flat_map(|&x| eb.iter().map(move |&y| x.cross(y)));
        let directions =
            ea.into_iter().chain(eb).chain(across.filter(|n| n.length() > 1e-9).map(DVec3::normalize));
        let least = |of: &[DVec3], n: DVec3| of.iter().map(|p| p.dot(n)).fold(f64::INFINITY, f64::min);
        directions
            .map(|n| (least(b, n) + least(a, -n)).max(least(a, n) + least(b, -n)))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn boxes_proven_apart_are_so_at_all_times() {
        let mut random = Random(11);
        let (mut proven, mut missed) = (0, 0);
        for round in 0..20_000 {
            let (a, b) = (Flying::random(&mut random), Flying::random(&mut random));
            let separation = [0.0, 0.1][round % 2];
            let answer = a.swept().against(&b.swept(), HALF, separation);
            assert_eq!(
                answer == Sweep::Apart,
                b.swept().against(&a.swept(), HALF, separation) == Sweep::Apart
            );
            let times = (0..=16).map(|k| HALF * (f64::from(k) / 8.0 - 1.0));
            let least = times.map(|t| gap(&a.placed(t), &b.placed(t))).fold(f64::INFINITY, f64::min);
            // A gap along a direction is not more than the distance.
            if answer == Sweep::Apart {
                proven += 1;
                assert!(least > 0.0, "round {round}: {least:e}");
                if separation > 0.0 {
                    // Corners to corners bound the distance from above.
                    let near = |t: f64| {
                        let (p, q) = (a.placed(t), b.placed(t));
                        p.iter()
                            .flat_map(|x| q.iter().map(move |y| x.distance(*y)))
                            .fold(f64::INFINITY, f64::min)
                    };
                    assert!([-HALF, 0.0, HALF].into_iter().all(|t| near(t) > separation), "round {round}");
                }
            } else if least > separation + 0.3 {
                missed += 1;
            }
        }
        assert!(proven > 4000 && missed < proven, "{proven} {missed}");
    }

    /// The same on the edge: a box that comes as near as the separation at the end of the span, and one that stays a hair away.
    #[test]
    fn a_gap_that_closes_at_the_end_of_the_span_is_seen() {
        let body = BodyBox {
            center: DVec3::ZERO,
            axes: DMat3::IDENTITY,
            half: DVec3::splat(0.5),
            radius: 0.75_f64.sqrt(),
            blur: 0.0,
        };
        let moving = |x: f64, speed: f64| {
            let motion =
                ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * speed);
            let covered = CoveredMotion::try_new(&motion, -HALF, HALF).unwrap();
            SweptBox::carried(&body, &covered.span_motion(0.0).unwrap(), HALF)
        };
        let still = moving(0.0, 0.0);
        for speed in [2.0_f64, -2.0, 0.0] {
            let reach = 1.0 + speed.abs() * HALF;
            assert_ne!(still.against(&moving(reach, speed), HALF, 0.0), Sweep::Apart);
            assert_eq!(still.against(&moving(reach + 1e-9, speed), HALF, 0.0), Sweep::Apart);
            assert_ne!(still.against(&moving(reach + 0.25, speed), HALF, 0.25), Sweep::Apart);
            assert_eq!(still.against(&moving(reach + 0.25 + 1e-9, speed), HALF, 0.25), Sweep::Apart);
        }
    }

    #[test]
    fn what_is_unknown_is_never_apart() {
        let one = Flying::random(&mut Random(1)).swept();
        let far = SweptBox { center: DVec3::X * 1e3, ..one };
        assert_eq!(one.against(&far, HALF, 0.0), Sweep::Apart);
        let unknown = [
            SweptBox { blur: f64::INFINITY, ..far },
            SweptBox { blur: f64::NAN, ..far },
            SweptBox { velocity: DVec3::NAN, ..far },
            SweptBox { spin: DVec3::NAN, center: one.center + DVec3::X, ..far },
            SweptBox { center: DVec3::NAN, ..far },
            SweptBox { axes: DMat3::NAN, center: one.center + DVec3::X, ..far },
        ];
        for of in unknown {
            assert_ne!(one.against(&of, HALF, 0.0), Sweep::Apart, "{of:?}");
        }
        assert_ne!(one.against(&far, HALF, f64::NAN), Sweep::Apart);
    }
}
