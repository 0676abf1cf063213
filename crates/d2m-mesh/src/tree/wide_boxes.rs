//! Eight boxes side by side, and what encloses their points in real arithmetic.

// Lanes are indexed alike in several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::node::{Below, WIDTH, WideNode};
use super::refine::Axes;
use super::slabs::{CUT_SLACK, MOST, PAIRS, STEPS};
use super::surface::Reach;
use crate::margin::{UNIT_F32, UNIT_F64, round_up};
use d2m_lanes::{Doubles, Elementwise, Lanes, Quad, power_of_two};

/// Lanes in one register of doubles.
pub(super) const HALF: usize = WIDTH / 2;

/// Added to a number below 2⁵⁰ and taken off again, it leaves the next whole number: neighbours of 3·2⁵¹ are one apart.
const WHOLE: f64 = 3.0 * power_of_two(51);
/// Added to a whole number below 2³², it leaves a number whose lowest bits are those of the whole one.
const WHOLE_BITS: f64 = power_of_two(52);
/// What the bytes of a word count.
const PLACES: [f64; 4] = [1.0, 256.0, 65_536.0, 16_777_216.0];
/// Raises a positive number by more than rounding to `f32` lowers it, 2⁻²⁴ of it, or 2⁻¹⁵⁰ where it is not normal.
const UP: f64 = 1.0 + 2.0 * UNIT_F32;
const LEAST_UP: f64 = power_of_two(-149);

/// What becomes, in single precision, numbers that are not below these: by at most three steps of rounding above them.
#[inline(always)]
pub(super) fn outward<D: Doubles<Scalar = f64>>(x: D) -> D {
    x * D::splat(UP) + D::splat(LEAST_UP)
}

/// Both halves of vectors, in twice the digits.
#[inline(always)]
pub(super) fn widened<L: Lanes>(v: &[L; 3]) -> [[L::Doubles; 3]; 2] {
    let ([a, b], [c, d], [e, f]) = (v[0].widened(), v[1].widened(), v[2].widened());
    [[a, c, e], [b, d, f]]
}

static BLANK: WideNode = WideNode::empty([0.0; 3], 0);

/// Eight boxes, lane by lane.
pub(super) struct Boxes<L: Lanes> {
    center: [L; 3],
    axes: Axes<L>,
    half_extent: [L; 3],
    /// For each pair of axes four bytes as a number.
    slabs: [[L::Doubles; 2]; 3],
    radius: L,
}

impl<L: Lanes> Boxes<L> {
    /// Around what reaches so far from these centers along these axes: rounded outward.
    #[inline(always)]
    pub(super) fn around(center: [L; 3], axes: Axes<L>, reached: &[WideReach<L::Doubles>; 2]) -> Self {
        let [low, high] = reached;
        let slack = [low.slack(), high.slack()];
        let mut half_extent = center;
        for i in 0..3 {
            half_extent[i] = L::narrowed([outward(low.half[i] + slack[0]), outward(high.half[i] + slack[1])]);
        }
        let radius = L::narrowed([outward(low.radius(slack[0])), outward(high.radius(slack[1]))]);
        let half = widened(&half_extent);
        let (low, high) = (low.cut(&half[0], slack[0]), high.cut(&half[1], slack[1]));
        let slabs = [[low[0], high[0]], [low[1], high[1]], [low[2], high[2]]];
        Self { center, axes, half_extent, slabs, radius }
    }

    /// Makes them the boxes of a node; lanes that are not used are blank.
    #[inline(always)]
    pub(super) fn store(&self, node: &mut WideNode, below: &[Below], origin: [f32; 3]) {
        let used = below.len();
        let blank = &BLANK;
        for i in 0..3 {
            node.center[i] = self.center[i].store();
            node.half_extent[i] = self.half_extent[i].store();
        }
        for i in 0..2 {
            for k in 0..3 {
                node.axes[i][k] = self.axes[i][k].store();
            }
        }
        (node.radius, node.child) = (self.radius.store(), blank.child);
        (node.origin, node.used) = (origin, used as u32);
        for pair in 0..3 {
            for half in 0..2 {
                let words = (self.slabs[pair][half] + L::Doubles::splat(WHOLE_BITS)).store().0;
                for place in 0..HALF {
                    node.slabs[pair][half * HALF + place] = f32::from_bits(words[place].to_bits() as u32);
                }
            }
        }
        let reaches = self.reaches();
        let mut reach = 0.0;
        for lane in 0..used {
            node.set_below(lane, below[lane]);
            let lane = reaches[lane / HALF].0[lane % HALF];
            reach = if lane > reach { lane } else { reach };
        }
        node.extent = round_up(reach);
        for lane in used..WIDTH {
            for i in 0..3 {
                node.center[i][lane] = blank.center[i][lane];
                node.half_extent[i][lane] = blank.half_extent[i][lane];
                node.slabs[i][lane] = blank.slabs[i][lane];
            }
            for i in 0..2 {
                for k in 0..3 {
                    node.axes[i][k][lane] = blank.axes[i][k][lane];
                }
            }
            node.radius[lane] = blank.radius[lane];
        }
    }

