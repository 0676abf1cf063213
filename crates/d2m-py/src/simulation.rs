//! Simulations.

use crate::arrays::{Doubles, rows, small};
use crate::fault::{Fault, OrRaise, Value};
use crate::mesh::tree_argument;
use crate::motion::motion_argument;
use crate::options::{default_solid, solid};
use crate::pose::{Pose, pose_argument, vec3_or_zero, wxyz};
use crate::segment::Segment;
use crate::supervise::{Watch, pool, supervised};
use d2m_dynamics::{
    Body, BodyId, Kind, Mass, MassError, MassProperties, Segment as Flown, Simulation as Engine,
    SimulationError, SimulationOptions, StepError,
};
use glam::{DMat3, DVec3};
use numpy::PyArray2;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use rayon::ThreadPool;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

impl From<SimulationError> for Fault {
    fn from(error: SimulationError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            SimulationError::BadOption { value, .. } => fault.found(value),
            SimulationError::BadBody { value, .. } => fault.with_value(Value::Text(value)),
            _ => fault,
        }
    }
}

impl From<MassError> for Fault {
    fn from(error: MassError) -> Self {
        Self::new(error.to_string())
    }
}

/// Rigid bodies that never pass through each other, at any speed: every segment of a run is certified.
///
/// `gravity`, shape (3,); `step`: how often forces act; `gap`: the distance that resting bodies keep; `max_events` contact events a
/// step; `sleeping`: islands at rest are left alone; any consistent units. Bodies are named by their index, from 0. The same bits at any number
/// of `threads`.
///
/// Raises `InputError` for settings that are not finite and positive.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
/// >>> one = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", v=[2, 0, 0], restitution=1)
/// >>> two = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", pose=d2m_ccd.Pose(x=[2, 0, 0]), restitution=1)
/// >>> segments = simulation.advance(1.0)
/// >>> (abs(simulation.velocities()[:, 0] - [0, 2]) < 1e-9).tolist()
/// [True, True]
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Simulation {
    inner: Mutex<Inner>,
    pool: Arc<ThreadPool>,
}

struct Inner {
    engine: Engine,
    names: HashMap<String, usize>,
}

impl Inner {
    fn id(&self, index: usize) -> PyResult<BodyId> {
        let id = self.engine.ids().find(|id| id.index() == index);
        id.ok_or_else(|| PyKeyError::new_err(format!("body {index} is not one of {}", self.engine.len())))
    }

    fn find(&self, any: &Bound<'_, PyAny>) -> PyResult<BodyId> {
        let index = match any.extract::<String>() {
            Ok(name) => {
                let index = self.names.get(&name).copied();
                index.ok_or_else(|| PyKeyError::new_err(format!("{name:?} is not in this simulation")))?
            }
            Err(_) => any.extract()?,
        };
        self.id(index)
    }
}

impl Simulation {
    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Inner> {
        self.inner.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

fn finite(any: &Bound<'_, PyAny>, name: &str) -> PyResult<DVec3> {
    Ok(DVec3::from_array(small(any, name)?))
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (*, gravity=None, step=0.01, gap=1e-3, max_events=128, sleeping=true, threads=None))]
    fn new(
        gravity: Option<&Bound<'_, PyAny>>,
        step: f64,
        gap: f64,
        max_events: u32,
        sleeping: bool,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let mut options = SimulationOptions::default()
            .with_step(step)
            .with_gap(gap)
            .with_max_events(max_events)
            .with_sleeping(sleeping);
        if let Some(gravity) = gravity {
            options = options.with_gravity(finite(gravity, "gravity")?);
        }
        let engine = Engine::new(options).or_raise()?;
        let inner = Mutex::new(Inner { engine, names: HashMap::new() });
        Ok(Self { inner, pool: pool(threads).or_raise()? })
    }

