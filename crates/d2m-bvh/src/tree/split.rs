//! Across which direction a part of the surface is cut in two, so that the boxes of both halves are small.
//!
//! Only a heuristic: every cut gives a valid tree. The longest extent alone is a poor guide where a part bends or is about as
//! wide as long: against it, nine directions take 8–16 % off the node tests of a query on scanned shapes and 25–30 % on
//! machine parts. No trigonometric function is called, so trees have the same bits on every platform.

use super::fit::{Moments, dot, sub};
use super::refine::DIRECTIONS;
use super::surface::Surface;

/// Directions that are tried: the axes of the part and the diagonals between two of them, the first of [`DIRECTIONS`].
const CUTS: usize = 9;
/// Triangles that a direction is chosen by.
const SAMPLE: usize = 256;
/// Directions that are tried with real boxes: those with the least second moments.
const FINALISTS: usize = 4;

/// A triangle that the choice of the split evaluates.
struct Sampled {
    /// Vertices from some point of the part.
    corners: [[f32; 3]; 3],
    moments: [f32; Moments::LENGTH],
    /// Sum of the vertices along the directions.
    along: [f32; CUTS],
}

/// Axes of two halves.
type Axes = [[[f64; 3]; 3]; 2];

/// Memory of one thread for splitting parts.
#[derive(Default)]
pub(super) struct Splitter {
    sample: Vec<Sampled>,
    /// Places along a direction, and triangles: numbers in the sample, or of the mesh.
    order: Vec<(f32, u32)>,
    best_order: Vec<(f32, u32)>,
    before: Vec<u32>,
}

impl Splitter {
    /// Puts the `half` triangles of a part that lie lowest along a good direction first. `axes` are those of the part;
    /// returned are those of the halves.
    pub(super) fn split(
        &mut self,
        surface: &Surface,
        part: &mut [u32],
        axes: &[[f64; 3]; 3],
        half: usize,
    ) -> Axes {
        let directions: [[f64; 3]; CUTS] = core::array::from_fn(|cut| {
            let d = DIRECTIONS[cut];
            [0, 1, 2].map(|k| d[0] * axes[0][k] + d[1] * axes[1][k] + d[2] * axes[2][k])
        });
        let stride = part.len().div_ceil(SAMPLE);
        self.take(part.iter().step_by(stride).map(|&triangle| surface.corners(triangle)), &directions);
        let lower = half * self.sample.len() / part.len();
        let ranked = self.ranked();
        let mut best = (f32::INFINITY, ranked[0].1, [*axes; 2]);
        for &(_, direction) in &ranked[..FINALISTS] {
            let (size, axes) = self.cut(direction, lower);
            if size < best.0 {
                best = (size, direction, axes);
                core::mem::swap(&mut self.order, &mut self.best_order);
            }
        }
        let (size, direction, axes) = best;
        if stride == 1 && size < f32::INFINITY {
            self.before.clear();
            self.before.extend_from_slice(part);
            for (slot, &(_, i)) in part.iter_mut().zip(&self.best_order) {
                *slot = self.before[i as usize];
            }
            return axes;
        }
        let across = directions[direction];
        self.order.clear();
        self.order.extend(part.iter().map(|&triangle| (surface.along(triangle, across), triangle)));
        partition(&mut self.order, half);
        for (slot, &(_, triangle)) in part.iter_mut().zip(&self.order) {
            *slot = triangle;
        }
        let (first, second) = part.split_at(half);
        [surface.axes(first), surface.axes(second)]
    }

    fn take(&mut self, part: impl Iterator<Item = [[f64; 3]; 3]>, directions: &[[f64; 3]; CUTS]) {
        self.sample.clear();
        let mut from = None;
        for corners in part {
            let from = *from.get_or_insert(corners[0]);
            let corners = corners.map(|p| sub(p, from));
            let sum = [0, 1, 2].map(|k| corners[0][k] + corners[1][k] + corners[2][k]);
            let mut moments = Moments::default();
            moments.add(&corners);
            self.sample.push(Sampled {
                corners: corners.map(|p| p.map(|c| c as f32)),
                moments: moments.narrow(),
                along: directions.map(|d| dot(d, sum) as f32),
            });
        }
    }

    /// The directions, those first that leave the least second moments on both sides of the middle.
    fn ranked(&self) -> [(f64, usize); CUTS] {
        let mut middle = [0.0f32; CUTS];
        for triangle in &self.sample {
            for (sum, along) in middle.iter_mut().zip(&triangle.along) {
                *sum += along;
            }
        }
        let share = 1.0 / self.sample.len() as f32;
        let mut sides = [[[0.0f32; Moments::LENGTH]; 2]; CUTS];
        for triangle in &self.sample {
            for (direction, sums) in sides.iter_mut().enumerate() {
                let side = usize::from(triangle.along[direction] < middle[direction] * share);
                for (sum, moment) in sums[side].iter_mut().zip(&triangle.moments) {
                    *sum += moment;
                }
            }
        }
        let mut ranked = [(0.0, 0); CUTS];
        for (direction, rank) in ranked.iter_mut().enumerate() {
            let spread = |side: usize| Moments::widen(&sides[direction][side]).spread();
            *rank = (spread(0) + spread(1), direction);
        }
        ranked.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        ranked
    }

    /// Cuts the sample: the sum of the extents of both halves along their principal axes, and these axes.
    fn cut(&mut self, direction: usize, half: usize) -> (f32, Axes) {
        self.order.clear();
        self.order.extend(self.sample.iter().zip(0..).map(|(triangle, i)| (triangle.along[direction], i)));
        partition(&mut self.order, half);
        let (first, second) = self.order.split_at(half);
        let ((size, axes), (other_size, other_axes)) = (self.size(first), self.size(second));
        (size + other_size, [axes, other_axes])
    }

    fn size(&self, part: &[(f32, u32)]) -> (f32, [[f64; 3]; 3]) {
        let mut sum = [0.0f32; Moments::LENGTH];
        for &(_, i) in part {
            for (sum, moment) in sum.iter_mut().zip(&self.sample[i as usize].moments) {
                *sum += moment;
            }
        }
        let axes = Moments::widen(&sum).axes();
        let column = |k: usize| [axes[0][k] as f32, axes[1][k] as f32, axes[2][k] as f32, 0.0];
        let (x, y, z) = (column(0), column(1), column(2));
        let (mut low, mut high) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
        for &(_, i) in part {
            for p in &self.sample[i as usize].corners {
                for k in 0..4 {
                    let along = x[k] * p[0] + y[k] * p[1] + z[k] * p[2];
                    low[k] = if along < low[k] { along } else { low[k] };
                    high[k] = if along > high[k] { along } else { high[k] };
                }
            }
        }
        ((high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2]), axes)
    }
}

/// Puts the `half` lowest first.
fn partition(order: &mut [(f32, u32)], half: usize) {
    if half < order.len() {
        order.select_nth_unstable_by(half, |x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    }
}
