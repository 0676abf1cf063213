//! The open trait: any rigid motion, twice differentiable piece by piece, that can enclose itself.
use crate::{CertifiedState, Chain, ConstantTwist, IntervalPose, IntervalTwist, Kinematics, Pose, Twist};
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// A piece of a motion during which its twist is constant.
///
/// ```
/// use d2m_motion::{Keyframes, Pose, RigidMotion, Span};
/// use glam::DVec3;
/// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
/// let path = Keyframes::try_new(&[(0.0, at(0.0)), (1.0, at(2.0)), (3.0, at(0.0))], Span::Linear)?;
/// let piece = path.constant_twist_from(0.5).expect("each span is a constant twist");
/// assert_eq!((piece.motion.linear_velocity(), piece.until), (DVec3::X * 2.0, Some(1.0)));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwistPiece {
    /// The motion during the piece, with its closed form.
    pub motion: ConstantTwist,
    /// When the piece ends; `None`: never.
    pub until: Option<f64>,
}

/// A rigid motion whose pose is continuous and whose acceleration is continuous piece by piece (piecewise C²), with proven
/// enclosures over intervals of time.
///
/// Promise of an implementation, for every interval `t` inside [`RigidMotion::domain`]:
/// * `enclose_pose(t)` contains the true pose, `enclose_twist(t)` the true twist and `enclose_twist_rate(t)` the
///   true derivative of the twist (acceleration of the reference point, angular acceleration) at every time of `t`;
/// * the enclosures shrink towards the values as `t` shrinks (otherwise queries get slow, never wrong);
/// * the body point `at` is the same at all times;
/// * [`RigidMotion::pose_and_twist`] is the same motion up to rounding. It proves nothing.
///
/// **Joints.** Where two C² pieces meet, twist and twist rate may jump. Such times are reported by
/// [`RigidMotion::smooth_until`]. Over an interval with an interior the enclosures hold what is inside and the
/// one-sided limits at its ends, seen from inside; at a single time, the piece that begins there (at the end of the domain: that
/// ends there). [`check_motion`](crate::check_motion) holds a motion against all this by samples.
///
/// ```
/// use d2m_interval::{Interval, IntervalVec3};
/// use d2m_motion::{IntervalPose, IntervalTwist, Pose, RigidMotion, Twist, check_motion};
/// use glam::DVec3;
///
/// /// Swings along x: x = sin t. Three functions of an interval are all that is needed.
/// struct Swing;
///
/// fn along_x(x: Interval) -> IntervalVec3 {
///     IntervalVec3 { x, ..IntervalVec3::ZERO }
/// }
///
/// impl RigidMotion for Swing {
///     fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
///         let pose = Pose { translation: DVec3::X * t.sin(), ..Pose::IDENTITY };
///         (pose, Twist { linear: DVec3::X * t.cos(), ..Twist::ZERO })
///     }
///     fn enclose_pose(&self, t: Interval) -> IntervalPose {
///         IntervalPose { translation: along_x(t.sin()), ..IntervalPose::IDENTITY }
///     }
///     fn enclose_twist(&self, t: Interval) -> IntervalTwist {
///         IntervalTwist { linear: along_x(t.cos()), angular: IntervalVec3::ZERO }
///     }
///     fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
///         IntervalTwist { linear: along_x(-t.sin()), angular: IntervalVec3::ZERO }
///     }
/// }
///
/// assert!(check_motion(&Swing, Interval::new(0.0, 6.0), 100).is_empty()); // no promise was caught broken
/// assert!(Swing.enclose_pose(Interval::new(1.0, 2.0)).translation.x.contains(1.0)); // at a quarter of a turn
/// ```
pub trait RigidMotion: Sync {
    /// Pose and twist at one time, in plain floating point.
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist);

    /// Encloses the pose over an interval of time.
    fn enclose_pose(&self, t: Interval) -> IntervalPose;

    /// Encloses the twist (world axes) over an interval of time.
    fn enclose_twist(&self, t: Interval) -> IntervalTwist;

    /// Encloses the time derivative of the twist (world axes) over an interval of time.
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist;

    /// The times at which the motion is defined; nothing is promised outside. The default is all times.
    fn domain(&self) -> Interval {
        Interval::ENTIRE
    }

    /// The end of the C² piece that begins at `t` (or holds it): the first time after `t` at which twist or twist rate
    /// may jump.
    ///
    /// `None`, the default, says that the motion is smooth from `t` to the end of its domain. A value that is not greater
    /// than `t` is a fault of the implementation.
    fn smooth_until(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }

    /// Pose and twist at one time with proven radii: what a search evaluates, once for each time.
    ///
    /// The default takes the middles of the enclosures at `t`, which is right for every motion. A motion that knows
    /// its own rounding can do it in plain floating point ([`ConstantTwist`] does, three times as fast).
    fn enclose_state(&self, t: f64) -> CertifiedState {
        let now = Interval::point(t);
        CertifiedState::from_enclosures(&self.enclose_pose(now), &self.enclose_twist(now))
    }

    /// [`RigidMotion::enclose_state`] with the position relative to the world point `origin`.
    ///
    /// A motion far from the world's origin that keeps more than one double of its position loses nothing here; the
    /// default subtracts.
    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        Kinematics::from_state(&self.enclose_state(t)).state_about(origin)
    }

    /// Pose, twist and twist rate over a span of time at once, as middles with radii.
    ///
    /// The default goes through the three enclosures.
    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        Kinematics::from_enclosures(
            &self.enclose_pose(t),
            &self.enclose_twist(t),
            &self.enclose_twist_rate(t),
        )
    }

    /// Bounds the length of the acceleration of every body point within `radius` of `at`, over an interval of
    /// time: `|v′| + (|ω′| + |ω|²)·radius`, rounded up.
    fn bound_acceleration(&self, t: Interval, radius: f64) -> f64 {
        let (twist, rate) = (self.enclose_twist(t), self.enclose_twist_rate(t));
        let length = |v: IntervalVec3| v.norm();
        let spin = length(rate.angular) + length(twist.angular).sqr();
        (length(rate.linear) + spin * Interval::point(radius)).hi()
    }

    /// The same motion as a [`ConstantTwist`] if its twist is constant, for the closed-form tests.
    fn constant_twist(&self) -> Option<ConstantTwist> {
        None
    }

    /// The constant twist that the motion follows from `t` on, if it does, and until when: searches then run on the closed
    /// form. Of two pieces that meet at `t` it is the later one.
    fn constant_twist_from(&self, t: f64) -> Option<TwistPiece> {
        let _ = t;
        self.constant_twist().map(|motion| TwistPiece { motion, until: None })
    }

    /// The motion as a [`Chain`], if it is one: two links of one arm are seen from their last common joint.
    fn chain(&self) -> Option<&Chain> {
        None
    }

    /// The motion as one inside of a moving frame, if it is one: pose(t) = outer(t)·inner(t) at each time of its domain, exactly. Two bodies that
    /// have the frame in common are seen from there.
    fn composition(&self) -> Option<Composition<'_>> {
        None
    }
}

