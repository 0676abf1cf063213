//! Simulations.

use crate::arrays::{Doubles, rows, small};
use crate::fault::{Fault, OrRaise, Value};

use crate::motion::motion_argument;
use crate::options::body_argument;
use crate::pose::{Pose, pose_argument, vec3_or_zero, wxyz};
use crate::segment::{Segment, TouchEvent};
use crate::supervise::{Watch, pool, supervised};
use d2m_dynamics::{
    Body, BodyId, Damping, Groups, Kind, Mass, MassError, MassProperties, Presence, Segment as Flown,
    Simulation as Engine, SimulationError, SimulationOptions, StepError, TouchEvent as Touched,
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
            SimulationError::BadBody { value, .. }
            | SimulationError::BadJoint { value, .. }
            | SimulationError::BadPair { value, .. } => fault.with_value(Value::Text(value)),
            SimulationError::TooLarge { value, .. }
            | SimulationError::VelocityWithoutMotion { value, .. } => {
                fault.with_value(Value::Numbers(value.to_array().to_vec()))
            }
            SimulationError::TargetTooFast { turn, .. } => fault.found(turn),
            SimulationError::Snapshot { place } => fault.at(place),
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

/// What changes.
pub(crate) struct Inner {
    pub(crate) engine: Engine,
    pub(crate) names: HashMap<String, usize>,
    /// Of the last advance; of none after a state was restored.
    pub(crate) touches: Vec<Touched>,
}

impl Inner {
    pub(crate) fn find(&self, any: &Bound<'_, PyAny>) -> PyResult<BodyId> {
        find(any, &self.names, self.engine.ids())
    }
}

/// The body of a simulation that an index or a name means.
pub(crate) fn find(
    any: &Bound<'_, PyAny>,
    names: &HashMap<String, usize>,
    ids: impl Iterator<Item = BodyId>,
) -> PyResult<BodyId> {
    let index = match any.extract::<String>() {
        Ok(name) => {
            let index = names.get(&name).copied();
            index.ok_or_else(|| PyKeyError::new_err(format!("{name:?} is not in this simulation")))?
        }
        Err(_) => any.extract()?,
    };
    let mut count = 0;
    let id = ids.inspect(|_| count += 1).find(|id| id.index() == index);
    id.ok_or_else(|| PyKeyError::new_err(format!("body {index} is not one of {count}")))
}

impl Simulation {
    pub(crate) fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Inner> {
        self.inner.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes something of one body.
    pub(crate) fn change(
        &self,
        body: &Bound<'_, PyAny>,
        change: impl FnOnce(&mut Engine, BodyId) -> Result<(), SimulationError>,
    ) -> PyResult<()> {
        let mut inner = self.lock(body.py());
        let id = inner.find(body)?;
        change(&mut inner.engine, id).or_raise()
    }

    /// Changes something of two bodies.
    pub(crate) fn change_pair(
        &self,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        change: impl FnOnce(&mut Engine, BodyId, BodyId) -> Result<(), SimulationError>,
    ) -> PyResult<()> {
        let mut inner = self.lock(a.py());
        let (a, b) = (inner.find(a)?, inner.find(b)?);
        change(&mut inner.engine, a, b).or_raise()
    }
}

/// Three finite numbers.
pub(crate) fn finite(any: &Bound<'_, PyAny>, name: &str) -> PyResult<DVec3> {
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
        let inner = Mutex::new(Inner { engine, names: HashMap::new(), touches: Vec::new() });
        Ok(Self { inner, pool: pool(threads).or_raise()? })
    }

    /// Adds a body and returns its index. That it intersects no other one is checked by the next step, or at once if `checked`.
    ///
    /// `kind` "dynamic", "static", "kinematic" (then `motion`, of the mesh frame) or "driven" (by `set_target`). `pose` of the mesh frame; `v`,
    /// `w`: velocity of the center of mass and angular velocity; `density` of the closed mesh, or its `mass`, or `mass`, `center` and `inertia`
    /// (3, 3) about it; `restitution` and `friction` of its surface; `solid` by default if the mesh is watertight; `radius`: everything within
    /// that distance. `linear_damping`, `angular_damping`: rates at which velocities fade; `groups`: bits of the groups that it is in, and of
    /// those that it meets (all); `presence` "solid" or "sensor", which others pass through; `surface_velocity`: of a belt, mesh axes.
    ///
    /// Raises `InputError` for numbers that cannot be used, a name that is taken, mass properties that are missing, and, if `checked`, an
    /// intersection: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.add("shape:box", name="cup", density=500)
    /// 0
    /// >>> simulation.add("shape:box", checked=True)  # doctest: +ELLIPSIS
    /// Traceback (most recent call last):
    ///     ...
    /// d2m_ccd._errors.InputError: bodies cup and 1 intersect at the start: ...
    #[pyo3(signature = (tree, *, name=None, kind="dynamic", pose=None, motion=None, v=None, w=None, density=None, mass=None, center=None, inertia=None, restitution=0.0, friction=0.0, solid=None, radius=0.0, linear_damping=0.0, angular_damping=0.0, groups=None, presence="solid", surface_velocity=None, checked=false))]
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
        radius: f64,
        linear_damping: f64,
        angular_damping: f64,
        groups: Option<(u32, u32)>,
        presence: &str,
        surface_velocity: Option<&Bound<'_, PyAny>>,
        checked: bool,
    ) -> PyResult<usize> {
        let (tree, solid) = body_argument(tree, solid)?;
        let kind = kind_argument(kind, motion, tree.mesh().size())?;
        let pose = pose_argument(pose, "pose")?;
        let mass = mass_of(density, mass, center, inertia)?;
        let mut inner = self.lock(py);
        if let Some(taken) = name.as_ref().filter(|name| inner.names.contains_key(*name)) {
            return Err(Fault::new(format!("name {taken:?} is taken")).into());
        }
        let body = Body::new(name.clone().unwrap_or_else(|| inner.engine.next_index().to_string()), tree)
            .with_kind(kind)
            .with_position(pose.transform_point(DVec3::ZERO))
            .with_orientation(pose.rotation)
            .with_linear_velocity(vec3_or_zero(v, "v")?)
            .with_angular_velocity(vec3_or_zero(w, "w")?)
            .with_mass(mass)
            .with_restitution(restitution)
            .with_friction(friction)
            .with_solid(solid)
            .with_radius(radius)
            .with_damping(Damping { linear: linear_damping, angular: angular_damping })
            .with_groups(groups.map_or(Groups::ALL, |(member, meets)| Groups { member, meets }))
            .with_presence(presence_argument(presence)?)
            .with_surface_velocity(vec3_or_zero(surface_velocity, "surface_velocity")?);
        let engine = &mut inner.engine;
        let id = if checked { engine.add_checked(&body) } else { engine.add(&body) };
        let index = id.or_raise()?.index();
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
            let Inner { engine, touches, .. } = &mut *inner;
            touches.clear();
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
                    touches.extend(report.touches);
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

    /// Who began to touch in the last `advance`, and who did so no more: `TouchEvent`s in the order of time. Sensors are among them. After
    /// `restore` there are none, until the next `advance`.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> floor = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", kind="static")
    /// >>> cup = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", pose=d2m_ccd.Pose(x=[0, 1.1, 0]))
    /// >>> segments = simulation.advance(0.3)
    /// >>> [(event.a, event.b, event.change) for event in simulation.touches], simulation.touch(floor, cup)
    /// ([(0, 1, 'began')], True)
    #[getter]
    fn touches(&self, py: Python<'_>) -> Vec<TouchEvent> {
        self.lock(py).touches.iter().map(|&event| TouchEvent { event }).collect()
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

/// A kind by its word, with the motion of a kinematic body of this size.
pub(crate) fn kind_argument(kind: &str, motion: Option<&Bound<'_, PyAny>>, size: f64) -> PyResult<Kind> {
    match (kind, motion) {
        ("dynamic", None) => Ok(Kind::Dynamic),
        ("static", None) => Ok(Kind::Static),
        ("driven", None) => Ok(Kind::Driven),
        ("kinematic", Some(motion)) => {
            let motion = motion_argument(Some(motion), "motion")?;
            motion.check_for(size).or_raise()?;
            Ok(Kind::Kinematic(motion.shared()))
        }
        ("kinematic", None) => Err(Fault::new("motion: a kinematic body needs one").into()),
        ("dynamic" | "static" | "driven", Some(_)) => {
            Err(Fault::new(format!("motion: a {kind} body has none")).into())
        }
        _ => Err(unexpected("kind", kind, "\"dynamic\", \"static\", \"kinematic\" or \"driven\"")),
    }
}

fn presence_argument(presence: &str) -> PyResult<Presence> {
    match presence {
        "solid" => Ok(Presence::Solid),
        "sensor" => Ok(Presence::Sensor),
        _ => Err(unexpected("presence", presence, "\"solid\" or \"sensor\"")),
    }
}

/// A word that is none of those that an argument takes.
pub(crate) fn unexpected(name: &str, word: &str, wanted: &str) -> PyErr {
    let message = format!("{name} is {word:?}: {wanted} is expected");
    Fault::new(message).with_value(Value::Text(word.to_owned())).into()
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
