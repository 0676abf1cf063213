//! A sphere that holds a body and moves with constant velocity: when two bodies may meet first, for the price of a square root.

use crate::Body;
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// Covers the roundings of a gap along a direction: two differences of coordinates, two products of three terms, their sum
/// and the length of the direction, fewer than 32 units 2⁻⁵³ of Σ|dₖ| + τ·Σ|wₖ|.
const GAP_ERROR: f64 = 32.0 * f64::EPSILON / 2.0;
/// What six products may lose by underflow, 2⁻¹⁰⁷⁵ each, and more.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;
/// Covers the roundings of the sum of two radii and a separation, and of what the gap is compared with.
const RADIUS_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
/// The part of the time until the spheres would touch, in exact arithmetic, for which a plane is to prove them apart: what is
/// left is more than what rounding takes from it.
const EARLY: f64 = 1.0 - 1.0 / 1_048_576.0;

/// A sphere, over a span of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingSphere {
    /// Where its center is when the span begins.
    center: DVec3,
    velocity: DVec3,
    /// Holds the body, and what center and velocity are rounded by, over the span.
    radius: f64,
}

/// When two bodies may meet first, as times since the spheres begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FirstMeeting {
    /// Proven apart over the whole part of the span.
    Never,
    /// Proven apart from the start of the part up to here, both included.
    After(f64),
    /// Nothing is proven.
    Unknown,
}

impl MovingSphere {
    /// Holds the body where its motion is known, for times since `start`; none if its twist is not constant.
    ///
    /// The reference point of a constant twist moves in a straight line, and every point of the body is within
    /// |center of the mesh − reference point| + radius of the mesh + radius of the body about its mesh of it.
    pub(crate) fn enclose(body: &Body, start: f64) -> Option<Self> {
        let twist = body.motion().constant_twist()?;
        let since = Interval::point(start) - Interval::point(twist.reference_time());
        let path = IntervalVec3::point(twist.linear_velocity()) * since + twist.position();
        let off = IntervalVec3::point(body.tree().center()) - twist.at();
        let center = path.mid();
        let rounded = (path - center).norm();
        let reach = Interval::point(body.tree().radius()) + Interval::point(body.radius());
        let radius = (off.norm() + rounded + reach).hi();
        (radius.is_finite() && body.radius() >= 0.0).then_some(Self {
            center,
            velocity: twist.linear_velocity(),
            radius,
        })
    }

    /// When the two may come within `separation` first, from `begin` to `end`, times since both spheres begin.
    ///
    /// Two points of the spheres are at least n·(d + τw) − r apart, for a unit vector n, the difference d of the centers, w of the
    /// velocities, and the sum r of the radii. That is linear in τ: what is positive at two times is positive between them.
    /// The direction comes from where the spheres would touch first, or pass closest; if that was rounded badly, nothing is
    /// proven.
    pub(crate) fn first_meeting(&self, other: &Self, separation: f64, begin: f64, end: f64) -> FirstMeeting {
        let (d, w) = (other.center - self.center, other.velocity - self.velocity);
        let radius = (self.radius + other.radius + separation) * RADIUS_UP;
        let is_apart = |direction: DVec3, time: f64| {
            let gap = direction.dot(d) + time * direction.dot(w);
            let size = d.abs().element_sum() + time * w.abs().element_sum();
            gap - GAP_ERROR * size > radius + UNDERFLOW
        };
        // What is not a number proves nothing. Squares of coordinates of about one are not lost to underflow: a direction that is
        // longer than one proves what is not true.
        let stays_apart = |between: DVec3, until: f64| {
            let direction = (between / between.abs().max_element()).normalize();
            is_apart(direction, begin) && is_apart(direction, until)
        };
        let first = d + w * begin;
        let (speed_squared, rate) = (w.length_squared(), first.dot(w));
        let room = first.length_squared() - radius * radius;
        if room <= 0.0 {
            return FirstMeeting::Unknown;
        }
        let closest = if speed_squared > 0.0 { (-rate / speed_squared).clamp(0.0, end - begin) } else { 0.0 };
        if stays_apart(first + w * closest, end) {
            return FirstMeeting::Never;
        }
        // The smaller root of |first + τw| = r, without cancellation.
        let root = (rate * rate - speed_squared * room).max(0.0).sqrt();
        let wait = EARLY * room / (root - rate);
        let touch = begin + wait;
        if wait > 0.0 && touch <= end && stays_apart(first + w * wait, touch) {
            return FirstMeeting::After(touch);
        }
        FirstMeeting::Unknown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_bvh::MeshTree;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};
    use std::sync::Arc;

    fn sphere(motion: ConstantTwist) -> MovingSphere {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        MovingSphere::enclose(&Body::new(tree, motion), 2.0).unwrap()
    }

    fn flying(position: DVec3, velocity: DVec3) -> ConstantTwist {
        ConstantTwist::REST.with_position(position).with_linear_velocity(velocity).with_reference_time(2.0)
    }

