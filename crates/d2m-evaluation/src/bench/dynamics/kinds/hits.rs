//! What hits and what spins: pairs, cradles, breaks, bounces, tops.
use super::super::scene::{Error, Scene, tree};
use super::law::{keeps_energy, keeps_momentum, leaves_at, never_more};
use super::solids::cuboid;
use super::trial::{Case, GAP, GRAVITY, Trial, floor, free, under};
use d2m::motion::Pose;
use d2m_dynamics::{BodyId, Kind, Mass, SimulationOptions};
use d2m_testing::Xoshiro256;
use glam::DVec3;

pub(super) fn cases(cases: &mut Vec<Case>, seed: u64) {
    for ratio in [1.0, 3.0, 1e4, 1e-4, 1e8] {
        for restitution in [1.0, 0.5, 0.0] {
            let variant = format!("of mass {ratio:e} with restitution {restitution}");
            cases.push(
                Case::new("hit", variant, 1.0, move |scene| hit(scene, ratio, restitution)).weightless(),
            );
        }
    }
    for (count, moving) in [(3, 1), (5, 1), (5, 2), (7, 3), (12, 1)] {
        let variant = format!("of {count} with {moving} that come");
        cases.push(Case::new("cradle", variant, 2.0, move |scene| cradle(scene, count, moving)).weightless());
    }
    for rows in [3, 4, 5] {
        for restitution in [1.0, 0.9] {
            let variant = format!("of {rows} rows with restitution {restitution}");
            let fine = SimulationOptions::default().with_gap(1e-4);
            let case = Case::new("break", variant, 1.0, move |scene| pool(scene, seed, rows, restitution));
            cases.push(case.with_options(fine).weightless());
        }
    }
    for restitution in [0.3, 0.8, 1.0] {
        let variant = format!("with restitution {restitution}");
        cases.push(Case::new("bounce", variant, 2.0, move |scene| bounce(scene, restitution)));
    }
    for ratio in [1e3, 1e5, 1e8] {
        for restitution in [0.5, 0.9, 1.0] {
            let variant = format!("on a light cube, {ratio:e} times, with restitution {restitution}");
            cases.push(Case::new("bounce", variant, 1.0, move |scene| bounce_on(scene, ratio, restitution)));
        }
    }
    for restitution in [0.5, 1.0] {
        let variant = format!("in a box, with restitution {restitution}");
        let fine = SimulationOptions::default().with_gap(1e-4);
        let case = Case::new("rattle", variant, 0.5, move |scene| rattle(scene, restitution));
        cases.push(case.with_options(fine).weightless());
    }
    for rate in [1.0, 30.0, 100.0, 300.0] {
        for (shape, x) in [("a brick", 0.5), ("a plate", 0.05)] {
            let variant = format!("of {shape} at {rate} rad/s");
            cases.push(Case::new("spin", variant, 6.0, move |scene| spin(scene, seed, rate, x)).weightless());
        }
    }
}

/// A cube hits another, so many times as heavy, in the middle: velocities by the law of Newton.
fn hit(mut scene: Scene, ratio: f64, restitution: f64) -> Result<Trial, Error> {
    let (shape, speed) = (cuboid(DVec3::splat(0.5))?, 2.0);
    let mut cube = |name: &str, x: f64, mass: f64, v: f64| {
        let body = free(name, &shape, 0.0).with_restitution(restitution).with_mass(Mass::Total(mass));
        scene.add(body.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v))
    };
    let (one, two) = (cube("one", -1.0, 1.0, speed)?, cube("two", 1.0, ratio, 0.0)?);
    let common = speed / (1.0 + ratio);
    let after = [common - restitution * speed * ratio / (1.0 + ratio), common + restitution * common];
    // What does not bounce is solved as what moves on together: to a hundredth of a gap a step (docs/theory/dynamics.md).
    let slow = 1e-2 * GAP / scene.simulation.options().step;
    let within = if restitution > 0.0 { 1e-9 * speed } else { slow };
    let law = |id: BodyId, v: f64| leaves_at(id, DVec3::X * v, within);
    under(scene, vec![law(one, after[0]), law(two, after[1])])
}

/// Cubes in a row, of which the first ones come with the same velocity: as many leave at the other end.
fn cradle(mut scene: Scene, count: usize, moving: usize) -> Result<Trial, Error> {
    let shape = cuboid(DVec3::splat(0.2))?;
    let pitch = 0.4 + 2.0 * GAP;
    let mut ids = Vec::new();
    for k in 0..count {
        let comes = k < moving;
        let x = pitch * k as f64 - if comes { 0.5 } else { 0.0 };
        let body = free(format!("cube {k}"), &shape, 0.0).with_restitution(1.0);
        let v = if comes { DVec3::X } else { DVec3::ZERO };
        ids.push(scene.add(body.with_position(DVec3::X * x).with_linear_velocity(v))?);
    }
    let mut laws = vec![keeps_energy(1e-9), keeps_momentum(1e-9, 1000.0)];
    for (k, &id) in ids.iter().enumerate() {
        let v = if k + moving >= count { DVec3::X } else { DVec3::ZERO };
        laws.push(leaves_at(id, v, 1e-6));
    }
    under(scene, laws)
}

