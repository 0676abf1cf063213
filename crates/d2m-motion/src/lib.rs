#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`RigidMotion`] is what every query asks of a motion. [`ConstantTwist`] is the one that most people use;
//! [`check_motion()`] finds out which promise a motion of your own breaks, as a [`MotionFault`].
//!
//! ## Motions of one body
//! - [`ConstantTwist`]: constant linear and angular velocity.
//! - [`ScrewMotion`]: a turn about an axis fixed in space and a slide along it.
//! - [`Keyframes`]: poses at times, each span ([`KeyframeSpan`]) joined as [`Span`] says; [`LARGEST_GAP`] is
//!   what counts as rounding between them.
//! - [`Spline`]: smooth through poses, as smooth as its [`SplineDegree`].
//! - [`AnyMotion`]: whatever has a JSON form.
//!
//! ## Arms
//! - [`Arm`]: a tree of links; [`Chain`]: one link of it.
//! - [`ArmSpan`]: all links over a span of time, as [`SpanMotion`]s.
//! - [`Joint`] and [`JointKind`]: how a link hangs on the one before; [`JointValue`] and [`JointPoints`]: its
//!   angle or length over time.
//!
//! ## Motions made of motions
//! [`Composed`]: a motion inside a moving frame ([`Composition`]). [`Retimed`]: the same way at another pace. [`KeptMotion`]: one that many queries
//! ask the same.
//!
//! ## Poses and velocities
//! - [`Pose`], [`Twist`], [`BodyTwist`]: plain numbers.
//! - [`IntervalPose`], [`IntervalTwist`]: sets that hold the true ones.
//!
//! ## For a motion of your own
//! [`Kinematics`], [`CertifiedState`] and [`Ball`] make enclosures tight, [`StateTwist`] is a motion through
//! the middle of a state, and [`TwistPiece`] says where a motion is a constant twist for a while.
//! [`FittedTwists`] are constant twists near two motions ([`MovingBall`]s) for a while, by a [`FittedClock`].
//! [`CoveredMotion`] holds a motion to the times that it covers. [`length`] and [`direction`] are those of a vector in any unit, [`angle`] that of a
//! point about an axis, [`rotation_vector`] the turn of a quaternion.
//!
//! ## Errors
//! [`MotionError`]: a description that was refused. [`OutsideDomain`]: times that a motion does not cover.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-motion")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod angle;
mod any_motion;
mod arm;
mod arm_span;
mod ball;
mod chain;
mod check_motion;
mod composed;
mod constant_twist;
mod covered_motion;
mod double_double_trig;
mod enclosed;
mod error;
mod fitted_twists;
mod joint;
mod joint_points;
mod joint_value;
mod kept_motion;
mod keyframes;
mod kinematics;
mod length;
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
#[cfg(feature = "serde")]
#[doc(hidden)]
pub mod serde_object;
mod sin_cos;
mod span_motion;
mod spline;
mod state;
mod text;
mod twist;
mod two;
mod two_jets;

pub use angle::angle;
pub use any_motion::AnyMotion;
pub use arm::Arm;
pub use arm_span::ArmSpan;
pub use ball::Ball;
pub use chain::Chain;
pub use check_motion::{MotionFault, check_motion};
pub use composed::Composed;
pub use constant_twist::ConstantTwist;
pub use covered_motion::{CoveredMotion, OutsideDomain};
pub use error::MotionError;
pub use fitted_twists::{FittedClock, FittedTwists, MovingBall};
pub use glam;
pub use joint::{Joint, JointKind};
pub use joint_points::JointPoints;
pub use joint_value::JointValue;
pub use kept_motion::KeptMotion;
pub use keyframes::{KeyframeSpan, Keyframes, LARGEST_GAP, Span};
pub use kinematics::Kinematics;
pub use length::{direction, length};
pub use pose::{IntervalPose, Pose};
pub use retimed::Retimed;
pub use rigid_motion::{Composition, RigidMotion, TwistPiece};
pub use rotation::rotation_vector;
pub use screw::ScrewMotion;
pub use span_motion::SpanMotion;
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
