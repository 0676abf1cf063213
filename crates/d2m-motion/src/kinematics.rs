//! Pose, twist and twist rate over a span of time, each a middle value with a proven radius.
use crate::ball::{Ball, length_up, product_radius, up};
use crate::rounding::UNIT;
use crate::{CertifiedState, IntervalPose, IntervalTwist, Pose};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_lanes::two_sum;
use glam::{DMat3, DQuat, DVec3};

/// No two rotations are farther apart than this in the operator norm (and the middle is one up to rounding).
const ANY_ROTATION: f64 = 2.0 + 1e-9;

/// Where a body is, how it moves and how it accelerates, over a span of time or at one time.
///
/// Promise: at every time of the span the true rotation is within `rotation_radius` (operator norm) of `rotation`, the
/// true position of the body point `at` within `position.radius` of `position.center + position_tail`, and velocity, angular
/// velocity and their derivatives (world axes) within their balls. Composition of such sets is plain floating
/// point with a running radius, so that a chain of many joints loses some units in the last place and no more.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let flying = ConstantTwist::REST.with_linear_velocity(DVec3::X * 2.0);
/// let over = flying.enclose_kinematics(Interval::UNIT);
/// // From x = 0 to x = 2: within 1 of the middle, with the roundings.
/// assert!((over.position.center - DVec3::X).length() < 1e-12 && over.position.radius >= 1.0);
/// assert!(over.to_pose().translation.x.contains(1.5));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Body frame to world frame.
    pub rotation: DMat3,
    /// Bound of the operator norm of the error of `rotation`.
    pub rotation_radius: f64,
    /// World position of the body point [`Kinematics::at`].
    pub position: Ball,
    /// What the middle of `position` leaves out: a second double for each coordinate, for bodies far from the origin.
    pub position_tail: DVec3,
    /// The reference point (body frame, exact).
    pub at: DVec3,
    /// Velocity of the reference point, world axes.
    pub linear: Ball,
    /// Angular velocity, world axes.
    pub angular: Ball,
    /// Acceleration of the reference point, world axes.
    pub linear_rate: Ball,
    /// Angular acceleration, world axes.
    pub angular_rate: Ball,
}

impl Kinematics {
    /// At rest with body frame = world frame.
    pub const REST: Self = Self {
        rotation: DMat3::IDENTITY,
        rotation_radius: 0.0,
        position: Ball::ZERO,
        position_tail: DVec3::ZERO,
        at: DVec3::ZERO,
        linear: Ball::ZERO,
        angular: Ball::ZERO,
        linear_rate: Ball::ZERO,
        angular_rate: Ball::ZERO,
    };

    /// The balls about enclosures.
    pub fn from_enclosures(pose: &IntervalPose, twist: &IntervalTwist, rate: &IntervalTwist) -> Self {
        let state = CertifiedState::from_enclosures(pose, twist);
        Self {
            linear_rate: Ball::around_box(rate.linear),
            angular_rate: Ball::around_box(rate.angular),
            ..Self::from_state(&state)
        }
        .with_rotation(state.rotation, state.rotation_radius)
    }

    /// A state at one time, with no acceleration.
    pub(crate) fn from_state(state: &CertifiedState) -> Self {
        Self {
            rotation: state.rotation,
            rotation_radius: state.rotation_radius,
            position: Ball::new(state.position, state.position_radius),
            position_tail: DVec3::ZERO,
            at: state.at,
            linear: Ball::new(state.linear, state.linear_radius),
            angular: Ball::new(state.angular, state.angular_radius),
            linear_rate: Ball::ZERO,
            angular_rate: Ball::ZERO,
        }
    }

    /// With another rotation; a radius that says nothing becomes that of all rotations.
    pub(crate) fn with_rotation(self, rotation: DMat3, radius: f64) -> Self {
        let known = radius < ANY_ROTATION && rotation.is_finite();
        let (rotation, rotation_radius) =
            if known { (rotation, radius) } else { (DMat3::IDENTITY, ANY_ROTATION) };
        Self { rotation, rotation_radius, ..self }
    }

