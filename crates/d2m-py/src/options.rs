//! Keywords of queries.

use crate::fault::{Fault, OrRaise, Value};
use crate::mesh::tree_argument;
use d2m::bvh::{Budget, MeshTree, Mode, QueryOptions, Solid, Start, Window};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};
use std::sync::Arc;
use std::time::Duration;

/// What most queries take.
pub(crate) struct QueryKeywords<'a> {
    pub(crate) tolerance: Option<f64>,
    pub(crate) min_separation: f64,
    pub(crate) mode: &'a str,
    pub(crate) start: &'a str,
    pub(crate) node_tests: Option<u64>,
    pub(crate) time_limit: Option<f64>,
}

/// The start of queries that say nothing of it.
pub(crate) const REPORT: &str = "report";

impl QueryKeywords<'_> {
    /// The options of the query.
    pub(crate) fn options(&self) -> PyResult<QueryOptions> {
        let mode = match self.mode {
            "accurate" => Mode::Accurate,
            "capoeira" => Mode::Capoeira,
            other => {
                let message = format!("mode is {other:?}: \"accurate\" or \"capoeira\" is expected");
                return Err(Fault::new(message).with_value(Value::Text(other.to_owned())).into());
            }
        };
        let mut options = QueryOptions::default()
            .with_mode(mode)
            .with_start(start(self.start)?)
            .with_min_separation(self.min_separation)
            .with_budget(budget(self.node_tests, self.time_limit).or_raise()?);
        if let Some(tolerance) = self.tolerance {
            options = options.with_tolerance(tolerance);
        }
        Ok(options)
    }
}

/// What counts of bodies that are in contact at the start: "report" or "leave".
pub(crate) fn start(word: &str) -> PyResult<Start> {
    match word {
        REPORT => Ok(Start::Report),
        "leave" => Ok(Start::Leave),
        other => {
            let message = format!("start is {other:?}: \"report\" or \"leave\" is expected");
            Err(Fault::new(message).with_value(Value::Text(other.to_owned())).into())
        }
    }
}

/// One radius for both bodies or a tuple of two; zero where none is given.
pub(crate) fn radii(any: Option<&Bound<'_, PyAny>>) -> PyResult<[f64; 2]> {
    let Some(any) = any.filter(|any| !any.is_none()) else { return Ok([0.0; 2]) };
    match any.cast::<PyTuple>() {
        Ok(pair) => {
            let (a, b): (f64, f64) = pair.extract()?;
            Ok([a, b])
        }
        Err(_) => Ok([any.extract::<f64>()?; 2]),
    }
}

/// Limits on the work.
pub(crate) fn budget(node_tests: Option<u64>, time_limit: Option<f64>) -> Result<Budget, Fault> {
    let mut budget = Budget::UNLIMITED;
    if let Some(count) = node_tests {
        budget = budget.with_node_tests(count);
    }
    if let Some(seconds) = time_limit {
        if seconds.is_nan() || seconds <= 0.0 {
            let message = format!("time_limit is {seconds:?}, a positive number of seconds is expected");
            return Err(Fault::new(message).found(seconds));
        }
        // More than a century is no limit, and the type could not hold it.
        budget = budget.with_wall_clock(Duration::from_secs_f64(seconds.min(3e9)));
    }
    Ok(budget)
}

/// What the two bodies are: by default solid where their meshes are watertight.
pub(crate) fn solids(any: Option<&Bound<'_, PyAny>>, trees: [&MeshTree; 2]) -> PyResult<[Solid; 2]> {
    let [a, b] = trees.map(MeshTree::usual_solid);
    let Some(any) = any else { return Ok([a, b]) };
    if let Ok(pair) = any.cast::<PyTuple>() {
        if pair.len() != 2 {
            return Err(Fault::new(format!("solid has {} elements, 2 are expected", pair.len())).into());
        }
        return Ok([solid(&pair.get_item(0)?, a)?, solid(&pair.get_item(1)?, b)?]);
    }
    Ok([solid(any, a)?, solid(any, b)?])
}

/// The tree of a body, and whether it is solid: by default if its mesh is watertight.
pub(crate) fn body_argument(
    tree: &Bound<'_, PyAny>,
    given: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Arc<MeshTree>, Solid)> {
    let tree = tree_argument(tree)?;
    let usual = tree.usual_solid();
    let solid = given.map_or(Ok(usual), |any| solid(any, usual))?;
    Ok((tree, solid))
}

/// `True` or "filled", `False` or "surface", or `None` for what is usual.
fn solid(any: &Bound<'_, PyAny>, usual: Solid) -> PyResult<Solid> {
    if any.is_none() {
        return Ok(usual);
    }
    if let Ok(filled) = any.extract::<bool>() {
        return Ok(if filled { Solid::Filled } else { Solid::Surface });
    }
    match any.cast::<PyString>().ok().map(|text| text.to_string_lossy().into_owned()).as_deref() {
        Some("filled") => Ok(Solid::Filled),
        Some("surface") => Ok(Solid::Surface),
        _ => Err(PyTypeError::new_err(format!(
            "solid is {}: True, False, \"filled\", \"surface\" or a tuple of two of them is expected",
            any.repr()?
        ))),
    }
}

/// As `solid` takes it.
pub(crate) const fn solid_word(solid: Solid) -> &'static str {
    match solid {
        Solid::Filled => "filled",
        Solid::Surface => "surface",
    }
}

/// The window of a pair of numbers.
pub(crate) fn window((start, end): (f64, f64)) -> PyResult<Window> {
    Window::try_new(start, end).or_raise()
}
