//! Robot arms.

use crate::answer;
use crate::arrays::Doubles;
use crate::fault::{Fault, OrRaise, Value};
use crate::mesh::tree_argument;
use crate::motion::motion_argument;
use crate::options::{QueryKeywords, default_solid, solid};
use crate::pose::pose_argument;
use crate::record::{EDGE_WORDS, Meeting, write_edge};
use crate::resting::named;
use crate::supervise::{Supervision, Watch, pool, supervised};
use d2m::TimeOfContact;
use d2m_robot::{
    Attached, Interpolation, LimitKind, Obstacle, PathAnswer as Found, Robot as Arm, RobotError,
    RobotOptions, RobotScene, Srdf, Trajectory, TrajectoryPoint,
};
use glam::DVec3;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

impl From<RobotError> for Fault {
    fn from(error: RobotError) -> Self {
        let fault = Self::new(error.to_string());
        match &error {
            RobotError::Path { place, .. } => match crate::fault::first_index(place) {
                Some(index) => fault.at(index),
                None => fault,
            },
            RobotError::Xml { line, .. }
            | RobotError::MeshFile { line, .. }
            | RobotError::Shape { line, .. } => fault.at(*line as usize),
            _ => fault,
        }
    }
}

/// What is known of a path or an edge of a `Robot`.
///
/// `status` "free": certified, no pair of links or bodies meets. "contact": certified free before `contact.time_lo`, and `a` and `b`
/// meet by `contact.time_hi`. "undecided": certified free until `free_until`. It has no truth value: ask for its status.
///
/// >>> import d2m_ccd
/// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
/// >>> robot.check_edge([0.0], [1.0])
/// PathAnswer('free', free_until=1.0)
#[pyclass(frozen, get_all, module = "d2m_ccd")]
pub(crate) struct PathAnswer {
    /// "free", "contact" or "undecided".
    status: &'static str,
    /// The end of what is proven free: a time of the path, or a part of an edge. Planners call it the last valid one.
    free_until: f64,
    /// The link or body that meets first, or is undecided first; `None` where the path is free.
    a: Option<String>,
    /// The other one.
    b: Option<String>,
    /// Their contact, in the world's frame, or `None`.
    contact: Option<Py<PyAny>>,
}

#[pymethods]
impl PathAnswer {
    fn __bool__(&self) -> PyResult<bool> {
        let message = "PathAnswer has no truth value: compare its status with \"free\"";
        Err(PyTypeError::new_err(message))
    }

    fn __repr__(&self) -> String {
        match (&self.a, &self.b) {
            (Some(a), Some(b)) => {
                format!("PathAnswer('{}', free_until={:?}, a='{a}', b='{b}')", self.status, self.free_until)
            }
            _ => format!("PathAnswer('{}', free_until={:?})", self.status, self.free_until),
        }
    }
}

impl PathAnswer {
    fn of(py: Python<'_>, found: Found) -> PyResult<Self> {
        let free_until = found.free_until();
        Ok(match found {
            Found::Free { .. } => Self { status: "free", free_until, a: None, b: None, contact: None },
            Found::Contact(found) => Self {
                status: "contact",
                free_until,
                contact: Some(answer::object(py, TimeOfContact::Contact(found.contact))?.unbind()),
                a: Some(found.a),
                b: Some(found.b),
            },
            Found::Undecided { a, b, .. } => {
                Self { status: "undecided", free_until, a: Some(a), b: Some(b), contact: None }
            }
        })
    }
}

/// A robot arm of a URDF file in a scene: is a path free of contact with the scene and with the arm itself, and until when?
///
/// `urdf`: a path, or the text itself; `srdf`: the same, whose disabled pairs are not checked; `packages`: folders by package names. Other
/// keywords as of `time_of_contact`, for every pair; `threads` for batches of edges. Joints that are not named stay at zero, or in the middle
/// of their limits where zero is outside; mimic joints follow. Checked are all pairs of links but those that a joint connects, and links and
/// attached bodies against obstacles. Lengths are those of the URDF (meters), angles radians.
///
/// Raises `InputError` with file, line (its `index`) and value for what cannot be used, and never leaves geometry out.
///
/// >>> import d2m_ccd
/// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
/// >>> robot
/// Robot('two', 2 links, 1 joint)
/// >>> robot.add_obstacle("wall", "shape:box?x=0.05&y=0.05&z=0.5", [1, 0, 0, 0, 0, 0.7, 0])
/// >>> answer = robot.check_path([0.0, 4.0], [[0.0], [2.0]])
/// >>> answer.status, answer.a, answer.b, 2.5 < answer.free_until < 3.2
/// ('contact', 'arm', 'wall', True)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Robot {
    inner: RwLock<Inner>,
    pool: Arc<ThreadPool>,
}

