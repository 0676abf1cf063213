//! Robot arms.

use crate::fault::{Fault, OrRaise};
use crate::mesh::Tree;
use crate::motion::{motion_argument, motion_object};
use crate::options::{QueryKeywords, body_argument, solid_word};
use crate::pose::{Pose, pose_argument};
use crate::robot_input::{Source, path};
use crate::robot_recipe::{Change, ReadRobot, RobotFiles, RobotKeywords, recipe};
use crate::supervise::{Supervision, Watch, pool, supervised};
use d2m_robot::{Attached, Obstacle, RobotError, RobotOptions, RobotScene, Srdf, Trajectory};
use glam::DVec3;
use pyo3::exceptions::PyKeyError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rayon::ThreadPool;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, PoisonError, RwLock};

/// A robot arm of a URDF file in a scene: is a path free of contact with the scene and with the arm itself, and until when?
///
/// `urdf`: a path, or the text itself; `srdf`: the same, whose disabled pairs are not checked; `packages`: folders by package names. Other
/// keywords as of `time_of_contact`, for every pair; `threads` for batches of edges. Joints that are not named stay at zero, or in the middle
/// of their limits where zero is outside; mimic joints follow. Checked are all pairs of links but those that a joint connects, and links and
/// attached bodies against obstacles. Lengths are those of the URDF (meters), angles radians.
///
/// Raises `InputError` with file, line (its `index`) and value for what cannot be used, and never leaves geometry out. A robot pickles with its
/// meshes and all that was added: no file is needed where it is read again.
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
    srdf: Option<Srdf>,
    remarks: Vec<String>,
    keywords: RobotKeywords,
    pub(crate) pool: Arc<ThreadPool>,
}

struct Inner {
    scene: Arc<RobotScene>,
    /// Links, then obstacles and attached bodies in the order in which they came.
    names: Vec<String>,
    /// What was done to the scene, to be done again when it is read from a pickle.
    changes: Vec<Change>,
}

impl Inner {
    /// To be changed: queries that go on have another one then.
    fn scene(&mut self) -> &mut RobotScene {
        Arc::make_mut(&mut self.scene)
    }
}

impl Robot {
    /// The scene as it is; queries go on in it while others change it.
    pub(crate) fn scene(&self, py: Python<'_>) -> Arc<RobotScene> {
        // A change takes long: whoever changes holds the lock, and not the interpreter's.
        match self.inner.try_read() {
            Ok(inner) => Arc::clone(&inner.scene),
            Err(_) => {
                py.detach(|| Arc::clone(&self.inner.read().unwrap_or_else(PoisonError::into_inner).scene))
            }
        }
    }

    fn change<T>(
        &self,
        py: Python<'_>,
        made: Change,
        change: impl FnOnce(&mut Inner) -> Result<T, RobotError> + Send,
    ) -> PyResult<T>
    where
        T: Send,
    {
        let both = || {
            let mut inner = self.inner.write().unwrap_or_else(PoisonError::into_inner);
            let answer = change(&mut inner)?;
            inner.changes.push(made);
            Ok::<_, RobotError>(answer)
        };
        py.detach(both).or_raise()
    }

    /// Of texts or files.
    fn of(py: Python<'_>, files: RobotFiles, keywords: RobotKeywords) -> PyResult<Self> {
        let RobotKeywords { tolerance, min_separation, ref start, node_tests, time_limit, threads } =
            keywords;
        let query =
            QueryKeywords { tolerance, min_separation, mode: "accurate", start, node_tests, time_limit };
        let options = query.options()?;
        let pool = pool(threads).or_raise()?;
        let read = py.detach(|| pool.install(|| files.read(options)));
        let ReadRobot { scene, srdf, remarks } = read.or_raise()?;
        let names = scene.robot().link_names().into_iter().map(str::to_owned).collect();
        let inner = RwLock::new(Inner { scene: Arc::new(scene), names, changes: Vec::new() });
        Ok(Self { inner, srdf, remarks, keywords, pool })
    }