    /// The state with the position relative to `origin`: `(position − origin)` is rounded once.
    pub fn state_about(&self, origin: DVec3) -> CertifiedState {
        let position = (self.position.center - origin) + self.position_tail;
        // The first difference is exact up to u of itself, and so is the sum.
        let rounding = 2.0 * UNIT * (length_up(self.position.center - origin) + length_up(position));
        CertifiedState {
            rotation: self.rotation,
            position,
            at: self.at,
            linear: self.linear.center,
            angular: self.angular.center,
            rotation_radius: self.rotation_radius,
            position_radius: up(self.position.radius + rounding),
            linear_radius: self.linear.radius,
            angular_radius: self.angular.radius,
        }
    }

    /// The pose in the middle, in plain floating point; what nothing is known of is no number.
    pub(crate) fn middle_pose(&self) -> Pose {
        let is_turned = self.rotation_radius < ANY_ROTATION;
        let is_placed = self.position.radius < f64::INFINITY;
        Pose {
            rotation: if is_turned { DQuat::from_mat3(&self.rotation).normalize() } else { DQuat::NAN },
            translation: if is_placed { self.position.center + self.position_tail } else { DVec3::NAN },
            at: self.at,
        }
    }

    /// Boxes about the pose.
    pub fn to_pose(&self) -> IntervalPose {
        let entry = |x: f64| Interval::around(x, self.rotation_radius).intersection(Interval::SIGNED_UNIT);
        let t = self.rotation.transpose();
        let row = |v: DVec3| IntervalVec3::new(entry(v.x), entry(v.y), entry(v.z));
        IntervalPose {
            rotation: IntervalMat3::from_rows([row(t.x_axis), row(t.y_axis), row(t.z_axis)]),
            translation: self.position.to_box() + IntervalVec3::point(self.position_tail),
            at: self.at,
        }
    }

    /// Boxes about the twist.
    pub fn to_twist(&self) -> IntervalTwist {
        IntervalTwist { linear: self.linear.to_box(), angular: self.angular.to_box() }
    }

    /// Boxes about the twist rate.
    pub fn to_twist_rate(&self) -> IntervalTwist {
        IntervalTwist { linear: self.linear_rate.to_box(), angular: self.angular_rate.to_box() }
    }

