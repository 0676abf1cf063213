//! The diagonal slabs of an 18-DOP in the frame of an oriented box (Klosowski et al. 1998, DOI 10.1109/2945.675649).
//!
//! Most parts of a surface leave the edges and corners of their box empty, so planes cut the twelve edges off. A point of the
//! part has coordinates xᵢ along the axes, |xᵢ| ≤ hᵢ. The edge between the faces σxᵢ = hᵢ and τxⱼ = hⱼ (σ, τ = ±1) is cut off
//! by the plane σxᵢ/hᵢ + τxⱼ/hⱼ = 2 − s. The box alone has s = 0; s = 1 cuts from the middle of one face to that of the other;
//! s = 0 where the part touches the edge. The planes of opposite edges bound a slab.

use crate::margin::UNIT_F64;
use d2m_lanes::Bytes;

/// The pairs of axes whose faces meet in edges.
pub const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Steps of a stored cut in one half extent.
pub const STEPS: f32 = 64.0;

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
    let mut steps = T::splat(0.0);
    for pair in 0..USED {
        let (i, j) = PAIRS[pair];
        let common = left[i].min(left[j]);
        (left[i], left[j]) = (left[i] - common, left[j] - common);
        steps = steps + common * slabs[pair].byte_of(cosines[i], cosines[j], along);
    }
    corner - steps * T::splat(1.0 / STEPS)
}

/// The same for one box in twice the digits, along a direction and along the opposite one.
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
