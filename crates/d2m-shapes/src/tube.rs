//! Tubes about closed curves: torus, torus knot, chain link.

use crate::grid::torus_grid;
use crate::surface::Surface;
use crate::trigonometry::{cos_sin, on_circle};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A point of the center line with two unit vectors across it.
struct Station {
    center: DVec3,
    normal: DVec3,
    binormal: DVec3,
}

fn tube(stations: &[Station], around: usize, radius: f64) -> Surface {
    torus_grid(stations.len(), around, |row, column| {
        let Station { center, normal, binormal } = stations[row];
        let side = on_circle(column, around);
        center + (normal * side.x + binormal * side.y) * radius
    })
    .outward()
}

/// (stations, vertices around) for about square quads, 2·stations·around ≈ `triangles`.
fn divide(triangles: usize, length: f64, girth: f64) -> (usize, usize) {
    let quads = triangles as f64 / 2.0;
    let around = ((quads * girth / length).sqrt().round() as usize).max(3);
    ((((quads / around as f64).round()) as usize).max(3), around)
}

/// Tube radius `tube` about a circle of radius 1 − `tube`, axis z.
pub(crate) fn torus(triangles: usize, tube_radius: f64) -> Surface {
    let radius = 1.0 - tube_radius;
    let (count, around) = divide(triangles, radius, tube_radius);
    let stations: Vec<Station> = (0..count)
        .map(|station| {
            let normal = on_circle(station, count).extend(0.0);
            Station { center: normal * radius, normal, binormal: DVec3::Z }
        })
        .collect();
    tube(&stations, around, tube_radius)
}

/// A (p, q) curve on the torus of radii 2 and 1: p turns about the axis while q turns about the tube.
pub(crate) fn torus_knot(triangles: usize, [p, q]: [f64; 2], tube_radius: f64) -> Surface {
    let length = TAU * (4.0 * p * p + q * q).sqrt();
    let (count, around) = divide(triangles, length, TAU * tube_radius);
    let stations: Vec<Station> = (0..count)
        .map(|station| {
            let t = station as f64 / count as f64;
            let turn = |times: f64| {
                let whole = t * times;
                cos_sin(TAU * (whole - whole.floor()))
            };
            let (about_axis, about_tube) = (turn(p), turn(q));
            let outward = about_axis.extend(0.0);
            let sideways = about_axis.perp().extend(0.0);
            let distance = 2.0 + about_tube.x;
            // The surface normal of the torus is at right angles to the curve: a frame that closes without twist.
            let normal = outward * about_tube.x + DVec3::Z * about_tube.y;
            let tangent = sideways * (p * distance) + (DVec3::Z * about_tube.x - outward * about_tube.y) * q;
            let center = outward * distance + DVec3::Z * about_tube.y;
            Station { center, normal, binormal: (tangent / tangent.length()).cross(normal) }
        })
        .collect();
    tube(&stations, around, tube_radius).normalized()
}

/// A tube about a stadium: half circles of radius 1 joined by straight pieces of length `straight`, in the xy plane.
pub(crate) fn chain_link(triangles: usize, straight: f64, tube_radius: f64) -> Surface {
    let (count, around) = divide(triangles, TAU + 2.0 * straight, TAU * tube_radius);
    // The four pieces get vertices in proportion to their lengths.
    let half = (count / 2).max(3);
    let on_straight = ((half as f64 * straight / (PI + straight)).round() as usize).clamp(1, half - 2);
    let on_arc = half - on_straight;
    let mut stations = Vec::with_capacity(2 * half);
    for (sign, first) in [(1.0, 0.0), (-1.0, PI)] {
        for step in 0..on_arc {
            let direction = cos_sin(first + PI * step as f64 / on_arc as f64).extend(0.0);
            let center = direction + DVec3::Y * (sign * straight * 0.5);
            stations.push(Station { center, normal: direction, binormal: DVec3::Z });
        }
        for step in 0..on_straight {
            let along = straight * (0.5 - step as f64 / on_straight as f64);
            let direction = DVec3::X * -sign;
            let center = direction + DVec3::Y * (sign * along);
            stations.push(Station { center, normal: direction, binormal: DVec3::Z });
        }
    }
    tube(&stations, around, tube_radius).normalized()
}