    /// |center|₁ + radius, as [`WideNode::reach_of`] has it.
    #[inline(always)]
    fn reaches(&self) -> [Quad; 2] {
        let [low, high] = widened(&self.center);
        let radius = self.radius.widened();
        [
            (low[0].abs() + low[1].abs() + low[2].abs() + radius[0]).store(),
            (high[0].abs() + high[1].abs() + high[2].abs() + radius[1]).store(),
        ]
    }
}

/// [`Reach`] of four boxes.
#[derive(Clone)]
pub(super) struct WideReach<D> {
    axes: [[D; 3]; 3],
    origin: [D; 3],
    center: [D; 3],
    about: [D; 3],
    half: [D; 3],
    /// For each pair of axes the ranges of xᵢ·aboutⱼ + xⱼ·aboutᵢ and of the difference: lowest, highest.
    sum: [[D; 2]; 3],
    difference: [[D; 2]; 3],
    square: D,
    norm: D,
}

impl<D: Doubles<Scalar = f64>> WideReach<D> {
    #[inline(always)]
    pub(super) fn new(origin: [f32; 3], center: &[D; 3], axes: [[D; 3]; 3], about: &[D; 3]) -> Self {
        let zero = D::splat(0.0);
        let (low, high) = (D::splat(f64::INFINITY), D::splat(f64::NEG_INFINITY));
        let [x, y, z] = origin;
        Self {
            axes,
            origin: [D::splat(f64::from(x)), D::splat(f64::from(y)), D::splat(f64::from(z))],
            center: *center,
            about: *about,
            half: [zero; 3],
            sum: [[low, high]; 3],
            difference: [[low, high]; 3],
            square: zero,
            norm: zero,
        }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, p: &[D; 3]) {
        let mut q = [p[0]; 3];
        for k in 0..3 {
            q[k] = (p[k] - self.origin[k]) - self.center[k];
        }
        let mut along = [p[0]; 3];
        for i in 0..3 {
            let axis = &self.axes[i];
            along[i] = axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2];
            self.half[i] = along[i].abs().max(self.half[i]);
        }
        for pair in 0..3 {
            let (i, j) = PAIRS[pair];
            let (first, second) = (along[i] * self.about[j], along[j] * self.about[i]);
            let (sum, difference) = (first + second, first - second);
            self.sum[pair][0] = sum.min(self.sum[pair][0]);
            self.sum[pair][1] = sum.max(self.sum[pair][1]);
            self.difference[pair][0] = difference.min(self.difference[pair][0]);
            self.difference[pair][1] = difference.max(self.difference[pair][1]);
        }
        self.square = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).max(self.square);
        self.norm = (p[0].abs() + p[1].abs() + p[2].abs()).max(self.norm);
    }

    /// In every lane what all lanes of both reach together.
    #[inline(always)]
    pub(super) fn join_all(&mut self, other: &Self) {
        for k in 0..3 {
            self.half[k] = D::splat(self.half[k].max(other.half[k]).max_element());
            for (own, other) in
                [(&mut self.sum[k], &other.sum[k]), (&mut self.difference[k], &other.difference[k])]
            {
                own[0] = D::splat(own[0].min(other[0]).min_element());
                own[1] = D::splat(own[1].max(other[1]).max_element());
            }
        }
        self.square = D::splat(self.square.max(other.square).max_element());
        self.norm = D::splat(self.norm.max(other.norm).max_element());
    }

    /// Bound on the error of coordinates along the axes.
    #[inline(always)]
    fn slack(&self) -> D {
        let (o, c) = (&self.origin, &self.center);
        let lengths =
            self.norm + (o[0].abs() + o[1].abs() + o[2].abs()) + (c[0].abs() + c[1].abs() + c[2].abs());
        D::splat(Reach::SLACK) * lengths
    }

    /// How far all of it reaches from the center.
    #[inline(always)]
    fn radius(&self, slack: D) -> D {
        self.square.sqrt() * D::splat(1.0 + 8.0 * UNIT_F64) + slack
    }

    /// What can be cut off the edges of boxes with these half extents, as [`EdgeReach`](super::slabs::EdgeReach) derives it.
    #[inline(always)]
    fn cut(&self, h: &[D; 3], slack: D) -> [D; 3] {
        let zero = D::splat(0.0);
        let mut off = [slack; 3];
        for k in 0..3 {
            off[k] = (h[k] - self.about[k]).abs() + slack;
        }
        let mut slabs = [zero; 3];
        for pair in 0..3 {
            let (i, j) = PAIRS[pair];
            let more = h[i] * off[j] + h[j] * off[i];
            let product = h[i] * h[j];
            let most = [
                self.sum[pair][1],
                zero - self.difference[pair][0],
                self.difference[pair][1],
                zero - self.sum[pair][0],
            ];
            let mut bytes = zero;
            for edge in 0..4 {
                let room = D::splat(f64::from(STEPS)) * (D::splat(2.0) - (most[edge] + more) / product);
                let steps = (room - D::splat(CUT_SLACK)).min(D::splat(f64::from(MOST)));
                // Zero where the room is no number.
                let steps = D::if_greater(room, D::splat(1.0), steps, zero);
                // A whole number that is not above it: half a step less, rounded to the next one.
                let whole = ((steps - D::splat(0.5)) + D::splat(WHOLE)) - D::splat(WHOLE);
                bytes = bytes + whole * D::splat(PLACES[edge]);
            }
            slabs[pair] = bytes;
        }
        slabs
    }
}
