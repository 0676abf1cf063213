//! A smooth piece of any motion, expressed in other units of length and time.
use crate::units::{Units, scaled_vector};
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::scaled;
use d2m_motion::{CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};

/// Exponents of the unit of time beyond which times of a motion are subnormal: its enclosures are not queried there.
const LARGEST_TIME_EXPONENT: i32 = 900;

/// A motion with lengths and times multiplied by powers of two, up to the end of one of its smooth pieces.
#[derive(Clone, Copy)]
pub(crate) struct MotionInUnits<'a> {
    source: Source<'a>,
    units: Units,
    /// The end of the smooth piece, if the motion may have another twist from there on.
    joint: Option<f64>,
}

#[derive(Clone, Copy)]
enum Source<'a> {
    /// In the units already.
    Twist(ConstantTwist),
    /// In the units of the input.
    Any(&'a dyn RigidMotion),
}

impl<'a> MotionInUnits<'a> {
    /// `None` where a number overflows or no time could be expressed exactly.
    pub(crate) fn try_new(
        motion: &'a dyn RigidMotion,
        units: &Units,
        start: f64,
        joint: Option<f64>,
    ) -> Option<Self> {
        let source = match motion.constant_twist() {
            Some(twist) => Source::Twist(units.try_motion(&twist, start)?),
            None if units.time_exponent().abs() <= LARGEST_TIME_EXPONENT => Source::Any(motion),
            None => return None,
        };
        Some(Self { source, units: *units, joint })
    }

    /// An interval of times in the units of the input: exact for normal numbers.
    fn times_back(&self, t: Interval) -> Interval {
        Interval::try_new(self.units.time_down(t.lo()), self.units.time_up(t.hi()))
            .unwrap_or(Interval::ENTIRE)
    }
}

/// `i·2ᵏ`, rounded outward where it is subnormal; everything where it overflows.
fn scaled_interval(i: Interval, k: i32) -> Interval {
    let end = |x: f64, outward: fn(f64) -> f64| {
        let there = scaled(x, k);
        if there.abs() < f64::MIN_POSITIVE && x != 0.0 { outward(there) } else { there }
    };
    let (lo, hi) = (end(i.lo(), f64::next_down), end(i.hi(), f64::next_up));
    if lo.is_finite() && hi.is_finite() {
        Interval::try_new(lo, hi).unwrap_or(Interval::ENTIRE)
    } else {
        Interval::ENTIRE
    }
}

fn scaled_box(v: IntervalVec3, k: i32) -> IntervalVec3 {
    IntervalVec3::new(scaled_interval(v.x, k), scaled_interval(v.y, k), scaled_interval(v.z, k))
}

impl RigidMotion for MotionInUnits<'_> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        match &self.source {
            Source::Twist(motion) => motion.pose_and_twist(t),
            Source::Any(motion) => {
                let (pose, twist) = motion.pose_and_twist(self.units.time_down(t));
                let translation = self.units.point(pose.translation);
                let linear = scaled_vector(twist.linear, self.units.speed_exponent());
                let angular = scaled_vector(twist.angular, self.units.time_exponent());
                (Pose { translation, at: self.units.point(pose.at), ..pose }, Twist { linear, angular })
            }
        }
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        match &self.source {
            Source::Twist(motion) => motion.enclose_pose(t),
            Source::Any(motion) => {
                let pose = motion.enclose_pose(self.times_back(t));
                let translation = scaled_box(pose.translation, -self.units.length_exponent());
                IntervalPose { translation, at: self.units.point(pose.at), ..pose }
            }
        }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        match &self.source {
            Source::Twist(motion) => motion.enclose_twist(t),
            Source::Any(motion) => {
                let twist = motion.enclose_twist(self.times_back(t));
                IntervalTwist {
                    linear: scaled_box(twist.linear, self.units.speed_exponent()),
                    angular: scaled_box(twist.angular, self.units.time_exponent()),
                }
            }
        }
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        match &self.source {
            Source::Twist(motion) => motion.enclose_twist_rate(t),
            Source::Any(motion) => {
                let rate = motion.enclose_twist_rate(self.times_back(t));
                let time = self.units.time_exponent();
                IntervalTwist {
                    linear: scaled_box(rate.linear, self.units.speed_exponent() + time),
                    angular: scaled_box(rate.angular, 2 * time),
                }
            }
        }
    }

    /// At the joint that ends the piece, twists are those of the piece and not of the next one.
    fn enclose_state(&self, t: f64) -> CertifiedState {
        let motion = match &self.source {
            Source::Twist(motion) => return motion.enclose_state(t),
            Source::Any(motion) => *motion,
        };
        let units = &self.units;
        let there = units.time_down(t);
        let state = if self.joint == Some(there) {
            let before = Interval::new(there.next_down(), there);
            let pose = motion.enclose_pose(Interval::point(there));
            CertifiedState::from_enclosures(&pose, &motion.enclose_twist(before))
        } else {
            motion.enclose_state(there)
        };
        units.state(&state)
    }
}
