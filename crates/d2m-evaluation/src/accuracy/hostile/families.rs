//! The hostile families: scenes at the edges of what the search assumes, each with the times at which the construction
//! puts its contact.
use super::generic_families::{
    dust, far_reference_points, large_times, one_and_many, spinning_together, windows, windows_without_length,
};
use super::made::{about, body, decade, scene};
use super::scene::HostileScene;
use super::shapes::{centered_box, extruded, refined, sliver, spikes, stepped_plate, tetrahedron};
use d2m::Solid;
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::{DQuat, DVec3};

/// A maker of scenes, and the name that a report shows.
pub(super) type Family = (&'static str, fn(&mut Random) -> HostileScene);

pub(super) const FAMILIES: [Family; 17] = [
    ("steps", steps),
    ("fine steps", fine_steps),
    ("sheets", sheets),
    ("parallel edges", parallel_edges),
    ("overlapping parts", overlapping_parts),
    ("coincident faces", coincident_faces),
    ("cones", cones),
    ("slivers", slivers),
    ("far reference points", far_reference_points),
    ("large times", large_times),
    ("windows without length", windows_without_length),
    ("tiny and huge windows", windows),
    ("spinning together", spinning_together),
    ("nearly still", nearly_still),
    ("crowds", crowds),
    ("one triangle and many", one_and_many),
    ("dust", dust),
];

/// A block slides over a plate towards a step that is twice as high as the gap below it.
fn steps(random: &mut Random) -> HostileScene {
    let step = decade(random, -12.0, -3.0);
    let plate = stepped_plate(step);
    let half = DVec3::new(random.range(0.1, 0.6), random.range(0.1, 0.9), 0.25);
    let block = centered_box(half);
    let from = -1.5 + half.x;
    let speed = random.range(1.0, 3.0);
    let height = 0.25 + 0.5 * step;
    // A slow spin about the vertical, with or without a common one.
    let spin = if random.unit() < 0.5 { DVec3::ZERO } else { DVec3::Z * random.range(-20.0, 20.0) };
    let own = if random.unit() < 0.5 { DVec3::ZERO } else { DVec3::Z * decade(random, -3.0, 0.0) };
    let contact = (-half.x - from) / speed;
    let mut a = body(plate, DVec3::ZERO, DVec3::ZERO, own);
    let mut b = body(block, DVec3::new(from, 0.0, height), DVec3::X * speed, spin);
    if random.unit() < 0.4 {
        let along = DVec3::Z * decade(random, 0.0, 4.0);
        a = about(a, along);
        b = about(b, -along);
    }
    let later = [0.01, 0.1, 0.3].map(|more| (contact + more).min(1.0));
    scene(a, b, [contact].into_iter().chain(later).chain([1.0]).collect())
}

/// A step under a sliding block in meshes of a thousand triangles each, turned anyhow in their own coordinates, with
/// reference points up to 100 away: long closeness without contact, then a contact.
fn fine_steps(random: &mut Random) -> HostileScene {
    let step = decade(random, -10.0, -5.0);
    let turn = random.rotation();
    let plate = refined(stepped_plate(step), 3).map(|p| turn * p);
    let half = DVec3::new(random.range(0.1, 0.6), random.range(0.1, 0.9), 0.25);
    let block = refined(centered_box(half), 3).map(|p| turn * p);
    let from = -1.5 + half.x;
    let speed = random.range(1.0, 3.0);
    let contact = (-half.x - from) / speed;
    let place = turn * DVec3::new(from, 0.0, 0.25 + 0.5 * step);
    let mut a = body(plate, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    let mut b = body(block, place, turn * DVec3::X * speed, DVec3::ZERO);
    if random.unit() < 0.6 {
        a = about(a, random.direction() * decade(random, -1.0, 2.0));
    }
    if random.unit() < 0.3 {
        b = about(b, random.direction() * decade(random, -1.0, 2.0));
    }
    let mut scene = scene(a, b, vec![contact, (contact + 0.05).min(1.0), (contact + 0.4).min(1.0), 1.0]);
    if random.unit() < 0.5 {
        scene.solid = Solid::Surface;
    }
    scene
}

/// Thin plates that pass, slide on, spin beside or cut each other at gaps of 1e-12 … 1e-3.
fn sheets(random: &mut Random) -> HostileScene {
    let thickness = decade(random, -9.0, -1.0);
    let gap = decade(random, -12.0, -3.0) * if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let sheet = |w: f64, h: f64| centered_box(DVec3::new(w, h, 0.5 * thickness));
    let lower = sheet(1.0, 1.0);
    let upper = sheet(random.range(0.2, 1.0), random.range(0.2, 1.0));
    let tilt = if random.unit() < 0.3 { decade(random, -12.0, -2.0) } else { 0.0 };
    let height = thickness + gap;
    let v = DVec3::new(
        random.range(-2.0, 2.0),
        random.range(-2.0, 2.0),
        if random.unit() < 0.5 { 0.0 } else { -gap * random.range(0.0, 2.0) },
    );
    let spin = DVec3::Z * if random.unit() < 0.5 { 0.0 } else { decade(random, -2.0, 2.0) };
    let mut b =
        body(upper, DVec3::new(-v.x * 0.5, -v.y * 0.5, height) + DVec3::X * random.range(-2.5, 2.5), v, spin);
    b.motion = b.motion.with_orientation(DQuat::from_xyzw(0.5 * tilt, 0.0, 0.0, 1.0));
    scene(body(lower, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO), b, vec![0.25, 0.5, 0.75, 1.0])
}

/// Edges of wedges that cross at an angle of 1e-15 … 1e-3 and come together.
fn parallel_edges(random: &mut Random) -> HostileScene {
    let wedge = extruded(&[(0.0, 0.0), (-1.0, -1.0), (1.0, -1.0)], 1.0);
    let angle = decade(random, -15.0, -3.0);
    let aside = random.range(-0.5, 0.5) * if random.unit() < 0.5 { 1.0 } else { angle };
    let start = decade(random, -6.0, 0.0);
    let speed = start * random.range(1.0, 3.0);
    let mut upper = body(
        wedge.clone(),
        DVec3::new(if random.unit() < 0.5 { 0.0 } else { aside * angle }, aside, start),
        DVec3::Z * -speed,
        if random.unit() < 0.5 { DVec3::ZERO } else { DVec3::Z * decade(random, -15.0, 1.0) },
    );
    // Upside down, then turned by the angle about the vertical.
    let flip = DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0);
    let turn = DQuat::from_xyzw(0.0, 0.0, 0.5 * angle, 1.0);
    upper.motion = upper.motion.with_orientation(turn * flip);
    let contact = start / speed;
    let lower = body(wedge, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    scene(lower, upper, vec![contact * (1.0 + 1e-9), contact + 1e-6, contact + 0.01, 1.0])
}

/// A solid of several closed parts, some of which overlap, are turned inside out or repeated; a probe flies in or starts
/// inside.
fn overlapping_parts(random: &mut Random) -> HostileScene {
    let mut union = Surface::default();
    // Repeated triangles count once, which could leave nothing of a part that is turned inside out: never both.
    let repeats = random.unit() < 0.4;
    for _ in 0..2 + random.bits() % 3 {
        let half = DVec3::new(random.range(0.2, 1.0), random.range(0.2, 1.0), random.range(0.2, 1.0));
        let center = random.direction() * random.range(0.0, 0.8);
        let part = Surface::cuboid(center - half, center + half);
        let part = if !repeats && random.unit() < 0.3 { part.inverted() } else { part };
        union = union.with(&part);
        if repeats && random.unit() < 0.5 {
            union = union.with(&part);
        }
    }
    let size = decade(random, -2.0, -0.5);
    let mut probe = tetrahedron(random, size);
    if random.unit() < 0.3 {
        let (part, place) = (tetrahedron(random, 0.05), random.direction() * 2.0);
        probe = probe.with(&part.map(|p| p + place));
    }
    let inside = random.unit() < 0.6;
    let away = if inside { random.range(0.0, 0.7) } else { 3.0 };
    let x = random.direction() * away;
    let v = if inside { random.direction() * 0.1 } else { x * -1.5 };
    let spin = random.direction() * random.range(0.0, 3.0);
    let a = body(union, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    scene(a, body(probe, x, v, spin), vec![0.0, 0.3, 0.5, 0.65, 0.8])
}

/// Boxes whose faces, edges or corners coincide at the start, slide on each other or part.
fn coincident_faces(random: &mut Random) -> HostileScene {
    let quarter = |random: &mut Random| f64::from((random.bits() % 9) as u32) * 0.25 - 1.0;
    let a = Surface::cube(0.5);
    let b = if random.unit() < 0.3 { a.clone() } else { centered_box(DVec3::new(0.25, 0.5, 1.0)) };
    let x = DVec3::new(quarter(random), quarter(random), quarter(random));
    let v = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 0.0, -0.5)]
        [random.bits() as usize % 4];
    let spin = if random.unit() < 0.6 { DVec3::ZERO } else { DVec3::Z * quarter(random) };
    let lead = if random.unit() < 0.5 { v * 0.5 } else { DVec3::ZERO };
    let mut scene = scene(
        body(a, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO),
        body(b, x - lead, v, spin),
        vec![0.0, 0.25, 0.5, 0.5 + 1e-9, 0.75, 1.0],
    );
    if random.unit() < 0.3 {
        scene.solid = Solid::Surface;
    }
    scene
}

/// Cones that meet apex to apex, apex to side, or pass closely.
fn cones(random: &mut Random) -> HostileScene {
    let sides = 3 + random.bits() as u32 % 60;
    let cone = |random: &mut Random| Surface::cone(sides, decade(random, -3.0, 0.0), -1.0);
    let (lower, upper) = (cone(random), cone(random));
    let aside =
        if random.unit() < 0.4 { DVec3::ZERO } else { random.direction() * decade(random, -12.0, -1.0) };
    let start = decade(random, -3.0, 0.0);
    let mut b =
        body(upper, aside + DVec3::Z * start, DVec3::Z * (-2.0 * start), DVec3::Z * random.range(0.0, 9.0));
    b.motion = b.motion.with_orientation(DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0));
    let spin = if random.unit() < 0.5 { DVec3::ZERO } else { random.direction() * random.range(0.0, 2.0) };
    scene(body(lower, DVec3::ZERO, DVec3::ZERO, spin), b, vec![0.5, 0.5 + 1e-7, 0.51, 0.6, 1.0])
}

