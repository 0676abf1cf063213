//! A triangle as four directions with the interval that it covers along each.
use crate::path::direction;
use crate::rounding::length_up;
use d2m_root::Band;
use glam::DVec3;

/// Height over the longest side, as a part of it, from which a triangle's prism is distinguished from rounding: side normals are
/// tilted by up to some 10·2⁻⁵³ of 1/height (docs/theory/features.md, "Existence"), 10⁻¹⁰ here.
const THICK: f64 = 1e-5;
/// Size of a triangle as a part of its distance from the origin from which the same is true of its vertices' rounding.
const NEAR: f64 = 1e-7;

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
    pub(crate) slab: Band,
    /// Support of the side normals.
    pub(crate) side_support: [Band; 3],
    /// A point inside all three sides below these values, and inside the slab, is on the triangle up to rounding;
    /// `None` if the triangle is too thin to say so.
    pub(crate) prism: Option<[f64; 3]>,
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Longest side.
    pub(crate) size: f64,
    /// Largest distance of a vertex from the origin.
    pub(crate) extent: f64,
}

impl TrianglePlanes {
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
            Band { lo: values[0].min(values[1]).min(values[2]), hi: values[0].max(values[1]).max(values[2]) }
        };
        let size = squares[longest].sqrt();
        // Height over the longest side: the prism argument needs it far above rounding.
        let area = product.length();
        let extent = vertices.iter().map(|&v| length_up(v)).fold(0.0, f64::max);
        let prism = (area > THICK * squares[longest] && size > NEAR * extent)
            .then(|| [0, 1, 2].map(|i| sides[i].dot(vertices[i]).min(sides[i].dot(vertices[(i + 1) % 3]))));
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        let center = low + (high - low) * 0.5;
        let radius = vertices.iter().map(|&v| length_up(v - center)).fold(0.0, f64::max);
        Self {
            vertices,
            normal,
            sides,
            slab: support(normal),
            side_support: sides.map(support),
            prism,
            center,
            radius,
            size,
            extent,
        }
    }
}
