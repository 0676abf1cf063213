//! The scenes of the bench.
use d2m::bvh::MeshTree;
use d2m::motion::ConstantTwist;
use d2m_dynamics::{Body, BodyId, Kind, Simulation, SimulationOptions};
use glam::{DQuat, DVec3};
use std::sync::Arc;

type Error = Box<dyn std::error::Error>;

/// Steps a second, as in the paper.
pub(super) const RATE: f64 = 64.0;
/// Half a side of the boxes.
pub(super) const HALF: f64 = 0.5;
/// Friction of the boxes, their density and that of everything else is water's.
pub(super) const FRICTION: f64 = 0.5;

/// What a run must do besides not skipping and not gaining energy.
#[derive(Clone, Copy, Debug)]
pub(super) enum Expectation {
    /// Fall, and stay above the floor at y = 0 by at least this much.
    Above(f64),
    /// Sink along −z and turn.
    Screw,
    /// The last body turns against the first.
    Turned,
    /// All sleep at the end.
    Asleep,
}

/// A simulation and what is known of it.
pub(super) struct Scene {
    pub(super) name: String,
    pub(super) simulation: Simulation,
    /// Dynamic bodies.
    pub(super) ids: Vec<BodyId>,
    pub(super) triangles: usize,
    /// How long it runs before its times count, and after.
    pub(super) before: f64,
    pub(super) seconds: f64,
    pub(super) expectation: Expectation,
}

/// Where `count` bodies start, `pitch` apart in layers that turn, low ones first.
pub(super) fn places(count: usize, pitch: f64) -> Vec<(DVec3, DQuat)> {
    let side = (1..=count).find(|side| side * side * side >= count).unwrap_or(1);
    let place = |k: usize| {
        let layer = (k / (side * side)) as f64;
        let at = |n: usize| (n % side) as f64 - 0.5 * (side - 1) as f64;
        let shift = 0.2 * pitch * (layer % 3.0 - 1.0);
        let place = DVec3::new(at(k) * pitch + shift, (layer + 0.7) * pitch, at(k / side) * pitch - shift);
        (place, DQuat::from_xyzw(0.03 * (k % 5) as f64, 0.05 * (k % 7) as f64, 0.02, 1.0).normalize())
    };
    (0..count).map(place).collect()
}

fn tree(shape: &str) -> Result<Arc<MeshTree>, Error> {
    Ok(Arc::new(MeshTree::new(d2m_shapes::mesh(shape)?)))
}

fn options() -> SimulationOptions {
    SimulationOptions::default().with_step(1.0 / RATE)
}

fn floor(simulation: &mut Simulation) -> Result<(), Error> {
    let floor = Body::new("floor", tree("box?x=100&y=0.5&z=100")?).with_kind(Kind::Static);
    simulation.add(&floor.with_position(DVec3::Y * -0.5).with_friction(FRICTION))?;
    Ok(())
}

impl Scene {
    /// Boxes that fall into a pile.
    pub(super) fn boxes(count: usize) -> Result<Self, Error> {
        let mut simulation = Simulation::new(options())?;
        floor(&mut simulation)?;
        let shape = tree(&format!("box?x={HALF}&y={HALF}&z={HALF}"))?;
        let mut ids = Vec::new();
        for (k, (place, turn)) in places(count, 1.4).into_iter().enumerate() {
            let body = Body::new(format!("box {k}"), Arc::clone(&shape)).with_friction(FRICTION);
            ids.push(simulation.add(&body.with_position(place).with_orientation(turn))?);
        }
        let (name, triangles) = (format!("boxes {count}"), shape.mesh().triangles().len());
        let expectation = Expectation::Above(HALF);
        Ok(Self { name, simulation, ids, triangles, before: 0.0, seconds: 2.0, expectation })
    }

    /// Columns of four boxes that have gone to sleep.
    pub(super) fn sleeping(count: usize) -> Result<Self, Error> {
        let mut simulation = Simulation::new(options())?;
        floor(&mut simulation)?;
        let shape = tree(&format!("box?x={HALF}&y={HALF}&z={HALF}"))?;
        let mut ids = Vec::new();
        for k in 0..count {
            let (column, level) = ((k / 4) as f64, (k % 4) as f64);
            let place = DVec3::new(2.0 * column, 0.501 + 1.001 * level, 0.0);
            let body = Body::new(format!("box {k}"), Arc::clone(&shape)).with_friction(FRICTION);
            ids.push(simulation.add(&body.with_position(place))?);
        }
        let (name, triangles) = (format!("sleeping boxes {count}"), shape.mesh().triangles().len());
        let expectation = Expectation::Asleep;
        Ok(Self { name, simulation, ids, triangles, before: 2.0, seconds: 1.0, expectation })
    }