    /// The motion of a body in a frame that itself moves so: `outer(t)·inner(t)`, over the same span.
    ///
    /// With e = R_o(x_i − at_o), w = R_o ω_i, ẋ = R_o v_i:
    /// R = R_o R_i, x = x_o + e, v = v_o + ω_o × e + ẋ, ω = ω_o + w, α = α_o + ω_o × w + R_o α_i,
    /// a = a_o + α_o × e + ω_o × (ω_o × e) + 2ω_o × ẋ + R_o a_i. The radii of the two rotations add, as
    /// R_o R_i − R̃_o R̃_i = R_o(R_i − R̃_i) + (R_o − R̃_o)R̃_i with |R̃_i| ≤ 1 + r_i; the product of the middles rounds by 3u·√3·√3
    /// in the Frobenius norm.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        self.then_with::<true>(inner)
    }

    /// The same; without `RATES` nothing is known of the accelerations, which take half of the work.
    #[inline]
    pub(crate) fn then_with<const RATES: bool>(&self, inner: &Self) -> Self {
        let turn = |b: Ball| b.turned(&self.rotation, self.rotation_radius);
        let Placed { e, position, position_tail } = self.placed(inner);
        let (relative, spin) = (turn(inner.linear), turn(inner.angular));
        let across = self.angular.cross(e);
        let (linear_rate, angular_rate) = if RATES {
            let coriolis = self.angular.cross(relative);
            let still = inner.linear_rate == Ball::ZERO && inner.angular_rate == Ball::ZERO;
            let turned_rate = |b: Ball| if still { Ball::ZERO } else { turn(b) };
            (
                self.linear_rate
                    + self.angular_rate.cross(e)
                    + self.angular.cross(across)
                    + coriolis
                    + coriolis
                    + turned_rate(inner.linear_rate),
                self.angular_rate + self.angular.cross(spin) + turned_rate(inner.angular_rate),
            )
        } else {
            (Ball::ANY, Ball::ANY)
        };
        let out = Self {
            position,
            position_tail,
            at: inner.at,
            linear: self.linear + across + relative,
            angular: self.angular + spin,
            linear_rate,
            angular_rate,
            ..*self
        };
        out.turned_by(inner)
    }

    /// As [`Kinematics::then`] for the pose alone: of velocities and accelerations nothing is known.
    #[inline]
    pub(crate) fn then_pose(&self, inner: &Self) -> Self {
        let Placed { position, position_tail, .. } = self.placed(inner);
        let out = Self {
            position,
            position_tail,
            at: inner.at,
            linear: Ball::ANY,
            angular: Ball::ANY,
            linear_rate: Ball::ANY,
            angular_rate: Ball::ANY,
            ..*self
        };
        out.turned_by(inner)
    }

    /// Where the reference point of `inner` is in this frame, from the frame's own and from the origin. What the middle of `inner.position`
    /// leaves out is turned by itself, so that a body far from the origin loses none of it.
    #[inline]
    fn placed(&self, inner: &Self) -> Placed {
        let turn = |b: Ball| b.turned(&self.rotation, self.rotation_radius);
        let arm = turn(inner.position - Ball::point(self.at));
        let rest = turn(Ball::point(inner.position_tail));
        let (sum, lost) = two_sums(self.position.center, arm.center);
        let left = self.position_tail + lost;
        let tail = left + rest.center;
        // Without a rest the second sum is exact.
        let summed = if rest == Ball::ZERO { length_up(left) } else { length_up(left) + length_up(tail) };
        let radius = up(self.position.radius + arm.radius + rest.radius + UNIT * summed);
        Placed {
            e: arm + rest,
            position: Ball::new(sum, radius),
            position_tail: if tail.is_finite() { tail } else { DVec3::ZERO },
        }
    }

    /// With the product of this rotation and that of `inner`.
    #[inline]
    fn turned_by(self, inner: &Self) -> Self {
        // A product with the identity is exact.
        if inner.rotation_radius == 0.0 && inner.rotation == DMat3::IDENTITY {
            return self;
        }
        let radius = product_radius(self.rotation_radius, inner.rotation_radius);
        self.with_rotation(self.rotation * inner.rotation, radius)
    }

    /// The same motion expressed by another body point: with e = R(at − at₀) the point is at x + e, moves with v + ω × e and
    /// accelerates with a + α × e + ω × (ω × e).
    #[must_use]
    pub fn following(&self, at: DVec3) -> Self {
        if at == self.at {
            return *self;
        }
        let shift = Self { position: Ball::point(at), at, ..Self::REST };
        Self { rotation: self.rotation, rotation_radius: self.rotation_radius, ..self.then(&shift) }
    }

    /// The same set on a clock of which a unit is, within `error`, `unit` of this one's: velocities times that number, accelerations times its
    /// square. A negative unit runs backwards. Of a radius that is negative or no number nothing is known.
    ///
    /// ```
    /// use d2m_motion::{Ball, Kinematics};
    /// use glam::DVec3;
    /// let falling = Kinematics { linear_rate: Ball::point(DVec3::Z * -10.0), linear: Ball::point(DVec3::X), ..Kinematics::REST };
    /// let slowly = falling.in_unit_of_time(0.1, 0.0); // of a tenth of a second
    /// assert!((slowly.linear.center - DVec3::X * 0.1).length() <= slowly.linear.radius);
    /// assert!((slowly.linear_rate.center - DVec3::Z * -0.1).length() <= slowly.linear_rate.radius);
    /// assert!(slowly.linear_rate.radius < 1e-15);
    /// ```
    #[must_use]
    pub fn in_unit_of_time(&self, unit: f64, error: f64) -> Self {
        let once = |ball: Ball| if ball.radius >= 0.0 { ball.times(unit, error) } else { Ball::ANY };
        Self {
            linear: once(self.linear),
            angular: once(self.angular),
            linear_rate: once(once(self.linear_rate)),
            angular_rate: once(once(self.angular_rate)),
            ..*self
        }
    }

    /// The same set with lengths times `factor`, a power of two: exact but for what over- or underflows. Where the body point cannot be
    /// multiplied exactly, or by another factor, nothing is known but the rotation and its rates.
    ///
    /// ```
    /// use d2m_motion::{Ball, Kinematics};
    /// use glam::DVec3;
    /// let tiny = Kinematics { position: Ball::new(DVec3::X * 3e-200, 1e-210), ..Kinematics::REST };
    /// let factor = f64::from_bits(1600 << 52); // 2⁵⁷⁷
    /// let found = tiny.in_unit_of_length(factor);
    /// assert_eq!(found.position.center, DVec3::X * 3e-200 * factor);
    /// assert_eq!(tiny.in_unit_of_length(3.0).position.radius, f64::INFINITY); // nothing is known
    /// ```
    #[must_use]
    pub fn in_unit_of_length(&self, factor: f64) -> Self {
        let inverse = factor.recip();
        let is_exact = |v: DVec3| (v * factor) * inverse == v && (v * factor).is_finite();
        let is_power =
            factor.is_normal() && inverse.is_normal() && factor.to_bits() << 12 == 0 && factor > 0.0;
        let times = |ball: Ball| {
            if !(is_power && is_exact(self.at) && ball.radius >= 0.0) {
                return Ball::ANY;
            }
            let (center, radius) = (ball.center * factor, ball.radius * factor);
            // What underflows is off by half of the least number in each component.
            let lost = if is_exact(ball.center) { 0.0 } else { f64::MIN_POSITIVE };
            let is_kept = radius * inverse == ball.radius && lost == 0.0;
            Ball::new(center, if is_kept { radius } else { up(radius + f64::MIN_POSITIVE) })
        };
        let tail = self.position_tail * factor;
        let is_tail = is_exact(self.position_tail);
        let position = if is_tail { self.position } else { self.position + Ball::point(self.position_tail) };
        Self {
            position: times(position),
            position_tail: if is_tail { tail } else { DVec3::ZERO },
            at: self.at * factor,
            linear: times(self.linear),
            linear_rate: times(self.linear_rate),
            ..*self
        }
    }

    /// A set that contains this one and another (of the same reference point).
    #[must_use]
    pub fn hull(&self, other: &Self) -> Self {
        let place = |k: &Self| k.position + Ball::point(k.position_tail);
        // Middle of the two; a matrix between two rotations is within half their distance of both.
        let middle = (self.rotation + other.rotation) * 0.5;
        let half = 0.5 * frobenius_up(&(self.rotation + other.rotation * -1.0)) + 4.0 * UNIT;
        let wide = up(half + self.rotation_radius.max(other.rotation_radius));
        Self {
            position: place(self).hull(place(other)),
            position_tail: DVec3::ZERO,
            linear: self.linear.hull(other.linear),
            angular: self.angular.hull(other.angular),
            linear_rate: self.linear_rate.hull(other.linear_rate),
            angular_rate: self.angular_rate.hull(other.angular_rate),
            ..*self
        }
        .with_rotation(middle, wide)
    }
}

/// A point of a frame, seen from the frame's reference point (world axes) and from the world's origin.
struct Placed {
    e: Ball,
    position: Ball,
    position_tail: DVec3,
}

/// Sums, coordinate by coordinate, and what they lose.
pub(crate) fn two_sums(a: DVec3, b: DVec3) -> (DVec3, DVec3) {
    let [x, y, z] = [0, 1, 2].map(|i| two_sum(a[i], b[i]));
    (DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1))
}

fn frobenius_up(m: &DMat3) -> f64 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(length_up);
    up((x * x + y * y + z * z).sqrt())
}
