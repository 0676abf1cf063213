//! Contacts that are solved, not iterated: masses far apart, tall stacks, friction that locks, hits that keep their energy, starts that touch.

use d2m_bvh::{MeshTree, Posed, Solid, TriMesh, distance};
use d2m_dynamics::{Body, BodyId, Kind, Mass, Simulation, SimulationOptions};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::sync::Arc;

fn tree(shape: &str) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()))
}

fn cube() -> Arc<MeshTree> {
    tree("box?x=0.5&y=0.5&z=0.5")
}

fn floor() -> Body {
    let shape = tree("box?x=10&y=0.5&z=10");
    Body::new("floor", shape).with_kind(Kind::Static).with_position(DVec3::Y * -0.5).with_friction(0.5)
}

fn body(name: usize, tree: &Arc<MeshTree>, y: f64) -> Body {
    Body::new(name.to_string(), Arc::clone(tree)).with_position(DVec3::Y * y).with_friction(0.5)
}

fn awake() -> Simulation {
    Simulation::new(SimulationOptions::default().with_sleeping(false)).unwrap()
}

/// What a run has given up, the largest residual, and the contact events.
struct Ran {
    skipped: f64,
    residual: f64,
    events: u32,
}

fn run(simulation: &mut Simulation, end: f64) -> Ran {
    let mut ran = Ran { skipped: 0.0, residual: 0.0, events: 0 };
    while simulation.time() < end - 1e-9 {
        let report = simulation.step().unwrap();
        ran.skipped += report.segments.iter().map(|segment| segment.skipped).sum::<f64>();
        ran.residual = ran.residual.max(report.residual);
        ran.events += report.events;
    }
    ran
}

fn speed(simulation: &Simulation) -> f64 {
    let of = |id: BodyId| simulation.linear_velocity(id).length() + simulation.angular_velocity(id).length();
    simulation.ids().map(of).fold(0.0, f64::max)
}

/// Boxes 10⁴, 10⁶ and 10⁸ times as heavy as what they stand on, off its middle.
#[test]
fn heavy_boxes_rest_on_light_ones() {
    for ratio in [1e4, 1e6, 1e8] {
        let mut simulation = awake();
        let shape = cube();
        simulation.add(&floor()).unwrap();
        simulation.add(&body(0, &shape, 0.501).with_mass(Mass::Total(1.0))).unwrap();
        let heavy = body(1, &shape, 1.502).with_mass(Mass::Total(ratio));
        let heavy = simulation.add(&heavy.with_position(DVec3::new(0.1, 1.502, 0.05))).unwrap();
        let ran = run(&mut simulation, 1.0);
        assert_eq!((ran.skipped, ran.events), (0.0, 0), "{ratio}");
        assert!(speed(&simulation) < 1e-5, "{ratio}: {}", speed(&simulation));
        assert!((simulation.position(heavy).y - 1.502).abs() < 1e-6, "{ratio}");
    }
}

