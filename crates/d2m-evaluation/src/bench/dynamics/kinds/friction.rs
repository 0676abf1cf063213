//! What friction holds, and what it does not: inclines, turntables, wedges, chucks, tongs, sliding to a stop.
use super::super::scene::{Error, Scene};
use super::law::{gets_along, goes, never_more, rests, stays};
use super::solids::{cuboid, prism};
use super::trial::{Case, GAP, GRAVITY, Trial, floor, free, still, under};
use d2m::bvh::MeshTree;
use d2m::motion::ConstantTwist;
use d2m_dynamics::{Joint, JointKind, Mass, Motor, MotorTarget};
use glam::{DQuat, DVec2, DVec3};
use std::sync::Arc;

/// The part of a gap by which what friction holds may move.
const HELD: f64 = GAP / 4.0;

pub(super) fn cases(cases: &mut Vec<Case>) {
    for degrees in [10.0, 26.565, 45.0] {
        for ratio in [0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.01, 1.1, 2.0] {
            let variant = format!("of {degrees} degrees at {ratio} of its limit");
            cases.push(Case::new("incline", variant, 2.0, move |scene| incline(scene, degrees, ratio)));
        }
    }
    for ratio in [0.5, 0.9, 0.99, 1.05, 1.5] {
        let variant = format!("at {ratio} of its limit");
        cases.push(Case::new("turntable", variant, 2.0, move |scene| turntable(scene, ratio)));
    }
    for slope in [0.05, 0.12, 0.3, 0.6] {
        let variant = format!("of slope {slope} that falls out");
        cases.push(Case::new("wedge", variant, 0.5, move |scene| hanging(scene, slope)));
        for ratio in [0.0, 0.5, 2.0] {
            let variant = format!("of slope {slope} dropped with {ratio} of the friction that holds it");
            cases.push(Case::new("wedge", variant, 1.5, move |scene| dropped(scene, slope, ratio)));
        }
        let variant = format!("of slope {slope} that rests");
        cases.push(Case::new("wedge", variant, 2.0, move |scene| keystone(scene, slope)));
    }
    for (degrees, mass) in [(7.0, 1e2), (7.0, 1e4), (7.0, 1e6), (15.0, 1e3), (15.0, 1e5)] {
        for ratio in [1.2, 0.5] {
            let variant =
                format!("of {degrees} degrees and {mass:.0} kg with {ratio} of the friction it takes");
            cases.push(Case::new("chuck", variant, 0.5, move |scene| chuck(scene, degrees, mass, ratio)));
        }
    }
    for ratio in [1.02, 1.5, 10.0, 1e4, 0.98, 0.5] {
        let variant = format!("with {ratio} of the force they take");
        cases.push(Case::new("tongs", variant, 0.75, move |scene| tongs(scene, ratio)));
    }
    for friction in [0.05, 0.3, 0.8] {
        for speed in [0.5, 3.0] {
            let (time, variant) =
                (speed / (friction * GRAVITY), format!("at {speed} m/s with friction {friction}"));
            cases.push(Case::new("slide", variant, time + 0.5, move |scene| slide(scene, friction, speed)));
        }
    }
}

/// A flat box on a slope whose tangent is this part of the coefficient of friction.
fn incline(mut scene: Scene, degrees: f64, ratio: f64) -> Result<Trial, Error> {
    let (turn, slope) = (DQuat::from_rotation_z(degrees.to_radians()), degrees.to_radians().tan());
    let friction = slope / ratio;
    let ground = still("slope", &cuboid(DVec3::new(30.0, 0.5, 5.0))?, friction);
    scene.add(ground.with_orientation(turn).with_position(turn * (DVec3::NEG_Y * 0.5)))?;
    let body = free("box", &cuboid(DVec3::new(0.4, 0.1, 0.3))?, friction).with_orientation(turn);
    let id = scene.add(body.with_position(turn * (DVec3::Y * (0.1 + GAP))))?;
    let pull = GRAVITY * degrees.to_radians().cos() * (slope - friction).max(0.0);
    let way = 0.5 * pull * scene.seconds * scene.seconds;
    let within = if ratio > 1.0 { GAP + 1e-3 * way } else { HELD };
    under(scene, vec![goes(id, turn * (DVec3::NEG_X * way), within)])
}

