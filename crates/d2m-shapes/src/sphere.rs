//! Icosphere, pebble, hollow sphere.

use crate::surface::Surface;
use crate::trigonometry::cos_sin;
use glam::DVec3;
use std::collections::HashMap;

const FACES: [[usize; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

fn icosahedron() -> [DVec3; 12] {
    let golden = 0.5 + 0.5 * f64::sqrt(5.0);
    let mut vertices = [DVec3::ZERO; 12];
    for (slot, vertex) in vertices.iter_mut().enumerate() {
        let first = if slot % 2 == 0 { -1.0 } else { 1.0 };
        let second = if slot % 4 < 2 { golden } else { -golden };
        *vertex = match slot / 4 {
            0 => DVec3::new(first, second, 0.0),
            1 => DVec3::new(0.0, first, second),
            _ => DVec3::new(second, 0.0, first),
        };
    }
    vertices
}

/// Each face of the icosahedron cut into n² triangles, pushed onto the unit sphere: 20 n² triangles.
pub(crate) fn icosphere(triangles: usize) -> Surface {
    let n = ((triangles as f64 / 20.0).sqrt().round() as usize).max(1);
    let coarse = icosahedron();
    let mut surface = Surface::default();
    // A lattice point is named by its weights that are not zero, in the order of the vertices, so faces share what lies on edges.
    let mut known: HashMap<[(usize, usize); 3], u32> = HashMap::with_capacity(10 * n * n + 2);
    for face in FACES {
        let mut vertex = |i: usize, j: usize| {
            let mut weights = [(face[0], n - i - j), (face[1], i), (face[2], j)];
            weights.sort_unstable();
            for weight in &mut weights {
                if weight.1 == 0 {
                    *weight = (usize::MAX, 0);
                }
            }
            weights.sort_unstable();
            *known.entry(weights).or_insert_with(|| {
                let used = weights.iter().filter(|weight| weight.1 > 0);
                let sum =
                    used.fold(DVec3::ZERO, |sum, &(vertex, weight)| sum + coarse[vertex] * weight as f64);
                surface.vertices.push(sum / sum.length());
                surface.vertices.len() as u32 - 1
            })
        };
        let mut cells = Vec::with_capacity(n * n);
        for i in 0..n {
            for j in 0..n - i {
                cells.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < n {
                    cells.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
        surface.triangles.extend(cells);
    }
    surface.outward()
}

/// A sphere whose radius varies smoothly with the direction: star-shaped, so it cannot overlap itself.
pub(crate) fn pebble(triangles: usize, seed: u64, roughness: f64) -> Surface {
    let mut state = seed;
    let mut random = || {
        // splitmix64 (G. Steele, D. Lea, C. Flood, 2014): 53 high bits as a number in [−1, 1).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = state;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ bits >> 31) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let waves: Vec<(DVec3, f64, f64)> = (0..12)
        .map(|number| {
            let frequency = 1.5 + 0.9 * f64::from(number);
            let direction = DVec3::new(random(), random(), random());
            let direction = direction / (direction.length() + 1e-3);
            (direction * frequency, random() * 3.2, 0.5 / frequency)
        })
        .collect();
    let stretch = DVec3::new(1.0, 0.85 + 0.1 * random(), 0.7 + 0.1 * random());
    let mut surface = icosphere(triangles);
    for vertex in &mut surface.vertices {
        let bump: f64 =
            waves.iter().map(|&(wave, phase, height)| height * cos_sin(wave.dot(*vertex) + phase).y).sum();
        *vertex *= (1.0 + roughness * bump).max(0.2) * stretch;
    }
    surface.normalized()
}

/// The space between two concentric spheres; `wall` is its thickness.
pub(crate) fn hollow_sphere(triangles: usize, wall: f64) -> Surface {
    icosphere(triangles / 2).and(icosphere(triangles / 2).scaled(1.0 - wall).reversed())
}
