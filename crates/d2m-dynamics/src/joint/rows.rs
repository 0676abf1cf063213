//! Joints of the bodies of a simulation, and their rows in the contact solver.

use crate::SimulationError;
use crate::body::rigid_body::RigidBody;
use crate::joint::description::{Joint, JointKind, Motor, MotorTarget};
use crate::joint::force::{Acted, TAKEN_BACK};
use crate::numbers::{FINITE, NOT_NEGATIVE, UNUSABLE, direction, is_small};
use crate::shown::{shown, shown_turn};
use d2m_contact::{ContactPoint, JointPart, JointRow, Law, Material, tangents};
use d2m_feature::FeaturePair;
use d2m_motion::rotation_vector;
use glam::{BVec3, DQuat, DVec3};

/// A joint between two bodies of the list, the second one perhaps the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Joined {
    pub(crate) joint: Joint,
    pub(crate) bodies: [usize; 2],
    /// From the centers to the point, and the axis, in the axes of the bodies.
    arms: [DVec3; 2],
    axes: [DVec3; 2],
    /// The turn of the second body's axes against those of the first one.
    turn: DQuat,
    /// The last value, and when that was computed: angles go on beyond half a turn.
    value: f64,
    looked: f64,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) acted: Acted,
    /// The impulse of its motor, in a step that an error ended early, beyond that of its largest force in the time
    /// that was flown.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) owed: f64,
    /// Was the joint removed, or one of its bodies?
    is_gone: bool,
}

/// The flight for which rows are made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead {
    pub(crate) length: f64,
    pub(crate) step: f64,
    /// How much of the step has passed, and the impulse of the joint's motor in it.
    pub(crate) passed: f64,
    pub(crate) spent: f64,
}

/// The error that refuses a joint of these bodies for a value.
fn unusable([a, b]: [&RigidBody; 2], name: &'static str, value: String) -> SimulationError {
    let [a, b] = [a, b].map(|body| body.name.to_string());
    SimulationError::BadJoint { a, b, name, value, reason: UNUSABLE }
}

impl Joined {
    pub(crate) fn try_new(
        joint: &Joint,
        places: [usize; 2],
        [a, b]: [&RigidBody; 2],
    ) -> Result<Self, SimulationError> {
        let bad = |name: &'static str, value: String| Err(unusable([a, b], name, value));
        Self::check_numbers(joint, [a, b])?;
        let axis = direction(joint.axis).unwrap_or_default();
        if places[0] == places[1] || !(a.is_dynamic() || b.is_dynamic()) {
            return bad("pair", "without a dynamic body, or of a body with itself,".to_owned());
        }
        let is_locked = matches!(joint.kind, JointKind::Locked { .. });
        if is_locked && joint.b.is_some() {
            return bad("second body", "of a lock, which holds to the world only,".to_owned());
        }
        let point = if is_locked { a.position } else { joint.point };
        let own = |body: &RigidBody, v: DVec3| body.orientation.conjugate() * v;
        let arms = [own(a, point - a.position), own(b, point - b.position)];
        if !arms.iter().all(|arm| is_small(*arm)) {
            return bad("point", shown(point.to_array()));
        }
        Ok(Self {
            joint: joint.clone(),
            bodies: places,
            arms,
            axes: [own(a, axis), own(b, axis)],
            turn: a.orientation.conjugate() * b.orientation,
            value: 0.0,
            looked: a.time.max(b.time),
            acted: Acted::default(),
            owed: 0.0,
            is_gone: false,
        })
    }

    /// Checks the numbers of a joint of these bodies, given or read.
    pub(crate) fn check_numbers(joint: &Joint, [a, b]: [&RigidBody; 2]) -> Result<(), SimulationError> {
        let bad = |name: &'static str, value: String, reason: &'static str| {
            let [a, b] = [a, b].map(|body| body.name.to_string());
            Err(SimulationError::BadJoint { a, b, name, value, reason })
        };
        if !joint.point.is_finite() {
            return bad("point", shown(joint.point.to_array()), FINITE);
        }
        if direction(joint.axis).is_none() {
            return bad("axis", shown(joint.axis.to_array()), "has no direction");
        }
        if let Some(limits) = joint.limits.filter(|[lo, hi]| !(lo.is_finite() && hi.is_finite() && lo <= hi))
        {
            return bad("limits", format!("{limits:?}"), "must be finite, the lower one first");
        }
        let motor = joint.motor.iter().flat_map(|motor| {
            let (MotorTarget::Velocity(aim) | MotorTarget::Position(aim)) = motor.target;
            let most = if motor.most == f64::INFINITY { 0.0 } else { motor.most };
            [
                ("motor", aim.abs()),
                ("motor max", most),
                ("motor stiffness", motor.stiffness),
                ("motor damping", motor.damping),
            ]
        });
        let spring = joint.spring.iter().flat_map(|spring| {
            [
                ("spring stiffness", spring.stiffness),
                ("spring damping", spring.damping),
                ("spring rest", spring.rest.abs()),
            ]
        });
        let numbers = motor.chain(spring).chain([("friction", joint.friction)]);
        for (name, value) in numbers {
            if !(value.is_finite() && value >= 0.0) {
                return bad(name, shown([value]), NOT_NEGATIVE);
            }
        }
        Ok(())
    }

