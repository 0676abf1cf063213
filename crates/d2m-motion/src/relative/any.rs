//! The motion of A seen from B about one time, for any two motions that can enclose themselves.
//!
//! docs/theory/features.md, "Any C² motion", derives the formulas, bounds and roundings of this file.
use super::bounds::length;
use crate::rounding::{UNIT, UP};
use crate::{Ball, CertifiedState, Kinematics, PathJet, Remainder, RigidMotion};
use d2m_interval::Interval;
use glam::{DMat3, DVec3};

/// Rounding of a jet and of all dot products made with it, in units of 2⁻⁵³ of the magnitudes that it adds.
const ROUNDING: f64 = 64.0;

/// Pose, twist and twist rate of A relative to B about one time, shared by all features of the two bodies.
///
/// Made of the two states at the time `at` and of enclosures of the twist *rates* over a piece of time: how far poses
/// and twists change over the piece follows from those, so that nothing else is enclosed over time. For motions of
/// constant twist the remainder is that of [`RelativeMotion`](super::RelativeMotion); otherwise the half-width of the
/// rates comes on top. A point of A is seen in the body frame of B.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{ConstantTwist, RelativeState};
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-DVec3::Z);
/// let state = RelativeState::new(&falling, &ConstantTwist::REST, Interval::UNIT, 0.5);
/// let jet = state.point_jet(DVec3::X, 1.0, 1.0);
/// assert_eq!((jet.p, jet.v), (DVec3::new(1.0, 0.0, 0.5), -DVec3::Z));
/// assert!(jet.remainder.bound(0.5) < 1e-13);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct RelativeState {
    rotation_a: DMat3,
    rotation_b: DMat3,
    at_a: DVec3,
    at_b: DVec3,
    /// G0, G1, G2: derivatives of the reference point of A, world axes.
    shift: [DVec3; 3],
    /// Ω = ω_A − ω_B.
    spin: DVec3,
    /// S = Λ − ω_B × Ω.
    spin_rate: DVec3,
    /// x_A − x_B, v_A − v_B, a_A − a_B.
    line: [DVec3; 3],
    /// Radii of `line`.
    line_radii: [f64; 3],
    /// Remainder of G, and of a vector of A of length 1.
    shift_remainder: Remainder,
    turn_remainder: Remainder,
    /// Upper bounds over the piece: |ω_B × g|, U, b, w.
    swept: f64,
    speed: f64,
    b: f64,
    w: f64,
}

/// A straight line near which one reference point moves, seen from the other.
#[derive(Debug, Clone, Copy)]
pub struct StraightLine {
    /// Where it is at the time of the state.
    pub offset: DVec3,
    /// Its velocity.
    pub velocity: DVec3,
    /// How far the point is from it at most.
    pub deviation: f64,
}

impl RelativeState {
    /// The two motions about the time `at` of a piece of time: jets made of it hold on the whole piece.
    pub fn new<A, B>(a: &A, b: &B, piece: Interval, at: f64) -> Self
    where
        A: RigidMotion + ?Sized,
        B: RigidMotion + ?Sized,
    {
        let (sa, sb) = (a.enclose_state(at), b.enclose_state(at));
        let (rate_a, rate_b) = (a.enclose_twist_rate(piece), b.enclose_twist_rate(piece));
        let h = (piece.hi() - at).max(at - piece.lo()) * UP;
        let linear_rates = [rate_a.linear, rate_b.linear].map(Ball::around_box);
        let angular_rates = [rate_a.angular, rate_b.angular].map(Ball::around_box);
        Self::from_balls(&sa, &sb, linear_rates, angular_rates, h)
    }

    /// Of the states of A and B at one time, and of what encloses their rates within `h` of it: jets hold there. The states may be about any
    /// point that both share, and in any unit of time near `h` that the rates share: products of rates in others may be lost to underflow.
    ///
    /// ```
    /// use d2m_interval::Interval;
    /// use d2m_motion::{ConstantTwist, RelativeState, RigidMotion};
    /// use glam::DVec3;
    /// let far = DVec3::X * 1e9;
    /// let falling = ConstantTwist::REST.with_position(far + DVec3::Z).with_linear_velocity(-DVec3::Z);
    /// let resting = ConstantTwist::REST.with_position(far);
    /// let [a, b] = [falling, resting].map(|motion| motion.enclose_state_about(0.5, far));
    /// let over = [falling, resting].map(|motion| motion.enclose_kinematics(Interval::UNIT));
    /// let jet = RelativeState::of_states([&a, &b], [&over[0], &over[1]], 0.5).point_jet(DVec3::X, 1.0, 1.0);
    /// assert_eq!((jet.p, jet.v), (DVec3::new(1.0, 0.0, 0.5), -DVec3::Z));
    /// ```
    pub fn of_states([a, b]: [&CertifiedState; 2], over: [&Kinematics; 2], h: f64) -> Self {
        Self::from_balls(a, b, over.map(|rates| rates.linear_rate), over.map(|rates| rates.angular_rate), h)
    }

