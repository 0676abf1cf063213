//! Scenes of two bodies in which bounds of speeds and accelerations have no slack: every point is about as far from the center of the
//! turn as the farthest one, and what it comes near is where the bound puts it. A bound that is too small by a part is then wrong.
use crate::{Draw, Random, Surface};
use core::f64::consts::TAU;
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};

/// What a scene is sharp about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharpFamily {
    /// Points on a circle, at right angles to a plate: nothing but their acceleration brings them near.
    Accelerations,
    /// Long triangles that turn about their middles beside a plate: their ends are as fast as they may be.
    TurnRates,
    /// Long fast turns: bodies whose ends pass each other closely again and again.
    FastTurns,
    /// A body that spins for long beside what it sweeps past, and slowly comes nearer.
    Sweeps,
    /// A common axis: a worm that turns and climbs in front of another one, hardly apart, and a shaft that leaves the middle of its sleeve.
    Screws,
    /// Two fans whose tips come together at one time, evenly or by nothing but their acceleration.
    Crowds,
    /// Cards that pass through those of another deck one after the other: most contacts are over when the next one begins.
    Decks,
}

impl SharpFamily {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Accelerations,
        Self::TurnRates,
        Self::FastTurns,
        Self::Sweeps,
        Self::Screws,
        Self::Crowds,
        Self::Decks,
    ];
}

/// Two bodies with their motions over [0, 1]; surfaces, no solids.
#[derive(Clone, Debug)]
pub struct SharpScene {
    /// The surfaces of the bodies.
    pub surfaces: [Surface; 2],
    /// Their motions.
    pub motions: [ConstantTwist; 2],
    /// The tolerance of the query.
    pub tolerance: f64,
    /// The minimum separation.
    pub separation: f64,
}

impl SharpScene {
    /// Scene number `index` of a family and a seed; the same numbers give the same scene.
    ///
    /// ```
    /// use d2m_testing::{SharpFamily, SharpScene};
    /// let scene = |index| SharpScene::draw(SharpFamily::Crowds, 1, index);
    /// assert_eq!(scene(3).motions[0], scene(3).motions[0]);
    /// assert_ne!(scene(3).motions[0], scene(4).motions[0]);
    /// ```
    pub fn draw(family: SharpFamily, seed: u64, index: u64) -> Self {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(index));
        random.bits();
        let mut scene = match family {
            SharpFamily::Accelerations => accelerations(&mut random),
            SharpFamily::TurnRates => turn_rates(&mut random),
            SharpFamily::FastTurns => fast_turns(&mut random),
            SharpFamily::Sweeps => sweeps(&mut random),
            SharpFamily::Screws => screws(&mut random),
            SharpFamily::Crowds => crowds(&mut random),
            SharpFamily::Decks => decks(&mut random),
        };
        scene.seen_from_anywhere(&mut random);
        scene
    }

    fn new(surfaces: [Surface; 2], motions: &[ConstantTwist; 2], random: &mut Random) -> Self {
        let tolerance = random.log_between(1e-9, 1e-3);
        let separation = if random.unit() < 0.7 { 0.0 } else { random.log_between(1e-4, 1e-2) };
        Self { surfaces, motions: *motions, tolerance, separation }
    }

    /// Half of the scenes turned and moved as a whole, a third with the bodies exchanged.
    fn seen_from_anywhere(&mut self, random: &mut Random) {
        if random.unit() < 0.5 {
            let (turn, shift) = (random.quaternion().normalize(), random.vector() * 3.0);
            self.motions = self.motions.map(|m| {
                m.with_position(turn * m.position() + shift)
                    .with_orientation(turn * m.orientation())
                    .with_linear_velocity(turn * m.linear_velocity())
                    .with_angular_velocity(turn * m.angular_velocity())
            });
        }
        if random.unit() < 0.33 {
            self.surfaces.swap(0, 1);
            self.motions.swap(0, 1);
        }
    }
}

