//! The boxes of the up to eight parts of a node, one to a lane: axes, then what encloses in real arithmetic.
//!
//! The rounding errors are those that [`Reach`](super::surface::Reach) counts: the same operations in the same order, lane by
//! lane, so a check of the tree finds the same numbers.

// Lanes are indexed alike in several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::fit::{Moments, triangle_moments};
use super::frame::{DEVIATION_ERROR, MOST_DEVIATION, deviation, frames, triangle_axes};
use super::node::{Below, WIDTH, WideNode};
use super::principal::principal_axes;
use super::refine::{Axes, Row, refined, stride};
use super::slabs::{CUT_SLACK, MOST, PAIRS, STEPS};
use super::surface::Reach;
use crate::margin::{UNIT_F32, UNIT_F64, round_up};
use d2m_lanes::three::cross;
use d2m_lanes::{Doubles, Elementwise, Lanes, Quad, Task, power_of_two};

/// Lanes in one register of doubles.
const HALF: usize = WIDTH / 2;

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
fn outward<D: Doubles<Scalar = f64>>(x: D) -> [f32; HALF] {
    (x * D::splat(UP) + D::splat(LEAST_UP)).narrow()
}

/// A point of each lane's part, local coordinates.
#[derive(Clone, Copy)]
pub(super) struct WideRow([[Quad; 2]; 3]);

/// Memory of one thread for fitting boxes.
#[derive(Default)]
pub(super) struct Rows {
    wide: Vec<WideRow>,
    narrow: Vec<Row>,
    /// How many of them are in use.
    used: usize,
}

/// What the boxes of a node are fitted to.
pub(super) struct Siblings<'a> {
    /// Vertices of the mesh, local coordinates.
    pub(super) points: &'a [[f64; 3]],
    /// The vertices of each part; of a triangle its three corners.
    pub(super) parts: &'a [&'a [u32]],
    pub(super) below: &'a [Below],
    /// Of each part. Those of triangles are computed here.
    pub(super) moments: &'a mut [Moments],
    /// The origin, or what the moments say.
    pub(super) origin: Option<[f32; 3]>,
    pub(super) parent: u32,
    pub(super) rows: &'a mut Rows,
    /// Where the boxes go.
    pub(super) node: &'a mut WideNode,
}

impl Task for Siblings<'_> {
    /// The moments of all.
    type Output = Moments;

    #[inline(always)]
    fn run<L: Lanes>(mut self) -> Moments {
        if let (&[part], &[Below::Node(_)]) = (self.parts, self.below) {
            return self.fit_one::<L>(part);
        }
        let mut lanes: [&[u32]; WIDTH] = [&[]; WIDTH];
        lanes[..self.parts.len()].copy_from_slice(self.parts);
        self.gather(&lanes);
        let is_triangle = self.is_triangle();
        let mut triangles = [[[0.0; WIDTH]; 3]; 2];
        if is_triangle != 0 {
            self.measure_triangles::<L>(is_triangle, &mut triangles);
        }
        let mut all = Moments::default();
        for moments in self.moments.iter() {
            all.add(moments);
        }
        let origin = self.origin_of(&all);
        self.narrow::<L::Doubles>(origin);
        let all_lanes = (1 << self.parts.len()) - 1;
        let axes = if is_triangle == all_lanes { triangles } else { self.axes::<L>(is_triangle, &triangles) };
        let mut boxes = self.boxes::<L>(origin, &axes, LanesAre::Boxes);
        boxes.store(self.node, self.below, origin);
        self.node.parent = self.parent;
        all
    }
}

/// What the points in the lanes belong to.
#[derive(Clone, Copy, PartialEq)]
enum LanesAre {
    /// Each lane's to a box of its own.
    Boxes,
    /// All to one box.
    PartsOfOne,
}

