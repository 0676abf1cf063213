//! Spheres that hold moving bodies: how long two of them stay apart, for the price of a square root or two.

use d2m_lanes::power_of_two;
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
/// Covers the roundings of a center that has moved on (the time, its product with a velocity, a sum: three units 2⁻⁵³ of what is added) and
/// of the radius with that.
const MOVED: f64 = 4.0 * f64::EPSILON;
/// Covers the roundings of a distance, of what it loses and of what it is compared with: a difference, a length (three squares, two sums, a
/// root), the same of a speed and its product with a time, three sums, a comparison: fewer than 16 units 2⁻⁵³ of what is added.
const ROOM_ERROR: f64 = 16.0 * f64::EPSILON;
/// More than a length loses whose squares are lost to underflow: 2⁻¹⁰⁷⁵ each, so the root of three of these.
const SQUARES_LOST: f64 = power_of_two(-536);

/// A sphere that moves with constant velocity, world frame. It holds a body, and what its center and velocity are rounded by, over the times
/// that it is made for.
///
/// ```
/// use d2m_feature::{FirstMeeting, MovingSphere};
/// use glam::DVec3;
/// let still = MovingSphere { center: DVec3::ZERO, velocity: DVec3::ZERO, radius: 1.0 };
/// let coming = MovingSphere { center: DVec3::X * 6.0, velocity: DVec3::X * -8.0, radius: 1.0 };
/// assert!(still.stays_apart(&coming, 0.0, 0.49) && !still.stays_apart(&coming, 0.0, 0.51));
/// let FirstMeeting::After(time) = still.first_meeting(&coming, 0.0, 0.0, 1.0) else { panic!("they meet") };
/// assert!(time <= 0.5 && time > 0.4999);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingSphere {
    /// Where its center is at the time that counts as zero.
    pub center: DVec3,
    /// How its center moves.
    pub velocity: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// When two bodies may meet first, as times since their spheres begin.
///
/// ```
/// use d2m_feature::{FirstMeeting, MovingSphere};
/// use glam::DVec3;
/// let sphere = MovingSphere { center: DVec3::ZERO, velocity: DVec3::ZERO, radius: 1.0 };
/// let passing = MovingSphere { center: DVec3::new(9.0, 3.0, 0.0), velocity: DVec3::X * -20.0, ..sphere };
/// assert_eq!(sphere.first_meeting(&passing, 0.0, 0.0, 1.0), FirstMeeting::Never);
/// assert_eq!(sphere.first_meeting(&sphere, 0.0, 0.0, 1.0), FirstMeeting::Unknown);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstMeeting {
    /// Proven apart over the whole part of the span.
    Never,
    /// Proven apart from the start of the part up to here, both included.
    After(f64),
    /// Nothing is proven.
    Unknown,
}

impl MovingSphere {
    /// The sphere as it is after this time, which may be a rounded difference of two times: larger by what that and its place are rounded by.
    ///
    /// ```
    /// use d2m_feature::MovingSphere;
    /// use glam::DVec3;
    /// let sphere = MovingSphere { center: DVec3::ONE, velocity: DVec3::X, radius: 0.5 };
    /// let later = sphere.after(0.1);
    /// assert!(later.center == DVec3::new(1.1, 1.0, 1.0) && later.radius > 0.5 && later.radius < 0.5 + 1e-14);
    /// ```
    #[must_use]
    #[inline]
    pub fn after(&self, elapsed: f64) -> Self {
        let travel = self.velocity * elapsed;
        let size = (self.center.abs() + travel.abs()).element_sum() + self.radius;
        let radius = self.radius + (MOVED * size + UNDERFLOW);
        Self { center: self.center + travel, velocity: self.velocity, radius }
    }

    /// Are the two further apart than `separation` at all times no further than `within` from that of their centers, before and after? That time
    /// may be a rounded difference of two. No where a number is not finite.
    ///
    /// The centers come closer by no more than the speed against each other times the time: |d| − |w|·`within` > r₁ + r₂ + `separation`.
    #[inline]
    pub fn stays_apart(&self, other: &Self, separation: f64, within: f64) -> bool {
        let distance = (other.center - self.center).length();
        let closer = (other.velocity - self.velocity).length() * within;
        let reach = self.radius + other.radius + separation;
        let lost = ROOM_ERROR * (distance + closer + reach) + SQUARES_LOST * (1.0 + within);
        distance - closer - reach > lost
    }

