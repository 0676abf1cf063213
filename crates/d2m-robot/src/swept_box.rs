//! Boxes that move over a span of time: are two of them apart at all times of it?

use crate::body_box::BodyBox;
use d2m_feature::MovingSphere;
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
        // Spheres first: no direction is needed, and most pairs are far from each other.
        if self.sphere().stays_apart(&other.sphere(), separation, half) {
            return Sweep::Apart;
        }
        let (d, v) = (other.center - self.center, other.velocity - self.velocity);
        let blur = (self.blur + other.blur + separation) * UP;
        let seen = SeenBoxes::new(self, other, [d, v], half);
        let mut best = seen.best_face();
        if best.gap > blur && self.is_apart_along(best.along, other, half, blur) {
            return Sweep::Apart;
        }
        // Most that are apart are so along a face.
        let edges = seen.best_edges();
        if edges.left > best.left {
            best = edges;
            if self.is_apart_along(best.along, other, half, blur) {
                return Sweep::Apart;
            }
        }
        let room = best.gap - separation;
        let taken = best.closing + self.blur + other.blur;
        if room > 0.0 { Sweep::Near { taken: taken / room } } else { Sweep::Meeting }
    }

    /// Holds the box over the span, as it is at the middle.
    fn sphere(&self) -> MovingSphere {
        let radius = (self.radius + self.blur) * UP;
        MovingSphere { center: self.center, velocity: self.velocity, radius }
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

/// Two boxes in the middle of a span, each in the axes of both: what directions are chosen by. Nothing is proven here.
struct SeenBoxes<'a> {
    boxes: [&'a SweptBox; 2],
    /// Column j is axis j of the second box in the axes of the first; and its absolute values.
    between: DMat3,
    spread: DMat3,
    /// From the first center to the second, in the axes of the first, and how that changes.
    apart: DVec3,
    velocity: DVec3,
    half: f64,
    /// What turning may take of a gap, at most, in the time from the middle to an end.
    turning: f64,
}

impl<'a> SeenBoxes<'a> {
    fn new(a: &'a SweptBox, b: &'a SweptBox, [d, v]: [DVec3; 2], half: f64) -> Self {
        let own = a.axes.transpose();
        let between = own * b.axes;
        let spread = DMat3::from_cols(between.x_axis.abs(), between.y_axis.abs(), between.z_axis.abs());
        let turning = half * (a.spin.length() * a.radius + b.spin.length() * b.radius);
        Self { boxes: [a, b], between, spread, apart: own * d, velocity: own * v, half, turning }
    }

    /// Along a direction of length one (in the axes of the first box) with this gap.
    fn along(&self, direction: DVec3, gap: f64) -> Direction {
        let closing = self.half * direction.dot(self.velocity).abs() + self.turning;
        Direction { along: direction, gap, closing, left: gap - closing }
    }

    /// In the axes that the boxes are given in.
    fn turned(&self, best: Direction) -> Direction {
        Direction { along: self.boxes[0].axes * best.along, ..best }
    }

    /// The direction along which most is left after what the motion takes, among the faces of both boxes and the line of their centers.
    fn best_face(&self) -> Direction {
        let [a, b] = self.boxes.map(|of| of.half);
        let mut best = Direction::WORST;
        let mut consider = |found: Direction| {
            if found.left > best.left {
                best = found;
            }
        };
        let reach_b = self.spread * b;
        let reach_a = self.spread.transpose() * a;
        let of_b = self.between.transpose() * self.apart;
        for k in 0..3 {
            let own = DVec3::AXES[k] * self.apart[k].signum();
            consider(self.along(own, self.apart[k].abs() - a[k] - reach_b[k]));
            let other = self.between.col(k) * of_b[k].signum();
            consider(self.along(other, of_b[k].abs() - b[k] - reach_a[k]));
        }
        let length = self.apart.length();
        if length > 0.0 {
            let n = self.apart / length;
            let reach = n.abs().dot(a) + (self.between.transpose() * n).abs().dot(b);
            consider(self.along(n, length - reach));
        }
        self.turned(best)
    }

    /// The same among the directions across an edge of each: with eᵢ × bⱼ, whose components are those of bⱼ, every reach has two terms.
    fn best_edges(&self) -> Direction {
        let [a, b] = self.boxes.map(|of| of.half);
        let mut best = Direction::WORST;
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (column, spread) = (self.between.col(j), self.spread.col(j));
                let square = 1.0 - column[i] * column[i];
                if square < LEAST_SINE_SQUARED {
                    continue;
                }
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                let long = square.sqrt();
                let at = self.apart[i2] * column[i1] - self.apart[i1] * column[i2];
                let reach = a[i1] * spread[i2]
                    + a[i2] * spread[i1]
                    + b[j1] * self.spread.col(j2)[i]
                    + b[j2] * self.spread.col(j1)[i];
                let moved = self.velocity[i2] * column[i1] - self.velocity[i1] * column[i2];
                let gap = (at.abs() - reach) / long;
                let closing = self.half * moved.abs() / long + self.turning;
                let left = gap - closing;
                if left > best.left {
                    let along = DVec3::AXES[i].cross(column) * (at.signum() / long);
                    best = Direction { along, gap, closing, left };
                }
            }
        }
        self.turned(best)
    }
}

/// A direction, and the gap of two boxes along it in the middle of a span.
#[derive(Clone, Copy)]
struct Direction {
    along: DVec3,
    gap: f64,
    /// About what the motion takes of it.
    closing: f64,
    left: f64,
}

impl Direction {
    /// Any other is better.
    const WORST: Self =
        Self { along: DVec3::X, gap: f64::NEG_INFINITY, closing: 0.0, left: f64::NEG_INFINITY };
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

    /// A rod that turns towards a box sweeps its tip into it: nothing but the turn of the direction sees that, since the centers rest and
    /// what the proof leaves out of a turn is of second order. Each body turns once, to either side, and each is once the first of the pair.
    #[test]
    fn a_tip_that_turns_into_a_box_is_seen() {
        let block = |half: DVec3| BodyBox {
            center: DVec3::ZERO,
            axes: DMat3::IDENTITY,
            half,
            radius: half.length(),
            blur: 0.0,
        };
        let moving = |body: &BodyBox, at: DVec3, spin: DVec3| {
            let motion = ConstantTwist::REST.with_position(at).with_angular_velocity(spin);
            let covered = CoveredMotion::try_new(&motion, -HALF, HALF).unwrap();
            SweptBox::carried(body, &covered.span_motion(0.0).unwrap(), HALF)
        };
        let (rod, cube) = (block(DVec3::new(1.0, 0.01, 0.01)), block(DVec3::splat(0.05)));
        for spin in [0.2, -0.2_f64] {
            // At an end of the span the tip has risen by sin(0.1), and what rises of the rod at x = 0.9 is 0.9·tan(0.1).
            let rises = 0.9 * (spin.abs() * HALF).tan();
            for (gap, is_apart) in [(0.5 * rises, false), (0.9 * rises, false), (1.25 * rises, true)] {
                let rod = moving(&rod, DVec3::ZERO, DVec3::Z * spin);
                let cube = moving(&cube, DVec3::new(0.9, 0.01 + 0.05 + gap, 0.0), DVec3::ZERO);
                let found = [rod.against(&cube, HALF, 0.0), cube.against(&rod, HALF, 0.0)];
                assert_eq!(found.map(|sweep| sweep == Sweep::Apart), [is_apart; 2], "{spin} {gap}");
            }
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