    pub(super) fn from_balls(
        sa: &CertifiedState,
        sb: &CertifiedState,
        linear_rates: [Ball; 2],
        angular_rates: [Ball; 2],
        h: f64,
    ) -> Self {
        // One rounding of each difference goes with its radius.
        let difference = |p: DVec3, q: DVec3, radius: f64| {
            let d = p - q;
            (d, (radius + 2.0 * UNIT * d.length()) * UP)
        };
        let (g, rx) = difference(sa.position, sb.position, sa.position_radius + sb.position_radius);
        let (u, rv) = difference(sa.linear, sb.linear, sa.linear_radius + sb.linear_radius);
        let (spin, r_spin) = difference(sa.angular, sb.angular, sa.angular_radius + sb.angular_radius);
        let [Ball { center: aa, radius: raa }, Ball { center: ab, radius: rab }] = linear_rates;
        let (acceleration, r_acceleration) = difference(aa, ab, raa + rab);
        let [Ball { center: alpha_a, radius: r_alpha_a }, Ball { center: alpha_b, radius: r_alpha_b }] =
            angular_rates;
        let (lambda_vector, r_lambda) = difference(alpha_a, alpha_b, r_alpha_a + r_alpha_b);
        let omega = sb.angular;
        let r_omega = sb.angular_radius;
        let (ra, rb) = (sa.rotation_radius, sb.rotation_radius);

        // Upper bounds over the piece, radii included.
        let a_sup = (acceleration.length() + r_acceleration) * UP;
        let beta = (alpha_b.length() + r_alpha_b) * UP;
        let lambda = (lambda_vector.length() + r_lambda) * UP;
        let speed = (u.length() + rv + a_sup * h) * UP;
        let b = (omega.length() + r_omega + beta * h) * UP;
        let w = (spin.length() + r_spin + lambda * h) * UP;
        let reach = (g.length() + rx + speed * h) * UP;
        // Of distance and velocity only what is across ω_B turns: |ω_B × g| and |ω_B × U| at the time of the state, what the
        // radii and roundings add, and how fast both change, |α_B × g + ω_B × U| and |α_B × U + ω_B × A|.
        let turned = omega.cross(g);
        let dragged = omega.cross(u);
        let dragging = ((length(dragged)
            + 8.0 * UNIT * b * u.length()
            + r_omega * speed
            + b * rv
            + h * (beta * speed + b * a_sup))
            * UP)
            .min(b * speed * UP);
        let swept = ((length(turned)
            + 8.0 * UNIT * b * g.length()
            + r_omega * reach
            + b * rx
            + h * (beta * reach + dragging))
            * UP)
            .min(b * reach * UP);
        let across = omega.cross(spin);
        let c =
            (across.length() + 8.0 * UNIT * w * b + r_omega * w + b * r_spin + h * (beta * w + b * lambda))
                * UP;

        // Values in world axes: G1 = U − ω_B × g, G2 = A − α_B × g − 2ω_B × U + ω_B × (ω_B × g), S = Λ − ω_B × Ω.
        let shift =
            [g, u - turned, (acceleration - alpha_b.cross(g)) - (2.0 * dragged - omega.cross(turned))];
        let spin_rate = lambda_vector - across;

        // Lengths of the terms that are added, for the rounding; then what the radii add.
        let (first, second) = (speed + b * reach, a_sup + beta * reach + b * (2.0 * speed + b * reach));
        let (turn, turn_second) = (w, lambda + (b + w) * w);
        let wide = (1.0 + ra) * (1.0 + rb) * UP;
        let k = ROUNDING * UNIT;
        let shift_remainder = Remainder {
            e0: (rx + (rb + k) * reach + k * sb.at.length()) * wide,
            e1: (rv + r_omega * reach + b * rx + (rb + k) * first) * wide,
            e2: (0.5
                * (r_acceleration
                    + r_alpha_b * reach
                    + beta * rx
                    + 2.0 * (r_omega * speed + b * rv)
                    + b * (2.0 * r_omega * reach + b * rx)
                    + rb * second)
                + k * second)
                * wide,
            // Of 3β(U + bY) the part α_B × (ω_B × g) is bounded by β|ω_B × g|; 2ω_B × (α_B × g) keeps its 2bβY.
            m3: (b * (3.0 * dragging + b * swept)
                + 3.0 * (beta * speed + b * a_sup)
                + beta * (swept + 2.0 * b * reach))
                * UP,
            m4: 0.0,
        };
        let turn_remainder = Remainder {
            e0: (ra + rb + k) * wide,
            e1: (r_spin + (ra + rb + k) * turn) * wide,
            e2: (0.5 * (r_lambda + r_omega * w + (b + 2.0 * w) * r_spin + (ra + rb) * turn_second)
                + k * turn_second)
                * wide,
            m3: (beta * w + 2.0 * b * lambda + b * c + 3.0 * w * (lambda + c) + w * w * w) * UP,
            m4: 0.0,
        };
        Self {
            rotation_a: sa.rotation,
            rotation_b: sb.rotation,
            at_a: sa.at,
            at_b: sb.at,
            shift,
            spin,
            spin_rate,
            line: [g, u, acceleration],
            line_radii: [rx, rv, r_acceleration],
            shift_remainder,
            turn_remainder,
            swept,
            speed,
            b,
            w,
        }
    }

