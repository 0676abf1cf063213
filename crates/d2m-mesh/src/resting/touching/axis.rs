//! Directions that part two triangles, though they may touch.
//!
//! Two triangles whose relative interiors share no point are parted, weakly, by a plane. Its normals form a cone, and each extreme ray of
//! that cone is across two edges of the two triangles: the normal of one, or the product of an edge of each (and in one plane, where the
//! cone holds a line, a normal of that plane or a direction in it across an edge).

use super::super::node_pair::RestingScene;
use d2m_lanes::power_of_two;
use glam::DVec3;

/// An edge of a triangle of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeOf {
    pub(super) body: usize,
    pub(super) triangle: u32,
    /// From this corner to the next one.
    pub(super) corner: usize,
}

/// A unit direction from A to B.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) direction: DVec3,
    /// By how much it may be off, an angle.
    pub(super) blur: f64,
    /// Across which edges; none: in the plane of two triangles.
    pub(super) across: Option<[EdgeOf; 2]>,
}

/// Edges with a smaller sine between them have no axis: 2⁻²⁶, the root of what doubles resolve. The axis across edges as long as
/// their coordinates is off by a rounding divided by the sine, so below this by more than the edges are from being parallel.
const LEAST_SINE: f64 = power_of_two(-26);

/// Directions nearer to each other than this are one, whatever their blurs: 2⁻⁴⁰.
const SAME: f64 = power_of_two(-40);

/// Which side of a face is outside, where triangles of one plane leave it open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sides {
    /// Where the corners turn counter-clockwise: of solids that agree about it.
    Outward([bool; 2]),
    /// Either.
    Any,
}

/// Two triangles that touch or nearly do, in working coordinates.
#[derive(Clone, Debug)]
pub(super) struct TouchingPair {
    pub(super) triangles: [u32; 2],
    pub(super) corners: [[DVec3; 3]; 2],
    /// The axes along which they are apart or touch, up to rounding.
    pub(super) axes: Vec<Axis>,
    /// Has one of them no area, or are both in one plane, up to rounding? Then they cross nowhere for certain.
    pub(super) is_flat: bool,
    spread: f64,
}

impl TouchingPair {
    /// Two points that part along some directions, for tests.
    #[cfg(test)]
    pub(super) fn along(directions: &[DVec3]) -> Self {
        let axes = directions.iter().map(|&direction| Axis { direction, blur: 0.0, across: None }).collect();
        Self { triangles: [0; 2], corners: [[DVec3::ZERO; 3]; 2], axes, is_flat: true, spread: 0.0 }
    }

    pub(super) fn new(scene: &RestingScene<'_>, triangles: [u32; 2], need: f64, sides: Sides) -> Self {
        let corners = [scene.place(0, triangles[0]), scene.place(1, triangles[1])];
        let spread = corners.as_flattened().iter().map(|p| p.distance(corners[0][0])).fold(0.0, f64::max);
        let mut pair = Self { triangles, corners, axes: Vec::new(), is_flat: false, spread };
        let edges = corners.map(|c| [c[1] - c[0], c[2] - c[1], c[0] - c[2]]);
        let edge = |body: usize, corner: usize| EdgeOf { body, triangle: triangles[body], corner };
        let mut faces: [Option<DVec3>; 2] = [None; 2];
        for body in [0, 1] {
            // The best conditioned two of three edges that go round.
            let best = (0..3).max_by(|&i, &j| {
                let sine = |k: usize| sine(edges[body][k], edges[body][(k + 1) % 3]);
                sine(i).total_cmp(&sine(j))
            });
            let k = best.unwrap_or(0);
            let across = [edge(body, k), edge(body, (k + 1) % 3)];
            let Some(axis) = across_edges(edges[body][k], edges[body][(k + 1) % 3], need, across) else {
                continue;
            };
            faces[body] = Some(axis.direction);
            let (fits, reversed) = (pair.fits(&axis, need), pair.fits(&axis.reversed(), need));
            let outward = match sides {
                // Outward of A is towards B; of B, away from it.
                Sides::Outward(known) if known[body] && fits && reversed => Some(body == 0),
                _ => None,
            };
            if fits && outward != Some(false) {
                pair.axes.push(axis);
            }
            if reversed && outward != Some(true) {
                pair.axes.push(axis.reversed());
            }
        }
        pair.is_flat = faces.iter().any(Option::is_none);
        if let [Some(a), Some(b)] = faces
            && a.cross(b).length() < LEAST_SINE
            && [a, -a].iter().all(|&n| pair.overlap(n) <= 3.0 * need)
        {
            pair.is_flat = true;
            // Triangles of one plane whose solids are on the same side of it part within the plane only.
            if matches!(sides, Sides::Outward([true, true])) && a.dot(b) > 0.0 {
                pair.axes.clear();
            }
            for edge in edges.as_flattened() {
                let direction = edge.cross(a).normalize_or_zero();
                pair.keep_those_that_fit(Axis { direction, blur: need / edge.length(), across: None }, need);
            }
            return pair;
        }
        for (i, &u) in edges[0].iter().enumerate() {
            for (j, &v) in edges[1].iter().enumerate() {
                if let Some(axis) = across_edges(u, v, need, [edge(0, i), edge(1, j)]) {
                    pair.keep_those_that_fit(axis, need);
                }
            }
        }
        pair
    }

    fn keep_those_that_fit(&mut self, axis: Axis, need: f64) {
        for axis in [axis, axis.reversed()] {
            if self.fits(&axis, need) {
                self.axes.push(axis);
            }
        }
    }

    /// How far A reaches beyond the lowest point of B along a unit direction.
    pub(super) fn overlap(&self, n: DVec3) -> f64 {
        let high = self.corners[0].iter().map(|p| n.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
        let low = self.corners[1].iter().map(|p| n.dot(*p)).fold(f64::INFINITY, f64::min);
        high - low
    }

    /// Do the triangles touch along the axis at most, up to rounding?
    pub(super) fn fits(&self, axis: &Axis, need: f64) -> bool {
        axis.direction != DVec3::ZERO && self.overlap(axis.direction) <= need + 2.0 * axis.blur * self.spread
    }
}

impl Axis {
    pub(super) fn reversed(&self) -> Self {
        Self { direction: -self.direction, ..*self }
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        let near = (4.0 * (self.blur + other.blur)).max(SAME);
        (self.direction - other.direction).length() <= near
    }
}

fn sine(u: DVec3, v: DVec3) -> f64 {
    let lengths = u.length() * v.length();
    if lengths > 0.0 { u.cross(v).length() / lengths } else { 0.0 }
}

/// The direction across two edges whose ends are off by `error` at most.
fn across_edges(u: DVec3, v: DVec3, error: f64, across: [EdgeOf; 2]) -> Option<Axis> {
    let product = u.cross(v);
    let (long, short) = (u.length() + v.length(), product.length());
    if sine(u, v) <= LEAST_SINE {
        return None;
    }
    Some(Axis { direction: product / short, blur: error * long / short, across: Some(across) })
}
