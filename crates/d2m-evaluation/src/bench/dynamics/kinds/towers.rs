//! What stands, and what does not: stacks, weights, overhangs, walls, arches, houses of cards.
use super::super::scene::{Error, Scene};
use super::law::{gets_along, rests, stays};
use super::solids::{cuboid, prism};
use super::trial::{Case, GAP, Trial, floor, free, under};
use d2m_dynamics::{Mass, SimulationOptions};
use d2m_testing::Xoshiro256;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::PI;

/// What stands may move by this, as the scene `stack-10` has it: no creep above it.
const CREEP: f64 = 1e-3;

pub(super) fn cases(cases: &mut Vec<Case>, seed: u64) {
    let awake = SimulationOptions::default().with_sleeping(false);
    for count in [5, 10, 20, 30, 50] {
        for (how, turned) in [("upright", false), ("turned", true)] {
            let build = move |scene| stack(scene, count, turned.then_some(seed), |_| 1.0);
            cases.push(Case::new("stack", format!("of {count} {how}"), 2.0, build).with_options(awake));
        }
    }
    for (count, ratio) in [(4, 10.0_f64), (9, 10.0), (5, 100.0), (10, 3.0)] {
        let build = move |scene| stack(scene, count, None, move |k| ratio.powi(k));
        let variant = format!("of {count} each {ratio} times as heavy as the one below");
        cases.push(Case::new("stack", variant, 2.0, build).with_options(awake));
    }
    for ratio in [1e2, 1e4, 1e6, 1e8] {
        for (how, offset) in [("centered", 0.0), ("off the middle", 0.3)] {
            let build = move |scene| weight(scene, ratio, offset);
            cases.push(Case::new("weight", format!("{ratio:.0e} {how}"), 2.0, build).with_options(awake));
        }
        cases.push(Case::new("table", format!("under {ratio:.0e}"), 2.0, move |scene| table(scene, ratio)));
    }
    for (count, heavy) in [(3, 2), (6, 5), (6, 3), (10, 9), (10, 5)] {
        for width in [0.02, 0.1] {
            let variant = format!("1e8 at {heavy} of {count} without friction {width} off the middle");
            let build = move |scene| slippery(scene, count, heavy, width, seed);
            cases.push(Case::new("weight", variant, 1.0, build).with_options(awake));
        }
    }
    for count in [2, 4, 7] {
        for part in [0.98, 1.02] {
            let variant = format!("of {count} at {part} of its limit");
            cases.push(Case::new("overhang", variant, 2.0, move |scene| overhang(scene, count, part)));
        }
    }
    for levels in [8, 12, 16, 24] {
        let build = move |scene| pyramid(scene, levels);
        cases.push(Case::new("pyramid", format!("of {levels} levels"), 1.0, build).with_options(awake));
    }
    for (rows, columns) in [(3, 4), (6, 6), (12, 12), (20, 10)] {
        let variant = format!("of {rows} rows and {columns} columns");
        cases.push(Case::new("wall", variant, 1.0, move |scene| wall(scene, rows, columns)));
    }
    for (along, across, high) in [(2, 1, 50), (5, 1, 20), (2, 2, 20), (6, 6, 6)] {
        let variant = format!("{along} by {across} a gap apart of {high}");
        cases.push(Case::new("columns", variant, 1.0, move |scene| columns(scene, along, across, high)));
    }
    for (stones, thickness) in [(5, 0.15), (7, 0.2), (9, 0.15), (15, 0.15), (25, 0.2)] {
        let variant = format!("of {stones} stones {thickness} thick");
        cases.push(Case::new("arch", variant, 2.0, move |scene| arch(scene, stones, thickness, 0.8)));
    }
    for (stones, thickness, friction) in [(21, 0.05, 0.8), (15, 0.2, 0.15)] {
        let variant = format!("of {stones} stones {thickness} thick with friction {friction} that falls");
        cases.push(Case::new("arch", variant, 2.0, move |scene| arch(scene, stones, thickness, friction)));
    }
    for degrees in [10.0, 20.0, 35.0] {
        for part in [1.1, 2.0, 0.9] {
            let variant = format!("leaning by {degrees} with {part} of the friction they take");
            cases.push(Case::new("cards", variant, 1.0, move |scene| leaning_cards(scene, degrees, part)));
        }
    }
    for levels in [1, 2, 3] {
        cases.push(Case::new("cards", format!("{levels} levels"), 2.0, move |scene| house(scene, levels)));
    }
}

