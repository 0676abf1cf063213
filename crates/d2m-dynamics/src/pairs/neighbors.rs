//! The bodies near each body, kept from flight to flight.

use crate::body::rigid_body::RigidBody;
use d2m_interval::Interval;
use d2m_motion::RigidMotion;
use d2m_world::{Aabb, BoxTree};

/// The boxes for the lists of neighbors are grown by this part of their bodies' radius. The lists hold as
/// long as no body leaves its grown box.
const GROWN: f64 = 0.125;

/// The volume that each body sweeps in its present flight, computed when it begins another one, and the
/// bodies near it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Neighbors {
    boxes: Vec<Aabb>,
    /// The flight, its end and the margin of each box; none: the box is not known.
    known: Vec<Option<Known>>,
    /// Larger boxes; bodies are neighbors if these meet.
    grown: Vec<Aabb>,
    tree: BoxTree,
    /// The index in `others` of the first neighbor of each body, and the end of the last list.
    starts: Vec<usize>,
    others: Vec<u32>,
    /// Has a body been forgotten since the neighbors were found?
    is_forgotten: bool,
}

/// Encloses the body at all times of its flight from its state's time to `end`, grown by `margin`.
///
/// The center moves on a straight line and no point is further from it than the radius. A body at rest has
/// the same box whenever it is computed.
fn swept(body: &RigidBody, end: f64, margin: f64) -> Aabb {
    if body.stands_still() {
        return posed(body, body.flight.reference_time(), margin);
    }
    Aabb::enclose_sphere(&body.sphere(), end - body.flight.reference_time()).grown(margin)
}

/// Encloses the body at a time of its flight, grown by `margin`.
pub(crate) fn posed(body: &RigidBody, time: f64, margin: f64) -> Aabb {
    let swept = if body.is_dynamic() {
        Aabb::enclose_sphere(&body.sphere_at(time), 0.0)
    } else {
        Aabb::enclose(&body.tree, &body.flight.enclose_pose(Interval::point(time)), body.rounding)
    };
    swept.grown(margin)
}

/// The inputs of a box: it holds as long as these are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    version: u64,
    /// None: the body stands still.
    end: Option<f64>,
    margin: f64,
}

impl Neighbors {
    /// Updates boxes and neighbors for the flights to `end`, with boxes grown by `margin`.
    pub(crate) fn update(&mut self, bodies: &[RigidBody], end: f64, margin: f64) {
        let mut is_old = self.is_forgotten || self.starts.len() != bodies.len() + 1;
        self.boxes.truncate(bodies.len());
        self.known.truncate(bodies.len());
        for (i, body) in bodies.iter().enumerate() {
            let known = Known { version: body.version, end: (!body.stands_still()).then_some(end), margin };
            if self.known.get(i) == Some(&Some(known)) {
                continue;
            }
            let swept = swept(body, end, margin);
            if i < self.boxes.len() {
                (self.boxes[i], self.known[i]) = (swept, Some(known));
            } else {
                self.boxes.push(swept);
                self.known.push(Some(known));
            }
            is_old |= !self.grown.get(i).is_some_and(|grown| grown.holds(&swept));
        }
        if is_old {
            self.find(bodies);
            self.is_forgotten = false;
        }
    }

    /// Forgets the box and the neighbors of this place: its body is another one now, or has changed.
    pub(crate) fn forget(&mut self, place: usize) {
        if let Some(known) = self.known.get_mut(place) {
            *known = None;
        }
        self.is_forgotten = true;
    }

    /// Finds the neighbors of all bodies.
    fn find(&mut self, bodies: &[RigidBody]) {
        let grown = self
            .boxes
            .iter()
            .zip(bodies)
            .map(|(b, body)| if body.is_dynamic() { b.grown(GROWN * body.radius) } else { *b });
        self.grown = grown.collect();
        let mut pairs = Vec::new();
        self.tree.fit(&self.grown);
        // Two bodies that are not dynamic do not meet.
        self.tree.pairs(&self.grown, 0.0, |pair| {
            if pair.iter().any(|&place| bodies[place as usize].is_dynamic()) {
                pairs.push(pair);
            }
        });
        self.starts = vec![0; bodies.len() + 1];
        for &i in pairs.iter().flatten() {
            self.starts[i as usize + 1] += 1;
        }
        for k in 1..self.starts.len() {
            self.starts[k] += self.starts[k - 1];
        }
        let mut next = self.starts.clone();
        self.others = vec![0; 2 * pairs.len()];
        for [a, b] in pairs {
            for (i, j) in [(a, b), (b, a)] {
                self.others[next[i as usize]] = j;
                next[i as usize] += 1;
            }
        }
        for ends in self.starts.windows(2) {
            self.others[ends[0]..ends[1]].sort_unstable();
        }
    }

    /// The pairs, ascending, of one of these bodies and any other whose boxes may meet and that are `wanted`;
    /// the smaller number first.
    pub(crate) fn pairs(&self, of: &[usize], wanted: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        let mut is_of = vec![false; self.boxes.len()];
        for &i in of {
            is_of[i] = true;
        }
        // The body with the smaller number adds a pair of two of them: for all bodies the pairs are found in
        // order.
        for &i in of {
            for &j in &self.others[self.starts[i]..self.starts[i + 1]] {
                let j = j as usize;
                let (a, b) = (i.min(j), i.max(j));
                if (j > i || !is_of[j]) && self.boxes[a].may_meet(&self.boxes[b], 0.0) && wanted(a, b) {
                    pairs.push((a, b));
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