    /// Of the moving joints where none are named.
    pub(crate) fn path(
        &self,
        py: Python<'_>,
        numbers: [Option<&Bound<'_, PyAny>>; 4],
        joints: Option<Vec<String>>,
    ) -> PyResult<Trajectory> {
        path(numbers, joints.unwrap_or_else(|| self.joint_names(py)))
    }

    pub(crate) fn names(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| self.inner.read().unwrap_or_else(PoisonError::into_inner).names.clone())
    }

    /// Asks on the robot's own pool.
    pub(crate) fn ask<T: Send>(
        &self,
        py: Python<'_>,
        watch: &Watch<'_>,
        ask: impl FnOnce(&RobotScene, &Supervision) -> Result<T, Fault> + Send,
    ) -> PyResult<T> {
        self.ask_on(py, &self.pool, watch, ask)
    }

    /// Asks on a pool, with a budget that ends when a signal comes.
    pub(crate) fn ask_on<T: Send>(
        &self,
        py: Python<'_>,
        pool: &ThreadPool,
        watch: &Watch<'_>,
        ask: impl FnOnce(&RobotScene, &Supervision) -> Result<T, Fault> + Send,
    ) -> PyResult<T> {
        let mut scene = (*self.scene(py)).clone();
        let options = *scene.options();
        supervised(py, watch, |supervision| {
            scene.set_budget(supervision.cancels(&options).budget);
            let scene = &scene;
            pool.install(move || ask(scene, supervision))
        })?
        .or_raise()
    }
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (urdf, *, srdf=None, packages=None, tolerance=None, min_separation=0.0, start="report", node_tests=None, time_limit=None, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn new(
        py: Python<'_>,
        urdf: &Bound<'_, PyAny>,
        srdf: Option<&Bound<'_, PyAny>>,
        packages: Option<HashMap<String, PathBuf>>,
        tolerance: Option<f64>,
        min_separation: f64,
        start: &str,
        node_tests: Option<u64>,
        time_limit: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let mut options = RobotOptions::new();
        for (name, folder) in packages.unwrap_or_default() {
            options = options.with_package(name, folder);
        }
        let urdf = Source::new(urdf, "urdf")?;
        let srdf = srdf.map(|srdf| Source::new(srdf, "srdf")).transpose()?;
        let start = start.to_owned();
        let keywords = RobotKeywords { tolerance, min_separation, start, node_tests, time_limit, threads };
        Self::of(py, RobotFiles { urdf, srdf, options }, keywords)
    }

    /// What `_rebuild.robot` begins with.
    #[staticmethod]
    fn _of_pickle(
        py: Python<'_>,
        file: String,
        text: String,
        meshes: Vec<(String, [f64; 3], Bound<'_, Tree>)>,
        srdf: Option<(String, String)>,
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        Self::of(py, RobotFiles::of_pickle([file, text], meshes, srdf), RobotKeywords::of(keywords)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, of) = (slf.py(), slf.get());
        let again = py.import(intern!(py, "d2m_ccd._rebuild"))?.getattr(intern!(py, "robot"))?;
        let inner = of.inner.read().unwrap_or_else(PoisonError::into_inner);
        let recipe = recipe(py, inner.scene.robot(), of.srdf.as_ref(), &of.keywords, &inner.changes)?;
        (again, recipe).into_pyobject(py)
    }

    /// The names of the links.
    #[getter]
    fn link_names(&self, py: Python<'_>) -> Vec<String> {
        self.scene(py).robot().link_names().into_iter().map(str::to_owned).collect()
    }

    /// The names of the joints that move and do not mimic another one: what configurations hold unless `joints` says otherwise.
    #[getter]
    pub(crate) fn joint_names(&self, py: Python<'_>) -> Vec<String> {
        self.scene(py).robot().joint_names().into_iter().map(str::to_owned).collect()
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

    /// What was noted while the robot was read: by how much cylinders were enlarged, joints that stay, links that only the SRDF has.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// Adds an obstacle: a tree (or what `Tree` takes) at rest in a pose, or with a motion in the time of paths.
    /// It is all that is within `radius` of its mesh.
    ///
    /// Raises `InputError` for a name that is taken and a radius that is none.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).add_obstacle("box", "shape:box", d2m_ccd.Pose(x=[5, 0, 0]))
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    #[pyo3(signature = (name, tree, pose=None, *, motion=None, radius=0.0, solid=None))]
    fn add_obstacle(
        &self,
        py: Python<'_>,
        name: String,
        tree: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
        motion: Option<&Bound<'_, PyAny>>,
        radius: f64,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (tree, solid) = body_argument(tree, solid)?;
        let body = Bound::new(py, Tree { tree: Arc::clone(&tree) })?;
        let motion = motion.map(|motion| motion_object(motion, "motion")).transpose()?;
        let motion = motion.as_ref();
        let placed =
            pose.map(|pose| Ok::<_, PyErr>(Pose { pose: pose_argument(Some(pose), "pose")? })).transpose()?;
        let made = Change::new(py, "add_obstacle", (&name, body, placed))?;
        let made = made.with(py, "motion", motion)?.with(py, "radius", radius)?.with(
            py,
            "solid",
            solid_word(solid),
        )?;
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
        self.change(py, made, |inner| {
            inner.scene().add_obstacle(obstacle.with_solid(solid).with_radius(radius))?;
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
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    #[pyo3(signature = (name, link, tree, pose=None, *, radius=0.0, solid=None))]
    fn attach(
        &self,
        py: Python<'_>,
        name: String,
        link: String,
        tree: &Bound<'_, PyAny>,
        pose: Option<&Bound<'_, PyAny>>,
        radius: f64,
        solid: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (tree, solid) = body_argument(tree, solid)?;
        let pose = pose_argument(pose, "pose")?;
        if pose.at != DVec3::ZERO {
            return Err(Fault::new("pose: the reference point of an attached body is its origin").into());
        }
        let body = Bound::new(py, Tree { tree: Arc::clone(&tree) })?;
        let made = Change::new(py, "attach", (&name, &link, body, Pose { pose }))?;
        let made = made.with(py, "radius", radius)?.with(py, "solid", solid_word(solid))?;
        let attached = Attached::new(name.clone(), link, tree, pose.translation, pose.rotation).or_raise()?;
        self.change(py, made, |inner| {
            inner.scene().attach(attached.with_solid(solid).with_radius(radius))?;
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
        let made = Change::new(py, "ignore", (a, b))?;
        let is_there = self.change(py, made, |inner| Ok(inner.scene().ignore(a, b)))?;
        there(is_there, a, b)
    }

    /// What counts of two links or bodies that are in contact at the start of a path, "report" or "leave": let go until they are proven apart.
    ///
    /// Raises `KeyError` for names that are not there.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).set_start("base", "arm", "leave")
    fn set_start(&self, py: Python<'_>, a: &str, b: &str, start: &str) -> PyResult<()> {
        let made = Change::new(py, "set_start", (a, b, start))?;
        let start = crate::options::start(start)?;
        let is_there = self.change(py, made, |inner| Ok(inner.scene().set_start([a, b], start)))?;
        there(is_there, a, b)
    }

    /// The distance at which two links or bodies count as in contact, instead of `min_separation`.
    ///
    /// Raises `KeyError` for names that are not there, `InputError` for a distance that is none.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).set_min_separation("base", "arm", 0.01)
    fn set_min_separation(&self, py: Python<'_>, a: &str, b: &str, distance: f64) -> PyResult<()> {
        let made = Change::new(py, "set_min_separation", (a, b, distance))?;
        let is_there = self.change(py, made, |inner| inner.scene().set_min_separation([a, b], distance))?;
        there(is_there, a, b)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let scene = self.scene(py);
        let robot = scene.robot();
        let joints = robot.joint_names().len();
        let plural = if joints == 1 { "" } else { "s" };
        format!("Robot('{}', {} links, {joints} joint{plural})", robot.name(), robot.link_names().len())
    }
}

fn there(is_there: bool, a: &str, b: &str) -> PyResult<()> {
    if is_there { Ok(()) } else { Err(PyKeyError::new_err(format!("{a:?} or {b:?} is not there"))) }
}