/// A few triangles of this size about points.
fn grains(points: &[DVec3], size: f64, random: &mut Random) -> Surface {
    let corners: Vec<DVec3> =
        points.iter().flat_map(|&p| [0; 3].map(|_| p + random.vector() * size)).collect();
    Surface::soup(corners)
}

/// A square of two triangles with this normal through a point, of a half width.
fn plate(at: DVec3, normal: DVec3, half: f64) -> Surface {
    let (u, w) = normal.any_orthonormal_pair();
    let corner = |s: f64, t: f64| at + (u * s + w * t) * half;
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    Surface { name: "plate", vertices: vec![a, b, c, d], triangles: vec![[0, 1, 2], [0, 2, 3]] }
}

fn about_z(angle: f64) -> DVec3 {
    DQuat::from_rotation_z(angle) * DVec3::X
}

fn accelerations(random: &mut Random) -> SharpScene {
    let size = random.log_between(1e-5, 1e-2);
    let spread = random.log_between(1e-4, 0.3);
    let count = 1 + random.index(20);
    let points: Vec<DVec3> = (0..count)
        .map(|_| about_z(spread * random.signed()) + DVec3::Z * (spread * random.signed()))
        .collect();
    let spin = random.log_between(0.05, 1.2);
    // At the end of the window the points are 1 − cos(spin) nearer: the plate is met within it, or not quite.
    let gap = (1.0 - spin.cos()) * random.between(0.02, 1.1) + size;
    let tilt = random.vector() * [0.0, 1e-2][random.index(2)];
    let normal = (DVec3::X + tilt).normalize();
    let wall = plate(DVec3::X * (1.0 - spread * spread - gap), normal, random.log_between(0.05, 2.0));
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * spin);
    let other = if random.unit() < 0.6 {
        ConstantTwist::REST
    } else {
        ConstantTwist::REST.with_angular_velocity(DVec3::Z * (-spin * random.unit()))
    };
    SharpScene::new([grains(&points, size, random), wall], &[turning, other], random)
}

fn turn_rates(random: &mut Random) -> SharpScene {
    let width = random.log_between(1e-4, 0.3);
    let blades = 1 + random.index(6);
    let corners = (0..blades).flat_map(|k| {
        let z = k as f64 * 0.01;
        [DVec3::new(-1.0, 0.0, z), DVec3::new(1.0, -width, z), DVec3::new(1.0, 0.0, z)]
    });
    let blade = Surface::soup(corners.collect::<Vec<_>>());
    let spin = random.log_between(0.05, 1.5);
    let gap = spin.sin() * random.between(0.05, 1.1);
    let at = DVec3::new(random.between(0.7, 1.0), gap, 0.02);
    let wall = if random.unit() < 0.5 {
        plate(at, DVec3::Y, random.log_between(0.01, 2.0))
    } else {
        grains(&[at], random.log_between(1e-5, 1e-2), random)
    };
    let drift = random.vector() * [0.0, 0.1][random.index(2)];
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * spin).with_linear_velocity(drift);
    SharpScene::new([blade, wall], &[turning, ConstantTwist::REST], random)
}

fn fast_turns(random: &mut Random) -> SharpScene {
    let spin = random.log_between(20.0, 400.0);
    let size = random.log_between(1e-3, 0.2);
    let points: Vec<DVec3> = (0..=random.index(12)).map(|_| about_z(TAU * random.unit())).collect();
    let body = grains(&points, size, random);
    let gap = random.log_between(1e-3, 0.5);
    let across = random.direction();
    let at = about_z(TAU * random.unit()) * (1.0 + size + gap);
    let wall = if random.unit() < 0.5 {
        plate(at, (at.normalize() + across * 0.2).normalize(), random.log_between(0.01, 1.0))
    } else {
        grains(&[at, at * 1.1, at + DVec3::Z * 0.1], random.log_between(1e-3, 0.2), random)
    };
    let axis = (DVec3::Z + random.vector() * [0.0, 0.2][random.index(2)]).normalize();
    let drift = at * (random.signed() * gap * 2.0);
    let turning = ConstantTwist::REST.with_angular_velocity(axis * spin).with_linear_velocity(drift);
    let turns = random.vector() * [0.0, 3.0][random.index(2)];
    SharpScene::new([body, wall], &[turning, ConstantTwist::REST.with_angular_velocity(turns)], random)
}