/// Boxes a gap apart, turned about the vertical and off the middle with a seed.
fn stack(
    mut scene: Scene,
    count: i32,
    turned: Option<u64>,
    mass: impl Fn(i32) -> f64,
) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let shape = cuboid(DVec3::splat(0.5))?;
    let mut random = turned.map(Xoshiro256::new);
    for k in 0..count {
        let mut place = DVec3::Y * (0.5 + GAP + (1.0 + GAP) * f64::from(k));
        let mut body = free(format!("box {k}"), &shape, 0.5).with_mass(Mass::Total(mass(k)));
        if let Some(random) = &mut random {
            let mut off = || random.range(-0.02, 0.02);
            place += DVec3::new(off(), 0.0, off());
            body = body.with_orientation(DQuat::from_rotation_y(10.0 * off()));
        }
        scene.add(body.with_position(place))?;
    }
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// Boxes in a plane, each on two others. What solutions leave at each level adds up to the top.
fn pyramid(mut scene: Scene, levels: u32) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let shape = cuboid(DVec3::splat(0.5))?;
    for level in 0..levels {
        let y = 0.5 + GAP + (1.0 + GAP) * f64::from(level);
        for k in 0..levels - level {
            let x = 1.05 * (f64::from(k) - 0.5 * f64::from(levels - level - 1));
            let body = free(format!("box {level} {k}"), &shape, 0.5).with_mass(Mass::Total(1.0));
            scene.add(body.with_position(DVec3::new(x, y, 0.0)))?;
        }
    }
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// A heavy box on a light one.
fn weight(mut scene: Scene, ratio: f64, offset: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let shape = cuboid(DVec3::splat(0.5))?;
    for (k, mass) in [1.0, ratio].into_iter().enumerate() {
        let place = DVec3::new(offset * k as f64, 0.5 + GAP + (1.0 + GAP) * k as f64, 0.0);
        let body = free(format!("{mass} kg"), &shape, 0.5).with_mass(Mass::Total(mass));
        scene.add(body.with_position(place))?;
    }
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// A heavy box among light ones, without friction, each off the middle by up to a width, and turned: all normals are vertical, so nothing moves.
fn slippery(mut scene: Scene, count: i32, heavy: i32, width: f64, seed: u64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.0)?)?;
    let shape = cuboid(DVec3::splat(0.5))?;
    let mut random = Xoshiro256::new(seed);
    for k in 0..count {
        let mut off = || random.range(-width, width);
        let place = DVec3::new(off(), 0.5 + GAP + (1.0 + GAP) * f64::from(k), off());
        let mass = if k == heavy { 1e8 } else { 1.0 };
        let body = free(format!("box {k}"), &shape, 0.0).with_mass(Mass::Total(mass)).with_position(place);
        scene.add(body.with_orientation(DQuat::from_rotation_y(10.0 * off())))?;
    }
    under(scene, vec![stays(20.0 * CREEP), rests(0.05)])
}

