//! Mechanisms that motors drive: linkages, arms with loads, cranes with loads on ropes of light rods.
use super::super::scene::{Error, Scene};
use super::law::{Law, goes, never_more};
use super::solids::cuboid;
use super::trial::{Case, GAP, Trial, floor, free, still, under};
use d2m::motion::Pose;
use d2m_dynamics::{Body, BodyId, Joint, JointKind, Mass, Motor, MotorTarget};
use glam::{DQuat, DVec3};

/// The greatest force or torque of a motor: as much as it takes.
const MOST: f64 = 1e12;

pub(super) fn cases(cases: &mut Vec<Case>) {
    for (how, beside) in [("in a plane", 0.0), ("beside each other", 0.05)] {
        for density in [1e3, 1e6, 1e9] {
            for rate in [5.0, 50.0] {
                let variant = format!("{how} at {rate} rad/s with a rocker of {density:.0e} kg/m³");
                let build = move |scene| linkage(scene, beside, density, rate);
                cases.push(Case::new("linkage", variant, 0.5, build));
            }
        }
    }
    for load in [1.0, 1e2, 1e5] {
        for (count, beside) in [(3, 0.0), (6, 0.0), (6, 0.05)] {
            let variant = format!("of {count} links, {beside} beside each other, under {load:.0e} times one");
            cases.push(Case::new("arm", variant, 1.0, move |scene| arm(scene, count, beside, load)));
        }
    }
    for load in [1e3, 1e7] {
        for rate in [0.5, 2.0] {
            let variant = format!("at {rate} rad/s with {load:.0e} times a rod on ten of them");
            cases.push(Case::new("crane", variant, 0.5, move |scene| crane(scene, rate, load)));
        }
    }
    for mass in [1e-2, 1.0, 1e4] {
        for strength in [f64::INFINITY, MOST] {
            let variant = format!("of {strength:.0e} N on a box of {mass:.0e} times its mass");
            let build = move |scene| pressed(scene, mass, strength);
            cases.push(Case::new("motor press", variant, 2.0, build));
            let variant =
                format!("of {strength:.0e} N that drives boxes of {mass:.0e} times its mass at a wall");
            cases.push(Case::new("ram", variant, 2.0, move |scene| ram(scene, mass, strength)));
        }
    }
    for strength in [f64::INFINITY, MOST] {
        let variant = format!("whose fingers close on a box with {strength:.0e} Nm");
        cases.push(Case::new("gripper", variant, 2.0, move |scene| gripper(scene, strength)));
    }
}

fn hinge(a: BodyId, b: Option<BodyId>, point: DVec3) -> Joint {
    Joint::new(JointKind::Revolute, a, b, point).with_axis(DVec3::Z)
}

fn strong(target: MotorTarget) -> Motor {
    let mut motor = Motor::new(target);
    motor.most = MOST;
    motor
}

/// A bar between two points, with room at its ends.
fn bar(name: impl Into<String>, [from, to]: [DVec3; 2], thick: f64) -> Result<Body, Error> {
    let (middle, way) = ((from + to) * 0.5, to - from);
    let shape = cuboid(DVec3::new(0.45 * way.length(), thick, thick))?;
    let turn = DQuat::from_rotation_arc(DVec3::X, way.normalize());
    Ok(free(name, &shape, 0.0).with_position(middle).with_orientation(turn))
}

/// A joint turns at its motor's speed: at the end it is where that leads, up to `within`.
fn follows(joint: usize, rate: f64, within: f64) -> Law {
    Law::new(format!("joint {joint} turns at {rate} rad/s, up to {within:.0e} rad"), move |ran| {
        let simulation = &ran.scene.simulation;
        let off = (simulation.joint_value(joint) - rate * simulation.time()).abs();
        (off > within || off.is_nan()).then(|| format!("joint {joint} is {off:.3e} rad off"))
    })
}

