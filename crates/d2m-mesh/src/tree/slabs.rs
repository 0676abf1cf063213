//! The diagonal slabs of an 18-DOP in the frame of an oriented box (Klosowski et al. 1998, DOI 10.1109/2945.675649).
//!
//! Most parts of a surface leave the edges and corners of their box empty, so planes cut the twelve edges off. A point of the
//! part has coordinates xᵢ along the axes, |xᵢ| ≤ hᵢ. The edge between the faces σxᵢ = hᵢ and τxⱼ = hⱼ (σ, τ = ±1) is cut off
//! by the plane σxᵢ/hᵢ + τxⱼ/hⱼ = 2 − s. The box alone has s = 0; s = 1 cuts from the middle of one face to that of the other;
//! s = 0 where the part touches the edge. The planes of opposite edges bound a slab.

use crate::margin::UNIT_F64;
use d2m_lanes::Bytes;

/// The pairs of axes whose faces meet in edges.
pub(crate) const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Steps of a stored cut in one half extent.
pub(crate) const STEPS: f32 = 64.0;

/// The largest stored cut. Four bytes that are not above it are never the bits of a NaN, so that they can be kept where
/// numbers are.
pub(crate) const MOST: u8 = 126;

/// Bound on the error of a room in steps: eight roundings of numbers that are at most twice the product they are divided by.
const ROOM_ERROR: f64 = STEPS as f64 * 64.0 * UNIT_F64;
/// What is taken off a room before it is rounded down: so much more than its error that boxes of more points pass, too.
pub(super) const CUT_SLACK: f64 = 1024.0 * ROOM_ERROR;

/// The two slabs of each pair of axes as cuts s in steps: that of the edge (σ, τ) at place (σ < 0) + 2·(τ < 0).
pub type Slabs = [[u8; 4]; 3];

/// How far points reach towards the edges of a box whose half extents are about known. One pair of axes to a lane (the
/// last lane is idle), so that all are done at once.
pub(super) struct EdgeReach {
    about: [f64; 3],
    /// Ranges of xᵢ·aboutⱼ + xⱼ·aboutᵢ and of the difference.
    sum: [[f64; 4]; 2],
    difference: [[f64; 4]; 2],
}

impl EdgeReach {
    pub(super) fn new(about: [f64; 3]) -> Self {
        let nothing = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
        Self { about, sum: nothing, difference: nothing }
    }

    /// Takes the coordinates of a point along the axes.
    #[inline(always)]
    pub(super) fn add(&mut self, [x, y, z]: [f64; 3]) {
        let [a, b, c] = self.about;
        let (first, second) = ([x * b, x * c, y * c, 0.0], [y * a, z * a, z * b, 0.0]);
        for k in 0..4 {
            let (sum, difference) = (first[k] + second[k], first[k] - second[k]);
            for (range, value) in [(&mut self.sum, sum), (&mut self.difference, difference)] {
                range[0][k] = if value < range[0][k] { value } else { range[0][k] };
                range[1][k] = if value > range[1][k] { value } else { range[1][k] };
            }
        }
    }

    /// Largest σ·xᵢ·aboutⱼ + τ·xⱼ·aboutᵢ, in the order of [`Slabs`].
    fn most(&self, pair: usize) -> [f64; 4] {
        [self.sum[1][pair], -self.difference[0][pair], self.difference[1][pair], -self.sum[0][pair]]
    }

    /// How many steps could be cut off each edge, for the final half extents and coordinates that err by at most `slack`.
    ///
    /// σxᵢhⱼ + τxⱼhᵢ ≤ most + hᵢ(|hⱼ − aboutⱼ| + slack) + hⱼ(|hᵢ − aboutᵢ| + slack), since |xᵢ| ≤ hᵢ. The roundings are a few
    /// v of numbers that are at most 2·hᵢ·hⱼ, so the result errs by less than [`ROOM_ERROR`]. Not a number where the box has no
    /// such edge.
    fn room(&self, half: &[f32; 3], slack: f64) -> [[f64; 4]; 3] {
        let half = half.map(f64::from);
        core::array::from_fn(|pair| {
            let (i, j) = PAIRS[pair];
            let off = |k: usize| (half[k] - self.about[k]).abs() + slack;
            let more = half[i] * off(j) + half[j] * off(i);
            self.most(pair).map(|most| f64::from(STEPS) * (2.0 - (most + more) / (half[i] * half[j])))
        })
    }

    /// Do the cuts leave all points? Those of a box made from these and other points do.
    pub(super) fn are_left_by(&self, slabs: &Slabs, half: &[f32; 3], slack: f64) -> bool {
        let room = self.room(half, slack);
        let all = slabs.iter().flatten().zip(room.iter().flatten());
        all.into_iter().all(|(&cut, room)| cut == 0 || f64::from(cut) <= room - ROOM_ERROR)
    }
}

/// How far boxes without their cut edges reach from their centers along directions that have these cosines with their axes,
/// or along the opposite ones where `along` is negative: Σ |cᵢ|hᵢ is what their corners reach. Of uᵢ = |cᵢ|hᵢ any w with
/// w ≤ uᵢ, w ≤ uⱼ can be written as w(σxᵢ/hᵢ + τxⱼ/hⱼ), which is at most w(2 − s). `USED`: how many pairs of axes are evaluated;
/// the cuts between the faces of the first one are the deepest. Own roundings: at most 20u√(Σcᵢ²) of the radius.
#[inline(always)]
pub fn reach<T: Bytes, const USED: usize>(half: &[T; 3], slabs: &[T; 3], cosines: &[T; 3], along: T) -> T {
    let mut left = [half[0] * cosines[0].abs(), half[1] * cosines[1].abs(), half[2] * cosines[2].abs()];
    let corner = left[0] + left[1] + left[2];
    let mut steps = cut_off(0, &mut left, slabs, cosines, along);
    for pair in 1..USED {
        steps = steps + cut_off(pair, &mut left, slabs, cosines, along);
    }
    corner - steps * T::splat(1.0 / STEPS)
}

/// What the cuts between the faces of a pair of axes take off, in steps, of what is left along both of them.
#[inline(always)]
fn cut_off<T: Bytes>(pair: usize, left: &mut [T; 3], slabs: &[T; 3], cosines: &[T; 3], along: T) -> T {
    let (i, j) = PAIRS[pair];
    let common = left[i].min(left[j]);
    (left[i], left[j]) = (left[i] - common, left[j] - common);
    common * slabs[pair].byte_of(cosines[i], cosines[j], along)
}

/// How far one box reaches, in twice the digits, along a direction and along the opposite one.
#[inline(always)]
pub(crate) fn reach_both_ways(half: &[f32; 3], slabs: &Slabs, cosines: [f64; 3]) -> [f64; 2] {
    let size = |k: usize| cosines[k].abs() * f64::from(half[k]);
    let mut left = [size(0), size(1), size(2)];
    let corner = left[0] + left[1] + left[2];
    let mut steps = [0.0; 2];
    for (&(i, j), cuts) in PAIRS.iter().zip(slabs) {
        let common = if left[i] < left[j] { left[i] } else { left[j] };
        (left[i], left[j]) = (left[i] - common, left[j] - common);
        let edge = usize::from(cosines[i] < 0.0) + 2 * usize::from(cosines[j] < 0.0);
        steps[0] += common * f64::from(cuts[edge]);
        steps[1] += common * f64::from(cuts[3 - edge]);
    }
    [corner - steps[0] / f64::from(STEPS), corner - steps[1] / f64::from(STEPS)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::{Elementwise, InstructionSet, Lanes, Portable, Task, Two, run_on};
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