/// A heavy slab on four light legs.
fn table(mut scene: Scene, ratio: f64) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let leg = cuboid(DVec3::new(0.1, 0.5, 0.1))?;
    for (k, (x, z)) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].into_iter().enumerate() {
        let body = free(format!("leg {k}"), &leg, 0.5).with_mass(Mass::Total(1.0));
        scene.add(body.with_position(DVec3::new(x, 0.5 + GAP, z)))?;
    }
    let slab = free("slab", &cuboid(DVec3::new(1.2, 0.1, 1.2))?, 0.5).with_mass(Mass::Total(ratio));
    scene.add(slab.with_position(DVec3::new(0.2, 1.1 + 2.0 * GAP, 0.1)))?;
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// Bricks of length 2 that each reach beyond the one below by a part of 1/k, k counted from above.
fn overhang(mut scene: Scene, count: u32, part: f64) -> Result<Trial, Error> {
    let shape = cuboid(DVec3::new(1.0, 0.1, 0.5))?;
    // The lowest one stands on a block that ends where it would tip.
    let block = cuboid(DVec3::new(1.0, 5.0, 1.0))?;
    scene.add(super::trial::still("block", &block, 0.5).with_position(DVec3::NEG_Y * 5.0))?;
    let mut x = 0.0;
    let mut last = None;
    for k in (1..=count).rev() {
        x += part / f64::from(k);
        let place = DVec3::new(x, 0.1 + GAP + (0.2 + GAP) * f64::from(count - k), 0.0);
        last = Some(scene.add(free(format!("brick {k}"), &shape, 0.5).with_position(place))?);
    }
    let Some(top) = last else { return Err("no brick".into()) };
    if part < 1.0 {
        return under(scene, vec![stays(CREEP), rests(1e-3)]);
    }
    under(scene, vec![gets_along(top, DVec3::NEG_Y, 0.2)])
}

/// Bricks in courses, each over the joint of two below.
fn wall(mut scene: Scene, rows: u32, columns: u32) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let (whole, half) =
        (cuboid(DVec3::new(0.5, 0.25, 0.25))?, cuboid(DVec3::new(0.25 - 0.5 * GAP, 0.25, 0.25))?);
    for row in 0..rows {
        let y = 0.25 + GAP + (0.5 + GAP) * f64::from(row);
        let pitch = 1.0 + 2.0 * GAP;
        let is_shifted = row % 2 == 1;
        for column in 0..columns {
            let x = pitch * (f64::from(column) + if is_shifted { 0.5 } else { 0.0 });
            if is_shifted && column + 1 == columns {
                break;
            }
            let body = free(format!("brick {row} {column}"), &whole, 0.5);
            scene.add(body.with_position(DVec3::new(x, y, 0.0)))?;
        }
        if is_shifted {
            for x in [-0.25 - 0.5 * GAP, pitch * f64::from(columns - 1) + 0.25 + 0.5 * GAP] {
                let body = free(format!("half {row} {x}"), &half, 0.5);
                scene.add(body.with_position(DVec3::new(x, y, 0.0)))?;
            }
        }
    }
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// Boxes on each other in columns a gap apart, as goods on a pallet.
fn columns(mut scene: Scene, along: u32, across: u32, high: u32) -> Result<Trial, Error> {
    scene.add(floor(0.0, 0.5)?)?;
    let shape = cuboid(DVec3::new(0.5, 0.25, 0.5))?;
    let places = (0..high).flat_map(|y| (0..along).flat_map(move |x| (0..across).map(move |z| [x, y, z])));
    for at in places {
        let [x, y, z] = at.map(f64::from);
        let place = DVec3::new((1.0 + GAP) * x, 0.25 + GAP + (0.5 + GAP) * y, (1.0 + GAP) * z);
        scene.add(free(format!("box {at:?}"), &shape, 0.5).with_position(place))?;
    }
    under(scene, vec![stays(CREEP), rests(1e-3)])
}

/// Half a circle of stones around a mean radius of 1. One as thick as 0.1075 or more stands with enough friction (Milankovitch 1907); with
/// less than 0.3 none does.
fn arch(mut scene: Scene, stones: u32, thickness: f64, friction: f64) -> Result<Trial, Error> {
    scene.add(floor(-0.5 * GAP, friction)?)?;
    let (inner, outer) = (1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness);
    let angle = PI / f64::from(stones);
    let mut crown = None;
    for k in 0..stones {
        let middle = angle * (f64::from(k) + 0.5);
        // In the axes of the stone, x outward: its sides lean by half the angle and keep half a gap to the joint.
        let side = |radius: f64, sign: f64| {
            let (sin, cos) = (0.5 * angle).sin_cos();
            DVec2::new(radius * cos + 0.5 * GAP * sin, sign * (radius * sin - 0.5 * GAP * cos))
        };
        let corners = [side(inner, -1.0), side(outer, -1.0), side(outer, 1.0), side(inner, 1.0)];
        let center = DVec2::new(1.0, 0.0);
        let shape = prism(&corners.map(|corner| corner - center), 0.3)?;
        let turn = DQuat::from_rotation_z(middle);
        let body = free(format!("stone {k}"), &shape, friction).with_orientation(turn);
        let id = scene.add(body.with_position(turn * center.extend(0.0)))?;
        if k == stones / 2 {
            crown = Some(id);
        }
    }
    let Some(crown) = crown else { return Err("no stone".into()) };
    if thickness > 0.1075 && friction > 0.4 {
        return under(scene, vec![stays(2.0 * CREEP), rests(1e-3)]);
    }
    under(scene, vec![gets_along(crown, DVec3::NEG_Y, 0.3)])
}

