//! Families of two random solids that are aimed at each other, in unusual windows, with unusual spins, reference points and sizes.
use super::made::{about, body, decade, scene};
use super::scene::HostileScene;
use super::shapes::{centered_box, refined, tetrahedron};
use d2m::Solid;
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::DVec3;

/// The reference point 1e1 … 1e6 away, along the spin, or across it for bodies that only fly.
pub(super) fn far_reference_points(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    for body in &mut scene.bodies {
        let far = decade(random, 1.0, 6.0);
        let w = body.motion.angular_velocity();
        let along = if w == DVec3::ZERO { random.direction() } else { w.normalize() };
        *body = about(body.clone(), body.motion.orientation().normalize().conjugate() * (along * far));
    }
    scene
}

/// A grain of dust, 2⁻²⁰ … 2⁻⁶⁴ of a block, that flies up to 2²⁴ times the block's size in the window and hits a face on its way.
pub(super) fn dust(random: &mut Random) -> HostileScene {
    let half = DVec3::new(random.range(0.1, 1.0), random.range(0.1, 1.0), random.range(0.1, 1.0));
    let block = refined(centered_box(half), (random.bits() % 3) as u32);
    let size = random.range(-64.0, -20.0).exp2();
    let grain = tetrahedron(random, size);
    let hit = DVec3::new(-half.x, half.y * random.range(-1.0, 1.0), half.z * random.range(-1.0, 1.0));
    let towards = DVec3::new(1.0, random.range(-1.0, 1.0), random.range(-1.0, 1.0));
    let spin = random.direction() * if random.unit() < 0.5 { 0.0 } else { decade(random, -2.0, 2.0) };
    let time = random.range(0.05, 0.95);
    let mut b = body(grain, hit, towards * random.range(0.0, 24.0).exp2(), spin);
    // Where it is at the time of the hit is given to the last digit.
    b.motion = b.motion.with_reference_time(time);
    let mut scene = scene(body(block, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO), b, vec![time]);
    if random.unit() < 0.5 {
        scene.solid = Solid::Surface;
    }
    scene
}

/// Two random solids that are aimed at each other.
fn generic(random: &mut Random) -> HostileScene {
    let shape = |random: &mut Random| match random.bits() % 3 {
        0 => tetrahedron(random, 1.0),
        1 => centered_box(DVec3::new(random.range(0.1, 1.0), random.range(0.1, 1.0), random.range(0.1, 1.0))),
        _ => Surface::cone(3 + random.bits() as u32 % 9, 0.7, -1.0),
    };
    let (a, b) = (shape(random), shape(random));
    let along = random.direction();
    let aside = random.direction() * random.range(0.0, 1.5);
    let spin = |random: &mut Random| {
        if random.unit() < 0.3 { DVec3::ZERO } else { random.direction() * decade(random, -2.0, 2.0) }
    };
    let (spin_a, spin_b) = (spin(random), spin(random));
    let speed = decade(random, 0.0, 3.0);
    let a = body(a, DVec3::ZERO, DVec3::ZERO, spin_a);
    let b = body(b, along * (-0.5 * speed) + aside, along * speed, spin_b);
    scene(a, b, vec![0.4, 0.45, 0.5, 0.55, 0.6])
}

/// A window at 1e3 … 1e17, poses given there or at time 0.
pub(super) fn large_times(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    let start = decade(random, 3.0, 17.0) * if random.unit() < 0.5 { 1.0 } else { -1.0 };
    // As long as the clock allows: at least some units in the last place.
    let least = (start.next_up() - start).abs();
    let length = (least * decade(random, 0.0, 6.0)).max(decade(random, -2.0, 2.0));
    let end = start + length;
    let length = end - start;
    for body in &mut scene.bodies {
        let m = body.motion;
        body.motion = m
            .with_linear_velocity(m.linear_velocity() / length)
            .with_angular_velocity(m.angular_velocity() / length)
            .with_reference_time(start);
        if random.unit() < 0.2 && start.abs() * m.angular_velocity().length() < 1e9 * length {
            // The same velocities, and a pose at the origin of time: another motion, as good as this one.
            let back = body.motion.linear_velocity() * start;
            body.motion = body.motion.with_reference_time(0.0).with_position(body.motion.position() - back);
        }
    }
    scene.window = [start, end];
    scene.planted = scene.planted.iter().map(|t| start + t * length).collect();
    scene
}

/// One instant, at a time at which the bodies may cross.
pub(super) fn windows_without_length(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    let at = random.range(0.3, 0.7);
    scene.window = [at, at];
    scene.planted = vec![at];
    scene
}

/// Windows of a few units in the last place, and of 1e3 … 1e9 with little speed or much spin.
pub(super) fn windows(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    if random.unit() < 0.5 {
        let at = random.range(0.3, 0.7);
        let end = (0..random.bits() % 4).fold(at, |t, _| t.next_up())
            + if random.unit() < 0.5 { 0.0 } else { decade(random, -15.0, -6.0) };
        scene.window = [at, end];
        scene.planted = vec![at, 0.5 * (at + end), end];
    } else {
        let long = decade(random, 3.0, 9.0);
        for body in &mut scene.bodies {
            let m = body.motion;
            body.motion = m.with_linear_velocity(m.linear_velocity() / long);
            if random.unit() < 0.8 {
                body.motion = body.motion.with_angular_velocity(m.angular_velocity() / long);
            }
        }
        scene.window = [0.0, long];
        scene.planted = scene.planted.iter().map(|t| t * long).collect();
    }
    scene
}

/// Bodies that turn alike, fast, and drift towards each other.
pub(super) fn spinning_together(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    let spin = random.direction() * decade(random, 0.0, 3.0);
    let other = if random.unit() < 0.5 { spin } else { spin * (1.0 + decade(random, -12.0, -3.0)) };
    let [a, b] = &mut scene.bodies;
    a.motion = a.motion.with_angular_velocity(spin);
    b.motion = b.motion.with_angular_velocity(other);
    scene
}

/// Sizes from one triangle to 1e5: a single triangle, or a small solid, and a fine one.
pub(super) fn one_and_many(random: &mut Random) -> HostileScene {
    let mut scene = generic(random);
    // A round of the suite meets the finest meshes a few times: the oracle takes seconds for them.
    let times = match random.unit() {
        u if u < 0.02 => 6,
        u if u < 0.1 => 5,
        u if u < 0.4 => 4,
        _ => 2,
    };
    let fine = &mut scene.bodies[0];
    let (vertices, triangles) = (std::mem::take(&mut fine.vertices), std::mem::take(&mut fine.triangles));
    let Surface { vertices, triangles, .. } = refined(Surface { name: "fine", vertices, triangles }, times);
    (fine.vertices, fine.triangles) = (vertices, triangles);
    if random.unit() < 0.5 {
        scene.bodies[1].triangles.truncate(1);
        scene.solid = Solid::Surface;
    }
    if random.unit() < 0.5 {
        scene.bodies.swap(0, 1);
    }
    scene
}
