//! What moves come what may: drums, stirrers, presses, jaws, paddles, shafts in bearings.
use super::super::scene::{Error, Scene, tree};
use super::law::{Law, gets_along, is_crushed, never_more, stays};
use super::solids::{cuboid, globe, prism, regular, ring};
use super::trial::{Case, GAP, Trial, crushing, floor, free, still, under};
use d2m::bvh::MeshTree;
use d2m::motion::{ConstantTwist, Keyframes, Pose, Span};
use d2m_dynamics::{Body, SimulationOptions};
use d2m_testing::Xoshiro256;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// Of a driven body that leaves no room: the part of a gap of each contact that may be left when a run ends, from which on queries see none.
const LEFT: f64 = 1.0 / 64.0;

/// Paddles from which on boxes lie in a corner of two walls.
const CORNERED: u64 = 12;

pub(super) fn cases(cases: &mut Vec<Case>, seed: u64) {
    let build = move |scene| drum(scene, seed, 3.0, 80, true);
    cases.push(Case::new("drum", "at 3 rad/s with 80 pebbles", 0.5, build));
    for rate in [1.0, 3.0, 8.0] {
        for count in [1, 4, 12] {
            for (how, is_round) in [("boxes", false), ("pebbles", true)] {
                let build = move |scene| drum(scene, seed, rate, count, is_round);
                cases.push(Case::new("drum", format!("at {rate} rad/s with {count} {how}"), 1.5, build));
            }
        }
    }
    // Gaps of a thousandth of what turning leads into them in a step.
    for (gap, step) in [(1e-4, 0.01), (1e-5, 0.01), (1e-3, 0.1)] {
        let options = SimulationOptions::default().with_gap(gap).with_step(step);
        for rate in [3.0, 8.0] {
            for (count, how, is_round) in [(4, "boxes", false), (12, "boxes", false), (12, "pebbles", true)] {
                let build = move |scene| drum(scene, seed, rate, count, is_round);
                let variant =
                    format!("at {rate} rad/s with {count} {how}, a gap of {gap:.0e}, steps of {step}");
                cases.push(Case::new("drum", variant, 1.0, build).with_options(options));
            }
        }
    }
    for rate in [1.0, 4.0] {
        for count in [6, 16, 40] {
            let build = move |scene| stirrer(scene, seed, rate, count);
            cases.push(Case::new("stirrer", format!("at {rate} rad/s with {count} boxes"), 1.5, build));
        }
    }
    for count in [1, 2, 5] {
        for left in [0.4, 0.05, -0.01, -1.0] {
            let variant = format!("on {count} boxes that leaves {left} gaps");
            cases.push(Case::new("press", variant, 1.2, move |scene| press(scene, count, left)));
        }
    }
    for count in [3, 8, 20] {
        for friction in [0.0, 0.4, 0.8] {
            for (how, is_round) in [("boxes", false), ("pebbles", true)] {
                let variant = format!("of {count} {how} with friction {friction}");
                let build = move |scene| sweep(scene, seed, count, friction, is_round);
                cases.push(Case::new("sweep", variant, 1.2, build));
            }
        }
    }
    for degrees in [10.0, 25.0, 40.0] {
        for friction in [0.0, 0.3, 0.8] {
            let variant = format!("that close at {degrees} degrees with friction {friction}");
            cases.push(Case::new("jaws", variant, 1.0, move |scene| jaws(scene, degrees, friction)));
        }
    }
    for variant in 0..2 * CORNERED {
        let build = move |scene| paddle(scene, seed, variant);
        cases.push(Case::new("paddle", format!("variant {variant}"), 2.0, build));
    }
    for variant in CORNERED..2 * CORNERED {
        let build = move |scene| paddle(scene, seed, variant);
        let fine = SimulationOptions::default().with_gap(1e-5);
        let name = format!("variant {variant} at a gap of 1e-5");
        cases.push(Case::new("paddle", name, 2.0, build).with_options(fine));
    }
    let fine = SimulationOptions::default().with_gap(2e-4);
    for rate in [10.0, 100.0] {
        for friction in [0.0, 0.1] {
            for sides in [16, 48] {
                let variant = format!("of {sides} sides at {rate} rad/s with friction {friction}");
                let build = move |scene| bearing(scene, sides, rate, friction);
                cases.push(Case::new("bearing", variant, 0.5, build).with_options(fine));
            }
        }
    }
    for sides in [12, 48] {
        for gap in [1e-4, 1e-5] {
            let variant = format!("of {sides} sides that turns a wheel; a gap of {gap:e}");
            let build = move |scene| axle(scene, sides, 30.0);
            let fine = SimulationOptions::default().with_gap(gap);
            cases.push(Case::new("axle", variant, 0.5, build).with_options(fine));
        }
    }
    for (meridians, gap, friction, restitution) in
        [(16, 4e-4, 0.3, 0.5), (12, 3e-6, 0.0, 0.0), (8, 1e-5, 0.3, 0.0), (12, 1e-3, 0.3, 0.0)]
    {
        let variant =
            format!("of {meridians} meridians that turn; friction {friction}, restitution {restitution}");
        let build = move |scene| shells(scene, meridians, friction, restitution);
        let fine = SimulationOptions::default().with_gap(gap);
        cases.push(Case::new("shells", variant, 0.6, build).with_options(fine));
    }
    for sides in [3, 4, 6] {
        for rate in [5.0, 20.0] {
            let variant = format!("of {sides} sides in a hole that turns at {rate} rad/s");
            cases.push(Case::new("peg", variant, 1.0, move |scene| peg(scene, sides, rate)));
        }
    }
}

