//! The report of a step: segments in which every body flies a constant twist.

use crate::BodyId;
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// An impulse at a contact.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
/// let falling = simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 0.6))?;
/// while simulation.time() < 0.5 {
///     for contact in simulation.step()?.contacts() {
///         // On the faces, in the world; the normal from a to b.
///         assert!(contact.point.y.abs() < 2e-3 && contact.normal.y.abs() > 0.999);
///     }
/// }
/// # let _ = falling;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactImpulse {
    /// The first body.
    pub a: BodyId,
    /// The second body.
    pub b: BodyId,
    /// Middle of the two closest points, world frame.
    pub point: DVec3,
    /// Unit normal from a to b.
    pub normal: DVec3,
    /// Impulse on a (its opposite acts on b): mass times speed, world axes.
    pub impulse: DVec3,
    /// The time at which the momenta change. Flights that lead to a contact without restitution are solved
    /// with it, so such an impulse acts up to a step before its bodies are closest.
    pub time: f64,
}

/// A span of time in which every body moves with a constant twist about its center of mass.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
/// let falling = simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 0.6))?;
/// let mut ends = 0.0;
/// for segment in simulation.step()?.segments {
///     // Flights join, and each is a constant twist that was certified.
///     assert!(segment.start >= ends && segment.end >= segment.start && segment.skipped == 0.0);
///     ends = segment.end;
/// }
/// # let _ = falling;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Segment {
    /// First instant.
    pub start: f64,
    /// Last instant; the next segment begins here.
    pub end: f64,
    /// The bodies whose twist differs from that in the segment before, with their motions from `start` on
    /// (all bodies in the first segment); the others fly on.
    pub changed: Vec<(BodyId, ConstantTwist)>,
    /// The bodies that were removed before the segment begins.
    pub removed: Vec<BodyId>,
    /// Impulses at the end of the segment.
    pub contacts: Vec<ContactImpulse>,
    /// The length of the segment if bodies stand still in it because the events of the step were used up, else zero.
    pub skipped: f64,
}

/// The change of two bodies that touch.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions, TouchChange};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// simulation.add(&Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_position(DVec3::Y * -0.5))?;
/// simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 0.6))?;
/// let mut changes = Vec::new();
/// while simulation.time() < 0.5 {
///     changes.extend(simulation.step()?.touches.iter().map(|touch| touch.change));
/// }
/// assert_eq!(changes.first(), Some(&TouchChange::Began));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TouchChange {
    /// The first impulse between them.
    Began,
    /// They are further apart than 1.5 gaps, as the step found that began then; or they may not meet any more
    /// (by their groups, an ignored pair, or because none of them is dynamic); or one of them was removed.
    Ended,
}

/// Two bodies begin to touch, or stop. Bodies that rest and sleep go on touching.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions, TouchChange};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let floor = Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static).with_restitution(0.5);
/// let floor = simulation.add(&floor)?;
/// let ball = simulation.add(&Body::new("ball", cube).with_position(DVec3::Y * 1.2))?;
/// let mut events = Vec::new();
/// while simulation.time() < 0.3 {
///     events.extend(simulation.step()?.touches);
/// }
/// // It has bounced once.
/// let changes: Vec<_> = events.iter().map(|event| event.change).collect();
/// assert_eq!(changes, [TouchChange::Began, TouchChange::Ended]);
/// assert!(events.iter().all(|event| (event.a, event.b) == (floor, ball)));
/// assert!(events[0].time < events[1].time && !simulation.touch(floor, ball));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TouchEvent {
    /// The body with the smaller place.
    pub a: BodyId,
    /// The other body.
    pub b: BodyId,
    /// The time of the change.
    pub time: f64,
    /// The change.
    pub change: TouchChange,
}

impl Segment {
    /// A segment without length.
    fn at(time: f64, changed: Vec<(BodyId, ConstantTwist)>) -> Self {
        let (removed, contacts) = (Vec::new(), Vec::new());
        Self { start: time, end: time, changed, removed, contacts, skipped: 0.0 }
    }
}

/// Collects segments as they become complete. One is kept back: impulses at the start of a step belong to the
/// segment that ends there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recorder {
    done: Vec<Segment>,
    last: Option<Segment>,
    open: Option<Segment>,
    /// Bodies removed while nothing is recorded: the next first segment states them.
    gone: Vec<BodyId>,
}

impl Recorder {
    /// Starts with a segment without length that holds the first velocities.
    pub(crate) fn begin(&mut self, time: f64, bodies: Vec<(BodyId, ConstantTwist)>) {
        let removed = core::mem::take(&mut self.gone);
        self.last = Some(Segment { removed, ..Segment::at(time, bodies) });
        self.open = Some(Segment::at(time, Vec::new()));
    }

    pub(crate) fn has_begun(&self) -> bool {
        self.last.is_some()
    }

    /// Ends the open segment at `time`; without length it stays open.
    pub(crate) fn cut(&mut self, time: f64) -> Option<&mut Segment> {
        let mut closed = self.open.take_if(|open| open.start < time)?;
        closed.end = time;
        self.open = Some(Segment::at(time, Vec::new()));
        self.done.extend(self.last.replace(closed));
        self.last.as_mut()
    }

    /// As [`Self::cut`], for a segment in which bodies stood still.
    pub(crate) fn cut_skipped(&mut self, time: f64) {
        if let Some(segment) = self.cut(time) {
            segment.skipped = time - segment.start;
        }
    }

    /// A body begins another flight at the start of the open segment.
    pub(crate) fn change(&mut self, body: BodyId, flight: ConstantTwist) {
        let Some(open) = &mut self.open else { return };
        match open.changed.binary_search_by_key(&body, |(id, _)| *id) {
            Ok(place) => open.changed[place].1 = flight,
            Err(place) => open.changed.insert(place, (body, flight)),
        }
    }

    /// A body is removed from the start of the open segment on.
    pub(crate) fn remove(&mut self, body: BodyId) {
        let Some(open) = &mut self.open else {
            self.gone.push(body);
            return;
        };
        open.changed.retain(|(id, _)| *id != body);
        open.removed.push(body);
    }

    /// An impulse at the start of the open segment.
    pub(crate) fn contact(&mut self, impulse: ContactImpulse) {
        if let Some(last) = &mut self.last {
            last.contacts.push(impulse);
        }
    }

    /// The complete segments.
    pub(crate) fn take(&mut self) -> Vec<Segment> {
        core::mem::take(&mut self.done)
    }

    /// All segments up to the last cut.
    pub(crate) fn finish(&mut self) -> Vec<Segment> {
        self.done.extend(self.last.take());
        self.open = None;
        self.take()
    }
}