/// A crank, a rod and a rocker, in a plane or beside each other: the crank turns at its motor's speed, however heavy the rocker.
fn linkage(mut scene: Scene, beside: f64, density: f64, rate: f64) -> Result<Trial, Error> {
    let (crank, ground) = (DVec3::new(0.7, 0.7, 0.0) * 0.2, DVec3::X * 0.9);
    // Where a rod of 0.8 and a rocker of 0.6 meet.
    let way = ground - crank;
    let along = (0.64 - 0.36 + way.length_squared()) / (2.0 * way.length());
    let unit = way.normalize();
    let meet = crank + unit * along + DVec3::Z.cross(unit) * (0.64 - along * along).sqrt();
    let mut part = |name: &str, ends: [DVec3; 2], place: f64, density: f64| {
        let body = bar(name, ends.map(|end| end + DVec3::Z * (place * beside)), 0.02)?;
        scene.add(body.with_mass(Mass::Density(density)))
    };
    let first = part("crank", [DVec3::ZERO, crank], 0.0, 1e3)?;
    let rod = part("rod", [crank, meet], 1.0, 1e3)?;
    let rocker = part("rocker", [meet, ground], 2.0, density)?;
    // The world takes a place among the bodies: behind them.
    scene.join(hinge(first, None, DVec3::ZERO).with_motor(strong(MotorTarget::Velocity(-rate))))?;
    scene.join(hinge(first, Some(rod), crank))?;
    scene.join(hinge(rod, Some(rocker), meet))?;
    scene.join(hinge(rocker, None, ground))?;
    under(scene, vec![follows(0, -rate, 1e-4)])
}

/// Links on hinges about z and y in turn, each with a motor, the last one so many times as heavy as the others: each turns at its motor's speed.
fn arm(mut scene: Scene, count: usize, beside: f64, load: f64) -> Result<Trial, Error> {
    let rate = 0.5;
    let (mut last, mut joints) = (None, Vec::new());
    for k in 0..count {
        let point = DVec3::new(0.3 * k as f64, 0.0, beside * k as f64);
        let mass = if k + 1 == count { load } else { 1.0 };
        let link = bar(format!("link {k}"), [point, point + DVec3::X * 0.3], 0.02)?;
        let id = scene.add(link.with_mass(Mass::Total(mass)))?;
        let joint = match last {
            None => hinge(id, None, point),
            Some(last) => hinge(last, Some(id), point),
        };
        let axis = if k % 2 == 0 { DVec3::Z } else { DVec3::Y };
        joints.push(joint.with_axis(axis).with_motor(strong(MotorTarget::Velocity(rate))));
        last = Some(id);
    }
    joints.into_iter().try_for_each(|joint| scene.join(joint))?;
    under(scene, (0..count).map(|joint| follows(joint, rate, 1e-4)).collect())
}

/// A jib that a motor lifts, with a load on a rope of ten light rods at its end: the jib turns at the motor's speed, and the rope holds.
fn crane(mut scene: Scene, rate: f64, load: f64) -> Result<Trial, Error> {
    let (count, pitch, size) = (10, 0.1, 0.1);
    let jib = bar("jib", [DVec3::ZERO, DVec3::X], 0.03)?.with_mass(Mass::Total(50.0));
    let jib = scene.add(jib)?;
    let (mut last, mut joints) = (jib, Vec::new());
    joints.push(hinge(jib, None, DVec3::ZERO).with_motor(strong(MotorTarget::Velocity(rate))));
    for k in 0..=count {
        let point = DVec3::X + DVec3::NEG_Y * (pitch * k as f64);
        let body = if k < count {
            let rod = bar(format!("rod {k}"), [point, point + DVec3::NEG_Y * pitch], 0.01)?;
            rod.with_mass(Mass::Total(0.1))
        } else {
            let load = free("load", &cuboid(DVec3::splat(size))?, 0.0).with_mass(Mass::Total(0.1 * load));
            load.with_position(point + DVec3::NEG_Y * size)
        };
        let id = scene.add(body)?;
        joints.push(Joint::new(JointKind::Spherical, last, Some(id), point));
        last = id;
    }
    joints.into_iter().try_for_each(|joint| scene.join(joint))?;
    let (first, end) = (jib.index(), last.index());
    let far = move |poses: &[Pose]| {
        // The jib's end is as far from its middle as the hinge.
        let tip = poses[first].translation * 2.0;
        poses[end].translation.distance(tip)
    };
    let longest = pitch * count as f64 + 3f64.sqrt() * size;
    under(scene, vec![follows(0, rate, 1e-4), never_more("the length of the rope", longest, far)])
}