/// A column of cubes, each `apart` from the one below, of which one is `ratio` times as heavy as the others; off the middle, and turned, by some.
fn unlike(gap: f64, heavy: usize, ratio: f64, apart: &[f64], state: &mut u64) -> Simulation {
    let options = SimulationOptions::default().with_sleeping(false).with_gap(gap);
    let mut simulation = Simulation::new(options).unwrap();
    let shape = cube();
    simulation.add(&floor().with_friction(0.0)).unwrap();
    let mut draw = || {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut height = 0.5;
    for (k, apart) in apart.iter().enumerate() {
        height += apart;
        let place = DVec3::new(0.1 * draw(), height, 0.1 * draw());
        let mass = Mass::Total(if k == heavy { ratio } else { 1.0 });
        let body = body(k, &shape, 0.0).with_friction(0.0).with_mass(mass).with_position(place);
        simulation.add(&body.with_orientation(DQuat::from_rotation_y(draw()))).unwrap();
        height += 1.0;
    }
    simulation
}

/// Cubes under one 10⁸ times as heavy, without friction: what is left of a solution tilts it, and it leans on light ones with a thousand times their
/// weight for a millionth of a degree. They were driven out at hundreds of metres a second.
#[test]
fn light_boxes_under_a_heavy_one_are_not_thrown() {
    let state = &mut 5;
    for (count, heavy) in [(6, 5), (6, 3), (10, 9), (5, 4), (6, 5), (6, 3)] {
        let mut simulation = unlike(1e-3, heavy, 1e8, &vec![1e-3; count], state);
        let ran = run(&mut simulation, 0.5);
        assert_eq!(ran.skipped, 0.0);
        assert!(speed(&simulation) < 0.05, "{count} {heavy}: {}", speed(&simulation));
    }
}

/// Of cubes under one 10⁶ times as heavy some touch, and part to the gap, and some keep a hundred-thousandth of it: what solutions leave of the lift
/// is less than these have. Where it was not, nothing parted, until hardly anything was left and time was given up.
#[test]
fn stacks_of_which_some_touch_part_to_the_gap() {
    let scenes = [[0, 3], [2, 5], [5, 6], [1, 4], [3, 5]]
        .into_iter()
        .flat_map(|touching| [3, 4, 5].map(|seed| (touching, seed)));
    for (touching, mut seed) in scenes {
        let mut apart = [1e-9; 8];
        for k in touching {
            apart[k] = 0.0;
        }
        let mut simulation = unlike(1e-2, 7, 1e6, &apart, &mut seed);
        let height = |simulation: &Simulation| simulation.position(simulation.ids().last().unwrap()).y - 7.5;
        assert_eq!(run(&mut simulation, 0.3).skipped, 0.0, "{touching:?}");
        assert!((height(&simulation) - 0.02).abs() < 1e-3, "{touching:?}: {}", height(&simulation));
    }
}

/// Tiles in two layers on a slope that friction just holds, with masses to 10⁷, of which the last one hangs over and tips off. What the direct solution left
/// as it did was swept from nothing: bodies a million times as heavy as what they lie on were borne by nothing for single steps, and slid.
#[test]
fn what_tips_off_leaves_its_neighbors_where_they_are() {
    let slope = 26.0_f64.to_radians();
    let options =
        SimulationOptions::default().with_gravity(9.81 * DVec3::new(slope.sin(), -slope.cos(), 0.0));
    let shape = tree("box?x=0.5&y=0.1&z=0.3");
    // Of the lower layer, then of the upper one.
    for masses in [
        &[44.91, 5.274, 592.1, 3.0, 2.921, 647.3, 5823000.0, 527.1][..],
        &[8.721, 855100.0, 222000.0, 61.02, 2938.0, 3.0, 36400.0, 331900.0, 4.54, 1.579, 5785000.0, 317.8][..],
        &[46.32, 6451.0, 388.8, 16880.0, 23990.0, 3.0, 1.236, 728300.0, 65.38, 43.68, 6862000.0, 947.0][..],
        &[357600.0, 567100.0, 2485.0, 67.82, 1.007, 3.0, 1958.0, 208000.0, 409.4, 246000.0, 5368000.0, 820.4]
            [..],
    ] {
        let mut simulation = Simulation::new(options).unwrap();
        simulation.add(&floor().with_friction(0.5)).unwrap();
        let (count, mut tiles) = (masses.len() / 2, Vec::new());
        for (k, mass) in masses.iter().enumerate() {
            let layer = (k / count) as f64;
            let place = DVec3::new(1.05 * (k % count) as f64 + 0.525 * layer, 0.101 + 0.201 * layer, 0.0);
            let tile = body(k, &shape, 0.0).with_friction(0.5).with_mass(Mass::Total(*mass));
            tiles.push((simulation.add(&tile.with_position(place)).unwrap(), place));
        }
        assert_eq!(run(&mut simulation, 0.8).skipped, 0.0);
        let off = |(id, place): &(BodyId, DVec3)| (simulation.position(*id) - *place).length();
        let (last, others) = tiles.split_last().unwrap();
        let most = others.iter().map(off).fold(0.0, f64::max);
        assert!(most < 1e-5 && off(last) > 0.1, "{masses:?}: {most} {}", off(last));
    }
}

/// The same of a wall of 35 tiles with masses to 10⁶, on which two boxes slide down, among others that rest: what heavy ones sink in on soft rows was
/// taken for sliding, and one was carried along by 18 cm.
#[test]
fn what_slides_over_a_wall_leaves_it_where_it_is() {
    let slope = 26.0_f64.to_radians();
    let options =
        SimulationOptions::default().with_gravity(9.81 * DVec3::new(slope.sin(), -slope.cos(), 0.0));
    let mut simulation = Simulation::new(options).unwrap();
    simulation.add(&floor().with_position(DVec3::new(6.0, -0.5, 0.0)).with_friction(0.5)).unwrap();
    let boxes = [0.5, 0.2].map(|x| tree(&format!("box?x={x}&y=0.1&z={}", if x < 0.3 { 0.2 } else { 0.3 })));
    let mut add = |shape: usize, [x, y, z]: [f64; 3], mass: f64, friction: f64, speed: f64| {
        let body = body(0, &boxes[shape], 0.0).with_mass(Mass::Total(mass)).with_friction(friction);
        let moving = body.with_linear_velocity(DVec3::X * speed);
        simulation.add(&moving.with_position(DVec3::new(x, y, z))).unwrap()
    };
    let mut tiles = Vec::new();
    for (layer, masses) in [
        &[26.78, 1842.0, 165.9, 4203.0, 5680.0, 2.473, 1.2, 105900.0, 35.99, 25.47, 941600.0, 663.1][..],
        &[104400.0, 721.3, 6830.0, 8.011, 6444.0, 161500.0, 1377.0, 28020.0, 10680.0, 2.422, 35430.0][..],
        &[3520.0, 64.21, 1.535, 156000.0, 686.3, 20560.0, 187400.0, 19270.0, 336200.0, 234.3, 63890.0, 465.3]
            [..],
    ]
    .iter()
    .enumerate()
    {
        for (k, mass) in masses.iter().enumerate() {
            let odd = if layer == 1 { 0.525 } else { 0.0 };
            let place = [1.05 * k as f64 + odd, 0.101 + 0.201 * layer as f64, 0.0];
            tiles.push((add(0, place, *mass, 0.5, 0.0), DVec3::from_array(place)));
        }
    }
    let slider = |k: usize| [0.1 + 2.1 * k as f64, 0.704, 0.0];
    let sliders = [410_700.0, 187_600.0].iter().enumerate();
    let sliders: Vec<BodyId> = sliders.map(|(k, mass)| add(1, slider(k), *mass, 0.3, 4.0)).collect();
    for k in 0..30 {
        add(1, [0.45 * f64::from(k), 0.101, 3.0], 1.0, 0.6, 0.0);
    }
    assert_eq!(run(&mut simulation, 0.15).skipped, 0.0);
    // The last one of the third layer hangs over.
    let off = |(id, place): &(BodyId, DVec3)| (simulation.position(*id) - *place).length();
    let most = tiles[..34].iter().map(off).fold(0.0, f64::max);
    // Of crowds 16 times a thousandth of the mean speed may be left, up to 0.016 m/s: 2.4 mm in that time.
    assert!(most < 2.4e-3, "{most}");
    assert!(sliders.iter().all(|id| simulation.position(*id).x > 0.6));
}

/// Thirty boxes on each other neither move nor gain energy; the residual says how exactly that is solved.
#[test]
fn a_stack_of_thirty_stands() {
    let mut simulation = awake();
    let shape = cube();
    simulation.add(&floor()).unwrap();
    let ids: Vec<BodyId> =
        (0..30).map(|k| simulation.add(&body(k, &shape, 0.501 + 1.001 * k as f64)).unwrap()).collect();
    let ran = run(&mut simulation, 1.0);
    assert_eq!(ran.skipped, 0.0);
    // A hundred-thousandth of a gap a step is a micrometer a second.
    assert!(ran.residual <= 1e-6, "{}", ran.residual);
    assert!(speed(&simulation) < 1e-6, "{}", speed(&simulation));
    for (k, &id) in ids.iter().enumerate() {
        let place = simulation.position(id) - DVec3::Y * (0.501 + 1.001 * k as f64);
        assert!(place.length() < 1e-7, "{k}: {place}");
    }
}

/// A prism whose sides lean by 0.12 to the vertical, narrow below (or above).
fn wedge(sign: f64) -> Arc<MeshTree> {
    let half = |y: f64| 0.3 + 0.12 * y * sign;
    let mut vertices = Vec::new();
    for z in [-0.5, 0.5] {
        for (x, y) in [(-half(-0.5), -0.5), (half(-0.5), -0.5), (half(0.5), 0.5), (-half(0.5), 0.5)] {
            vertices.push(DVec3::new(x, y, z));
        }
    }
    let mut triangles = vec![[0, 3, 2], [0, 2, 1], [4, 5, 6], [4, 6, 7]];
    for i in 0..4u32 {
        let j = (i + 1) % 4;
        triangles.extend([[i, j, j + 4], [i, j + 4, i + 4]]);
    }
    Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap()))
}

