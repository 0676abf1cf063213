//! The direction across two edges, each of which turns with its body.
//!
//! Where two edges cross at a small gap while both bodies spin, a direction that is fixed in space or turns with one body loses the
//! far end of the other's edge after a time of the size of the gap over its speed. The product of both edges sees neither turn.
//!
//! See docs/theory/engine.md, "Edges that turn".

use super::turning::TurningTriangle;
use crate::gap::first_time::{PathAlong, first_time_of_paths};
use d2m_mesh::margin::{UNIT_F64, UP};
use glam::DVec3;

/// Roundings of a triple product, in 2⁻⁵³ of the product of the lengths: the product of two edges errs by 4, the rate of an edge by
/// 5, its second derivative by 12, an inner product by 3, so none errs by more than 24; the rest is room for the roundings of bounds.
const PRODUCT_ERROR: f64 = 32.0 * UNIT_F64;

/// Where two edges come closest.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrossingEdges {
    /// By number, of A and of B.
    pub(super) edges: [usize; 2],
    /// Points on them, in the frame of the triangles.
    pub(super) points: [DVec3; 2],
}

/// An edge of one body and its derivatives as the other body sees them, with bounds on their lengths up to a time.
struct SeenEdge {
    now: DVec3,
    rate: DVec3,
    bend: DVec3,
    length: f64,
    most_rate: f64,
    most_bend: f64,
    most_jerk: f64,
    /// The terms of the rate and of the second derivative, by which their roundings are measured.
    rate_terms: f64,
    bend_terms: f64,
}

impl SeenEdge {
    /// d′ = δ × d, d″ = δ × (ω × d) − ω′ × d′, d‴ = δ × (ω × (ω × d)) − 2ω′ × (δ × (ω × d)) + ω′ × (ω′ × d′) with ω of the edge's
    /// body and ω′ of the other one, where |ω × d| stays.
    fn new(edge: DVec3, own: DVec3, observer: DVec3, enough: f64) -> Self {
        let (difference, length) = (own - observer, edge.length() * UP);
        let (rate, world_rate) = (difference.cross(edge), own.cross(edge));
        let [apart, spin, spin_observer] = [difference, own, observer].map(|w| w.length() * UP);
        let rate_terms = apart * length * UP;
        let bend_terms = rate_terms * (spin + spin_observer) * UP;
        let most_change = apart * (world_rate.length() * UP + PRODUCT_ERROR * spin * length);
        let grown = rate.length() * UP
            + PRODUCT_ERROR * rate_terms
            + enough * (most_change + spin_observer * rate_terms);
        let most_rate = rate_terms.min(grown);
        Self {
            now: edge,
            rate,
            bend: difference.cross(world_rate) - observer.cross(rate),
            length,
            most_rate,
            most_bend: most_change + spin_observer * most_rate,
            most_jerk: most_change * (spin + 2.0 * spin_observer) + spin_observer * spin_observer * most_rate,
            rate_terms,
            bend_terms,
        }
    }

    /// The inner product with a vector that turns with the observer and errs by 4·2⁻⁵³ of `size`.
    fn along(&self, n: DVec3, size: f64) -> PathAlong {
        let error = PRODUCT_ERROR * size;
        PathAlong {
            gap: n.dot(self.now) - error * self.length,
            rate: n.dot(self.rate) - error * self.rate_terms,
            bend: n.dot(self.bend) - error * self.bend_terms,
            jerk: n.length() * self.most_jerk * UP,
        }
    }
}

/// How a point of B moves as A sees it, from where a point of A is, with bounds up to a time.
struct SeenPoint {
    line: DVec3,
    rate: DVec3,
    bend: DVec3,
    most_line: f64,
    most_rate: f64,
    most_bend: f64,
    most_jerk: f64,
    /// The terms of the rate and of the second derivative, by which their roundings are measured.
    rate_terms: f64,
    bend_terms: f64,
}

