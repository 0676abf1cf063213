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

#[cfg(test)]
mod tests;