struct Inner {
    scene: RobotScene,
    /// Links, then obstacles and attached bodies in the order in which they came.
    names: Vec<String>,
}

impl Robot {
    /// The scene as it is; queries go on in it while others change it.
    fn scene(&self, py: Python<'_>) -> RobotScene {
        py.detach(|| self.inner.read().unwrap_or_else(PoisonError::into_inner).scene.clone())
    }

    fn change<T>(
        &self,
        py: Python<'_>,
        change: impl FnOnce(&mut Inner) -> Result<T, RobotError> + Send,
    ) -> PyResult<T>
    where
        T: Send,
    {
        py.detach(|| change(&mut self.inner.write().unwrap_or_else(PoisonError::into_inner))).or_raise()
    }

    fn names(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| self.inner.read().unwrap_or_else(PoisonError::into_inner).names.clone())
    }

    /// Asks on the pool, with a budget that ends when a signal comes.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        watch: &Watch<'_>,
        ask: impl FnOnce(&RobotScene, &Supervision) -> Result<T, Fault> + Send,
    ) -> PyResult<T> {
        let mut scene = self.scene(py);
        let options = *scene.options();
        supervised(py, watch, |supervision| {
            scene.set_budget(supervision.cancels(&options).budget);
            let scene = &scene;
            self.pool.install(move || ask(scene, supervision))
        })?
        .or_raise()
    }
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (urdf, *, srdf=None, packages=None, tolerance=None, min_separation=0.0, node_tests=None, time_limit=None, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn new(
        py: Python<'_>,
        urdf: &Bound<'_, PyAny>,
        srdf: Option<&Bound<'_, PyAny>>,
        packages: Option<HashMap<String, PathBuf>>,
        tolerance: Option<f64>,
        min_separation: f64,
        node_tests: Option<u64>,
        time_limit: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let mode = "accurate";
        let options = QueryKeywords { tolerance, min_separation, mode, node_tests, time_limit }.options()?;
        let mut read = RobotOptions::new();
        for (name, folder) in packages.unwrap_or_default() {
            read = read.with_package(name, folder);
        }
        let (urdf, srdf) = (Source::new(urdf)?, srdf.map(Source::new).transpose()?);
        let pool = pool(threads).or_raise()?;
        let scene = py.detach(|| {
            let robot = match urdf {
                Source::File(path) => Arm::read(path, &read)?,
                Source::Text(text) => Arm::parse("urdf", &text, &read)?,
            };
            let srdf = match srdf {
                None => None,
                Some(Source::File(path)) => Some(Srdf::read(path)?),
                Some(Source::Text(text)) => Some(Srdf::parse("srdf", &text)?),
            };
            pool.install(|| RobotScene::new(Arc::new(robot), srdf.as_ref(), options))
        });
        let scene = scene.or_raise()?;
        let names = scene.robot().link_names().into_iter().map(str::to_owned).collect();
        Ok(Self { inner: RwLock::new(Inner { scene, names }), pool })
    }

    /// The names of the links.
    #[getter]
    fn link_names(&self, py: Python<'_>) -> Vec<String> {
        self.scene(py).robot().link_names().into_iter().map(str::to_owned).collect()
    }

    /// The names of the joints that move and do not mimic another one: what configurations hold unless `joints` says otherwise.
    #[getter]
    fn joint_names(&self, py: Python<'_>) -> Vec<String> {
        moving_joints(self.scene(py).robot())
    }

    /// Links, then obstacles and attached bodies: what `body_a` and `body_b` of `check_edges` number.
    #[getter]
    fn body_names(&self, py: Python<'_>) -> Vec<String> {
        self.names(py)
    }

    /// Least and greatest position of a joint and its greatest speed; infinite where the file states none.
    ///
    /// Raises `KeyError` for a joint that is not there.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).limits("turn")
    /// (-3.0, 3.0, 1.0)
    fn limits(&self, py: Python<'_>, joint: &str) -> PyResult<(f64, f64, f64)> {
        let scene = self.scene(py);
        let found = scene.robot().find_joint(joint);
        let found =
            found.ok_or_else(|| PyKeyError::new_err(format!("{joint:?} is no joint of the robot")))?;
        let limits = scene.robot().limits(found);
        let [lower, upper] = limits.position.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        Ok((lower, upper, limits.velocity.unwrap_or(f64::INFINITY)))
    }

    /// What was noted while the robot was read, such as by how much cylinders were enlarged.
    #[getter]
    fn remarks(&self, py: Python<'_>) -> Vec<String> {
        self.scene(py).robot().remarks().to_vec()
    }

    /// Adds an obstacle: a tree (or what `Tree` takes) at rest in a pose, or with a motion in the time of paths.
    ///
    /// Raises `InputError` for a name that is taken.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).add_obstacle("box", "shape:box", d2m_ccd.Pose(x=[5, 0, 0]))
    #[pyo3(signature = (name, tree, pose=None, *, motion=None, solid=None))]
    fn add_obstacle(
        &self,
        py: Python<'_>,
        name: String,
        tree: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
        motion: Option<&Bound<'_, PyAny>>,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let tree = tree_argument(tree)?;
        let usual = default_solid(&tree);
        let solid = solid.map_or(Ok(usual), |any| self::solid(any, usual))?;
        let obstacle = match (pose, motion) {
            (Some(_), Some(_)) => {
                return Err(Fault::new("an obstacle has a pose or a motion, not both").into());
            }
            (_, Some(motion)) => {
                let motion = motion_argument(Some(motion), "motion")?;
                motion.check_size(&tree).or_raise()?;
                Obstacle::moving(name.clone(), tree, motion.shared())
            }
            (pose, None) => {
                let pose = pose_argument(pose, "pose")?;
                let origin = d2m::Pose { rotation: pose.rotation.normalize(), ..pose };
                let position = if pose.at == DVec3::ZERO {
                    pose.translation
                } else {
                    origin.transform_point(DVec3::ZERO)
                };
                Obstacle::at_rest(name.clone(), tree, position, pose.rotation).or_raise()?
            }
        };
        self.change(py, |inner| {
            inner.scene.add_obstacle(obstacle.with_solid(solid))?;
            inner.names.push(name);
            Ok(())
        })
    }

    /// Attaches a body to a link: a tree in a pose in the link's frame.
    ///
    /// Raises `InputError` for a name that is taken and a link that is not there.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).attach("cup", "arm", "shape:box?x=0.01&y=0.01&z=0.01", d2m_ccd.Pose(x=[1, 0, 0]))
    #[pyo3(signature = (name, link, tree, pose=None, *, solid=None))]
    fn attach(
        &self,
        py: Python<'_>,
        name: String,
        link: String,
        tree: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let tree = tree_argument(tree)?;
        let usual = default_solid(&tree);
        let solid = solid.map_or(Ok(usual), |any| self::solid(any, usual))?;
        let pose = pose_argument(pose, "pose")?;
        if pose.at != DVec3::ZERO {
            return Err(Fault::new("pose: the reference point of an attached body is its origin").into());
        }
        let attached = Attached::new(name.clone(), link, tree, pose.translation, pose.rotation).or_raise()?;
        self.change(py, |inner| {
            inner.scene.attach(attached.with_solid(solid))?;
            inner.names.push(name);
            Ok(())
        })
    }

    /// Leaves out a pair of links or bodies, by their names.
    ///
    /// Raises `KeyError` for names that are not there.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).ignore("base", "arm")
    fn ignore(&self, py: Python<'_>, a: &str, b: &str) -> PyResult<()> {
        if self.change(py, |inner| Ok(inner.scene.ignore(a, b)))? {
            Ok(())
        } else {
            Err(PyKeyError::new_err(format!("{a:?} or {b:?} is not there")))
        }
    }

    /// Is a path free of contact, until when, and which pair meets first?
    ///
    /// `times` of shape (k,), `positions` of shape (k, j), and `velocities` and `accelerations` of the same shape: linear between the points,
    /// cubic with velocities, quintic with accelerations. `joints`: the names of the j joints, by default `joint_names`.
    ///
    /// Raises `InputError` for other shapes, numbers that are not finite, times that do not increase, and names that are no joints.
    ///
    /// >>> import d2m_ccd
    /// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    /// >>> robot.check_path([0.0, 1.0, 2.0], [[0.0], [1.0], [0.0]], [[0.0], [0.0], [0.0]]).status
    /// 'free'
    #[pyo3(signature = (times, positions, velocities=None, accelerations=None, *, joints=None))]
    fn check_path(
        &self,
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        accelerations: Option<&Bound<'_, PyAny>>,
        joints: Option<Vec<String>>,
    ) -> PyResult<PathAnswer> {
        let path = self.path(py, [Some(times), Some(positions), velocities, accelerations], joints)?;
        let found = self.ask(py, &Watch::default(), |scene, _| Ok(scene.check_path(&path)?))?;
        PathAnswer::of(py, found)
    }

    /// Where a path leaves the limits of its joints, which are not enforced: a list of dictionaries with "joint", "kind" ("position" or
    /// "velocity"), "time", "point" (after which it is), "value" and "limit". Arguments as of `check_path`.
    ///
    /// >>> import d2m_ccd
    /// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    /// >>> [(found["joint"], found["kind"]) for found in robot.limit_warnings([0.0, 1.0], [[0.0], [2.0]])]
    /// [('turn', 'velocity')]
    #[pyo3(signature = (times, positions, velocities=None, accelerations=None, *, joints=None))]
    fn limit_warnings<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
        positions: &Bound<'py, PyAny>,
        velocities: Option<&Bound<'py, PyAny>>,
        accelerations: Option<&Bound<'py, PyAny>>,
        joints: Option<Vec<String>>,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let path = self.path(py, [Some(times), Some(positions), velocities, accelerations], joints)?;
        let scene = self.scene(py);
        let found = py.detach(|| scene.limit_warnings(&path)).or_raise()?;
        let one = |found: &d2m_robot::LimitWarning| {
            let dict = PyDict::new(py);
            dict.set_item("joint", &found.joint)?;
            dict.set_item("kind", if found.kind == LimitKind::Position { "position" } else { "velocity" })?;
            dict.set_item("time", found.time)?;
            dict.set_item("point", found.point)?;
            dict.set_item("value", found.value)?;
            dict.set_item("limit", found.limit)?;
            Ok(dict)
        };
        found.iter().map(one).collect()
    }

    /// Is the straight edge from one configuration to another free, and how far? Time runs from 0 to 1.
    ///
    /// Configurations of shape (j,), of the joints named in `joints`, by default `joint_names`.
    ///
    /// Raises as `check_path`.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).check_edge([0.0], [1.0]).status
    /// 'free'
    #[pyo3(signature = (start, end, *, joints=None))]
    fn check_edge(
        &self,
        py: Python<'_>,
        start: &Bound<'_, PyAny>,
        end: &Bound<'_, PyAny>,
        joints: Option<Vec<String>>,
    ) -> PyResult<PathAnswer> {
        let (from, to) = (Doubles::new(start, "start", &[None])?, Doubles::new(end, "end", &[None])?);
        let (from, to) = (from.slice(), to.slice());
        let found = self.ask(py, &Watch::default(), |scene, _| {
            let names = joints.unwrap_or_else(|| moving_joints(scene.robot()));
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            Ok(scene.edges(&names)?.check(from, to)?)
        })?;
        PathAnswer::of(py, found)
    }

    /// Many edges, on all threads: configurations of shape (n, j) twice.
    ///
    /// Returns a structured array with the fields of `d2m_ccd.EDGE`: those of `d2m_ccd.RESULT`, of the first contact, and `free_until` (1 where
    /// the edge is free), `body_a` and `body_b` (places in `body_names`, -1 where there is none). In order, with the same bits at any
    /// number of threads. `progress` as of `d2m_ccd.batch`.
    ///
    /// Raises `InputError` whose `index` is the first edge that cannot be checked; `KeyboardInterrupt` on Ctrl-C.
    ///
    /// >>> import numpy, d2m_ccd
    /// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    /// >>> robot.check_edges(numpy.zeros((3, 1)), [[1.0], [2.0], [3.0]])["free_until"].tolist()
    /// [1.0, 1.0, 1.0]
    #[pyo3(signature = (start, end, *, joints=None, progress=None))]
    fn check_edges<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        joints: Option<Vec<String>>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let from = Doubles::new(start, "start", &[None, None])?;
        let shape = from.shape().to_vec();
        let to = Doubles::new(end, "end", &[Some(shape[0]), Some(shape[1])])?;
        let (from, to, width) = (from.slice(), to.slice(), shape[1]);
        let names = self.names(py);
        let places: HashMap<&str, u32> = names.iter().map(String::as_str).zip(0..).collect();
        let mut words = vec![0u64; shape[0] * EDGE_WORDS];
        let watch = Watch { progress, total: shape[0] };
        let out = &mut words;
        self.ask(py, &watch, |scene, supervision| {
            let joints = joints.unwrap_or_else(|| moving_joints(scene.robot()));
            if joints.len() != width {
                let message = format!("{width} numbers a configuration for {} joints", joints.len());
                return Err(Fault::new(message).with_value(Value::Whole(width as i128)));
            }
            let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
            let edges = scene.edges(&joints)?;
            let first: Mutex<Option<(usize, Fault)>> = Mutex::new(None);
            let failed = AtomicUsize::new(usize::MAX);
            out.par_chunks_mut(EDGE_WORDS).enumerate().for_each(|(edge, words)| {
                if supervision.is_cancelled() || edge > failed.load(Ordering::Relaxed) {
                    return;
                }
                let at = edge * width..(edge + 1) * width;
                match edges.check(&from[at.clone()], &to[at]) {
                    Ok(found) => write_edge(&meeting(&found, &places), words),
                    Err(error) => {
                        failed.fetch_min(edge, Ordering::Relaxed);
                        let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
                        if first.as_ref().is_none_or(|(other, _)| edge < *other) {
                            *first = Some((edge, error.into()));
                        }
                    }
                }
                supervision.add_done(1);
            });
            match first.into_inner().unwrap_or_else(PoisonError::into_inner) {
                Some((edge, fault)) => Err(fault.within(&format!("edge {edge}")).at(edge)),
                None => Ok(()),
            }
        })?;
        named(py, words, "EDGE")
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let scene = self.scene(py);
        let robot = scene.robot();
        let joints = moving_joints(robot).len();
        let plural = if joints == 1 { "" } else { "s" };
        format!("Robot('{}', {} links, {joints} joint{plural})", robot.name(), robot.link_names().len())
    }
}