/// A box that turns with a table: held as long as the acceleration is below that of friction.
fn turntable(mut scene: Scene, ratio: f64) -> Result<Trial, Error> {
    let (friction, radius): (f64, f64) = (0.5, 2.0);
    let rate = (ratio * friction * GRAVITY / radius).sqrt();
    let table = free("table", &cuboid(DVec3::new(20.0, 0.5, 20.0))?, friction);
    let spin = DVec3::Y * rate;
    let motion = ConstantTwist::REST.with_position(DVec3::NEG_Y * 0.5).with_angular_velocity(spin);
    scene.drive(table, motion)?;
    let place = DVec3::new(radius, 0.1 + GAP, 0.0);
    let body = free("box", &cuboid(DVec3::new(0.2, 0.1, 0.2))?, friction).with_position(place);
    let body = body.with_linear_velocity(spin.cross(place)).with_angular_velocity(spin);
    let k = scene.add(body)?.index();
    let out = move |poses: &[d2m::motion::Pose]| {
        DVec2::new(poses[k].translation.x, poses[k].translation.z).length()
    };
    if ratio < 1.0 {
        return under(scene, vec![never_more("its distance", radius + 2.0 * GAP, out)]);
    }
    // It gains at least half of what it would if its distance stayed what it is.
    let least = radius + 0.25 * (ratio - 1.0) * friction * GRAVITY * scene.seconds * scene.seconds;
    under(
        scene,
        vec![super::law::Law::new(format!("it ends {least} from the axis or further"), move |ran| {
            let found = out(&ran.track[ran.track.len() - 1].1);
            (found < least).then(|| format!("it ends {found} from the axis, not {least} at least"))
        })],
    )
}

/// A prism of height 1 whose sides lean by this slope; narrow below for positive ones.
fn leaning(slope: f64) -> Result<Arc<MeshTree>, Error> {
    let half = |y: f64| 0.4 + slope * y;
    let at = |x: f64, y: f64| DVec2::new(x, y);
    prism(&[at(-half(-0.5), -0.5), at(half(-0.5), -0.5), at(half(0.5), 0.5), at(-half(0.5), 0.5)], 0.5)
}

/// A stone between two jaws that stand still, a gap from each.
fn between_jaws(scene: &mut Scene, slope: f64, friction: f64) -> Result<d2m_dynamics::BodyId, Error> {
    let id = scene.add(free("stone", &leaning(slope)?, friction))?;
    jaws(scene, slope, friction)?;
    Ok(id)
}

/// Jaws that stand still, which a stone of this slope fits a gap from each.
fn jaws(scene: &mut Scene, slope: f64, friction: f64) -> Result<(), Error> {
    let x = 0.8 + GAP * (1.0 + slope * slope).sqrt();
    for side in [-1.0, 1.0] {
        let jaw = still(format!("jaw {side}"), &leaning(-slope)?, friction);
        scene.add(jaw.with_position(DVec3::X * (x * side)))?;
    }
    Ok(())
}

/// A stone that is wider below falls freely if friction has not the slope.
fn hanging(mut scene: Scene, slope: f64) -> Result<Trial, Error> {
    let id = between_jaws(&mut scene, -slope, 0.9 * slope)?;
    let fallen = 0.5 * GRAVITY * scene.seconds * scene.seconds;
    under(scene, vec![goes(id, DVec3::NEG_Y * fallen, 0.02 * fallen)])
}

/// A stone that is wider above falls by 5 cm into its jaws, and comes to rest there.
fn dropped(mut scene: Scene, slope: f64, ratio: f64) -> Result<Trial, Error> {
    let height = 0.05;
    let stone = free("stone", &leaning(slope)?, ratio * slope).with_position(DVec3::Y * height);
    let id = scene.add(stone)?;
    jaws(&mut scene, slope, ratio * slope)?;
    // What it keeps to the jaws is a gap or more.
    under(scene, vec![goes(id, DVec3::NEG_Y * height, GAP / slope + GAP), rests(1e-3)])
}

/// A stone that is wider above rests without friction.
fn keystone(mut scene: Scene, slope: f64) -> Result<Trial, Error> {
    between_jaws(&mut scene, slope, 0.0)?;
    under(scene, vec![stays(HELD), rests(1e-3)])
}

