//! Boxes that a body never leaves: over a whole time span, and over slices of it.

use crate::{Aabb, Body};
use d2m_bvh::{MeshTree, Moving, Window};
use d2m_motion::{CoveredMotion, OutsideDomain};

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

    /// The same body with a margin around it, which is not negative. A radius that is none stays what it is.
    pub(crate) fn with_margin(self, margin: f64) -> Self {
        let radius = if self.radius >= 0.0 { (self.radius + margin).next_up() } else { self.radius };
        Self { radius, ..self }
    }

    fn part(self, from: f64, to: f64) -> Option<Self> {
        Some(Self { motion: self.motion.part(from, to)?, ..self })
    }

    /// Encloses every point of the body at every time of its span. A radius that is none excludes nothing, so that the query of a pair
    /// refuses it.
    pub(crate) fn swept(self) -> Aabb {
        Aabb::enclose(self.tree, &self.motion.enclose_pose(), self.radius)
    }
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
pub(crate) struct SweptSlices(Box<[Aabb; SLICES]>);

impl SweptSlices {
    pub(crate) fn enclose(body: CoveredBody<'_>, slicing: &Slicing) -> Self {
        let mut boxes = Box::new([Aabb::EMPTY; SLICES]);
        for (k, swept) in boxes.iter_mut().enumerate() {
            if let Some(part) = body.part(slicing.time(k), slicing.time(k + 1)) {
                *swept = part.swept();
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
    pub(crate) hull: &'a Aabb,
    pub(crate) slices: Option<&'a SweptSlices>,
}

impl<'a> Sweep<'a> {
    #[inline(always)]
    fn at(self, k: usize) -> &'a Aabb {
        self.slices.map_or(self.hull, |slices| &slices.0[k])
    }
}
