//! Pairs whose axes of rotation are nearly parallel: bolts in nuts, wheels in forks, shafts in bearings, plates on axles.
//!
//! What a search concludes along a common axis is true of axes that are parallel, and has to pay for each that is not quite: here they
//! are tilted by all sizes, at clearances of all sizes, so that both what is still true and what no longer is are met.
use super::case::{Case, ask, usual};
use d2m::motion::{Chain, Joint, JointKind, JointValue, Keyframes, ScrewMotion, Spline, SplineDegree};
use d2m::{ConstantTwist, MeshTree, Moving, RigidMotion, Solid, TriMesh};
use d2m_testing::{Draw, Opaque, OpaqueWithState, Random, Surface};
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};

/// Two bodies in the frame of the one's axle, which is z.
struct Axles {
    surfaces: [Surface; 2],
    /// Where the second one's axle is.
    beside: DVec3,
    /// Sizes that a clearance and a speed are part of.
    size: f64,
    /// How far the second one's threads carry it in a turn.
    lead: f64,
}

/// One pair on its axles, and a question about it.
pub(super) fn axles(case: &Case<'_>) {
    let random = &mut case.random();
    // A tilt about as large as the clearance closes it within a turn: where both are small, axes are still taken for parallel.
    let closes = random.unit() < 0.5;
    let gap = if closes { random.log_between(1e-9, 1e-5) } else { random.log_between(1e-9, 0.1) };
    let Axles { surfaces, beside, size, lead } = match random.index(6) {
        0 => plates(random, gap),
        1 => rods(random, gap),
        2 => bolt_and_nut(random, gap),
        3 => wheel_in_fork(random, gap),
        4 => shaft_in_bearing(random, gap),
        _ => wheels_beside_each_other(random, gap),
    };
    let tilt = if closes { leaning(random, [0.2 * gap, 5.0 * gap]) } else { tilt(random) };
    let [one, other] = rates(random);
    // The whole scene anyhow in the world, and of another size.
    let frame = if random.unit() < 0.4 { DQuat::IDENTITY } else { DQuat::from_scaled_axis(random.vector()) };
    let scale = if random.unit() < 0.7 { 1.0 } else { random.between(-20.0, 20.0).round().exp2() };
    let slow = gap * size * random.log_between(1e-3, 10.0);
    let carried = DVec3::Z * (lead * (other - one) / TAU);
    let velocity = carried
        + match random.index(5) {
            0 => DVec3::ZERO,
            1 => DVec3::Z * slow * random.signed().signum(),
            2 => random.direction() * slow,
            3 => DVec3::Z * random.signed() * size,
            _ => random.direction() * (slow * 1e-3),
        };
    let common = if random.unit() < 0.7 { DVec3::ZERO } else { random.vector() * size };
    let lean = DQuat::from_rotation_arc(DVec3::Z, tilt);
    // A body whose axle leans may lean with it: its axle is its own axis of symmetry then.
    let leans = if random.unit() < 0.5 { lean } else { DQuat::IDENTITY };
    // Threads fit into each other as they are.
    let anyhow = lead == 0.0 && random.unit() < 0.5;
    let turned = |random: &mut Random| {
        if anyhow { DQuat::from_rotation_z(random.between(0.0, TAU)) } else { DQuat::IDENTITY }
    };
    let far = if random.unit() < 0.7 {
        DVec3::ZERO
    } else {
        random.direction() * size * random.log_between(0.1, 30.0)
    };
    let twist = |x: DVec3, turn: DQuat, v: DVec3, w: DVec3| {
        ConstantTwist::REST
            .with_position(frame * x * scale)
            .with_orientation(frame * turn)
            .with_linear_velocity(frame * v * scale)
            .with_angular_velocity(frame * w)
    };
    let twists = [
        twist(far, turned(random), common, DVec3::Z * one),
        twist(far + beside, leans * turned(random), common + velocity, tilt * other),
    ];
    // Boxes are judged by other families.
    let trees = surfaces.map(|surface| MeshTree::new(surface.map(|p| p * scale).into_mesh(TriMesh::try_new)));
    let motions = twists.map(|twist| motion(random, twist));
    let order = if random.unit() < 0.5 { [0, 1] } else { [1, 0] };
    let tolerance = size * scale * random.log_between(1e-10, 1e-4);
    let separation = if random.unit() < 0.7 { 0.0 } else { gap * size * scale * random.unit() };
    let options =
        usual().with_solid(Solid::Surface).with_tolerance(tolerance).with_min_separation(separation);
    ask(case.index % 8, order.map(|k| Moving::new(&trees[k], &*motions[k])), &options);
}

/// The direction of an axle that leans against z by nothing, by one place, or by up to a thousandth.
fn tilt(random: &mut Random) -> DVec3 {
    match random.index(8) {
        0 => DVec3::Z,
        1 => DVec3::new(f64::EPSILON * random.signed().signum(), 0.0, 1.0),
        _ => leaning(random, [1e-12, 1e-3]),
    }
}

