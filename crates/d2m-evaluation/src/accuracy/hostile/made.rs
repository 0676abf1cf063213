//! How families make bodies and scenes.
use super::guise::Guise;
use super::scene::{Body, HostileScene, PATIENT};
use d2m::Solid;
use d2m::motion::ConstantTwist;
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::{DQuat, DVec3};

pub(super) fn body(shape: Surface, x: DVec3, v: DVec3, w: DVec3) -> Body {
    let motion = ConstantTwist::try_new(x, DQuat::IDENTITY, v, w).expect("finite");
    Body { vertices: shape.vertices, triangles: shape.triangles, motion, guise: Guise::ConstantTwist }
}

pub(super) fn scene(a: Body, b: Body, planted: Vec<f64>) -> HostileScene {
    HostileScene {
        bodies: [a, b],
        window: [0.0, 1.0],
        solid: Solid::Filled,
        tolerance: None,
        min_separation: 0.0,
        is_early: false,
        is_parallel: false,
        budget: PATIENT,
        planted,
    }
}

/// A length between 10^lo and 10^hi.
pub(super) fn decade(random: &mut Random, lo: f64, hi: f64) -> f64 {
    10f64.powf(random.range(lo, hi))
}

/// The same motion expressed about another reference point of the body.
pub(super) fn about(body: Body, by: DVec3) -> Body {
    let m = body.motion;
    let motion = m.with_at(m.at() + by).with_position(m.position() + m.orientation().normalize() * by);
    // A body that turns about another point needs that point's velocity: v + ω × by, which changes with time; so only
    // bodies that do not turn, or turn about the direction of `by`, keep their motion.
    Body { motion, ..body }
}