    /// Checks a joint of a snapshot: is it one of these bodies? Both may be static by now.
    pub(crate) fn check(&self, bodies: [&RigidBody; 2]) -> Result<(), SimulationError> {
        let [a, b] = bodies;
        Self::check_numbers(&self.joint, bodies)?;
        let is_pair = a.id != b.id && self.joint.a == a.id && self.joint.b.is_none_or(|named| named == b.id);
        let is_locked = matches!(self.joint.kind, JointKind::Locked { .. });
        let fault = if !is_pair || (is_locked && self.joint.b.is_some()) {
            Some(("pair", format!("{:?}", self.bodies)))
        } else if !self.arms.iter().all(|arm| is_small(*arm)) {
            Some(("arms", format!("{:?}", self.arms)))
        } else if !(self.axes.iter().all(|axis| axis.is_normalized()) && self.turn.is_normalized()) {
            Some(("axes", format!("{:?}, {}", self.axes, shown_turn(self.turn))))
        } else if !self.acted.is_known() {
            Some(("times of the forces", format!("{:?}", self.acted)))
        } else if !is_small(DVec3::X * self.owed) {
            Some(("motor's impulse", shown([self.owed])))
        } else {
            (!is_small(DVec3::new(self.value, self.looked, 0.0)))
                .then(|| ("value and its time", shown([self.value, self.looked])))
        };
        fault.map_or(Ok(()), |(name, value)| Err(unusable([a, b], name, value)))
    }

    pub(crate) fn has(&self, body: usize) -> bool {
        !self.is_gone && self.bodies.contains(&body)
    }

    /// The center of a body has become another point of it, at `by` in its axes. Locks hold at the new
    /// center.
    pub(crate) fn center_moved(&mut self, body: usize, by: DVec3) {
        if matches!(self.joint.kind, JointKind::Locked { .. }) {
            return;
        }
        for (arm, place) in self.arms.iter_mut().zip(self.bodies) {
            if place == body {
                *arm -= by;
            }
        }
    }

    /// The axis in the world, if this is the orientation of the first body.
    pub(crate) fn axis(&self, first: DQuat) -> DVec3 {
        first * self.axes[0]
    }

    /// Does it connect bodies, rather than lock axes of one in the world?
    pub(crate) fn is_between_bodies(&self) -> bool {
        !matches!(self.joint.kind, JointKind::Locked { .. })
    }

    /// A joint that holds the bodies as they are, at the same point.
    pub(crate) fn fixed_at(&self, [a, b]: [&RigidBody; 2]) -> Self {
        let point = b.position + b.orientation * self.arms[1];
        let joint = Joint { kind: JointKind::Fixed, limits: None, ..self.joint.clone() };
        Self {
            joint,
            arms: [a.orientation.conjugate() * (point - a.position), self.arms[1]],
            turn: a.orientation.conjugate() * b.orientation,
            ..self.clone()
        }
    }

    pub(crate) fn take_out(&mut self) {
        self.is_gone = true;
    }

    /// Does a motor or a spring act at it?
    pub(crate) fn drives(&self) -> bool {
        !self.is_gone() && (self.joint.motor.is_some() || self.joint.spring.is_some())
    }

    /// Does a motor of unbounded force hold its value?
    pub(crate) fn holds(&self) -> bool {
        let is_hard = |motor: &Motor| motor.most == f64::INFINITY && motor.hard_rate(0.0, 1.0).is_some();
        !self.is_gone() && self.joint.motor.as_ref().is_some_and(is_hard)
    }

    pub(crate) fn is_gone(&self) -> bool {
        self.is_gone
    }

    /// The value where the bodies are: the angle or the length.
    pub(crate) fn value(&self, bodies: [&RigidBody; 2]) -> f64 {
        let poses = bodies.map(|body| (body.position, body.orientation));
        self.value_at(poses, self.value + self.turned(bodies))
    }