    /// Adds a body and returns its index.
    ///
    /// `kind` "dynamic", "static" or "kinematic" (then `motion`, of the mesh frame). `pose` of the mesh frame; `v`, `w`: velocity of
    /// the center of mass and angular velocity; `density` of the closed mesh, or its `mass`, or `mass`, `center` and `inertia` (3, 3)
    /// about it; `restitution` and `friction` of its surface; `solid` by default if the mesh is watertight.
    ///
    /// Raises `InputError` for numbers that cannot be used, a name that is taken, and mass properties that are missing.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Simulation().add("shape:box", name="cup", density=500)
    /// 0
    #[pyo3(signature = (tree, *, name=None, kind="dynamic", pose=None, motion=None, v=None, w=None, density=None, mass=None, center=None, inertia=None, restitution=0.0, friction=0.0, solid=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn add(
        &self,
        py: Python<'_>,
        tree: &Bound<'_, PyAny>,
        name: Option<String>,
        kind: &str,
        pose: Option<&Bound<'_, PyAny>>,
        motion: Option<&Bound<'_, PyAny>>,
        v: Option<&Bound<'_, PyAny>>,
        w: Option<&Bound<'_, PyAny>>,
        density: Option<f64>,
        mass: Option<f64>,
        center: Option<&Bound<'_, PyAny>>,
        inertia: Option<&Bound<'_, PyAny>>,
        restitution: f64,
        friction: f64,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<usize> {
        let tree = tree_argument(tree)?;
        let usual = default_solid(&tree);
        let solid = solid.map_or(Ok(usual), |any| self::solid(any, usual))?;
        let kind = match (kind, motion) {
            ("dynamic", None) => Kind::Dynamic,
            ("static", None) => Kind::Static,
            ("kinematic", Some(motion)) => {
                let motion = motion_argument(Some(motion), "motion")?;
                motion.check_size(&tree).or_raise()?;
                Kind::Kinematic(motion.shared())
            }
            ("kinematic", None) => return Err(Fault::new("motion: a kinematic body needs one").into()),
            ("dynamic" | "static", Some(_)) => {
                return Err(Fault::new(format!("motion: a {kind} body has none")).into());
            }
            _ => {
                let message =
                    format!("kind is {kind:?}: \"dynamic\", \"static\" or \"kinematic\" is expected");
                return Err(Fault::new(message).with_value(Value::Text(kind.to_owned())).into());
            }
        };
        let pose = pose_argument(pose, "pose")?;
        let mass = mass_of(density, mass, center, inertia)?;
        let mut inner = self.lock(py);
        let index = inner.engine.len();
        if let Some(taken) = name.as_ref().filter(|name| inner.names.contains_key(*name)) {
            return Err(Fault::new(format!("name {taken:?} is taken")).into());
        }
        let body = Body::new(name.clone().unwrap_or_else(|| index.to_string()), tree)
            .with_kind(kind)
            .with_position(pose.transform_point(DVec3::ZERO))
            .with_orientation(pose.rotation)
            .with_linear_velocity(vec3_or_zero(v, "v")?)
            .with_angular_velocity(vec3_or_zero(w, "w")?)
            .with_mass(mass)
            .with_restitution(restitution)
            .with_friction(friction)
            .with_solid(solid);
        let index = inner.engine.add(&body).or_raise()?.index();
        if let Some(name) = name {
            inner.names.insert(name, index);
        }
        Ok(index)
    }

    /// Takes a body out; what rested on it is awake. Its index may be given to a body that is added later.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.remove(simulation.add("shape:box", name="cup"))
    /// >>> len(simulation)
    /// 0
    fn remove(&self, py: Python<'_>, body: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.remove(id);
        inner.names.retain(|_, index| *index != id.index());
        Ok(())
    }

    /// Puts the mesh frame of a body that follows no motion somewhere else; its velocities stay.
    ///
    /// Raises `InputError` if it would intersect another one there: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> cup = simulation.add("shape:box")
    /// >>> simulation.set_pose(cup, d2m_ccd.Pose(x=[0, 2, 0]))
    /// >>> simulation.pose(cup).x.tolist()
    /// [0.0, 2.0, 0.0]
    fn set_pose(&self, py: Python<'_>, body: &Bound<'_, PyAny>, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let pose = pose_argument(Some(pose), "pose")?;
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.set_pose(id, pose).or_raise()
    }