impl Siblings<'_> {
    fn origin_of(&self, all: &Moments) -> [f32; 3] {
        match self.origin {
            Some(origin) => origin,
            None => all.center(),
        }
    }

    /// A node of one box around many points, the topmost one: an eighth of them to a lane, once the axes are known, for which a
    /// sample is enough. The same bits as with all of them in the first lane: extrema are exact in any order.
    #[inline(always)]
    fn fit_one<L: Lanes>(&mut self, part: &[u32]) -> Moments {
        let all = self.moments[0];
        let origin = self.origin_of(&all);
        let sample: Vec<u32> = part.iter().step_by(stride(part.len())).copied().collect();
        let mut lanes: [&[u32]; WIDTH] = [&[]; WIDTH];
        lanes[0] = &sample;
        self.gather(&lanes);
        self.narrow::<L::Doubles>(origin);
        let mut axes = self.axes::<L>(0, &[[[0.0; WIDTH]; 3]; 2]);
        for row in axes.as_flattened_mut() {
            *row = [row[0]; WIDTH];
        }
        for (lane, points) in lanes.iter_mut().zip(part.chunks(part.len().div_ceil(WIDTH))) {
            *lane = points;
        }
        self.gather(&lanes);
        self.narrow::<L::Doubles>(origin);
        let mut boxes = self.boxes::<L>(origin, &axes, LanesAre::PartsOfOne);
        boxes.store(self.node, self.below, origin);
        self.node.parent = self.parent;
        all
    }

    /// The bits of the lanes with a triangle.
    #[inline(always)]
    fn is_triangle(&self) -> u32 {
        let mut bits = 0;
        for (lane, below) in self.below.iter().enumerate() {
            bits |= u32::from(matches!(below, Below::Triangle(_))) << lane;
        }
        bits
    }

    /// Puts the points of the lanes side by side; short lanes repeat a point, those without points that of the first lane.
    #[inline(always)]
    fn gather(&mut self, lanes: &[&[u32]; WIDTH]) {
        let mut count = 0;
        for part in lanes {
            count = if part.len() > count { part.len() } else { count };
        }
        let rows = &mut *self.rows;
        if rows.wide.len() < count {
            rows.wide.resize(count, WideRow([[Quad([0.0; HALF]); 2]; 3]));
            rows.narrow.resize(count, [[0.0; WIDTH]; 3]);
        }
        rows.used = count;
        let wide = &mut rows.wide[..count];
        for lane in 0..WIDTH {
            let part = lanes[lane];
            let (half, place) = (lane / HALF, lane % HALF);
            for (row, &vertex) in wide.iter_mut().zip(part) {
                let p = &self.points[vertex as usize];
                row.0[0][half].0[place] = p[0];
                row.0[1][half].0[place] = p[1];
                row.0[2][half].0[place] = p[2];
            }
            if part.len() == count {
                continue;
            }
            let first = if part.is_empty() { lanes[0][0] } else { part[0] };
            let p = self.points[first as usize];
            for row in &mut wide[part.len()..] {
                row.0[0][half].0[place] = p[0];
                row.0[1][half].0[place] = p[1];
                row.0[2][half].0[place] = p[2];
            }
        }
    }

    /// The same from the origin, in `f32`.
    #[inline(always)]
    fn narrow<D: Doubles<Scalar = f64>>(&mut self, origin: [f32; 3]) {
        let Rows { wide, narrow, used } = &mut *self.rows;
        for (narrow, wide) in narrow[..*used].iter_mut().zip(&wide[..*used]) {
            for k in 0..3 {
                let from = D::splat(f64::from(origin[k]));
                for half in 0..2 {
                    let from_origin = (D::load(&wide.0[k][half]) - from).narrow();
                    narrow[k][half * HALF..][..HALF].copy_from_slice(&from_origin);
                }
            }
        }
    }

    /// Moments and axes of triangles, whose corners are the first three rows.
    #[inline(always)]
    fn measure_triangles<L: Lanes>(&mut self, is_triangle: u32, axes: &mut StoredAxes) {
        for half in 0..2 {
            let mut corners = [[<L::Doubles as Elementwise>::splat(0.0); 3]; 3];
            for i in 0..3 {
                for k in 0..3 {
                    corners[i][k] = <L::Doubles as Doubles>::load(&self.rows.wide[i].0[k][half]);
                }
            }
            store_half(&triangle_axes(&corners), half, axes);
            let moments = triangle_moments(&corners);
            for place in 0..HALF {
                let lane = half * HALF + place;
                if is_triangle >> lane & 1 == 1 {
                    for k in 0..Moments::LENGTH {
                        self.moments[lane].0[k] = moments[k].0[place];
                    }
                }
            }
        }
    }

    /// Axes of parts of more than one triangle; those of triangles are given.
    #[inline(always)]
    fn axes<L: Lanes>(&self, is_triangle: u32, triangles: &StoredAxes) -> StoredAxes {
        let mut matrices = [[0.0; WIDTH]; 6];
        for lane in 0..self.parts.len() {
            let covariance = self.moments[lane].covariance();
            for k in 0..6 {
                matrices[k][lane] = covariance[k];
            }
        }
        let mut matrix = [L::splat(0.0); 6];
        for k in 0..6 {
            matrix[k] = L::load(&matrices[k]);
        }
        let turned = refined(principal_axes(matrix), &self.rows.narrow[..self.rows.used]);
        let mut stored = [[[0.0; WIDTH]; 3]; 2];
        for i in 0..2 {
            for k in 0..3 {
                stored[i][k] = turned[i][k].store();
            }
        }
        let mut axes = [[[0.0; WIDTH]; 3]; 2];
        for half in 0..2 {
            let mut pair = [[<L::Doubles as Elementwise>::splat(0.0); 3]; 2];
            for i in 0..2 {
                for k in 0..3 {
                    pair[i][k] = <L::Doubles as Doubles>::load(&widened(&stored[i][k], half));
                }
            }
            store_half(&frames(&pair[0], &pair[1]), half, &mut axes);
        }
        for i in 0..2 {
            for k in 0..3 {
                for lane in 0..WIDTH {
                    if is_triangle >> lane & 1 == 1 {
                        axes[i][k][lane] = triangles[i][k][lane];
                    }
                }
            }
        }
        axes
    }

    /// The boxes with these axes.
    #[inline(always)]
    fn boxes<L: Lanes>(&self, origin: [f32; 3], axes: &StoredAxes, lanes: LanesAre) -> Boxes {
        let axes = all_axes::<L>(axes);
        let (center, about) = middle::<L>(&axes, &self.rows.narrow[..self.rows.used], lanes);
        let mut boxes = Boxes {
            center,
            axes,
            half_extent: [[0.0; WIDTH]; 3],
            slabs: [[0.0; WIDTH]; 3],
            radius: [0.0; WIDTH],
        };
        let [mut low, mut high] =
            [self.reach_of::<L>(origin, &boxes, &about, 0), self.reach_of::<L>(origin, &boxes, &about, 1)];
        if lanes == LanesAre::PartsOfOne {
            low.join_all(&high);
            high = low.clone();
        }
        low.finish(&mut boxes, 0);
        high.finish(&mut boxes, 1);
        boxes
    }

    /// How far the points in one half of the lanes reach.
    #[inline(always)]
    fn reach_of<L: Lanes>(
        &self,
        origin: [f32; 3],
        boxes: &Boxes,
        about: &[[f32; WIDTH]; 3],
        half: usize,
    ) -> WideReach<L::Doubles> {
        let mut reach = WideReach::<L::Doubles>::new(origin, boxes, about, half);
        for row in &self.rows.wide[..self.rows.used] {
            let p = &row.0;
            reach.add(&[
                <L::Doubles as Doubles>::load(&p[0][half]),
                <L::Doubles as Doubles>::load(&p[1][half]),
                <L::Doubles as Doubles>::load(&p[2][half]),
            ]);
        }
        reach
    }
}

