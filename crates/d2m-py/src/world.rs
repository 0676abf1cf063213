//! Many moving bodies.

use crate::answer;
use crate::fault::{Fault, OrRaise, Value};

use crate::motion::motion_argument;
use crate::options::{QueryKeywords, body_argument, window};
use crate::resting::proximity_array;
use crate::supervise::{Supervision, Watch, pool, supervised};
use crate::world_answer::{BodyId, FirstContact, PairContact};
use d2m::{Body, Group, PlannedMotion, ProximityOptions, TimeOfContact};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use rayon::ThreadPool;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Many moving bodies: a broad phase over what they sweep, and certified queries for what is left.
///
/// Keywords as of `time_of_contact`, for every pair; a budget is one for each query of the world. What is proven of a pair is kept
/// until one of its bodies changes. Answers have the same bits at any number of `threads`. Methods may be called from several
/// threads; one at a time runs. Bodies are named by the `BodyId` that `add` returns, or by their own names.
///
/// Raises `InputError` for numbers that cannot be used, `KeyError` for bodies that are not there.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> world = d2m_ccd.World(min_separation=1e-3)
/// >>> wall = world.add(box, name="wall")
/// >>> ball = world.add(box, {"x": [9, 0, 0], "v": [-16, 0, 0]}, name="ball")
/// >>> first = world.first_contact()
/// >>> first.a.name, first.b.name, first.contact.time_lo < 0.5
/// ('wall', 'ball', True)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct World {
    number: u64,
    inner: Mutex<Inner>,
    pool: Arc<ThreadPool>,
}

struct Inner {
    world: d2m::World,
    names: HashMap<String, d2m::BodyId>,
    given: HashMap<d2m::BodyId, String>,
}

impl World {
    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Inner> {
        self.inner.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }

    /// Of a [`BodyId`] or a name.
    fn find(&self, inner: &Inner, any: &Bound<'_, PyAny>) -> PyResult<d2m::BodyId> {
        let found = if let Ok(id) = any.cast::<BodyId>() {
            let id = id.get();
            (id.world == self.number).then_some(id.id)
        } else {
            let name: String = any.extract()?;
            inner.names.get(&name).copied()
        };
        let there = found.filter(|id| inner.world.get(*id).is_some());
        there.ok_or_else(|| {
            PyKeyError::new_err(format!(
                "{} is not in this world",
                any.repr().map_or_else(|_| String::new(), |text| text.to_string())
            ))
        })
    }

    fn name(&self, inner: &Inner, id: d2m::BodyId) -> BodyId {
        BodyId { world: self.number, id, name: inner.given.get(&id).cloned() }
    }

