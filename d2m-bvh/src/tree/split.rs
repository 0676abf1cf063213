//! Across which direction a part of the surface is cut in two, so that the boxes of both halves are small.
//!
//! Only a heuristic: every cut gives a valid tree. The longest extent alone is a poor guide where a part bends or is about as
//! wide as long: against it, nine directions take 8–16 % off the node tests of a query on scanned shapes and 25–30 % on
//! machine parts. No trigonometric function is called, so trees have the same bits on every platform.

use super::fit::{Moments, dot, sub};

/// Directions in the frame of the part's axes: the axes and the diagonals between two of them.
const DIRECTIONS: [[f64; 3]; 9] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
];
/// Triangles that a direction is chosen by.
const SAMPLE: usize = 256;
/// Directions that are tried with real boxes: those with the least second moments.
const FINALISTS: usize = 4;

/// A triangle that the choice looks at.
struct Sampled {
    /// Corners from some point of the part.
    corners: [[f32; 3]; 3],
    moments: [f32; Moments::LENGTH],
    /// Sum of the corners along the directions.
    along: [f32; DIRECTIONS.len()],
}

/// Memory of one thread for choosing directions.
#[derive(Default)]
pub(super) struct Chooser {
    sample: Vec<Sampled>,
    order: Vec<(f32, u32)>,
}

impl Chooser {
    /// How many triangles of a part there are to each one that is looked at.
    pub(super) fn stride(count: usize) -> usize {
        count.div_ceil(SAMPLE)
    }

    /// The direction, not normalised, across which the part should be cut. `part` gives the corners of the triangles to
    /// look at; `lower` is the share of the triangles that comes first.
    pub(super) fn direction(
        &mut self,
        part: impl Iterator<Item = [[f64; 3]; 3]>,
        axes: &[[f64; 3]; 3],
        lower: f64,
    ) -> [f64; 3] {
        let directions =
            DIRECTIONS.map(|d| [0, 1, 2].map(|k| d[0] * axes[0][k] + d[1] * axes[1][k] + d[2] * axes[2][k]));
        self.take(part, &directions);
        let ranked = self.ranked();
        let half = (lower * self.sample.len() as f64) as usize;
        let mut best = (f32::INFINITY, ranked[0].1);
        for &(_, direction) in &ranked[..FINALISTS] {
            let size = self.size_of_halves(direction, half);
            if size < best.0 {
                best = (size, direction);
            }
        }
        directions[best.1]
    }

    fn take(&mut self, part: impl Iterator<Item = [[f64; 3]; 3]>, directions: &[[f64; 3]; 9]) {
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
    fn ranked(&self) -> [(f64, usize); DIRECTIONS.len()] {
        let mut middle = [0.0f32; DIRECTIONS.len()];
        for triangle in &self.sample {
            for (sum, along) in middle.iter_mut().zip(&triangle.along) {
                *sum += along;
            }
        }
        let share = 1.0 / self.sample.len() as f32;
        let mut sides = [[[0.0f32; Moments::LENGTH]; 2]; DIRECTIONS.len()];
        for triangle in &self.sample {
            for (direction, sums) in sides.iter_mut().enumerate() {
                let side = usize::from(triangle.along[direction] < middle[direction] * share);
                for (sum, moment) in sums[side].iter_mut().zip(&triangle.moments) {
                    *sum += moment;
                }
            }
        }
        let mut ranked = [(0.0, 0); DIRECTIONS.len()];
        for (direction, rank) in ranked.iter_mut().enumerate() {
            let spread = |side: usize| Moments::widen(&sides[direction][side]).spread();
            *rank = (spread(0) + spread(1), direction);
        }
        ranked.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        ranked
    }

    /// Sum of the extents of both halves along their principal axes.
    fn size_of_halves(&mut self, direction: usize, half: usize) -> f32 {
        self.order.clear();
        self.order.extend(self.sample.iter().zip(0..).map(|(triangle, i)| (triangle.along[direction], i)));
        if half < self.order.len() {
            self.order.select_nth_unstable_by(half, |x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        }
        let (first, second) = self.order.split_at(half);
        self.size(first) + self.size(second)
    }

    fn size(&self, part: &[(f32, u32)]) -> f32 {
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
        (high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2])
    }
}
