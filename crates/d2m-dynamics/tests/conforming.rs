//! Bodies that fit into each other and turn together, touching all round: pegs in holes, wheels on axles, shells in shells.

mod ground;

use d2m_bvh::{MeshTree, TriMesh};
use d2m_dynamics::{Body, BodyId, Joint, JointKind, Kind, Mass, Simulation, SimulationOptions};
use d2m_motion::ConstantTwist;
use glam::DVec3;
use ground::{counted, run};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A circle of corners about z.
fn circle(corners: u32, radius: f64, z: f64) -> impl Iterator<Item = DVec3> {
    let angle = move |k: u32| TAU * f64::from(k) / f64::from(corners);
    (0..corners).map(move |k| DVec3::new(radius * angle(k).cos(), radius * angle(k).sin(), z))
}

fn tree_of(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap()))
}

/// What lies between two prisms about z over regular polygons; the inner one is a hole.
fn ring(sides: u32, [inner, outer]: [f64; 2], half_length: f64) -> Arc<MeshTree> {
    let ends = [-half_length, half_length];
    let corners = [outer, inner].into_iter().flat_map(|radius| ends.map(|z| (radius, z)));
    let vertices = corners.flat_map(|(radius, z)| circle(sides, radius, z)).collect();
    let mut triangles = Vec::new();
    for i in 0..sides {
        let [j, above, inside, over] = [(i + 1) % sides, sides, 2 * sides, 3 * sides];
        let faces = [
            [i, j, above + j, above + i],
            [inside + j, inside + i, over + i, over + j],
            [above + i, above + j, over + j, over + i],
            [j, i, inside + i, inside + j],
        ];
        triangles.extend(faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]));
    }
    tree_of(vertices, triangles)
}

fn prism(sides: u32, radius: f64, half_length: f64) -> Arc<MeshTree> {
    let vertices = [-half_length, half_length].into_iter().flat_map(|z| circle(sides, radius, z)).collect();
    let caps = (1..sides - 1).flat_map(|i| [[0, i + 1, i], [sides, sides + i, sides + i + 1]]);
    let walls = (0..sides).flat_map(|i| {
        let j = (i + 1) % sides;
        [[i, j, sides + j], [i, sides + j, sides + i]]
    });
    tree_of(vertices, caps.chain(walls).collect())
}

/// A globe of meridians and half as many parallels, hollow from the second radius on inward.
fn globe(meridians: u32, [outer, inner]: [f64; 2]) -> Arc<MeshTree> {
    let parallels = meridians / 2;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for radius in [outer, inner] {
        let first = vertices.len() as u32;
        vertices.push(DVec3::Z * radius);
        for k in 1..parallels {
            let angle = PI * f64::from(k) / f64::from(parallels);
            vertices.extend(circle(meridians, radius * angle.sin(), radius * angle.cos()));
        }
        let last = vertices.len() as u32;
        vertices.push(DVec3::NEG_Z * radius);
        let at = |parallel: u32, meridian: u32| first + 1 + (parallel - 1) * meridians + meridian % meridians;
        for i in 0..meridians {
            let mut faces =
                vec![[first, at(1, i), at(1, i + 1)], [last, at(parallels - 1, i + 1), at(parallels - 1, i)]];
            faces.extend((1..parallels - 1).flat_map(|k| {
                [[at(k, i), at(k + 1, i), at(k + 1, i + 1)], [at(k, i), at(k + 1, i + 1), at(k, i + 1)]]
            }));
            triangles.extend(
                faces.into_iter().map(|[a, b, c]| if radius == outer { [a, b, c] } else { [a, c, b] }),
            );
        }
    }
    tree_of(vertices, triangles)
}

fn simulation(gap: f64) -> Simulation {
    Simulation::new(SimulationOptions::default().with_gap(gap)).unwrap()
}

fn drive(simulation: &mut Simulation, tree: Arc<MeshTree>, spin: DVec3, friction: f64) -> BodyId {
    let motion = Kind::Kinematic(Arc::new(ConstantTwist::REST.with_angular_velocity(spin)));
    simulation.add(&Body::new("drive", tree).with_kind(motion).with_friction(friction)).unwrap()
}

/// A peg without friction in a hole of its own shape that turns about its level axis turns with it, and nothing pushes it along that
/// axis. Were room asked for at each contact as if the other body stood still, it would be thrown out at many times the speed of the hole.
#[test]
fn pegs_stay_in_holes_that_turn() {
    for (sides, rate) in [(3, 20.0), (4, 20.0), (6, 5.0)] {
        let mut simulation = simulation(1e-3);
        drive(&mut simulation, ring(sides, [0.5, 1.5], 0.5), DVec3::Z * rate, 0.0);
        let peg = simulation.add(&Body::new("peg", prism(sides, 0.498, 0.5)).with_friction(0.0)).unwrap();
        assert_eq!(run(&mut simulation, 0.5), 0.0);
        let (place, spin) = (simulation.position(peg), simulation.angular_velocity(peg));
        assert!(place.z.abs() < 0.02 && place.truncate().length() < 0.01, "{sides}, {rate}: at {place}");
        assert!((spin.z - rate).abs() < 0.1 * rate, "{sides}, {rate}: {spin}");
    }
}

