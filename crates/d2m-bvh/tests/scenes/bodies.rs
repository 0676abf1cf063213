//! Bodies with exact coordinates.

use d2m_bvh::TriMesh;
use d2m_testing::Surface;
use glam::{DVec3, dvec3};

/// An axis-aligned box.
pub(crate) fn plank(lo: DVec3, hi: DVec3) -> TriMesh {
    Surface::cuboid(lo, hi).into_mesh(TriMesh::try_new)
}

/// The cube from `corner` with this side.
pub(crate) fn cube(corner: DVec3, side: f64) -> TriMesh {
    plank(corner, corner + DVec3::splat(side))
}

/// A cube of half side `outer` with a cubic cavity of half side `inner`.
pub(crate) fn hollow_cube(outer: f64, inner: f64) -> TriMesh {
    Surface::cube(outer).with(&Surface::cube(inner).inverted()).into_mesh(TriMesh::try_new)
}

/// Two unit cubes, the second at `offset`.
pub(crate) fn two_cubes(offset: DVec3) -> TriMesh {
    let [first, second] = [DVec3::ZERO, offset].map(|corner| Surface::cuboid(corner, corner + DVec3::ONE));
    first.with(&second).into_mesh(TriMesh::try_new)
}

/// A square ring: outer half side 2, inner 1, half thickness 1/2, in the plane of x and y, or of x and z if `upright`.
pub(crate) fn frame(upright: bool) -> TriMesh {
    let corner = |s: f64, z: f64| [(s, s, z), (-s, s, z), (-s, -s, z), (s, -s, z)];
    let mut v: Vec<DVec3> = vec![];
    for (s, z) in [(2.0, -0.5), (1.0, -0.5), (1.0, 0.5), (2.0, 0.5)] {
        v.extend(corner(s, z).map(|(x, y, z)| if upright { dvec3(x, z, y) } else { dvec3(x, y, z) }));
    }
    let mut t = vec![];
    for k in 0..4u32 {
        let n = (k + 1) % 4;
        for ring in 0..4u32 {
            let next = (ring + 1) % 4;
            let (a, b, c, d) = (4 * ring + k, 4 * ring + n, 4 * next + n, 4 * next + k);
            let faces = [[a, c, b], [a, d, c]];
            t.extend(faces.map(|[p, q, r]| if upright { [p, r, q] } else { [p, q, r] }));
        }
    }
    TriMesh::try_new(v, t).unwrap()
}

/// Triangles as they are.
pub(crate) fn soup(triangles: &[[DVec3; 3]]) -> TriMesh {
    Surface::soup(triangles.iter().flatten().copied()).into_mesh(TriMesh::try_new)
}