/// A stone that is wider below than the jaws on both sides of it are apart above, at an angle of 0.12 with a coefficient of friction of
/// 0.3: it could fall out, or be held by normal forces as large as friction needs. What can stick sticks: it comes up with the jaws.
#[test]
fn a_stone_that_only_friction_holds_is_held() {
    let mut simulation = awake();
    let stone = Body::new("stone", wedge(-1.0)).with_friction(0.3).with_position(DVec3::Y * 2.0);
    let stone = simulation.add(&stone).unwrap();
    // A gap along the normals.
    let x = 0.6 + 1e-3 * (1.0f64 + 0.12 * 0.12).sqrt();
    for side in [-1.0, 1.0] {
        let up = ConstantTwist::REST
            .with_position(DVec3::new(x * side, 2.0, 0.0))
            .with_linear_velocity(DVec3::Y * 0.2);
        let jaw = Body::new(format!("jaw {side}"), wedge(1.0)).with_friction(0.3);
        simulation.add(&jaw.with_kind(Kind::Kinematic(Arc::new(up)))).unwrap();
    }
    let start = simulation.position(stone).y;
    assert_eq!(run(&mut simulation, 0.1).skipped, 0.0);
    let risen = simulation.position(stone).y - start;
    // It would have fallen by 0.05; what restores the gap may lift it by a millionth of that gap above the jaws.
    assert!(risen > 0.01 && risen <= 0.02 + 1e-6 * 1e-3, "{risen}");
}