impl Robot {
    /// Of times, positions, velocities and accelerations.
    fn path(
        &self,
        py: Python<'_>,
        [times, positions, velocities, accelerations]: [Option<&Bound<'_, PyAny>>; 4],
        joints: Option<Vec<String>>,
    ) -> PyResult<Trajectory> {
        let joints = joints.unwrap_or_else(|| moving_joints(self.scene(py).robot()));
        let read = |any: Option<&Bound<'_, PyAny>>, name: &str, shape: &[Option<usize>]| {
            any.map(|any| Ok::<_, PyErr>(Doubles::new(any, name, shape)?.slice().to_vec())).transpose()
        };
        let times = read(times, "times", &[None])?.unwrap_or_default();
        let shape = [Some(times.len()), Some(joints.len())];
        let positions = read(positions, "positions", &shape)?.unwrap_or_default();
        let velocities = read(velocities, "velocities", &shape)?;
        let accelerations = read(accelerations, "accelerations", &shape)?;
        let width = joints.len();
        let row = |all: &[f64], point: usize| all[point * width..(point + 1) * width].to_vec();
        let point = |(place, &time): (usize, &f64)| {
            let mut point = TrajectoryPoint::new(time, row(&positions, place));
            if let Some(velocities) = &velocities {
                point = point.with_velocities(row(velocities, place));
            }
            if let Some(accelerations) = &accelerations {
                point = point.with_accelerations(row(accelerations, place));
            }
            point
        };
        let interpolation = match (&velocities, &accelerations) {
            (_, Some(_)) => Interpolation::Quintic,
            (Some(_), None) => Interpolation::Cubic,
            (None, None) => Interpolation::Linear,
        };
        let points = times.iter().enumerate().map(point).collect();
        Ok(Trajectory::new(joints, points).with_interpolation(interpolation))
    }
}