    /// Gives a dynamic body these velocities, of its center of mass and angular, world axes.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_velocity(simulation.add("shape:box"), [1, 0, 0])
    #[pyo3(signature = (body, v, w=None))]
    fn set_velocity(
        &self,
        py: Python<'_>,
        body: &Bound<'_, PyAny>,
        v: &Bound<'_, PyAny>,
        w: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (linear, angular) = (finite(v, "v")?, vec3_or_zero(w, "w")?);
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.set_velocity(id, linear, angular).or_raise()
    }

    /// Another gravity from now on.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Simulation().set_gravity([0, -1.62, 0])
    fn set_gravity(&self, py: Python<'_>, gravity: &Bound<'_, PyAny>) -> PyResult<()> {
        let gravity = finite(gravity, "gravity")?;
        self.lock(py).engine.set_gravity(gravity).or_raise()
    }

    /// Restitution and friction of a body from now on.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_material(simulation.add("shape:box"), restitution=0.5, friction=0.2)
    #[pyo3(signature = (body, *, restitution, friction))]
    fn set_material(
        &self,
        py: Python<'_>,
        body: &Bound<'_, PyAny>,
        restitution: f64,
        friction: f64,
    ) -> PyResult<()> {
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.set_material(id, restitution, friction).or_raise()
    }

    /// These two bodies may pass through each other.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.ignore(simulation.add("shape:box"), simulation.add("shape:box"))
    fn ignore(&self, py: Python<'_>, a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut inner = self.lock(py);
        let (a, b) = (inner.find(a)?, inner.find(b)?);
        inner.engine.ignore(a, b);
        Ok(())
    }

    /// Restitution and friction of one pair, instead of what follows from its bodies.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_pair(simulation.add("shape:box"), simulation.add("shape:box"), restitution=0.5, friction=0.2)
    #[pyo3(signature = (a, b, *, restitution, friction))]
    fn set_pair(
        &self,
        py: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        restitution: f64,
        friction: f64,
    ) -> PyResult<()> {
        let mut inner = self.lock(py);
        let (a, b) = (inner.find(a)?, inner.find(b)?);
        inner.engine.set_pair(a, b, restitution, friction).or_raise()
    }

    /// A force through the center of mass and a torque over the next step, world axes; gravity comes on top.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_force(simulation.add("shape:box"), [0, 100, 0])
    #[pyo3(signature = (body, force, torque=None))]
    fn set_force(
        &self,
        py: Python<'_>,
        body: &Bound<'_, PyAny>,
        force: &Bound<'_, PyAny>,
        torque: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (force, torque) = (finite(force, "force")?, vec3_or_zero(torque, "torque")?);
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.set_force(id, force, torque).or_raise()
    }

    /// Adds an impulse at the center of mass and an angular impulse, world axes.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.apply_impulse(simulation.add("shape:box"), [0, 100, 0])
    #[pyo3(signature = (body, impulse, angular=None))]
    fn apply_impulse(
        &self,
        py: Python<'_>,
        body: &Bound<'_, PyAny>,
        impulse: &Bound<'_, PyAny>,
        angular: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (impulse, angular) = (finite(impulse, "impulse")?, vec3_or_zero(angular, "angular")?);
        let mut inner = self.lock(py);
        let id = inner.find(body)?;
        inner.engine.apply_impulse(id, impulse, angular).or_raise()
    }