/// A ball of triangles breaks a triangle of others; neither friction nor gravity.
fn pool(mut scene: Scene, seed: u64, rows: usize, restitution: f64) -> Result<Trial, Error> {
    let (radius, speed) = (0.03, 5.0);
    let shape = tree(&format!("icosphere?triangles=320&scale={radius}"))?;
    let mut random = Xoshiro256::new(seed);
    let pitch = 2.0 * radius + 3e-4;
    let ball = |name: String, place: DVec3, turn: glam::DQuat| {
        free(name, &shape, 0.0).with_restitution(restitution).with_position(place).with_orientation(turn)
    };
    for row in 0..rows {
        for k in 0..=row {
            let z = pitch * (k as f64 - 0.5 * row as f64);
            let place = DVec3::new(pitch * 0.75_f64.sqrt() * row as f64, 0.0, z);
            scene.add(ball(format!("ball {row} {k}"), place, random.rotation()))?;
        }
    }
    let place = DVec3::new(-0.3, 0.0, 0.002 * random.unit());
    let cue = ball("cue".into(), place, random.rotation()).with_linear_velocity(DVec3::X * speed);
    let cue = scene.add(cue)?;
    let mass = scene.simulation.mass_properties(cue).map_or(0.0, |properties| properties.mass);
    let mut laws = vec![keeps_momentum(1e-9, mass * speed)];
    if restitution == 1.0 {
        laws.push(keeps_energy(1e-9));
    }
    under(scene, laws)
}

/// A cube that falls flat from a meter: no height after it is more than the energy that is left allows.
fn bounce(mut scene: Scene, restitution: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.0)?.with_restitution(restitution))?;
    let (half, drop) = (0.2, 1.0);
    let body = free("cube", &cuboid(DVec3::splat(half))?, 0.0).with_restitution(restitution);
    let k = scene.add(body.with_position(DVec3::Y * (half + drop)))?.index();
    let height = move |poses: &[Pose]| poses[k].translation.y;
    let laws =
        vec![comes_up(k, half, drop, restitution), never_more("its height", half + drop + 1e-9, height)];
    under(scene, laws)
}

/// At the top of its first way up, after it has fallen by this much onto something that lies at `floor`.
fn comes_up(k: usize, floor: f64, drop: f64, restitution: f64) -> super::law::Law {
    let height = move |poses: &[Pose]| poses[k].translation.y;
    let first = (2.0 * drop / GRAVITY).sqrt();
    let (top, time) = (floor + drop * restitution * restitution, first * (1.0 + restitution));
    let within = 2.0 * GAP + 2e-3;
    super::law::Law::new(format!("it comes up to {top:.4}"), move |ran| {
        let near = |time: f64, other: f64| (time - other).abs() < 0.05;
        let highest = ran.track.iter().filter(|(t, _)| near(*t, time)).map(|(_, poses)| height(poses));
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        ((highest - top).abs() > within).then(|| format!("it came up to {highest}, not {top}"))
    })
}

/// A heavy cube that falls flat from a meter onto a light one, which lies on the floor: it comes up as from the floor itself.
fn bounce_on(mut scene: Scene, ratio: f64, restitution: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.0)?.with_restitution(restitution))?;
    let (half, drop) = (0.2, 1.0);
    let mut cube = |name: &str, y: f64, mass: f64| {
        let body = free(name, &cuboid(DVec3::splat(half))?, 0.0).with_restitution(restitution);
        scene.add(body.with_position(DVec3::Y * y).with_mass(Mass::Total(mass)))
    };
    cube("light", half + GAP, 1.0)?;
    let k = cube("heavy", 3.0 * half + drop, ratio)?.index();
    let height = move |poses: &[Pose]| poses[k].translation.y;
    let laws =
        vec![comes_up(k, 3.0 * half, drop, restitution), never_more("its height", 3.0 * half + drop, height)];
    under(scene, laws)
}

/// A cube in a box, in which it meets one wall and the other many times a step.
fn rattle(mut scene: Scene, restitution: f64) -> Result<Trial, Error> {
    // Half a side of 1, of which the wall is a tenth.
    let hollow = free("hollow", &tree("hollow-box?wall=0.1&scale=1.7320508")?, 0.0).with_kind(Kind::Static);
    scene.add(hollow.with_restitution(restitution))?;
    let body = free("cube", &cuboid(DVec3::splat(0.895))?, 0.0).with_restitution(restitution);
    let id = scene.add(body.with_linear_velocity(DVec3::X * 20.0))?;
    let stays = leaves_at(id, DVec3::ZERO, if restitution < 1.0 { 1.0 } else { 20.0 + 1e-9 });
    under(scene, if restitution < 1.0 { vec![stays] } else { vec![stays, keeps_energy(1e-9)] })
}

/// A free top: energy to a thousandth, as long as it spins.
fn spin(mut scene: Scene, seed: u64, rate: f64, x: f64) -> Result<Trial, Error> {
    let mut random = Xoshiro256::new(seed);
    let body = free("top", &cuboid(DVec3::new(x, 0.3, 0.2))?, 0.0);
    let body = body.with_angular_velocity(random.direction() * rate).with_orientation(random.rotation());
    scene.add(body)?;
    under(scene, vec![keeps_energy(1e-3), keeps_momentum(1e-9, 1.0)])
}
