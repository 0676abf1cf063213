//! Bodies with exact coordinates.

use d2m_bvh::TriMesh;
use glam::{DVec3, dvec3};

/// The faces of a box by the bits of its corners (x: 1, y: 2, z: 4), outward.
const SIDES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

fn add_box(vertices: &mut Vec<DVec3>, triangles: &mut Vec<[u32; 3]>, lo: DVec3, hi: DVec3, inward: bool) {
    let first = vertices.len();
    vertices.extend((0..8).map(|i| {
        let pick = |bit: usize, l: f64, h: f64| if i & bit == 0 { l } else { h };
        dvec3(pick(1, lo.x, hi.x), pick(2, lo.y, hi.y), pick(4, lo.z, hi.z))
    }));
    for [a, b, c, d] in SIDES.map(|s| s.map(|k| (first + k) as u32)) {
        let faces = [[a, b, c], [a, c, d]];
        triangles.extend(faces.map(|[p, q, r]| if inward { [p, r, q] } else { [p, q, r] }));
    }
}

/// An axis-aligned box.
pub(crate) fn plank(lo: DVec3, hi: DVec3) -> TriMesh {
    let (mut v, mut t) = (vec![], vec![]);
    add_box(&mut v, &mut t, lo, hi, false);
    TriMesh::try_new(v, t).unwrap()
}

/// The cube from `corner` with this side.
pub(crate) fn cube(corner: DVec3, side: f64) -> TriMesh {
    plank(corner, corner + DVec3::splat(side))
}

/// A cube of half side `outer` with a cubic cavity of half side `inner`.
pub(crate) fn hollow_cube(outer: f64, inner: f64) -> TriMesh {
    let (mut v, mut t) = (vec![], vec![]);
    add_box(&mut v, &mut t, DVec3::splat(-outer), DVec3::splat(outer), false);
    add_box(&mut v, &mut t, DVec3::splat(-inner), DVec3::splat(inner), true);
    TriMesh::try_new(v, t).unwrap()
}

/// Two unit cubes, the second at `offset`.
pub(crate) fn two_cubes(offset: DVec3) -> TriMesh {
    let (mut v, mut t) = (vec![], vec![]);
    add_box(&mut v, &mut t, DVec3::ZERO, DVec3::ONE, false);
    add_box(&mut v, &mut t, offset, offset + DVec3::ONE, false);
    TriMesh::try_new(v, t).unwrap()
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
    let v: Vec<DVec3> = triangles.iter().flatten().copied().collect();
    let t = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriMesh::try_new(v, t).unwrap()
}
