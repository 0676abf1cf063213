//! How points of one body move in the frame of the other, enclosed over a span of time.

use super::jet::PointJet;
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::DVec3;

/// The motion of a *mover* seen from the frame of an *observer*, for any pair of rigid motions.
///
/// With poses x, R, twists v, ω and their rates in the world (one letter for the mover, another for the observer),
/// g = x_m − x_o, u = v_m − v_o, z = R_m r̂ and Ω = ω_m − ω_o, a point r of the mover (r̂ = r − at_m) is at
///
/// ```text
/// q  = R_oᵀ (g + z) + at_o
/// q′ = R_oᵀ (u − ω_o × g + Ω × z)
/// q″ = R_oᵀ (u′ − ω_o′ × g − 2 ω_o × u + ω_o × (ω_o × g) + [Ω′ + ω_m × ω_o] × z + Ω × (Ω × z))
/// ```
///
/// (Appendix A of the paper gives the same derivatives in the world; the functions f of the paper are scalars and do
/// not depend on the frame. In the observer's frame its own features stand still.)
///
/// Scene recentering: for two motions with constant twist the world positions enter only as x_m(t_ref) − x_o(t_ref),
/// so a common offset of the scene costs nothing.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::RelativeMotion;
/// use glam::DVec3;
/// let (train, platform) = (ConstantTwist::REST.with_linear_velocity(DVec3::X), ConstantTwist::REST);
/// let seen = RelativeMotion::new(&train, &platform);
/// assert!(seen.placement(2.0).enclose_point(DVec3::ZERO).x.contains(2.0));
/// assert!(seen.swapped().placement(2.0).enclose_point(DVec3::ZERO).x.contains(-2.0));
/// ```
#[derive(Clone, Copy)]
pub struct RelativeMotion<'a> {
    mover: &'a dyn RigidMotion,
    observer: &'a dyn RigidMotion,
    constant_twists: Option<[ConstantTwistBody; 2]>,
}

impl core::fmt::Debug for RelativeMotion<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("RelativeMotion")
            .field("constant_twists", &self.constant_twists)
            .finish_non_exhaustive()
    }
}

/// A motion with constant twist, its rotation prepared: R(t) = R₀ + sin θ·K R₀ + (1 − cos θ)·K² R₀ with θ = |ω|(t −
/// t_ref) and K = \[ω/|ω|\] (Rodrigues).
#[derive(Clone, Copy, Debug)]
struct ConstantTwistBody {
    motion: ConstantTwist,
    spin: Interval,
    terms: [IntervalMat3; 3],
}

impl ConstantTwistBody {
    fn new(motion: ConstantTwist) -> Self {
        let spin = IntervalVec3::point(motion.angular_velocity()).norm();
        let start = IntervalMat3::from_quat_normalized(motion.orientation());
        let mut terms = [start; 3];
        if spin.lo() > 0.0 {
            let axis = IntervalVec3::point(motion.angular_velocity()) * spin.recip();
            terms[1] = skew(axis).mul_mat(start);
            terms[2] = skew_squared(axis).mul_mat(start);
        }
        Self { motion, spin, terms }
    }

    fn rotation(&self, t: Interval) -> IntervalMat3 {
        if self.motion.angular_velocity() == DVec3::ZERO {
            return self.terms[0];
        }
        if self.spin.lo() <= 0.0 {
            // |ω|² underflows: leave it to the motion itself.
            return self.motion.enclose_pose(t).rotation;
        }
        let (sin, cos) = (self.spin * (t - self.motion.reference_time())).sin_cos();
        let versine = 1.0 - cos;
        let [r, s, v] = self.terms.map(IntervalMat3::rows);
        IntervalMat3::from_rows(core::array::from_fn(|i| r[i] + s[i] * sin + v[i] * versine))
    }
}

/// Everything of both bodies at the times of a span, world axes.
struct State {
    mover: IntervalMat3,
    mover_inverse: IntervalMat3,
    observer_inverse: IntervalMat3,
    at_mover: DVec3,
    at_observer: DVec3,
    /// g, u, u′.
    offset: IntervalVec3,
    velocity: IntervalVec3,
    acceleration: IntervalVec3,
    /// ω_m, ω_o, ω_m′, ω_o′.
    spin_mover: IntervalVec3,
    spin_observer: IntervalVec3,
    spin_rate_mover: IntervalVec3,
    spin_rate_observer: IntervalVec3,
}

impl<'a> RelativeMotion<'a> {
    /// The motion of `mover` seen from `observer`.
    pub fn new(mover: &'a dyn RigidMotion, observer: &'a dyn RigidMotion) -> Self {
        let twists = mover.constant_twist().zip(observer.constant_twist());
        Self { mover, observer, constant_twists: twists.map(|(m, o)| [m, o].map(ConstantTwistBody::new)) }
    }

    /// The roles exchanged.
    pub fn swapped(&self) -> Self {
        let constant_twists = self.constant_twists.map(|[m, o]| [o, m]);
        Self { mover: self.observer, observer: self.mover, constant_twists }
    }

