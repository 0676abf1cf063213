//! Until when are a placed box and the eight boxes of a wide node apart?

use super::gap_and_rate::{GapAndRate, RateBounds};
use super::node_scale::NodeScale;
use super::node_test::Placed;
use super::passing::PassingBoxes;
use d2m_lanes::three::{dot, splat};
use d2m_lanes::{Elementwise, Lanes, Two};
use d2m_mesh::node::{BoxPair, WideNode};

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
    let best = GapAndRate { gap, closing }.or(best);
    let times = best.lasts_for(scale);
    match placed.passing {
        None => times,
        Some(left) => {
            let passing = PassingBoxes { wide, placed, line: pair.line, velocity: rate, left };
            passing.apart_until(times, scale)
        }
    }
}