    #[test]
    fn head_on_passing_by_and_at_rest() {
        let radius = 0.75f64.sqrt();
        let one = sphere(flying(DVec3::ZERO, DVec3::ZERO));
        let meeting = |position: DVec3, velocity: DVec3| {
            one.first_meeting(&sphere(flying(position, velocity)), 0.1, 0.0, 1.0)
        };
        let time = (10.0 - 2.0 * radius - 0.1) / 20.0;
        let FirstMeeting::After(found) = meeting(DVec3::X * 10.0, DVec3::X * -20.0) else { panic!() };
        assert!(found <= time && found > time - 1e-5);
        assert_eq!(meeting(DVec3::X * 10.0, DVec3::X * -8.0), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::new(10.0, 2.0, 0.0), DVec3::X * -20.0), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 3.0, DVec3::ZERO), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 3.0, DVec3::X), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 1.5, DVec3::X), FirstMeeting::Unknown);
        assert_eq!(meeting(DVec3::ZERO, DVec3::X), FirstMeeting::Unknown);
        let huge = flying(DVec3::X * 1e200, DVec3::X * -1e200).with_reference_time(-1e200);
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box").unwrap()));
        assert!(MovingSphere::enclose(&Body::new(tree, huge), 2.0).is_none());
    }

    #[test]
    fn a_sphere_holds_its_body_at_all_times() {
        let mut random = KnuthRandom(17);
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("gear?triangles=500").unwrap()));
        for round in 0..200 {
            let offset = random.vector() * [0.0, 1e5][round % 2];
            let twist = ConstantTwist::REST
                .with_position(random.vector() + offset)
                .with_orientation(glam::DQuat::from_scaled_axis(random.vector() * 3.0))
                .with_linear_velocity(random.vector() * 9.0)
                .with_angular_velocity(random.vector() * 40.0)
                .with_at(random.vector() * 2.0)
                .with_reference_time([0.0, -1e3][round % 2]);
            let body = Body::new(Arc::clone(&tree), twist);
            let start = random.vector().x * 3.0;
            let sphere = MovingSphere::enclose(&body, start).unwrap();
            for k in 0..20 {
                let since = f64::from(k) * 0.1;
                let pose = twist.pose_and_twist(start + since).0;
                let center = sphere.center + sphere.velocity * since;
                for &vertex in tree.mesh().vertices().iter().step_by(7) {
                    let point = pose.rotation * (vertex - pose.at) + pose.translation;
                    assert!(point.distance(center) <= sphere.radius * (1.0 + 1e-9), "round {round}");
                }
            }
        }
    }

    /// Squares of the coordinates of their distance at the end lose a third to underflow in such a unit: a direction divided by that
    /// length was longer than one by a fifth, and so was the gap along it.
    #[test]
    fn spheres_that_end_in_each_other_in_a_tiny_unit() {
        let unit = 1e-162;
        let sphere = |place: f64, velocity: f64| MovingSphere {
            center: DVec3::splat(place * unit),
            velocity: DVec3::splat(velocity * unit),
            radius: 2.6 * unit,
        };
        let meeting = sphere(0.0, 0.0).first_meeting(&sphere(12.7, -10.0), 0.0, 0.0, 1.0);
        assert_ne!(meeting, FirstMeeting::Never);
    }

    /// In units from 1e-161, where squares of lengths are lost to underflow, to 1e153, near and far from the origin, from before and
    /// after the reference time: no point of a sphere is within the separation before the time that is given, and little is given
    /// away.
    #[test]
    fn nothing_is_late_in_any_unit() {
        let mut random = KnuthRandom(3);
        let mut useful = 0;
        for round in 0..20_000 {
            let unit = 10f64.powi([0, 60, -60, 8, -8, 30, -155, -158, -161, 153][round % 10]);
            let offset = random.vector() * [0.0, 1e6, 1e12][round % 3];
            let at = random.vector() * if round % 5 == 0 { 0.3 } else { 0.0 };
            let mut one = || {
                let spread = 4.0 * random.unit();
                let (position, velocity) = (random.vector() * spread, random.vector() * 6.0 * random.unit());
                MovingSphere {
                    center: (offset + position + at) * unit,
                    velocity: velocity * unit,
                    radius: (0.1 + random.unit()) * unit,
                }
            };
            let (a, b) = (one(), one());
            let separation = [0.0, 0.05][round % 2] * unit;
            let begin = [0.0, 0.25][round % 2];
            let meeting = a.first_meeting(&b, separation, begin, 1.0);
            let until = match meeting {
                FirstMeeting::Never => 1.0,
                FirstMeeting::After(time) => time,
                FirstMeeting::Unknown => continue,
            };
            useful += 1;
            let gap = |time: f64| {
                let d = ((b.center - a.center) + (b.velocity - a.velocity) * time) / unit;
                d.length() * unit - (a.radius + b.radius + separation)
            };
            let step = (until - begin) / 64.0;
            let least = (0..=64).map(|k| gap(begin + step * f64::from(k))).fold(f64::INFINITY, f64::min);
            assert!(least >= 0.0, "round {round}: {meeting:?}, {least:e}");
            if let FirstMeeting::After(time) = meeting {
                assert!(gap(time) < 1e-3 * unit, "round {round}: {meeting:?} is early");
            }
        }
        assert!(useful > 4000, "{useful}");
    }
}