/// Slides at the rate of its friction: what sticks first is let go where it cannot.
#[test]
fn a_box_slides_to_a_stop() {
    let mut simulation = awake();
    simulation.add(&floor()).unwrap();
    let id = simulation.add(&body(0, &cube(), 0.501).with_linear_velocity(DVec3::X * 2.0)).unwrap();
    assert_eq!(run(&mut simulation, 0.3).skipped, 0.0);
    let expected = 2.0 * 0.3 - 0.5 * 0.5 * 9.81 * 0.09;
    assert!((simulation.position(id).x - expected).abs() < 2e-3, "{}", simulation.position(id).x);
    run(&mut simulation, 1.0);
    assert!(speed(&simulation) < 1e-6);
}

/// A ball of triangles between two walls, more than a hundred times: hits off its middle make it spin, but the energy is that of the
/// start to 1e-9.
#[test]
fn elastic_hits_keep_their_energy() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(1e-5);
    let mut simulation = Simulation::new(options).unwrap();
    for x in [-0.61, 0.61] {
        let wall = Body::new(format!("wall {x}"), cube()).with_kind(Kind::Static);
        simulation.add(&wall.with_position(DVec3::X * x)).unwrap();
    }
    let ball = Body::new("ball", tree("icosphere?triangles=320&scale=0.1")).with_restitution(1.0);
    let ball = simulation.add(&ball.with_linear_velocity(DVec3::X * 50.0)).unwrap();
    let ran = run(&mut simulation, 0.12);
    assert!(ran.events > 100, "{}", ran.events);
    let properties = simulation.mass_properties(ball).unwrap();
    let spin = simulation.orientation(ball).conjugate() * simulation.angular_velocity(ball);
    let energy = properties.mass * simulation.linear_velocity(ball).length_squared()
        + spin.dot(properties.inertia * spin);
    assert!((energy / (properties.mass * 2500.0) - 1.0).abs() < 1e-9, "{energy}");
}