/// The direction of an axle that leans against z by an angle between these.
fn leaning(random: &mut Random, [least, most]: [f64; 2]) -> DVec3 {
    let across = DQuat::from_rotation_z(random.between(0.0, TAU)) * DVec3::X;
    (DVec3::Z + across * random.log_between(least, most)).normalize()
}

/// Two rates about the axles: alike, opposite, nearly alike, unlike, or only one.
fn rates(random: &mut Random) -> [f64; 2] {
    let one = random.log_between(0.1, 60.0) * random.signed().signum();
    let other = match random.index(7) {
        0 => one,
        1 => -one,
        2 => one * (1.0 + random.log_between(1e-13, 1e-2) * random.signed().signum()),
        3 => one * random.log_between(0.01, 100.0).min(60.0 / one.abs()),
        4 => -one * random.unit(),
        5 => one * f64::from(random.index(5) as u32 + 2) / 2.0,
        _ => 0.0,
    };
    [one, other]
}

/// A constant twist as what it is, or as one of the motions that can say the same, or nearly the same.
fn motion(random: &mut Random, twist: ConstantTwist) -> Box<dyn RigidMotion + Send> {
    let general: Option<Box<dyn RigidMotion + Send>> = match random.index(16) {
        0 => ScrewMotion::try_from_constant_twist(twist).ok().map(|screw| Box::new(screw) as _),
        1 => Keyframes::try_from_spans(vec![-1.0, 0.3, 2.0], vec![twist; 2])
            .ok()
            .map(|spans| Box::new(spans) as _),
        2 => spline(random, &twist).map(|spline| Box::new(spline) as _),
        3 => chain(random, &twist).map(|chain| Box::new(chain) as _),
        4 => Some(Box::new(Opaque(twist))),
        5 => Some(Box::new(OpaqueWithState(twist))),
        _ => None,
    };
    general.unwrap_or_else(|| Box::new(twist))
}

/// Through poses of the twist, an eighth of a turn from each to the next at most.
fn spline(random: &mut Random, twist: &ConstantTwist) -> Option<Spline> {
    let pieces = (twist.angular_velocity().length() / (0.25 * PI)).ceil().max(2.0);
    let poses: Vec<_> =
        (0..=pieces as usize).map(|k| k as f64 / pieces).map(|t| (t, twist.pose_and_twist(t).0)).collect();
    let degree = if random.unit() < 0.5 { SplineDegree::Cubic } else { SplineDegree::Quintic };
    Spline::try_through(&poses, degree).ok()
}

/// A slide along the velocity that carries a turn about the axle, whose rate may change.
fn chain(random: &mut Random, twist: &ConstantTwist) -> Option<Chain> {
    let (v, w) = (twist.linear_velocity(), twist.angular_velocity());
    let change = if random.unit() < 0.5 { 0.0 } else { random.signed() * w.length() };
    let slide = JointKind::Prismatic {
        axis: v.try_normalize().unwrap_or(DVec3::X),
        value: JointValue::try_polynomial(vec![0.0, v.length()]).ok()?,
    };
    let turn = JointKind::Revolute {
        axis: twist.orientation().conjugate() * w.try_normalize()?,
        value: JointValue::try_polynomial(vec![0.0, w.length(), change]).ok()?,
    };
    let slides = Joint::try_new(twist.position(), DQuat::IDENTITY, slide).ok()?;
    Chain::try_new(vec![slides, Joint::try_new(DVec3::ZERO, twist.orientation(), turn).ok()?]).ok()
}

/// What a closed outline of (ρ, z) leaves that is led about z in so many steps; it may depend on the part of a turn.
fn lathed(sides: u32, outline: impl Fn(f64) -> Vec<[f64; 2]>) -> Surface {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for side in 0..sides {
        let part = f64::from(side) / f64::from(sides);
        let (sin, cos) = (TAU * part).sin_cos();
        let around = outline(part);
        let count = around.len() as u32;
        for (k, [rho, z]) in (0..count).zip(around) {
            let next = (k + 1) % count;
            let [at, after] = [side, (side + 1) % sides].map(|side| side * count);
            vertices.push(DVec3::new(rho * cos, rho * sin, z));
            triangles.extend([[at + k, after + k, after + next], [at + k, after + next, at + next]]);
        }
    }
    let surface = Surface { name: "turned", vertices, triangles };
    if surface.signed_volume() < 0.0 { surface.inverted() } else { surface }
}

/// A ring, or a wheel with a bore.
fn ring(sides: u32, [inner, outer]: [f64; 2], [low, high]: [f64; 2]) -> Surface {
    lathed(sides, |_| vec![[inner, low], [outer, low], [outer, high], [inner, high]])
}

/// So much larger are the corners of a polygon of so many sides than the circle in it.
fn corner(sides: u32) -> f64 {
    1.0 / (PI / f64::from(sides)).cos()
}

