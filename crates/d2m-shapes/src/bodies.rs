//! Box, plate, hollow box, needle.

use crate::surface::Surface;
use crate::trigonometry::on_circle;
use glam::DVec3;
use std::collections::HashMap;

/// A box with half sizes `half`, each face cut into n² squares.
pub(crate) fn cuboid(triangles: usize, half: DVec3) -> Surface {
    let n = ((triangles as f64 / 12.0).sqrt().round() as usize).max(1);
    let mut surface = Surface::default();
    let mut known: HashMap<[usize; 3], u32> = HashMap::with_capacity(6 * n * n + 2);
    for axis in 0..3 {
        for end in [0, n] {
            let mut vertex = |i: usize, j: usize| {
                let mut key = [0; 3];
                (key[axis], key[(axis + 1) % 3], key[(axis + 2) % 3]) = (end, i, j);
                *known.entry(key).or_insert_with(|| {
                    let share = key.map(|k| (2 * k) as f64 / n as f64 - 1.0);
                    surface.vertices.push(DVec3::from_array(share) * half);
                    surface.vertices.len() as u32 - 1
                })
            };
            let mut quads = Vec::with_capacity(n * n);
            for i in 0..n {
                for j in 0..n {
                    quads.push([vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
            for [a, b, c, d] in quads {
                surface.quad(if end == n { [a, b, c, d] } else { [d, c, b, a] });
            }
        }
    }
    surface.outward()
}

/// The space between two concentric boxes; `wall` is its thickness.
pub(crate) fn hollow_box(triangles: usize, wall: f64) -> Surface {
    let half = DVec3::ONE;
    cuboid(triangles / 2, half).and(cuboid(triangles / 2, half * (1.0 - wall)).reversed()).normalized()
}

/// A double cone along z, 2 long and 2/`aspect` thick.
pub(crate) fn needle(triangles: usize, aspect: f64) -> Surface {
    let sides = (triangles / 2).max(3);
    let mut surface = Surface::default();
    let [tip, tail] = [DVec3::Z, -DVec3::Z].map(|pole| surface.vertex(pole));
    for side in 0..sides {
        surface.vertex((on_circle(side, sides) / aspect).extend(0.0));
    }
    for side in 0..sides {
        let (here, next) = (2 + side as u32, 2 + ((side + 1) % sides) as u32);
        surface.triangles.push([tip, here, next]);
        surface.triangles.push([tail, next, here]);
    }
    surface
}

/// The regular tetrahedron in the unit sphere.
pub(crate) fn tetrahedron() -> Surface {
    let signs = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    Surface {
        vertices: signs.map(|vertex| DVec3::from_array(vertex) / f64::sqrt(3.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    }
    .outward()
}
