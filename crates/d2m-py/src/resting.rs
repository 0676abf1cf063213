//! Queries of bodies at rest.

use crate::fault::{Fault, OrRaise};
use crate::mesh::tree_argument;
use crate::options::{budget, solids};
use crate::pose::{list, pose_argument};
use crate::query::run;
use crate::record::{PROXIMITY_WORDS, write_proximity};
use crate::witness::Witness;
use d2m::bvh::{
    Budget, DistanceOptions, MeshTree, Posed, ProximityOptions, QueryError, QueryOptions, Solid,
    collide_within, distance_within, proximities_within,
};
use d2m_io::start_word;
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::Arc;

/// Two bodies in their poses.
struct PosedPair {
    trees: [Arc<MeshTree>; 2],
    poses: [d2m::Pose; 2],
}

impl PosedPair {
    fn new(bodies: [&Bound<'_, PyAny>; 2], poses: [Option<&Bound<'_, PyAny>>; 2]) -> PyResult<Self> {
        let trees = [tree_argument(bodies[0])?, tree_argument(bodies[1])?];
        let poses = [pose_argument(poses[0], "pose_a")?, pose_argument(poses[1], "pose_b")?];
        Ok(Self { trees, poses })
    }

    fn posed(&self) -> [Posed<'_>; 2] {
        [0, 1].map(|body| Posed::new(&self.trees[body], self.poses[body]))
    }

    /// What each body is.
    fn solids(&self, any: Option<&Bound<'_, PyAny>>) -> PyResult<[Solid; 2]> {
        solids(any, [&self.trees[0], &self.trees[1]])
    }
}

/// The distance of two bodies at rest, enclosed, with the points that are nearest (those of `Witness`).
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> apart = d2m_ccd.distance(box, box, d2m_ccd.Pose(x=[0, 0, 1.25]))
/// >>> apart.lower <= 0.25 <= apart.upper, apart.state, apart.normal.tolist()
/// (True, 'apart', [0.0, 0.0, -1.0])
#[pyclass(frozen, extends = Witness, module = "d2m_ccd")]
pub(crate) struct Distance {
    found: d2m::Distance,
}

impl Distance {
    /// With its witness.
    pub(crate) fn new(py: Python<'_>, found: d2m::Distance) -> PyResult<Py<Self>> {
        Py::new(py, PyClassInitializer::from(Witness::from(&found)).add_subclass(Self { found }))
    }
}

#[pymethods]
impl Distance {
    /// The distance to rounding; 0 if the bodies are not proven apart.
    #[getter]
    fn value(&self) -> f64 {
        self.found.value
    }

    /// Proven: the distance is at least this.
    #[getter]
    fn lower(&self) -> f64 {
        self.found.lower
    }

    /// Proven: the distance is at most this.
    #[getter]
    fn upper(&self) -> f64 {
        self.found.upper
    }

    /// "apart" (proven), "touching", "overlapping" or "contained" (proven).
    #[getter]
    fn state(&self) -> &'static str {
        start_word(self.found.state)
    }

    fn __float__(&self) -> f64 {
        self.found.value
    }

    fn __repr__(&self) -> String {
        let d2m::Distance { value, lower, upper, .. } = self.found;
        let [a, b] = [self.found.point_a, self.found.point_b].map(|point| list(&point.to_array()));
        let state = self.state();
        format!(
            "Distance(value={value:?}, bounds=[{lower:?}, {upper:?}], state='{state}', point_a={a}, point_b={b})"
        )
    }
}

/// The distance of two bodies at rest, with proven bounds and witnesses.
///
/// Poses are those of `Pose`, matrices of shape (4, 4), seven numbers (q, x), or `None`; `solid` as of `time_of_contact`. With a `cutoff`, `None` is a proof that the distance is more than that.
///
/// Raises `InputError` for poses that are none, a filled solid that does not close, a negative cutoff.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> round(d2m_ccd.distance(box, box, d2m_ccd.Pose(x=[3, 0, 0])).value, 12)
/// 2.0
/// >>> d2m_ccd.distance(box, box, d2m_ccd.Pose(x=[3, 0, 0]), cutoff=1.0) is None
/// True
#[pyfunction]
#[pyo3(signature = (a, b, pose_a=None, pose_b=None, *, solid=None, cutoff=None))]
pub(crate) fn distance(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    pose_a: Option<&Bound<'_, PyAny>>,
    pose_b: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    cutoff: Option<f64>,
) -> PyResult<Option<Py<Distance>>> {
    let pair = PosedPair::new([a, b], [pose_a, pose_b])?;
    let mut options = DistanceOptions::default().with_solids(pair.solids(solid)?);
    if let Some(cutoff) = cutoff {
        options = options.with_cutoff(cutoff);
    }
    let [a, b] = pair.posed();
    let found = py.detach(|| distance_within(a, b, &options)).or_raise()?;
    found.map(|found| Distance::new(py, found)).transpose()
}

