//! Polygons of mesh files as triangles.
//!
//! A polygon of n corners becomes n − 2 triangles, and every way of cutting keeps the polygon's sides, so a closed mesh
//! stays closed. The polygon is seen along the coordinate axis nearest to its normal (Newell's sum over the sides), where
//! orientation signs are exact.
//!
//! - If all triangles of the fan about the first corner are counter-clockwise or flat, the fan is the answer; so it is for
//!   every convex polygon.
//! - Otherwise ears are cut (Meisters 1975, DOI 10.1080/00029890.1975.11993898): an ear is a corner that turns left and
//!   whose triangle holds no other corner. Where no ear is left, a corner on the line of its neighbours is cut off.
//! - All these triangles are counter-clockwise or flat, so seen along the axis they cover each point as often as the
//!   outline winds around it: once inside, never outside. Where no such cut is found the outline crosses itself as it is
//!   seen (or took more than [`MOST_TESTS`] tests). What is left then becomes a fan, and the polygon is *counted as crossing*.
//! - A polygon whose corners are not in one plane has no surface of its own. It is cut in the same way, and counted as
//!   *bent* if a corner is further than [`FLATNESS`] of its size from the plane through its middle.

use super::strips::fan;
use d2m_feature::orient2d;
use glam::{DVec2, DVec3};
use std::cmp::Ordering::{Equal, Greater, Less};
use std::collections::VecDeque;

/// Part of a polygon's size by which its corners may leave its plane before it is reported as bent. Coordinates that were
/// written with six digits stay below.
const FLATNESS: f64 = 1e-5;

/// Most tests of a corner against a triangle for all polygons of a file: a few seconds. A star of 100 000 long thin rays
/// takes a tenth of it.
const MOST_TESTS: u64 = 1 << 30;

/// What was found among the polygons of a file.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, parse_mesh};
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n";
/// let counts = parse_mesh(text, MeshFormat::Obj, &ReadOptions::new())?.report.polygons;
/// assert_eq!((counts.cut, counts.bent, counts.crossing), (1, 1, 0)); // one square that is not flat
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PolygonCounts {
    /// Polygons with more than three corners.
    pub cut: usize,
    /// Of them: not flat.
    pub bent: usize,
    /// Of them: cross themselves as they are seen along their normal, so their triangles overlap.
    pub crossing: usize,
    /// Faces with one or two corners: left out.
    pub without_area: usize,
}

impl PolygonCounts {
    /// Those of another part of the same file, too.
    pub(super) fn add(&mut self, other: Self) {
        self.cut += other.cut;
        self.bent += other.bent;
        self.crossing += other.crossing;
        self.without_area += other.without_area;
    }
}

/// Triangles of the polygons that were added, and what was found.
#[derive(Debug, Default)]
pub(super) struct Triangulation {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) counts: PolygonCounts,
    /// Tests that were made, up to [`MOST_TESTS`].
    tests: u64,
}

impl Triangulation {
    /// Adds the n − 2 triangles of a polygon of n corners; none for one or two corners.
    pub(super) fn add(&mut self, polygon: &[u32], vertices: &[DVec3]) {
        match polygon {
            [] | [_] | [_, _] => self.counts.without_area += 1,
            &[a, b, c] => self.triangles.push([a, b, c]),
            _ => {
                self.counts.cut += 1;
                let corners: Option<Vec<DVec3>> =
                    polygon.iter().map(|&index| vertices.get(index as usize).copied()).collect();
                let Some(corners) = corners else {
                    return self.triangles.extend(fan(polygon)); // an index is out of range, which the mesh will say
                };
                let normal = normal(&corners);
                self.counts.bent += usize::from(is_bent(&corners, normal));
                let flat = flatten(&corners, normal);
                let mut outline = Outline::new(polygon, &flat, self.tests);
                self.counts.crossing += usize::from(!outline.cut(&mut self.triangles));
                self.tests = outline.tests;
            }
        }
    }
}

/// Newell's sum over the sides, of the corners scaled to about one so that nothing under- or overflows. Rounded: it only
/// chooses from where the polygon is seen.
fn normal(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    let size = corners.iter().map(|&corner| (corner - origin).abs().max_element()).fold(0.0, f64::max);
    if size == 0.0 {
        return DVec3::ZERO;
    }
    let scaled = |corner: DVec3| (corner - origin) / size;
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&p, &q)| scaled(p).cross(scaled(q))).sum()
}