/// One in, one out, and the energy with it.
#[test]
fn a_cradle_passes_on_one() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
    let mut simulation = Simulation::new(options).unwrap();
    let shape = cube();
    let ids: Vec<BodyId> = (0..5)
        .map(|k| {
            let x = if k == 0 { -0.5 } else { 1.002 * k as f64 };
            let v = if k == 0 { DVec3::X } else { DVec3::ZERO };
            let one = Body::new(k.to_string(), Arc::clone(&shape)).with_restitution(1.0);
            simulation.add(&one.with_position(DVec3::X * x).with_linear_velocity(v)).unwrap()
        })
        .collect();
    run(&mut simulation, 1.0);
    for (k, &id) in ids.iter().enumerate() {
        let expected = if k == 4 { 1.0 } else { 0.0 };
        assert!((simulation.linear_velocity(id).x - expected).abs() < 1e-6, "{k}");
    }
}

/// What a wall and a body a million times as heavy throw to and fro turns that back: three thousand hits, nearly all in one step.
#[test]
fn light_boxes_turn_back_heavy_ones() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(1e-4);
    let mut simulation = Simulation::new(options).unwrap();
    let shape = cube();
    simulation.add(&Body::new("wall", Arc::clone(&shape)).with_kind(Kind::Static)).unwrap();
    let mut one = |name: &str, mass: f64, x: f64, v: f64| {
        let body = Body::new(name, Arc::clone(&shape)).with_mass(Mass::Total(mass)).with_restitution(1.0);
        let body = body.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
        simulation.add(&body).unwrap()
    };
    let (light, heavy) = (one("light", 1.0, 1.5, 0.0), one("heavy", 1e6, 2.7, -1.0));
    let ran = run(&mut simulation, 1.0);
    assert_eq!(ran.skipped, 0.0);
    assert!(ran.events > 3000, "{}", ran.events);
    let [v, w] = [light, heavy].map(|id| simulation.linear_velocity(id).x);
    assert!(w > 0.999 && ((w * w + 1e-6 * v * v) - 1.0).abs() < 1e-9, "{v} {w}");
}

/// Boxes that touch are accepted, and part to the gap; so do those that are nearer than queries resolve.
#[test]
fn boxes_that_touch_part_to_the_gap() {
    for near in [0.0, 1e-12] {
        let mut simulation = awake();
        let shape = cube();
        simulation.add(&floor()).unwrap();
        let height = |k: usize| 0.5 + near + (1.0 + near) * k as f64;
        let ids: Vec<BodyId> = (0..4).map(|k| simulation.add(&body(k, &shape, height(k))).unwrap()).collect();
        assert_eq!(run(&mut simulation, 0.5).skipped, 0.0);
        for (k, &id) in ids.iter().enumerate() {
            let expected = 0.5 + k as f64 + 1e-3 * (k + 1) as f64;
            let y = simulation.position(id).y;
            assert!((y - expected).abs() < 2e-4 * (k + 1) as f64, "{k}: {y} {expected}");
        }
        assert!(speed(&simulation) < 1e-3, "{}", speed(&simulation));
    }
}

/// Also where the gap is wide: what they are parted by first is a part of their size, and not of the gap. A box on a fifth as large a one, turned against it.
#[test]
fn boxes_that_touch_part_to_a_wide_gap() {
    let gap = 0.01;
    for lifted in [gap, 0.5 * gap, 0.0] {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gap(gap)).unwrap();
        simulation.add(&floor()).unwrap();
        let small = tree("box?x=0.1&y=0.1&z=0.1");
        let below = simulation.add(&body(0, &small, 0.1 + lifted)).unwrap();
        let turned = body(1, &cube(), 0.7 + lifted).with_orientation(DQuat::from_rotation_y(0.4));
        let above = simulation.add(&turned).unwrap();
        assert_eq!(run(&mut simulation, 1.0).skipped, 0.0, "{lifted}");
        let y = simulation.position(above).y - simulation.position(below).y;
        assert!((y - 0.6 - gap).abs() < 0.2 * gap, "{lifted}: {y}");
    }
}