    /// The value in these poses: of angles, which poses give up to full turns, the one nearest to `about`.
    pub(crate) fn value_at(&self, [(xa, qa), (xb, qb)]: [(DVec3, DQuat); 2], about: f64) -> f64 {
        match self.joint.kind {
            JointKind::Revolute => {
                let off = rotation_vector(qb * (qa * self.turn).conjugate());
                let angle = off.dot(qa * self.axes[0]);
                let turns = ((about - angle) / core::f64::consts::TAU).round();
                angle + turns * core::f64::consts::TAU
            }
            JointKind::Prismatic => {
                ((xb + qb * self.arms[1]) - (xa + qa * self.arms[0])).dot(qa * self.axes[0])
            }
            JointKind::Fixed | JointKind::Spherical | JointKind::Locked { .. } => 0.0,
        }
    }

    /// How far the second body has turned against the first one about the axis in their present flights,
    /// since the last value.
    fn turned(&self, [a, b]: [&RigidBody; 2]) -> f64 {
        let turned = |body: &RigidBody| {
            let since = body.flight.reference_time().max(self.looked);
            body.present_velocity().angular * (body.time - since).max(0.0)
        };
        (turned(b) - turned(a)).dot(a.orientation * self.axes[0])
    }

    /// Keeps the value where flights end: poses give it up to full turns, and flights give the number of
    /// these.
    pub(crate) fn look(&mut self, pair: [&RigidBody; 2]) {
        self.value = self.value(pair);
        self.looked = pair[0].time.max(pair[1].time);
    }

    /// The position errors of the joint in these poses, along each of its equations.
    pub(crate) fn offs(&self, [(xa, qa), (xb, qb)]: [(DVec3, DQuat); 2]) -> Vec<f64> {
        let away = (xb + qb * self.arms[1]) - (xa + qa * self.arms[0]);
        let tilted = match self.joint.kind {
            JointKind::Revolute => (qa * self.axes[0]).cross(qb * self.axes[1]),
            JointKind::Spherical => DVec3::ZERO,
            JointKind::Fixed | JointKind::Prismatic | JointKind::Locked { .. } => {
                rotation_vector(qb * (qa * self.turn).conjugate())
            }
        };
        let along = |v: DVec3| move |direction: &DVec3| v.dot(*direction);
        let (linear, angular) = self.directions(qa);
        linear.iter().map(along(away)).chain(angular.iter().map(along(tilted))).collect()
    }

    /// No position from which its errors are computed is further from the origin.
    pub(crate) fn extent(&self, poses: [(DVec3, DQuat); 2]) -> f64 {
        let far = poses.iter().zip(self.arms).map(|((position, _), arm)| position.length() + arm.length());
        far.fold(0.0, f64::max)
    }

    /// The directions of the equations: of displacements, and of turns.
    fn directions(&self, qa: DQuat) -> (Vec<DVec3>, Vec<DVec3>) {
        let all = vec![DVec3::X, DVec3::Y, DVec3::Z];
        let across: Vec<DVec3> = tangents(self.axes[0]).into_iter().map(|t| qa * t).collect();
        match self.joint.kind {
            JointKind::Fixed => (all.clone(), all),
            JointKind::Revolute => (all, across),
            JointKind::Prismatic => (across, all),
            JointKind::Spherical => (all, Vec::new()),
            JointKind::Locked { ways, turns } => {
                let locked = |axes: BVec3| (0..3).filter(|&k| axes.test(k)).map(|k| all[k]).collect();
                (locked(ways), locked(turns))
            }
        }
    }

    /// Is it a turn about a single locked axis? That has a rate, and no position from which it could drift.
    fn is_of_a_rate(&self, row: &JointRow) -> bool {
        let is_one = |turns: BVec3| turns.bitmask().is_power_of_two();
        matches!(self.joint.kind, JointKind::Locked { turns, .. } if row.is_angular && is_one(turns))
    }

    /// The position errors that the equations may have at the end of a flight from here.
    pub(crate) fn aims(&self, poses: [(DVec3, DQuat); 2], length: f64, step: f64) -> Vec<f64> {
        let left = 1.0 - TAKEN_BACK * (length / step).min(1.0);
        self.offs(poses).into_iter().map(|off| left * off).collect()
    }

