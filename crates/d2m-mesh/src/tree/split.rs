//! Across which direction a part of the surface is cut in two, so that the boxes of both halves are small.
//!
//! Only a heuristic: every cut gives a valid tree. The longest extent alone is a poor guide where a part bends or is about as
//! wide as long: against it, eight directions take 8–16 % off the node tests of a query on scanned shapes and 25–30 % on
//! machine parts. They are ranked by the second moments of the halves, all side by side, one to a lane; the best few are tried
//! with the extents of the halves along their principal axes, one half to a lane. No trigonometric function is called, so trees
//! have the same bits on every platform.

// Lanes are indexed alike in several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::principal::principal_axes;
use super::refine::DIRECTIONS;
use super::surface::Surface;
use d2m_lanes::three::{cross, dot, minus};
use d2m_lanes::{Lanes, Task, run};

/// Directions that are tried: two axes of the part and the diagonals between two, the first of [`DIRECTIONS`].
const CUTS: usize = 8;
/// Triangles of a part that a direction is chosen by.
const SAMPLE: usize = 256;
/// Directions that are tried with boxes: those with the least second moments.
const FINALISTS: usize = 4;
/// Steps that find the middles of a part along all directions, and how far each goes at least.
const HALVINGS: usize = 9;
const LEAST_STEP: f32 = 0.1;
/// What the area of a triangle counts at least.
const LEAST_AREA: f32 = super::fit::LEAST_AREA as f32;
/// More than any rank or extent.
const BEYOND: f32 = f32::MAX;

/// Orthonormal axes of a part.
pub(super) type PartAxes = [[f32; 3]; 3];
pub(super) const NO_AXES: PartAxes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Weight, first and second moments.
const MOMENTS: usize = 10;

/// A triangle that takes part in the choice of cuts, from some point of the part.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Sampled {
    numbers: [f32; 16],
    corners: [[f32; 3]; 3],
    triangle: u32,
}

/// What is known of a direction for a cut.
struct Ranking {
    directions: [[f32; CUTS]; 3],
    middle: [f32; CUTS],
    /// Moments of the lower sides, and of all.
    lower: [[f32; CUTS]; MOMENTS],
    all: [f32; 16],
    rank: [f32; CUTS],
}

/// A direction, and axes of both halves of a cut across it.
#[derive(Clone, Copy)]
pub(super) struct Choice {
    direction: [f32; 3],
    pub(super) axes: [PartAxes; 2],
}

/// Memory of one thread for splitting parts.
#[derive(Default)]
pub(super) struct Splitter {
    sample: Vec<Sampled>,
    keys: Vec<u64>,
    along: Vec<[f32; CUTS]>,
}

