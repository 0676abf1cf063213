//! What a scene is, and those that show how the cost of a step grows.
use super::bound::Bound;
use d2m::bvh::MeshTree;
use d2m::motion::{AnyMotion, ConstantTwist, Pose};
use d2m_dynamics::{Body, BodyId, Joint, Kind, Simulation, SimulationOptions};
use glam::{DQuat, DVec3};
use std::sync::Arc;

pub(super) type Error = Box<dyn std::error::Error>;

/// Steps a second, as in the paper.
const RATE: f64 = 64.0;
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
    /// The first body turns about z at this rate in the mean of the second half, give or take a twentieth of it: from one hit of its teeth to
    /// the next it turns as it likes.
    Rate(f64),
    /// All end within this distance of where they started.
    Stays(f64),
    /// All end within this distance of the origin.
    Within(f64),
    /// Joints hold, as they must in every scene.
    Held,
}

/// A simulation and what is known of it: all that another engine needs to run the same.
pub(super) struct Scene {
    pub(super) name: String,
    pub(super) simulation: Simulation,
    /// All bodies as they were added, so that the first has the first name.
    pub(super) bodies: Vec<Body>,
    /// The motions of the bodies that follow one, each with the body's place, in a form that files have.
    pub(super) motions: Vec<(usize, AnyMotion)>,
    pub(super) joints: Vec<Joint>,
    /// Dynamic bodies.
    pub(super) ids: Vec<BodyId>,
    pub(super) triangles: usize,
    /// How long it runs before its times count, how long they do, and how long it runs on until it has settled.
    pub(super) before: f64,
    pub(super) seconds: f64,
    pub(super) after: f64,
    pub(super) expectation: Expectation,
    /// Targets.
    pub(super) bounds: Vec<Bound>,
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

pub(super) fn tree(shape: &str) -> Result<Arc<MeshTree>, Error> {
    Ok(Arc::new(MeshTree::new(d2m_shapes::mesh(shape)?)))
}

/// Those of the paper.
pub(super) fn options() -> SimulationOptions {
    SimulationOptions::default().with_step(1.0 / RATE)
}

fn unit_box() -> Result<Arc<MeshTree>, Error> {
    tree(&format!("box?x={HALF}&y={HALF}&z={HALF}"))
}

fn floor() -> Result<Body, Error> {
    let floor = Body::new("floor", tree("box?x=100&y=0.5&z=100")?).with_kind(Kind::Static);
    Ok(floor.with_position(DVec3::Y * -0.5).with_friction(FRICTION))
}

impl Scene {
    /// Without bodies.
    pub(super) fn new(
        name: impl Into<String>,
        options: SimulationOptions,
        seconds: f64,
        expectation: Expectation,
    ) -> Result<Self, Error> {
        Ok(Self {
            name: name.into(),
            simulation: Simulation::new(options)?,
            bodies: Vec::new(),
            motions: Vec::new(),
            joints: Vec::new(),
            ids: Vec::new(),
            triangles: 0,
            before: 0.0,
            seconds,
            after: 0.0,
            expectation,
            bounds: Vec::new(),
        })
    }

    /// With this body; the triangles that are stated are those of the last dynamic one.
    pub(super) fn add(&mut self, body: Body) -> Result<BodyId, Error> {
        let id = self.simulation.add(&body)?;
        if matches!(body.kind, Kind::Dynamic) {
            self.ids.push(id);
            self.triangles = body.tree.mesh().triangles().len();
        }
        self.bodies.push(body);
        Ok(id)
    }

    /// With this body, which follows this motion.
    pub(super) fn drive(&mut self, body: Body, motion: impl Into<AnyMotion>) -> Result<BodyId, Error> {
        let motion = motion.into();
        let id = self.add(body.with_kind(Kind::Kinematic(Arc::new(motion.clone()))))?;
        self.motions.push((id.index(), motion));
        Ok(id)
    }

    /// With this joint.
    pub(super) fn join(&mut self, joint: Joint) -> Result<(), Error> {
        self.simulation.add_joint(&joint)?;
        self.joints.push(joint);
        Ok(())
    }

    /// Where the bodies are now.
    pub(super) fn poses(&self) -> Vec<Pose> {
        self.simulation.ids().map(|id| self.simulation.pose(id)).collect()
    }

    /// Boxes that fall into a pile.
    pub(super) fn boxes(count: usize) -> Result<Self, Error> {
        let mut scene = Self::new(format!("boxes {count}"), options(), 2.0, Expectation::Above(HALF))?;
        scene.add(floor()?)?;
        let shape = unit_box()?;
        for (k, (place, turn)) in places(count, 1.4).into_iter().enumerate() {
            let body = Body::new(format!("box {k}"), Arc::clone(&shape)).with_friction(FRICTION);
            scene.add(body.with_position(place).with_orientation(turn))?;
        }
        Ok(scene)
    }