/// Two small solids that are not alike, of a radius of about 0.1.
fn grain(is_round: bool, k: usize) -> Result<Arc<MeshTree>, Error> {
    if is_round {
        return tree(&format!("pebble?triangles=100&seed={}&scale=0.1", k % 3));
    }
    cuboid([DVec3::new(0.1, 0.06, 0.08), DVec3::new(0.07, 0.07, 0.07), DVec3::new(0.12, 0.05, 0.05)][k % 3])
}

/// Grains within a ring that turns about its axis, which is level, between two plates.
fn drum(mut scene: Scene, seed: u64, rate: f64, count: usize, is_round: bool) -> Result<Trial, Error> {
    let (inner, half) = (1.0, 0.35);
    let shell = free("drum", &ring(24, [inner, 1.1], half)?, 0.5);
    scene.drive(shell, ConstantTwist::REST.with_angular_velocity(DVec3::Z * rate))?;
    let plate = cuboid(DVec3::new(1.2, 1.2, 0.1))?;
    for side in [-1.0, 1.0] {
        let plate = still(format!("plate {side}"), &plate, 0.3);
        scene.add(plate.with_position(DVec3::Z * (side * (half + 0.1 + 0.5 * GAP))))?;
    }
    let mut random = Xoshiro256::new(seed);
    // Below first.
    let pitch = if is_round { 0.24 } else { 0.28 };
    let grid = |k: usize| pitch * ((k % 8) as f64 - 3.5);
    let layers = if is_round { [-0.22, 0.0, 0.22].as_slice() } else { &[-0.14, 0.14] };
    let section = (0..64).map(|k| DVec2::new(grid(k), grid(k / 8))).filter(|at| at.length() < 0.82);
    let places = section.flat_map(|at| layers.iter().map(move |&z| at.extend(z)));
    for (k, place) in places.take(count).enumerate() {
        let jitter = DVec3::new(random.range(-0.01, 0.01), random.range(-0.01, 0.01), 0.0);
        let body = free(format!("grain {k}"), &grain(is_round, k)?, 0.5).with_position(place + jitter);
        scene.add(body.with_orientation(random.rotation()))?;
    }
    if scene.ids.len() < count {
        return Err(format!("a drum has no room for {count}").into());
    }
    let ids: Vec<usize> = scene.ids.iter().map(|id| id.index()).collect();
    let out = move |poses: &[Pose]| {
        ids.iter().map(|&k| poses[k].translation.truncate().length()).fold(0.0, f64::max)
    };
    under(scene, vec![never_more("distance from the axis", inner, out)])
}