/// A peg that slides out of such a hole goes on as it slides, also where most of it is out: what both turn in common bends nothing along
/// their axis, however far from each other their centers lie on it.
#[test]
fn pegs_slide_out_of_holes_that_turn() {
    let (rate, speed) = (20.0, 1.0);
    let mut simulation = simulation(1e-4);
    drive(&mut simulation, ring(6, [1.0, 1.3], 3.0), DVec3::Z * rate, 0.0);
    let peg = Body::new("peg", prism(6, 0.998, 0.4)).with_friction(0.0).with_position(DVec3::NEG_Z * 2.2);
    let peg = peg.with_linear_velocity(DVec3::NEG_Z * speed).with_angular_velocity(DVec3::Z * rate);
    let peg = simulation.add(&peg).unwrap();
    while simulation.time() < 1.2 {
        let next = simulation.time() + 0.01;
        assert_eq!(run(&mut simulation, next), 0.0);
        let slides = simulation.linear_velocity(peg).z;
        assert!((slides + speed).abs() < 0.25 * speed, "{slides} at {}", simulation.time());
    }
    assert!(simulation.position(peg).z < -3.3);
}

/// A prism in a free tube, both of which spin askew to their axis, goes round with the tube, from one side to the other. Each straight flight
/// as long as a step leads into the tube that turns: they end sooner, and no time is given up.
#[test]
fn what_spins_askew_in_a_tube_goes_round_with_it() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(7e-4).with_step(0.03);
    let mut simulation = Simulation::new(options).unwrap();
    let spin = DVec3::new(13.0, 0.0, 15.0);
    let tube = Body::new("tube", ring(6, [1.0, 1.4], 2.2)).with_angular_velocity(spin);
    simulation.add(&tube.with_friction(0.5)).unwrap();
    let place = DVec3::Z * 2.3;
    let prism = Body::new("prism", prism(6, 0.99, 0.37)).with_position(place).with_angular_velocity(spin);
    let prism = prism.with_linear_velocity(spin.cross(place) + DVec3::Z * 3.0).with_friction(0.5);
    simulation.add(&prism.with_mass(Mass::Density(0.4))).unwrap();
    assert_eq!(run(&mut simulation, 0.5), 0.0);
}

/// A bore falls on a pin on which it hangs, and which turns in its joint. Its contacts hold it on all sides and ask for more room than
/// there is: that is not made by throwing the bore off along the axis.
#[test]
fn bores_hang_on_pins_that_turn() {
    let options = SimulationOptions::default().with_gap(4e-5).with_step(1.0 / 60.0);
    let mut simulation = Simulation::new(options).unwrap();
    let bore = simulation.add(&Body::new("bore", ring(32, [1.0, 1.5], 0.5))).unwrap();
    let pin = Body::new("pin", prism(32, 0.99, 0.6)).with_angular_velocity(DVec3::Z * 9.0);
    let pin = simulation.add(&pin).unwrap();
    simulation
        .add_joint(&Joint::new(JointKind::Revolute, pin, None, DVec3::ZERO).with_axis(DVec3::Z))
        .unwrap();
    assert_eq!(run(&mut simulation, 1.0), 0.0);
    let place = simulation.position(bore);
    assert!(place.length() < 0.05, "{place}");
}

/// A wheel that turns with its axle, which touches it all round the bore, meets no events.
#[test]
fn a_wheel_turns_with_its_axle() {
    let mut simulation = simulation(1e-4);
    let rate = 30.0;
    drive(&mut simulation, prism(12, 0.499, 0.5), DVec3::Z * rate, 0.2);
    let wheel = Body::new("wheel", ring(12, [0.5, 0.8], 0.5)).with_angular_velocity(DVec3::Z * rate);
    let wheel = simulation.add(&wheel.with_friction(0.2)).unwrap();
    let run = counted(&mut simulation, 0.5);
    assert_eq!((run.skipped, run.events), (0.0, 0));
    assert!((simulation.angular_velocity(wheel).z - rate).abs() < 0.01 * rate);
}

/// Three shells, each of which can turn in the next one, go on turning. What their accounts of energy do not allow is taken from their
/// velocities, but not the last of the room between them, which they would never get back.
#[test]
fn shells_that_turn_in_each_other_go_on() {
    let mut simulation = simulation(1e-5);
    let meridians = 8;
    // From a sphere through the corners of a shell to one within its faces, with a clearance of a hundredth.
    let within = (PI / f64::from(meridians)).cos().powi(2) * 0.99;
    drive(&mut simulation, globe(meridians, [1.1, 1.0]), DVec3::new(30.0, 9.0, 6.0), 0.3);
    let mut radius = 1.0;
    let shells = [0; 3].map(|_| {
        radius *= within;
        let shell = Body::new("shell", globe(meridians, [radius, 0.9 * radius])).with_friction(0.3);
        radius *= 0.9;
        simulation.add(&shell.with_angular_velocity(DVec3::new(30.0, 0.0, -30.0))).unwrap()
    });
    assert_eq!(run(&mut simulation, 0.6), 0.0);
    for shell in shells {
        assert!(simulation.position(shell).length() < 0.3);
        assert!(simulation.angular_velocity(shell).length() < 60.0);
    }
}
