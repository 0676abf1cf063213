//! Nodes of which each lane is a triangle, nine of ten: from the corners to the boxes in registers.

// Lanes are indexed alike in several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::{
    Boxes, HALF, Middle, Moments, Siblings, all_axes, columns, stored, triangle_axes, triangle_moments,
};
use d2m_lanes::{Doubles, Elementwise, Lanes};

impl Siblings<'_> {
    #[inline(always)]
    pub(super) fn fit_triangles<L: Lanes>(&mut self) -> Moments {
        let (low, high) = (self.corners::<L::Doubles>(0), self.corners::<L::Doubles>(1));
        let moments = [triangle_moments(&low), triangle_moments(&high)];
        let mut all = Moments::default();
        for lane in 0..self.parts.len() {
            for k in 0..Moments::LENGTH {
                all.0[k] += moments[lane / HALF][k].0[lane % HALF];
            }
        }
        let origin = self.origin_of(&all);
        let from = [
            L::Doubles::splat(f64::from(origin[0])),
            L::Doubles::splat(f64::from(origin[1])),
            L::Doubles::splat(f64::from(origin[2])),
        ];
        let mut middle = Middle::new(all_axes::<L>(&stored(&[triangle_axes(&low), triangle_axes(&high)])));
        for i in 0..3 {
            let mut corner = [L::splat(0.0); 3];
            for k in 0..3 {
                corner[k] = L::narrowed([low[i][k] - from[k], high[i][k] - from[k]]);
            }
            middle.add(&corner);
        }
        let (center, mut reached) = middle.reaches(origin);
        for i in 0..3 {
            reached[0].add(&low[i]);
            reached[1].add(&high[i]);
        }
        Boxes::around(center, middle.axes, &reached).store(self.node, self.below, origin);
        self.node.parent = self.parent;
        all
    }

    /// Of the triangles in one half of the lanes; lanes that are not used have the first one's.
    #[inline(always)]
    fn corners<D: Doubles<Scalar = f64>>(&self, half: usize) -> [[D; 3]; 3] {
        let mut corners = [[D::splat(0.0); 3]; 3];
        for i in 0..3 {
            let mut points = [&self.points[0]; HALF];
            for place in 0..HALF {
                let lane = half * HALF + place;
                let part = self.parts[if lane < self.parts.len() { lane } else { 0 }];
                points[place] = &self.points[part[i] as usize];
            }
            corners[i] = columns(points);
        }
        corners
    }
}
