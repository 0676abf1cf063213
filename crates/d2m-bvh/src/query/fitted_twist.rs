//! Two constant twists that stay near two motions for a while, and how near that is proven to be.
//!
//! docs/theory/motions.md, section 3, derives the bound.

use super::Moving;
use d2m_interval::Interval;
use d2m_motion::{Ball, CertifiedState, ConstantTwist, Kinematics};
use glam::DVec3;

/// The constant twists that have the states of two motions at one time of a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct FittedTwists {
    /// The two motions, their positions told from the origin that was asked for.
    pub(super) twists: [ConstantTwist; 2],
    /// At every time of the span the distance of any point of the one body from any of the other differs by at most this.
    pub(super) deviation: f64,
    /// The part of it that no shorter span takes away.
    pub(super) floor: f64,
}

/// One motion, told by one body point.
struct Fit {
    twist: ConstantTwist,
    state: CertifiedState,
    rotation_radius: f64,
    acceleration: Ball,
    angular_rate: f64,
    reach: f64,
}

/// Covers the rounding of fewer than 32 operations on non-negative numbers.
const UP: f64 = 1.0 + 1e-14;
/// The pole of acceleration is looked for within so many radii of the body.
const POLE_WITHIN: f64 = 16.0;

impl FittedTwists {
    /// Fits in the middle of the span; `None` where the motions' enclosures know too little, whatever the span.
    ///
    /// Each motion is told by the point that it follows and by the one that accelerates least; what gives the smaller
    /// deviation is taken.
    pub(super) fn new(bodies: &[Moving<'_>; 2], span: (f64, f64), origin: DVec3) -> Option<Self> {
        let (from, to) = span;
        let middle = (from + 0.5 * (to - from)).clamp(from, to);
        let fits = bodies.map(|body| candidates(&body, Interval::new(from, to), middle, origin));
        // Either difference is rounded once.
        let half = (to - middle).max(middle - from) * UP;
        let mut best: Option<Self> = None;
        for a in fits[0].iter().flatten() {
            for b in fits[1].iter().flatten() {
                let fitted = between(a, b, half);
                // What is not a number is never better.
                if fitted.deviation < best.as_ref().map_or(f64::INFINITY, |best| best.deviation) {
                    best = Some(fitted);
                }
            }
        }
        best
    }
}

fn candidates(body: &Moving<'_>, span: Interval, middle: f64, origin: DVec3) -> [Option<Fit>; 2] {
    let kinematics = body.motion.enclose_kinematics(span);
    let state = body.motion.enclose_state_about(middle, origin);
    let one = |state: CertifiedState, kinematics: &Kinematics| {
        let (twist, rotation_radius) = state.to_constant_twist(middle)?;
        Some(Fit {
            twist,
            rotation_radius,
            acceleration: kinematics.linear_rate,
            angular_rate: kinematics.angular_rate.bound_length(),
            reach: (body.body.radius() + (body.body.center() - state.at).length()) * UP,
            state,
        })
    };
    let (w, a) = (state.angular, kinematics.linear_rate.center);
    let across = (a - w * (w.dot(a) / w.length_squared())) / w.length_squared();
    let near = across.length() <= POLE_WITHIN * body.body.radius() && across != DVec3::ZERO;
    let pole = near.then(|| {
        // ω × (ω × e) = −a across ω.
        let at = state.at + state.rotation.transpose() * across;
        one(state.following(at), &kinematics.following(at))
    });
    [one(state, &kinematics), pole.flatten()]
}

fn between(a: &Fit, b: &Fit, half: f64) -> FittedTwists {
    let along = (a.acceleration.minus(b.acceleration)).bound_length();
    let square = 0.5 * half * half;
    let turned = |fit: &Fit| {
        fit.reach * (fit.rotation_radius + half * fit.state.angular_radius + square * fit.angular_rate)
    };
    let still = |fit: &Fit| fit.state.position_radius + fit.reach * fit.rotation_radius;
    let moved = half * (a.state.linear_radius + b.state.linear_radius) + square * along;
    let deviation = a.state.position_radius + b.state.position_radius + moved + turned(a) + turned(b);
    FittedTwists {
        twists: [a.twist, b.twist],
        // What underflow may take is less than the smallest normal number.
        deviation: deviation * UP + f64::MIN_POSITIVE,
        floor: still(a) + still(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshTree, TriMesh};
    use d2m_motion::{Chain, Joint, JointKind, JointValue, RigidMotion};
    use glam::DQuat;

    fn joint(x: DVec3, axis: DVec3, coefficients: &[f64], turns: bool) -> Joint {
        let value = JointValue::try_polynomial(coefficients.to_vec()).unwrap();
        let kind =
            if turns { JointKind::Revolute { axis, value } } else { JointKind::Prismatic { axis, value } };
        Joint::try_new(x, DQuat::IDENTITY, kind).unwrap()
    }

    /// Differences of positions, of the corners of a body that is a thin rod from its origin and of a point at rest: within
    /// the bound at all times of the span, and nearly reached by some.
    #[test]
    fn fitted_twists_stay_within_the_deviation() {
        let rod = |length: f64| {
            let corners = vec![-DVec3::X * length, DVec3::X * length, DVec3::Y * 1e-3];
            MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap())
        };
        let (body, point) = (rod(1.0), rod(1e-6));
        let still = ConstantTwist::REST;
        let mut sharpest = [0.0_f64; 4];
        for (kind, joints) in [
            vec![joint(DVec3::ZERO, DVec3::Z, &[0.0, 1.0, 1.0], false)],
            vec![joint(DVec3::ZERO, DVec3::Z, &[0.0, 0.0, 1.0], true)],
            vec![
                joint(DVec3::ZERO, DVec3::Z, &[0.3, -2.0], true),
                joint(DVec3::X, DVec3::Y, &[0.0, 1.0, -3.0], true),
            ],
            // A turn at a constant rate about a point that the body does not follow: the pole does not accelerate.
            vec![joint(DVec3::ZERO, DVec3::Z, &[0.0, 2.0], true), joint(DVec3::X, DVec3::Y, &[0.0], true)],
        ]
        .into_iter()
        .enumerate()
        {
            let motion = Chain::try_new(joints).unwrap();
            for (from, to) in [(0.0, 0.1), (0.4, 0.5), (-0.3, 0.3), (1.0, 1.000_01)] {
                let bodies = [Moving::new(&body, &motion as &dyn RigidMotion), Moving::new(&point, &still)];
                let fitted = FittedTwists::new(&bodies, (from, to), DVec3::ZERO).unwrap();
                assert!(fitted.floor <= fitted.deviation && fitted.floor < 1e-13);
                let mut most = 0.0_f64;
                for i in 0..=20 {
                    let t = from + (to - from) * f64::from(i) / 20.0;
                    let (true_pose, _) = motion.pose_and_twist(t);
                    let (near, _) = fitted.twists[0].pose_and_twist(t);
                    for corner in body.mesh().vertices() {
                        let off = true_pose.transform_point(*corner) - near.transform_point(*corner);
                        assert!(off.length() <= fitted.deviation + 1e-14, "{kind}, {t}");
                        most = most.max(off.length());
                    }
                }
                if to - from > 0.05 {
                    sharpest[kind] = sharpest[kind].max(most / fitted.deviation);
                }
            }
            if kind == 3 {
                let bodies = [Moving::new(&body, &motion as &dyn RigidMotion), Moving::new(&point, &still)];
                let fitted = FittedTwists::new(&bodies, (0.0, 1e-4), DVec3::ZERO).unwrap();
                assert!(fitted.deviation < 1e-2 * 0.5 * 0.5e-4 * 0.5e-4 * 4.0, "{fitted:?}");
            }
        }
        assert!(sharpest[0] > 0.99 && sharpest[1] > 0.9, "{sharpest:?}");
    }
}