/// Those that start closer than the gap stay where they are.
#[test]
fn boxes_that_start_a_billionth_apart_rest() {
    let mut simulation = awake();
    let shape = cube();
    simulation.add(&floor()).unwrap();
    for k in 0..3 {
        simulation.add(&body(k, &shape, 0.5 + 1e-9 + (1.0 + 1e-9) * k as f64)).unwrap();
    }
    let ran = run(&mut simulation, 1.0);
    assert_eq!((ran.skipped, ran.events), (0.0, 0));
    assert!(speed(&simulation) < 1e-6);
}

/// What no friction brakes goes on, however slow; what friction holds sleeps.
#[test]
fn slow_boxes_without_friction_stay_awake() {
    for (friction, sleeps) in [(0.0, false), (1.0, true)] {
        let options = SimulationOptions::default().with_gravity(DVec3::new(1e-4, -9.81, 0.0));
        let mut simulation = Simulation::new(options).unwrap();
        simulation.add(&floor().with_friction(friction)).unwrap();
        let shape = tree("box?x=0.2&y=0.2&z=0.2");
        let id = simulation.add(&body(0, &shape, 0.201).with_friction(friction)).unwrap();
        run(&mut simulation, 4.0);
        assert_eq!(simulation.is_asleep(id), sleeps);
        let expected = if sleeps { 0.0 } else { 0.5 * 1e-4 * 16.0 };
        assert!((simulation.position(id).x - expected).abs() < 2e-5, "{}", simulation.position(id).x);
    }
}

/// A brick that nothing meets, at three hundred radians a second about no axis of its own.
#[test]
fn fast_tops_keep_their_energy() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let top = Body::new("top", tree("box?x=0.3&y=0.5&z=0.2"));
    let id = simulation.add(&top.with_angular_velocity(DVec3::new(100.0, 250.0, 130.0))).unwrap();
    let properties = simulation.mass_properties(id).unwrap();
    let start = DVec3::new(100.0, 250.0, 130.0);
    let energy = start.dot(properties.inertia * start);
    let mut worst = 0.0f64;
    while simulation.time() < 1.0 {
        for segment in simulation.step().unwrap().segments {
            for (_, flight) in &segment.changed {
                let spin = flight.orientation().conjugate() * flight.angular_velocity();
                worst = worst.max((spin.dot(properties.inertia * spin) / energy - 1.0).abs());
            }
        }
    }
    assert!(worst < 1e-3, "{worst}");
}

/// Sixty rings that fall into each other until they hang: what a solution leaves at each of them adds up along the chain, and the last one would come
/// up again by what is restored. Each pair keeps what it has at the start.
#[test]
fn a_long_chain_keeps_its_distances() {
    let mut simulation = awake();
    let ring = tree("torus?triangles=192&tube=0.2&scale=0.2");
    let inner = ring.mesh().vertices().iter().map(|p| p.truncate().length()).fold(f64::INFINITY, f64::min);
    let pitch = 2.0 * inner - 1e-3 - 0.1 * (0.2 - inner);
    let turn = |k: usize| DQuat::from_rotation_y(0.5 * core::f64::consts::PI * (k % 2) as f64);
    let ids: Vec<BodyId> = (0..60)
        .map(|k| {
            let one = body(k, &ring, -pitch * k as f64).with_orientation(turn(k));
            let one = if k == 0 { one.with_kind(Kind::Static) } else { one };
            simulation.add(&one).unwrap()
        })
        .collect();
    let least = |simulation: &Simulation| {
        let apart = |pair: &[BodyId]| {
            let [a, b] = [pair[0], pair[1]].map(|id| Posed::new(&ring, simulation.pose(id)));
            distance(a, b, Solid::Filled).unwrap().lower
        };
        ids.windows(2).map(apart).fold(f64::INFINITY, f64::min)
    };
    let start = least(&simulation);
    while simulation.time() < 0.12 {
        let end = simulation.time() + 0.01;
        assert_eq!(run(&mut simulation, end).skipped, 0.0);
        let now = least(&simulation);
        assert!(now > 0.95 * start, "{now} {start} at {}", simulation.time());
    }
}