    /// A screw that turns down through its nut.
    pub(super) fn bolt(triangles: usize) -> Result<Self, Error> {
        let mut simulation = Simulation::new(options().with_gravity(DVec3::Z * -9.81).with_gap(5e-4))?;
        let nut = tree(&format!("nut?triangles={triangles}&clearance=0.03"))?;
        let screw = tree(&format!("screw?triangles={triangles}"))?;
        let triangles = screw.mesh().triangles().len();
        simulation.add(&Body::new("nut", nut).with_kind(Kind::Static))?;
        let ids = vec![simulation.add(&Body::new("screw", screw))?];
        let (name, expectation) = ("bolt".into(), Expectation::Screw);
        Ok(Self { name, simulation, ids, triangles, before: 0.0, seconds: 1.0, expectation })
    }

    /// A gear that is driven turns another on a pin; both lie on a plate, axes upwards along z.
    pub(super) fn gears(triangles: usize) -> Result<Self, Error> {
        let mut simulation = Simulation::new(options().with_gravity(DVec3::Z * -9.81))?;
        let shape = tree(&format!("gear?triangles={triangles}&teeth={TEETH}&depth={DEPTH}"))?;
        let (vertices, tip) = (shape.mesh().vertices(), |v: &DVec3| v.truncate().length());
        let outer = vertices.iter().map(tip).fold(0.0, f64::max);
        let bore = vertices.iter().map(tip).fold(f64::INFINITY, f64::min);
        let low = vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
        let plate = tree("box?x=10&y=10&z=0.5")?;
        let plate = Body::new("plate", plate).with_kind(Kind::Static);
        simulation.add(&plate.with_position(DVec3::Z * (low - 0.502)))?;
        let drive = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
        let driven = Body::new("driven", Arc::clone(&shape));
        simulation.add(&driven.clone().with_kind(Kind::Kinematic(Arc::new(drive))))?;
        // The tips reach nearly to the roots, a gap of teeth opposite to a tooth.
        let apart = DVec3::X * (2.0 - 0.6 * DEPTH) * outer;
        let half_a_tooth = DQuat::from_rotation_z(core::f64::consts::PI / f64::from(TEETH));
        let body =
            Body::new("turned", Arc::clone(&shape)).with_position(apart).with_orientation(half_a_tooth);
        let ids = vec![simulation.add(&body)?];
        let thick = 0.9 * bore;
        let pin = tree(&format!(
            "box?x={r}&y={r}&z={h}",
            r = thick * core::f64::consts::FRAC_1_SQRT_2,
            h = -2.0 * low
        ))?;
        let pin = Body::new("pin", pin).with_kind(Kind::Static).with_position(apart);
        let pin = simulation.add(&pin)?;
        for other in simulation.ids().filter(|&other| other != pin && !ids.contains(&other)) {
            simulation.ignore(pin, other);
        }
        let (name, triangles) = ("gears".into(), shape.mesh().triangles().len());
        let expectation = Expectation::Turned;
        Ok(Self { name, simulation, ids, triangles, before: 0.0, seconds: 2.0, expectation })
    }

    /// Pebbles and knots that fall into a pile.
    pub(super) fn crowd(count: usize, triangles: usize) -> Result<Self, Error> {
        let mut simulation = Simulation::new(options())?;
        floor(&mut simulation)?;
        let shapes = [
            tree(&format!("pebble?triangles={triangles}"))?,
            tree(&format!("torus-knot?triangles={triangles}"))?,
        ];
        let radius = shapes.iter().map(|shape| shape.radius()).fold(0.0, f64::max);
        let mut ids = Vec::new();
        for (k, (place, turn)) in places(count, 2.2 * radius).into_iter().enumerate() {
            let body = Body::new(format!("body {k}"), Arc::clone(&shapes[k % 2])).with_friction(FRICTION);
            ids.push(simulation.add(&body.with_position(place).with_orientation(turn))?);
        }
        let name = format!("pebbles and knots {count}");
        let expectation = Expectation::Above(0.0);
        Ok(Self { name, simulation, ids, triangles, before: 0.0, seconds: 2.0, expectation })
    }
}

/// Teeth of the gears and the depth of a tooth, as parts of the radius.
const TEETH: u32 = 16;
const DEPTH: f64 = 0.15;