/// Needles and blades of aspect up to 1e12 that are aimed at each other.
fn slivers(random: &mut Random) -> HostileScene {
    let sliver = |random: &mut Random| {
        let aspect = decade(random, 0.0, 12.0);
        sliver(random, aspect)
    };
    let (a, b) = (sliver(random), sliver(random));
    let along = random.direction();
    let aside = random.direction() * random.range(0.0, 0.5);
    let spin = |random: &mut Random| {
        random.direction() * if random.unit() < 0.4 { 0.0 } else { decade(random, -2.0, 2.0) }
    };
    let (spin_a, spin_b) = (spin(random), spin(random));
    let a = body(a, DVec3::ZERO, DVec3::ZERO, spin_a);
    let b = body(b, along * -2.0 + aside, along * 4.0, spin_b);
    scene(a, b, vec![0.3, 0.4, 0.5, 0.6, 0.7])
}

/// Bodies at a small distance that hardly move.
fn nearly_still(random: &mut Random) -> HostileScene {
    let gap = decade(random, -9.0, -1.0);
    let a = Surface::cube(0.5);
    let b = centered_box(DVec3::new(0.5, 0.3, 0.5));
    let v = random.direction() * (gap * decade(random, -3.0, 0.5));
    let spin = random.direction() * (gap * decade(random, -3.0, 0.5));
    scene(
        body(a, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO),
        body(b, DVec3::X * (1.0 + gap), v, spin),
        vec![0.5, 0.9, 1.0],
    )
}