    /// The rows of the next flight. Impulses act where the bodies are now. The rates of equations are
    /// corrected until the flight ends where it should ([`Self::aims`]); that is the method SHAKE:
    /// symplectic, so that energy does not drift. So are those of the value, until they are its mean rates in
    /// the flight: a slide that turns would move out of its limits otherwise, since bodies fly straight.
    pub(crate) fn rows(&self, number: usize, pair: [&RigidBody; 2], ahead: Ahead) -> Vec<ContactPoint> {
        let arms = [0, 1].map(|k| pair[k].orientation * self.arms[k]);
        let points = [0, 1].map(|k| pair[k].position + arms[k]);
        let axis = pair[0].orientation * self.axes[0];
        let mut made = Made { joined: self, number, arms, point: points[1], rows: Vec::new() };
        // Both arms reach to one point, so that impulses add no angular momentum: to that of b, which differs on
        // a slide.
        if matches!(self.joint.kind, JointKind::Locked { .. }) {
            // The world has no angular momentum to keep: locks act at the center.
            made.arms[1] = points[0] - pair[1].position;
        } else {
            made.arms[0] = arms[0] + (points[1] - points[0]);
        }
        let law = Law::Range { lo: f64::NEG_INFINITY, hi: f64::INFINITY, softness: 0.0 };
        let equal = JointRow::still(law);
        let (linear, angular) = self.directions(pair[0].orientation);
        for direction in linear {
            made.add(direction, equal);
        }
        for direction in angular {
            made.add(direction, JointRow { is_angular: true, ..equal });
        }
        let count = made.rows.len();
        for (slot, row) in made.rows[..count].iter_mut().enumerate() {
            let part = JointPart::Equation { joint: number, number: slot };
            row.row = row.row.map(|row| if self.is_of_a_rate(&row) { row } else { JointRow { part, ..row } });
        }
        if matches!(self.joint.kind, JointKind::Revolute | JointKind::Prismatic) {
            self.along(&mut made, axis, self.value(pair), ahead);
        }
        made.rows
    }

    /// Limits, spring, motor and friction of the value.
    fn along(&self, made: &mut Made<'_>, axis: DVec3, value: f64, ahead: Ahead) {
        let is_angular = self.joint.kind == JointKind::Revolute;
        let part = JointPart::Value { joint: made.number };
        let row = |law: Law, pushing: f64, target: f64| JointRow {
            is_angular,
            law,
            pushing,
            target,
            part,
            is_motor: false,
        };
        let h = ahead.length;
        // The rates that limits allow.
        let (mut slowest, mut fastest) = (f64::NEG_INFINITY, f64::INFINITY);
        if let Some([lo, hi]) = self.joint.limits {
            let push = Law::Range { lo: 0.0, hi: f64::INFINITY, softness: 0.0 };
            let least_of = |room: f64| if room >= 0.0 { -room / h } else { -TAKEN_BACK * room / ahead.step };
            let [up, down] = [least_of(value - lo), least_of(hi - value)];
            made.add(axis, row(push, up.min(0.0), up));
            made.add(-axis, row(push, down.min(0.0), down));
            (slowest, fastest) = (up.min(0.0), -down.min(0.0));
        }
        let motor = self.joint.motor;
        if let Some((motor, rate)) =
            motor.and_then(|motor| Some((motor, motor.hard_rate(value, ahead.step)?)))
        {
            // In a step that is flown in parts it brings about its rate in each, with the impulse that it has
            // not used so far.
            let most = motor.most * (ahead.passed + h);
            let [lo, hi] = [(-most - ahead.spent).min(0.0), (most - ahead.spent).max(0.0)];
            let law = Law::Range { lo, hi, softness: 0.0 };
            // No rates obey both a limit and a motor of unbounded force that leads beyond it.
            let rate = rate.min(fastest).max(slowest);
            made.add(axis, JointRow { is_motor: true, ..row(law, rate, rate) });
        }
        for (number, (law, rate)) in self.joint.laws_of_forces(value, h).into_iter().enumerate() {
            let part = JointPart::Force { joint: made.number, number };
            made.add(axis, JointRow { part, ..row(law, rate, rate) });
        }
    }
}

struct Made<'j> {
    joined: &'j Joined,
    number: usize,
    arms: [DVec3; 2],
    point: DVec3,
    rows: Vec<ContactPoint>,
}

impl Made<'_> {
    fn add(&mut self, direction: DVec3, row: JointRow) {
        let feature = FeaturePair::VertexFace { vertex: self.rows.len() as u32, face: self.number as u32 };
        let still = ContactPoint::new(self.joined.bodies, self.arms, direction, Material::new(0.0, 0.0));
        self.rows.push(ContactPoint { feature, point: self.point, row: Some(row), ..still });
    }
}
