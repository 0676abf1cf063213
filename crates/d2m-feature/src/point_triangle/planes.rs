//! A triangle as four directions with the interval that it covers along each.
use crate::path::direction;
use d2m_root::Band;
use glam::DVec3;

/// The face normal and three in-plane edge normals with their support over the vertices.
///
/// Any direction is sound: a contact of `q` with the triangle needs `d·q` inside the support, whatever `d` is. So
/// degenerate triangles and rounded normals need no special case; zero directions exclude nothing.
#[derive(Debug, Clone)]
pub(crate) struct TrianglePlanes {
    pub(crate) vertices: [DVec3; 3],
    pub(crate) normal: DVec3,
    pub(crate) sides: [DVec3; 3],
    /// Support of the normal.
    pub(crate) slab: (f64, f64),
    /// Support of the side normals.
    pub(crate) side_support: [(f64, f64); 3],
    /// A point inside all three sides below these values, and inside the slab, is on the triangle up to rounding;
    /// `None` if the triangle is too thin to say so.
    pub(crate) prism: Option<[f64; 3]>,
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
    /// Longest side.
    pub(crate) size: f64,
    /// Largest distance of a vertex from the origin.
    pub(crate) extent: f64,
}

impl TrianglePlanes {
    /// The values of the triangle along its normal.
    #[inline(always)]
    pub(crate) const fn slab(&self) -> Band {
        Band { lo: self.slab.0, hi: self.slab.1 }
    }

    pub(crate) fn new(vertices: [DVec3; 3]) -> Self {
        let [a, b, c] = vertices;
        let edges = [b - a, c - b, a - c];
        let squares = edges.map(DVec3::length_squared);
        let longest = (0..3).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
        let along = direction(edges[longest]);
        // Of the three products the one of the two shorter sides has the least error; make it orthogonal to the
        // longest side, which a sliver's rounding tilts most.
        let product = edges[(longest + 1) % 3].cross(edges[(longest + 2) % 3]);
        let raw = direction(product);
        let mut normal = direction(raw - along * raw.dot(along));
        if normal == DVec3::ZERO && along != DVec3::ZERO {
            normal = direction(along.any_orthogonal_vector());
        }
        let sides = edges.map(|edge| direction(direction(edge).cross(normal)));
        let support = |d: DVec3| {
            let values = vertices.map(|v| d.dot(v));
            (values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2]))
        };
        let size = squares[longest].sqrt();
        // Height over the longest side: the prism argument needs it far above rounding.
        let area = product.length();
        let extent = vertices.iter().map(|v| v.length()).fold(0.0, f64::max) * (1.0 + 1e-14);
        let prism = (area > 1e-5 * squares[longest] && size > 1e-7 * extent)
            .then(|| [0, 1, 2].map(|i| sides[i].dot(vertices[i]).min(sides[i].dot(vertices[(i + 1) % 3]))));
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        let centre = low + (high - low) * 0.5;
        let radius = vertices.iter().map(|v| (*v - centre).length()).fold(0.0, f64::max) * (1.0 + 1e-14);
        Self {
            vertices,
            normal,
            sides,
            slab: support(normal),
            side_support: sides.map(support),
            prism,
            centre,
            radius,
            size,
            extent,
        }
    }
}