/// Two plates full of spikes: tips against tips, at gaps of 1e-9 … 1e-1, that slide, turn, part or come together.
fn crowds(random: &mut Random) -> HostileScene {
    let side = 2 + random.bits() as u32 % 14;
    let height = decade(random, -2.0, 0.5);
    let crowd = spikes(random, side, height);
    let other = if random.unit() < 0.5 { crowd.clone() } else { spikes(random, side, height) };
    let gap = decade(random, -9.0, -1.0);
    // Half of them come together at the middle of the window.
    let down = if random.unit() < 0.5 { 2.0 * gap } else { 0.0 };
    let slide = random.direction() * if random.unit() < 0.4 { 0.0 } else { decade(random, -3.0, 0.5) };
    let spin = DVec3::Z * if random.unit() < 0.4 { 0.0 } else { decade(random, -3.0, 1.0) };
    let common = if random.unit() < 0.7 { DVec3::ZERO } else { DVec3::Z * decade(random, -1.0, 2.0) };
    let x = DVec3::Z * (2.0 * height + gap);
    let mut b = body(other, x, DVec3::new(slide.x, slide.y, -down), common + spin);
    b.motion = b.motion.with_orientation(DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0));
    scene(body(crowd, DVec3::ZERO, DVec3::ZERO, common), b, vec![0.5, 0.5 + 1e-6, 0.51, 0.75, 1.0])
}