impl Splitter {
    /// Takes these triangles: cuts are chosen among them, by their places in the list.
    pub(super) fn take<'t>(&mut self, surface: &Surface<'_>, triangles: impl Iterator<Item = &'t u32>) {
        self.sample.clear();
        let mut from = None;
        for &triangle in triangles {
            let corners = surface.corners(triangle);
            let from = *from.get_or_insert(corners[0]);
            let mut near = [[0.0f32; 3]; 3];
            for (near, corner) in near.iter_mut().zip(&corners) {
                for k in 0..3 {
                    near[k] = (corner[k] - from[k]) as f32;
                }
            }
            self.sample.push(Sampled::new(near, triangle));
        }
    }

    /// Puts the `half` triangles of a part that lie lowest along a good direction first; `axes` are those of the part. The
    /// part is a list of places among the triangles that were taken.
    pub(super) fn split_taken(&mut self, part: &mut [u32], axes: &PartAxes, half: usize) -> [PartAxes; 2] {
        let along = &mut self.along;
        let choice = run(Choosing { sample: &self.sample, part, axes, lower: half, along });
        self.keys.clear();
        let d = choice.direction;
        self.keys.extend(part.iter().map(|&place| {
            let s = &self.sample[place as usize].numbers;
            key(d[0] * s[10] + d[1] * s[11] + d[2] * s[12], place)
        }));
        self.partition(part, half);
        choice.axes
    }

    /// The same for triangles of a mesh, chosen by a sample of them.
    pub(super) fn split(
        &mut self,
        surface: &Surface<'_>,
        part: &mut [u32],
        axes: &PartAxes,
        half: usize,
    ) -> [PartAxes; 2] {
        let stride = part.len().div_ceil(SAMPLE);
        self.take(surface, part.iter().step_by(stride));
        let places: Vec<u32> = (0..self.sample.len() as u32).collect();
        let lower = half * places.len() / part.len();
        let along = &mut self.along;
        let choice = run(Choosing { sample: &self.sample, part: &places, axes, lower, along });
        self.keys.clear();
        let d = choice.direction;
        self.keys.extend(part.iter().map(|&triangle| {
            let s = surface.sums[triangle as usize];
            key(d[0] * s[0] + d[1] * s[1] + d[2] * s[2], triangle)
        }));
        self.partition(part, half);
        choice.axes
    }

    /// The triangle at a place among those that were taken.
    pub(super) fn triangle(&self, place: u32) -> u32 {
        self.sample[place as usize].triangle
    }

    /// The principal axes of what was taken.
    pub(super) fn axes(&self) -> PartAxes {
        let mut all = [0.0; 16];
        for triangle in &self.sample {
            for k in 0..16 {
                all[k] += triangle.numbers[k];
            }
        }
        run(PrincipalAxes { all: &all })
    }

    fn partition(&mut self, part: &mut [u32], half: usize) {
        if half < part.len() {
            self.keys.select_nth_unstable(half);
        }
        for (slot, &key) in part.iter_mut().zip(&self.keys) {
            *slot = key as u32;
        }
    }
}

/// A place along a direction and a number, in the order of the places, then of the numbers.
#[inline(always)]
fn key(along: f32, number: u32) -> u64 {
    let bits = along.to_bits();
    let ordered = bits ^ (((bits as i32) >> 31) as u32 | 1 << 31);
    u64::from(ordered) << 32 | u64::from(number)
}

impl Sampled {
    #[inline(always)]
    fn new([a, b, c]: [[f32; 3]; 3], triangle: u32) -> Self {
        let n = cross(&minus(&b, &a), &minus(&c, &a));
        let area = 0.5 * dot(&n, &n).sqrt() + LEAST_AREA;
        let sum = [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]];
        let (third, twelfth) = (area * (1.0 / 3.0), area * (1.0 / 12.0));
        let mut numbers = [0.0; 16];
        numbers[0] = area;
        const PRODUCTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        for k in 0..6 {
            let (i, j) = PRODUCTS[k];
            numbers[4 + k] = twelfth * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j]);
        }
        for k in 0..3 {
            numbers[1 + k] = third * sum[k];
            numbers[10 + k] = sum[k];
        }
        Self { numbers, corners: [a, b, c], triangle }
    }
}

struct PrincipalAxes<'a> {
    all: &'a [f32; 16],
}

impl Task for PrincipalAxes<'_> {
    type Output = PartAxes;

    #[inline(always)]
    fn run<L: Lanes>(self) -> PartAxes {
        let mut moments = [L::splat(0.0); MOMENTS];
        for k in 0..MOMENTS {
            moments[k] = L::splat(self.all[k]);
        }
        let axes = principal_axes(covariance(&moments));
        lane_axes(&axes, 0)
    }
}

/// Second moments about the centers, in units of their traces.
#[inline(always)]
fn covariance<L: Lanes>(moments: &[L; MOMENTS]) -> [L; 6] {
    let about = about_center(moments);
    let trace = (about[0] + about[1] + about[2]).max(L::splat(f32::MIN_POSITIVE));
    let scale = L::splat(1.0) / trace;
    let mut scaled = about;
    for k in 0..6 {
        scaled[k] = about[k] * scale;
    }
    scaled
}

#[inline(always)]
fn about_center<L: Lanes>(moments: &[L; MOMENTS]) -> [L; 6] {
    let share = L::splat(1.0) / moments[0];
    let (x, y, z) = (moments[1] * share, moments[2] * share, moments[3] * share);
    [
        moments[4] * share - x * x,
        moments[5] * share - y * y,
        moments[6] * share - z * z,
        moments[7] * share - x * y,
        moments[8] * share - x * z,
        moments[9] * share - y * z,
    ]
}

