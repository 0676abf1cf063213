//! Axis-aligned boxes that a body never leaves: over a whole time span, and over slices of it.

use crate::Body;
use d2m_bvh::{MeshTree, Moving, Window};
use d2m_interval::IntervalVec3;
use d2m_motion::{CoveredMotion, OutsideDomain};
use glam::DVec3;

/// Slices of a time span. A pair whose boxes over the whole span overlap is apart in most slices if the bodies move far.
pub(crate) const SLICES: usize = 16;

/// A body over a span of time that its motion covers: boxes are made of no other.
#[derive(Clone, Copy)]
pub(crate) struct CoveredBody<'a> {
    tree: &'a MeshTree,
    motion: CoveredMotion<'a>,
    radius: f64,
}

impl<'a> CoveredBody<'a> {
    /// A body from one time to another, both included.
    ///
    /// # Errors
    /// The motion does not cover both.
    pub(crate) fn try_new(body: &'a Body, from: f64, to: f64) -> Result<Self, OutsideDomain> {
        let motion = CoveredMotion::try_new(body.motion(), from, to)?;
        Ok(Self { tree: body.tree(), motion, radius: body.radius() })
    }

    /// The same of a body in the form of pair queries.
    ///
    /// # Errors
    /// The motion does not cover both.
    pub(crate) fn of_moving(body: &Moving<'a>, from: f64, to: f64) -> Result<Self, OutsideDomain> {
        let motion = CoveredMotion::try_new(body.motion, from, to)?;
        Ok(Self { tree: body.body, motion, radius: body.radius })
    }

    fn part(self, from: f64, to: f64) -> Option<Self> {
        Some(Self { motion: self.motion.part(from, to)?, ..self })
    }
}

/// An axis-aligned box, world frame. Every comparison errs on "may meet".
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SweptBox {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl SweptBox {
    /// The empty box, of a body that was removed.
    pub(crate) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Encloses every point of a body at every time of its span.
    pub(crate) fn enclose(body: CoveredBody<'_>) -> Self {
        let bounds: IntervalVec3 = body.tree.enclose_placed(&body.motion.enclose_pose());
        Self { low: bounds.lo(), high: bounds.hi() }.grown(body.radius)
    }

    /// Holds what is within a radius of the box. A radius that is none (negative, not finite) makes a box that excludes nothing, so
    /// that the query of a pair refuses it.
    fn grown(self, radius: f64) -> Self {
        if radius == 0.0 {
            return self;
        }
        let by = if radius > 0.0 && radius.is_finite() { radius } else { f64::NAN };
        Self { low: self.low.map(|x| (x - by).next_down()), high: self.high.map(|x| (x + by).next_up()) }
    }

    /// Holds both: everything if an end of one is not a number.
    pub(crate) fn joined(&self, other: &Self) -> Self {
        let is_unordered = |swept: &Self| swept.low.is_nan() || swept.high.is_nan();
        if is_unordered(self) || is_unordered(other) {
            return Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };
        }
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Is this [`Self::EMPTY`]?
    pub(crate) fn is_empty(&self) -> bool {
        self.low.x > self.high.x
    }

    /// Can a point of one box be within `separation` of one of the other? Along each axis the further end is moved by the
    /// separation and rounded up, so "no" is proven; an end that is not a number compares false and excludes nothing.
    #[inline(always)]
    pub(crate) fn may_meet(&self, other: &Self, separation: f64) -> bool {
        let apart = |low: f64, high: f64| low > round_up_sum(high, separation);
        let apart_along = |a: f64, b: f64, c: f64, d: f64| apart(a, d) || apart(c, b);
        !(apart_along(self.low.x, self.high.x, other.low.x, other.high.x)
            || apart_along(self.low.y, self.high.y, other.low.y, other.high.y)
            || apart_along(self.low.z, self.high.z, other.low.z, other.high.z))
    }
}

/// A number that is not below the exact sum; x itself when nothing is added.
#[inline(always)]
pub(crate) fn round_up_sum(x: f64, separation: f64) -> f64 {
    if separation == 0.0 { x } else { (x + separation).next_up() }
}

/// The times at which a span is cut: strictly the span's own ends at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slicing {
    start: f64,
    end: f64,
}

impl Slicing {
    pub(crate) fn new(span: Window) -> Self {
        Self { start: span.start(), end: span.end() }
    }

    /// Slice k is from `time(k)` to `time(k + 1)`, both ends included.
    pub(crate) fn time(&self, k: usize) -> f64 {
        match k {
            0 => self.start,
            k if k >= SLICES => self.end,
            // The part of the span first: its length is finite, but 16 times it need not be.
            k => (self.start + (self.end - self.start) * (k as f64 / SLICES as f64))
                .clamp(self.start, self.end),
        }
    }
}

/// What a body sweeps over the slices of a span, at those times of it that the body is given for.
#[derive(Clone, Debug)]
pub(crate) struct SweptSlices(Box<[SweptBox; SLICES]>);

impl SweptSlices {
    pub(crate) fn enclose(body: CoveredBody<'_>, slicing: &Slicing) -> Self {
        let mut boxes = Box::new([SweptBox::EMPTY; SLICES]);
        for (k, swept) in boxes.iter_mut().enumerate() {
            if let Some(part) = body.part(slicing.time(k), slicing.time(k + 1)) {
                *swept = SweptBox::enclose(part);
            }
        }
        Self(boxes)
    }
}

/// Part of a span, as slices from `first` to `last`, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SliceRange {
    pub(crate) first: usize,
    pub(crate) last: usize,
}

impl SliceRange {
    pub(crate) const ALL: Self = Self { first: 0, last: SLICES - 1 };

    /// The slices in which two bodies may come within `separation`; none is a proof that they do not in the whole span. A body
    /// without slices is where its box over the whole span says.
    pub(crate) fn of_pair(a: Sweep<'_>, b: Sweep<'_>, separation: f64) -> Option<Self> {
        let may_meet = |k: &usize| {
            let (a, b) = (a.at(*k), b.at(*k));
            a.may_meet(b, separation)
        };
        if a.slices.is_none() && b.slices.is_none() {
            return a.hull.may_meet(b.hull, separation).then_some(Self::ALL);
        }
        let first = (0..SLICES).find(may_meet)?;
        let last = (first..SLICES).rev().find(may_meet).unwrap_or(first);
        Some(Self { first, last })
    }
}

/// The boxes of one body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep<'a> {
    pub(crate) hull: &'a SweptBox,
    pub(crate) slices: Option<&'a SweptSlices>,
}

impl<'a> Sweep<'a> {
    #[inline(always)]
    fn at(self, k: usize) -> &'a SweptBox {
        self.slices.map_or(self.hull, |slices| &slices.0[k])
    }
}
