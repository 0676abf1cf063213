//! Γ edge/edge, section IV-C of the paper.

use crate::feature::direction::{Direction, across, unit};
use crate::feature::{PointJet, RelativeFrame};
use d2m_interval::{Interval, IntervalVec3};
use d2m_root::InclusionFunction;
use glam::DVec3;

/// An edge of the mover in the observer's frame: one end and the direction to the other, both over a span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeJet {
    pub(crate) start: PointJet,
    pub(crate) direction: [IntervalVec3; 3],
}

impl EdgeJet {
    pub(crate) fn new(frame: &RelativeFrame, edge: [DVec3; 2]) -> Self {
        let direction = frame.direction(IntervalVec3::point(edge[1]) - edge[0]);
        Self { start: frame.jet(edge[0]), direction }
    }

    /// The direction's path as a jet.
    pub(crate) fn direction_jet(&self) -> PointJet {
        PointJet::new(self.start.span(), self.direction)
    }

    /// Encloses n·p over both ends p, hence over the whole edge, for the offsets `x`.
    pub(crate) fn range_along(&self, n: DVec3, x: Interval) -> Interval {
        let a = self.start.range_along(n, x);
        let e: InclusionFunction = self.direction_jet().along(n);
        a.hull(a + e.enclose_at_offset(x))
    }

    /// Does `n` separate the edge from the fixed one at all times of `x`?
    pub(crate) fn certainly_apart_along(&self, n: DVec3, fixed: &[DVec3; 2], x: Interval) -> bool {
        Direction::new(n, fixed).certainly_apart(self.range_along(n, x))
    }
}

/// Squared sine of the angle between two edges from which they count as not parallel: at 10⁻¹⁰ rad rounding turns their cross
/// product by 10⁻⁶. Only a choice of axes hangs on it, and every axis is sound.
const SIN_SQUARED: f64 = 1e-20;

/// `false` promises that the edges do not meet at any time of the offsets `x`.
///
/// The paper projects both thickened edges along k = e × d (for parallel edges along (c − a) × (d − a)) and tests
/// whether two rectangles meet. Two rectangles meet unless one of their four sides' normals separates them: across and
/// along each edge within the plane of projection. Here these four are separating axes of the edges themselves,
/// judged second order in time; a separating axis is sound whatever its direction, so k at the middle of the piece
/// serves for all of it.
///
/// ```text
///        ╲ A   │u      u = d × k across B's edge: both ends of A on one side → apart
///         ╲    │       v = e × k across A's edge, and d, e themselves for the ends
///   ───────╲───┼── B
/// ```
pub(crate) fn gamma_edge_edge(edge: &EdgeJet, fixed: &[DVec3; 2], x: Interval) -> bool {
    let middle = Interval::point(x.mid());
    let e = edge.direction_jet().enclose(middle).mid();
    let d = fixed[1] - fixed[0];
    let (Some(e), Some(d)) = (unit(e), unit(d)) else { return true };
    let k = e.cross(d);
    let k = if k.length_squared() > SIN_SQUARED {
        k
    } else {
        let a = edge.start.enclose(middle).mid();
        unit((fixed[0] - a).cross(fixed[1] - a)).unwrap_or_else(|| across(d))
    };
    for axis in [unit(d.cross(k)), unit(e.cross(k)), Some(d), Some(e)].into_iter().flatten() {
        if edge.certainly_apart_along(axis, fixed, x) {
            return false;
        }
    }
    true
}
