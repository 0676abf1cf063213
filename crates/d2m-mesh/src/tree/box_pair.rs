//! A box of one body and the eight boxes of a wide node of the other: how far apart are their centers along some directions,
//! and how far do both reach? The tests of bodies that move and of bodies at rest begin with this.

use super::node::WideNode;
use super::slabs::reach;
use crate::margin::UNIT_F32;
use d2m_lanes::three::{beside, both, dot, load, minus, splat};
use d2m_lanes::{Elementwise, Lanes, Two};

/// Factor of the error bound of a gap; see docs/theory/engine.md.
pub const GAP_ERROR: f32 = 48.0 * UNIT_F32 as f32;

/// The four bytes of a box's cuts for the opposites of directions.
#[inline(always)]
pub fn opposite(slabs: f32) -> f32 {
    f32::from_bits(slabs.to_bits().swap_bytes())
}

/// A single box in the frame of the wide body.
#[derive(Clone, Copy, Debug)]
pub struct PlacedBox {
    /// Its center; the last number of each row means nothing.
    pub center: [f32; 4],
    /// Its axes, row by row.
    pub axes: [[f32; 4]; 3],
    /// Half of its extent along each.
    pub half: [f32; 3],
    /// Of the opposite edges: for the opposite of a direction.
    pub slabs: [f32; 3],
    /// What gaps err by, and what they have to exceed.
    pub margin: f32,
}

/// Axes of the lanes' boxes beside one of the single box.
#[derive(Clone, Copy)]
pub struct Axis<T> {
    /// Where it points.
    pub direction: [T; 3],
    /// From the lane's center to the single one's along it.
    pub between: T,
    /// How far both boxes reach, and the margin.
    pub reach: T,
}

/// Both boxes along five directions: the middle axes of both side by side, the last axes, and the line of the centers.
pub struct BoxPair<L: Lanes> {
    /// The lanes' centers, twice.
    pub center: [L::Two; 3],
    /// Along the middle axes.
    pub middle: Axis<L::Two>,
    /// Along the last axes.
    pub last: Axis<L::Two>,
    /// From center to center.
    pub line: [L; 3],
    /// Squared length of the line, and how far both boxes reach along it times its length, without the margin. Where it has
    /// no length, nothing is known along it.
    pub square: L,
    /// See `square`.
    pub line_reach: L,
}

impl<L: Lanes> BoxPair<L> {
    /// The boxes of a node of the wide body, and one of the other body in its frame.
    #[inline(always)]
    pub fn new(wide: &WideNode, placed: &PlacedBox) -> Self {
        let center = both::<L>(&load(&wide.center));
        let at: [L::Two; 3] = splat(&placed.center);
        let to = minus(&at, &center);
        let half = load::<L>(&wide.half_extent);
        let a = wide.wide_axes::<L>();
        let b =
            [splat::<L, 4>(&placed.axes[0]), splat::<L, 4>(&placed.axes[1]), splat::<L, 4>(&placed.axes[2])];
        let k = [L::splat(placed.half[0]), L::splat(placed.half[1]), L::splat(placed.half[2])];
        let margin = L::Two::splat(placed.margin);
        // Axes of the lane's box beside those of the single one, each against the axes of the other box.
        let [middle, last] = [beside(&a[1], &b[1]), beside(&a[2], &b[2])];
        let first_of_other = beside(&b[0], &a[0]);
        let same = dot(&beside(&a[1], &a[2]), &beside(&b[1], &b[2]));
        let middle_last = dot(&middle, &beside(&b[2], &a[2]));
        let with_middle = [dot(&middle, &first_of_other), L::Two::both(same.first()), middle_last];
        let last_middle = L::Two::of(middle_last.second(), middle_last.first());
        let with_last = [dot(&last, &first_of_other), last_middle, L::Two::both(same.second())];
        let slabs = [L::splat(placed.slabs[0]), L::splat(placed.slabs[1]), L::splat(placed.slabs[2])];
        let (other_half, other_slabs) = (beside(&k, &half), beside(&slabs, &load(&wide.slabs)));
        let [along_middle, along_last] = [dot(&to, &middle), dot(&to, &last)];
        let reach_middle = reach::<_, 1>(&other_half, &other_slabs, &with_middle, along_middle);
        let reach_last = reach::<_, 3>(&other_half, &other_slabs, &with_last, along_last);
        let with_line = [
            dot(&to, &first_of_other),
            L::Two::of(along_middle.second(), along_middle.first()),
            L::Two::of(along_last.second(), along_last.first()),
        ];
        let reach_line = reach::<_, 3>(&other_half, &other_slabs, &with_line, L::Two::splat(0.0));
        let line = [to[0].first(), to[1].first(), to[2].first()];
        Self {
            center,
            middle: Axis {
                direction: middle,
                between: along_middle,
                reach: L::Two::of(half[1], k[1]) + margin + reach_middle,
            },
            last: Axis {
                direction: last,
                between: along_last,
                reach: L::Two::of(half[2], k[2]) + margin + reach_last,
            },
            square: dot(&line, &line),
            line,
            line_reach: reach_line.first() + reach_line.second(),
        }
    }

    /// The greatest gap along the five directions, less the margin; not more than it where one of them is not a number.
    #[inline(always)]
    pub fn gap(&self, margin: f32) -> L {
        let middle = self.middle.between.abs() - self.middle.reach;
        let last = self.last.between.abs() - self.last.reach;
        let both = middle.max(last);
        let line = (self.square - self.line_reach) * (L::splat(1.0) / self.square.sqrt()) - L::splat(margin);
        line.max(both.first()).max(both.second())
    }
}
