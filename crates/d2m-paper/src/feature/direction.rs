//! A direction together with the extent of a fixed feature along it.

use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// A direction d (any vector) and the extent \[min d·b, max d·b\] of the convex hull of some fixed points b.
///
/// A point q of another convex set can only meet the hull if d·q lies in the extent. That is true for *every* d, so
/// no error in the direction can lose a contact; a poor direction only excludes less.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_paper::Direction;
/// use glam::DVec3;
/// let along = Direction::new(DVec3::X, &[DVec3::ZERO, DVec3::X * 2.0]);
/// assert!(along.extent.contains(0.0) && along.extent.contains(2.0));
/// assert!(along.certainly_apart(Interval::new(2.5, 3.0)) && !along.certainly_apart(Interval::new(1.5, 3.0)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    /// The vector d, the frame of the fixed feature.
    pub vector: DVec3,
    /// Encloses \[min d·b, max d·b\].
    pub extent: Interval,
}

impl Direction {
    /// The extent of the hull of `points` along `vector`.
    ///
    /// # Panics
    /// If `points` is empty.
    pub fn new(vector: DVec3, points: &[DVec3]) -> Self {
        let extent = points
            .iter()
            .map(|&p| IntervalVec3::point(p).dot_point(vector))
            .reduce(Interval::hull)
            .expect("a feature has at least one point");
        Self { vector, extent }
    }

    /// Is every value of `values` = d·q off the extent, on one side?
    pub fn certainly_apart(&self, values: Interval) -> bool {
        values.lo() > self.extent.hi() || values.hi() < self.extent.lo()
    }
}

/// The unit vector along `v`, safe against overflow and underflow; `None` for zero or not finite.
pub(crate) fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if !(largest > 0.0 && largest < f64::INFINITY) {
        return None;
    }
    let scaled = v / largest;
    let u = scaled / scaled.length();
    u.is_finite().then_some(u)
}

/// Any unit vector across `v`.
pub(crate) fn across(v: DVec3) -> DVec3 {
    let a = v.abs();
    let axis = if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.y <= a.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    unit(v.cross(axis)).unwrap_or(DVec3::X)
}
