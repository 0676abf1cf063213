//! Joints of simulations, with motors and springs.

use crate::fault::{Fault, OrRaise};
use crate::simulation::{Inner, Simulation, finite, unexpected};
use d2m_dynamics::{Joint, JointKind, Motor as Drive, MotorTarget, Spring as Coil};
use glam::{BVec3, DVec3};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

/// Drives the value of a revolute joint (an angle, by a torque) or of a prismatic one (a length, by a force) of a `Simulation`.
///
/// It aims at a `velocity`, a rate of the value, or at a `position`. `most`: the greatest force or torque, `None` for any; `stiffness`: force by
/// what lacks to the position, 0 for as stiff as need be; `damping`: force by rate, of a motor with a stiffness.
///
/// Raises `InputError` unless one of velocity and position is given.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> wheel = simulation.add("shape:box")
/// >>> hinge = simulation.add_joint("revolute", wheel, motor=d2m_ccd.Motor(velocity=3.0))
/// >>> segments = simulation.advance(0.01)
/// >>> simulation.velocities()[wheel].round(6).tolist()[3:]
/// [0.0, 0.0, -3.0]
#[pyclass(frozen, from_py_object, module = "d2m_ccd")]
#[derive(Clone, Copy)]
pub(crate) struct Motor {
    motor: Drive,
}

#[pymethods]
impl Motor {
    #[new]
    #[pyo3(signature = (*, velocity=None, position=None, most=None, stiffness=0.0, damping=0.0))]
    fn new(
        velocity: Option<f64>,
        position: Option<f64>,
        most: Option<f64>,
        stiffness: f64,
        damping: f64,
    ) -> PyResult<Self> {
        let target = match (velocity, position) {
            (Some(velocity), None) => MotorTarget::Velocity(velocity),
            (None, Some(position)) => MotorTarget::Position(position),
            _ => return Err(Fault::new("a motor has either velocity or position").into()),
        };
        let mut motor = Drive::new(target);
        if let Some(most) = most {
            motor.most = most;
        }
        (motor.stiffness, motor.damping) = (stiffness, damping);
        Ok(Self { motor })
    }

    /// The rate that it aims at, if it does.
    #[getter]
    fn velocity(&self) -> Option<f64> {
        match self.motor.target {
            MotorTarget::Velocity(velocity) => Some(velocity),
            _ => None,
        }
    }

    /// The value that it aims at, if it does.
    #[getter]
    fn position(&self) -> Option<f64> {
        match self.motor.target {
            MotorTarget::Position(position) => Some(position),
            _ => None,
        }
    }

    /// The greatest force or torque; `None`: any.
    #[getter]
    fn most(&self) -> Option<f64> {
        Some(self.motor.most).filter(|most| *most < f64::INFINITY)
    }

    /// Force by what lacks to the position; 0: as stiff as need be.
    #[getter]
    fn stiffness(&self) -> f64 {
        self.motor.stiffness
    }

    /// Force by rate, of a motor with a stiffness.
    #[getter]
    fn damping(&self) -> f64 {
        self.motor.damping
    }

    fn __repr__(&self) -> String {
        let (name, aim) = match (self.velocity(), self.position()) {
            (Some(velocity), _) => ("velocity", velocity),
            (_, position) => ("position", position.unwrap_or_default()),
        };
        let most = self.most().map_or_else(|| "None".to_owned(), |most| format!("{most:?}"));
        let Drive { stiffness, damping, .. } = self.motor;
        format!("Motor({name}={aim:?}, most={most}, stiffness={stiffness:?}, damping={damping:?})")
    }
}

/// A spring at a joint's value: the force, or torque, is stiffness (rest - value) - damping rate. Stable for any stiffness.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> load = simulation.add("shape:box", mass=8.0)
/// >>> guide = simulation.add_joint("prismatic", load, axis=[0, 1, 0], spring=d2m_ccd.Spring(800.0, 80.0))
/// >>> segments = simulation.advance(5.0)
/// >>> abs(abs(simulation.joint_value(guide)) - 8 * 9.81 / 800) < 1e-4
/// True
#[pyclass(frozen, from_py_object, module = "d2m_ccd")]
#[derive(Clone, Copy)]
pub(crate) struct Spring {
    spring: Coil,
}

#[pymethods]
impl Spring {
    #[new]
    #[pyo3(signature = (stiffness, damping=0.0, rest=0.0))]
    fn new(stiffness: f64, damping: f64, rest: f64) -> Self {
        Self { spring: Coil::new(stiffness, damping, rest) }
    }

    /// Force by length, or torque by angle.
    #[getter]
    fn stiffness(&self) -> f64 {
        self.spring.stiffness
    }

    /// Force by rate.
    #[getter]
    fn damping(&self) -> f64 {
        self.spring.damping
    }

    /// The value at which it is slack.
    #[getter]
    fn rest(&self) -> f64 {
        self.spring.rest
    }

    fn __repr__(&self) -> String {
        let Coil { stiffness, damping, rest, .. } = self.spring;
        format!("Spring({stiffness:?}, {damping:?}, {rest:?})")
    }
}

fn bits(bits: [bool; 3]) -> BVec3 {
    BVec3::from_array(bits)
}

fn kind_of(kind: &str, ways: Option<[bool; 3]>, turns: Option<[bool; 3]>) -> PyResult<JointKind> {
    let free = match kind {
        "fixed" => JointKind::Fixed,
        "revolute" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "spherical" => JointKind::Spherical,
        "locked" => {
            let [ways, turns] = [ways, turns].map(|axes| bits(axes.unwrap_or_default()));
            return Ok(JointKind::Locked { ways, turns });
        }
        _ => {
            let wanted = "\"fixed\", \"revolute\", \"prismatic\", \"spherical\" or \"locked\"";
            return Err(unexpected("kind", kind, wanted));
        }
    };
    if ways.is_some() || turns.is_some() {
        return Err(Fault::new(format!("ways, turns: a {kind} joint has none, only a locked one")).into());
    }
    Ok(free)
}