impl SeenPoint {
    /// r = v − ω_A × u + δ × p and r′ − ω_A × r, as in `turning`.
    fn new([from, point]: [DVec3; 2], a: &TurningTriangle, b: &TurningTriangle, enough: f64) -> Self {
        let (w_a, w_b) = (a.omega, b.omega);
        let (spin_a, difference) = (w_a.length() * UP, (w_b - w_a).length() * UP);
        let (of_a, of_b) = (point - a.center, point - b.center);
        let arm_velocity = w_b.cross(of_b + b.arm);
        let rate = (b.velocity + w_b.cross(of_b)) - (a.velocity + w_a.cross(of_a));
        let reference_drift = (b.velocity - w_b.cross(b.arm)) - (a.velocity - w_a.cross(a.arm));
        let change = (w_b - w_a).cross(arm_velocity) - w_a.cross(reference_drift);
        // Bounds, with what the terms err by.
        let speeds = a.velocity.length() + b.velocity.length();
        let spins = [a, b].map(|body| body.omega.length());
        let rate_terms = (speeds + spins[0] * of_a.length() + spins[1] * of_b.length()) * UP;
        let drift_terms = (speeds + spins[0] * a.arm.length() + spins[1] * b.arm.length()) * UP;
        let arm_terms = spins[1] * (of_b.length() + b.arm.length()) * UP;
        let most_arm_velocity = arm_velocity.length() * UP + PRODUCT_ERROR * arm_terms;
        let most_drift_turned =
            w_a.cross(reference_drift).length() * UP + PRODUCT_ERROR * spin_a * drift_terms;
        let most_change = difference * most_arm_velocity + most_drift_turned;
        let most_rate = rate.length() * UP + PRODUCT_ERROR * rate_terms + enough * most_change;
        let line = point - from;
        Self {
            line,
            rate,
            bend: change - w_a.cross(rate),
            most_line: line.length() * UP + enough * most_rate,
            most_rate,
            most_bend: most_change + spin_a * most_rate,
            most_jerk: difference * spins[1] * most_arm_velocity
                + spin_a * (2.0 * most_change + spin_a * most_rate),
            rate_terms,
            bend_terms: difference * arm_terms + spin_a * (drift_terms + rate_terms),
        }
    }
}