/// √(λ₁λ₂ + λ₁λ₃ + λ₂λ₃) for the eigenvalues of the covariance: about the area of the box, up to a factor.
#[inline(always)]
fn spread<L: Lanes>(moments: &[L; MOMENTS]) -> L {
    let [xx, yy, zz, xy, xz, yz] = about_center(moments);
    let minors = (xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz);
    minors.max(L::splat(0.0)).sqrt()
}

#[inline(always)]
fn lane_axes<L: Lanes>(axes: &[[L; 3]; 3], lane: usize) -> PartAxes {
    let mut out = NO_AXES;
    for i in 0..3 {
        for k in 0..3 {
            out[i][k] = axes[i][k].store()[lane];
        }
    }
    out
}

/// The choice of a direction.
struct Choosing<'a> {
    sample: &'a [Sampled],
    /// Places in the sample.
    part: &'a [u32],
    axes: &'a PartAxes,
    /// Triangles of the part in the first half.
    lower: usize,
    /// Places of the triangles along the directions.
    along: &'a mut Vec<[f32; CUTS]>,
}

impl Task for Choosing<'_> {
    type Output = Choice;

    #[inline(always)]
    fn run<L: Lanes>(mut self) -> Choice {
        let ranking = self.rank::<L>();
        // The places of the least ranks.
        let mut best = [0; FINALISTS];
        let mut rank = ranking.rank;
        for place in &mut best {
            for cut in 1..CUTS {
                *place = if rank[cut] < rank[*place] { cut } else { *place };
            }
            rank[*place] = f32::INFINITY;
        }
        self.decide::<L>(&ranking, best)
    }
}

