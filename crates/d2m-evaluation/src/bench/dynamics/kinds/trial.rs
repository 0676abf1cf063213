//! A scene with what must happen in it.
use super::super::scene::{Error, Expectation, Scene};
use super::law::Law;
use d2m::bvh::MeshTree;
use d2m_dynamics::{Body, Kind, MotorTarget, SimulationOptions};
use glam::DVec3;
use std::sync::Arc;

pub(super) struct Trial {
    pub(super) scene: Scene,
    pub(super) laws: Vec<Law>,
    /// Must it end because there is no room?
    pub(super) is_crushing: bool,
}

impl Trial {
    /// Works something in it, so that energy may grow?
    pub(super) fn is_driven(&self) -> bool {
        let moves = |motor: &MotorTarget| !matches!(motor, MotorTarget::Velocity(rate) if *rate == 0.0);
        !self.scene.motions.is_empty()
            || self.scene.joints.iter().any(|joint| joint.motor.is_some_and(|motor| moves(&motor.target)))
    }
}

/// A kind's scene, to be built when its turn comes.
pub(super) struct Case {
    pub(super) kind: &'static str,
    pub(super) name: String,
    pub(super) build: Box<dyn Fn(Scene) -> Result<Trial, Error> + Sync>,
    /// What a scene begins with: how long it lasts.
    pub(super) seconds: f64,
    pub(super) options: SimulationOptions,
}

impl Case {
    /// Of so many seconds, with the settings of most scenes.
    pub(super) fn new(
        kind: &'static str,
        variant: impl core::fmt::Display,
        seconds: f64,
        build: impl Fn(Scene) -> Result<Trial, Error> + Sync + 'static,
    ) -> Self {
        let name = format!("{kind} {variant}");
        Self { kind, name, build: Box::new(build), seconds, options: SimulationOptions::default() }
    }

    pub(super) fn with_options(self, options: SimulationOptions) -> Self {
        Self { options, ..self }
    }

    /// Without gravity.
    pub(super) fn weightless(self) -> Self {
        let options = self.options.with_gravity(DVec3::ZERO);
        self.with_options(options)
    }

    pub(super) fn trial(&self) -> Result<Trial, Error> {
        let scene = Scene::new(self.name.clone(), self.options, self.seconds, Expectation::Held)?;
        (self.build)(scene)
    }
}

/// The scene, with these laws: without any it would always go right.
pub(super) fn under(scene: Scene, laws: Vec<Law>) -> Result<Trial, Error> {
    if laws.is_empty() {
        return Err(format!("{}: the scene has no law to be judged by", scene.name).into());
    }
    Ok(Trial { scene, laws, is_crushing: false })
}

/// The scene, which must end so.
pub(super) fn crushing(scene: Scene, law: Law) -> Trial {
    Trial { scene, laws: vec![law], is_crushing: true }
}

/// What gravity and the gap are in nearly all scenes.
pub(super) const GRAVITY: f64 = 9.81;
pub(super) const GAP: f64 = SimulationOptions::DEFAULT.gap;

/// A floor whose top is at this height.
pub(super) fn floor(height: f64, friction: f64) -> Result<Body, Error> {
    let shape = super::solids::cuboid(DVec3::new(30.0, 0.5, 30.0))?;
    Ok(still("floor", &shape, friction).with_position(DVec3::Y * (height - 0.5)))
}

/// A body that stands still.
pub(super) fn still(name: impl Into<String>, shape: &Arc<MeshTree>, friction: f64) -> Body {
    Body::new(name, Arc::clone(shape)).with_kind(Kind::Static).with_friction(friction)
}

/// A body that moves freely.
pub(super) fn free(name: impl Into<String>, shape: &Arc<MeshTree>, friction: f64) -> Body {
    Body::new(name, Arc::clone(shape)).with_friction(friction)
}