/// A blade that turns about the vertical among boxes on the floor of a round bin.
fn stirrer(mut scene: Scene, seed: u64, rate: f64, count: usize) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.4)?)?;
    let level = DQuat::from_rotation_x(-0.5 * PI);
    let bin = still("bin", &ring(20, [1.3, 1.5], 3.0)?, 0.4).with_orientation(level);
    scene.add(bin.with_position(DVec3::Y * (3.0 + GAP)))?;
    let blade = free("blade", &cuboid(DVec3::new(0.9, 0.12, 0.03))?, 0.4);
    let motion = ConstantTwist::REST.with_position(DVec3::Y * 0.14).with_angular_velocity(DVec3::Y * rate);
    scene.drive(blade, motion)?;
    let mut random = Xoshiro256::new(seed);
    for k in 0..count {
        let (ring, place) = (k / 8, k % 8);
        let angle = PI * (0.25 * place as f64 + 0.06);
        let out = DVec2::from_angle(angle) * (0.75 + 0.05 * random.unit());
        let at = DVec3::new(out.x, 0.5 + 0.3 * ring as f64, out.y);
        let body = free(format!("box {k}"), &grain(false, k)?, 0.4).with_position(at);
        scene.add(body.with_orientation(random.rotation()))?;
    }
    let ids: Vec<usize> = scene.ids.iter().map(|id| id.index()).collect();
    let out = move |poses: &[Pose]| {
        let of = |&k: &usize| DVec2::new(poses[k].translation.x, poses[k].translation.z).length();
        ids.iter().map(of).fold(0.0, f64::max)
    };
    under(scene, vec![never_more("distance from the axis", 1.3, out)])
}

/// A motion along a straight line that ends after a second, and what follows stands still.
fn pushed(from: DVec3, way: DVec3) -> Result<Keyframes, Error> {
    let at = |x: DVec3| Pose { translation: x, ..Pose::IDENTITY };
    let poses = [(0.0, at(from)), (1.0, at(from + way)), (9.0, at(from + way))];
    Ok(Keyframes::try_new(&poses, Span::Linear)?)
}

/// A press that comes down on boxes on each other and leaves so many gaps in all for the contacts of one more than there are.
fn press(mut scene: Scene, count: u32, left: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.3)?)?;
    let (shape, high) = (cuboid(DVec3::splat(0.3))?, 0.6);
    for k in 0..count {
        let place = DVec3::Y * (0.3 + GAP + (high + GAP) * f64::from(k));
        scene.add(free(format!("box {k}"), &shape, 0.3).with_position(place))?;
    }
    let solid = high * f64::from(count);
    // From half a meter above to what is to be left.
    let (from, to) = (solid + 0.5, solid + left * GAP);
    let plate = free("press", &cuboid(DVec3::new(1.0, 0.2, 1.0))?, 0.3);
    scene.drive(plate, pushed(DVec3::Y * (from + 0.2), DVec3::Y * (to - from))?)?;
    if left < 0.0 {
        let (speed, contacts) = (from - to, f64::from(count + 1));
        let end = (from - solid) / speed;
        return Ok(crushing(scene, is_crushed(end - contacts * LEFT * GAP / speed, end)));
    }
    under(scene, vec![stays(2.0 * GAP * f64::from(count))])
}

/// Two plates that close in on a prism of twelve sides on a floor, with an angle between them: it must slip out where they are wide, whether friction
/// would hold it or not.
fn jaws(mut scene: Scene, degrees: f64, friction: f64) -> Result<Trial, Error> {
    let (radius, speed) = (0.2, 0.1);
    scene.add(floor(0.0, friction)?)?;
    let stone = prism(&regular(12, radius), 0.15)?;
    let upright = DQuat::from_rotation_x(-0.5 * PI);
    let stone = free("stone", &stone, friction).with_orientation(upright);
    let id = scene.add(stone.with_position(DVec3::Y * (0.15 + GAP)))?;
    let plate = cuboid(DVec3::new(2.0, 0.4, 0.1))?;
    for side in [-1.0, 1.0] {
        // Its face leans by half of the angle; wide towards +x.
        let turn = DQuat::from_rotation_y(-side * 0.5 * degrees.to_radians());
        let normal = turn * (DVec3::Z * side);
        let motion = ConstantTwist::REST
            .with_orientation(turn)
            .with_position(normal * (radius + 0.1 + 2.0 * GAP) + DVec3::Y * (0.4 + GAP))
            .with_linear_velocity(DVec3::Z * (-side * speed));
        scene.drive(free(format!("jaw {side}"), &plate, friction), motion)?;
    }
    // Where each of the plates moves by v, what they hold moves by v over the tangent of half the angle; it may turn on a side meanwhile.
    let way = speed * scene.seconds / (0.5 * degrees.to_radians()).tan();
    under(scene, vec![gets_along(id, DVec3::X, 0.8 * way)])
}

