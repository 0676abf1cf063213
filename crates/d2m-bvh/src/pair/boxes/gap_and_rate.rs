//! Gaps of boxes along a direction, how fast they close, and how long they last for it.

use super::node_scale::NodeScale;
use d2m_lanes::three::dot;
use d2m_lanes::{Elementwise, Lanes};
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::Axis;

/// What covers the roundings of the entry time and of unit axes.
const ENTRY_FACTOR: f32 = 1.0 - 32.0 * UNIT_F32 as f32;

/// Along one axis: the gap, and the speed at which it closes at most, never less than a positive least one. Where sums of sizes
/// overflow, the gap is infinite or not a number: then the entry time is not a number, and nothing is known. Where sums of products
/// of speeds may, the least one is infinite (`MOST_SPEED` in `pair/scene.rs`).
#[derive(Clone, Copy)]
pub(super) struct GapAndRate<T> {
    pub(super) gap: T,
    pub(super) closing: T,
}

/// What holds for the speeds along every axis.
#[derive(Clone, Copy)]
pub(super) struct RateBounds<T> {
    /// Speeds of the boxes' points differ by at most this from those of the centers.
    pub(super) spread: T,
    /// Least closing speed that is reckoned with.
    pub(super) least: T,
}

impl<T: Elementwise> GapAndRate<T> {
    /// Along an axis; `velocity` is that of the centers. A speed that is not a number stays so: the greater of two is the second one
    /// where either is not a number.
    #[inline(always)]
    pub(super) fn new(axis: &Axis<T>, velocity: &[T; 3], rate: RateBounds<T>) -> Self {
        let parting = dot(velocity, &axis.direction);
        Self {
            gap: axis.between.abs() - axis.reach,
            closing: rate.least.max(rate.spread - T::flip_sign(parting, axis.between)),
        }
    }

    /// The one whose gap lasts longer without acceleration; `other` where a gap is not a number.
    #[inline(always)]
    pub(super) fn or(self, other: Self) -> Self {
        let (left, right) = (self.gap * other.closing, other.gap * self.closing);
        Self {
            gap: T::if_greater(left, right, self.gap, other.gap),
            closing: T::if_greater(left, right, self.closing, other.closing),
        }
    }
}

impl<L: Lanes> GapAndRate<L> {
    /// A time until which the gap stays positive: the root of gap − closing·s − acceleration·s²/2, without cancellation.
    #[inline(always)]
    pub(super) fn lasts_for(&self, scale: &NodeScale) -> L {
        let twice = self.gap + self.gap;
        let root = (self.closing * self.closing + L::splat(scale.acceleration) * twice).sqrt();
        twice / (self.closing + root) * L::splat(ENTRY_FACTOR)
    }
}
