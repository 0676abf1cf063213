//! Jets of any C² motion from what it encloses of itself.
use super::{FeaturePath, HalfEdge};
use crate::motion_in_units::MotionInUnits;
use crate::rounding::{PRODUCT_UNDERFLOW, UNIT, UP, length_up};
use d2m_interval::Interval;
use d2m_motion::{EdgeJets, PathJet, RelativeState, StraightLine};
use d2m_root::{Band, Piece, Quadratic};
use glam::DVec3;

/// Part of the window that may be left before it is searched as a whole, with the shared state in its middle.
const SHARED: f64 = 0.8;

/// Two motions over a window with their relative state in its middle: the time at which every feature of a pair of
/// bodies is evaluated first.
#[derive(Clone, Copy)]
pub(crate) struct EnclosedMotions<'a> {
    a: MotionInUnits<'a>,
    b: MotionInUnits<'a>,
    window: Piece,
    middle: f64,
    state: RelativeState,
    /// The same for the middle alone: how strongly the path bends there, free of what the window adds.
    instant: RelativeState,
}

impl<'a> EnclosedMotions<'a> {
    pub(crate) fn new(a: MotionInUnits<'a>, b: MotionInUnits<'a>, window: Piece) -> Self {
        let middle = window.mid();
        let state = RelativeState::new(&a, &b, Interval::new(window.lo, window.hi), middle);
        let instant = RelativeState::new(&a, &b, Interval::point(middle), middle);
        Self { a, b, window, middle, state, instant }
    }

    pub(crate) const fn window(&self) -> Piece {
        self.window
    }

    /// Bound of the distance of the reference points over the window.
    pub(crate) fn bound_distance(&self) -> f64 {
        let h = super::local(self.window, self.middle).reach() * UP;
        let StraightLine { offset: g, velocity: u, deviation } = self.state.straight_line(h);
        (length_up(g) + length_up(u) * h + deviation) * UP
    }

    /// The reference points of A and B, body frames.
    pub(crate) const fn at_a(&self) -> DVec3 {
        self.state.at_a()
    }

    pub(crate) const fn at_b(&self) -> DVec3 {
        self.state.at_b()
    }

    /// Bound of the rate of turn of B over the window.
    pub(crate) const fn turn_b(&self) -> f64 {
        self.state.turn_b()
    }

    /// The part of the window in which the reference points are within `distance` of each other; `None`: never.
    ///
    /// `|x_A − x_B| ≥ |g + us| − r` with the r of [`RelativeState::straight_line`], so contact needs
    /// `|g + us|² ≤ (distance + r)²`. The squares' rounding is below 16·2⁻⁵³ of `(|g| + |u|h)²`, and so is their
    /// change over the rounding of s.
    pub(crate) fn times_within(&self, distance: f64) -> Option<Piece> {
        let whole = super::local(self.window, self.middle);
        let h = whole.reach() * UP;
        let StraightLine { offset: g, velocity: u, deviation } = self.state.straight_line(h);
        let size = length_up(g) + length_up(u) * h;
        let band = (distance + deviation) * UP;
        let square = band * band * UP + SQUARES * (size * size) + PRODUCT_UNDERFLOW;
        let squared = Quadratic {
            value: g.length_squared(),
            slope: 2.0 * g.dot(u),
            curvature: 2.0 * u.length_squared(),
        };
        let part = squared.clip(Band { lo: f64::NEG_INFINITY, hi: square }, whole)?;
        Some(super::global(part, self.middle, self.window))
    }
}

/// Rounding of |g + us|² and its change over the rounding of s, as a part of (|g| + |u|h)²: both below 16·2⁻⁵³.
const SQUARES: f64 = 128.0 * UNIT;

/// A point and a direction of A seen from the body frame of B, in real time.
pub(crate) struct EnclosedPath<'a> {
    motions: &'a EnclosedMotions<'a>,
    /// From A's reference point to the middle of the ends, body frame.
    arm: DVec3,
    /// Half the difference of the ends.
    half: DVec3,
    radius: f64,
    length: f64,
    extent: f64,
    window: Option<Piece>,
}

/// How far features of B reach: from the origin of its frame, and from its reference point.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) from_origin: f64,
    pub(crate) from_reference: f64,
}

impl Extent {
    /// Of a sphere.
    pub(crate) fn of(center: DVec3, radius: f64, motions: &EnclosedMotions<'_>) -> Self {
        let at = motions.state.at_b();
        Self {
            from_origin: (length_up(center) + radius) * UP,
            from_reference: (length_up(center - at) + radius + 2.0 * UNIT * length_up(at)) * UP,
        }
    }
}

impl<'a> EnclosedPath<'a> {
    /// `ends` are two body points of A: the path is that of their midpoint and of half their difference; equal ends
    /// for a single point. `extent` bounds the points of B that are compared with it, `separation` is the distance
    /// that counts as contact.
    pub(crate) fn new(
        motions: &'a EnclosedMotions<'a>,
        ends: [DVec3; 2],
        extent: Extent,
        separation: f64,
    ) -> Self {
        let at = motions.state.at_a();
        let (first, last) = (ends[0] - at, ends[1] - at);
        let half = (ends[1] - ends[0]) * 0.5;
        let arm = (first + last) * 0.5;
        // Bounds both ends, so that the rounding of the middle is relative to it.
        let radius = length_up(first).max(length_up(last));
        let length = length_up(half);
        let distance = (radius + extent.from_reference + separation) * UP;
        let window = motions
            .times_within(distance)
            .map(|part| if part.width() > SHARED * motions.window.width() { motions.window } else { part });
        Self { motions, arm, half, radius, length, extent: extent.from_origin, window }
    }

    /// The part of the window in which a contact is possible at all.
    pub(crate) const fn window(&self) -> Option<Piece> {
        self.window
    }

    #[inline(always)]
    fn with_state<T>(&self, piece: Piece, at: f64, f: impl FnOnce(&RelativeState) -> T) -> T {
        let shared = self.motions;
        // The shared state knows the whole window: too much for a narrow piece that happens to have its middle.
        if at == shared.middle && piece.width() > 0.5 * shared.window.width() {
            f(&shared.state)
        } else {
            f(&RelativeState::new(&shared.a, &shared.b, Interval::new(piece.lo, piece.hi), at))
        }
    }
}

impl FeaturePath for EnclosedPath<'_> {
    #[inline(always)]
    fn point(&mut self, piece: Piece, at: f64) -> PathJet {
        self.with_state(piece, at, |state| state.point_jet(self.arm, self.radius, self.extent))
    }

    #[inline(always)]
    fn edges(&mut self, piece: Piece, at: f64, of_b: HalfEdge) -> EdgeJets {
        let of_a = self.with_state(piece, at, |state| {
            let point = state.point_jet(self.arm, self.radius, self.extent);
            [point, state.direction_jet(self.half, self.length)]
        });
        super::against(of_a, of_b)
    }

    fn speed(&self) -> f64 {
        self.motions.state.bound_speed(self.radius)
    }

    fn direction_speed(&self) -> f64 {
        self.motions.state.bound_turn_speed(self.length)
    }

    fn left_out(&self, h: f64) -> f64 {
        // Only a hint of how wide a piece may be, a sixth of what jets to third order are held to; what is not finite
        // says nothing.
        let jerk = self.motions.instant.remainder(self.radius, 0.0).m3;
        if jerk < f64::INFINITY { (1.0 / 36.0) * jerk * (h * h * h) } else { 0.0 }
    }

    fn rounding(&self) -> f64 {
        self.motions.instant.remainder(self.radius, self.extent).e0
    }
}
