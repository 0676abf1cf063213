//! What an audit asks the engine: each family makes its query number `index` of a seed, and answers whatever it asks.
use super::axles::axles;
use super::case::{Case, ask, usual};
use crate::accuracy::hostile;
use d2m::bvh::{collide, distance_within};
use d2m::motion::{Chain, Joint, JointKind, JointValue, Keyframes, Span, Spline, SplineDegree};
use d2m::{
    Body, Budget, ConstantTwist, MeshTree, Mode, Moving, PairCache, Pose, Posed, ProximityOptions,
    QueryOptions, RigidMotion, SharedMotion, Solid, Start, TriMesh, Window, World, contact_exists,
    proximities_with, time_of_contact, time_of_contact_with,
};
use d2m_dynamics::{Kind, Simulation, SimulationOptions};
use d2m_testing::{Draw, Opaque, OpaqueWithState, Random, SharpFamily, SharpScene, SmallScene, Surface};
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// Makes a question and asks it.
pub(super) type Family = fn(&Case<'_>);

/// Each with its name. Cases of a family come one after the other, in turns with those of the others.
pub(super) const FAMILIES: [(&str, Family); 11] = [
    ("sharp", sharp),
    ("hostile", |case| hostile::ask(case.seed, case.index)),
    ("small", small),
    ("modes", modes),
    ("motions", any_motion),
    ("caches", caches),
    ("questions", questions),
    ("axles", axles),
    ("rest", at_rest),
    ("worlds", worlds),
    ("simulations", simulations),
];

fn sharp_options(scene: &SharpScene) -> QueryOptions {
    usual().with_solid(Solid::Surface).with_tolerance(scene.tolerance).with_min_separation(scene.separation)
}

fn sharp(case: &Case<'_>) {
    let family = SharpFamily::ALL[case.index as usize % SharpFamily::ALL.len()];
    let scene = SharpScene::draw(family, case.seed, case.index);
    let trees = scene.surfaces.clone().map(|surface| case.tree(surface));
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
    let _ = time_of_contact(bodies[0], bodies[1], Window::UNIT, &sharp_options(&scene));
}

fn small_scene(seed: u64, index: u64) -> SmallScene {
    let is_closed = |surface: &Surface| {
        let mesh = TriMesh::try_new(surface.vertices.clone(), surface.triangles.clone());
        mesh.is_ok_and(|mesh| MeshTree::new(mesh).is_watertight())
    };
    SmallScene::draw(seed, index, is_closed)
}

fn small(case: &Case<'_>) {
    let scene = small_scene(case.seed, case.index);
    let trees = scene.surfaces.clone().map(|surface| case.tree(surface));
    let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
    let Ok(window) = Window::try_new(scene.window[0], scene.window[1]) else { return };
    let _ = time_of_contact(bodies[0], bodies[1], window, &usual().with_solid(solid));
}

/// Early stops, existence, several threads, what is left at the start.
fn modes(case: &Case<'_>) {
    let family = SharpFamily::ALL[case.index as usize / 4 % SharpFamily::ALL.len()];
    let scene = SharpScene::draw(family, case.seed, case.index);
    let trees = scene.surfaces.clone().map(|surface| case.tree(surface));
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
    let options = sharp_options(&scene);
    let options = match case.index % 4 {
        0 => options.with_mode(Mode::Capoeira),
        1 => options.with_mode(Mode::Exists),
        2 => options.with_parallel(true),
        _ => options.with_start(Start::Leave),
    };
    let _ = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options);
}

fn random_pose(random: &mut Random, spread: f64) -> Pose {
    let rotation = DQuat::from_scaled_axis(random.vector());
    Pose { translation: random.vector() * spread, rotation, at: DVec3::ZERO }
}

