//! The state of a body in a snapshot.

use crate::body::description::{Damping, Groups, Kind};
use crate::body::rigid_body::{RigidBody, Role, Target};
use crate::numbers::{Numbers, is_small, is_turn, unusable_of};
use crate::rest::quiet::Quiet;
use crate::shown::{shown, shown_turn};
use crate::snapshot::contents::Held;
use crate::{BodyId, Motion, SimulationError};
use d2m_bvh::{MeshTree, Solid};
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::{DQuat, DVec3};
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum KindState {
    Dynamic,
    Static,
    Kinematic,
    Driven,
}

/// What proofs about a body depend on, and the motion that it follows.
#[derive(Clone)]
pub(crate) struct HeldBody {
    tree: Arc<MeshTree>,
    role: Role,
    center: DVec3,
    rounding: f64,
    solid: Solid,
    motion: Option<Motion>,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct BodyState {
    pub(crate) id: BodyId,
    kind: KindState,
    restitution: f64,
    friction: f64,
    damping: Damping,
    groups: Groups,
    pub(crate) surface_velocity: DVec3,
    target: Option<Target>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) held: Held<HeldBody>,
    time: f64,
    pub(crate) position: DVec3,
    orientation: DQuat,
    momentum: DVec3,
    angular_momentum: DVec3,
    /// None: not beyond its time.
    #[cfg_attr(feature = "serde", serde(default))]
    faded: Option<f64>,
    force: DVec3,
    torque: DVec3,
    /// As it was flown: from its start, and the time of that.
    pub(crate) flight: ConstantTwist,
    /// None: the flight has no end.
    horizon: Option<f64>,
    version: u64,
    has_flown: bool,
    free: bool,
    pub(crate) asleep: bool,
    quiet: Quiet,
    gained: f64,
}

impl BodyState {
    pub(crate) fn of(body: &RigidBody) -> Self {
        let kind = match &body.kind {
            Kind::Dynamic => KindState::Dynamic,
            Kind::Static => KindState::Static,
            Kind::Kinematic(_) => KindState::Kinematic,
            Kind::Driven => KindState::Driven,
        };
        let motion = match &body.kind {
            Kind::Kinematic(motion) => Some(Arc::clone(motion)),
            _ => None,
        };
        let (tree, center) = (Arc::clone(&body.tree), body.center);
        let (role, rounding, solid) = (body.role, body.rounding, body.solid);
        Self {
            id: body.id,
            kind,
            restitution: body.restitution,
            friction: body.friction,
            damping: body.damping,
            groups: body.groups,
            surface_velocity: body.surface_velocity,
            target: body.target,
            held: Held(Some(HeldBody { tree, role, center, rounding, solid, motion })),
            time: body.time,
            position: body.position,
            orientation: body.orientation,
            momentum: body.momentum,
            angular_momentum: body.angular_momentum,
            faded: (body.faded > body.time).then_some(body.faded),
            force: body.force,
            torque: body.torque,
            flight: body.flight,
            horizon: body.horizon.is_finite().then_some(body.horizon),
            version: body.version,
            has_flown: body.has_flown,
            free: body.free,
            asleep: body.asleep,
            quiet: body.quiet,
            gained: body.gained,
        }
    }

    /// Was the state taken of this body?
    pub(crate) fn is_of(&self, body: &RigidBody) -> bool {
        self.held.0.as_ref().is_some_and(|held| {
            Arc::ptr_eq(&held.tree, &body.tree)
                && (held.center, held.rounding) == (body.center, body.rounding)
                && (held.role, held.solid) == (body.role, body.solid)
        })
    }

