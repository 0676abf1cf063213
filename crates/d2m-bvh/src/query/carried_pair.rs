//! Two bodies that something carries together, seen from there: only how they move against each other decides when they meet.
//!
//! Distances of two bodies at a time are the same in every rigid frame, also in one that moves. So where both poses are c(t)·a(t) and c(t)·b(t)
//! with one and the same c, the query of the motions a and b has the answer of that of the bodies, but for the places of what it
//! reports. No bound has to hold for c then, however fast it is. That the two have c in common is known where nothing is rounded: it is one object,
//! or given by equal numbers.

use crate::covered_pair::CoveredPair;
use crate::{Clearance, Contact, Moving, QueryError, TimeOfContact};
use d2m_motion::{Chain, ConstantTwist, Pose, RigidMotion};
use glam::DVec3;

/// What both bodies have in common, and what is left of their motions.
enum Carrier<'a> {
    /// Nothing that is known.
    World,
    /// Both move as this one: they are at rest in its frame.
    Motion(&'a dyn RigidMotion),
    /// Both move in this frame, and so in it.
    Frame { outer: &'a dyn RigidMotion, inner: [&'a dyn RigidMotion; 2] },
    /// The first joints of two links of one arm, and the chains of the links from there on.
    Joints { first: Chain, rest: [Chain; 2] },
}

/// Two moving bodies, and what carries them both.
pub(super) struct CarriedPair<'a> {
    bodies: [Moving<'a>; 2],
    carrier: Carrier<'a>,
}

impl<'a> CarriedPair<'a> {
    pub(super) fn new(pair: &CoveredPair<'a>) -> Self {
        let bodies = *pair.bodies();
        Self { bodies, carrier: Carrier::of(bodies.map(|body| body.motion), pair.window().start()) }
    }

    /// The bodies as they move in the carrier.
    pub(super) fn seen(&self) -> [Moving<'_>; 2] {
        let [a, b] = self.bodies;
        match &self.carrier {
            Carrier::World => [a, b],
            Carrier::Motion(_) => {
                [Moving { motion: &ConstantTwist::REST, ..a }, Moving { motion: &ConstantTwist::REST, ..b }]
            }
            Carrier::Frame { inner: [of_a, of_b], .. } => {
                [Moving { motion: *of_a, ..a }, Moving { motion: *of_b, ..b }]
            }
            Carrier::Joints { rest: [of_a, of_b], .. } => {
                [Moving { motion: of_a, ..a }, Moving { motion: of_b, ..b }]
            }
        }
    }

    /// An answer about the bodies that are seen, with places and directions of the world.
    ///
    /// # Errors
    /// [`QueryError::BadMotion`]: what carries the bodies has no pose at the time of the answer.
    pub(super) fn in_world(&self, answer: TimeOfContact) -> Result<TimeOfContact, QueryError> {
        match answer {
            TimeOfContact::Contact(contact) => {
                let [normal, point_a, point_b] =
                    self.carry(contact.time_lo, contact.normal, [contact.point_a, contact.point_b])?;
                let closing_speed = contact.closing_speed + self.turning_speed(&contact);
                Ok(TimeOfContact::Contact(Contact { normal, point_a, point_b, closing_speed, ..contact }))
            }
            other => Ok(other),
        }
    }

    /// The same of a clearance.
    ///
    /// # Errors
    /// As [`CarriedPair::in_world`].
    pub(super) fn clearance_in_world(&self, found: Clearance) -> Result<Clearance, QueryError> {
        let [normal, point_a, point_b] =
            self.carry(found.time, found.normal, [found.point_a, found.point_b])?;
        Ok(Clearance { point_a, point_b, normal, ..found })
    }

    /// What the turning of the carrier adds to how fast the points of a contact come together along its normal, which may not be quite the
    /// direction from one to the other.
    fn turning_speed(&self, contact: &Contact) -> f64 {
        let Some(carrier) = self.motion() else { return 0.0 };
        let (pose, twist) = carrier.pose_and_twist(contact.time_lo);
        let spin = pose.rotation.normalize().conjugate() * twist.angular;
        let speed = spin.cross(contact.point_a - contact.point_b).dot(contact.normal);
        // Of one that is no number nothing is known.
        if speed.is_finite() { speed } else { 0.0 }
    }

    /// What carries both.
    fn motion(&self) -> Option<&dyn RigidMotion> {
        match &self.carrier {
            Carrier::World => None,
            Carrier::Motion(motion) => Some(*motion),
            Carrier::Frame { outer, .. } => Some(*outer),
            Carrier::Joints { first, .. } => Some(first),
        }
    }

    fn carry(&self, time: f64, normal: DVec3, [a, b]: [DVec3; 2]) -> Result<[DVec3; 3], QueryError> {
        let Some(carrier) = self.motion() else { return Ok([normal, a, b]) };
        // Both bodies have no pose then.
        let frame = frame_of(carrier, time).ok_or(QueryError::BadMotion { body: 0 })?;
        Ok([frame.transform_vector(normal), frame.transform_point(a), frame.transform_point(b)])
    }
}

impl<'a> Carrier<'a> {
    fn of([a, b]: [&'a dyn RigidMotion; 2], start: f64) -> Self {
        if is_shared(a, b) {
            // A motion that has no pose is for the search to refuse.
            return frame_of(a, start).map_or(Self::World, |_| Self::Motion(a));
        }
        if let (Some(a), Some(b)) = (a.composition(), b.composition())
            && is_shared(a.outer, b.outer)
        {
            let frame = Self::Frame { outer: a.outer, inner: [a.inner, b.inner] };
            return frame_of(a.outer, start).map_or(Self::World, |_| frame);
        }
        let (Some(a), Some(b)) = (a.chain(), b.chain()) else { return Self::World };
        let common = a.common_joints(b);
        if common == 0 {
            return Self::World;
        }
        let rest = [a.without_first(common), b.without_first(common)];
        Self::Joints { first: a.only_first(common), rest }
    }
}

/// The pose at a time, with the rotation of the quaternion divided by its length; `None`: there is none.
fn frame_of(motion: &dyn RigidMotion, time: f64) -> Option<Pose> {
    let Pose { rotation, translation, at } = motion.pose_and_twist(time).0;
    let rotation = rotation.normalize();
    let is_pose = rotation.is_finite() && translation.is_finite() && at.is_finite();
    is_pose.then_some(Pose { rotation, translation, at })
}

/// Are these two one motion for certain, and one that is worth to be left out?
fn is_shared<'a>(a: &'a dyn RigidMotion, b: &'a dyn RigidMotion) -> bool {
    match (a.constant_twist(), b.constant_twist()) {
        // Searches see by themselves that nothing changes between bodies that do not turn.
        (Some(a), Some(b)) => a == b && a.angular_velocity() != DVec3::ZERO,
        // By address and type: a part of a motion may have the address of the whole.
        (None, None) => {
            let same_object = core::ptr::eq::<dyn RigidMotion>(a, b);
            let equal_chains = || {
                let (Some(a), Some(b)) = (a.chain(), b.chain()) else { return false };
                let count = a.joints().len();
                count == b.joints().len() && a.common_joints(b) == count
            };
            same_object || equal_chains()
        }
        _ => false,
    }
}
