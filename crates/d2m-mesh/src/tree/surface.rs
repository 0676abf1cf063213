//! The triangles of a mesh in local coordinates, and boxes around some of them.

use super::node::OrientedBox;
use super::slabs::EdgeReach;
use crate::TriMesh;
use crate::margin::{UNIT_F64, round_up};
use crate::parallel::{MANY, map_in_order};
use d2m_lanes::three::{dot, minus};
use d2m_lanes::{power_of_two, power_of_two_above};
use glam::DVec3;
use std::borrow::Cow;

/// Where local coordinates begin, how far the body reaches from there, and the unit they are divided by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    pub(super) unit: f64,
}

impl Extent {
    /// Middle of the bounding box of the used vertices, and a bound on the distance from it.
    pub(super) fn of(mesh: &TriMesh) -> Self {
        let used = used_vertices(mesh);
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &p in used.iter() {
            (low, high) = (low.min(p), high.max(p));
        }
        let center = low * 0.5 + high * 0.5;
        // Differences are rounded without a change of order, so the box has the largest.
        Self::within(&used, center, (low - center).abs().max((high - center).abs()).max_element())
    }

    /// The least bound on the distance from a given center.
    pub(super) fn about(mesh: &TriMesh, center: DVec3) -> Self {
        let used = used_vertices(mesh);
        let largest = used.iter().map(|&p| (p - center).abs().max_element()).fold(0.0, f64::max);
        Self::within(&used, center, largest)
    }

    /// The same if the largest coordinate of a used vertex from the center is known.
    fn within(used: &[DVec3], center: DVec3, largest: f64) -> Self {
        // In a unit in which no square over- or underflows; one over it is exact.
        let unit = unit_of(largest);
        let inverse = 1.0 / unit;
        let square = used.iter().map(|&p| ((p - center) * inverse).length_squared()).fold(0.0, f64::max);
        // Differences, squares, sum, root: relative error below 6v. Below the normal numbers the product rounds.
        let radius = square.sqrt() * (1.0 + 16.0 * UNIT_F64) * unit;
        let radius = if radius < f64::MIN_POSITIVE && square > 0.0 { f64::MIN_POSITIVE } else { radius };
        Self { center, radius, unit: unit_of(radius) }
    }

    /// A point of the body in local coordinates.
    #[inline(always)]
    pub(super) fn local(&self, p: DVec3) -> [f64; 3] {
        // One over a power of two is exact.
        ((p - self.center) * (1.0 / self.unit)).to_array()
    }
}

/// The vertices that triangles use, each once.
fn used_vertices(mesh: &TriMesh) -> Cow<'_, [DVec3]> {
    let mut is_used = vec![false; mesh.vertex_count()];
    for &vertex in mesh.triangles().as_flattened() {
        is_used[vertex as usize] = true;
    }
    if is_used.iter().all(|is_used| *is_used) {
        return Cow::Borrowed(mesh.vertices());
    }
    let vertices = mesh.vertices().iter().zip(is_used);
    Cow::Owned(vertices.filter_map(|(&vertex, is_used)| is_used.then_some(vertex)).collect())
}

/// The least unit of a tree: one over it is a number.
const LEAST_UNIT: f64 = power_of_two(-1000); // 2⁻¹⁰⁰⁰

/// The least power of two that is not below `radius`, and not below the least unit; one for a point.
pub(super) fn unit_of(radius: f64) -> f64 {
    if radius < LEAST_UNIT {
        return if radius == 0.0 { 1.0 } else { LEAST_UNIT };
    }
    power_of_two_above(radius)
}