/// A motion from one side of the origin to the other, of any kind, over [0, 1].
fn motion(random: &mut Random) -> Box<dyn RigidMotion + Send> {
    let from = random.direction() * random.between(1.0, 4.0);
    let middle = random_pose(random, 1.0);
    let ends = [from, -from].map(|translation| Pose { translation, ..random_pose(random, 0.0) });
    let frames = [(0.0, ends[0]), (random.between(0.1, 0.9), middle), (1.0, ends[1])];
    let twist = ConstantTwist::REST
        .with_position(from + middle.translation)
        .with_linear_velocity(-2.0 * from)
        .with_angular_velocity(random.vector() * random.log_between(0.1, 40.0));
    let value = |terms: Vec<f64>| JointValue::try_polynomial(terms).expect("finite coefficients");
    let turn = value(vec![0.3, 2.0 * random.signed(), -1.5, random.signed()]);
    let slide = value(vec![-random.unit(), 1.0, random.signed()]);
    let joint = |kind| Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).expect("an axis");
    match random.index(8) {
        0 => Box::new(Opaque(twist)),
        1 => Box::new(OpaqueWithState(twist)),
        2 | 3 => {
            let slides = joint(JointKind::Prismatic { axis: from, value: slide });
            let turns = joint(JointKind::Revolute { axis: random.direction(), value: turn });
            Box::new(Chain::try_new(vec![slides, turns]).expect("a chain"))
        }
        kind => {
            let spline = match kind {
                4 => Spline::try_through(&frames, SplineDegree::Cubic).ok(),
                5 => Spline::try_through(&frames, SplineDegree::Quintic).ok(),
                _ => None,
            };
            let keyframes = || Keyframes::try_new(&frames, Span::Screw).ok();
            match spline {
                Some(spline) => Box::new(spline),
                None if kind == 6 => keyframes().map_or(Box::new(twist), |frames| Box::new(Opaque(frames))),
                None => keyframes().map_or(Box::new(twist), |frames| Box::new(frames)),
            }
        }
    }
}

fn drawn_options(random: &mut Random) -> QueryOptions {
    let separation = if random.unit() < 0.5 { 0.0 } else { random.log_between(1e-4, 0.3) };
    usual()
        .with_solid(Solid::Surface)
        .with_tolerance(random.log_between(1e-9, 1e-2))
        .with_min_separation(separation)
}

fn any_motion(case: &Case<'_>) {
    let random = &mut case.random();
    let trees = [case.shape(random), case.shape(random)];
    let still: Box<dyn RigidMotion + Send> = Box::new(ConstantTwist::REST);
    let motions = [motion(random), if random.unit() < 0.6 { still } else { motion(random) }];
    let options = drawn_options(random);
    let _ = time_of_contact(
        Moving::new(&trees[0], &*motions[0]),
        Moving::new(&trees[1], &*motions[1]),
        Window::UNIT,
        &options,
    );
}

/// Queries that differ little from each other, with one cache.
fn caches(case: &Case<'_>) {
    let random = &mut case.random();
    let trees = [case.shape(random), case.shape(random)];
    let options = drawn_options(random).with_budget(Budget::UNLIMITED);
    let start = random.direction() * random.between(1.0, 2.0);
    let (speed, spin) = (random.vector(), random.vector() * 3.0);
    let is_general = random.unit() < 0.5;
    let mut cache = PairCache::new();
    for step in 0..24 {
        let off = random.vector() * (1e-3 * f64::from(step));
        let twist = ConstantTwist::REST
            .with_position(start - start * (0.02 * f64::from(step)) + off)
            .with_linear_velocity(speed)
            .with_angular_velocity(spin);
        let value = JointValue::try_polynomial(vec![0.0, 1.0, 0.05]).expect("finite");
        let joint = Joint::try_new(
            twist.position(),
            DQuat::IDENTITY,
            JointKind::Revolute { axis: spin.normalize(), value },
        );
        let chain = Chain::try_new(vec![joint.expect("an axis")]).expect("a chain");
        let a = if is_general { Moving::new(&trees[0], &chain) } else { Moving::new(&trees[0], &twist) };
        let b = Moving::new(&trees[1], &ConstantTwist::REST);
        let _ = time_of_contact_with(a, b, Window::UNIT, &options, &mut cache);
        let _ = contact_exists(a, b, Window::UNIT, &options, &mut cache);
    }
}

