//! Jets of any C² motion from its interval enclosures.
use super::FeaturePath;
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{PathJet, Remainder, RigidMotion};
use d2m_root::Piece;
use glam::DVec3;

/// A point and a direction of A seen from the body frame of B, in real time.
pub(crate) struct EnclosedPath<'a> {
    a: &'a dyn RigidMotion,
    b: &'a dyn RigidMotion,
    point: DVec3,
    /// Difference of two body points of A, twice the half edge.
    direction: Option<(DVec3, DVec3)>,
    /// Rounding of dot products and comparisons made with the jets.
    slack: f64,
    speed: f64,
    direction_speed: f64,
}

/// Position, velocity and acceleration in B's frame over an interval of time.
struct Seen {
    p: IntervalVec3,
    v: IntervalVec3,
    a: IntervalVec3,
}

impl<'a> EnclosedPath<'a> {
    /// `ends` are two body points of A: the path is that of their midpoint and of half their difference; equal ends
    /// for a single point. `extent` bounds the points of B (body frame) that are compared with it.
    pub(crate) fn new(
        a: &'a dyn RigidMotion,
        b: &'a dyn RigidMotion,
        ends: [DVec3; 2],
        window: Piece,
        extent: f64,
    ) -> Self {
        let mut path = Self {
            a,
            b,
            point: ends[0],
            direction: (ends[0] != ends[1]).then_some((ends[0], ends[1])),
            slack: 0.0,
            speed: 0.0,
            direction_speed: 0.0,
        };
        let over = Interval::new(window.lo, window.hi);
        let (point, direction) = path.enclose(over);
        path.speed = point.v.norm().hi();
        path.direction_speed = direction.v.norm().hi();
        let size = point.p.norm().hi() + direction.p.norm().hi() + extent;
        path.slack = 64.0 * f64::EPSILON * size;
        path
    }

    /// Point (midpoint of the ends) and direction (half the difference) over an interval of time.
    fn enclose(&self, t: Interval) -> (Seen, Seen) {
        let (pose_a, pose_b) = (self.a.enclose_pose(t), self.b.enclose_pose(t));
        let (twist_a, twist_b) = (self.a.enclose_twist(t), self.b.enclose_twist(t));
        let (rate_a, rate_b) = (self.a.enclose_twist_rate(t), self.b.enclose_twist_rate(t));
        let back = pose_b.rotation.transpose();
        // X, X1, X2 of docs/theory/features.md: the derivatives of R_Bᵀx are R_Bᵀ X_k.
        let seen = |arm: IntervalVec3, along: Option<(IntervalVec3, IntervalVec3, IntervalVec3)>| {
            let turn = twist_a.angular.cross(arm);
            let turn_rate = rate_a.angular.cross(arm) + twist_a.angular.cross(turn);
            let (x, x1, x2) = match along {
                Some((x, v, a)) => (x + arm, v + turn, a + turn_rate),
                None => (arm, turn, turn_rate),
            };
            let first = x1 - twist_b.angular.cross(x);
            let second =
                x2 - rate_b.angular.cross(x) - twist_b.angular.cross(x1) - twist_b.angular.cross(first);
            Seen { p: back.mul_vec(x), v: back.mul_vec(first), a: back.mul_vec(second) }
        };
        let body = |p: DVec3| pose_a.rotation.mul_vec(IntervalVec3::point(p) - pose_a.at);
        let centre = (
            pose_a.translation - pose_b.translation,
            twist_a.linear - twist_b.linear,
            rate_a.linear - rate_b.linear,
        );
        let at_b = IntervalVec3::point(pose_b.at);
        let shifted = |mut s: Seen| {
            s.p += at_b;
            s
        };
        match self.direction {
            None => (
                shifted(seen(body(self.point), Some(centre))),
                Seen { p: IntervalVec3::ZERO, v: IntervalVec3::ZERO, a: IntervalVec3::ZERO },
            ),
            Some((p0, p1)) => {
                let half = Interval::point(0.5);
                let difference = (IntervalVec3::point(p1) - p0) * half;
                let middle = (IntervalVec3::point(p1) + p0) * half - pose_a.at;
                (
                    shifted(seen(pose_a.rotation.mul_vec(middle), Some(centre))),
                    seen(pose_a.rotation.mul_vec(difference), None),
                )
            }
        }
    }

    fn jets(&self, piece: Piece, at: f64) -> (PathJet, PathJet) {
        let now = self.enclose(Interval::point(at));
        let over = self.enclose(Interval::new(piece.lo, piece.hi));
        (jet(&now.0, &over.0, self.slack), jet(&now.1, &over.1, self.slack))
    }
}

/// Taylor with the enclosed second derivative: middle values as coefficients, half-widths as remainder.
fn jet(now: &Seen, over: &Seen, slack: f64) -> PathJet {
    let radius = |v: &IntervalVec3| DVec3::new(v.x.rad(), v.y.rad(), v.z.rad()).length() * (1.0 + 1e-14);
    PathJet {
        p: now.p.mid(),
        v: now.v.mid(),
        a: over.a.mid(),
        remainder: Remainder {
            e0: radius(&now.p) + slack,
            e1: radius(&now.v) + 32.0 * f64::EPSILON * now.v.mid().length(),
            e2: 0.5 * radius(&over.a) + 32.0 * f64::EPSILON * over.a.mid().length(),
            m3: 0.0,
        },
    }
}

impl FeaturePath for EnclosedPath<'_> {
    fn point(&mut self, piece: Piece, at: f64) -> PathJet {
        self.jets(piece, at).0
    }

    fn point_and_direction(&mut self, piece: Piece, at: f64) -> (PathJet, PathJet) {
        self.jets(piece, at)
    }

    fn speed(&self) -> f64 {
        self.speed
    }

    fn direction_speed(&self) -> f64 {
        self.direction_speed
    }

    fn jerk(&self) -> f64 {
        0.0
    }

    fn rounding(&self) -> f64 {
        self.slack
    }
}
