//! Prisms over star-shaped outlines, with or without a round bore: cylinder, ring, gear, paddle wheel.

use crate::grid::{fit_step, pieces, sphere_grid, torus_grid};
use crate::surface::Surface;
use crate::trigonometry::on_circle;
use glam::{DVec2, DVec3};

/// A flat outline, counter-clockwise, whose vertices turn strictly about the origin.
pub(crate) struct Outline(pub(crate) Vec<DVec2>);

/// The extent of a prism along z and its hole.
#[derive(Clone, Copy)]
pub(crate) struct Prism {
    pub(crate) half_height: f64,
    /// Radius of the bore; 0 for none.
    pub(crate) bore: f64,
}

struct Divisions {
    outline: Vec<usize>,
    height: usize,
    radial: usize,
}

impl Divisions {
    fn new(outline: &Outline, prism: Prism, step: f64) -> Self {
        let sides = outline.sides().map(|(from, to)| pieces(from.distance(to), step)).collect();
        let mean = outline.0.iter().map(|corner| corner.length()).sum::<f64>() / outline.0.len() as f64;
        Self {
            outline: sides,
            height: pieces(2.0 * prism.half_height, step),
            radial: pieces(mean - prism.bore, step),
        }
    }

    fn triangles(&self, prism: Prism) -> usize {
        let around: usize = self.outline.iter().sum();
        let rings = 2 * (self.height + self.radial);
        if prism.bore > 0.0 { 2 * around * rings } else { 2 * around * (self.height + 2 * self.radial - 1) }
    }
}

impl Outline {
    /// A regular polygon with circumradius `radius`.
    pub(crate) fn circle(radius: f64, corners: usize) -> Self {
        Self((0..corners).map(|corner| on_circle(corner, corners) * radius).collect())
    }

    fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        self.0.iter().enumerate().map(|(index, &corner)| (corner, self.0[(index + 1) % self.0.len()]))
    }

    /// The prism over this outline with about `triangles` triangles.
    pub(crate) fn extrude(&self, prism: Prism, triangles: usize) -> Surface {
        let step = fit_step(triangles, |step| Divisions::new(self, prism, step).triangles(prism));
        let divisions = Divisions::new(self, prism, step);
        let mut rim = Vec::new();
        for ((from, to), &count) in self.sides().zip(&divisions.outline) {
            rim.extend((0..count).map(|piece| from + (to - from) * (piece as f64 / count as f64)));
        }
        let low = |(height, radial): (usize, usize)| {
            let z = prism.half_height * (2.0 * height as f64 / divisions.height as f64 - 1.0);
            (z, radial as f64 / divisions.radial as f64)
        };
        let place = |(z, share): (f64, f64), rim: DVec2| {
            let inner = if prism.bore > 0.0 { rim * (prism.bore / rim.length()) } else { DVec2::ZERO };
            // Exactly the rim at share 1, so that outer walls stay flat.
            let flat = if share == 1.0 { rim } else { inner + (rim - inner) * share };
            DVec3::new(flat.x, flat.y, z)
        };
        let (h, r) = (divisions.height, divisions.radial);
        // One meridian: bottom outwards, up the wall, top inwards, and down the bore.
        let mut meridian: Vec<(usize, usize)> = Vec::new();
        meridian.extend((0..r).map(|radial| (0, radial)));
        meridian.extend((0..h).map(|height| (height, r)));
        meridian.extend((0..r).map(|radial| (h, r - radial)));
        if prism.bore > 0.0 {
            meridian.extend((0..h).map(|height| (h - height, 0)));
            torus_grid(meridian.len(), rim.len(), |row, column| place(low(meridian[row]), rim[column]))
                .outward()
        } else {
            let poles = [DVec3::Z * -prism.half_height, DVec3::Z * prism.half_height];
            let rings = &meridian[1..];
            sphere_grid(rings.len(), rim.len(), poles, |row, column| place(low(rings[row]), rim[column]))
                .outward()
        }
    }
}

/// Trapezoid teeth on a disc.
pub(crate) fn gear(triangles: usize, teeth: usize, depth: f64, prism: Prism) -> Surface {
    let steps = 8 * teeth;
    let corners = (0..teeth).flat_map(|tooth| {
        // Eighths of a tooth: root at 0–2, flank, tip at 3–5, flank.
        [(0, 1.0 - depth), (2, 1.0 - depth), (3, 1.0), (5, 1.0), (6, 1.0 - depth)]
            .map(|(eighth, radius)| on_circle(8 * tooth + eighth, steps) * radius)
    });
    Outline(corners.collect()).extrude(prism, triangles).normalized()
}

/// Flat blades with parallel sides on a hub.
pub(crate) fn paddle_wheel(
    triangles: usize,
    blades: usize,
    hub: f64,
    half_width: f64,
    prism: Prism,
) -> Surface {
    let corners = (0..blades).flat_map(|blade| {
        let direction = on_circle(2 * blade, 2 * blades);
        let foot = (hub * hub - half_width * half_width).sqrt();
        let local = |along: f64, across: f64| direction * along + direction.perp() * across;
        [
            local(foot, -half_width),
            local(1.0, -half_width),
            local(1.0, half_width),
            local(foot, half_width),
            on_circle(2 * blade + 1, 2 * blades) * hub,
        ]
    });
    Outline(corners.collect()).extrude(prism, triangles).normalized()
}

/// The number of sides of a cylinder of radius `radius` for which square pieces give about `triangles`.
fn round_sides(triangles: usize, radius: f64, prism: Prism) -> usize {
    let girth = 2.0 * std::f64::consts::PI * radius;
    let step = fit_step(triangles, |step| {
        let sides = pieces(girth, step).max(8);
        Divisions::new(&Outline::circle(radius, sides), prism, girth / sides as f64 * 1.2).triangles(prism)
    });
    pieces(girth, step).max(8)
}

/// A cylinder inscribed in the round one of the given radius.
pub(crate) fn cylinder(triangles: usize, radius: f64, half_height: f64) -> Surface {
    let prism = Prism { half_height, bore: 0.0 };
    Outline::circle(radius, round_sides(triangles, radius, prism)).extrude(prism, triangles)
}

/// A ring that nowhere comes nearer to its axis than `bore`: its vertices are farther by 1/cos(π/n).
pub(crate) fn ring(triangles: usize, radius: f64, half_height: f64, bore: f64) -> Surface {
    let sides = round_sides(triangles, radius, Prism { half_height, bore });
    // Sides are not divided further below, whatever the step: see `Divisions`; a division would only move points onto
    // chords, which keeps the distance too.
    let apothem = crate::trigonometry::cos_sin(std::f64::consts::PI / sides as f64).x;
    Outline::circle(radius, sides).extrude(Prism { half_height, bore: bore / apothem }, triangles)
}
