//! Eight boxes side by side, and what encloses their points in real arithmetic.

// Lanes are indexed alike in several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::node::{Below, WIDTH, WideNode};
use super::slabs::{CUT_SLACK, MOST, PAIRS, STEPS};
use super::surface::Reach;
use crate::margin::{UNIT_F32, UNIT_F64, round_up};
use d2m_lanes::{Doubles, Quad, power_of_two};

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

/// Numbers of single precision that are not below these: by at most three steps of rounding above them.
#[inline(always)]
pub(super) fn outward<D: Doubles<Scalar = f64>>(x: D) -> [f32; HALF] {
    (x * D::splat(UP) + D::splat(LEAST_UP)).narrow()
}

/// One half of eight lanes in twice the digits.
#[inline(always)]
pub(super) fn widened(lanes: &[f32; WIDTH], half: usize) -> Quad {
    let at = half * HALF;
    Quad([f64::from(lanes[at]), f64::from(lanes[at + 1]), f64::from(lanes[at + 2]), f64::from(lanes[at + 3])])
}

static BLANK: WideNode = WideNode::empty([0.0; 3], 0);

/// Eight boxes, lane by lane.
pub(super) struct Boxes {
    pub(super) center: [[f32; WIDTH]; 3],
    pub(super) axes: [[[f32; WIDTH]; 3]; 3],
    pub(super) half_extent: [[f32; WIDTH]; 3],
    /// For each pair of axes four bytes as a number.
    pub(super) slabs: [[f64; WIDTH]; 3],
    pub(super) radius: [f32; WIDTH],
}

impl Boxes {
    /// Makes them the boxes of a node; lanes that are not used are blank.
    #[inline(always)]
    pub(super) fn store(&mut self, node: &mut WideNode, below: &[Below], origin: [f32; 3]) {
        let used = below.len();
        let blank = &BLANK;
        for lane in used..WIDTH {
            for i in 0..3 {
                self.center[i][lane] = blank.center[i][lane];
                self.half_extent[i][lane] = blank.half_extent[i][lane];
                self.slabs[i][lane] = 0.0;
            }
            for i in 0..2 {
                for k in 0..3 {
                    self.axes[i][k][lane] = blank.axes[i][k][lane];
                }
            }
            self.radius[lane] = blank.radius[lane];
        }
        let [first, second, _] = self.axes;
        (node.center, node.axes, node.half_extent) = (self.center, [first, second], self.half_extent);
        (node.radius, node.child) = (self.radius, blank.child);
        (node.origin, node.used) = (origin, used as u32);
        for (pair, slabs) in node.slabs.iter_mut().zip(&self.slabs) {
            for lane in 0..WIDTH {
                pair[lane] = f32::from_bits((slabs[lane] + WHOLE_BITS).to_bits() as u32);
            }
        }
        let mut reach = 0.0;
        for lane in 0..used {
            node.set_below(lane, below[lane]);
            let lane = node.reach_of(lane);
            reach = if lane > reach { lane } else { reach };
        }
        node.extent = round_up(reach);
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
    pub(super) fn new(origin: [f32; 3], boxes: &Boxes, about: &[[f32; WIDTH]; 3], half: usize) -> Self {
        let zero = D::splat(0.0);
        let (low, high) = (D::splat(f64::INFINITY), D::splat(f64::NEG_INFINITY));
        let mut reach = Self {
            axes: [[zero; 3]; 3],
            origin: [zero; 3],
            center: [zero; 3],
            about: [zero; 3],
            half: [zero; 3],
            sum: [[low, high]; 3],
            difference: [[low, high]; 3],
            square: zero,
            norm: zero,
        };
        for k in 0..3 {
            reach.origin[k] = D::splat(f64::from(origin[k]));
            reach.center[k] = D::load(&widened(&boxes.center[k], half));
            reach.about[k] = D::load(&widened(&about[k], half));
            for i in 0..3 {
                reach.axes[i][k] = D::load(&widened(&boxes.axes[i][k], half));
            }
        }
        reach
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

    /// Rounds outward and stores.
    #[inline(always)]
    pub(super) fn finish(&self, boxes: &mut Boxes, half: usize) {
        let (o, c) = (&self.origin, &self.center);
        let lengths =
            self.norm + (o[0].abs() + o[1].abs() + o[2].abs()) + (c[0].abs() + c[1].abs() + c[2].abs());
        let slack = D::splat(Reach::SLACK) * lengths;
        let at = half * HALF;
        for i in 0..3 {
            boxes.half_extent[i][at..][..HALF].copy_from_slice(&outward(self.half[i] + slack));
        }
        let radius = self.square.sqrt() * D::splat(1.0 + 8.0 * UNIT_F64) + slack;
        boxes.radius[at..][..HALF].copy_from_slice(&outward(radius));
        self.cut(boxes, half, slack);
    }

    /// What can be cut off the edges, as [`EdgeReach`](super::slabs::EdgeReach) derives it.
    #[inline(always)]
    fn cut(&self, boxes: &mut Boxes, half: usize, slack: D) {
        let zero = D::splat(0.0);
        let mut h = [slack; 3];
        let mut off = [slack; 3];
        for k in 0..3 {
            h[k] = D::load(&widened(&boxes.half_extent[k], half));
            off[k] = (h[k] - self.about[k]).abs() + slack;
        }
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
            boxes.slabs[pair][half * HALF..][..HALF].copy_from_slice(&bytes.store().0);
        }
    }
}
