//! Jets in closed form, from frames that all features of a pair of bodies share.
use super::{CubicAlong, FeaturePath, HalfEdge};
use crate::rounding::{UNIT, UP, length_up};
use d2m_motion::{ArmPair, EdgeJets, Frame, LeverArm, PathJet, RelativeMotion, Remainder};
use d2m_root::{Cubic, Piece};
use glam::DVec3;
use std::sync::OnceLock;

/// A relative motion with its frame in the middle of the window: the time at which every feature of a pair of bodies that comes near is
/// evaluated first, and most of them last. It is made once one does.
#[derive(Debug, Clone)]
pub(crate) struct FramedMotion {
    pub(crate) motion: RelativeMotion,
    middle: f64,
    frame: OnceLock<Frame>,
}

impl FramedMotion {
    #[inline]
    pub(crate) fn new(motion: RelativeMotion) -> Self {
        let middle = Piece { lo: 0.0, hi: motion.duration() }.mid();
        Self { motion, middle, frame: OnceLock::new() }
    }

    #[inline]
    fn frame(&self) -> &Frame {
        self.frame.get_or_init(|| self.motion.frame(self.middle))
    }
}

/// Part of the window that may be left before it is searched as a whole, with the shared frame in its middle.
const SHARED: f64 = 0.8;

/// Part of the way of half a piece that the remainder of a jet to second order may reach before one to third order is
/// made in place of using the shared frame.
const COARSE: f64 = 0.5;

/// More than what `times_within` adds to a distance, as a part of the reach of the motion: 64·2⁻⁵³(|g| + |u|T), and
/// |u|T ≤ 2Y, |g| ≤ Y; as much again for what rounding the two times adds.
const PAD: f64 = 512.0 * UNIT;
/// Units in the last place of the window's length that a bracket may keep: the two ends of a piece that can no longer be
/// halved, each rounded outward, and as much again for the clock at its end.
const CLOCK: f64 = 8.0 * UNIT;

/// A point and a direction of A with a constant relative twist.
pub(crate) struct RigidPath<'a> {
    motion: &'a FramedMotion,
    point: DVec3,
    direction: DVec3,
    /// What jets to third order need, once one is needed.
    third_order: Option<ThirdOrder>,
    window: Option<Piece>,
    point_remainder: Remainder,
    direction_remainder: Remainder,
    fourth_derivative: f64,
    speed: f64,
    direction_speed: f64,
}

/// The vectors prepared for jets to third order, and the remainders of these.
// One on the stack a query: a box would cost more than the room.
#[allow(clippy::large_enum_variant)]
enum ThirdOrder {
    Point(LeverArm, Remainder),
    /// Of A and of B, with the remainders of point and direction.
    Edges([ArmPair; 2], [Remainder; 2]),
}

impl<'a> RigidPath<'a> {
    /// `point` and `direction` as placed at the epoch; `extent` bounds the points of B that they are compared with,
    /// `separation` is the distance that counts as contact.
    ///
    /// Contact needs the reference points within `|point| + |direction| + extent + separation` of each other: that
    /// part of the window is all that is searched, and there the bounds are smaller.
    #[inline(always)]
    pub(crate) fn new(
        framed: &'a FramedMotion,
        point: DVec3,
        direction: DVec3,
        extent: f64,
        separation: f64,
    ) -> Self {
        let motion = &framed.motion;
        let (radius, length) = (length_up(point), length_up(direction));
        let whole = Piece { lo: 0.0, hi: motion.duration() };
        let (mut window, mut reach) = (Some(whole), f64::INFINITY);
        let distance = (radius + length + extent + separation + motion.bound_anchor_arms()) * UP;
        match motion.times_within(distance) {
            None => window = None,
            // Not worth another frame than the shared one in the middle.
            Some(times) if times.to - times.from > SHARED * whole.hi => {}
            Some(times) => {
                window = Some(Piece { lo: times.from, hi: times.to });
                // The pad of `times_within` is below this.
                reach = (distance + PAD * motion.bound_reach(0.0)) * UP;
            }
        }
        Self {
            motion: framed,
            point,
            direction,
            third_order: None,
            window,
            point_remainder: motion.point_remainder_within(radius, extent, reach),
            direction_remainder: motion.direction_remainder(length),
            fourth_derivative: motion.bound_fourth_derivative_within(radius, reach),
            speed: motion.bound_speed_within(radius, reach),
            direction_speed: motion.bound_direction_speed() * length * UP,
        }
    }