    /// The body in this state.
    ///
    /// # Errors
    /// Numbers that cannot be used, as for a body that is added or changed.
    pub(crate) fn restored(&self, own: &RigidBody, now: f64) -> Result<RigidBody, SimulationError> {
        let bad = |name: &'static str, value: String| unusable_of(&own.name, name, value);
        self.check_numbers(own, now)?;
        let motion = self.held.0.as_ref().and_then(|held| held.motion.clone());
        let kind = match (self.kind, motion, &own.kind) {
            (KindState::Dynamic, ..) => Kind::Dynamic,
            (KindState::Static, ..) => Kind::Static,
            (KindState::Driven, ..) => Kind::Driven,
            (KindState::Kinematic, Some(motion), _) => Kind::Kinematic(motion),
            (KindState::Kinematic, None, Kind::Kinematic(motion)) => Kind::Kinematic(Arc::clone(motion)),
            (KindState::Kinematic, None, _) => return Err(bad("motion", "of a snapshot".to_owned())),
        };
        let mut body = own.clone();
        let is_other = core::mem::discriminant(&kind) != core::mem::discriminant(&own.kind);
        if is_other {
            // A motion would place the body at another time; the snapshot places it.
            let rebuilt = if matches!(kind, Kind::Kinematic(_)) { Kind::Driven } else { kind.clone() };
            body = own.with_kind(rebuilt, self.time)?;
        }
        body.kind = kind;
        (body.restitution, body.friction) = (self.restitution, self.friction);
        (body.damping, body.groups) = (self.damping, self.groups);
        (body.surface_velocity, body.target) = (self.surface_velocity, self.target);
        body.time = self.time;
        (body.position, body.orientation) = (self.position, self.orientation);
        (body.momentum, body.angular_momentum) = (self.momentum, self.angular_momentum);
        body.faded = self.faded.unwrap_or(f64::NEG_INFINITY);
        (body.force, body.torque) = (self.force, self.torque);
        body.horizon = self.horizon.unwrap_or(f64::INFINITY);
        (body.version, body.has_flown) = (self.version, self.has_flown);
        (body.asleep, body.quiet) = (self.asleep, self.quiet);
        body.flight = self.flight;
        if !self.is_where_it_flies(&body, now) {
            // It flies from its present place, where the next step begins and which is checked. A body that
            // no step moves stands still.
            let [linear, angular] = if body.is_awake() {
                [self.flight.linear_velocity(), self.flight.angular_velocity()]
            } else {
                [DVec3::ZERO; 2]
            };
            body.flight = ConstantTwist::try_new(self.position, self.orientation, linear, angular)
                .and_then(|twist| twist.try_with_at(body.center))
                .and_then(|twist| twist.try_with_reference_time(now))
                .map_err(|_| bad("flight of the snapshot", format!("{:?}", self.flight)))?;
        }
        body.gained = self.gained;
        (body.held, body.free, body.lead) = (false, self.free, None);
        let momenta = [("momentum", body.momentum), ("angular momentum", body.angular_momentum)];
        body.check_momenta(momenta, [DVec3::ZERO; 2])?;
        body.check_momenta([("force", self.force), ("torque", self.torque)], [self.force, self.torque])?;
        if let Some(target) = self.target {
            body.check_target(target, now)?;
        }
        Ok(body)
    }

    /// Does the flight lead to the body's place, bit by bit? Then it is kept as it was flown: a pose computed
    /// from another time has other last bits. The flight of a body that no step moves has to be at rest
    /// there.
    fn is_where_it_flies(&self, body: &RigidBody, now: f64) -> bool {
        let pose = self.flight.pose_and_twist(now).0;
        let is_there = (pose.translation, pose.rotation) == (self.position, self.orientation);
        let begins_there =
            (self.flight.position(), self.flight.orientation()) == (self.position, self.orientation);
        let fits = if body.stands_still() { is_there || begins_there } else { body.is_awake() && is_there };
        fits && self.flight.at() == body.center
    }