    /// Columns of so many boxes on the floor, with this clearance between them.
    pub(super) fn columns(mut self, count: usize, levels: usize, clearance: f64) -> Result<Self, Error> {
        self.add(floor()?)?;
        let shape = unit_box()?;
        for k in 0..count {
            let (column, level) = ((k / levels) as f64, (k % levels) as f64);
            let height = HALF + clearance + (2.0 * HALF + clearance) * level;
            let body = Body::new(format!("box {k}"), Arc::clone(&shape)).with_friction(FRICTION);
            self.add(body.with_position(DVec3::new(2.0 * column, height, 0.0)))?;
        }
        Ok(self)
    }

    /// Columns of four boxes that have gone to sleep.
    pub(super) fn sleeping(count: usize) -> Result<Self, Error> {
        let scene = Self::new(format!("sleeping boxes {count}"), options(), 1.0, Expectation::Asleep)?;
        let clearance = scene.simulation.options().gap;
        Ok(Self { before: 2.0, ..scene.columns(count, 4, clearance)? })
    }

    /// A screw that turns down through its nut.
    pub(super) fn bolt(triangles: usize) -> Result<Self, Error> {
        let options = options().with_gravity(DVec3::Z * -9.81).with_gap(5e-4);
        let mut scene = Self::new("bolt", options, 1.0, Expectation::Screw)?;
        let nut = tree(&format!("nut?triangles={triangles}&clearance=0.03"))?;
        scene.add(Body::new("nut", nut).with_kind(Kind::Static))?;
        scene.add(Body::new("screw", tree(&format!("screw?triangles={triangles}"))?))?;
        Ok(scene)
    }

    /// A gear that is driven turns another on a pin; both lie on a plate, axes upwards along z.
    pub(super) fn gears(triangles: usize) -> Result<Self, Error> {
        let options = options().with_gravity(DVec3::Z * -9.81);
        let mut scene = Self::new("gears", options, 2.0, Expectation::Turned)?;
        let shape = tree(&format!("gear?triangles={triangles}&teeth={TEETH}&depth={DEPTH}"))?;
        let (vertices, tip) = (shape.mesh().vertices(), |v: &DVec3| v.truncate().length());
        let outer = vertices.iter().map(tip).fold(0.0, f64::max);
        let bore = vertices.iter().map(tip).fold(f64::INFINITY, f64::min);
        let low = vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
        let plate = tree("box?x=10&y=10&z=0.5")?;
        let plate = Body::new("plate", plate).with_kind(Kind::Static);
        scene.add(plate.with_position(DVec3::Z * (low - 0.502)))?;
        let drive = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
        let driven = Body::new("driven", Arc::clone(&shape));
        scene.drive(driven, drive)?;
        // The tips reach nearly to the roots, a gap of teeth opposite to a tooth.
        let apart = DVec3::X * (2.0 - 0.6 * DEPTH) * outer;
        let half_a_tooth = DQuat::from_rotation_z(core::f64::consts::PI / f64::from(TEETH));
        let body = Body::new("turned", shape).with_position(apart).with_orientation(half_a_tooth);
        let turned = scene.add(body)?;
        let thick = 0.9 * bore;
        let pin = tree(&format!(
            "box?x={r}&y={r}&z={h}",
            r = thick * core::f64::consts::FRAC_1_SQRT_2,
            h = -2.0 * low
        ))?;
        let pin = Body::new("pin", pin).with_kind(Kind::Static).with_position(apart);
        let pin = scene.add(pin)?;
        for other in scene.simulation.ids().filter(|&other| other != pin && other != turned) {
            scene.simulation.ignore(pin, other);
        }
        Ok(scene)
    }

    /// Pebbles and knots that fall into a pile.
    pub(super) fn crowd(count: usize, triangles: usize) -> Result<Self, Error> {
        let name = format!("pebbles and knots {count}");
        let mut scene = Self::new(name, options(), 2.0, Expectation::Above(0.0))?;
        scene.add(floor()?)?;
        let shapes = [
            tree(&format!("pebble?triangles={triangles}"))?,
            tree(&format!("torus-knot?triangles={triangles}"))?,
        ];
        let radius = shapes.iter().map(|shape| shape.radius()).fold(0.0, f64::max);
        for (k, (place, turn)) in places(count, 2.2 * radius).into_iter().enumerate() {
            let body = Body::new(format!("body {k}"), Arc::clone(&shapes[k % 2])).with_friction(FRICTION);
            scene.add(body.with_position(place).with_orientation(turn))?;
        }
        scene.triangles = triangles;
        Ok(scene)
    }
}

/// Teeth of the gears and the depth of a tooth, as parts of the radius.
const TEETH: u32 = 16;
const DEPTH: f64 = 0.15;
