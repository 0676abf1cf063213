//! Many moving bodies.
use super::{Target, figure, least_in_turn, least_time, milliseconds, threads, wrong};
use crate::{TaskResult, memory};
use d2m::glam::{DQuat, DVec3};
use d2m::{
    Body, BodyId, ConstantTwist, FirstContact, MeshTree, Posed, QueryOptions, RigidMotion, Solid, StartState,
    TimeOfContact, Window, World, distance, time_of_contact,
};
use d2m_testing::Xoshiro256 as Random;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

fn tree(shape: &str) -> Result<Arc<MeshTree>, Error> {
    Ok(Arc::new(MeshTree::new(d2m::shapes::mesh(shape)?)))
}

fn flying(random: &mut Random, place: DVec3, speed: f64) -> ConstantTwist {
    ConstantTwist::REST
        .with_position(place)
        .with_orientation(DQuat::from_scaled_axis(random.direction() * 3.0))
        .with_linear_velocity(random.direction() * speed)
        .with_angular_velocity(random.direction() * 0.3)
}

/// Bodies on a grid, `spacing` apart, each with its own velocity.
fn grid(mesh: &Arc<MeshTree>, side: u32, spacing: f64, speed: f64) -> World {
    let mut random = Random::new(11);
    let mut world = World::new(QueryOptions::default());
    for k in 0..side * side * side {
        let place = DVec3::new(f64::from(k % side), f64::from(k / side % side), f64::from(k / side / side));
        world.add(Body::new(Arc::clone(mesh), flying(&mut random, place * spacing, speed)));
    }
    world
}

pub(super) fn run(rounds: usize) -> TaskResult {
    broad_phase(rounds)?;
    events()?;
    at_one_place(rounds)?;
    bytes_of_candidates()?;
    let dense = among_each_other()?;
    unavoidable(rounds, "300 knots among each other", &dense, Target::AtMost(2.0))?;
    // Next to nothing to search: the whole is the cost of the boxes, which is a figure of its own above and grows with the bodies, not
    // with the queries. A ratio to fifteen queries says nothing of the search.
    unavoidable(rounds, "343 rings that hardly meet", &crossing_flights()?, Target::None)?;
    threads::run(rounds, &dense)
}

fn broad_phase(rounds: usize) -> TaskResult {
    let mesh = tree("icosphere?triangles=320")?;
    for (name, spacing) in [("no boxes overlap", 4.0), ("boxes overlap", 2.5)] {
        let world = grid(&mesh, 10, spacing, 0.5);
        let (time, pairs) =
            least_time(4 * rounds, || (), |()| world.candidates(Window::UNIT).expect("all motions cover it"));
        check_candidates(&world, &pairs)?;
        let what = format!("broad phase, 1000 moving bodies from scratch, {name}, {} pairs", pairs.len());
        figure(what, milliseconds(time), "ms", Target::AtMost(1.0));
    }
    let mut random = Random::new(5);
    let mut changed = |world: &mut World| {
        let ids: Vec<_> = world.ids().step_by(10).collect();
        for id in ids {
            let place = world.body(id).motion().pose_and_twist(0.0).0.translation;
            let motion = flying(&mut random, place, 0.5);
            world.set_motion(id, motion);
        }
    };
    let mut world = grid(&mesh, 10, 4.0, 0.5);
    let mut least = f64::INFINITY;
    for _ in 0..=4 * rounds {
        let start = Instant::now();
        let answer = world.first_contact(Window::UNIT)?;
        let time = milliseconds(start.elapsed());
        if answer != FirstContact::Separated {
            return Err(wrong("bodies whose boxes do not meet"));
        }
        least = least.min(time);
        changed(&mut world);
    }
    figure("broad phase, a tenth of 1000 bodies changed", least, "ms", Target::AtMost(0.2));
    many_bodies(rounds, &mesh)
}

/// The same with ten times as many: the time grows little faster than their number.
fn many_bodies(rounds: usize, mesh: &Arc<MeshTree>) -> TaskResult {
    let mut world = grid(mesh, 22, 4.0, 0.5);
    let count = world.len();
    let (time, pairs) =
        least_time(rounds, || (), |()| world.candidates(Window::UNIT).expect("all motions cover it"));
    let what = format!("broad phase, {count} moving bodies from scratch, {} pairs", pairs.len());
    figure(what, milliseconds(time), "ms", Target::None);
    let mut random = Random::new(5);
    let mut least = f64::INFINITY;
    for round in 0..=4 * rounds {
        let start = Instant::now();
        let answer = world.first_contact(Window::UNIT)?;
        let time = milliseconds(start.elapsed());
        if answer != FirstContact::Separated {
            return Err(wrong("bodies whose boxes do not meet"));
        }
        // The first query finds all boxes.
        if round > 0 {
            least = least.min(time);
        }
        let ids: Vec<_> = world.ids().step_by(10).collect();
        for id in ids {
            let place = world.body(id).motion().pose_and_twist(0.0).0.translation;
            let motion = flying(&mut random, place, 0.5);
            world.set_motion(id, motion);
        }
    }
    figure(format!("broad phase, a tenth of {count} bodies changed"), least, "ms", Target::AtMost(2.0));
    Ok(())
}