fn sweeps(random: &mut Random) -> SharpScene {
    let spin = random.log_between(40.0, 4000.0);
    let body = Surface::torus(10, 4, random.between(0.05, 0.3));
    let reach = body.vertices.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    let gap = random.log_between(1e-4, 0.1);
    // Beside, above, or through the hole; near by the end of the window.
    let closes = gap * random.between(0.3, 1.5);
    let (at, velocity, wall) = match random.index(3) {
        0 => {
            let at = DVec3::X * (reach + gap);
            (at, DVec3::X * -closes, plate(DVec3::ZERO, DVec3::X, random.between(0.1, 2.0)))
        }
        1 => {
            let top = body.vertices.iter().map(|p| p.z).fold(0.0, f64::max);
            (
                DVec3::Z * (top + gap),
                DVec3::Z * -closes,
                plate(DVec3::ZERO, DVec3::Z, random.between(0.5, 2.0)),
            )
        }
        _ => {
            let hole = body.vertices.iter().map(|p| p.truncate().length()).fold(f64::INFINITY, f64::min);
            // Sides of rings are chords: the hole is a little smaller than its vertices say.
            let radius = (hole * (TAU / 20.0).cos() - gap).max(0.05);
            let post = Surface::cone(5, radius, 1.0).map(|p| p - DVec3::Z * 0.5);
            (DVec3::ZERO, DVec3::Z * -0.1 * random.unit(), post)
        }
    };
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * spin);
    let slow = DVec3::Z * [0.0, 0.3, 17.0][random.index(3)];
    let other =
        ConstantTwist::REST.with_position(at).with_linear_velocity(velocity).with_angular_velocity(slow);
    SharpScene::new([body, wall], &[turning, other], random)
}

/// A strip along a helix from radius `from` to `to`, in so many turns of a pitch.
fn worm(from: f64, to: f64, pitch: f64, turns: f64) -> Surface {
    let steps = 8;
    let point = |k: u32, radius: f64| {
        let angle = TAU * turns * f64::from(k) / f64::from(steps);
        about_z(angle) * radius + DVec3::Z * (pitch * angle / TAU)
    };
    let vertices = (0..=steps).flat_map(|k| [point(k, from), point(k, to)]).collect();
    let triangles =
        (0..steps).flat_map(|k| [[2 * k, 2 * k + 1, 2 * k + 2], [2 * k + 1, 2 * k + 3, 2 * k + 2]]).collect();
    Surface { name: "worm", vertices, triangles }
}

/// The sides of a prism about z.
fn sleeve(sides: u32, radius: f64, low: f64, high: f64) -> Surface {
    let point = |k: u32, z: f64| about_z(TAU * f64::from(k) / f64::from(sides)) * radius + DVec3::Z * z;
    let vertices = (0..sides).flat_map(|k| [point(k, low), point(k, high)]).collect();
    let at = |k: u32| 2 * (k % sides);
    let triangles =
        (0..sides).flat_map(|k| [[at(k), at(k + 1), at(k) + 1], [at(k + 1), at(k + 1) + 1, at(k) + 1]]);
    Surface { name: "sleeve", vertices, triangles: triangles.collect() }
}

