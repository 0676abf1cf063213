//! Axis-aligned boxes that are rounded outward.

use d2m_bvh::MeshTree;
use d2m_feature::MovingSphere;
use d2m_motion::IntervalPose;
use glam::DVec3;

/// An axis-aligned box, world frame: what it is about lies between `low` and `high`, both included.
///
/// Every comparison errs on "may meet": an end that is not a number excludes nothing.
///
/// ```
/// use d2m_world::Aabb;
/// use glam::DVec3;
/// let one = Aabb { low: DVec3::ZERO, high: DVec3::ONE };
/// let other = Aabb { low: DVec3::X * 1.5, high: DVec3::new(2.0, 1.0, 1.0) };
/// assert!(!one.may_meet(&other, 0.25) && one.may_meet(&other, 0.5));
/// assert!(one.joined(&other).holds(&other) && !one.holds(&other));
/// let unknown = Aabb { high: DVec3::NAN, ..one };
/// assert!(unknown.may_meet(&other, 0.0) && !one.holds(&unknown));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinates.
    pub low: DVec3,
    /// The greatest coordinates.
    pub high: DVec3,
}

impl Aabb {
    /// The box that holds nothing, as of a body that was removed.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Encloses every point within `radius` of a mesh, in each of these poses. A radius that is none (negative, not finite) makes a box
    /// that excludes nothing.
    ///
    /// ```
    /// use d2m_bvh::MeshTree;
    /// use d2m_interval::Interval;
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// use d2m_world::Aabb;
    /// use glam::DVec3;
    /// let cube = MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?); // edges of length 1
    /// let way = ConstantTwist::REST.with_linear_velocity(DVec3::X * 8.0).enclose_pose(Interval::new(0.0, 1.0));
    /// let swept = Aabb::enclose(&cube, &way, 0.25);
    /// assert!(swept.holds(&Aabb { low: DVec3::splat(-0.75), high: DVec3::new(8.75, 0.75, 0.75) }));
    /// assert!(swept.high.x < 8.76 && swept.high.y < 0.76);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn enclose(tree: &MeshTree, poses: &IntervalPose, radius: f64) -> Self {
        let bounds = tree.enclose_placed(poses);
        let bounds = Self { low: bounds.lo(), high: bounds.hi() };
        if radius == 0.0 {
            return bounds;
        }
        bounds.grown(if radius > 0.0 && radius.is_finite() { radius } else { f64::NAN })
    }

    /// Encloses a sphere at all times from that of its center until so much later (or before), which may be a rounded difference of two times.
    ///
    /// ```
    /// use d2m_feature::MovingSphere;
    /// use d2m_world::Aabb;
    /// use glam::DVec3;
    /// let sphere = MovingSphere { center: DVec3::ZERO, velocity: DVec3::X * 8.0, radius: 1.0 };
    /// let swept = Aabb::enclose_sphere(&sphere, 0.5);
    /// assert!(swept.holds(&Aabb { low: DVec3::splat(-1.0), high: DVec3::new(5.0, 1.0, 1.0) }) && swept.high.x < 5.01);
    /// ```
    pub fn enclose_sphere(sphere: &MovingSphere, elapsed: f64) -> Self {
        let last = sphere.after(elapsed);
        Self { low: sphere.center.min(last.center), high: sphere.center.max(last.center) }.grown(last.radius)
    }

    /// Holds every point within this distance (which is not negative) of the box, along each axis.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self { low: self.low.map(|x| (x - by).next_down()), high: self.high.map(|x| (x + by).next_up()) }
    }

    /// Holds both: everything if an end of one is not a number.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let is_unordered = |of: &Self| of.low.is_nan() || of.high.is_nan();
        if is_unordered(self) || is_unordered(other) {
            return Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };
        }
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Is every point of the other box in this one? No when an end is not a number.
    pub fn holds(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && self.high.cmpge(other.high).all()
    }

    /// Is this [`Self::EMPTY`]?
    pub fn is_empty(&self) -> bool {
        self.low.x > self.high.x
    }

    /// Can a point of one box be within `separation` of one of the other? Along each axis the further end is moved by the
    /// separation and rounded up, so "no" is proven; an end that is not a number compares false and excludes nothing.
    #[inline(always)]
    pub fn may_meet(&self, other: &Self, separation: f64) -> bool {
        let apart = |low: f64, high: f64| low > round_up_sum(high, separation);
        let apart_along = |a: f64, b: f64, c: f64, d: f64| apart(a, d) || apart(c, b);
        !(apart_along(self.low.x, self.high.x, other.low.x, other.high.x)
            || apart_along(self.low.y, self.high.y, other.low.y, other.high.y)
            || apart_along(self.low.z, self.high.z, other.low.z, other.high.z))
    }
}

/// A number that is not below the exact sum; x itself when nothing is added.
#[inline(always)]
fn round_up_sum(x: f64, separation: f64) -> f64 {
    if separation == 0.0 { x } else { (x + separation).next_up() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever is not a number, in either box or as a radius, excludes nothing and holds nothing.
    #[test]
    fn what_is_no_number_may_meet_everything() {
        let cube = Aabb { low: DVec3::ZERO, high: DVec3::ONE };
        let far = Aabb { low: DVec3::splat(8.0), high: DVec3::splat(9.0) };
        assert!(!cube.may_meet(&far, 0.0));
        for axis in 0..3 {
            let (mut low, mut high) = (far, far);
            low.low[axis] = f64::NAN;
            high.high[axis] = f64::NAN;
            // Along the other axes the boxes are apart still.
            assert!(!cube.may_meet(&low, 0.0) && !cube.may_meet(&high, 0.0));
            assert!(!cube.holds(&low) && !low.holds(&low) && !far.joined(&cube).holds(&high));
            assert_eq!(cube.joined(&low), Aabb { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY });
        }
        let tree = MeshTree::new(d2m_shapes::mesh("box").unwrap());
        let rest = d2m_motion::RigidMotion::enclose_pose(
            &d2m_motion::ConstantTwist::REST,
            d2m_interval::Interval::point(0.0),
        );
        for radius in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(Aabb::enclose(&tree, &rest, radius).may_meet(&far, 0.0), "{radius}");
        }
        assert!(!Aabb::EMPTY.may_meet(&cube, 0.0) && Aabb::EMPTY.is_empty() && !cube.is_empty());
    }

    /// Ends that rounding moves inward, by the separation and by growing: 2⁵³ + 1 is no number.
    #[test]
    fn sums_of_ends_are_rounded_outward() {
        let size = (1u64 << 53) as f64;
        let one = Aabb { low: DVec3::splat(-size), high: DVec3::splat(size) };
        let other = Aabb { low: DVec3::splat(size + 2.0), high: DVec3::splat(size + 4.0) };
        assert!(one.may_meet(&other, 1.5) && !one.may_meet(&other, 0.0));
        let grown = one.grown(1.0);
        assert!(grown.low.x <= -size - 2.0 && grown.high.x >= size + 2.0);
    }
}