fn is_bent(corners: &[DVec3], normal: DVec3) -> bool {
    let Some(normal) = normal.try_normalize() else { return false };
    let origin = corners[0];
    let (mut low, mut high, mut size) = (0.0_f64, 0.0_f64, 0.0_f64);
    for &corner in corners {
        let height = (corner - origin).dot(normal);
        (low, high) = (low.min(height), high.max(height));
        size = size.max((corner - origin).abs().max_element());
    }
    high - low > FLATNESS * size
}

/// Seen along the axis nearest to the normal, counter-clockwise.
fn flatten(corners: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let size = normal.abs();
    let project: fn(DVec3) -> DVec2 = if size.x >= size.y && size.x >= size.z {
        if normal.x >= 0.0 { |p| DVec2::new(p.y, p.z) } else { |p| DVec2::new(p.z, p.y) }
    } else if size.y >= size.z {
        if normal.y >= 0.0 { |p| DVec2::new(p.z, p.x) } else { |p| DVec2::new(p.x, p.z) }
    } else if normal.z >= 0.0 {
        |p| DVec2::new(p.x, p.y)
    } else {
        |p| DVec2::new(p.y, p.x)
    };
    corners.iter().map(|&corner| project(corner)).collect()
}

/// A polygon from which ears are cut: a ring of the corners that are left.
struct Outline<'a> {
    polygon: &'a [u32],
    flat: &'a [DVec2],
    /// Corner before and after each corner that is left.
    before: Vec<usize>,
    after: Vec<usize>,
    is_left: Vec<bool>,
    /// Corners that do not turn left: only they can be in the way of an ear.
    blockers: Grid,
    tests: u64,
}

impl<'a> Outline<'a> {
    fn new(polygon: &'a [u32], flat: &'a [DVec2], tests: u64) -> Self {
        let n = polygon.len();
        Self {
            polygon,
            flat,
            before: (0..n).map(|i| (i + n - 1) % n).collect(),
            after: (0..n).map(|i| (i + 1) % n).collect(),
            is_left: vec![true; n],
            blockers: Grid::default(),
            tests,
        }
    }

    /// Appends n − 2 triangles; says whether all of them are counter-clockwise or flat.
    fn cut(&mut self, triangles: &mut Vec<[u32; 3]>) -> bool {
        let n = self.polygon.len();
        let flat = self.flat;
        let is_fan = (1..n - 1).all(|i| orient2d(flat[0], flat[i], flat[i + 1]) != Less);
        if is_fan {
            triangles.extend(fan(self.polygon));
            return true;
        }
        let blockers: Vec<usize> = (0..n).filter(|&i| self.turn(i) != Greater).collect();
        self.blockers = Grid::new(flat, &blockers);
        let mut left = n;
        let mut takes_flat = false;
        loop {
            let before = left;
            // When an ear is cut off, only its neighbors can have become ears.
            let mut queue: VecDeque<usize> = (0..n).filter(|&i| self.is_left[i]).collect();
            while let Some(corner) = queue.pop_front()
                && left > 3
                && self.tests < MOST_TESTS
            {
                let can_go = self.is_left[corner]
                    && match self.turn(corner) {
                        Greater => self.is_ear(corner),
                        Equal => takes_flat,
                        Less => false,
                    };
                if can_go {
                    let [before, _, after] = self.neighbors(corner);
                    triangles.push(self.triangle(corner));
                    self.remove(corner);
                    left -= 1;
                    queue.extend([before, after]);
                }
            }
            if left == 3 || self.tests >= MOST_TESTS || (left == before && takes_flat) {
                break;
            }
            takes_flat = left == before;
        }
        let Some(first) = self.is_left.iter().position(|&is_left| is_left) else { return false };
        let mut rest = vec![first];
        let mut corner = self.after[first];
        while corner != first {
            rest.push(corner);
            corner = self.after[corner];
        }
        let is_whole = rest.len() == 3 && self.turn(first) != Less;
        let rest: Vec<u32> = rest.into_iter().map(|corner| self.polygon[corner]).collect();
        triangles.extend(fan(&rest));
        is_whole
    }

    fn neighbors(&self, corner: usize) -> [usize; 3] {
        [self.before[corner], corner, self.after[corner]]
    }

