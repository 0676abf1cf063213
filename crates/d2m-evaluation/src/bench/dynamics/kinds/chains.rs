//! Chains: of rings that hang in each other, of bars on joints; ropes of light rods with a load.
use super::super::scene::{Error, Scene, tree};
use super::law::{gets_along, never_more};
use super::solids::cuboid;
use super::trial::{Case, GAP, Trial, free, still, under};
use d2m::motion::Pose;
use d2m_dynamics::{Joint, JointKind, Mass};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;

pub(super) fn cases(cases: &mut Vec<Case>) {
    for (count, seconds) in [(3, 1.0), (10, 1.0), (30, 1.0), (60, 0.5), (70, 0.5), (100, 0.5)] {
        cases
            .push(Case::new("chain", format!("of {count} rings"), seconds, move |scene| rings(scene, count)));
    }
    for (count, seconds) in [(10, 2.0), (30, 1.0), (100, 0.5)] {
        for (how, degrees) in [("upright", 0.0), ("level", 90.0)] {
            let variant = format!("of {count} bars that begins {how}");
            cases.push(Case::new("chain", variant, seconds, move |scene| bars(scene, count, degrees)));
        }
    }
    for ratio in [1e5, 1e6, 1e7] {
        for (count, how) in [(10, Hung::Slack), (10, Hung::Oblique), (10, Hung::Upright), (50, Hung::Upright)]
        {
            let variant = format!("of {count} rods under {ratio:.0e}, {how:?}");
            cases.push(Case::new("rope", variant, 1.5, move |scene| rope(scene, count, how, ratio)));
        }
    }
}

/// How a rope begins.
#[derive(Clone, Copy, Debug)]
enum Hung {
    /// Its load falls until it is taut.
    Slack,
    /// It swings.
    Oblique,
    /// It hangs, and its load by a corner, about which that swings.
    Upright,
}

/// Rings that hang in each other, the first one held: centers of neighbors keep within twice what the inner radius is above the tube's.
fn rings(mut scene: Scene, count: usize) -> Result<Trial, Error> {
    let (scale, tube) = (0.2, 0.2);
    // The torus has an outer radius of 1, and facets within it.
    let shape = tree(&format!("torus?triangles=192&tube={tube}&scale={scale}"))?;
    let inner = shape.mesh().vertices().iter().map(|p| p.truncate().length()).fold(f64::INFINITY, f64::min);
    let thick = scale - inner;
    // The inner edges of the two rings rest on each other: from center to center the inner diameter, less the gap.
    let pitch = 2.0 * inner - GAP - 0.1 * thick;
    for k in 0..count {
        let turn = DQuat::from_rotation_y(0.5 * PI * (k % 2) as f64);
        let place = DVec3::NEG_Y * (pitch * k as f64);
        let ring = if k == 0 { still("held", &shape, 0.3) } else { free(format!("ring {k}"), &shape, 0.3) };
        scene.add(ring.with_position(place).with_orientation(turn))?;
    }
    let apart = move |poses: &[Pose]| {
        let between = |pair: &[Pose]| pair[0].translation.distance(pair[1].translation);
        poses.windows(2).map(between).fold(0.0, f64::max)
    };
    // Where tubes cross, facets are within the true torus, by up to a tenth of the tube.
    let laws = vec![never_more("the distance of neighbors", 2.0 * inner + 0.2 * thick, apart)];
    under(scene, laws)
}

/// Bars on spherical joints, hung at one end: joints hold, energy is not gained; what hangs stays, what begins level falls.
fn bars(mut scene: Scene, count: usize, degrees: f64) -> Result<Trial, Error> {
    let half = 0.1;
    let shape = cuboid(DVec3::new(0.02, half, 0.02))?;
    let turn = DQuat::from_rotation_z(degrees.to_radians());
    let down = turn * DVec3::NEG_Y;
    let (mut last, mut joints) = (None, Vec::new());
    for k in 0..count {
        let point = down * (2.0 * half * k as f64);
        let body = free(format!("bar {k}"), &shape, 0.0).with_orientation(turn);
        let id = scene.add(body.with_position(point + down * half))?;
        joints.push(match last {
            None => Joint::new(JointKind::Spherical, id, None, point),
            Some(last) => Joint::new(JointKind::Spherical, last, Some(id), point),
        });
        last = Some(id);
    }
    // The world takes a place among the bodies: behind them.
    joints.into_iter().try_for_each(|joint| scene.join(joint))?;
    let Some(last) = last else { return Err("no bar".into()) };
    if degrees == 0.0 {
        return under(scene, vec![super::law::stays(GAP)]);
    }
    under(scene, vec![gets_along(last, DVec3::NEG_Y, 0.1)])
}

/// Rods on spherical joints, hung at one end, with a box so many times as heavy at the other end: the rope holds it, and no energy is gained.
fn rope(mut scene: Scene, count: usize, how: Hung, ratio: f64) -> Result<Trial, Error> {
    let (half, size) = (0.05, 0.15);
    let shape = cuboid(DVec3::new(half, 0.01, 0.01))?;
    let point = |k: usize| match how {
        Hung::Slack => DVec3::new(0.08 * (k % 2) as f64, -0.06 * k as f64, 0.0),
        Hung::Oblique => DVec3::new(0.6, -0.8, 0.0) * (2.0 * half * k as f64),
        Hung::Upright => DVec3::NEG_Y * (2.0 * half * k as f64),
    };
    let (mut last, mut joints) = (None, Vec::new());
    for k in 0..=count {
        let from = point(k);
        let body = if k < count {
            let way = point(k + 1) - from;
            let rod = free(format!("rod {k}"), &shape, 0.0).with_mass(Mass::Total(0.1));
            rod.with_position(from + way * 0.5)
                .with_orientation(DQuat::from_rotation_arc(DVec3::X, way.normalize()))
        } else {
            let load = free("load", &cuboid(DVec3::splat(size))?, 0.0).with_mass(Mass::Total(0.1 * ratio));
            load.with_position(from + DVec3::new(size, -size - GAP, 0.0))
        };
        let id = scene.add(body)?;
        joints.push(match last {
            None => Joint::new(JointKind::Spherical, id, None, from),
            Some(last) => Joint::new(JointKind::Spherical, last, Some(id), from),
        });
        last = Some(id);
    }
    joints.into_iter().try_for_each(|joint| scene.join(joint))?;
    let Some(load) = last else { return Err("no load".into()) };
    let longest = 2.0 * half * count as f64 + 2.0 * size;
    let far = |poses: &[Pose]| poses.iter().map(|pose| pose.translation.length()).fold(0.0, f64::max);
    let mut laws = vec![never_more("the distance from the top", longest, far)];
    if !matches!(how, Hung::Upright) {
        laws.push(gets_along(load, DVec3::NEG_Y, 0.03));
    }
    under(scene, laws)
}