    /// When the two may come within `separation` first, from `begin` to `end`, times since both spheres begin.
    ///
    /// Two points of the spheres are at least n·(d + τw) − r apart, for a unit vector n, the difference d of the centers, w of the
    /// velocities, and the sum r of the radii. That is linear in τ: what is positive at two times is positive between them.
    /// The direction comes from where the spheres would touch first, or pass closest; if that was rounded badly, nothing is
    /// proven.
    pub fn first_meeting(&self, other: &Self, separation: f64, begin: f64, end: f64) -> FirstMeeting {
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
    use d2m_testing::{Draw, KnuthRandom};

    #[test]
    fn head_on_passing_by_and_at_rest() {
        let sphere = |center: DVec3, velocity: DVec3| MovingSphere { center, velocity, radius: 0.875 };
        let one = sphere(DVec3::ZERO, DVec3::ZERO);
        let meeting =
            |position: DVec3, velocity: DVec3| one.first_meeting(&sphere(position, velocity), 0.1, 0.0, 1.0);
        let time = (10.0 - 2.0 * 0.875 - 0.1) / 20.0;
        let FirstMeeting::After(found) = meeting(DVec3::X * 10.0, DVec3::X * -20.0) else { panic!() };
        assert!(found <= time && found > time - 1e-5);
        assert_eq!(meeting(DVec3::X * 10.0, DVec3::X * -8.0), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::new(10.0, 2.0, 0.0), DVec3::X * -20.0), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 3.0, DVec3::ZERO), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 3.0, DVec3::X), FirstMeeting::Never);
        assert_eq!(meeting(DVec3::X * 1.5, DVec3::X), FirstMeeting::Unknown);
        assert_eq!(meeting(DVec3::ZERO, DVec3::X), FirstMeeting::Unknown);
    }

    /// The centers are 2⁵³ + 1.5 apart, which rounds to 2⁵³ + 2; the sum of radii and separation, 2⁵³ + 1.75, rounds to 2⁵³. In a tiny unit the
    /// squares of a distance, or of a speed, are lost.
    #[test]
    fn spheres_that_overlap_by_less_than_rounding_are_not_apart() {
        let sphere =
            |x: f64, radius: f64| MovingSphere { center: DVec3::X * x, velocity: DVec3::ZERO, radius };
        let size = (1u64 << 53) as f64;
        assert!(!sphere(-1.5, size).stays_apart(&sphere(size, 1.0), 0.75, 1.0));
        let apart = |radius: f64, gap: f64| sphere(-1.0, radius).stays_apart(&sphere(1.0, 0.9), gap, 1.0);
        assert!(apart(0.9, 0.1) && !apart(0.9, 0.21) && !apart(f64::NAN, 0.1) && !apart(0.9, f64::NAN));
        let [one, two] =
            [-0.5, 0.5].map(|x| MovingSphere { center: DVec3::splat(x * 1e-162), ..sphere(0.0, 0.9e-162) });
        assert!(!one.stays_apart(&two, 0.0, 0.0));
        let slow = MovingSphere { center: DVec3::X * 1e-100, velocity: DVec3::X * -1e-170, radius: 0.0 };
        assert!(
            !sphere(0.0, 0.0).stays_apart(&slow, 0.0, 2e70) && slow.stays_apart(&sphere(0.0, 0.0), 0.0, 1e50)
        );
    }

    /// In many units, near and far from the origin: at no time within the one given the spheres are as near as that, and a sphere after a
    /// time holds that from before it.
    #[test]
    fn what_stays_apart_does_so_before_and_after() {
        let mut random = KnuthRandom(29);
        let (mut proven, mut missed) = (0, 0);
        for round in 0..20_000 {
            let unit = 10f64.powi([0, 60, -60, 8, -8][round % 5]);
            let offset = random.vector() * [0.0, 1e6, 1e12][round % 3];
            let mut one = || MovingSphere {
                center: (offset + random.vector() * 4.0) * unit,
                velocity: random.vector() * 3.0 * unit,
                radius: (0.1 + random.unit()) * unit,
            };
            let (a, b) = (one(), one());
            let (separation, within) = ([0.0, 0.05][round % 2] * unit, random.unit());
            let elapsed = random.vector().x * 3.0;
            let [c, d] = [&a, &b].map(|sphere| sphere.after(elapsed));
            let gap = |time: f64| {
                let d = ((b.center - a.center) + (b.velocity - a.velocity) * (elapsed + time)) / unit;
                d.length() * unit - (a.radius + b.radius + separation)
            };
            let least = (-32..=32).map(|k| gap(within * f64::from(k) / 32.0)).fold(f64::INFINITY, f64::min);
            let is_apart = c.stays_apart(&d, separation, within);
            assert_eq!(is_apart, d.stays_apart(&c, separation, within));
            assert!(!is_apart || least > 0.0, "round {round}: {least:e}");
            // Past each other: the speed counts as if all of it brought them closer.
            let closing = (b.velocity - a.velocity).length() * within;
            (proven, missed) = (
                proven + usize::from(is_apart),
                missed + usize::from(!is_apart && gap(0.0) > closing + 0.01 * unit),
            );
        }
        assert!(proven > 4000 && missed == 0, "{proven} {missed}");
    }

    #[test]
    fn a_sphere_after_a_time_holds_where_it_is_then() {
        let size = (1u64 << 53) as f64;
        // 2⁵³ + 1 is no number.
        let sphere = MovingSphere { center: DVec3::splat(size), velocity: DVec3::ONE, radius: 1.0 };
        let after = sphere.after(1.0);
        assert!(after.radius - 1.0 >= 3f64.sqrt() * (size + 1.0 - after.center.x).abs().max(1.0));
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