    fn turn(&self, corner: usize) -> std::cmp::Ordering {
        let [a, b, c] = self.neighbors(corner).map(|corner| self.flat[corner]);
        orient2d(a, b, c)
    }

    fn triangle(&self, corner: usize) -> [u32; 3] {
        self.neighbors(corner).map(|corner| self.polygon[corner])
    }

    fn remove(&mut self, corner: usize) {
        let [before, _, after] = self.neighbors(corner);
        (self.after[before], self.before[after]) = (after, before);
        self.is_left[corner] = false;
    }

    /// Holds the triangle of a corner that turns left no other corner? One at the place of a corner of the triangle is not
    /// in the way: outlines that touch themselves (holes on a bridge) have such.
    fn is_ear(&mut self, corner: usize) -> bool {
        let triangle = self.neighbors(corner).map(|corner| self.flat[corner]);
        let [a, b, c] = triangle;
        let (flat, is_left) = (self.flat, &self.is_left);
        let holds = |other: usize| {
            let point = flat[other];
            !triangle.contains(&point)
                && [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| orient2d(from, to, point) != Less)
        };
        !self.blockers.any_near(triangle, |other| is_left[other], holds, &mut self.tests)
    }
}

/// Corners by place: cells of a square grid over the outline.
#[derive(Default)]
struct Grid {
    low: DVec2,
    /// Cells per unit of length, by axis.
    scale: DVec2,
    side: usize,
    cells: Vec<Vec<usize>>,
}

/// Cells by which a triangle is widened: far more than the rounding of coordinates in units of cells (a few 2⁻⁵³ of the at
/// most 2¹⁶ cells of a row). A corner that is overlooked all the same costs no more than a polygon that counts as crossing.
const WIDENED: f64 = 1e-6;

impl Grid {
    fn new(flat: &[DVec2], corners: &[usize]) -> Self {
        let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let side = (corners.len() as f64).sqrt().ceil().max(1.0);
        // An outline without width or height has one column or row of cells.
        let scale = (high - low).map(|extent| if extent > 0.0 { side / extent } else { 0.0 });
        let scale = scale.map(|scale| if scale.is_finite() { scale } else { 0.0 });
        let side = side as usize;
        let mut grid = Self { low, scale, side, cells: vec![Vec::new(); side * side] };
        for &corner in corners {
            let place = grid.place(flat[corner]);
            let cell = grid.whole(place.y) * side + grid.whole(place.x);
            grid.cells[cell].push(corner);
        }
        grid
    }

    /// Coordinates in units of cells.
    fn place(&self, point: DVec2) -> DVec2 {
        (point - self.low) * self.scale
    }

    fn whole(&self, place: f64) -> usize {
        (place as usize).min(self.side - 1)
    }

    /// Does `test` hold for a corner in the cells that meet the triangle? Corners that are not `kept` are dropped.
    fn any_near(
        &mut self,
        triangle: [DVec2; 3],
        kept: impl Fn(usize) -> bool,
        test: impl Fn(usize) -> bool,
        tests: &mut u64,
    ) -> bool {
        let [a, b, c] = triangle.map(|point| self.place(point));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        for row in self.whole(low.y - WIDENED)..=self.whole(high.y + WIDENED) {
            // The last row also holds what rounding puts beyond it.
            let bottom = row as f64 - WIDENED;
            let top = if row + 1 == self.side { f64::INFINITY } else { row as f64 + 1.0 + WIDENED };
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                if p.y.max(q.y) < bottom || p.y.min(q.y) > top {
                    continue;
                }
                for height in [bottom, top] {
                    let part = ((height - p.y) / (q.y - p.y)).clamp(0.0, 1.0);
                    // A side along the row has no such part.
                    let ends = if part.is_nan() { [p.x, q.x] } else { [p.x + (q.x - p.x) * part; 2] };
                    (from, to) = (from.min(ends[0]).min(ends[1]), to.max(ends[0]).max(ends[1]));
                }
            }
            for column in self.whole(from - WIDENED)..=self.whole(to + WIDENED) {
                let cell = &mut self.cells[row * self.side + column];
                cell.retain(|&corner| kept(corner));
                *tests += 1 + cell.len() as u64;
                if cell.iter().any(|&corner| test(corner)) {
                    return true;
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests;