/// Grains on a floor between walls that a paddle sweeps towards a third one, up to where they still have room beside each other.
fn sweep(mut scene: Scene, seed: u64, count: usize, friction: f64, is_round: bool) -> Result<Trial, Error> {
    scene.add(floor(0.0, friction)?)?;
    let (wall, side) = (cuboid(DVec3::new(0.2, 1.0, 2.0))?, cuboid(DVec3::new(2.0, 1.0, 0.2))?);
    // The floor between the walls is 1.2 wide.
    let wide = 0.6;
    scene.add(still("wall", &wall, friction).with_position(DVec3::new(1.2, 1.0 + GAP, 0.0)))?;
    for z in [-1.0, 1.0] {
        let side = still(format!("side {z}"), &side, friction);
        scene.add(side.with_position(DVec3::new(-1.001, 1.0 + GAP, z * (wide + 0.2))))?;
    }
    let mut random = Xoshiro256::new(seed);
    for k in 0..count {
        let place = DVec3::new(
            0.27 * (k / 4 % 3) as f64 + random.range(-0.01, 0.01),
            0.16 + 0.27 * (k / 12) as f64,
            0.27 * ((k % 4) as f64 - 1.5),
        );
        let body = free(format!("grain {k}"), &grain(is_round, k)?, friction).with_position(place);
        scene.add(body.with_orientation(random.rotation()))?;
    }
    // What is left is twice the area of the grains if they lie on their sides, and at least four of them deep.
    let deep = (2.0 * count as f64 * 0.04 / (2.0 * wide)).max(0.4);
    let paddle = free("paddle", &cuboid(DVec3::new(0.05, 0.9, wide - 0.01))?, friction);
    let (from, to) = (-0.3, 1.0 - deep - 0.05);
    scene.drive(paddle, pushed(DVec3::new(from, 0.9 + 2.0 * GAP, 0.0), DVec3::X * (to - from))?)?;
    let ids: Vec<usize> = scene.ids.iter().map(|id| id.index()).collect();
    let out = move |poses: &[Pose]| ids.iter().map(|&k| poses[k].translation.x).fold(f64::MIN, f64::max);
    under(scene, vec![never_more("how far a grain is", 1.0, out)])
}

/// A box on a floor that a paddle sweeps against a wall, at least as high as wide: it aligns with one of its sides, and there is room until the
/// paddle is as near to the wall as that is wide. One in three is not square from above.
fn paddle(mut scene: Scene, seed: u64, variant: u64) -> Result<Trial, Error> {
    let mut random = Xoshiro256::new(seed.wrapping_mul(1000) + variant);
    let friction = [0.0, 0.2, 0.5, 0.8][(variant % 4) as usize];
    let half = 0.1 + 0.1 * random.unit();
    let other = if variant % 3 == 2 { half * (1.0 + random.unit()) } else { half };
    let high = other * (1.0 + 0.5 * random.unit());
    let speed = 0.4 + random.unit();
    scene.add(floor(0.0, friction)?)?;
    let wall = cuboid(DVec3::new(0.2, 1.0, 2.0))?;
    scene.add(still("wall", &wall, friction).with_position(DVec3::new(1.2, 1.0 + GAP, 0.0)))?;
    if variant >= CORNERED {
        let side = cuboid(DVec3::new(2.0, 1.0, 0.2))?;
        scene.add(still("side", &side, friction).with_position(DVec3::new(-1.001, 1.0 + GAP, 0.2)))?;
    }
    let yaw = DQuat::from_rotation_y(random.range(-0.7, 0.7));
    let away = if variant >= CORNERED {
        -(1.5 * half.hypot(other) + 0.1 * random.unit())
    } else {
        random.range(-0.2, 0.2)
    };
    let body = free("box", &cuboid(DVec3::new(half, high, other))?, friction).with_orientation(yaw);
    scene.add(body.with_position(DVec3::new(0.3, high + GAP, away)))?;
    // Its face begins at −0.3; the wall's is at 1.
    let paddle = free("paddle", &cuboid(DVec3::new(0.05, 0.9, 1.0))?, friction);
    let from = DVec3::new(-0.35, 0.9 + 2.0 * GAP, if variant >= CORNERED { -1.0 } else { 0.0 });
    let motion = ConstantTwist::REST.with_position(from).with_linear_velocity(DVec3::X * speed);
    scene.drive(paddle, motion)?;
    let [first, end] = [other, half].map(|half| (1.3 - 2.0 * half) / speed);
    scene.seconds = end + 0.1;
    Ok(crushing(scene, is_crushed(first - 2.0 * LEFT * GAP / speed, end)))
}