    /// The part of the window in which a contact is possible at all.
    pub(crate) const fn window(&self) -> Option<Piece> {
        self.window
    }

    /// How far the point can be from the origin of B's frame over the window.
    pub(crate) fn reach(&self) -> f64 {
        self.motion.motion.bound_reach(length_up(self.point))
    }

    /// How far the point moves while the time of the window cannot change by less: a few units in the last place.
    pub(crate) fn time_rounding(&self) -> f64 {
        CLOCK * self.motion.motion.duration() * (self.speed + self.direction_speed)
    }
}

impl RigidPath<'_> {
    /// True if the frame in the middle of the window serves this piece.
    #[inline(always)]
    fn frame_serves(&self, piece: Piece, at: f64) -> bool {
        let h = 0.5 * piece.width();
        at == self.motion.middle && self.point_remainder.m3 * (h * h) <= 6.0 * COARSE * self.speed
    }
}

impl FeaturePath for RigidPath<'_> {
    #[inline(always)]
    fn point(&mut self, piece: Piece, at: f64) -> PathJet {
        let framed = self.motion;
        if self.frame_serves(piece, at) {
            return framed.frame().point_jet(self.point, self.point_remainder);
        }
        let motion = &framed.motion;
        if motion.is_anchored() {
            return motion.frame(at).point_jet(self.point, self.point_remainder);
        }
        if let Some(ThirdOrder::Point(arm, remainder)) = &self.third_order {
            return motion.point_jet(at, arm, *remainder);
        }
        let remainder = motion.point_remainder_third_order(self.point_remainder, self.fourth_derivative);
        let arm = motion.arm(self.point);
        self.third_order = Some(ThirdOrder::Point(arm, remainder));
        motion.point_jet(at, &arm, remainder)
    }

    #[inline(always)]
    fn point_along(&mut self, piece: Piece, at: f64, d: DVec3) -> CubicAlong {
        let motion = &self.motion.motion;
        if let Some(ThirdOrder::Point(arm, remainder)) = &self.third_order
            && !self.frame_serves(piece, at)
        {
            let [value, slope, curvature, jerk] = motion.point_along(at, arm, d);
            let cubic = Cubic { value, slope, curvature, jerk };
            return CubicAlong { cubic, remainder: *remainder };
        }
        let jet = self.point(piece, at);
        CubicAlong::new(&jet, d)
    }

    #[inline(always)]
    fn edges(&mut self, piece: Piece, at: f64, of_b: HalfEdge) -> EdgeJets {
        let framed = self.motion;
        let from = |frame: &Frame| {
            let point = frame.point_jet(self.point, self.point_remainder);
            super::against([point, frame.direction_jet(self.direction, self.direction_remainder)], of_b)
        };
        if self.frame_serves(piece, at) {
            return from(framed.frame());
        }
        let motion = &framed.motion;
        if motion.is_anchored() {
            return from(&motion.frame(at));
        }
        if self.third_order.is_none() {
            let point = motion.point_remainder_third_order(self.point_remainder, self.fourth_derivative);
            let length = length_up(self.direction);
            let remainders = [point, motion.direction_remainder_third_order(length)];
            let arms = [motion.arms_a(self.point, self.direction), motion.arms_b(of_b.middle, of_b.half)];
            self.third_order = Some(ThirdOrder::Edges(arms, remainders));
        }
        let Some(ThirdOrder::Edges([of_a, of_b], remainders)) = &self.third_order else {
            unreachable!("a path of edges");
        };
        motion.edge_jets(at, of_a, of_b, *remainders)
    }

    fn speed(&self) -> f64 {
        self.speed
    }

    fn direction_speed(&self) -> f64 {
        self.direction_speed
    }

    #[inline(always)]
    fn left_out(&self, h: f64) -> f64 {
        let square = h * h;
        if self.motion.motion.is_anchored() {
            (1.0 / 6.0) * self.point_remainder.m3 * (h * square)
        } else {
            (1.0 / 24.0) * self.fourth_derivative * (square * square)
        }
    }

    fn rounding(&self) -> f64 {
        self.point_remainder.e0
    }
}