fn screws(random: &mut Random) -> SharpScene {
    let (pitch, turns) = (random.between(0.1, 0.6), random.between(0.5, 2.0));
    let (mut inner, mut outer) = (worm(0.4, 1.0, pitch, turns), worm(0.6, 1.4, pitch, turns));
    let spin = random.log_between(20.0, 80.0);
    // The same pitch, or almost: then the worms come near after a while.
    let climb = spin * pitch / TAU * if random.unit() < 0.6 { 1.0 } else { 1.0 + 1e-3 * random.signed() };
    let lift = pitch * random.between(0.05, 0.5);
    let start = DVec3::Z * (lift - if random.unit() < 0.5 { 0.0 } else { climb * random.unit() });
    let mut velocity = DVec3::Z * climb;
    if random.unit() < 0.6 {
        let (sides, gap) = (6, random.log_between(1e-3, 0.05));
        inner = inner.with(&sleeve(5, 0.2, 0.0, 0.1));
        outer = outer.with(&sleeve(sides, (0.2 + gap) / (TAU / 12.0).cos(), -climb - 1.0, climb + 1.0));
        velocity += about_z(TAU * random.unit()) * (gap * random.between(0.5, 2.5));
    }
    let turning = ConstantTwist::REST
        .with_position(start)
        .with_angular_velocity(DVec3::Z * spin)
        .with_linear_velocity(velocity);
    SharpScene::new([inner, outer], &[turning, ConstantTwist::REST], random)
}

fn crowds(random: &mut Random) -> SharpScene {
    let count = 60 + random.index(60);
    let gap = random.log_between(1e-5, 0.2);
    let fan = |up: f64, spread: f64, random: &mut Random| {
        let mut corners = Vec::new();
        for _ in 0..count {
            let d = random.direction();
            let far = DVec3::new(d.x, d.y, (d.z.abs() + 0.02) * up);
            let tip = random.vector() * spread;
            corners.extend([tip, far, far + random.vector() * 1e-3]);
        }
        Surface::soup(corners)
    };
    let spins = [0, 1].map(|_| random.vector() * [0.0, 0.02, 0.3, 2.0][random.index(4)]);
    if random.unit() < 0.5 {
        // Tips that differ by little.
        let fans = [fan(1.0, 1e-6, random), fan(-1.0, 1e-6, random)];
        let falling = ConstantTwist::REST
            .with_position(DVec3::Z * gap)
            .with_linear_velocity(DVec3::Z * (-gap * random.between(0.0, 1.3)))
            .with_angular_velocity(spins[0]);
        let other = ConstantTwist::REST.with_angular_velocity(spins[1]);
        return SharpScene::new(fans, &[falling, other], random);
    }
    // About a point one below: the tips go ahead with those of the other body, which go straight, and bend towards them.
    let spin = random.log_between(0.05, 0.6);
    let gap = (1.0 - spin.cos()) * random.between(0.05, 1.2);
    let spread = gap * random.log_between(1e-3, 0.5);
    let fans = [fan(1.0, spread, random).map(|p| p + DVec3::Z), fan(-1.0, spread, random)];
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::X * spin);
    let ahead = ConstantTwist::REST
        .with_position(DVec3::Z * (1.0 - gap - spread))
        .with_linear_velocity(DVec3::Y * -spin);
    SharpScene::new(fans, &[turning, ahead], random)
}

fn decks(random: &mut Random) -> SharpScene {
    let (count, thick) = (20 + random.index(60), random.log_between(0.02, 1.0));
    let deck = |random: &mut Random| {
        let corners = (0..count).flat_map(|_| {
            let height = thick * random.unit();
            [0.0, 1.0, 2.0].map(|k| {
                let corner = about_z(TAU / 3.0 * (k + random.unit())) * random.between(0.2, 1.0);
                corner + DVec3::Z * (height + 1e-3 * random.signed())
            })
        });
        Surface::soup(corners.collect::<Vec<_>>())
    };
    let decks = [deck(random), deck(random)];
    let speed = random.between(1.0, 4.0);
    let spins = [0, 1].map(|_| random.vector() * [0.0, 0.05, 1.0][random.index(3)]);
    let aside = random.vector() * 0.3;
    let falling = ConstantTwist::REST
        .with_position(DVec3::new(aside.x, aside.y, random.between(1.2, 2.0)))
        .with_linear_velocity(DVec3::new(aside.y, aside.z, -speed))
        .with_angular_velocity(spins[0]);
    let other = ConstantTwist::REST.with_angular_velocity(spins[1]);
    SharpScene::new(decks, &[falling, other], random)
}