/// How near, when, and when they part.
fn questions(case: &Case<'_>) {
    let random = &mut case.random();
    let trees = [case.shape(random), case.shape(random)];
    let motions = [motion(random), motion(random)];
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], &*motions[k]));
    ask(case.index % 3, bodies, &drawn_options(random));
}

fn at_rest(case: &Case<'_>) {
    let random = &mut case.random();
    let trees = [case.shape(random), case.shape(random)];
    let spread = random.between(0.3, 2.0);
    let poses = [random_pose(random, spread), random_pose(random, spread)];
    let [a, b] = [0, 1].map(|k| Posed::new(&trees[k], poses[k]));
    let margin = random.log_between(1e-3, 1.0);
    let _ = proximities_with(a, b, &ProximityOptions::new(margin));
    let mut options = d2m::bvh::DistanceOptions::default().with_solid(Solid::Surface);
    if random.unit() < 0.3 {
        options = options.with_cutoff(random.unit());
    }
    let _ = distance_within(a, b, &options);
    let _ = collide(a, b, Solid::Surface);
}

/// Bodies that fly about, some of which change their ways from query to query.
fn worlds(case: &Case<'_>) {
    let random = &mut case.random();
    let separation = if random.unit() < 0.5 { 0.0 } else { random.log_between(1e-3, 0.2) };
    let mut world = World::new(usual().with_solid(Solid::Surface).with_min_separation(separation));
    let fly = |random: &mut Random| -> SharedMotion {
        let velocity = random.vector() * random.log_between(0.1, 30.0);
        Arc::new(
            ConstantTwist::REST
                .with_position(random.vector() * 6.0)
                .with_linear_velocity(velocity)
                .with_angular_velocity(random.vector() * random.log_between(0.1, 20.0)),
        )
    };
    let shapes = [case.shape(random), case.shape(random)].map(Arc::new);
    let ids: Vec<_> =
        (0..8).map(|k| world.add(Body::with_shared(Arc::clone(&shapes[k % 2]), fly(random)))).collect();
    for step in 0..4 {
        let start = 0.2 * f64::from(step);
        let Ok(window) = Window::try_new(start, if random.unit() < 0.5 { 1.0 } else { start + 0.3 }) else {
            continue;
        };
        if random.unit() < 0.5 {
            let _ = world.first_contact(window);
        } else {
            let _ = world.contacts(window);
        }
        let changed = ids[random.index(ids.len())];
        world.set_shared_motion(changed, fly(random));
    }
}

/// A few boxes and others that fall on a floor.
fn simulations(case: &Case<'_>) {
    let random = &mut case.random();
    let Ok(mut simulation) = Simulation::new(SimulationOptions::default().with_step(1.0 / 64.0)) else {
        return;
    };
    let slab = Arc::new(case.tree(Surface::cuboid(DVec3::new(-5.0, -1.0, -5.0), DVec3::new(5.0, 0.0, 5.0))));
    let floor = d2m_dynamics::Body::new("floor", slab).with_kind(Kind::Static);
    let _ = simulation.add(&floor);
    for k in 0..2 + random.index(4) {
        let shape = match random.index(3) {
            0 => Surface::cuboid(-0.2 * DVec3::ONE, 0.2 * DVec3::ONE),
            1 => Surface::cone(6, 0.2, 0.4),
            _ => Surface::torus(8, 5, 0.3).map(|p| p * 0.3),
        };
        let body = d2m_dynamics::Body::new(format!("body {k}"), Arc::new(case.tree(shape)))
            .with_position(DVec3::new(0.2 * random.signed(), 0.6 + 0.7 * k as f64, 0.2 * random.signed()))
            .with_orientation(DQuat::from_scaled_axis(random.vector()))
            .with_angular_velocity(random.vector() * random.log_between(0.1, 20.0));
        let _ = simulation.add(&body);
    }
    for _ in 0..24 {
        if simulation.step().is_err() {
            return;
        }
    }
}