/// Joints that move by a value of their own.
fn moving_joints(robot: &Arm) -> Vec<String> {
    let moves = |&&name: &&&str| {
        robot.find_joint(name).is_some_and(|joint| {
            robot.joint_type(joint) != d2m_robot::JointType::Fixed && robot.mimic(joint).is_none()
        })
    };
    robot.joint_names().iter().filter(moves).map(|&name| name.to_owned()).collect()
}

/// What a record of an edge holds.
fn meeting(found: &Found, places: &HashMap<&str, u32>) -> Meeting {
    let place = |name: &str| places.get(name).copied();
    let (answer, a, b) = match found {
        Found::Free { .. } => (TimeOfContact::Separated, None, None),
        Found::Contact(found) => (TimeOfContact::Contact(found.contact), place(&found.a), place(&found.b)),
        Found::Undecided { free_until, a, b, .. } => {
            (TimeOfContact::Undecided { clear_until: *free_until }, place(a), place(b))
        }
    };
    Meeting { answer, free_until: found.free_until(), bodies: [a, b] }
}

/// Where a text is.
enum Source {
    File(PathBuf),
    Text(String),
}

impl Source {
    /// A text that begins as XML does, or a path.
    fn new(any: &Bound<'_, PyAny>) -> PyResult<Self> {
        match any.extract::<String>() {
            Ok(text) if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') => {
                Ok(Self::Text(text))
            }
            _ => Ok(Self::File(any.extract()?)),
        }
    }
}
