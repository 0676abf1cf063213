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
use super::wide_boxes::{Boxes, HALF, WideReach, widened};

use d2m_lanes::three::cross;
use d2m_lanes::{Doubles, Elementwise, Lanes, Quad, Task};

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
        let is_triangle = self.is_triangle();
        let all_lanes = (1 << self.parts.len()) - 1;
        if is_triangle == all_lanes {
            return self.fit_triangles::<L>();
        }
        let mut lanes: [&[u32]; WIDTH] = [&[]; WIDTH];
        lanes[..self.parts.len()].copy_from_slice(self.parts);
        self.gather::<L::Doubles>(&lanes);
        let mut triangles = [[[0.0; WIDTH]; 3]; 2];
        if is_triangle != 0 {
            self.measure_triangles::<L>(is_triangle, &mut triangles);
        }
        let mut all = Moments::default();
        for moments in self.moments.iter() {
            all.add(moments);
        }
        let origin = self.origin_of(&all);
        self.narrow::<L>(origin);
        let axes = self.axes::<L>(is_triangle, &triangles);
        self.store::<L>(origin, &axes, LanesAre::Boxes);
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
        self.gather::<L::Doubles>(&lanes);
        self.narrow::<L>(origin);
        let mut axes = self.axes::<L>(0, &[[[0.0; WIDTH]; 3]; 2]);
        for axis in axes.as_flattened_mut() {
            *axis = L::splat(axis.store()[0]);
        }
        for (lane, points) in lanes.iter_mut().zip(part.chunks(part.len().div_ceil(WIDTH))) {
            *lane = points;
        }
        self.gather::<L::Doubles>(&lanes);
        self.narrow::<L>(origin);
        self.store::<L>(origin, &axes, LanesAre::PartsOfOne);
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
    fn gather<D: Doubles<Scalar = f64>>(&mut self, lanes: &[&[u32]; WIDTH]) {
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
        let mut parts = *lanes;
        for part in &mut parts {
            *part = if part.is_empty() { &lanes[0][..1] } else { part };
        }
        for (at, row) in rows.wide[..count].iter_mut().enumerate() {
            for half in 0..2 {
                let mut points = [&self.points[0]; HALF];
                for place in 0..HALF {
                    let part = parts[half * HALF + place];
                    points[place] = &self.points[part[if at < part.len() { at } else { 0 }] as usize];
                }
                let columns = columns::<D>(points);
                for k in 0..3 {
                    row.0[k][half] = columns[k].store();
                }
            }
        }
    }

    /// The same from the origin, in `f32`.
    #[inline(always)]
    fn narrow<L: Lanes>(&mut self, origin: [f32; 3]) {
        let Rows { wide, narrow, used } = &mut *self.rows;
        for (narrow, wide) in narrow[..*used].iter_mut().zip(&wide[..*used]) {
            for k in 0..3 {
                let from = L::Doubles::splat(f64::from(origin[k]));
                let [low, high] = &wide.0[k];
                narrow[k] =
                    L::narrowed([L::Doubles::load(low) - from, L::Doubles::load(high) - from]).store();
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
    fn axes<L: Lanes>(&self, is_triangle: u32, triangles: &StoredAxes) -> [[L; 3]; 2] {
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
        let [first, second, _] = refined(principal_axes(matrix), &self.rows.narrow[..self.rows.used]);
        let ([a, b], [c, d]) = (widened(&first), widened(&second));
        let axes = stored::<L>(&[frames(&a, &c), frames(&b, &d)]);
        if is_triangle == 0 {
            return axes;
        }
        let mut mixed = axes;
        for i in 0..2 {
            for k in 0..3 {
                let mut lanes = axes[i][k].store();
                for lane in 0..WIDTH {
                    if is_triangle >> lane & 1 == 1 {
                        lanes[lane] = triangles[i][k][lane];
                    }
                }
                mixed[i][k] = L::load(&lanes);
            }
        }
        mixed
    }

    /// Fits the boxes with these axes.
    #[inline(always)]
    fn store<L: Lanes>(&mut self, origin: [f32; 3], stored: &[[L; 3]; 2], lanes: LanesAre) {
        let mut middle = Middle::new(all_axes(stored));
        for row in &self.rows.narrow[..self.rows.used] {
            middle.add(&[L::load(&row[0]), L::load(&row[1]), L::load(&row[2])]);
        }
        if lanes == LanesAre::PartsOfOne {
            middle.join_all();
        }
        let (center, [mut low, mut high]) = middle.reaches(origin);
        for row in &self.rows.wide[..self.rows.used] {
            low.add(&[
                L::Doubles::load(&row.0[0][0]),
                L::Doubles::load(&row.0[1][0]),
                L::Doubles::load(&row.0[2][0]),
            ]);
        }
        for row in &self.rows.wide[..self.rows.used] {
            high.add(&[
                L::Doubles::load(&row.0[0][1]),
                L::Doubles::load(&row.0[1][1]),
                L::Doubles::load(&row.0[2][1]),
            ]);
        }
        if lanes == LanesAre::PartsOfOne {
            low.join_all(&high);
            high = low.clone();
        }
        Boxes::around(center, middle.axes, &[low, high]).store(self.node, self.below, origin);
        self.node.parent = self.parent;
    }
}

/// Coordinates of four points, side by side.
#[inline(always)]
fn columns<D: Doubles>(points: [&[f64; 3]; HALF]) -> [D; 3] {
    let [a, b, c, d] = points;
    [
        D::load(&Quad([a[0], b[0], c[0], d[0]])),
        D::load(&Quad([a[1], b[1], c[1], d[1]])),
        D::load(&Quad([a[2], b[2], c[2], d[2]])),
    ]
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

/// The first two axes of frames as a node stores them, from both halves of its lanes.
#[inline(always)]
fn stored<L: Lanes>([low, high]: &[[[L::Doubles; 3]; 2]; 2]) -> [[L; 3]; 2] {
    let mut axes = [[L::splat(0.0); 3]; 2];
    for i in 0..2 {
        for k in 0..3 {
            axes[i][k] = L::narrowed([low[i][k], high[i][k]]);
        }
    }
    axes
}

/// The axes with the third ones, as whoever reads the boxes computes them; those of the coordinates for the one frame in some 10⁸
/// that its roundings leave less orthonormal than boxes promise.
#[inline(always)]
fn all_axes<L: Lanes>(&[first, second]: &[[L; 3]; 2]) -> Axes<L> {
    let mut axes = [first, second, cross(&first, &second)];
    let ([a, b], [c, d]) = (widened(&axes[0]), widened(&axes[1]));
    let [e, f] = widened(&axes[2]);
    let is_spoiled = L::narrowed([is_spoiled(&[a, c, e]), is_spoiled(&[b, d, f])]);
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    for i in 0..3 {
        for k in 0..3 {
            let unit = if i == k { one } else { zero };
            axes[i][k] = L::if_greater(is_spoiled, zero, unit, axes[i][k]);
        }
    }
    axes
}

/// One for frames that are less orthonormal than boxes promise, else zero.
#[inline(always)]
fn is_spoiled<D: Doubles<Scalar = f64>>(frame: &[[D; 3]; 3]) -> D {
    let most = D::splat(MOST_DEVIATION - 2.0 * DEVIATION_ERROR);
    D::if_greater(deviation(frame), most, D::splat(1.0), D::splat(0.0))
}

/// About the middles of boxes with these axes, and their half extents. The center may be anything: the extents are measured from it.
struct Middle<L> {
    axes: Axes<L>,
    low: [L; 3],
    high: [L; 3],
}

impl<L: Lanes> Middle<L> {
    #[inline(always)]
    fn new(axes: Axes<L>) -> Self {
        Self { axes, low: [L::splat(f32::INFINITY); 3], high: [L::splat(f32::NEG_INFINITY); 3] }
    }

    /// Takes a point, from the origin.
    #[inline(always)]
    fn add(&mut self, p: &[L; 3]) {
        for i in 0..3 {
            let axis = &self.axes[i];
            let along = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
            self.low[i] = along.min(self.low[i]);
            self.high[i] = along.max(self.high[i]);
        }
    }

    /// In every lane what is between all lanes.
    #[inline(always)]
    fn join_all(&mut self) {
        for i in 0..3 {
            self.low[i] = L::splat(self.low[i].store().into_iter().fold(f32::INFINITY, f32::min));
            self.high[i] = L::splat(self.high[i].store().into_iter().fold(f32::NEG_INFINITY, f32::max));
        }
    }

    /// The centers, and what is to be measured from them in both halves of the lanes.
    #[inline(always)]
    fn reaches(&self, origin: [f32; 3]) -> ([L; 3], [WideReach<L::Doubles>; 2]) {
        let (mut center, mut about) = ([L::splat(0.0); 3], [L::splat(0.0); 3]);
        for i in 0..3 {
            let middle = (self.low[i] + self.high[i]) * L::splat(0.5);
            for k in 0..3 {
                center[k] = center[k] + self.axes[i][k] * middle;
            }
            about[i] = (self.high[i] - self.low[i]) * L::splat(0.5);
        }
        let (centers, abouts) = (widened(&center), widened(&about));
        let axes = [widened(&self.axes[0]), widened(&self.axes[1]), widened(&self.axes[2])];
        let low = [axes[0][0], axes[1][0], axes[2][0]];
        let high = [axes[0][1], axes[1][1], axes[2][1]];
        let low = WideReach::new(origin, &centers[0], low, &abouts[0]);
        (center, [low, WideReach::new(origin, &centers[1], high, &abouts[1])])
    }
}

mod triangles;

#[cfg(test)]
mod tests;