/// A heap is the same at one and at two threads, to the bit.
#[test]
fn heaps_have_the_same_bits_at_any_number_of_threads() {
    let run_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut simulation = awake();
            simulation.add(&floor()).unwrap();
            let shape = tree("box?x=0.2&y=0.1&z=0.15");
            for k in 0..24 {
                let place =
                    DVec3::new(0.45 * (k % 3) as f64, 0.3 + 0.35 * (k / 3) as f64, 0.02 * (k % 5) as f64);
                simulation.add(&body(k, &shape, 0.0).with_position(place)).unwrap();
            }
            run(&mut simulation, 0.4);
            simulation.snapshot()
        })
    };
    assert_eq!(run_on(1), run_on(2));
}

/// Three boxes that turn far in a step and bounce off each other: contacts of which hardly any room is left get enough for what turns and slips there. With
/// no more than a gap in a step each of their flights ended at half of what there was, and at rounding they stood still in the air for ever.
#[test]
fn what_turns_as_it_meets_stays_in_flight() {
    let mut state = 3u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut vector = move || DVec3::new(random(), random(), random());
    let shape = tree("box?x=0.3&y=0.1&z=0.2");
    for trial in 0..48 {
        let (restitution, friction) = [(0.5, 0.0), (0.3, 0.4), (1.0, 0.0), (0.8, 0.3)][trial % 4];
        let step = [0.1, 0.1, 0.1, 0.25][trial % 4];
        let mut simulation = Simulation::new(SimulationOptions::default().with_step(step)).unwrap();
        simulation.add(&floor().with_friction(friction).with_restitution(restitution)).unwrap();
        for k in 0..3 {
            let (v, place) = (vector(), vector() * 0.1);
            let thrown = body(k, &shape, 0.0)
                .with_position(DVec3::new(place.x, 0.5 + 0.8 * k as f64, place.z))
                .with_orientation(DQuat::from_xyzw(v.x, v.y, v.z, place.y * 10.0).normalize())
                .with_angular_velocity(vector() * 4.0)
                .with_friction(friction)
                .with_restitution(restitution);
            simulation.add(&thrown).unwrap();
        }
        assert_eq!(run(&mut simulation, 4.0).skipped, 0.0, "{trial}");
    }
}

/// More boxes than a crowd has, poured on each other: swept, with what is expected of a few solved nearby. Nothing is given up, nothing
/// meets at the end, hardly anything is left for events, and the bits are the same at one and at two threads.
#[test]
fn crowds_are_poured_and_nothing_meets() {
    let run_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut simulation = Simulation::new(SimulationOptions::default().with_step(1.0 / 64.0)).unwrap();
            simulation.add(&floor()).unwrap();
            let shape = tree("box?x=0.25&y=0.35&z=0.2");
            for k in 0..72 {
                let at = DVec3::new((k % 3) as f64, (k / 9) as f64, (k / 3 % 3) as f64);
                let turn = DQuat::from_xyzw(0.3 * (k % 5) as f64, 0.2 * (k % 7) as f64, 0.1 * at.x, 1.0);
                let place = DVec3::new(0.95, 1.0, 0.95) * at + DVec3::new(0.03 * at.y, 0.7, 0.02 * at.y);
                let one = body(k, &shape, 0.0).with_position(place).with_orientation(turn.normalize());
                simulation.add(&one).unwrap();
            }
            let ran = run(&mut simulation, 1.25);
            assert_eq!(ran.skipped, 0.0);
            assert!(ran.events <= 40 && ran.residual < 0.2, "{} {}", ran.events, ran.residual);
            simulation
        })
    };
    let simulation = run_on(1);
    assert_eq!(simulation.snapshot(), run_on(2).snapshot());
    let box_of = tree("box?x=0.25&y=0.35&z=0.2");
    let ids: Vec<BodyId> = simulation.ids().skip(1).collect();
    for (k, &a) in ids.iter().enumerate() {
        assert!(simulation.position(a).y > 0.2);
        for &b in
            ids[k + 1..].iter().filter(|&&b| simulation.position(a).distance(simulation.position(b)) < 1.0)
        {
            let [a, b] = [a, b].map(|id| Posed::new(&box_of, simulation.pose(id)));
            assert!(distance(a, b, Solid::Filled).unwrap().lower > 0.0);
        }
    }
}
