//! A triangle or convex polygon with its normal and side directions.

use super::direction::{Direction, across, unit};
use glam::DVec3;

/// A triangle, prepared for [`point_triangle`](super::point_triangle()).
///
/// The normal n and the in-plane normals of the three sides, each with the extent of the triangle along it. Collapsed
/// triangles (a segment, a point) get directions across and along what is left of them; every direction is sound.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_paper::TriangleFace;
/// use glam::DVec3;
/// let floor = TriangleFace::new([DVec3::ZERO, DVec3::X, DVec3::Y]);
/// let face = floor.face();
/// assert_eq!((face.normal.vector.abs(), face.sides.len()), (DVec3::Z, 3));
/// assert!(face.normal.certainly_apart(Interval::point(0.1))); // a point above it does not touch it
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TriangleFace {
    vertices: [DVec3; 3],
    normal: Direction,
    sides: [Direction; 3],
}

impl TriangleFace {
    /// Prepares the triangle with these vertices.
    pub fn new(vertices: [DVec3; 3]) -> Self {
        let (normal, sides) = directions(&vertices);
        let side = |i: usize| Direction::new(sides(i), &vertices);
        Self { vertices, normal: Direction::new(normal, &vertices), sides: [side(0), side(1), side(2)] }
    }

    /// The view that the tests take.
    pub fn face(&self) -> Face<'_> {
        Face { vertices: &self.vertices, normal: self.normal, sides: &self.sides }
    }
}

/// A convex polygon, prepared for [`point_polygon`](super::point_polygon).
///
/// What is tested is the convex hull of the vertices: a polygon that is not quite flat or not quite convex is replaced
/// by its hull, never by something smaller.
///
/// ```
/// use d2m_paper::PolygonFace;
/// use glam::DVec3;
/// let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
/// assert_eq!(PolygonFace::try_new(&square).expect("four vertices").face().sides.len(), 4);
/// assert!(PolygonFace::try_new(&square[..2]).is_none());
/// ```
#[derive(Clone, Debug)]
pub struct PolygonFace {
    vertices: Vec<DVec3>,
    normal: Direction,
    sides: Vec<Direction>,
}

impl PolygonFace {
    /// Prepares the polygon with these vertices, in order around it; `None` for fewer than three.
    pub fn try_new(vertices: &[DVec3]) -> Option<Self> {
        if vertices.len() < 3 {
            return None;
        }
        let (normal, sides) = directions(vertices);
        let sides = (0..vertices.len()).map(|i| Direction::new(sides(i), vertices)).collect();
        Some(Self { vertices: vertices.to_vec(), normal: Direction::new(normal, vertices), sides })
    }

    /// The view that the tests take.
    pub fn face(&self) -> Face<'_> {
        Face { vertices: &self.vertices, normal: self.normal, sides: &self.sides }
    }
}

/// A convex, nearly flat feature of the observer, at rest in its frame.
///
/// ```
/// use d2m_paper::{PolygonFace, TriangleFace};
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let (triangle, polygon) = (TriangleFace::new(corners), PolygonFace::try_new(&corners).expect("three vertices"));
/// // The tests take both as this view.
/// assert_eq!(triangle.face().vertices, polygon.face().vertices);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Face<'a> {
    /// The vertices, in order.
    pub vertices: &'a [DVec3],
    /// About the unit normal.
    pub normal: Direction,
    /// About the unit in-plane normals of the sides.
    pub sides: &'a [Direction],
}

/// Area of a polygon, as a part of its squared size, below which its normal is taken across its longest edge instead: far below
/// rounding (2⁻⁵³), and any direction is sound.
const FLAT: f64 = 1e-30;

/// The normal of a polygon and, by index, the in-plane normals of its sides; substitutes where it has collapsed.
fn directions(vertices: &[DVec3]) -> (DVec3, impl Fn(usize) -> DVec3 + '_) {
    let n = vertices.len();
    let edge = move |i: usize| vertices[(i + 1) % n] - vertices[i];
    let area = (1..n - 1)
        .map(|i| (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]))
        .fold(DVec3::ZERO, |sum, a| sum + a);
    let longest = (0..n).map(edge).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let longest = longest.and_then(unit);
    // A sliver's area vector is poor along its longest edge: take that component out.
    let straight = |v: DVec3| longest.map_or(v, |l| v - l * v.dot(l));
    let normal = unit(area).map(straight).and_then(unit).filter(|u| {
        let size = vertices.iter().fold(0.0f64, |m, c| m.max((*c - vertices[0]).abs().max_element()));
        u.is_finite() && area.abs().max_element() > FLAT * size * size
    });
    let (n_hat, flat) = match (normal, longest) {
        (Some(u), _) => (u, true),
        (None, Some(l)) => (across(l), false),
        (None, None) => (DVec3::X, false),
    };
    let side = move |i: usize| {
        let own = if flat { unit(n_hat.cross(edge(i))) } else { None };
        own.unwrap_or_else(|| match (longest, i % 3) {
            (Some(l), 0) => l,
            (Some(l), _) => unit(n_hat.cross(l)).unwrap_or(DVec3::Y),
            (None, 0) => DVec3::X,
            (None, 1) => DVec3::Y,
            (None, _) => DVec3::Z,
        })
    };
    (n_hat, side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collapsed_triangles_have_finite_directions() {
        let p = DVec3::new(1.0, 2.0, 3.0);
        for vertices in [
            [p, p, p],
            [p, p, p + DVec3::X],
            [p, p + DVec3::X, p + 2.0 * DVec3::X],
            [DVec3::ZERO, DVec3::X * 1e-300, DVec3::Y * 1e-300],
            [DVec3::ZERO, DVec3::X * 1e50, DVec3::Y * 1e50],
        ] {
            let t = TriangleFace::new(vertices);
            for d in t.sides.iter().chain([&t.normal]) {
                assert!(d.vector.is_finite() && (d.vector.length() - 1.0).abs() < 1e-9, "{vertices:?}");
                for c in vertices {
                    assert!(!d.certainly_apart(d2m_interval::IntervalVec3::point(c).dot_point(d.vector)));
                }
            }
        }
        assert!(PolygonFace::try_new(&[p, p]).is_none());
    }
}