/// Every two bodies whose spheres meet at a sampled time are candidates.
fn check_candidates(world: &World, pairs: &[(BodyId, BodyId)]) -> TaskResult {
    let ids: Vec<_> = world.ids().collect();
    for step in 0..=8 {
        let time = f64::from(step) / 8.0;
        let places: Vec<_> =
            ids.iter().map(|&id| world.body(id).motion().pose_and_twist(time).0.translation).collect();
        for i in 0..ids.len() {
            for j in i + 1..ids.len() {
                // Spheres of radius one, less what their facets leave.
                if places[i].distance(places[j]) < 1.9 && pairs.binary_search(&(ids[i], ids[j])).is_err() {
                    return Err(wrong("a pair that meets is no candidate"));
                }
            }
        }
    }
    Ok(())
}

/// Bodies that fly through each other's way and bounce.
fn events() -> TaskResult {
    let mesh = tree("box?x=0.5&y=0.5&z=0.5")?;
    let mut random = Random::new(3);
    let mut world = World::new(QueryOptions::default().with_min_separation(1e-6));
    for k in 0..2000u32 {
        let place = DVec3::new(f64::from(k % 13), f64::from(k / 13 % 13), f64::from(k / 169)) * 2.5;
        world.add(Body::new(Arc::clone(&mesh), flying(&mut random, place, 1.0)));
    }
    let (mut time, mut times, mut first) = (0.0, Vec::new(), 0.0);
    while times.len() < 300 {
        let start = Instant::now();
        let answer = world.first_contact(Window::try_new(time, 1.0)?)?;
        let spent = milliseconds(start.elapsed());
        let FirstContact::Contact { a, b, contact, .. } = answer else { break };
        if contact.time_lo < time {
            return Err(wrong("an event before the one before"));
        }
        if first == 0.0 {
            first = spent;
        } else {
            times.push(spent);
        }
        time = contact.time_lo;
        let twists = [a, b].map(|id| world.body(id).motion().pose_and_twist(time));
        for (id, (here, own), away) in [(a, twists[0], -1.0), (b, twists[1], 1.0)] {
            let motion = ConstantTwist::REST
                .with_position(here.translation)
                .with_orientation(here.rotation)
                .with_at(here.at)
                .with_linear_velocity(contact.normal * away * own.linear.length().max(0.1))
                .with_reference_time(time);
            world.set_motion(id, motion);
        }
        if times.len() % 100 == 50 {
            check_event(&mut world, time)?;
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |part: f64| times.get((part * times.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    figure("events of 2000 bodies: the first one, with all boxes", first, "ms", Target::None);
    figure(format!("events of 2000 bodies: median of {}", times.len()), at(0.5), "ms", Target::AtMost(1.0));
    figure("events of 2000 bodies: nine tenths are below", at(0.9), "ms", Target::AtMost(1.0));
    Ok(())
}

/// The next contact is that of a world that knows nothing.
fn check_event(world: &mut World, time: f64) -> TaskResult {
    let window = Window::try_new(time, 1.0)?;
    let mut other = World::new(*world.options());
    for id in world.ids() {
        other.add(world.body(id).clone());
    }
    match (world.first_contact(window)?, other.first_contact(window)?) {
        (FirstContact::Contact { contact: x, .. }, FirstContact::Contact { contact: y, .. })
            if x.time_lo <= y.time_hi && y.time_lo <= x.time_hi => {}
        (FirstContact::Separated, FirstContact::Separated) => {}
        (x, y) => return Err(wrong(&format!("{x:?} and {y:?}"))),
    }
    Ok(())
}

fn at_one_place(rounds: usize) -> TaskResult {
    let mesh = tree("box")?;
    let fill = || {
        let mut random = Random::new(8);
        let mut world = World::new(QueryOptions::default());
        for _ in 0..1000 {
            let motion = flying(&mut random, DVec3::ZERO, 1.0);
            world.add(Body::new(Arc::clone(&mesh), motion));
        }
        world
    };
    let (time, answer) = least_time(rounds, fill, |world| world.first_contact(Window::UNIT));
    match answer? {
        FirstContact::Contact { contact, .. }
            if contact.time_lo == 0.0 && contact.start == StartState::Overlapping => {}
        other => return Err(wrong(&format!("1000 bodies at one place: {other:?}"))),
    }
    figure("contact at the start, 1000 bodies at one place", milliseconds(time), "ms", Target::AtMost(50.0));
    Ok(())
}

/// What stays in memory for each pair that the broad phase leaves and nothing has searched.
fn bytes_of_candidates() -> TaskResult {
    let Some(before) = memory::resident() else {
        println!("memory per candidate: only where /proc reports it");
        return Ok(());
    };
    let mesh = tree("box")?;
    // 17³ = 4913 bodies; boxes of many more than neighbors overlap.
    let mut world = grid(&mesh, 17, 1.0, 9.0);
    let filled = memory::resident().unwrap_or(before);
    let count = world.candidates(Window::UNIT).expect("all motions cover it").len();
    let first = world.first_contact(Window::UNIT)?;
    let FirstContact::Contact { contact, .. } = first else { return Err(wrong("overlapping bodies")) };
    if contact.start == StartState::Apart {
        return Err(wrong("overlapping bodies"));
    }
    let spent = memory::resident().unwrap_or(filled).saturating_sub(filled);
    let what = format!("memory a candidate never searched, {count} candidates");
    figure(what, spent as f64 / count as f64, "bytes", Target::AtMost(64.0));
    Ok(())
}

/// Rings far from each other for their size: few boxes meet.
fn crossing_flights() -> Result<World, Error> {
    let mesh = tree("torus?triangles=3000")?;
    let mut random = Random::new(21);
    let mut world = World::new(QueryOptions::default());
    for k in 0..343u32 {
        let place = DVec3::new(f64::from(k % 7), f64::from(k / 7 % 7), f64::from(k / 49)) * 2.2;
        world.add(Body::new(Arc::clone(&mesh), flying(&mut random, place, 0.35)));
    }
    Ok(world)
}

/// 300 thin knots of 5000 triangles through each other's loops, each moving and turning its own way: about twenty neighbors of each
/// are within its box, and nothing but their triangles proves them apart.
fn among_each_other() -> Result<World, Error> {
    const COUNT: usize = 300;
    /// Radius of the ball of centers, in radii of a body.
    const SPREAD: f64 = 4.0;
    /// All are this far from each other at the start.
    const CLEARANCE: f64 = 0.01;
    let mesh = tree("torus-knot?triangles=5000&tube=0.05")?;
    let mut random = Random::new(21);
    let mut placed: Vec<ConstantTwist> = Vec::new();
    while placed.len() < COUNT {
        let place = random.direction() * random.unit().cbrt() * SPREAD;
        let motion = flying(&mut random, place, 0.02);
        let pose = motion.pose_and_twist(0.0).0;
        let mut is_free = true;
        for other in placed.iter().map(|other| other.pose_and_twist(0.0).0) {
            let far = other.translation.distance(place) > 2.0 * mesh.radius() + CLEARANCE;
            is_free &= far
                || distance(Posed::new(&mesh, pose), Posed::new(&mesh, other), Solid::Surface)?.lower
                    > CLEARANCE;
            if !is_free {
                break;
            }
        }
        if is_free {
            placed.push(motion);
        }
    }
    let mut world = World::new(QueryOptions::default());
    for motion in placed {
        world.add(Body::new(Arc::clone(&mesh), motion));
    }
    Ok(world)
}

/// The whole query against the queries of pairs that no order of search avoids: all whose boxes meet before the first contact.
/// On one thread.
fn unavoidable(rounds: usize, name: &str, fresh: &World, target: Target) -> TaskResult {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let answer = pool.install(|| fresh.clone().first_contact(Window::UNIT))?;
    let FirstContact::Contact { contact, .. } = answer else { return Err(wrong("no contact at all")) };
    let window = Window::try_new(0.0, contact.time_hi)?;
    let pairs = fresh.candidates(window).expect("all motions cover it");
    let options = *fresh.options();
    let search = |&(a, b): &(BodyId, BodyId)| {
        time_of_contact(fresh.body(a).moving(), fresh.body(b).moving(), window, &options)
    };
    let all_pairs = || {
        pairs.iter().try_fold(f64::INFINITY, |least, pair| {
            Ok::<_, Error>(match search(pair)? {
                TimeOfContact::Contact(found) => least.min(found.time_lo),
                _ => least,
            })
        })
    };
    let earliest = all_pairs()?;
    if !(earliest <= contact.time_hi && (earliest - contact.time_lo).abs() < 1e-9) {
        return Err(wrong("brute force finds another first contact"));
    }
    let mut is_answered = true;
    let mut whole = |world: &mut World| is_answered &= world.first_contact(Window::UNIT).is_ok();
    let mut queries = |_: &mut World| _ = black_box(all_pairs());
    let mut broad_phase =
        |world: &mut World| _ = black_box(world.candidates(Window::UNIT).expect("all motions cover it"));
    let times = pool.install(|| {
        least_in_turn(8 * rounds, || fresh.clone(), &mut [&mut whole, &mut queries, &mut broad_phase])
    });
    let &[time, sum, boxes] = times.as_slice() else { return Err(wrong("as many times as works")) };
    if !is_answered {
        return Err(wrong("no answer"));
    }
    let what = format!(
        "first_contact, {name} ({:.2} ms, boxes {:.2} ms of them), over its {} unavoidable pair queries ({:.2} ms)",
        milliseconds(time),
        milliseconds(boxes),
        pairs.len(),
        milliseconds(sum)
    );
    figure(what, time.as_secs_f64() / sum.as_secs_f64(), "times", target);
    let beyond = time.saturating_sub(boxes).as_secs_f64() / sum.as_secs_f64();
    figure("  the same without the boxes", beyond, "times", Target::None);
    Ok(())
}
