//! Two edges, all four vertices on straight paths.
use super::Lines;
use super::linear::{Clearance, Line, Linear, clear_above};
use super::straight_test::{Inside, SeenAlong, StraightFeatures, StraightTest};
use super::triple_product::{Allowed, Seen};
use crate::accurate_cross::{Difference, accurate_cross};
use crate::closest::{self, ClosestPair};
use crate::options::ContactOptions;
use crate::path::direction;
use crate::rounding::{UP, length_up};
use core::marker::PhantomData;
use d2m_root::Piece;
use glam::DVec3;

/// With the difference `w` of the midpoints and the half edges `e`, `d`: `f = w·(e × d)`.
pub(super) struct EdgeEdge;

impl StraightTest<EdgeEdge> {
    #[inline(always)]
    pub(super) fn of_edges(lines: &Lines, options: &ContactOptions) -> Self {
        let combine = |points: &[DVec3; 4]| {
            let w = (points[0] - points[2] + (points[1] - points[3])) * 0.5;
            (w, (points[1] - points[0]) * 0.5, (points[3] - points[2]) * 0.5)
        };
        let (w0, e0, d0) = combine(&lines.start);
        let (w1, e1, d1) = combine(&lines.velocity);
        let error = lines.error(64.0);
        let longest = 2.0 * e0.length_squared().max(d0.length_squared()).sqrt();
        Self {
            features: PhantomData,
            lines: [Line { p: w0, v: w1 }, Line { p: e0, v: e1 }, Line { p: d0, v: d1 }],
            error,
            size: lines.magnitude,
            speed: length_up(w1) + length_up(e1) + length_up(d1),
            tolerance: options.wanted_tolerance(longest, lines.magnitude).max(4.0 * error),
            separation: options.separation(),
            inside: Piece::NONE,
        }
    }
}

impl StraightFeatures for EdgeEdge {
    /// All four vertices `w ± e ± d` on one side throughout, seen along the line of the midpoints.
    #[inline(always)]
    fn are_apart([w, e, d]: &[Line; 3], margin: f64, h: f64) -> bool {
        let n = w.p;
        let margin = margin * length_up(n);
        let (w, e, d) = (w.along(n), e.along(n), d.along(n));
        let clear = |s: f64| w.at(s) - e.at(s).abs() - d.at(s).abs() > margin;
        clear(-h) && clear(h)
    }

    /// w + se = td gives s·N = −n·(w × d) and t·N = −n·(w × e), N = n·(e × d).
    #[inline(always)]
    fn clip_inside([w, e, d]: &[Line; 3], seen: &SeenAlong, meeting: Piece) -> Option<Inside> {
        let SeenAlong { normal: n, length, lengths: [lw, le, ld], allowed, padded } = *seen;
        let (across_d, across_e) = (d.cross(n), e.cross(n));
        let total = Seen::new(e, &across_d, length, [le, ld], Allowed { separation: 0.0, ..allowed });
        let mut part = meeting;
        let mut inside = true;
        for seen in [
            Seen::new(w, &across_d, length, [lw, ld], allowed),
            Seen::new(w, &across_e, length, [lw, le], allowed),
        ] {
            let margin = (total.margin + seen.margin) * UP;
            let (above, below) = (total.quadratic + seen.quadratic, seen.quadratic - total.quadratic);
            part = above.clip_shared_sign_beyond(&below, margin, part)?;
            inside = inside && above.exceeds(margin, padded) && (-below).exceeds(margin, padded);
        }
        Some(Inside { part, is_certain: inside && part == meeting && total.is_positive(padded) })
    }

    #[inline(always)]
    fn closest([w, e, d]: &[Line; 3]) -> ClosestPair {
        closest::segment_segment(w.p, e.p, d.p)
    }

    /// The functions `w ± e ± d`.
    #[inline(always)]
    fn clear_along([w, e, d]: &[Line; 3], n: DVec3, margin: f64) -> Clearance {
        let (w, e, d) = (w.along(n), e.along(n), d.along(n));
        let vertex = |s: f64, t: f64| Linear {
            value: w.value + s * e.value + t * d.value,
            slope: w.slope + s * e.slope + t * d.slope,
        };
        clear_above(&[vertex(1.0, 1.0), vertex(1.0, -1.0), vertex(-1.0, 1.0), vertex(-1.0, -1.0)], margin)
    }

    #[inline(always)]
    fn directions([_, e, d]: &[Line; 3], mut consider: impl FnMut(DVec3)) {
        let k = direction(accurate_cross(Difference::from(e.p), Difference::from(d.p)));
        consider(k);
        consider(-k);
        for edge in [e.p, d.p] {
            let n = direction(direction(edge).cross(k));
            consider(n);
            consider(-n);
        }
    }
}