    /// Advances by steps until this time and returns the segments flown, the last one included.
    ///
    /// `progress`: called with (steps done, steps) some times a second, or a bar with `update(n)`. Ctrl-C ends it between two steps; the
    /// simulation goes on from there.
    ///
    /// Raises `InputError` for bodies that intersect at the start, and `RuntimeError` where kinematic bodies crush a dynamic one.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> segments = simulation.advance(0.1)
    /// >>> simulation.time
    /// 0.1
    #[pyo3(signature = (until, *, progress=None))]
    fn advance(
        &self,
        py: Python<'_>,
        until: f64,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Segment>> {
        if !until.is_finite() {
            return Err(Fault::new(format!("until is {until}, not a finite number")).found(until).into());
        }
        let (inner, pool) = (&self.inner, &self.pool);
        let (time, step) = {
            let inner = self.lock(py);
            (inner.engine.time(), inner.engine.options().step)
        };
        let total = ((until - time) / step).ceil().max(0.0) as usize;
        let flown = supervised(py, &Watch { progress, total }, |supervision| {
            let mut inner = inner.lock().unwrap_or_else(PoisonError::into_inner);
            let engine = &mut inner.engine;
            pool.install(move || -> Result<Vec<Flown>, StepError> {
                let mut flown = Vec::new();
                while engine.time() < until && !supervision.is_cancelled() {
                    // Times of steps are multiples; what is less than a millionth of a step is rounding.
                    let rest = until - engine.time();
                    if rest < 1e-6 * step {
                        break;
                    }
                    let report =
                        if rest < (1.0 - 1e-6) * step { engine.step_to(until)? } else { engine.step()? };
                    flown.extend(report.segments);
                    supervision.add_done(1);
                }
                flown.extend(engine.finish());
                Ok(flown)
            })
        })?;
        match flown {
            Ok(flown) => Ok(flown.into_iter().map(|flown| Segment { flown }).collect()),
            Err(StepError::Setup(error)) => Err(Fault::from(error).into()),
            Err(error) => Err(PyRuntimeError::new_err(error.to_string())),
        }
    }

    /// The present time.
    #[getter]
    fn time(&self, py: Python<'_>) -> f64 {
        self.lock(py).engine.time()
    }

    /// Where the mesh frame of a body is; its reference point is the center of mass.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.pose(simulation.add("shape:box"))
    /// Pose(x=[0.0, 0.0, 0.0], q=[1.0, 0.0, 0.0, 0.0])
    fn pose(&self, py: Python<'_>, body: &Bound<'_, PyAny>) -> PyResult<Pose> {
        let inner = self.lock(py);
        Ok(Pose { pose: inner.engine.pose(inner.find(body)?) })
    }

    /// The poses of all bodies, shape (n, 7): the turn of the mesh frame (w, x, y, z) and the position of the center of mass.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Simulation().poses().shape
    /// (0, 7)
    fn poses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inner = self.lock(py);
        let row = |id: BodyId| {
            let pose = inner.engine.pose(id);
            let ([w, x, y, z], p) = (wxyz(pose.rotation), pose.translation);
            [w, x, y, z, p.x, p.y, p.z]
        };
        let all: Vec<_> = inner.engine.ids().map(row).collect();
        rows(py, all.into_iter())
    }

    /// The velocities of all bodies, shape (n, 6): those of the centers of mass, and angular ones, world axes.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Simulation().velocities().shape
    /// (0, 6)
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inner = self.lock(py);
        let row = |id: BodyId| {
            let (v, w) = (inner.engine.linear_velocity(id), inner.engine.angular_velocity(id));
            [v.x, v.y, v.z, w.x, w.y, w.z]
        };
        let all: Vec<_> = inner.engine.ids().map(row).collect();
        rows(py, all.into_iter())
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.lock(py).engine.len()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let inner = self.lock(py);
        format!("Simulation({} bodies, time={:?})", inner.engine.len(), inner.engine.time())
    }
}

/// What was given of density, mass, center and inertia.
fn mass_of(
    density: Option<f64>,
    mass: Option<f64>,
    center: Option<&Bound<'_, PyAny>>,
    inertia: Option<&Bound<'_, PyAny>>,
) -> PyResult<Mass> {
    match (density, mass, center, inertia) {
        (None, None, None, None) => Ok(Mass::Density(1000.0)),
        (Some(density), None, None, None) => Ok(Mass::Density(density)),
        (None, Some(mass), None, None) => Ok(Mass::Total(mass)),
        (None, Some(mass), Some(center), Some(inertia)) => {
            let numbers = Doubles::new(inertia, "inertia", &[Some(3), Some(3)])?;
            let mut columns = [0.0; 9];
            columns.copy_from_slice(numbers.slice());
            let inertia = DMat3::from_cols_array(&columns).transpose();
            let center = finite(center, "center")?;
            Ok(Mass::Given(MassProperties::try_new(mass, center, inertia).or_raise()?))
        }
        _ => {
            let message = "either density, or mass, or mass with center and inertia";
            Err(Fault::new(message).into())
        }
    }
}
