//! Round bodies as meshes that enclose them or lie within them, and by how much.

use d2m_interval::Interval;
use d2m_mesh::{MeshError, TriMesh};
use glam::{DVec2, DVec3};

/// How much corners are moved outward or inward beyond what the sides ask for: 2⁻⁴⁰, where sine, cosine and products round by a few
/// 2⁻⁵² each.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// Which of the two holds the other.
///
/// ```
/// use d2m_shapes::{Fit, Tessellation};
/// let [around, within] = [Fit::Enclosing, Fit::Inscribed].map(|fit| Tessellation::of_cylinder(1.0, 2.0, 96, fit));
/// let (around, within) = (around?, within?);
/// assert!(around.error < 6e-4 && within.error < 6e-4 && around.mesh.triangle_count() == within.mesh.triangle_count());
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// The mesh holds the body: what it proves apart is apart.
    Enclosing,
    /// The body holds the mesh: what touches it touches the body.
    Inscribed,
}

/// A closed mesh in place of a round body, and how far it is from it.
///
/// ```
/// use d2m_shapes::{Fit, Tessellation};
/// use glam::DVec3;
/// let cone = Tessellation::of_cone(0.5, 2.0, 64, Fit::Enclosing)?; // its tip at z = 1, its base at z = -1
/// assert!(cone.mesh.vertices().contains(&DVec3::Z) && cone.error < 0.5 * 1.3e-3);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Tessellation {
    /// Closed, outward oriented.
    pub mesh: TriMesh,
    /// Bound of the distance of any point of the greater of the two, mesh and body, from the lesser one.
    pub error: f64,
}

impl Tessellation {
    /// A prism of so many sides, at least three, for a cylinder about z whose middle is the origin. Its ends are those of the cylinder.
    ///
    /// # Errors
    /// A radius or length that is not finite.
    pub fn of_cylinder(radius: f64, length: f64, sides: usize, fit: Fit) -> Result<Self, MeshError> {
        let Ring { corners, error } = Ring::new(radius, sides, fit);
        let (half, sides) = (0.5 * length, corners.len() as u32);
        let ends = corners.iter().flat_map(|corner| [corner.extend(-half), corner.extend(half)]);
        let mut vertices: Vec<DVec3> = ends.collect();
        let [bottom, top] = [2 * sides, 2 * sides + 1];
        vertices.extend([DVec3::Z * -half, DVec3::Z * half]);
        let mut triangles = Vec::with_capacity(4 * corners.len());
        for k in 0..sides {
            let next = (k + 1) % sides;
            let [a, b, c, d] = [2 * k, 2 * next, 2 * next + 1, 2 * k + 1];
            triangles.extend([[a, b, c], [a, c, d], [bottom, b, a], [top, d, c]]);
        }
        Ok(Self { mesh: TriMesh::try_new(vertices, triangles)?, error })
    }

    /// A pyramid of so many sides, at least three, for a cone about z with its tip at `height`/2 and its base at −`height`/2. Sections at
    /// one height are polygons about (or in) circles in the ratio of those of the base, so tip and base are those of the cone.
    ///
    /// # Errors
    /// A radius or height that is not finite.
    pub fn of_cone(radius: f64, height: f64, sides: usize, fit: Fit) -> Result<Self, MeshError> {
        let Ring { corners, error } = Ring::new(radius, sides, fit);
        let (half, sides) = (0.5 * height, corners.len() as u32);
        let mut vertices: Vec<DVec3> = corners.iter().map(|corner| corner.extend(-half)).collect();
        let [base, tip] = [sides, sides + 1];
        vertices.extend([DVec3::Z * -half, DVec3::Z * half]);
        let sides = (0..sides).map(|k| [k, (k + 1) % sides]);
        let triangles = sides.flat_map(|[a, b]| [[a, b, tip], [base, b, a]]).collect();
        Ok(Self { mesh: TriMesh::try_new(vertices, triangles)?, error })
    }