/// A shaft that turns in a bore of as many sides, with a clearance of ten gaps at the corners.
fn bearing(mut scene: Scene, sides: u32, rate: f64, friction: f64) -> Result<Trial, Error> {
    let gap = scene.simulation.options().gap;
    let (radius, clearance) = (0.2, 10.0 * gap);
    // A corner of the shaft turns within the sides of the bore.
    let bore = (radius + clearance) / (PI / f64::from(sides)).cos();
    scene.add(still("bore", &ring(sides, [bore, bore + 0.1], 0.1)?, friction))?;
    let shaft = prism(&regular(sides, radius), 0.15)?;
    let shaft: Body = free("shaft", &shaft, friction).with_angular_velocity(DVec3::Z * rate);
    let k = scene.add(shaft)?.index();
    let most = bore - radius * (PI / f64::from(sides)).cos();
    let out = move |poses: &[Pose]| poses[k].translation.truncate().length();
    under(scene, vec![never_more("distance from the axis", most, out)])
}

/// A wheel on an axle of as many sides, with less play than the axle's corners need to turn in its bore: it turns with the axle.
fn axle(mut scene: Scene, sides: u32, rate: f64) -> Result<Trial, Error> {
    let (radius, play) = (0.5, 1e-3);
    let axle = free("axle", &prism(&regular(sides, radius - play), 0.3)?, 0.2);
    scene.drive(axle, ConstantTwist::REST.with_angular_velocity(DVec3::Z * rate))?;
    let wheel = free("wheel", &ring(sides, [radius, 0.8], 0.15)?, 0.2);
    let wheel = scene.add(wheel.with_angular_velocity(DVec3::Z * rate / 6.0))?;
    let k = wheel.index();
    let most = play / (PI / f64::from(sides)).cos();
    let out = move |poses: &[Pose]| poses[k].translation.truncate().length();
    let turns = Law::new(format!("the wheel turns at {rate}"), move |ran| {
        let found = ran.scene.simulation.angular_velocity(wheel).z;
        ((found - rate).abs() > 0.01 * rate).then(|| format!("it turns at {found:.3e}"))
    });
    under(scene, vec![never_more("distance from the axis", most, out), turns])
}

/// A globe within three shells, each of which turns freely in the next one; the outermost turns with 30 rad/s and more.
fn shells(mut scene: Scene, meridians: u32, friction: f64, restitution: f64) -> Result<Trial, Error> {
    let spin = DVec3::new(30.0, 9.0, 6.0);
    // From a sphere through the corners of a shell to one within its faces, with a clearance of a hundredth.
    let within = (PI / f64::from(meridians)).cos().powi(2) * 0.99;
    let mut radius = 1.0;
    let shell = free("shell 0", &globe(meridians, [1.1 * radius, radius])?, friction);
    scene.drive(shell, ConstantTwist::REST.with_angular_velocity(spin))?;
    let mut inside = Vec::new();
    for k in 1..4 {
        radius *= within;
        let hollow = if k < 3 { 0.9 * radius } else { 0.0 };
        let body = free(format!("shell {k}"), &globe(meridians, [radius, hollow])?, friction);
        let body = body.with_restitution(restitution).with_angular_velocity(DVec3::new(30.0, 0.0, -30.0));
        inside.push(scene.add(body)?.index());
        radius *= 0.9;
    }
    // Corners are no faster than those of the outermost shell, and the others fall by no more than their play.
    let out = move |poses: &[Pose]| inside.iter().map(|&k| poses[k].translation.length()).fold(0.0, f64::max);
    under(scene, vec![never_more("distance from the center", 1.0, out)])
}

/// A peg without friction in a hole of its own shape that turns about its axis, which is level: nothing pushes the peg along that.
fn peg(mut scene: Scene, sides: u32, rate: f64) -> Result<Trial, Error> {
    let (radius, play) = (0.5, 2e-3);
    let hole = free("hole", &ring(sides, [radius, 1.5], 0.5)?, 0.0);
    scene.drive(hole, ConstantTwist::REST.with_angular_velocity(DVec3::Z * rate))?;
    let peg = free("peg", &prism(&regular(sides, radius - play), 0.5)?, 0.0);
    let peg = scene.add(peg)?;
    let k = peg.index();
    let along = move |poses: &[Pose]| poses[k].translation.z.abs();
    let fastest = 4.0 * rate * radius;
    let slow = Law::new(format!("the peg is no faster than {fastest}"), move |ran| {
        let found = ran.scene.simulation.angular_velocity(peg).length() * radius;
        (found > fastest).then(|| format!("its corners have {found:.3e} at the end"))
    });
    under(scene, vec![never_more("the way along the axis", 0.2 * radius, along), slow])
}
