#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod any_motion;
mod arm;
mod ball;
mod chain;
mod check_motion;
mod composed;
mod constant_twist;
mod covered_motion;
mod double_double_trig;
mod error;
mod joint;
mod joint_points;
mod joint_value;
mod keyframes;
mod kinematics;
mod path_jet;
mod pose;
mod relative;
mod retimed;
mod rigid_motion;
mod rotation;
mod rounding;
mod screw;
mod sequence;
#[cfg(feature = "serde")]
mod serde_any;
#[cfg(feature = "serde")]
mod serde_form;
mod sin_cos;
mod spline;
mod state;
mod text;
mod twist;
mod two;
mod two_jets;

pub use any_motion::AnyMotion;
pub use arm::Arm;
pub use ball::Ball;
pub use chain::Chain;
pub use check_motion::{MotionFault, check_motion};
pub use composed::Composed;
pub use constant_twist::ConstantTwist;
pub use covered_motion::{CoveredMotion, OutsideDomain};
pub use error::MotionError;
pub use joint::{Joint, JointKind};
pub use joint_points::JointPoints;
pub use joint_value::JointValue;
pub use keyframes::{KeyframeSpan, Keyframes, LARGEST_GAP, Span};
pub use kinematics::Kinematics;
pub use pose::{IntervalPose, Pose};
pub use retimed::Retimed;
pub use rigid_motion::{RigidMotion, TwistPiece};
pub use screw::ScrewMotion;
pub use spline::{Spline, SplineDegree};
pub use state::{CertifiedState, StateTwist};
pub use twist::{BodyTwist, IntervalTwist, Twist};
/// For the crates of this workspace: two motions seen from one body, jets of points and what they leave out.
#[doc(hidden)]
pub use {
    path_jet::{PathJet, Remainder},
    relative::{ArmPair, Frame, LeverArm, OffsetRange, RelativeMotion, RelativeState, StraightLine},
    two::TwoVec3,
    two_jets::{EdgeJets, TwoJets},
};

#[cfg(all(test, feature = "serde"))]
mod chain_tests;
#[cfg(test)]
mod tests;
