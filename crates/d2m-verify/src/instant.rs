//! Where the bodies are at one time, and the gap between two parts of them along a direction.
use crate::Body;
use crate::mesh::finite;
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use glam::{DMat3, DVec3};

/// The second body seen from the first (the *base*) at one time: its point Q (from its mesh's center) is at x = turn·Q + offset from
/// the base's center, in the base's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub(crate) time: f64,
    pub(crate) turn: IntervalMat3,
    pub(crate) back: IntervalMat3,
    pub(crate) offset: IntervalVec3,
    /// Middles, for guesses.
    pub(crate) turn_guess: DMat3,
    pub(crate) back_guess: DMat3,
    pub(crate) offset_guess: DVec3,
}

impl Instant {
    /// `None` where an enclosure says nothing: what is empty, unbounded or no number proves nothing.
    pub(crate) fn new(bodies: &[Body<'_>; 2], time: f64) -> Option<Self> {
        // Near the bodies, so that their positions lose nothing far from the world's origin.
        let near = bodies[0].motion.pose_and_twist(time).0.translation;
        let origin = if near.is_finite() { near } else { DVec3::ZERO };
        let [(turn_a, at_a), (turn_b, at_b)] = bodies.map(|body| {
            let state = body.motion.enclose_state_about(time, origin).following(body.mesh.center);
            (
                around_matrix(state.rotation, state.rotation_radius),
                around(state.position, state.position_radius),
            )
        });
        let (turn_a, turn_b) = (turn_a?, turn_b?);
        let back_a = turn_a.transpose();
        let turn = back_a.mul_mat(turn_b);
        let offset = finite(back_a.mul_vec(at_b? - at_a?))?;
        for row in turn.rows() {
            let _ = finite(row)?;
        }
        let turn_guess = DMat3::from_cols_array_2d(&turn.cols().map(|column| column.mid().to_array()));
        let (back, back_guess) = (turn.transpose(), turn_guess.transpose());
        Some(Self { time, turn, back, offset, turn_guess, back_guess, offset_guess: offset.mid() })
    }
}

/// The vectors within `radius` of `center`.
fn around(center: DVec3, radius: f64) -> Option<IntervalVec3> {
    let side = |x: f64| Interval::around(x, radius);
    (radius >= 0.0)
        .then_some(IntervalVec3::new(side(center.x), side(center.y), side(center.z)))
        .and_then(finite)
}

/// The matrices within `radius` (operator norm) of `m`: no entry is further off than that.
pub(crate) fn around_matrix(m: DMat3, radius: f64) -> Option<IntervalMat3> {
    let [x, y, z] = m.to_cols_array_2d().map(|column| around(column.into(), radius));
    Some(IntervalMat3::from_cols([x?, y?, z?]))
}

/// A part of a body: a box, or a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    Box { bounds: IntervalVec3, middle: DVec3, half: DVec3, reach: f64 },
    Triangle { corners: [IntervalVec3; 3], guess: [DVec3; 3], reach: f64 },
}

impl Part {
    pub(crate) fn boxed(bounds: IntervalVec3) -> Self {
        Self::Box { bounds, middle: bounds.mid(), half: bounds.rad(), reach: bounds.norm().hi() }
    }

    pub(crate) fn triangle(corners: [IntervalVec3; 3]) -> Self {
        let reach = corners.map(|p| p.norm().hi()).into_iter().fold(0.0, f64::max);
        Self::Triangle { corners, guess: corners.map(IntervalVec3::mid), reach }
    }

    pub(crate) fn reach(&self) -> f64 {
        let (Self::Box { reach, .. } | Self::Triangle { reach, .. }) = self;
        *reach
    }

    pub(crate) fn bounds(&self) -> IntervalVec3 {
        match self {
            Self::Box { bounds, .. } => *bounds,
            Self::Triangle { corners: [a, b, c], .. } => a.hull(*b).hull(*c),
        }
    }

    /// The corners of a triangle.
    pub(crate) fn corners(&self) -> Option<&[IntervalVec3; 3]> {
        if let Self::Triangle { corners, .. } = self { Some(corners) } else { None }
    }

    /// About the corners of a triangle; of a box its middle.
    pub(crate) fn guess(&self) -> [DVec3; 3] {
        match self {
            Self::Box { middle, .. } => [*middle; 3],
            Self::Triangle { guess, .. } => *guess,
        }
    }

    /// n·p of all its points.
    fn along(&self, n: IntervalVec3) -> Interval {
        match self {
            Self::Box { bounds, .. } => n.dot(*bounds),
            Self::Triangle { corners: [a, b, c], .. } => n.dot(*a).hull(n.dot(*b)).hull(n.dot(*c)),
        }
    }

    /// About the least and the greatest n·p.
    fn guess_along(&self, n: DVec3) -> [f64; 2] {
        match self {
            Self::Box { middle, half, .. } => {
                let (center, wide) = (n.dot(*middle), n.abs().dot(*half));
                [center - wide, center + wide]
            }
            Self::Triangle { guess: [a, b, c], .. } => {
                let [a, b, c] = [n.dot(*a), n.dot(*b), n.dot(*c)];
                [a.min(b).min(c), a.max(b).max(c)]
            }
        }
    }
}

/// A direction that goes with the bodies; it need not be of length one.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Direction {
    /// Fixed in the base.
    Base(DVec3),
    /// Fixed in the other body.
    Other(DVec3),
    /// e × (turn·f): across a direction of either.
    Across(DVec3, DVec3),
}

impl Direction {
    /// An upper bound of its length.
    pub(crate) fn size(self) -> Interval {
        let length = |v: DVec3| IntervalVec3::point(v).norm();
        match self {
            Self::Base(n) | Self::Other(n) => length(n),
            Self::Across(e, f) => length(e) * length(f),
        }
    }

    /// In the axes of the base and in those of the other body.
    pub(crate) fn at(self, now: &Instant) -> [IntervalVec3; 2] {
        match self {
            Self::Base(n) => [IntervalVec3::point(n), now.back.mul_point(n)],
            Self::Other(n) => [now.turn.mul_point(n), IntervalVec3::point(n)],
            Self::Across(e, f) => {
                let (e, f) = (IntervalVec3::point(e), IntervalVec3::point(f));
                [e.cross(now.turn.mul_vec(f)), now.back.mul_vec(e).cross(f)]
            }
        }
    }

    pub(crate) fn guess(self, now: &Instant) -> DVec3 {
        match self {
            Self::Base(n) => n,
            Self::Other(n) => now.turn_guess * n,
            Self::Across(e, f) => e.cross(now.turn_guess * f),
        }
    }

    #[must_use]
    pub(crate) fn reversed(self) -> Self {
        match self {
            Self::Base(n) => Self::Base(-n),
            Self::Other(n) => Self::Other(-n),
            Self::Across(e, f) => Self::Across(-e, f),
        }
    }
}

impl Instant {
    /// A lower bound of N·(x − p) over all points p of the base's part and x of the other's: what is proven of this time.
    pub(crate) fn gap(&self, [n, n_other]: [IntervalVec3; 2], [base, other]: [&Part; 2]) -> Interval {
        n.dot(self.offset) + other.along(n_other) - base.along(n)
    }

    /// About the gaps along n and along −n.
    pub(crate) fn guess_gaps(&self, n: DVec3, [base, other]: [&Part; 2]) -> [f64; 2] {
        let apart = n.dot(self.offset_guess);
        let [low, high] = base.guess_along(n);
        let [other_low, other_high] = other.guess_along(self.back_guess * n);
        [apart + other_low - high, low - apart - other_high]
    }
}
