//! Boxes about what bodies sweep, and which of them meet.

use crate::rigid_body::RigidBody;
use d2m_motion::Pose;
use glam::DVec3;

/// An axis-aligned box, world frame, rounded outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

/// Roundings of a placed point, relative to the sizes of its terms: a rotation (norm of the quaternion, nine products of
/// three) and two sums, fewer than 40 operations of relative error 2⁻⁵³ each, doubled.
const PLACED: f64 = 40.0 * f64::EPSILON;

impl Aabb {
    /// Encloses the body at all times of its flight from its state's time to `end`, grown by `margin`.
    ///
    /// The center moves on a straight line and no point is further from it than the radius.
    pub(crate) fn swept(body: &RigidBody, end: f64, margin: f64) -> Self {
        let start = body.flight.position();
        let elapsed = end - body.flight.reference_time();
        let travel = body.flight.linear_velocity() * elapsed;
        if body.stands_still() {
            return Self::posed(body, &body.pose_at(end), margin);
        }
        let finish = start + travel;
        let lost = PLACED * (start.length() + travel.length() + body.radius + margin);
        let reach = DVec3::splat(body.radius + margin + lost);
        Self { low: start.min(finish) - reach, high: start.max(finish) + reach }
    }

    /// Encloses the body in one pose, grown by `margin`.
    pub(crate) fn posed(body: &RigidBody, pose: &Pose, margin: f64) -> Self {
        let lost = PLACED * (pose.translation.length() + body.radius + margin);
        let reach = DVec3::splat(margin + lost);
        if body.is_dynamic() {
            let reach = reach + DVec3::splat(body.radius);
            return Self { low: pose.translation - reach, high: pose.translation + reach };
        }
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mesh = body.tree.mesh();
        for &vertex in mesh.triangles().iter().flatten() {
            let p = pose.transform_point(mesh.vertices()[vertex as usize]);
            (low, high) = (low.min(p), high.max(p));
        }
        Self { low: low - reach, high: high + reach }
    }

    /// Can the boxes share a point? Yes when a bound is not a number.
    #[inline]
    pub(crate) fn may_meet(&self, other: &Self) -> bool {
        !(self.low.cmpgt(other.high).any() || other.low.cmpgt(self.high).any())
    }
}

/// What each body sweeps on its present flight, computed when it begins another one.
#[derive(Clone, Debug, Default)]
pub(crate) struct SweptBoxes {
    boxes: Vec<Aabb>,
    /// Of which flight, until when, and by how much the box is grown.
    known: Vec<Known>,
}

/// What a box is for: it holds as long as these are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    version: u64,
    /// None: the body stands still.
    end: Option<f64>,
    margin: f64,
}

impl SweptBoxes {
    /// The boxes of the flights to `end`, grown by `margin`.
    pub(crate) fn update(&mut self, bodies: &[RigidBody], end: f64, margin: f64) -> &[Aabb] {
        for (i, body) in bodies.iter().enumerate() {
            let known = Known { version: body.version, end: (!body.stands_still()).then_some(end), margin };
            if self.known.get(i) == Some(&known) {
                continue;
            }
            let swept = Aabb::swept(body, end, margin);
            if i < self.boxes.len() {
                (self.boxes[i], self.known[i]) = (swept, known);
            } else {
                self.boxes.push(swept);
                self.known.push(known);
            }
        }
        &self.boxes
    }
}

/// The pairs of boxes that may meet and that `wanted` wants, smaller number first, ascending.
pub(crate) fn candidates(boxes: &[Aabb], wanted: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
    let spread = |axis: usize| {
        let middles = boxes.iter().map(|b| 0.5 * (b.low[axis] + b.high[axis]));
        let (low, high) = middles.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(m), h.max(m)));
        high - low
    };
    let axis = (1..3).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| boxes[i].low[axis].total_cmp(&boxes[j].low[axis]).then(i.cmp(&j)));
    let mut open: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for i in order {
        let start = boxes[i].low[axis];
        // A box that is not finite stays: it excludes nothing.
        open.retain(|&j| boxes[j].high[axis] >= start || boxes[j].high[axis].is_nan());
        for &j in &open {
            let (a, b) = (i.min(j), i.max(j));
            if boxes[i].may_meet(&boxes[j]) && wanted(a, b) {
                pairs.push((a, b));
            }
        }
        open.push(i);
    }
    pairs.sort_unstable();
    pairs
}