/// For how long the product of the two edges, which turns as they do, keeps the triangles further apart than `need`; zero if it
/// does not part them now. No time beyond `enough` matters.
pub(super) fn clear_across_edges(
    crossing: &CrossingEdges,
    a: &TurningTriangle,
    b: &TurningTriangle,
    need: f64,
    enough: f64,
) -> f64 {
    let ([i, j], [p, q]) = (crossing.edges, crossing.points);
    let edge_a = a.corners[(i + 1) % 3] - a.corners[i];
    let edge_b = b.corners[(j + 1) % 3] - b.corners[j];
    let edge_b = if edge_a.cross(edge_b).dot(q - p) < 0.0 { -edge_b } else { edge_b };
    let (seen_a, seen_b) =
        (SeenEdge::new(edge_a, a.omega, b.omega, enough), SeenEdge::new(edge_b, b.omega, a.omega, enough));
    let across = edge_a.cross(edge_b);
    let (length, size) = (across.length(), seen_a.length * seen_b.length);
    // Not when it is no number either.
    let is_direction = length > 0.0;
    if !is_direction {
        return 0.0;
    }
    let point = SeenPoint::new([p, q], a, b, enough);

    // |m(s)| ≤ |m + s m′| + s²/2 max |m″| and |m + s m′| ≤ |m| + s m·m′/|m| + s²/2 |m′|²/|m|.
    let (across_rate, across_bend) = (edge_a.cross(seen_b.rate), edge_a.cross(seen_b.bend));
    let stretch = across.dot(across_rate) / length;
    let stretch_bend = across_rate.length_squared() / length + seen_a.length * seen_b.most_bend;
    // What is multiplied with the second edge and its derivatives: the line, and the length that m is compared with.
    let measured = point.line.length() + need * (size / length);
    let error = PRODUCT_ERROR * seen_a.length;
    let most_across = size.min(length * UP + enough * seen_a.length * seen_b.most_rate);
    let third = seen_b.most_jerk * point.most_line
        + 3.0 * (seen_b.most_bend * point.most_rate + seen_b.most_rate * point.most_bend);
    let gap = PathAlong {
        gap: across.dot(point.line) - need * length - error * seen_b.length * measured,
        rate: across_rate.dot(point.line) + across.dot(point.rate)
            - need * stretch
            - error * (seen_b.rate_terms * measured + seen_b.length * point.rate_terms),
        bend: across_bend.dot(point.line) + 2.0 * across_rate.dot(point.rate) + across.dot(point.bend)
            - need * stretch_bend * UP
            - error
                * (seen_b.bend_terms * measured
                    + 2.0 * seen_b.rate_terms * point.rate_terms
                    + seen_b.length * point.bend_terms),
        jerk: (seen_a.length * third + most_across * point.most_jerk) * UP,
    };
    // The third corners: how far they are behind their edges.
    let behind_a = p - (a.center + a.corners[(i + 2) % 3]);
    let behind_b = (b.center + b.corners[(j + 2) % 3]) - q;
    let corner_a = seen_b.along(behind_a.cross(edge_a), behind_a.length() * seen_a.length);
    let corner_b = seen_a.along(edge_b.cross(behind_b), behind_b.length() * seen_b.length);
    let paths = [gap, gap + corner_a, gap + corner_b, gap + corner_a + corner_b];
    if paths.iter().all(|path| path.gap > 0.0) { first_time_of_paths(&paths, enough) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::widest_gap::{greatest, least};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DQuat;

    /// A triangle and how it moves.
    fn body(points: [DVec3; 3], omega: DVec3, velocity: DVec3, arm: DVec3) -> TurningTriangle {
        let center = (points[0] + points[1] + points[2]) / 4.0;
        TurningTriangle { corners: points.map(|p| p - center), center, velocity, omega, arm }
    }

    /// Where a point of a body is at a time.
    fn moved(body: &TurningTriangle, p: DVec3, s: f64) -> DVec3 {
        let reference = (body.center - body.arm) + (body.velocity - body.omega.cross(body.arm)) * s;
        reference + DQuat::from_scaled_axis(body.omega * s) * (p - body.center + body.arm)
    }

    /// What rounding may hide from the judge below: places of up to about 4, rounded a few times, are known to some 1e-15, which is
    /// 1e-12 of the gap of 1e-3 that is needed; ten times that is granted.
    const ROUNDED_DOWN: f64 = 1.0 - 1e-11;

    /// The least gap across the first edges over what is needed, at times that are proven, and the time.
    fn least_ratio(bodies: &[TurningTriangle; 2], points: [DVec3; 2], need: f64, enough: f64) -> (f64, f64) {
        let [a, b] = bodies;
        let crossing = CrossingEdges { edges: [0, 0], points };
        let time = clear_across_edges(&crossing, a, b, need, enough);
        let ratio = |part: f64| {
            let at = |body: &TurningTriangle| {
                body.corners.map(|corner| moved(body, body.center + corner, time * part))
            };
            let (pa, pb) = (at(a), at(b));
            let n = (pa[1] - pa[0]).cross(pb[1] - pb[0]).normalize();
            let (ha, hb) = (pa.map(|p| n.dot(p)), pb.map(|p| n.dot(p)));
            (least(&hb) - greatest(&ha)).max(least(&ha) - greatest(&hb)) / need
        };
        let least = [0.2, 0.5, 0.8, 1.0].map(ratio).into_iter().fold(f64::INFINITY, f64::min);
        (if time > 0.0 { least } else { f64::INFINITY }, time)
    }

    /// Edges that cross at any angle and gap, of bodies of any kind: far axes, parallel and equal spins, nearly at rest or fast.
    #[test]
    fn edges_that_turn_keep_bodies_apart() {
        let mut random = KnuthRandom(33);
        let (mut least, mut proven, mut sharp) = (f64::INFINITY, 0, 0);
        for round in 0..40_000 {
            let need = 1e-3;
            let part = 0.5 + 0.5 * random.signed();
            let gap = need * (1.0 + 10f64.powf(4.0 * part - 2.0));
            let e = random.vector().normalize();
            let angle = 10f64.powf(-1.5 * (0.5 + 0.5 * random.signed())) * [1.0, -1.0][round % 2];
            let n = e.cross(random.vector()).normalize();
            let d = DQuat::from_axis_angle(n, angle) * e;
            let (p, flat) = (random.vector(), [1.0, 1e-3][round / 2 % 2]);
            let q = p + n * gap;
            let mut corners = |on: DVec3, along: DVec3, out: DVec3| {
                let third = on + random.vector() + out * (0.7 * flat);
                let behind = out * (out.dot(third - on).min(0.0));
                [on - along * (0.1 + random.signed().abs()), on + along, third - behind]
            };
            let (a, b) = (corners(p, e, -n), corners(q, d, n));
            let far = [0.0, 0.1, 1.0][round / 4 % 3];
            let speed = [0.0, 1e-3, 0.1][round / 12 % 3];
            let spin = [0.0, 0.3, 1.0][round / 36 % 3];
            // The axes go through the points, up to what `far` says.
            let mut arm = |points: &[DVec3; 3], on: DVec3| {
                let center = (points[0] + points[1] + points[2]) / 4.0;
                center - on + random.vector() * far
            };
            let (arm_a, arm_b) = (arm(&a, p), arm(&b, q));
            let w_a = random.vector();
            let w_b =
                if round / 108 % 3 == 1 { w_a * [1.0, -0.5][round % 2] } else { random.vector() * spin };
            // Velocities of the reference points, not of the centers.
            let v_a = w_a.cross(arm_a);
            let v_b = w_b.cross(arm_b) + random.vector() * speed;
            let bodies = [body(a, w_a, v_a, arm_a), body(b, w_b, v_b, arm_b)];
            let (ratio, time) = least_ratio(&bodies, [p, q], need, 0.35 / w_a.length().max(w_b.length()));
            proven += u32::from(time > 0.0);
            sharp += u32::from(ratio < 1.1);
            least = least.min(ratio);
        }
        assert!(least >= ROUNDED_DOWN, "{:e}", least - 1.0);
        assert!(proven > 20_000 && sharp > 4000, "{proven} {sharp}");
    }

    /// An edge that spins about a line along itself, 1 away, with the rest of its path taken off: the gap is g + sin s − s.
    #[test]
    fn the_third_derivative_across_edges_is_needed() {
        let gap = 3e-3;
        let below = [-DVec3::X, DVec3::X, -DVec3::Z];
        let above = [-DVec3::Y, DVec3::Y, DVec3::Z].map(|p| p + DVec3::Z * gap);
        let a = body(below, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let center = (above[0] + above[1] + above[2]) / 4.0;
        let arm = center - (DVec3::Z * gap + DVec3::X);
        let b = body(above, DVec3::Y, DVec3::Y.cross(arm) - DVec3::Z, arm);
        let (ratio, time) = least_ratio(&[a, b], [DVec3::ZERO, DVec3::Z * gap], 1e-3, 0.35);
        assert!((1.0..1.5).contains(&ratio) && time > 0.2, "{ratio} {time}");
    }

    /// Each edge spins about a line through the point where they cross: the far ends pass the gap at once, the product parts them.
    #[test]
    fn edges_that_cross_stay_apart() {
        for gap in [1e-6, 1e-9, 1e-12] {
            let below = [-DVec3::X, DVec3::X, -DVec3::Z];
            let above = [-DVec3::Y, DVec3::Y, DVec3::Z].map(|p| p + DVec3::Z * gap);
            let spin = |points: [DVec3; 3], on: DVec3, omega: DVec3| {
                let arm = (points[0] + points[1] + points[2]) / 4.0 - on;
                body(points, omega, omega.cross(arm), arm)
            };
            let a = spin(below, DVec3::ZERO, DVec3::new(0.2, 0.5, 0.6));
            let b = spin(above, DVec3::Z * gap, DVec3::new(-0.4, -0.1, -0.5));
            let crossing = CrossingEdges { edges: [0, 0], points: [DVec3::ZERO, DVec3::Z * gap] };
            let time = clear_across_edges(&crossing, &a, &b, 0.1 * gap, 0.3);
            assert!(time >= 0.25, "{gap:e}: {time}");
        }
    }
}
