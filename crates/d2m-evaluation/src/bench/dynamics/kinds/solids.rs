//! Meshes that the shapes of the library do not have: prisms over polygons, and rings.
use super::super::scene::{Error, tree};
use d2m::TriMesh;
use d2m::bvh::MeshTree;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A box with these half sizes.
pub(super) fn cuboid(half: DVec3) -> Result<Arc<MeshTree>, Error> {
    tree(&format!("box?x={:?}&y={:?}&z={:?}", half.x, half.y, half.z))
}

/// A prism along z between ±`half`, over a convex polygon that is given counter-clockwise.
pub(super) fn prism(corners: &[DVec2], half: f64) -> Result<Arc<MeshTree>, Error> {
    let count = corners.len() as u32;
    let vertices = [-half, half].into_iter().flat_map(|z| corners.iter().map(move |c| c.extend(z)));
    let mut triangles = Vec::new();
    for i in 1..count - 1 {
        triangles.extend([[0, i + 1, i], [count, count + i, count + i + 1]]);
    }
    for i in 0..count {
        let j = (i + 1) % count;
        triangles.extend([[i, j, j + count], [i, j + count, i + count]]);
    }
    Ok(Arc::new(MeshTree::new(TriMesh::try_new(vertices.collect(), triangles)?)))
}

/// A regular polygon whose corners lie on a circle.
pub(super) fn regular(sides: u32, radius: f64) -> Vec<DVec2> {
    (0..sides).map(|k| DVec2::from_angle(TAU * f64::from(k) / f64::from(sides)) * radius).collect()
}

/// A ring about z between ±`half`, of two regular polygons whose corners lie on these circles.
pub(super) fn ring(sides: u32, [inner, outer]: [f64; 2], half: f64) -> Result<Arc<MeshTree>, Error> {
    let mut vertices: Vec<DVec3> = Vec::new();
    for (radius, z) in [(outer, -half), (outer, half), (inner, -half), (inner, half)] {
        vertices.extend(regular(sides, radius).into_iter().map(|corner| corner.extend(z)));
    }
    let mut triangles = Vec::new();
    for i in 0..sides {
        let j = (i + 1) % sides;
        let [low, high, inside, above] = [0, sides, 2 * sides, 3 * sides];
        let mut face = |[a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
        face([low + i, low + j, high + j, high + i]);
        face([inside + j, inside + i, above + i, above + j]);
        face([high + i, high + j, above + j, above + i]);
        face([low + j, low + i, inside + i, inside + j]);
    }
    Ok(Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles)?)))
}

/// A globe about z of so many meridians and half as many parallels, all corners on a sphere of the first radius; hollow from the second radius
/// on inward, unless that is zero.
pub(super) fn globe(meridians: u32, [outer, inner]: [f64; 2]) -> Result<Arc<MeshTree>, Error> {
    let parallels = meridians / 2;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for radius in [outer, inner].into_iter().filter(|&radius| radius > 0.0) {
        let first = vertices.len() as u32;
        vertices.push(DVec3::Z * radius);
        for k in 1..parallels {
            let (sine, cosine) = (PI * f64::from(k) / f64::from(parallels)).sin_cos();
            vertices.extend(regular(meridians, radius * sine).into_iter().map(|p| p.extend(radius * cosine)));
        }
        let last = vertices.len() as u32;
        vertices.push(DVec3::NEG_Z * radius);
        let at = |parallel: u32, meridian: u32| first + 1 + (parallel - 1) * meridians + meridian % meridians;
        for i in 0..meridians {
            let mut faces =
                vec![[first, at(1, i), at(1, i + 1)], [last, at(parallels - 1, i + 1), at(parallels - 1, i)]];
            for k in 1..parallels - 1 {
                faces.push([at(k, i), at(k + 1, i), at(k + 1, i + 1)]);
                faces.push([at(k, i), at(k + 1, i + 1), at(k, i + 1)]);
            }
            triangles.extend(
                faces.into_iter().map(|[a, b, c]| if radius == outer { [a, b, c] } else { [a, c, b] }),
            );
        }
    }
    Ok(Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::bvh::Topology;

    /// Closed, turned outward, and of the volume of their sections.
    #[test]
    fn solids_are_closed_and_turned_outward() {
        let triangle = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let area = |radius: f64| 0.5 * 12.0 * (TAU / 12.0).sin() * radius * radius;
        for (solid, volume) in [
            (prism(&triangle, 1.0).unwrap(), 1.0),
            (ring(12, [0.5, 1.0], 0.25).unwrap(), 0.5 * (area(1.0) - area(0.5))),
            // Two pyramids of four sides on each other, less a smaller one.
            (globe(4, [1.0, 0.5]).unwrap(), 4.0 / 3.0 * (1.0 - 0.125)),
        ] {
            assert!(Topology::new(solid.mesh()).is_watertight());
            let six = |k: usize| {
                let [a, b, c] = solid.mesh().corners(k);
                a.dot(b.cross(c))
            };
            let found = (0..solid.mesh().triangle_count()).map(six).sum::<f64>() / 6.0;
            assert!((found - volume).abs() < 1e-12, "{found} {volume}");
        }
    }
}
