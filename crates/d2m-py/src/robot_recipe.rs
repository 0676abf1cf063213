//! What a robot was made of: a pickled one is made again of that, on a machine that has none of its files.

use crate::mesh::Tree;
use crate::robot_input::Source;
use d2m::bvh::QueryOptions;
use d2m_robot::{Robot, RobotError, RobotOptions, RobotScene, Srdf};
use glam::DVec3;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// Keywords of a robot.
#[derive(Clone)]
pub(crate) struct RobotKeywords {
    pub(crate) tolerance: Option<f64>,
    pub(crate) min_separation: f64,
    pub(crate) start: String,
    pub(crate) node_tests: Option<u64>,
    pub(crate) time_limit: Option<f64>,
    pub(crate) threads: Option<usize>,
}

impl RobotKeywords {
    fn dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("tolerance", self.tolerance)?;
        dict.set_item("min_separation", self.min_separation)?;
        dict.set_item("start", &self.start)?;
        dict.set_item("node_tests", self.node_tests)?;
        dict.set_item("time_limit", self.time_limit)?;
        dict.set_item("threads", self.threads)?;
        Ok(dict)
    }

    /// Of what [`RobotKeywords::dict`] has made.
    pub(crate) fn of(dict: &Bound<'_, PyDict>) -> PyResult<Self> {
        let item = |key: &str| dict.get_item(key)?.ok_or_else(|| PyKeyError::new_err(key.to_owned()));
        Ok(Self {
            tolerance: item("tolerance")?.extract()?,
            min_separation: item("min_separation")?.extract()?,
            start: item("start")?.extract()?,
            node_tests: item("node_tests")?.extract()?,
            time_limit: item("time_limit")?.extract()?,
            threads: item("threads")?.extract()?,
        })
    }
}

/// What was done to the scene of a robot: a method with arguments that pickle.
pub(crate) struct Change {
    method: &'static str,
    arguments: Py<PyTuple>,
    keywords: Py<PyDict>,
}

impl Change {
    pub(crate) fn new<'py>(
        py: Python<'py>,
        method: &'static str,
        arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
    ) -> PyResult<Self> {
        let (arguments, keywords) = (arguments.into_pyobject(py)?.unbind(), PyDict::new(py).unbind());
        Ok(Self { method, arguments, keywords })
    }

    /// With one more keyword.
    pub(crate) fn with<'py>(
        self,
        py: Python<'py>,
        name: &str,
        value: impl IntoPyObject<'py>,
    ) -> PyResult<Self> {
        self.keywords.bind(py).set_item(name, value)?;
        Ok(self)
    }

    pub(crate) fn parts(&self, py: Python<'_>) -> (&'static str, Py<PyTuple>, Py<PyDict>) {
        (self.method, self.arguments.clone_ref(py), self.keywords.clone_ref(py))
    }
}

/// What `_rebuild.robot` takes.
pub(crate) fn recipe<'py>(
    py: Python<'py>,
    robot: &Robot,
    srdf: Option<&Srdf>,
    keywords: &RobotKeywords,
    changes: &[Change],
) -> PyResult<Bound<'py, PyTuple>> {
    let mesh = |mesh: d2m_robot::RobotMesh<'_>| {
        let tree = Bound::new(py, Tree { tree: Arc::clone(mesh.tree) })?;
        (mesh.name, mesh.scale.to_array(), tree).into_pyobject(py)
    };
    let meshes = robot.meshes().map(mesh).collect::<PyResult<Vec<_>>>()?;
    let srdf = srdf.map(|srdf| (srdf.file(), srdf.text()));
    let changes: Vec<_> = changes.iter().map(|change| change.parts(py)).collect();
    (robot.file(), robot.text(), meshes, srdf, keywords.dict(py)?, changes).into_pyobject(py)
}

/// What a robot is read from.
pub(crate) struct RobotFiles {
    pub(crate) urdf: Source,
    pub(crate) srdf: Option<Source>,
    pub(crate) options: RobotOptions,
}

/// A robot that was read.
pub(crate) struct ReadRobot {
    pub(crate) scene: RobotScene,
    pub(crate) srdf: Option<Srdf>,
    pub(crate) remarks: Vec<String>,
}

impl RobotFiles {
    pub(crate) fn read(self, query: QueryOptions) -> Result<ReadRobot, RobotError> {
        let Self { urdf, srdf, options } = self;
        let robot = match urdf {
            Source::File(path) => Robot::read(path, &options)?,
            Source::Text { file, text } => Robot::parse(&file, &text, &options)?,
        };
        let srdf = match srdf {
            None => None,
            Some(Source::File(path)) => Some(Srdf::read(path)?),
            Some(Source::Text { file, text }) => Some(Srdf::parse(&file, &text)?),
        };
        let mut remarks = robot.remarks().to_vec();
        let is_link = |link: &str| robot.find_link(link).is_some();
        remarks.extend(srdf.iter().flat_map(|srdf| srdf.find_unknown_links(is_link)));
        let scene = RobotScene::new(Arc::new(robot), srdf.as_ref(), query)?;
        Ok(ReadRobot { scene, srdf, remarks })
    }

    /// What [`recipe`] has written.
    pub(crate) fn of_pickle(
        [file, text]: [String; 2],
        meshes: Vec<(String, [f64; 3], Bound<'_, Tree>)>,
        srdf: Option<(String, String)>,
    ) -> Self {
        let with = |options: RobotOptions, (name, scale, tree): (String, [f64; 3], Bound<'_, Tree>)| {
            options.with_mesh(name, DVec3::from_array(scale), Arc::clone(&tree.get().tree))
        };
        Self {
            urdf: Source::Text { file, text },
            srdf: srdf.map(|(file, text)| Source::Text { file, text }),
            options: meshes.into_iter().fold(RobotOptions::new(), with),
        }
    }
}