/// A motion inside of a moving frame: see [`RigidMotion::composition`].
///
/// ```
/// use d2m_motion::{Composed, ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let round = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// let slide = ConstantTwist::REST.with_linear_velocity(DVec3::X);
/// let horse = Composed::new(round, slide);
/// let parts = horse.composition().expect("it is a motion in a frame");
/// assert_eq!((parts.outer.constant_twist(), parts.inner.constant_twist()), (Some(round), Some(slide)));
/// assert!(slide.composition().is_none());
/// ```
#[derive(Clone, Copy)]
pub struct Composition<'a> {
    /// How the frame moves.
    pub outer: &'a dyn RigidMotion,
    /// The motion in the frame.
    pub inner: &'a dyn RigidMotion,
}

/// The methods of a type that moves as another motion does, which is what the expression finds in `self`.
macro_rules! forward {
    (|$this:ident| $motion:expr) => {
        fn pose_and_twist(&self, t: f64) -> ($crate::Pose, $crate::Twist) {
            let $this = self;
            $motion.pose_and_twist(t)
        }
        fn enclose_pose(&self, t: d2m_interval::Interval) -> $crate::IntervalPose {
            let $this = self;
            $motion.enclose_pose(t)
        }
        fn enclose_twist(&self, t: d2m_interval::Interval) -> $crate::IntervalTwist {
            let $this = self;
            $motion.enclose_twist(t)
        }
        fn enclose_twist_rate(&self, t: d2m_interval::Interval) -> $crate::IntervalTwist {
            let $this = self;
            $motion.enclose_twist_rate(t)
        }
        fn domain(&self) -> d2m_interval::Interval {
            let $this = self;
            $motion.domain()
        }
        fn smooth_until(&self, t: f64) -> Option<f64> {
            let $this = self;
            $motion.smooth_until(t)
        }
        fn enclose_state(&self, t: f64) -> $crate::CertifiedState {
            let $this = self;
            $motion.enclose_state(t)
        }
        fn enclose_state_about(&self, t: f64, origin: glam::DVec3) -> $crate::CertifiedState {
            let $this = self;
            $motion.enclose_state_about(t, origin)
        }
        fn enclose_kinematics(&self, t: d2m_interval::Interval) -> $crate::Kinematics {
            let $this = self;
            $motion.enclose_kinematics(t)
        }
        fn bound_acceleration(&self, t: d2m_interval::Interval, radius: f64) -> f64 {
            let $this = self;
            $motion.bound_acceleration(t, radius)
        }
        fn constant_twist(&self) -> Option<$crate::ConstantTwist> {
            let $this = self;
            $motion.constant_twist()
        }
        fn constant_twist_from(&self, t: f64) -> Option<$crate::TwistPiece> {
            let $this = self;
            $motion.constant_twist_from(t)
        }
        fn chain(&self) -> Option<&$crate::Chain> {
            let $this = self;
            $motion.chain()
        }
        fn composition(&self) -> Option<$crate::Composition<'_>> {
            let $this = self;
            $motion.composition()
        }
    };
}
pub(crate) use forward;

impl<M: RigidMotion + ?Sized> RigidMotion for &M {
    forward!(|motion| (**motion));
}

impl<M: RigidMotion + Send + ?Sized> RigidMotion for Box<M> {
    forward!(|motion| (**motion));
}

impl<M: RigidMotion + Send + ?Sized> RigidMotion for std::sync::Arc<M> {
    forward!(|motion| (**motion));
}