/// Along an axis in the world, at half a unit a second.
fn slide(body: BodyId, axis: DVec3, point: DVec3, strength: f64) -> Joint {
    let mut motor = Motor::new(MotorTarget::Velocity(-0.5));
    motor.most = strength;
    Joint::new(JointKind::Prismatic, body, None, point).with_axis(axis).with_motor(motor)
}

/// A head that a motor lowers onto a box stops a gap above it.
fn pressed(mut scene: Scene, mass: f64, strength: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let body = free("box", &cuboid(DVec3::splat(0.3))?, 0.5).with_mass(Mass::Total(100.0 * mass));
    let body = scene.add(body.with_position(DVec3::new(0.1, 0.3 + GAP, 0.0)))?;
    let head = free("head", &cuboid(DVec3::new(0.4, 0.1, 0.4))?, 0.5).with_mass(Mass::Total(100.0));
    let head = scene.add(head.with_position(DVec3::Y))?;
    scene.join(slide(head, DVec3::NEG_Y, DVec3::Y, strength))?;
    let way = DVec3::NEG_Y * (0.3 - 2.0 * GAP);
    under(scene, vec![goes(head, way, GAP), goes(body, DVec3::ZERO, GAP)])
}

/// A ram that a motor drives packs two boxes between itself and a wall.
fn ram(mut scene: Scene, mass: f64, strength: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let wall = still("wall", &cuboid(DVec3::new(0.1, 1.0, 1.0))?, 0.5);
    scene.add(wall.with_position(DVec3::new(0.6, 1.0, 0.0)))?;
    let shape = cuboid(DVec3::splat(0.2))?;
    let mut part = |name: &str, mass: f64, x: f64| {
        let body = free(name, &shape, 0.5).with_mass(Mass::Total(mass));
        scene.add(body.with_position(DVec3::new(x, 0.2 + GAP, 0.0)))
    };
    let ram = part("ram", 64.0, -1.0)?;
    part("first", 64.0 * mass, -0.4)?;
    part("second", 64.0 * mass, 0.1)?;
    scene.join(slide(ram, DVec3::X, DVec3::NEG_X, strength))?;
    under(scene, vec![goes(ram, DVec3::X * (0.5 - 3.0 * GAP), 2.0 * GAP)])
}

/// Two fingers on hinges close on a box that stands on a post: it stays there.
fn gripper(mut scene: Scene, strength: f64) -> Result<Trial, Error> {
    let post = still("post", &cuboid(DVec3::new(0.1, 0.5, 0.1))?, 0.5);
    scene.add(post.with_position(DVec3::Y * 0.5))?;
    let body = free("box", &cuboid(DVec3::splat(0.15))?, 0.5);
    let body = scene.add(body.with_position(DVec3::Y * (1.15 + GAP)))?;
    let finger = cuboid(DVec3::new(0.04, 0.4, 0.1))?;
    let mut joints = Vec::new();
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let finger = free(name, &finger, 0.5).with_position(DVec3::new(0.3 * side, 1.5, 0.0));
        let finger = scene.add(finger)?;
        let mut motor = Motor::new(MotorTarget::Velocity(0.7 * side));
        motor.most = strength;
        let point = DVec3::new(0.3 * side, 1.92, 0.0);
        joints.push(hinge(finger, None, point).with_motor(motor));
    }
    // The world takes a place among the bodies: behind them.
    joints.into_iter().try_for_each(|joint| scene.join(joint))?;
    under(scene, vec![goes(body, DVec3::ZERO, 0.02)])
}
