//! A screw and a nut whose threads fit each other.
//!
//! Both threads are one helical surface r = ρ(z/pitch − θ/2π), the nut's a little wider. The mesh has n columns around
//! and n rows per pitch, so that moving one column on and one row up keeps the phase z/pitch − θ/2π: the diagonals of all
//! quads run along the helix, the profile's bends (at multiples of 1/4) fall on vertices, and the mesh is carried into
//! itself by one n-th of a turn of the screw motion. What remains is that chords of a helix lie inside it by the factor
//! cos(π/n), and two effects of higher order on the flanks, for which the nut is widened too (with h = π/n and Δ the step
//! in radius from row to row):
//! - the angle of a chord's point is not linear in its height, by at most arctan(x tan h) − x h ≤ 0.13 h³;
//! - a chord between radii r and r + Δ has the harmonic mean in its middle, Δ²/(4r) below the arithmetic one, at a phase
//!   that is off by as much again.
//!
//! Each counts for both threads. So the play is nowhere below the requested one (measured radially; across the flanks it is
//! 0.64 of it). Where vertices face vertices, a coarse pair has up to 1/cos(π/n) − 1 of the radius more.

use crate::grid::{sphere_grid, torus_grid};
use crate::surface::Surface;
use crate::trigonometry::{cos_sin, on_circle};
use glam::DVec3;
use std::f64::consts::PI;

/// Radius of the thread's root.
const ROOT: f64 = 0.30;
/// Radius of the thread's crest.
const CREST: f64 = 0.36;
/// Rise of the thread's flanks in radius per radian of phase: from root to crest in a quarter of a turn.
const FLANK_SLOPE: f64 = (CREST - ROOT) / (0.5 * PI);
/// Climb per turn.
const PITCH: f64 = 0.2;
const HEAD_RADIUS: f64 = 0.6;
const HEAD_HEIGHT: f64 = 0.25;
const NUT_TURNS: usize = 2;
const NUT_RADIUS: f64 = 0.65;

/// Trapezoid: root for a quarter, up, crest for a quarter, down. `step` of `steps` is the phase in one pitch.
fn profile(step: i64, steps: usize) -> f64 {
    let phase = step.rem_euclid(steps as i64) as f64 / steps as f64;
    let height = (4.0 * phase - 1.0).clamp(0.0, 1.0) - (4.0 * phase - 3.0).clamp(0.0, 1.0);
    ROOT + (CREST - ROOT) * height
}

/// The multiple of `unit` (at least one) for which `triangles_of` comes closest to `wanted`.
fn fit_columns(wanted: usize, unit: usize, triangles_of: impl Fn(usize) -> usize) -> usize {
    let mut columns = unit;
    while triangles_of(columns + unit) <= wanted {
        columns += unit;
    }
    let next = columns + unit;
    if triangles_of(next) - wanted < wanted.saturating_sub(triangles_of(columns)) { next } else { columns }
}

/// A screw along z, its thread of so many turns centered at the origin, with a round head below.
pub(crate) fn screw(triangles: usize, turns: usize) -> Surface {
    let columns = fit_columns(triangles, 4, |columns| 2 * columns * (turns * columns + 3));
    let rows = turns * columns;
    let bottom = -0.5 * PITCH * turns as f64;
    let height = |row: usize| bottom + PITCH * row as f64 / columns as f64;
    // Rings: head's bottom, head's top, then the thread from its foot (in the plane of the head's top) upwards.
    let poles = [DVec3::Z * (bottom - HEAD_HEIGHT), DVec3::Z * height(rows)];
    sphere_grid(rows + 3, columns, poles, |ring, column| {
        let (radius, z) = match ring {
            0 => (HEAD_RADIUS, bottom - HEAD_HEIGHT),
            1 => (HEAD_RADIUS, bottom),
            _ => (profile(ring as i64 - 2 - column as i64, columns), height(ring - 2)),
        };
        (on_circle(column, columns) * radius).extend(z)
    })
    .outward()
}

/// A hexagonal nut about the middle of the thread of a screw of so many turns, in its place at the start: both at the
/// origin, unturned.
pub(crate) fn nut(triangles: usize, clearance: f64, turns: usize) -> Surface {
    // Inside rows, outside rows, and the two flat rings.
    let outside = |columns: usize| (NUT_TURNS * columns).div_ceil(3);
    let rows_of = |columns: usize| NUT_TURNS * columns + 1 + outside(columns) + 1;
    let columns = fit_columns(triangles, 12, |columns| 2 * columns * rows_of(columns));
    let (inside, outside) = (NUT_TURNS * columns, outside(columns));
    let half_height = 0.5 * PITCH * NUT_TURNS as f64;
    let widen = 1.0 / cos_sin(PI / columns as f64).x;
    let half_step = PI / columns as f64;
    let rise = FLANK_SLOPE * 2.0 * half_step;
    let play = clearance
        + 2.0 * (0.13 * half_step * half_step * half_step * FLANK_SLOPE + rise * rise / (2.0 * ROOT));
    // Rows per pitch equal columns, and the screw's thread starts so many rows lower: phases agree.
    let start = (turns - NUT_TURNS) * columns / 2;
    let hexagon = |column: usize| {
        let side = columns / 6;
        let (corner, share) = (column / side, (column % side) as f64 / side as f64);
        let (from, to) = (on_circle(corner, 6), on_circle(corner + 1, 6));
        (from + (to - from) * share) * NUT_RADIUS
    };
    torus_grid(inside + outside + 2, columns, |row, column| {
        if row <= inside {
            let z = PITCH * row as f64 / columns as f64 - half_height;
            let radius = (profile((start + row) as i64 - column as i64, columns) + play) * widen;
            (on_circle(column, columns) * radius).extend(z)
        } else {
            let share = (row - inside - 1) as f64 / outside as f64;
            hexagon(column).extend(half_height * (1.0 - 2.0 * share))
        }
    })
    .outward()
}

/// The factor that brings the farthest vertex of a screw of so many turns to distance 1; the nut uses the same one.
pub(crate) fn common_scale(turns: usize) -> f64 {
    let bottom = 0.5 * PITCH * turns as f64 + HEAD_HEIGHT;
    1.0 / (bottom * bottom + HEAD_RADIUS * HEAD_RADIUS).sqrt()
}