    /// The mover as it stands in the observer's frame at one time.
    pub fn placement(&self, t: f64) -> Placement {
        let s = self.state(Interval::point(t));
        Placement {
            rotation: s.observer_inverse.mul_mat(s.mover),
            offset: s.observer_inverse.mul_vec(s.offset) + s.at_observer,
            at_mover: s.at_mover,
        }
    }

    fn state(&self, t: Interval) -> State {
        if let Some([m, o]) = &self.constant_twists {
            let mover = m.rotation(t);
            return State {
                mover,
                mover_inverse: mover.transpose(),
                observer_inverse: o.rotation(t).transpose(),
                at_mover: m.motion.at(),
                at_observer: o.motion.at(),
                offset: linear_offset(&m.motion, &o.motion, t),
                velocity: IntervalVec3::point(m.motion.linear_velocity()) - o.motion.linear_velocity(),
                acceleration: IntervalVec3::ZERO,
                spin_mover: IntervalVec3::point(m.motion.angular_velocity()),
                spin_observer: IntervalVec3::point(o.motion.angular_velocity()),
                spin_rate_mover: IntervalVec3::ZERO,
                spin_rate_observer: IntervalVec3::ZERO,
            };
        }
        let (m, o) = (self.mover.enclose_pose(t), self.observer.enclose_pose(t));
        let (mt, ot) = (self.mover.enclose_twist(t), self.observer.enclose_twist(t));
        let (mr, or) = (self.mover.enclose_twist_rate(t), self.observer.enclose_twist_rate(t));
        State {
            mover: m.rotation,
            mover_inverse: m.rotation.transpose(),
            observer_inverse: o.rotation.transpose(),
            at_mover: m.at,
            at_observer: o.at,
            offset: m.translation - o.translation,
            velocity: mt.linear - ot.linear,
            acceleration: mr.linear - or.linear,
            spin_mover: mt.angular,
            spin_observer: ot.angular,
            spin_rate_mover: mr.angular,
            spin_rate_observer: or.angular,
        }
    }

    /// The frame of the observer over `span`: every point of the mover then costs three matrix products.
    pub fn frame(&self, span: Interval) -> RelativeFrame {
        let all = self.state(span);
        if self.has_joint(span) {
            return Self::observers_frame(span, &all, &all).standing();
        }
        let start = self.state(Interval::point(span.lo()));
        Self::observers_frame(span, &start, &all)
    }

    fn has_joint(&self, span: Interval) -> bool {
        self.constant_twists.is_none()
            && [self.mover, self.observer].iter().any(|motion| has_joint(*motion, span))
    }

    /// The mover in the observer's frame and the observer in the mover's, over `span`.
    ///
    /// The matrices of the one are the transposes of the other's.
    pub fn frames(&self, span: Interval) -> [RelativeFrame; 2] {
        if self.has_joint(span) {
            return [self.frame(span), self.swapped().frame(span)];
        }
        let start = self.state(Interval::point(span.lo()));
        let all = self.state(span);
        let first = Self::observers_frame(span, &start, &all);
        let second = RelativeFrame {
            span,
            at_mover: start.at_observer,
            constant: [
                start.mover_inverse.mul_vec(-start.offset) + start.at_mover,
                start.mover_inverse.mul_vec(start.spin_mover.cross(start.offset) - start.velocity),
                all.mover_inverse.mul_vec(
                    all.spin_rate_mover.cross(all.offset)
                        + all.spin_mover.cross(all.velocity * 2.0 - all.spin_mover.cross(all.offset))
                        - all.acceleration,
                ),
            ],
            matrix: first.matrix.map(IntervalMat3::transpose),
        };
        [first, second]
    }

    fn observers_frame(span: Interval, start: &State, all: &State) -> RelativeFrame {
        let s = start;
        let spin = s.spin_mover - s.spin_observer;
        let position = (s.observer_inverse.mul_vec(s.offset), s.observer_inverse.mul_mat(s.mover));
        let velocity = (
            s.observer_inverse.mul_vec(s.velocity - s.spin_observer.cross(s.offset)),
            s.observer_inverse.mul_mat(skew(spin).mul_mat(s.mover)),
        );
        let s = all;
        let spin = s.spin_mover - s.spin_observer;
        let turn = s.spin_rate_mover - s.spin_rate_observer + s.spin_mover.cross(s.spin_observer);
        let drift = s.acceleration
            - s.spin_rate_observer.cross(s.offset)
            - s.spin_observer.cross(s.velocity * 2.0 - s.spin_observer.cross(s.offset));
        let acceleration = (
            s.observer_inverse.mul_vec(drift),
            s.observer_inverse.mul_mat((add(skew(turn), skew_squared(spin))).mul_mat(s.mover)),
        );
        RelativeFrame {
            span,
            at_mover: s.at_mover,
            constant: [position.0 + s.at_observer, velocity.0, acceleration.0],
            matrix: [position.1, velocity.1, acceleration.1],
        }
    }
}

