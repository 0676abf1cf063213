//! A unit of length in which the scene is about one: intervals, which are rounded by 2⁻⁵⁰⁰ at least, know no volumes of bodies of 1e-50, and
//! those of bodies of 1e110 are beyond all numbers.
use crate::{Body, Claim, Mesh, Query, Verdict};
use d2m_interval::Interval;
use d2m_motion::{CertifiedState, IntervalPose, IntervalTwist, Kinematics, Pose, RigidMotion, Twist};
use glam::DVec3;

/// Scenes between this and its inverse, 2⁶⁴, keep their unit.
const LARGEST: f64 = 18_446_744_073_709_551_616.0;

/// The bits of the exponent of a number.
const EXPONENT: u64 = 0x7ff << 52;

/// Lengths are multiplied by this, a power of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    factor: f64,
    inverse: f64,
}

impl Unit {
    /// `None`: the scene needs no other.
    pub(crate) fn of(query: &Query<'_>) -> Option<Self> {
        let sizes = query.bodies.map(|body| {
            let root = &body.mesh.nodes[0];
            (root.high - root.low).max_element().max(body.radius)
        });
        let place =
            |body: &Body<'_>, time: f64| body.motion.pose_and_twist(time).0.transform_point(body.mesh.center);
        let is_known = |time: &f64| query.bodies.iter().all(|body| body.motion.domain().contains(*time));
        let apart = [query.window.from, query.window.to].into_iter().filter(is_known).map(|time| {
            let [a, b] = query.bodies.each_ref().map(|body| place(body, time));
            (b - a).abs().max_element()
        });
        let size = sizes.into_iter().chain(apart).filter(|x| x.is_finite()).fold(0.0, f64::max);
        let inverse = f64::from_bits(size.to_bits() & EXPONENT);
        let is_far = !(LARGEST.recip()..=LARGEST).contains(&inverse);
        let factor = inverse.recip();
        (is_far && inverse.is_normal() && factor.is_normal()).then_some(Self { factor, inverse })
    }

    /// `None` where that is not exact.
    fn try_length(self, x: f64) -> Option<f64> {
        let found = x * self.factor;
        (found.is_finite() && found * self.inverse == x).then_some(found)
    }

    fn try_point(self, p: DVec3) -> Option<DVec3> {
        Some(DVec3::new(self.try_length(p.x)?, self.try_length(p.y)?, self.try_length(p.z)?))
    }

    pub(crate) fn try_meshes(self, bodies: &[Body<'_>; 2]) -> Option<[Mesh; 2]> {
        let [a, b] = bodies.each_ref().map(|body| body.mesh.try_map(|p| self.try_point(p)));
        Some([a?, b?])
    }

    pub(crate) fn motions<'a>(self, bodies: &[Body<'a>; 2]) -> [InUnit<'a>; 2] {
        bodies.each_ref().map(|body| InUnit { motion: body.motion, center: body.mesh.center, unit: self })
    }

    /// The bodies with the meshes and the motions that are their own in this unit.
    pub(crate) fn try_bodies<'a>(
        self,
        bodies: &[Body<'_>; 2],
        meshes: &'a [Mesh; 2],
        motions: &'a [InUnit<'_>; 2],
    ) -> Option<[Body<'a>; 2]> {
        let body = |k: usize| {
            let radius = self.try_length(bodies[k].radius)?;
            Some(Body { mesh: &meshes[k], motion: &motions[k], solid: bodies[k].solid, radius })
        };
        Some([body(0)?, body(1)?])
    }

    pub(crate) fn try_claim(self, claim: &Claim) -> Option<Claim> {
        let length = |x: f64| self.try_length(x);
        Some(match *claim {
            Claim::Clear { span, distance } => Claim::Clear { span, distance: length(distance)? },
            Claim::Within { span, distance, triangles } => {
                Claim::Within { span, distance: length(distance)?, triangles }
            }
            Claim::Often { span, distance, every } => {
                Claim::Often { span, distance: length(distance)?, every }
            }
            Claim::Apart { time, triangles, least, most } => {
                Claim::Apart { time, triangles, least: length(least)?, most: length(most)? }
            }
            Claim::Parted { time, along, most } => Claim::Parted { time, along, most: length(most)? },
            Claim::Held { .. } | Claim::Overlapping { .. } => claim.clone(),
            Claim::All(ref claims) => {
                Claim::All(claims.iter().map(|claim| self.try_claim(claim)).collect::<Option<_>>()?)
            }
        })
    }

    /// In the unit of the input.
    pub(crate) fn verdict(self, verdict: Verdict) -> Verdict {
        match verdict {
            Verdict::Refuted { time, triangles, distance } => {
                // Of what underflows or overflows the next number is beyond.
                let back = |x: f64, outward: fn(f64) -> f64| {
                    let found = x * self.inverse;
                    if found * self.factor == x { found } else { outward(found) }
                };
                let [lo, hi] =
                    [back(distance.lo(), f64::next_down).max(0.0), back(distance.hi(), f64::next_up)];
                let distance = Interval::try_new(lo, hi).unwrap_or(Interval::ENTIRE);
                Verdict::Refuted { time, triangles, distance }
            }
            other => other,
        }
    }
}

/// A motion in another unit of length, known by where the center of a mesh goes.
#[derive(Clone, Copy)]
pub(crate) struct InUnit<'a> {
    motion: &'a dyn RigidMotion,
    /// In the unit of the input.
    center: DVec3,
    unit: Unit,
}

impl RigidMotion for InUnit<'_> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let factor = self.unit.factor;
        let (pose, twist) = self.motion.pose_and_twist(t);
        let pose = Pose { translation: pose.translation * factor, at: pose.at * factor, ..pose };
        (pose, Twist { linear: twist.linear * factor, ..twist })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.enclose_kinematics(t).to_pose()
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.enclose_kinematics(t).to_twist()
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.enclose_kinematics(t).to_twist_rate()
    }

    fn domain(&self) -> Interval {
        self.motion.domain()
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.motion.smooth_until(t)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.enclose_state_about(t, DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        let Unit { factor, inverse } = self.unit;
        let origin_there = origin * inverse;
        if origin_there * factor != origin {
            return self.enclose_kinematics(Interval::point(t)).state_about(origin);
        }
        let there = self.motion.enclose_state_about(t, origin_there);
        there.following(self.center).in_unit_of_length(factor)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        let there = self.motion.enclose_kinematics(t);
        there.following(self.center).in_unit_of_length(self.unit.factor)
    }
}
