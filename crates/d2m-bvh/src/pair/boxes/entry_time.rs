//! Until when are a placed box and the eight boxes of a wide node apart?

use super::node_scale::NodeScale;
use super::node_test::Placed;
use super::whole_span::Boxes;
use d2m_lanes::{Elementwise, Lanes, Two};
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::WideNode;
use d2m_mesh::node::{Axis, BoxPair, dot, load, splat};

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
    let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
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

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::{Bytes, InstructionSet, Portable, Task, run_on};
    use d2m_mesh::node::{PAIRS, STEPS, reach};
    use d2m_testing::{Draw, KnuthRandom};

    /// Bytes chosen by signs, by lanes and by twice as many.
    struct Choice([[f32; 8]; 4]);

    impl Task for Choice {
        type Output = [[u32; 8]; 3];

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let [four, x, y, flip] =
                [L::load(&self.0[0]), L::load(&self.0[1]), L::load(&self.0[2]), L::load(&self.0[3])];
            let zero = L::splat(0.0);
            let (two, one) = (L::Two::of(zero, four), L::Two::both(flip));
            let second = two.byte_of(L::Two::of(x, x), L::Two::of(y, y), one);
            [four.byte_of(x, y, flip), second.first(), second.second()]
                .map(|lanes| lanes.store().map(f32::to_bits))
        }
    }

    #[test]
    fn bytes_are_chosen_by_signs_with_every_instruction_set() {
        let mut random = KnuthRandom(21);
        for _ in 0..2000 {
            let mut number = || random.signed() as f32;
            let signs: [[f32; 8]; 3] = core::array::from_fn(|_| {
                core::array::from_fn(|k| if k == 3 { -0.0 * number().signum() } else { number() })
            });
            let bytes: [[u8; 4]; 8] =
                core::array::from_fn(|_| core::array::from_fn(|_| ((number() + 1.0) * 63.4) as u8));
            let four = bytes.map(|b| f32::from_bits(u32::from_le_bytes(b)));
            let expected: [u32; 8] = core::array::from_fn(|k| {
                let is_negative =
                    |v: &[f32; 8]| usize::from(v[k].is_sign_negative() != signs[2][k].is_sign_negative());
                f32::from(bytes[k][is_negative(&signs[0]) + 2 * is_negative(&signs[1])]).to_bits()
            });
            let wanted = [expected, [0; 8], expected];
            for set in InstructionSet::available() {
                assert_eq!(run_on(set, Choice([four, signs[0], signs[1], signs[2]])), wanted, "{set:?}");
            }
        }
    }

    /// Points in a box from which all edges are cut off, pushed out until they are on its surface: none is beyond its
    /// reach, and together they come near it.
    #[test]
    fn slabs_reach_as_far_as_their_points() {
        let mut random = KnuthRandom(22);
        let mut sharpest = 0.0f32;
        for _ in 0..300 {
            let half: [f32; 3] = core::array::from_fn(|_| 10f64.powf(1.5 * random.signed() - 1.5) as f32);
            let cuts: [[u8; 4]; 3] =
                core::array::from_fn(|_| core::array::from_fn(|_| ((random.signed() + 1.0) * 63.4) as u8));
            let room = |q: [f32; 3]| {
                // The largest number that the point, in half extents, may be multiplied with.
                let mut most = q.iter().map(|x| 1.0 / x.abs()).fold(f32::INFINITY, f32::min);
                for (&(i, j), cuts) in PAIRS.iter().zip(&cuts) {
                    for (place, &cut) in cuts.iter().enumerate() {
                        let sign = |bit: usize| if place & bit == 0 { 1.0 } else { -1.0 };
                        let towards = sign(1) * q[i] + sign(2) * q[j];
                        if towards > 0.0 {
                            most = most.min((2.0 - f32::from(cut) / STEPS) / towards);
                        }
                    }
                }
                most
            };
            let points: Vec<[f32; 3]> = (0..400)
                .map(|_| {
                    let q: [f32; 3] = core::array::from_fn(|_| random.signed() as f32);
                    let most = room(q);
                    core::array::from_fn(|k| q[k] * most * half[k])
                })
                .collect();
            let slabs = cuts.map(|cuts| Portable::splat(f32::from_bits(u32::from_le_bytes(cuts))));
            let along = random.signed() as f32;
            for _ in 0..20 {
                let cosines: [f32; 3] = core::array::from_fn(|_| random.signed() as f32);
                let bound = reach::<_, 3>(
                    &half.map(Portable::splat),
                    &slabs,
                    &cosines.map(Portable::splat),
                    Portable::splat(along),
                )
                .store()[0];
                let direction = cosines.map(|c| c * along.signum());
                let farthest = points
                    .iter()
                    .map(|p| direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2])
                    .fold(f32::NEG_INFINITY, f32::max);
                let corner: f32 = (0..3).map(|k| half[k] * cosines[k].abs()).sum();
                assert!(farthest <= bound + 1e-6 * corner, "{farthest} {bound}");
                sharpest = sharpest.max(farthest / bound);
            }
        }
        assert!(sharpest > 0.999, "{sharpest}");
    }
}