/// The number of a joint that is there.
fn there(inner: &Inner, joint: usize) -> PyResult<usize> {
    let there = inner.engine.joint(joint).map(|_| joint);
    there.ok_or_else(|| PyKeyError::new_err(format!("joint {joint} is not in this simulation")))
}

#[pymethods]
impl Simulation {
    /// Joins two bodies, or one with the world, where they are, and returns the number of the joint.
    ///
    /// `kind`: "fixed"; "revolute", which turns about `axis` through `point`; "prismatic", which moves along `axis`; "spherical", which turns
    /// about `point`; "locked", of a body and the world: `ways` of its center of mass along the axes of the world, and `turns` about them, three
    /// truths each, that it may not go. `point` (by default the origin) and `axis` (by default z) in the world. Of revolute and prismatic ones
    /// `limits`: the least and the greatest value; `motor`; `spring`; `friction`: the greatest force or torque of dry friction. The value, an
    /// angle or a length, is 0 where the joint is added. The two bodies pass through each other unless they `collide`.
    ///
    /// Raises `InputError` for numbers that cannot be used, and where no body could move: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> door = simulation.add("shape:box?x=0.5&y=0.05&z=0.05")
    /// >>> hinge = simulation.add_joint("revolute", door, point=[-0.5, 0, 0], limits=(-0.5, 0.5))
    /// >>> segments = simulation.advance(1.0)
    /// >>> round(abs(simulation.joint_value(hinge)), 2)  # it has fallen to its limit
    /// 0.5
    #[pyo3(signature = (kind, a, b=None, *, point=None, axis=None, limits=None, motor=None, spring=None, friction=0.0, collide=false, ways=None, turns=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn add_joint(
        &self,
        kind: &str,
        a: &Bound<'_, PyAny>,
        b: Option<&Bound<'_, PyAny>>,
        point: Option<&Bound<'_, PyAny>>,
        axis: Option<&Bound<'_, PyAny>>,
        limits: Option<(f64, f64)>,
        motor: Option<Motor>,
        spring: Option<Spring>,
        friction: f64,
        collide: bool,
        ways: Option<[bool; 3]>,
        turns: Option<[bool; 3]>,
    ) -> PyResult<usize> {
        let kind = kind_of(kind, ways, turns)?;
        let point = point.map_or(Ok(DVec3::ZERO), |point| finite(point, "point"))?;
        let mut inner = self.lock(a.py());
        let b = b.map(|b| inner.find(b)).transpose()?;
        let mut joint =
            Joint::new(kind, inner.find(a)?, b, point).with_friction(friction).with_collide(collide);
        if let Some(axis) = axis {
            joint = joint.with_axis(finite(axis, "axis")?);
        }
        joint.limits = limits.map(|(lo, hi)| [lo, hi]);
        joint.motor = motor.map(|motor| motor.motor);
        joint.spring = spring.map(|spring| spring.spring);
        inner.engine.add_joint(&joint).or_raise()
    }

    /// Takes a joint out; its number never means another one. Its bodies go on passing through each other where they did: `heed` has them
    /// meet again.
    ///
    /// Raises `KeyError` if there is no such joint, or it was taken out.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> lamp = simulation.add("shape:box")
    /// >>> nail = simulation.add_joint("spherical", lamp, point=[0, 1, 0])
    /// >>> segments = simulation.advance(0.1)
    /// >>> hung = simulation.pose(lamp).x[1]
    /// >>> simulation.remove_joint(nail)
    /// >>> segments = simulation.advance(0.2)
    /// >>> bool(abs(hung) < 1e-9), bool(simulation.pose(lamp).x[1] < -0.01)
    /// (True, True)
    fn remove_joint(&self, py: Python<'_>, joint: usize) -> PyResult<()> {
        let mut inner = self.lock(py);
        let joint = there(&inner, joint)?;
        inner.engine.remove_joint(joint);
        Ok(())
    }

    /// The value of a joint: how far b has turned about the axis, or moved along it, against a; 0 of other kinds. `b` is the world where only
    /// one body was given.
    ///
    /// Raises `KeyError` if there is no such joint, or it was taken out.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.joint_value(simulation.add_joint("revolute", simulation.add("shape:box")))
    /// 0.0
    fn joint_value(&self, py: Python<'_>, joint: usize) -> PyResult<f64> {
        let inner = self.lock(py);
        Ok(inner.engine.joint_value(there(&inner, joint)?))
    }

    /// Another motor of a joint, or none: so a robot is driven from step to step. Its bodies are awake.
    ///
    /// Raises `InputError` for numbers that cannot be used, `KeyError` if there is no such joint.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
    /// >>> slide = simulation.add("shape:box", mass=8.0)
    /// >>> rail = simulation.add_joint("prismatic", slide, axis=[1, 0, 0])
    /// >>> simulation.set_motor(rail, d2m_ccd.Motor(velocity=100.0, most=4.0))
    /// >>> segments = simulation.advance(1.0)
    /// >>> abs(simulation.velocities()[slide, 0]).round(6)  # half a metre per square second
    /// np.float64(0.5)
    #[pyo3(signature = (joint, motor))]
    fn set_motor(&self, py: Python<'_>, joint: usize, motor: Option<Motor>) -> PyResult<()> {
        let mut inner = self.lock(py);
        let joint = there(&inner, joint)?;
        inner.engine.set_motor(joint, motor.map(|motor| motor.motor)).or_raise()
    }
}
