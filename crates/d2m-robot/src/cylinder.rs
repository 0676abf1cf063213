//! A cylinder as a prism that encloses it.

use d2m_bvh::{MeshError, TriMesh};
use d2m_interval::Interval;
use glam::{DVec2, DVec3};

/// Sides of the prism: it reaches 1/cos(π/96) − 1 = 0.054 % of the radius beyond the cylinder.
const SIDES: usize = 96;
/// How much the corners are moved outward beyond that: 2⁻⁴⁰, where sine, cosine and products round by a few 2⁻⁵² each.
const OUTWARD: f64 = 1.0 + 4096.0 * f64::EPSILON;

/// A prism about z that encloses a cylinder, and how far it reaches beyond it.
#[derive(Debug)]
pub(crate) struct Prism {
    pub(crate) mesh: TriMesh,
    /// Bound of the distance of its points from the cylinder.
    pub(crate) excess: f64,
}

impl Prism {
    /// Its ends are those of the cylinder. That every side is at least a radius away from the axis is proven by
    /// intervals in the test of this module, for sides of a circle of any radius: they are scaled by one product each.
    pub(crate) fn around(radius: f64, length: f64) -> Result<Self, MeshError> {
        let reach = reach();
        let corner = |k: usize| direction(k) * (radius * reach);
        let half = 0.5 * length;
        let corners = (0..SIDES).flat_map(|k| [corner(k).extend(-half), corner(k).extend(half)]);
        let mut vertices: Vec<DVec3> = corners.collect();
        let [bottom, top] = [vertices.len() as u32, vertices.len() as u32 + 1];
        vertices.extend([DVec3::Z * -half, DVec3::Z * half]);
        let mut triangles = Vec::with_capacity(4 * SIDES);
        for k in 0..SIDES as u32 {
            let next = (k + 1) % SIDES as u32;
            let [a, b, c, d] = [2 * k, 2 * next, 2 * next + 1, 2 * k + 1];
            triangles.extend([[a, b, c], [a, c, d], [bottom, b, a], [top, d, c]]);
        }
        let excess = radius * (reach - 1.0) * OUTWARD;
        Ok(Self { mesh: TriMesh::try_new(vertices, triangles)?, excess })
    }
}

/// Where the corners are, in radii.
fn reach() -> f64 {
    let (_, cos) = (Interval::PI / Interval::point(SIDES as f64)).sin_cos();
    OUTWARD / cos.lo()
}

/// The direction of a corner, rounded.
fn direction(k: usize) -> DVec2 {
    let angle = Interval::PI * Interval::point(2.0 * k as f64) / Interval::point(SIDES as f64);
    let (sin, cos) = angle.sin_cos();
    DVec2::new(cos.mid(), sin.mid())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_prism_encloses_the_cylinder_by_as_much_as_it_says() {
        for radius in [1.0, 0.05, 1e-6, 3e7, 0.123_456_789] {
            let Prism { mesh, excess } = Prism::around(radius, 0.3).unwrap();
            let point = Interval::point;
            for k in 0..SIDES {
                let [p, q] = [mesh.vertices()[2 * k], mesh.vertices()[2 * ((k + 1) % SIDES)]];
                // Twice the area of the triangle with the axis, over the side: the distance of the side's line.
                let area = point(p.x) * point(q.y) - point(p.y) * point(q.x);
                let side = ((point(q.x) - point(p.x)).sqr() + (point(q.y) - point(p.y)).sqr()).sqrt();
                let distance = area / side;
                assert!(distance.lo() >= radius, "{radius} {k} {distance:?}");
                let corner = (point(p.x).sqr() + point(p.y).sqr()).sqrt();
                assert!(corner.hi() <= radius + excess * (1.0 + 1e-9) && excess < 5.4e-4 * radius);
                assert_eq!((p.z, mesh.vertices()[2 * k + 1].z), (-0.15, 0.15));
            }
            assert!(d2m_bvh::MeshTree::new(mesh).is_watertight());
        }
    }
}