    /// A box for the half-space z ≤ 0: within `reach` of the origin they are the same, and beyond the box is in the half-space.
    ///
    /// ```
    /// let floor = d2m_shapes::Tessellation::of_half_space(100.0)?;
    /// assert!(floor.error == 0.0 && floor.mesh.vertices().iter().all(|p| p.z <= 0.0));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// A reach that is not finite.
    pub fn of_half_space(reach: f64) -> Result<Self, MeshError> {
        let corner = |k: usize| {
            let side = |bit: usize| if k & bit == 0 { -reach } else { reach };
            DVec3::new(side(1), side(2), if k & 4 == 0 { -reach } else { 0.0 })
        };
        let vertices = (0..8).map(corner).collect();
        let quads: [[u32; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Ok(Self { mesh: TriMesh::try_new(vertices, triangles)?, error: 0.0 })
    }
}

/// The corners of a regular polygon about a circle, or in it.
struct Ring {
    corners: Vec<DVec2>,
    error: f64,
}

impl Ring {
    /// That every side is at least a radius away from the center, or every corner at most that, is proven by intervals in the test of this
    /// module, for circles of any radius: the corners are scaled by one product each.
    fn new(radius: f64, sides: usize, fit: Fit) -> Self {
        let sides = sides.max(3);
        let (_, cos) = (Interval::PI / Interval::point(sides as f64)).sin_cos();
        // Where the corners are, in radii, and how far from the circle the corners or the middles of the sides are.
        let (reach, off) = match fit {
            Fit::Enclosing => {
                let reach = (1.0 + ROUNDING) / cos.lo();
                (reach, reach - 1.0)
            }
            Fit::Inscribed => (1.0 - ROUNDING, 1.0 - cos.lo() * (1.0 - ROUNDING)),
        };
        let corner = |k: usize| direction(k, sides) * (radius * reach);
        Self {
            corners: (0..sides).map(corner).collect(),
            error: radius * (off + ROUNDING) * (1.0 + ROUNDING),
        }
    }
}

/// The direction of a corner, rounded.
fn direction(k: usize, sides: usize) -> DVec2 {
    let angle = Interval::PI * Interval::point(2.0 * k as f64) / Interval::point(sides as f64);
    let (sin, cos) = angle.sin_cos();
    DVec2::new(cos.mid(), sin.mid())
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_mesh::MeshTree;

    /// Above zero: the triangles face outward.
    fn six_volumes(mesh: &TriMesh) -> f64 {
        (0..mesh.triangle_count()).map(|k| mesh.corners(k)).map(|[p, q, r]| p.cross(q).dot(r)).sum()
    }

    /// Sides are proven to be outside of the circle, or corners inside; and none is further from it than the error says.
    #[test]
    fn what_holds_what_is_proven_and_by_how_much() {
        let point = Interval::point;
        for (radius, sides) in
            [(1.0, 96), (0.05, 3), (1e-6, 4), (3e7, 17), (0.123_456_789, 1000), (2.0, 0), (1.0, 64)]
        {
            for fit in [Fit::Enclosing, Fit::Inscribed] {
                let prism = Tessellation::of_cylinder(radius, 0.3, sides, fit).unwrap();
                let cone = Tessellation::of_cone(radius, 0.3, sides, fit).unwrap();
                let count = sides.max(3);
                let ring = |mesh: &TriMesh, step: usize| -> Vec<DVec3> {
                    (0..count).map(|k| mesh.vertices()[step * k]).collect()
                };
                let base = ring(&prism.mesh, 2);
                assert_eq!(base, ring(&cone.mesh, 1));
                for k in 0..count {
                    let [p, q] = [base[k], base[(k + 1) % count]];
                    // Twice the area of the triangle with the axis, over the side: the distance of the side's line.
                    let area = point(p.x) * point(q.y) - point(p.y) * point(q.x);
                    let side = ((point(q.x) - point(p.x)).sqr() + (point(q.y) - point(p.y)).sqr()).sqrt();
                    let (nearest, corner) = (area / side, (point(p.x).sqr() + point(p.y).sqr()).sqrt());
                    let least = match fit {
                        Fit::Enclosing => nearest.lo() >= radius && corner.hi() <= radius + prism.error,
                        Fit::Inscribed => corner.hi() <= radius && nearest.lo() >= radius - prism.error,
                    };
                    assert!(least, "{radius} {sides} {fit:?} {k}: {nearest:?} {corner:?} {}", prism.error);
                    assert_eq!((p.z, prism.mesh.vertices()[2 * k + 1].z), (-0.15, 0.15));
                }
                // 1/cos(π/n) − 1 and 1 − cos(π/n), to rounding.
                let cos = (core::f64::consts::PI / count as f64).cos();
                let expected = if fit == Fit::Enclosing { 1.0 / cos - 1.0 } else { 1.0 - cos };
                assert!((prism.error / radius - expected).abs() < 1e-10 && cone.error == prism.error);
                for mesh in [prism.mesh, cone.mesh] {
                    assert!(d2m_mesh::Topology::new(&mesh).is_watertight(), "{radius} {sides}");
                    assert!(six_volumes(&mesh) > 0.0, "{radius} {sides}");
                }
            }
        }
        assert!(Tessellation::of_cone(f64::NAN, 1.0, 9, Fit::Enclosing).is_err());
        assert!(Tessellation::of_cylinder(1.0, f64::INFINITY, 9, Fit::Inscribed).is_err());
        assert!(MeshTree::new(Tessellation::of_half_space(5.0).unwrap().mesh).is_watertight());
        let floor = Tessellation::of_half_space(5.0).unwrap().mesh;
        assert!((six_volumes(&floor) - 6.0 * 500.0).abs() < 1e-9);
    }
}