    /// Bound of the rate of turn of B over the piece.
    pub const fn turn_b(&self) -> f64 {
        self.b
    }

    /// The body point of A that its motion follows.
    pub const fn at_a(&self) -> DVec3 {
        self.at_a
    }

    /// The body point of B that its motion follows.
    pub const fn at_b(&self) -> DVec3 {
        self.at_b
    }

    /// `R_Bᵀ` of a world vector.
    #[inline(always)]
    fn back(&self, v: DVec3) -> DVec3 {
        let m = &self.rotation_b;
        DVec3::new(m.x_axis.dot(v), m.y_axis.dot(v), m.z_axis.dot(v))
    }

    /// `z`, `Ω × z`, `S × z + Ω × (Ω × z)` for `z = R_A d`.
    #[inline(always)]
    fn turn(&self, d: DVec3) -> [DVec3; 3] {
        let z = self.rotation_a * d;
        let first = self.spin.cross(z);
        [z, first, self.spin_rate.cross(z) + self.spin.cross(first)]
    }

    /// Jet, in B's body frame, of the point of A at `arm` (body frame) from the reference point.
    ///
    /// `radius` bounds `|arm|`, and `arm` may be off by 2·2⁻⁵³ of it. The remainder counts a dot product with a
    /// direction of length at most 1 and the comparison with points of B within `extent` of the origin of its frame.
    #[inline(always)]
    pub fn point_jet(&self, arm: DVec3, radius: f64, extent: f64) -> PathJet {
        let [z, z1, z2] = self.turn(arm);
        let [g, g1, g2] = self.shift;
        PathJet {
            p: self.back(g + z) + self.at_b,
            v: self.back(g1 + z1),
            a: self.back(g2 + z2),
            j: DVec3::ZERO,
            remainder: self.remainder(radius, extent),
        }
    }

    /// Jet, in B's body frame, of a difference of two points of A (body frame, off by at most 2·2⁻⁵³ of `length`).
    #[inline(always)]
    pub fn direction_jet(&self, difference: DVec3, length: f64) -> PathJet {
        let [z, z1, z2] = self.turn(difference);
        let r = &self.turn_remainder;
        PathJet {
            p: self.back(z),
            v: self.back(z1),
            a: self.back(z2),
            j: DVec3::ZERO,
            remainder: Remainder {
                e0: r.e0 * length * UP,
                e1: r.e1 * length * UP,
                e2: r.e2 * length * UP,
                m3: r.m3 * length * UP,
                m4: 0.0,
            },
        }
    }

    /// The remainder of every point within `radius` of the reference point.
    #[inline(always)]
    pub fn remainder(&self, radius: f64, extent: f64) -> Remainder {
        let (s, t) = (&self.shift_remainder, &self.turn_remainder);
        Remainder {
            e0: (s.e0 + t.e0 * radius + ROUNDING * UNIT * extent) * UP,
            e1: (s.e1 + t.e1 * radius) * UP,
            e2: (s.e2 + t.e2 * radius) * UP,
            m3: (s.m3 + t.m3 * radius) * UP,
            m4: 0.0,
        }
    }

    /// Bound of the speed over the piece, seen from B, of a point of A within `radius`: `U + bY⊥ + wρ`.
    pub fn bound_speed(&self, radius: f64) -> f64 {
        (self.speed + self.swept + self.w * radius) * UP
    }

    /// Bound over the piece of the speed of the tip of a vector of A of the given length: `w·length`.
    pub fn bound_turn_speed(&self, length: f64) -> f64 {
        self.w * length * UP
    }

    /// The reference points seen from each other: `|(x_A − x_B)(at + s) − offset − velocity·s|` is at most `deviation` for
    /// all |s| ≤ h, h not beyond the piece.
    ///
    /// World axes: no rotation takes part. The bound is `½(|A| + rad A)h²` and the radii and roundings of g and u.
    pub fn straight_line(&self, h: f64) -> StraightLine {
        let [g, u, a] = self.line;
        let [rx, rv, ra] = self.line_radii;
        let deviation = (rx + rv * h + 0.5 * (a.length() + ra) * (h * h)) * UP;
        StraightLine { offset: g, velocity: u, deviation }
    }
}