/// A mesh in local coordinates.
pub(super) struct Surface<'a> {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) triangles: &'a [[u32; 3]],
    /// Three times the middle of each triangle.
    pub(super) sums: Vec<[f32; 3]>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(mesh: &'a TriMesh, extent: &Extent) -> Self {
        let points = map_in_order(mesh.vertices(), MANY, |&p| extent.local(p));
        Self { points, triangles: mesh.triangles(), sums: Vec::new() }
    }

    /// The same with the middles of the triangles.
    pub(super) fn with_sums(mesh: &'a TriMesh, extent: &Extent) -> Self {
        let mut surface = Self::new(mesh, extent);
        let points = &surface.points;
        surface.sums = map_in_order(mesh.triangles(), MANY, |&[i, j, k]| {
            let [a, b, c] = [points[i as usize], points[j as usize], points[k as usize]];
            [(a[0] + b[0] + c[0]) as f32, (a[1] + b[1] + c[1]) as f32, (a[2] + b[2] + c[2]) as f32]
        });
        surface
    }

    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        let [i, j, k] = self.triangles[triangle as usize];
        [self.points[i as usize], self.points[j as usize], self.points[k as usize]]
    }
}

/// How far a box reaches from its center, rounded up.
struct Extents {
    half_extent: [f32; 3],
    radius: f32,
}

/// How far points reach from the center of a box, along its axes and in all.
///
/// Rounding, v = 2⁻⁵³, for a point p (local, itself within v of the real one in each coordinate; its unit is a power
/// of two): p − origin − center errs by v(|p| + |p − o| + |q|) and the projection by 3v|q|₁ more, in all less than
/// 7v(|p|₁ + |o|₁ + |c|₁); [`SLACK`](Self::SLACK) is 8v of that.
pub(super) struct Reach {
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
    center: [f64; 3],
    half: [f64; 3],
    edges: EdgeReach,
    square: f64,
    norm: f64,
}

impl Reach {
    pub(super) const SLACK: f64 = 8.0 * UNIT_F64;

    /// `about`: the half extents as far as they are known.
    pub(super) fn new(origin: [f32; 3], center: [f32; 3], axes: &[[f32; 3]; 3], about: [f64; 3]) -> Self {
        Self {
            axes: axes.map(|axis| axis.map(f64::from)),
            origin: origin.map(f64::from),
            center: center.map(f64::from),
            half: [0.0; 3],
            edges: EdgeReach::new(about),
            square: 0.0,
            norm: 0.0,
        }
    }

    /// Takes a point in local coordinates.
    #[inline(always)]
    pub(super) fn add(&mut self, p: &[f64; 3]) {
        let q = minus(&minus(p, &self.origin), &self.center);
        let along = [dot(&self.axes[0], &q), dot(&self.axes[1], &q), dot(&self.axes[2], &q)];
        for (half, along) in self.half.iter_mut().zip(along) {
            *half = if along.abs() > *half { along.abs() } else { *half };
        }
        self.edges.add(along);
        let (square, norm) = (dot(&q, &q), p[0].abs() + p[1].abs() + p[2].abs());
        self.square = if square > self.square { square } else { self.square };
        self.norm = if norm > self.norm { norm } else { self.norm };
    }

    /// Bound on the error of coordinates along the axes.
    fn slack(&self) -> f64 {
        let sum = |v: &[f64; 3]| v[0].abs() + v[1].abs() + v[2].abs();
        Self::SLACK * (self.norm + sum(&self.origin) + sum(&self.center))
    }

    /// Is all of it proven to be in the box and its sphere?
    pub(super) fn is_within(&self, boxed: &OrientedBox) -> bool {
        let Extents { half_extent: half, radius } = self.outward();
        (0..3).all(|i| half[i] <= boxed.half_extent[i])
            && radius <= boxed.radius
            && self.edges.are_left_by(&boxed.slabs, &boxed.half_extent, self.slack())
    }

    /// Half extents and radius that enclose the points in real arithmetic. Monotone: a box made from more points is
    /// at least as large, in every bit.
    fn outward(&self) -> Extents {
        let slack = self.slack();
        let half = self.half.map(|h| round_up(h + slack));
        let radius = round_up(self.square.sqrt() * (1.0 + 8.0 * UNIT_F64) + slack);
        Extents { half_extent: half, radius }
    }
}