/// One half of eight lanes in twice the digits.
#[inline(always)]
fn widened(lanes: &[f32; WIDTH], half: usize) -> Quad {
    let at = half * HALF;
    Quad([f64::from(lanes[at]), f64::from(lanes[at + 1]), f64::from(lanes[at + 2]), f64::from(lanes[at + 3])])
}

/// The axes that are stored, as a node has them.
type StoredAxes = [[[f32; WIDTH]; 3]; 2];

/// Stores frames of four lanes in `f32`: their first two axes.
#[inline(always)]
fn store_half<D: Doubles>(frames: &[[D; 3]; 2], half: usize, axes: &mut StoredAxes) {
    for i in 0..2 {
        for k in 0..3 {
            axes[i][k][half * HALF..][..HALF].copy_from_slice(&frames[i][k].narrow());
        }
    }
}

/// The axes with the third ones, as whoever reads the boxes computes them; those of the coordinates for the one frame in some 10⁸
/// that its roundings leave less orthonormal than boxes promise.
#[inline(always)]
fn all_axes<L: Lanes>(stored: &StoredAxes) -> [[[f32; WIDTH]; 3]; 3] {
    let [a, b] = stored;
    let first = [L::load(&a[0]), L::load(&a[1]), L::load(&a[2])];
    let second = [L::load(&b[0]), L::load(&b[1]), L::load(&b[2])];
    let third = cross(&first, &second);
    let mut axes = [*a, *b, [third[0].store(), third[1].store(), third[2].store()]];
    for half in 0..2 {
        let mut frame = [[<L::Doubles as Elementwise>::splat(0.0); 3]; 3];
        for i in 0..3 {
            for k in 0..3 {
                frame[i][k] = <L::Doubles as Doubles>::load(&widened(&axes[i][k], half));
            }
        }
        let off = deviation(&frame).store().0;
        for place in 0..HALF {
            if off[place] > MOST_DEVIATION - 2.0 * DEVIATION_ERROR {
                for i in 0..3 {
                    for k in 0..3 {
                        axes[i][k][half * HALF + place] = f32::from(u8::from(i == k));
                    }
                }
            }
        }
    }
    axes
}

