//! A motion that several queries ask the same.

use crate::{
    CertifiedState, Chain, Composition, ConstantTwist, IntervalPose, IntervalTwist, Kinematics, Pose,
    RigidMotion, Twist, TwistPiece,
};
use d2m_interval::Interval;
use glam::DVec3;
use std::sync::OnceLock;

/// Answers that are kept of each kind, and places in which one is looked for.
const PLACES: usize = 64;
const LOOKED_AT: usize = 8;

/// A motion, and what it has answered: where several queries ask the same of a motion that is expensive, the later ones look it up.
///
/// A value that is kept is the one that the motion would give again, to the bit, so that no answer depends on who asked first. Some 50 000
/// bytes.
///
/// ```
/// use d2m_motion::{ConstantTwist, KeptMotion, RigidMotion};
/// let turning = ConstantTwist::REST.with_angular_velocity(glam::DVec3::Z);
/// let kept = KeptMotion::new(&turning);
/// assert_eq!(kept.pose_and_twist(0.5), turning.pose_and_twist(0.5));
/// assert_eq!(kept.pose_and_twist(0.5), turning.pose_and_twist(0.5)); // without the sines and cosines
/// ```
pub struct KeptMotion<'a> {
    motion: &'a dyn RigidMotion,
    poses: Kept<1, (Pose, Twist)>,
    states: Kept<4, CertifiedState>,
    kinematics: Kept<2, Kinematics>,
}

impl<'a> KeptMotion<'a> {
    /// Nothing is known of it yet.
    pub fn new(motion: &'a dyn RigidMotion) -> Self {
        Self { motion, poses: Kept::new(), states: Kept::new(), kinematics: Kept::new() }
    }
}

impl core::fmt::Debug for KeptMotion<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("KeptMotion").finish_non_exhaustive()
    }
}

impl RigidMotion for KeptMotion<'_> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.poses.of([t], || self.motion.pose_and_twist(t))
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.motion.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist_rate(t)
    }
    fn domain(&self) -> Interval {
        self.motion.domain()
    }
    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.motion.smooth_until(t)
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.motion.enclose_state(t)
    }
    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        let DVec3 { x, y, z } = origin;
        self.states.of([t, x, y, z], || self.motion.enclose_state_about(t, origin))
    }
    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        self.kinematics.of([t.lo(), t.hi()], || self.motion.enclose_kinematics(t))
    }
    fn bound_acceleration(&self, t: Interval, radius: f64) -> f64 {
        self.motion.bound_acceleration(t, radius)
    }
    fn constant_twist(&self) -> Option<ConstantTwist> {
        self.motion.constant_twist()
    }
    fn constant_twist_from(&self, t: f64) -> Option<TwistPiece> {
        self.motion.constant_twist_from(t)
    }
    fn chain(&self) -> Option<&Chain> {
        self.motion.chain()
    }
    fn composition(&self) -> Option<Composition<'_>> {
        self.motion.composition()
    }
}

/// Answers by the bits of what was asked. The first ones are kept, and none gives way, so that no thread waits for another.
struct Kept<const NUMBERS: usize, T>(Box<[Place<NUMBERS, T>]>);

/// What was asked, and the answer.
type Place<const NUMBERS: usize, T> = OnceLock<([u64; NUMBERS], T)>;

impl<const NUMBERS: usize, T: Copy> Kept<NUMBERS, T> {
    fn new() -> Self {
        Self((0..PLACES).map(|_| OnceLock::new()).collect())
    }

    fn of(&self, asked: [f64; NUMBERS], answer: impl FnOnce() -> T) -> T {
        let asked = asked.map(f64::to_bits);
        let mix = |hash: u64, bits: &u64| (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        let first = asked.iter().fold(0, mix) as usize;
        for place in (0..LOOKED_AT).map(|step| &self.0[(first + step) % PLACES]) {
            match place.get() {
                Some((known, kept)) if *known == asked => return *kept,
                Some(_) => {}
                None => {
                    let found = answer();
                    // Another thread may have filled it meanwhile: then this one is not kept.
                    let _ = place.set((asked, found));
                    return found;
                }
            }
        }
        answer()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers to what differs in a single bit, or in the sign of a zero, are kept apart; more of them than there are places, too.
    #[test]
    fn nothing_is_taken_for_another() {
        let kept = Kept::<2, f64>::new();
        for round in 0..3 {
            for k in 4..500_u32 {
                let number = f64::from(k / 4);
                let asked = [number, [0.0, -0.0, number, number.next_up()][k as usize % 4]];
                assert_eq!(kept.of(asked, || f64::from(k)), f64::from(k), "round {round}");
            }
        }
    }
}