/// Do two bodies at rest share a point?
///
/// `False` is proven; `True` is said wherever that cannot be proven, which is for bodies that touch and those that are
/// apart by less than rounding. `None`: `node_tests` or `time_limit` (seconds) ran out. Other arguments as of `distance`.
///
/// Raises `InputError` as `distance`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> d2m_ccd.collide(box, box, d2m_ccd.Pose(x=[0.9, 0, 0])), d2m_ccd.collide(box, box, d2m_ccd.Pose(x=[1.1, 0, 0]))
/// (True, False)
#[pyfunction]
#[pyo3(signature = (a, b, pose_a=None, pose_b=None, *, solid=None, node_tests=None, time_limit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn collide(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    pose_a: Option<&Bound<'_, PyAny>>,
    pose_b: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
) -> PyResult<Option<bool>> {
    let pair = PosedPair::new([a, b], [pose_a, pose_b])?;
    let solids = pair.solids(solid)?;
    let budget = budget(node_tests, time_limit).or_raise()?;
    let [a, b] = pair.posed();
    py.detach(|| collide_within(a, b, solids, &budget)).or_raise()
}

/// Every locally closest pair of features of two bodies at rest within `margin`: the contact manifold.
///
/// Returns a structured array, ordered by distance, with the fields `distance`, `tilt`, `normal` (from A to B), `point_a`,
/// `point_b`, `triangle_a`, `triangle_b`, `feature_kind`, `features`. `cone_slack`, the sine of an angle: how far a direction may be outside
/// of a normal cone. Poses as of `distance`.
///
/// Raises `InputError` for bodies that are not apart, a margin that is negative or not finite.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> near = d2m_ccd.proximities(box, box, None, d2m_ccd.Pose(x=[0.2, 0, 1.01]), margin=0.1)
/// >>> bool((near["normal"] == [0, 0, 1]).all()), round(float(near["distance"][0]), 9)
/// (True, 0.01)
#[pyfunction]
#[pyo3(signature = (a, b, pose_a=None, pose_b=None, *, margin, cone_slack=0.0))]
pub(crate) fn proximities<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    pose_a: Option<&Bound<'py, PyAny>>,
    pose_b: Option<&Bound<'py, PyAny>>,
    margin: f64,
    cone_slack: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let pair = PosedPair::new([a, b], [pose_a, pose_b])?;
    let options = ProximityOptions::new(margin).with_cone_slack(cone_slack);
    let [a, b] = pair.posed();
    let ask = |query: &QueryOptions| -> Result<_, Fault> {
        let found: Result<_, QueryError> = proximities_within(a, b, &options, &query.budget);
        Ok(found?)
    };
    let unlimited = QueryOptions::DEFAULT.with_budget(Budget::UNLIMITED);
    let found = run(py, &unlimited, ask, Option::is_some)?.unwrap_or_default();
    proximity_array(py, &found)
}

/// Proximities as a structured array.
pub(crate) fn proximity_array<'py>(py: Python<'py>, found: &[d2m::Proximity]) -> PyResult<Bound<'py, PyAny>> {
    let mut words = vec![0; found.len() * PROXIMITY_WORDS];
    for (proximity, words) in found.iter().zip(words.chunks_exact_mut(PROXIMITY_WORDS)) {
        write_proximity(proximity, words);
    }
    named(py, words, "PROXIMITY")
}

/// Words with the names of a dtype of `d2m_ccd._records`, which takes no copy.
pub(crate) fn named<'py>(py: Python<'py>, words: Vec<u64>, dtype: &str) -> PyResult<Bound<'py, PyAny>> {
    let dtype = py.import("d2m_ccd._records")?.getattr(dtype)?;
    PyArray1::from_vec(py, words).call_method1("view", (dtype,))
}