/// About the middles of the boxes and their half extents. The center may be anything: the extents are measured from it.
#[inline(always)]
fn middle<L: Lanes>(
    axes: &[[[f32; WIDTH]; 3]; 3],
    rows: &[Row],
    lanes: LanesAre,
) -> ([[f32; WIDTH]; 3], [[f32; WIDTH]; 3]) {
    let mut axis: Axes<L> = [[L::splat(0.0); 3]; 3];
    for i in 0..3 {
        for k in 0..3 {
            axis[i][k] = L::load(&axes[i][k]);
        }
    }
    let mut low = [L::splat(f32::INFINITY); 3];
    let mut high = [L::splat(f32::NEG_INFINITY); 3];
    for row in rows {
        let p = [L::load(&row[0]), L::load(&row[1]), L::load(&row[2])];
        for i in 0..3 {
            let along = axis[i][0] * p[0] + axis[i][1] * p[1] + axis[i][2] * p[2];
            low[i] = along.min(low[i]);
            high[i] = along.max(high[i]);
        }
    }
    if lanes == LanesAre::PartsOfOne {
        for i in 0..3 {
            low[i] = L::splat(low[i].store().into_iter().fold(f32::INFINITY, f32::min));
            high[i] = L::splat(high[i].store().into_iter().fold(f32::NEG_INFINITY, f32::max));
        }
    }
    let (mut center, mut about) = ([L::splat(0.0); 3], [[0.0; WIDTH]; 3]);
    for i in 0..3 {
        let middle = (low[i] + high[i]) * L::splat(0.5);
        for k in 0..3 {
            center[k] = center[k] + axis[i][k] * middle;
        }
        about[i] = ((high[i] - low[i]) * L::splat(0.5)).store();
    }
    ([center[0].store(), center[1].store(), center[2].store()], about)
}

static BLANK: WideNode = WideNode::empty([0.0; 3], 0);

/// Eight boxes, lane by lane.
struct Boxes {
    center: [[f32; WIDTH]; 3],
    axes: [[[f32; WIDTH]; 3]; 3],
    half_extent: [[f32; WIDTH]; 3],
    /// For each pair of axes four bytes as a number.
    slabs: [[f64; WIDTH]; 3],
    radius: [f32; WIDTH],
}

impl Boxes {
    /// Makes them the boxes of a node; lanes that are not used are blank.
    #[inline(always)]
    fn store(&mut self, node: &mut WideNode, below: &[Below], origin: [f32; 3]) {
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
struct WideReach<D> {
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
    fn new(origin: [f32; 3], boxes: &Boxes, about: &[[f32; WIDTH]; 3], half: usize) -> Self {
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
    fn add(&mut self, p: &[D; 3]) {
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
    fn join_all(&mut self, other: &Self) {
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
    fn finish(&self, boxes: &mut Boxes, half: usize) {
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

#[cfg(test)]
mod tests;
