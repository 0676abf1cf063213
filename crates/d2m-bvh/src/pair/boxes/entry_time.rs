//! Until when are a placed box and the eight boxes of a wide node apart?

use super::node_scale::NodeScale;
use super::node_test::Placed;
use super::whole_span::Boxes;
use d2m_lanes::three::{dot, load, minus, splat};
use d2m_lanes::{Elementwise, Lanes, Two};
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::{Axis, BoxPair, WideNode};

/// What covers the roundings of the entry time and of unit axes.
pub(crate) const ENTRY_FACTOR: f32 = 1.0 - 32.0 * UNIT_F32 as f32;

/// Along one axis: the gap, and the speed at which it closes at most, never less than a positive least one. Where sums of sizes
/// overflow, the gap is infinite or not a number: then the entry time is not a number, and nothing is known. Where sums of products
/// of speeds may, the least one is infinite (`MOST_SPEED` in `pair/scene.rs`).
#[derive(Clone, Copy)]
struct GapAndRate<T> {
    gap: T,
    closing: T,
}

/// What holds for the speeds along every axis.
#[derive(Clone, Copy)]
struct RateBounds<T> {
    /// Speeds of the boxes' points differ by at most this from those of the centers.
    spread: T,
    /// Least closing speed that is reckoned with.
    least: T,
}

impl<T: Elementwise> GapAndRate<T> {
    /// Along an axis; `velocity` is that of the centers. A speed that is not a number stays so: the greater of two is the second one
    /// where either is not a number.
    #[inline(always)]
    fn new(axis: &Axis<T>, velocity: &[T; 3], rate: RateBounds<T>) -> Self {
        let parting = dot(velocity, &axis.direction);
        Self {
            gap: axis.between.abs() - axis.reach,
            closing: rate.least.max(rate.spread - T::flip_sign(parting, axis.between)),
        }
    }

    /// The one whose gap lasts longer without acceleration; `other` where a gap is not a number.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let (left, right) = (self.gap * other.closing, other.gap * self.closing);
        Self {
            gap: T::if_greater(left, right, self.gap, other.gap),
            closing: T::if_greater(left, right, self.closing, other.closing),
        }
    }
}

/// Lower bounds on the times, counted from the frame, until which each lane's box stays apart from the single one;
/// not positive, or not a number, where nothing is known. In units of the sub-window, not yet clipped.
///
/// Five directions are evaluated: the middle axes of both boxes side by side, the last axes, and the line of the centers.
#[inline(always)]
pub(crate) fn entry_times<L: Lanes>(wide: &WideNode, placed: &Placed, scale: &NodeScale) -> L {
    let pair = BoxPair::<L>::new(wide, &placed.boxed);
    let center = &pair.center;
    let w = splat::<L::Two, 4>(&placed.omega_wide);
    let base = splat::<L::Two, 4>(&placed.velocity);
    let v = [
        base[0] - (w[1] * center[2] - w[2] * center[1]),
        base[1] - (w[2] * center[0] - w[0] * center[2]),
        base[2] - (w[0] * center[1] - w[1] * center[0]),
    ];
    // |ω|·radius of both boxes, whatever the direction, and the error of speeds.
    let spread =
        L::splat(scale.spin[0]) * L::load(&wide.radius) + L::splat(placed.spin_speed + placed.speed_margin);
    let rates = RateBounds { spread: L::Two::both(spread), least: L::Two::splat(placed.least) };
    let best = GapAndRate::new(&pair.middle, &v, rates).or(GapAndRate::new(&pair.last, &v, rates));
    let best = GapAndRate { gap: best.gap.first(), closing: best.closing.first() }
        .or(GapAndRate { gap: best.gap.second(), closing: best.closing.second() });

    let rate = [v[0].first(), v[1].first(), v[2].first()];
    let inverse = L::splat(1.0) / pair.square.sqrt();
    let gap = (pair.square - pair.line_reach) * inverse - L::splat(placed.boxed.margin);
    let closing = L::splat(placed.least).max(spread - dot(&rate, &pair.line) * inverse);
    let mut best = GapAndRate { gap, closing }.or(best);
    if let Some(parting) = &placed.parting {
        best = along(wide, placed, parting, &rate, RateBounds { spread, least: L::splat(placed.least) })
            .or(best);
    }

    // Root of gap − closing·s − acceleration·s²/2: no cancellation.
    let twice = best.gap + best.gap;
    let root = (best.closing * best.closing + L::splat(scale.acceleration) * twice).sqrt();
    twice / (best.closing + root) * L::splat(ENTRY_FACTOR)
}

/// Along a direction that is given, by the wide body's axes; it may be longer than one by a few roundings.
#[inline(always)]
fn along<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    direction: &[f32; 3],
    velocity: &[L; 3],
    rates: RateBounds<L>,
) -> GapAndRate<L> {
    let n: [L; 3] = splat(direction);
    let (at, boxed) = (splat::<L, 4>(&placed.boxed.center), &placed.boxed);
    let center = load::<L>(&wide.center);
    let to = minus(&at, &center);
    let of_lanes = Boxes {
        half: load::<L>(&wide.half_extent),
        slabs: load::<L>(&wide.slabs),
        axes: wide.wide_axes::<L>(),
    };
    let of_single = Boxes {
        half: splat(&boxed.half),
        slabs: splat(&boxed.slabs),
        axes: [splat(&boxed.axes[0]), splat(&boxed.axes[1]), splat(&boxed.axes[2])],
    };
    let between = dot(&to, &n);
    let reach = of_lanes.reach(&n, between) + of_single.reach(&n, between) + L::splat(boxed.margin);
    GapAndRate::new(&Axis { direction: n, between, reach }, velocity, rates)
}
