//! Questions about the paths and edges of a robot.

use crate::arrays::Doubles;
use crate::fault::{Fault, OrRaise, Value};
use crate::path_answer::{PathAnswer, PathClearance, limit_warning};
use crate::query::run;
use crate::record::EDGE_WORDS;
use crate::resting::named;
use crate::robot::Robot;
use crate::robot_edges::EdgeBatch;
use crate::supervise::{Watch, pool};
use crate::verify::{Verdict, in_growing_steps, ran_out};
use d2m::bvh::{QueryOptions, StartState};
use d2m::verify::{PathVerdict, verify_path};
use d2m_robot::PathAnswer as Found;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashMap;
use std::sync::Arc;

#[pymethods]
impl Robot {
    /// How near does a path come to a contact? `None` where no pair is checked. Arguments as of `check_path`.
    ///
    /// Raises as `check_path`. Returns a `PathClearance`.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF).clearance([0.0, 1.0], [[0.0], [1.0]]) is None
    /// True
    #[pyo3(signature = (times, positions, velocities=None, accelerations=None, *, joints=None))]
    fn clearance(
        &self,
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        accelerations: Option<&Bound<'_, PyAny>>,
        joints: Option<Vec<String>>,
    ) -> PyResult<Option<PathClearance>> {
        let path = self.path(py, [Some(times), Some(positions), velocities, accelerations], joints)?;
        let found = self.ask(py, &Watch::default(), |scene, _| Ok(scene.clearance(&path)?))?;
        Ok(found.map(PathClearance::from))
    }

    /// Proves an answer of `check_path` again, pair by pair, by code that shares no search with the engine; an edge is the path with the times
    /// 0 and 1. `steps`: an end to the work, by default some seconds; other arguments as of `check_path`.
    ///
    /// Raises as `check_path`. Returns a `Verdict`, with the pair of which it is false or was not proven.
    ///
    /// >>> import d2m_ccd
    /// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    /// >>> robot.add_obstacle("wall", "shape:box?x=0.05&y=0.05&z=0.5", [1, 0, 0, 0, 0, 0.7, 0])
    /// >>> free = robot.check_edge([0.0], [1.0])
    /// >>> robot.verify(free, [0.0, 1.0], [[0.0], [1.0]]).status, robot.verify(free, [0.0, 1.0], [[0.0], [3.0]]).status
    /// ('verified', 'refuted')
    #[pyo3(signature = (answer, times, positions, velocities=None, accelerations=None, *, joints=None, steps=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords")]
    fn verify(
        &self,
        py: Python<'_>,
        answer: &Bound<'_, PathAnswer>,
        times: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        accelerations: Option<&Bound<'_, PyAny>>,
        joints: Option<Vec<String>>,
        steps: Option<u64>,
    ) -> PyResult<Verdict> {
        let path = self.path(py, [Some(times), Some(positions), velocities, accelerations], joints)?;
        let answer = &answer.get().found;
        self.ask(py, &Watch::default(), |scene, supervision| {
            let bodies = scene.bodies_along(&path)?;
            let names = |pair: [usize; 2]| pair.map(|body| bodies.name(body));
            let prove = |now: u64| {
                verify_path(&bodies, answer, now).map_err(|fault| {
                    let [a, b] = names(fault.pair);
                    Fault::new(format!("{a:?} and {b:?}: {}", fault.fault))
                })
            };
            let more =
                |found: &PathVerdict| matches!(found, PathVerdict::Pair { verdict, .. } if ran_out(verdict));
            Ok(match in_growing_steps(steps, supervision, prove, more)? {
                PathVerdict::Pair { pair, verdict } => Verdict::of(names(pair), verdict),
                PathVerdict::MeetBefore { pair, clear_until } => {
                    let reason = "let go at the start, they meet again before".to_owned();
                    Verdict::unproven(names(pair), reason, clear_until)
                }
                PathVerdict::OtherBodies => {
                    let reason = "the answer is about other bodies".to_owned();
                    let pair = answer.contact().map_or(["", ""], |found| [&found.a, &found.b]);
                    Verdict::unproven(pair, reason, path.times().map_or(0.0, |[start, _]| start))
                }
                PathVerdict::Verified { steps } => d2m::verify::Verdict::Verified { steps }.into(),
                other => return Err(Fault::new(format!("{other:?}"))),
            })
        })
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
    /// "velocity"), "time", "point" (after which it is), "value", "limit" and "is_certain" (false where the search could not decide; "value" is then
    /// how far beyond it may be). Arguments as of `check_path`.
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
        found.iter().map(|found| limit_warning(py, found)).collect()
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
        let scene = self.scene(py);
        let ask = |options: &QueryOptions| {
            let mut scene = (*scene).clone();
            scene.set_budget(options.budget);
            let names = match &joints {
                Some(names) => names.iter().map(String::as_str).collect(),
                None => scene.robot().joint_names(),
            };
            Ok(scene.edges(&names)?.check(from, to)?)
        };
        let is_decided = |answer: &Found| match answer {
            Found::Undecided { .. } => false,
            Found::Contact(met) => met.contact.start != StartState::Undecided,
            _ => true,
        };
        PathAnswer::of(py, run(py, scene.options(), ask, is_decided)?)
    }

    /// Many edges, on all threads: configurations of shape (n, j) twice.
    ///
    /// Returns a structured array with the fields of `d2m_ccd.EDGE`: those of `d2m_ccd.RESULT`, of the first contact, and `free_until` (1 where
    /// the edge is free), `body_a` and `body_b` (places in `body_names`, -1 where there is none). In order, with the same bits at any
    /// number of threads (`threads`, by default those of the robot). `progress` as of `d2m_ccd.batch`.
    ///
    /// Raises `InputError` whose `index` is the first edge that cannot be checked; `KeyboardInterrupt` on Ctrl-C.
    ///
    /// >>> import numpy, d2m_ccd
    /// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    /// >>> robot.check_edges(numpy.zeros((3, 1)), [[1.0], [2.0], [3.0]])["free_until"].tolist()
    /// [1.0, 1.0, 1.0]
    #[pyo3(signature = (start, end, *, joints=None, threads=None, progress=None))]
    fn check_edges<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: &Bound<'py, PyAny>,
        joints: Option<Vec<String>>,
        threads: Option<usize>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let from = Doubles::new(start, "start", &[None, None])?;
        let shape = from.shape().to_vec();
        let to = Doubles::new(end, "end", &[Some(shape[0]), Some(shape[1])])?;
        let (from, to, width) = (from.slice(), to.slice(), shape[1]);
        let (names, usual) = (self.names(py), self.joint_names(py));
        let places: HashMap<&str, u32> = names.iter().map(String::as_str).zip(0..).collect();
        let mut words = vec![0u64; shape[0] * EDGE_WORDS];
        let watch = Watch { progress, total: shape[0] };
        let out = &mut words;
        let pool = threads.map_or_else(|| Ok(Arc::clone(&self.pool)), |_| self::pool(threads)).or_raise()?;
        self.ask_on(py, &pool, &watch, |scene, supervision| {
            let joints = joints.unwrap_or(usual);
            if joints.len() != width {
                let message = format!("{width} numbers a configuration for {} joints", joints.len());
                return Err(Fault::new(message).with_value(Value::Whole(width as i128)));
            }
            let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
            let edges = scene.edges(&joints)?;
            EdgeBatch { from, to, width, places: &places }.run(&edges, supervision, out)
        })?;
        named(py, words, "EDGE")
    }
}