/// Length, thickness and half the width of a card.
const CARD: [f64; 3] = [1.0, 0.02, 0.3];

/// Two cards that lean on each other above (x, y), half a gap from the plane between them and a gap above y.
fn lean(scene: &mut Scene, degrees: f64, at: DVec2, friction: f64, name: &str) -> Result<f64, Error> {
    let [length, thickness, half] = CARD;
    let shape = cuboid(DVec3::new(0.5 * thickness, 0.5 * length, half))?;
    let (sin, cos) = degrees.to_radians().sin_cos();
    // Of the left card, turned to the right: its lowest and its rightmost corner lie on its inner face.
    let low = -0.5 * thickness * sin - 0.5 * length * cos;
    let right = 0.5 * thickness * cos + 0.5 * length * sin;
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let turn = DQuat::from_rotation_z(-sign * degrees.to_radians());
        let place = DVec3::new(at.x - sign * (right + 0.5 * GAP), at.y + GAP - low, 0.0);
        let body = free(format!("{side} of {name}"), &shape, friction);
        scene.add(body.with_orientation(turn).with_position(place))?;
    }
    // The height of the outer corners above.
    Ok(GAP - low + 0.5 * thickness * sin + 0.5 * length * cos)
}

/// Two cards: they stand on a floor with the friction of (tan − d/L)/2, which is what their thrust is to their weight.
fn leaning_cards(mut scene: Scene, degrees: f64, part: f64) -> Result<Trial, Error> {
    let [length, thickness, _] = CARD;
    let needed = 0.5 * (degrees.to_radians().tan() - thickness / length);
    let friction = part * needed;
    scene.add(floor(0.0, friction)?)?;
    lean(&mut scene, degrees, DVec2::ZERO, friction, "pair")?;
    if part > 1.0 {
        return under(scene, vec![stays(2.0 * CREEP), rests(1e-3)]);
    }
    let left = scene.ids[0];
    under(scene, vec![gets_along(left, DVec3::NEG_Y, 0.02)])
}

/// Pairs of cards with a flat one upon them that loads both of each, one pair less on each level.
fn house(mut scene: Scene, levels: u32) -> Result<Trial, Error> {
    let [length, thickness, half] = CARD;
    let friction = 0.7;
    scene.add(floor(0.0, friction)?)?;
    let degrees: f64 = 18.0;
    // The feet of neighbors are well apart.
    let pitch = 2.0 * length * degrees.to_radians().sin() + 0.15;
    let mut below = 0.0;
    for level in 0..levels {
        let pairs = levels - level;
        let wide = 0.5 * pitch * f64::from(pairs - 1);
        let mut height = 0.0;
        for k in 0..pairs {
            let at = DVec2::new(pitch * f64::from(k) - wide, below);
            height = lean(&mut scene, degrees, at, friction, &format!("pair {k} on level {level}"))?;
        }
        below += height + GAP + thickness;
        if pairs > 1 {
            let flat = cuboid(DVec3::new(wide + 0.1, 0.5 * thickness, half))?;
            let body = free(format!("flat on level {level}"), &flat, friction);
            scene.add(body.with_position(DVec3::Y * (below - 0.5 * thickness)))?;
        }
    }
    under(scene, vec![stays(10.0 * CREEP), rests(1e-3)])
}
