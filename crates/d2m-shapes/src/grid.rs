//! Surfaces that are wrapped grids, and the choice of a resolution.

use crate::surface::Surface;
use glam::DVec3;

/// A torus-like surface: `rows` × `columns` quads, both directions closed.
pub(crate) fn torus_grid(rows: usize, columns: usize, position: impl Fn(usize, usize) -> DVec3) -> Surface {
    let mut surface = Surface::default();
    for row in 0..rows {
        for column in 0..columns {
            surface.vertices.push(position(row, column));
        }
    }
    let number = |row: usize, column: usize| (row % rows * columns + column % columns) as u32;
    for row in 0..rows {
        for column in 0..columns {
            surface.quad([
                number(row, column),
                number(row, column + 1),
                number(row + 1, column + 1),
                number(row + 1, column),
            ]);
        }
    }
    surface
}

/// A sphere-like surface: `rows` rings of `columns` vertices between two poles.
pub(crate) fn sphere_grid(
    rows: usize,
    columns: usize,
    poles: [DVec3; 2],
    position: impl Fn(usize, usize) -> DVec3,
) -> Surface {
    let mut surface = Surface::default();
    for row in 0..rows {
        for column in 0..columns {
            surface.vertices.push(position(row, column));
        }
    }
    let number = |row: usize, column: usize| (row * columns + column % columns) as u32;
    let [first, last] = poles.map(|pole| surface.vertex(pole));
    for column in 0..columns {
        surface.triangles.push([first, number(0, column + 1), number(0, column)]);
        surface.triangles.push([last, number(rows - 1, column), number(rows - 1, column + 1)]);
        for row in 1..rows {
            surface.quad([
                number(row - 1, column),
                number(row - 1, column + 1),
                number(row, column + 1),
                number(row, column),
            ]);
        }
    }
    surface
}

/// A step length for which `count(step)` (not increasing in the step) comes closest to `wanted`.
pub(crate) fn fit_step(wanted: usize, count: impl Fn(f64) -> usize) -> f64 {
    let (mut fine, mut coarse) = (1e-5, 10.0);
    for _ in 0..60 {
        let middle = f64::sqrt(fine * coarse);
        if count(middle) > wanted {
            fine = middle;
        } else {
            coarse = middle;
        }
    }
    if count(fine).abs_diff(wanted) < count(coarse).abs_diff(wanted) { fine } else { coarse }
}

/// How many pieces of about `step` a length has; at least one.
pub(crate) fn pieces(length: f64, step: f64) -> usize {
    ((length / step).round() as usize).max(1)
}