/// May velocities or accelerations of the motion jump inside of the span?
pub(crate) fn has_joint(motion: &dyn RigidMotion, span: Interval) -> bool {
    // An end that is no number, or none after the start, is one inside.
    motion.smooth_until(span.lo()).is_some_and(|end| end.is_nan() || end < span.hi())
}

/// x_m(t) − x_o(t) with the world offset cancelled first.
fn linear_offset(m: &ConstantTwist, o: &ConstantTwist, t: Interval) -> IntervalVec3 {
    let path = |l: &ConstantTwist| IntervalVec3::point(l.linear_velocity()) * (t - l.reference_time());
    let start = IntervalVec3::point(m.position()) - o.position();
    if m.reference_time() == o.reference_time() {
        let velocity = IntervalVec3::point(m.linear_velocity()) - o.linear_velocity();
        start + velocity * (t - m.reference_time())
    } else {
        start + path(m) - path(o)
    }
}

/// The matrix of w ↦ v × w.
fn skew(v: IntervalVec3) -> IntervalMat3 {
    let o = Interval::ZERO;
    IntervalMat3::from_rows([
        IntervalVec3::new(o, -v.z, v.y),
        IntervalVec3::new(v.z, o, -v.x),
        IntervalVec3::new(-v.y, v.x, o),
    ])
}

/// The matrix of w ↦ v × (v × w) = v (v·w) − |v|² w.
fn skew_squared(v: IntervalVec3) -> IntervalMat3 {
    let (xx, yy, zz) = (v.x.sqr(), v.y.sqr(), v.z.sqr());
    let (xy, xz, yz) = (v.x * v.y, v.x * v.z, v.y * v.z);
    IntervalMat3::from_rows([
        IntervalVec3::new(-(yy + zz), xy, xz),
        IntervalVec3::new(xy, -(xx + zz), yz),
        IntervalVec3::new(xz, yz, -(xx + yy)),
    ])
}

fn add(a: IntervalMat3, b: IntervalMat3) -> IntervalMat3 {
    let (a, b) = (a.rows(), b.rows());
    IntervalMat3::from_rows([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
}

/// The relative position of two bodies at one time, up to rounding that it encloses.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::RelativeMotion;
/// use glam::DVec3;
/// let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// let placed = RelativeMotion::new(&turning, &ConstantTwist::REST).placement(1.0);
/// let point = placed.enclose_point(DVec3::X);
/// assert!((point.x.mid() - 0.5403023).abs() < 1e-6 && (point.y.mid() - 0.841471).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    rotation: IntervalMat3,
    offset: IntervalVec3,
    at_mover: DVec3,
}

impl Placement {
    /// Encloses a point of the mover (its body frame) in the observer's frame.
    pub fn enclose_point(&self, point: DVec3) -> IntervalVec3 {
        self.rotation.mul_vec(IntervalVec3::point(point) - self.at_mover) + self.offset
    }
}

/// A matrix of zeros.
const NO_TURN: IntervalMat3 = IntervalMat3::from_rows([IntervalVec3::ZERO; 3]);

/// The relative motion over one span: position and velocity at its start, acceleration throughout, each affine in the
/// body point. Over a span inside of which a motion has a joint: its positions, velocities down to none, and no acceleration.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::RelativeMotion;
/// use glam::DVec3;
/// let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// let frame = RelativeMotion::new(&turning, &ConstantTwist::REST).frame(Interval::new(0.0, 0.1));
/// // Every point of the mover costs three products of matrices now.
/// let [position, velocity, _] = *frame.jet(DVec3::X).derivatives();
/// assert!(position.x.contains(1.0) && velocity.y.contains(1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RelativeFrame {
    span: Interval,
    at_mover: DVec3,
    constant: [IntervalVec3; 3],
    matrix: [IntervalMat3; 3],
}

impl RelativeFrame {
    /// Of enclosures over all of the span: what stands still where the mover is at any time of it. Where velocities jump no expansion about the
    /// start holds, but this one does: at each time the mover is where one that stands still is.
    fn standing(mut self) -> Self {
        self.constant[1] = self.constant[1].hull(IntervalVec3::ZERO);
        self.matrix[1] = self.matrix[1].hull(NO_TURN);
        (self.constant[2], self.matrix[2]) = (IntervalVec3::ZERO, NO_TURN);
        self
    }

    /// The span of time for which it holds.
    pub const fn span(&self) -> Interval {
        self.span
    }

    /// The path of a point of the mover (its body frame) in the observer's frame.
    pub fn jet(&self, point: DVec3) -> PointJet {
        let r = IntervalVec3::point(point) - self.at_mover;
        PointJet::new(
            self.span,
            [
                self.constant[0] + self.matrix[0].mul_vec(r),
                self.constant[1] + self.matrix[1].mul_vec(r),
                self.constant[2] + self.matrix[2].mul_vec(r),
            ],
        )
    }

    /// The path of a direction of the mover (its body frame): value and rate at the start, second derivative
    /// throughout.
    pub fn direction(&self, e: IntervalVec3) -> [IntervalVec3; 3] {
        [self.matrix[0].mul_vec(e), self.matrix[1].mul_vec(e), self.matrix[2].mul_vec(e)]
    }
}