    fn check_numbers(&self, own: &RigidBody, now: f64) -> Result<(), SimulationError> {
        let bad = |name: &'static str, value: String| Err(unusable_of(&own.name, name, value));
        let numbers = Numbers {
            body: &own.name,
            vectors: &[("position", self.position), ("surface velocity", self.surface_velocity)],
            orientation: self.orientation,
            restitution: self.restitution,
            friction: self.friction,
            not_negative: &self.damping.rates(),
        };
        numbers.check()?;
        if !is_turn(self.orientation) {
            return bad("orientation", shown_turn(self.orientation));
        }
        let velocities = [
            ("velocity of the flight", self.flight.linear_velocity()),
            ("angular velocity of the flight", self.flight.angular_velocity()),
        ];
        if let Some((name, value)) = velocities.into_iter().find(|(_, v)| !is_small(*v)) {
            return bad(name, shown(value.to_array()));
        }
        if !(self.time.is_finite() && self.time <= now) {
            return bad("time", shown([self.time]));
        }
        if let Some(horizon) = self.horizon.filter(|horizon| !(horizon.is_finite() && *horizon >= self.time))
        {
            return bad("end of the flight", shown([horizon]));
        }
        if let Some(faded) = self.faded.filter(|faded| !faded.is_finite()) {
            return bad("end of the damping", shown([faded]));
        }
        if !self.gained.is_finite() {
            return bad("account of energy", shown([self.gained]));
        }
        // The number is counted up with each flight.
        if self.version > u64::MAX / 2 {
            return bad("number of flights", self.version.to_string());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use d2m_mesh::Faces;
    use d2m_motion::Pose;

    type Change = &'static dyn Fn(&mut BodyState);

    /// Larger than any body may have.
    const HUGE: DVec3 = DVec3::new(1e160, 0.0, 0.0);

    /// A cube that has flown for a while.
    fn flown() -> RigidBody {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.4&z=0.3").unwrap()));
        let described = Body::new("cube", Arc::clone(&tree)).with_angular_velocity(DVec3::new(1.0, 2.0, 3.0));
        let mut body = RigidBody::try_new(&described, Arc::new(Faces::new(tree.mesh())), 0.0).unwrap();
        body.fly(body.velocity(), 1.0);
        body.advance(0.3, DVec3::ZERO);
        body
    }

    /// Its poses at times between have the same bits; those of a flight that begins later would differ.
    #[test]
    fn flights_are_kept_as_they_were_flown() {
        let body = flown();
        let restored = BodyState::of(&body).restored(&body, 0.3).unwrap();
        let poses =
            |body: &RigidBody| -> Vec<Pose> { (3..10).map(|k| body.pose_at(0.1 * f64::from(k))).collect() };
        assert_eq!(poses(&restored), poses(&body));
        let mut elsewhere = BodyState::of(&body);
        elsewhere.position.x += 1.0;
        let restored = elsewhere.restored(&body, 0.3).unwrap();
        assert_eq!(restored.pose_at(0.3).translation, elsewhere.position);
    }

    #[test]
    fn numbers_that_no_body_has_are_refused_by_their_names() {
        let body = flown();
        let changes: [(&str, Change); 21] = [
            ("position", &|s| s.position.x = f64::NAN),
            ("orientation", &|s| s.orientation *= 1.001),
            ("orientation", &|s| s.orientation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            ("restitution", &|s| s.restitution = 1.5),
            ("friction", &|s| s.friction = -1.0),
            ("linear damping", &|s| s.damping.linear = f64::INFINITY),
            ("angular damping", &|s| s.damping.angular = -1.0),
            ("surface velocity", &|s| s.surface_velocity.y = f64::NAN),
            ("momentum", &|s| s.momentum = HUGE),
            ("momentum", &|s| s.momentum.z = f64::NAN),
            ("angular momentum", &|s| s.angular_momentum = HUGE),
            ("force", &|s| s.force = HUGE),
            ("torque", &|s| s.torque = HUGE),
            ("velocity of the flight", &|s| s.flight = s.flight.with_linear_velocity(HUGE)),
            ("angular velocity of the flight", &|s| s.flight = s.flight.with_angular_velocity(HUGE)),
            ("time", &|s| s.time = 0.4),
            ("end of the flight", &|s| s.horizon = Some(0.1)),
            ("end of the damping", &|s| s.faded = Some(f64::INFINITY)),
            ("account of energy", &|s| s.gained = f64::NAN),
            ("number of flights", &|s| s.version = u64::MAX),
            ("target", &|s| {
                s.target = Some(Target { position: DVec3::ZERO, orientation: DQuat::IDENTITY });
            }),
        ];
        for (name, change) in changes {
            let mut state = BodyState::of(&body);
            change(&mut state);
            let said = state.restored(&body, 0.3).map(|_| ()).unwrap_err().to_string();
            assert!(said.starts_with(&format!("body cube: {name} ")), "{name}: {said}");
        }
    }
}