/// A stone between two wedges of 100 kg or so that its weight pulls into a conical housing, which they slide on without friction: held if the
/// friction at the stone is at least the tangent of the housing's angle, times what part of the load the stone is.
fn chuck(mut scene: Scene, degrees: f64, mass: f64, ratio: f64) -> Result<Trial, Error> {
    let (slope, light) = (degrees.to_radians().tan(), 100.0);
    let needed = slope * 0.5 * mass / (0.5 * mass + light);
    let friction = ratio * needed;
    let stone = free("stone", &cuboid(DVec3::new(0.3, 0.6, 0.5))?, 2.0 * friction);
    let stone = scene.add(stone.with_mass(Mass::Total(mass)))?;
    let half = |y: f64| slope * y;
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        // The wedge: upright inside, leaning outside; mirrored by a half turn about y.
        let turn = if side > 0.0 { DQuat::IDENTITY } else { DQuat::from_rotation_y(core::f64::consts::PI) };
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let jaw =
            prism(&[at(0.0, -0.4), at(0.3 + half(-0.4), -0.4), at(0.3 + half(0.4), 0.4), at(0.0, 0.4)], 0.4)?;
        let wedge = free(format!("{name} wedge"), &jaw, 0.0).with_mass(Mass::Total(light));
        let x = 0.3 + GAP;
        scene.add(wedge.with_orientation(turn).with_position(DVec3::X * (x * side)))?;
        let wall =
            prism(&[at(0.3 + half(-1.0), -1.0), at(1.0, -1.0), at(1.0, 1.0), at(0.3 + half(1.0), 1.0)], 1.0)?;
        let wall = still(format!("{name} wall"), &wall, 0.0).with_orientation(turn);
        scene.add(wall.with_position(DVec3::X * ((x + GAP * (1.0 + slope * slope).sqrt()) * side)))?;
    }
    if ratio > 1.0 {
        return under(scene, vec![stays(2.0 * GAP)]);
    }
    // The wedges bear the friction of the stone and their own weight.
    let normal = light * GRAVITY / (slope - friction);
    let pull = GRAVITY - 2.0 * friction * normal / mass;
    let fallen = 0.5 * pull * scene.seconds * scene.seconds;
    under(scene, vec![goes(stone, DVec3::NEG_Y * fallen, 2.0 * GAP + 0.02 * fallen)])
}

/// Two jaws on rails that motors press on a stone: they hold it with twice the friction of a force.
fn tongs(mut scene: Scene, ratio: f64) -> Result<Trial, Error> {
    let (friction, mass) = (0.4, 50.0);
    let force = ratio * mass * GRAVITY / (2.0 * friction);
    let stone = free("stone", &cuboid(DVec3::new(0.2, 0.2, 0.2))?, friction).with_mass(Mass::Total(mass));
    let stone = scene.add(stone)?;
    let mut rails = Vec::new();
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let place = DVec3::X * ((0.25 + GAP) * side);
        let jaw = free(format!("{name} jaw"), &cuboid(DVec3::new(0.05, 2.0, 0.3))?, friction);
        let jaw = scene.add(jaw.with_mass(Mass::Total(10.0)).with_position(place))?;
        let mut motor = Motor::new(MotorTarget::Velocity(1.0));
        motor.most = force;
        let axis = DVec3::X * side;
        rails.push(Joint::new(JointKind::Prismatic, jaw, None, place).with_axis(axis).with_motor(motor));
    }
    // The world takes a place among the bodies: behind them.
    rails.into_iter().try_for_each(|rail| scene.join(rail))?;
    let pull = GRAVITY - 2.0 * friction * force / mass;
    let fallen = if ratio < 1.0 { 0.5 * pull * scene.seconds * scene.seconds } else { 0.0 };
    under(scene, vec![goes(stone, DVec3::NEG_Y * fallen, GAP + 0.02 * fallen)])
}

/// A box that friction brings to rest after v²/(2 μ g).
fn slide(mut scene: Scene, friction: f64, speed: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, friction)?)?;
    let body = free("box", &cuboid(DVec3::new(0.4, 0.1, 0.3))?, friction);
    let body = body.with_position(DVec3::new(-10.0, 0.1 + GAP, 0.0));
    let id = scene.add(body.with_linear_velocity(DVec3::X * speed))?;
    let way = speed * speed / (2.0 * friction * GRAVITY);
    under(scene, vec![goes(id, DVec3::X * way, GAP + 1e-3 * way), rests(1e-3), gets_along(id, DVec3::X, 0.0)])
}