    /// Runs a query of the world on its pool.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        ask: impl FnOnce(&mut d2m::World, &Supervision) -> Result<T, Fault> + Send,
    ) -> PyResult<T> {
        let watch = Watch { progress, total: 0 };
        let (inner, pool) = (&self.inner, &self.pool);
        supervised(py, &watch, |supervision| {
            let mut inner = inner.lock().unwrap_or_else(PoisonError::into_inner);
            let world = &mut inner.world;
            let usual = *world.options();
            world.set_budget(supervision.cancels(&usual).budget);
            let answer = pool.install(|| ask(world, supervision));
            world.set_budget(usual.budget);
            answer
        })?
        .or_raise()
    }

    fn pair(&self, py: Python<'_>, found: &d2m::PairContact) -> PyResult<PairContact> {
        let inner = self.lock(py);
        let [a, b] = [found.a, found.b].map(|id| self.name(&inner, id));
        Ok(PairContact { a, b, answer: answer::object(py, found.answer)?.unbind() })
    }

    fn first(&self, py: Python<'_>, found: d2m::FirstContact) -> PyResult<FirstContact> {
        let named = |id: d2m::BodyId| Some(self.name(&self.lock(py), id));
        Ok(match found {
            d2m::FirstContact::Contact { a, b, contact, overlapping, .. } => FirstContact {
                status: "contact",
                a: named(a),
                b: named(b),
                contact: Some(answer::object(py, TimeOfContact::Contact(contact))?.unbind()),
                overlapping: overlapping
                    .iter()
                    .map(|pair| Py::new(py, self.pair(py, pair)?))
                    .collect::<PyResult<_>>()?,
                clear_until: contact.time_lo,
            },
            d2m::FirstContact::Undecided { clear_until, a, b, .. } => FirstContact {
                status: "undecided",
                a: named(a),
                b: named(b),
                contact: None,
                overlapping: Vec::new(),
                clear_until,
            },
            d2m::FirstContact::Separated => FirstContact {
                status: "separated",
                a: None,
                b: None,
                contact: None,
                overlapping: Vec::new(),
                clear_until: f64::INFINITY,
            },
        })
    }
}

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (*, tolerance=None, min_separation=0.0, start="report", mode="accurate", node_tests=None, time_limit=None, threads=None))]
    fn new(
        tolerance: Option<f64>,
        min_separation: f64,
        start: &str,
        mode: &str,
        node_tests: Option<u64>,
        time_limit: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let options =
            QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit }.options()?;
        let world = d2m::World::new(options);
        let inner = Inner { world, names: HashMap::new(), given: HashMap::new() };
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        Ok(Self { number, inner: Mutex::new(inner), pool: pool(threads).or_raise()? })
    }

    /// Adds a body: a tree (or what `Tree` takes), its motion, a name that no other body has, the number of a group, the
    /// radius about its mesh that belongs to it, and whether it is solid (by default if its mesh is watertight).
    ///
    /// Raises `InputError` for a name that is taken.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.World().add("shape:box", group=3)
    /// BodyId(0)
    #[pyo3(signature = (tree, motion=None, *, name=None, group=None, radius=0.0, solid=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn add(
        &self,
        py: Python<'_>,
        tree: &Bound<'_, PyAny>,
        motion: Option<&Bound<'_, PyAny>>,
        name: Option<String>,
        group: Option<u32>,
        radius: f64,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<BodyId> {
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(Fault::new(format!("radius is {radius:?}, a number from 0 on is expected"))
                .found(radius)
                .into());
        }
        let (tree, solid) = body_argument(tree, solid)?;
        let motion = motion_argument(motion, "motion")?;
        motion.check_size(&tree).or_raise()?;
        let mut body = Body::with_shared(tree, motion.shared()).with_solid(solid).with_radius(radius);
        if let Some(group) = group {
            body = body.with_group(Group(group));
        }
        let mut inner = self.lock(py);
        if let Some(taken) = name.as_ref().filter(|name| inner.names.contains_key(*name)) {
            let fault = Fault::new(format!("name {taken:?} is taken"));
            return Err(fault.with_value(Value::Text(taken.clone())).into());
        }
        let id = inner.world.add(body);
        if let Some(name) = name {
            inner.names.insert(name.clone(), id);
            inner.given.insert(id, name);
        }
        Ok(self.name(&inner, id))
    }

    /// Takes a body out. Its id never means another body; its name may be given again.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> world.remove(world.add("shape:box"))
    /// >>> len(world)
    /// 0
    fn remove(&self, py: Python<'_>, body: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut inner = self.lock(py);
        let id = self.find(&inner, body)?;
        inner.world.remove(id);
        if let Some(name) = inner.given.remove(&id) {
            inner.names.remove(&name);
        }
        Ok(())
    }

    /// Gives a body another motion, which must hold from the start of the next query's window on.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> world.set_motion(world.add("shape:box"), {"v": [1, 0, 0]})
    fn set_motion(
        &self,
        py: Python<'_>,
        body: &Bound<'_, PyAny>,
        motion: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let motion = motion_argument(motion, "motion")?;
        let mut inner = self.lock(py);
        let id = self.find(&inner, body)?;
        motion.check_size(inner.world.body(id).tree()).or_raise()?;
        inner.world.set_shared_motion(id, motion.shared());
        Ok(())
    }

    /// Whether contacts of two bodies are ignored.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> a, b = world.add("shape:box"), world.add("shape:box")
    /// >>> world.ignore_pair(a, b)
    /// >>> world.first_contact().status
    /// 'separated'
    #[pyo3(signature = (a, b, ignored=true))]
    fn ignore_pair(
        &self,
        py: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        ignored: bool,
    ) -> PyResult<()> {
        let mut inner = self.lock(py);
        let (a, b) = (self.find(&inner, a)?, self.find(&inner, b)?);
        inner.world.ignore_pair(a, b, ignored);
        Ok(())
    }

    /// Whether contacts between bodies of two groups (numbers, which may be the same) are ignored.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> ids = [world.add("shape:box", group=1), world.add("shape:box", group=2)]
    /// >>> world.ignore_groups(1, 2)
    /// >>> world.first_contact().status
    /// 'separated'
    #[pyo3(signature = (a, b, ignored=true))]
    fn ignore_groups(&self, py: Python<'_>, a: u32, b: u32, ignored: bool) {
        self.lock(py).world.ignore_groups(Group(a), Group(b), ignored);
    }

    /// The separation at which these two bodies count as in contact; `None` for that of the world again.
    ///
    /// Raises `InputError` for a separation that is negative or not finite.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> world.set_min_separation(world.add("shape:box"), world.add("shape:box", {"x": [9, 0, 0]}), 8.0)
    /// >>> world.first_contact().status
    /// 'contact'
    #[pyo3(signature = (a, b, separation))]
    fn set_min_separation(
        &self,
        py: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        separation: Option<f64>,
    ) -> PyResult<()> {
        if let Some(value) = separation.filter(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(Fault::from(d2m::QueryError::BadMinSeparation { value }).into());
        }
        let mut inner = self.lock(py);
        let (a, b) = (self.find(&inner, a)?, self.find(&inner, b)?);
        inner.world.set_min_separation(a, b, separation);
        Ok(())
    }

    /// What counts of these two bodies if they are in contact at the start of a window, "report" or "leave"; `None` for what the world says.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> table, part = world.add("shape:box"), world.add("shape:box", {"x": [0, 0, 1], "v": [0, 0, 9]})
    /// >>> world.set_start(table, part, "leave")
    /// >>> world.first_contact().status
    /// 'separated'
    #[pyo3(signature = (a, b, start))]
    fn set_start(
        &self,
        py: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        start: Option<&str>,
    ) -> PyResult<()> {
        let start = start.map(crate::options::start).transpose()?;
        let mut inner = self.lock(py);
        let (a, b) = (self.find(&inner, a)?, self.find(&inner, b)?);
        inner.world.set_start(a, b, start);
        Ok(())
    }

    /// All bodies, in the order of their places.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> body = world.add("shape:box")
    /// >>> world.bodies() == [body]
    /// True
    fn bodies(&self, py: Python<'_>) -> Vec<BodyId> {
        let inner = self.lock(py);
        inner.world.ids().map(|id| self.name(&inner, id)).collect()
    }

    /// The first contact of any two bodies in the window.
    ///
    /// Raises `InputError` for bad input of a pair, whose indices are the error's `index`; `KeyboardInterrupt` on Ctrl-C.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.World().first_contact((0.0, 2.0)).status
    /// 'separated'
    #[pyo3(signature = (window=(0.0, 1.0), *, progress=None))]
    fn first_contact(
        &self,
        py: Python<'_>,
        window: (f64, f64),
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<FirstContact> {
        let window = self::window(window)?;
        let found = self.ask(py, progress, |world, supervision| {
            Ok(world.first_contact_with_progress(window, &|done, _| supervision.set_done(done))?)
        })?;
        self.first(py, found)
    }

    /// The first contact of every pair that meets in the window or is undecided, a list of `PairContact` by time.
    ///
    /// Raises as `first_contact`.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.World().contacts()
    /// []
    #[pyo3(signature = (window=(0.0, 1.0), *, progress=None))]
    fn contacts(
        &self,
        py: Python<'_>,
        window: (f64, f64),
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<PairContact>> {
        let window = self::window(window)?;
        let found = self.ask(py, progress, |world, supervision| {
            Ok(world.contacts_with_progress(window, &|done, _| supervision.set_done(done))?)
        })?;
        found.iter().map(|pair| self.pair(py, pair)).collect()
    }

    /// If these bodies moved so, and all others as they do: would one of these touch anything, and when first?
    ///
    /// `plan`: a dictionary, or pairs, of bodies and motions. The world stays as it is.
    ///
    /// Raises as `first_contact`.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> tool, table = world.add("shape:box"), world.add("shape:box", {"x": [9, 0, 0]})
    /// >>> world.first_contact_of({tool: {"v": [9, 0, 0]}}).status, world.first_contact_of({tool: {"v": [0, 9, 0]}}).status
    /// ('contact', 'separated')
    #[pyo3(signature = (plan, window=(0.0, 1.0)))]
    fn first_contact_of(
        &self,
        py: Python<'_>,
        plan: &Bound<'_, PyAny>,
        window: (f64, f64),
    ) -> PyResult<FirstContact> {
        let window = self::window(window)?;
        let items = match plan.cast::<pyo3::types::PyDict>() {
            Ok(dict) => dict.items().into_any(),
            Err(_) => plan.clone(),
        };
        let mut planned = Vec::new();
        for item in items.try_iter()? {
            let (body, motion): (Bound<'_, PyAny>, Option<Bound<'_, PyAny>>) = item?.extract()?;
            let motion = motion_argument(motion.as_ref(), "motion")?;
            let inner = self.lock(py);
            let body = self.find(&inner, &body)?;
            motion.check_size(inner.world.body(body).tree()).or_raise()?;
            planned.push(PlannedMotion { body, motion: motion.shared() });
        }
        let found = self.ask(py, None, |world, _| {
            // A body may have been removed by another thread since.
            match planned.iter().find(|planned| world.get(planned.body).is_none()) {
                Some(planned) => Err(Fault::new(format!("{:?} was removed", planned.body))),
                None => Ok(world.first_contact_of(&planned, window)?),
            }
        })?;
        self.first(py, found)
    }

    /// The locally closest features of all pairs within `margin` at one time: a list of (a, b, structured array as of
    /// `d2m_ccd.proximities`).
    ///
    /// Raises `InputError` for bodies that are not apart.
    ///
    /// >>> import d2m_ccd
    /// >>> world = d2m_ccd.World()
    /// >>> ids = [world.add("shape:box?x=0.5&y=0.5&z=0.5", {"x": [0, 0, 1.001 * k]}) for k in range(3)]
    /// >>> [(a.index, b.index) for a, b, near in world.proximities(0.0, 0.01)]
    /// [(0, 1), (1, 2)]
    #[pyo3(signature = (time, margin, *, cone_slack=0.0))]
    fn proximities<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        margin: f64,
        cone_slack: f64,
    ) -> PyResult<Vec<(BodyId, BodyId, Bound<'py, PyAny>)>> {
        if !time.is_finite() {
            return Err(Fault::new(format!("time is {time}, not a finite number")).found(time).into());
        }
        let options = ProximityOptions::new(margin).with_cone_slack(cone_slack);
        let found = self.ask(py, None, |world, _| Ok(world.proximities(time, &options)?))?;
        let inner = self.lock(py);
        let pair = |pair: &d2m::PairProximities| {
            let [a, b] = [pair.a, pair.b].map(|id| self.name(&inner, id));
            Ok((a, b, proximity_array(py, &pair.proximities)?))
        };
        found.iter().map(pair).collect()
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.lock(py).world.len()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("World({} bodies)", self.__len__(py))
    }
}