/// Flat plates or discs one above the other, whose rims a tilt moves up and down.
fn plates(random: &mut Random, gap: f64) -> Axles {
    let mut plate = || {
        let half = random.log_between(1e-4, 0.3);
        if random.unit() < 0.5 {
            let [x, y] = [0, 1].map(|_| random.between(0.1, 1.0));
            (half, Surface::cuboid(-DVec3::new(x, y, half), DVec3::new(x, y, half)))
        } else {
            let outer = random.between(0.3, 1.0);
            (half, ring(4 + random.index(12) as u32, [0.1, outer], [-half, half]))
        }
    };
    let [(low, below), (high, above)] = [plate(), plate()];
    Axles { surfaces: [below, above], beside: DVec3::Z * (low + high + gap), size: 1.0, lead: 0.0 }
}

/// Long rods along their axles or across them.
fn rods(random: &mut Random, gap: f64) -> Axles {
    let half = random.log_between(1e-3, 0.1);
    let kind = random.index(3);
    let mut rod = |along: bool| {
        let length = random.between(0.5, 3.0);
        let extents = if along { DVec3::new(half, half, length) } else { DVec3::new(length, half, half) };
        Surface::cuboid(-extents, extents)
    };
    let surfaces = [rod(kind == 0), rod(kind != 1)];
    let [a, b] = surfaces.each_ref().map(|rod| rod.vertices[7]);
    let beside = match kind {
        // Side by side; one above the other; the one rises beside the circle of the other one's ends.
        0 => DVec3::X * (2.0 * half * 2f64.sqrt() + gap),
        1 => DVec3::Z * (2.0 * half + gap),
        _ => DVec3::X * (a.truncate().length() + b.truncate().length() + gap),
    };
    Axles { surfaces, beside, size: 3.0, lead: 0.0 }
}

/// A thread of a few hundred triangles in another one.
fn bolt_and_nut(random: &mut Random, gap: f64) -> Axles {
    let sides = 8 + random.index(9) as u32;
    let pitch = random.log_between(0.1, 1.0);
    let depth = pitch * random.between(0.05, 0.4);
    let turns = 1 + random.index(4);
    let thread =
        move |z: f64, part: f64| 0.5 + depth * (1.0 - 2.0 * ((z / pitch - part).rem_euclid(1.0) - 0.5).abs());
    // The points of the outline follow the thread.
    let heights = move |part: f64, turns: usize| {
        (0..=4 * turns).map(move |k| pitch * (k as f64 / 4.0 + part - 0.5 * turns as f64))
    };
    let threaded = |turns: usize, core: f64, wider: f64| {
        lathed(sides, move |part| {
            let side: Vec<_> = heights(part, turns)
                .map(|z| [thread(z, part) * wider + if wider > 1.0 { gap } else { 0.0 }, z])
                .collect();
            let (first, last) = (side[0][1], side[side.len() - 1][1]);
            side.into_iter().chain([[core, last], [core, first]]).collect()
        })
    };
    let bolt = threaded(turns + random.index(5), 0.2, 1.0);
    let nut = threaded(turns, 1.5, corner(sides));
    Axles { surfaces: [bolt, nut], beside: DVec3::ZERO, size: 1.0, lead: pitch }
}

/// A wheel between two plates, which may be square.
fn wheel_in_fork(random: &mut Random, gap: f64) -> Axles {
    let half = random.log_between(1e-3, 0.3);
    let wheel = ring(6 + random.index(20) as u32, [0.1, 1.0], [-half, half]);
    let thick = random.log_between(1e-3, 0.2);
    let (is_square, width) = (random.unit() < 0.5, random.between(0.2, 1.5));
    let mut tine = |low: f64| {
        if is_square {
            let corner = DVec3::new(random.between(0.2, 1.5), width, low + thick);
            Surface::cuboid(DVec3::new(-0.2, -width, low), corner)
        } else {
            ring(5, [0.15, width], [low, low + thick])
        }
    };
    let fork = tine(half + gap).with(&tine(-half - gap - thick));
    Axles { surfaces: [wheel, fork], beside: DVec3::ZERO, size: 1.0, lead: 0.0 }
}

/// A polygon that turns in another one, with play all around or on one side.
fn shaft_in_bearing(random: &mut Random, gap: f64) -> Axles {
    let sides = [4 + random.index(20) as u32, 4 + random.index(20) as u32];
    let length = random.log_between(0.05, 3.0);
    let shaft = ring(sides[0], [0.2, 0.5], [-length, length]);
    let play = if random.unit() < 0.5 { 0.0 } else { gap };
    let inner = (0.5 + gap + play) * corner(sides[1]);
    let wide = random.log_between(0.05, 1.5);
    let bearing = ring(sides[1], [inner, inner + 0.3], [-wide, wide]);
    Axles { surfaces: [shaft, bearing], beside: DVec3::X * play, size: length.max(1.0), lead: 0.0 }
}

/// Friction wheels: the rims pass each other.
fn wheels_beside_each_other(random: &mut Random, gap: f64) -> Axles {
    let mut wheel = || {
        let (outer, half) = (random.between(0.2, 1.0), random.log_between(1e-3, 1.0));
        (outer, ring(5 + random.index(20) as u32, [0.1, outer], [-half, half]))
    };
    let [(a, one), (b, other)] = [wheel(), wheel()];
    Axles { surfaces: [one, other], beside: DVec3::X * (a + b + gap), size: 1.0, lead: 0.0 }
}