impl Choosing<'_> {
    #[inline(always)]
    fn rank<L: Lanes>(&mut self) -> Ranking {
        let mut directions = [[0.0; CUTS]; 3];
        for cut in 0..CUTS {
            let d = DIRECTIONS[cut];
            for k in 0..3 {
                directions[k][cut] = d[0] * self.axes[0][k] + d[1] * self.axes[1][k] + d[2] * self.axes[2][k];
            }
        }
        let mut all = [0.0; 16];
        for &place in self.part {
            let numbers = &self.sample[place as usize].numbers;
            for k in 0..16 {
                all[k] += numbers[k];
            }
        }
        let direction = [L::load(&directions[0]), L::load(&directions[1]), L::load(&directions[2])];
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let middle = self.middle::<L>(&direction);
        let mut lower = [zero; MOMENTS];
        for (&place, along) in self.part.iter().zip(self.along.iter()) {
            let numbers = &self.sample[place as usize].numbers;
            let is_lower = L::if_greater(middle, L::load(along), one, zero);
            for k in 0..MOMENTS {
                lower[k] = lower[k] + is_lower * L::splat(numbers[k]);
            }
        }
        let mut upper = lower;
        for k in 0..MOMENTS {
            upper[k] = L::splat(all[k]) - lower[k];
        }
        // Beyond all where it is no number: where all triangles are on one side.
        let rank = (spread(&lower) + spread(&upper)).min(L::splat(BEYOND));
        let mut stored = [[0.0; CUTS]; MOMENTS];
        for k in 0..MOMENTS {
            stored[k] = lower[k].store();
        }
        Ranking { directions, middle: middle.store(), lower: stored, all, rank: rank.store() }
    }

    /// About the places below which the triangles of the first half lie, one for each direction: by bisection, each step where
    /// they would be if they were spread evenly.
    #[inline(always)]
    fn middle<L: Lanes>(&mut self, direction: &[L; 3]) -> L {
        let mut low = L::splat(BEYOND);
        let mut high = L::splat(-BEYOND);
        self.along.clear();
        for &place in self.part {
            let numbers = &self.sample[place as usize].numbers;
            let along = direction[0] * L::splat(numbers[10])
                + direction[1] * L::splat(numbers[11])
                + direction[2] * L::splat(numbers[12]);
            low = along.min(low);
            high = along.max(high);
            self.along.push(along.store());
        }
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let wanted = L::splat(self.lower as f32);
        let mut below_low = zero;
        let mut below_high = L::splat(self.part.len() as f32);
        for _ in 0..HALVINGS {
            let part = (wanted - below_low) / (below_high - below_low);
            let part = part.max(L::splat(LEAST_STEP)).min(L::splat(1.0 - LEAST_STEP));
            let at = low + (high - low) * part;
            // Four sums side by side: they need not wait for each other.
            let mut sums = [zero; 4];
            let mut fours = self.along.chunks_exact(4);
            for four in &mut fours {
                for k in 0..4 {
                    sums[k] = sums[k] + L::if_greater(at, L::load(&four[k]), one, zero);
                }
            }
            for along in fours.remainder() {
                sums[0] = sums[0] + L::if_greater(at, L::load(along), one, zero);
            }
            let below = (sums[0] + sums[1]) + (sums[2] + sums[3]);
            low = L::if_greater(below, wanted, low, at);
            below_low = L::if_greater(below, wanted, below_low, below);
            high = L::if_greater(below, wanted, at, high);
            below_high = L::if_greater(below, wanted, below, below_high);
        }
        L::if_greater(below_high - wanted, wanted - below_low, low, high)
    }

    /// The finalist whose halves have the least extents along their principal axes, all added up. The lower half of each is a
    /// lane, and the upper half, where the opposite direction is lower, the next one.
    #[inline(always)]
    fn decide<L: Lanes>(&self, ranking: &Ranking, finalists: [usize; FINALISTS]) -> Choice {
        let mut moments = [[0.0; 2 * FINALISTS]; MOMENTS];
        let mut directions = [[0.0; 2 * FINALISTS]; 3];
        let mut middles = [0.0; 2 * FINALISTS];
        for (place, &cut) in finalists.iter().enumerate() {
            for k in 0..MOMENTS {
                moments[k][2 * place] = ranking.lower[k][cut];
                moments[k][2 * place + 1] = ranking.all[k] - ranking.lower[k][cut];
            }
            for k in 0..3 {
                directions[k][2 * place] = ranking.directions[k][cut];
                directions[k][2 * place + 1] = -ranking.directions[k][cut];
            }
            middles[2 * place] = ranking.middle[cut];
            middles[2 * place + 1] = -ranking.middle[cut];
        }
        let mut wide = [L::splat(0.0); MOMENTS];
        for k in 0..MOMENTS {
            wide[k] = L::load(&moments[k]);
        }
        let axes = principal_axes(covariance(&wide));
        let direction = [L::load(&directions[0]), L::load(&directions[1]), L::load(&directions[2])];
        let middle = L::load(&middles);
        let mut low = [L::splat(BEYOND); 3];
        let mut high = [L::splat(-BEYOND); 3];
        for &place in self.part {
            let Sampled { numbers, corners, .. } = &self.sample[place as usize];
            let along = direction[0] * L::splat(numbers[10])
                + direction[1] * L::splat(numbers[11])
                + direction[2] * L::splat(numbers[12]);
            for i in 0..3 {
                let axis = &axes[i];
                let mut at = [along; 3];
                for k in 0..3 {
                    let p = &corners[k];
                    at[k] = axis[0] * L::splat(p[0]) + axis[1] * L::splat(p[1]) + axis[2] * L::splat(p[2]);
                }
                let lowest = at[0].min(at[1]).min(at[2]);
                let highest = at[0].max(at[1]).max(at[2]);
                low[i] = L::if_greater(middle, along, lowest, low[i]).min(low[i]);
                high[i] = L::if_greater(middle, along, highest, high[i]).max(high[i]);
            }
        }
        let size = ((high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2])).store();
        let mut best = 0;
        for place in 1..FINALISTS {
            let [now, least] = [size[2 * place] + size[2 * place + 1], size[2 * best] + size[2 * best + 1]];
            best = if now < least { place } else { best };
        }
        let cut = finalists[best];
        let direction = [0, 1, 2].map(|k| ranking.directions[k][cut]);
        Choice { direction, axes: [lane_axes(&axes, 2 * best), lane_axes(&axes, 2 * best + 1)] }
    }
}
