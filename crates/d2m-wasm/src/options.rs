//! Options of queries, as a plain object.

use d2m::bvh::{Budget, ClearanceOptions, MeshTree, QueryOptions, Solid, Window};
use d2m_io::parse_json;
use serde::Deserialize;

/// What counts of bodies that are in contact at the start of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum StartChoice {
    /// It is the first contact.
    Report,
    /// It is let go until the bodies are proven apart.
    Leave,
}

/// The keys have the names and meanings of the command's options and of scene files.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Options {
    window: Option<[f64; 2]>,
    tolerance: Option<f64>,
    min_separation: Option<f64>,
    solid: Option<bool>,
    /// Tests of pairs of nodes.
    budget: Option<u64>,
    pub(crate) clearance: bool,
    pub(crate) accuracy: Option<f64>,
    pub(crate) start: Option<StartChoice>,
    /// Whether the answer is proven again by the verifier.
    pub(crate) verify: bool,
    /// A time: no span of contact that is shorter is examined further.
    pub(crate) resolution: Option<f64>,
}

impl Options {
    /// Of JSON.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let options: Self = parse_json(text.as_bytes()).map_err(|error| format!("options: {error}"))?;
        let limits = [
            ("tolerance", options.tolerance, "a positive finite distance", false),
            ("accuracy", options.accuracy, "a positive finite number", false),
            ("resolution", options.resolution, "a positive finite time", false),
            ("min_separation", options.min_separation, "a finite distance that is not negative", true),
        ];
        for (key, given, wanted, may_be_zero) in limits {
            if let Some(value) = given.filter(|&v| !(v.is_finite() && (v > 0.0 || may_be_zero && v == 0.0))) {
                return Err(format!("{key}: {value} is not {wanted}"));
            }
        }
        Ok(options)
    }

    /// The times of interest: from 0 to 1 unless given.
    pub(crate) fn window(&self) -> Result<Window, String> {
        let [start, end] = self.window.unwrap_or([0.0, 1.0]);
        let window = Window::try_new(start, end).map_err(|error| format!("window: {error}"))?;
        if window.length() <= 0.0 {
            return Err(format!("window: the window from {start:?} to {end:?} is empty"));
        }
        Ok(window)
    }

    /// No clock: on this target only work can be limited.
    pub(crate) fn budget(&self) -> Budget {
        self.budget.map_or(Budget::UNLIMITED, |tests| Budget::UNLIMITED.with_node_tests(tests))
    }

    pub(crate) fn query(&self) -> QueryOptions {
        let mut options = QueryOptions::default().with_budget(self.budget());
        if let Some(tolerance) = self.tolerance {
            options = options.with_tolerance(tolerance);
        }
        options.with_min_separation(self.min_separation.unwrap_or(0.0))
    }

    pub(crate) fn of_clearance(&self) -> ClearanceOptions {
        let mut options = ClearanceOptions::default().with_budget(self.budget());
        options.tolerance = self.query().tolerance;
        options.accuracy = self.accuracy.unwrap_or(options.accuracy);
        options
    }

    /// What counts as a body: solids where the mesh bounds one, unless the caller wants otherwise.
    pub(crate) fn solid(&self, name: &str, tree: &MeshTree) -> Result<Solid, String> {
        match (self.solid, tree.usual_solid()) {
            (Some(true), Solid::Surface) => {
                Err(format!("{name}: the mesh is not watertight, so it bounds no solid: use solid: false"))
            }
            (Some(false), _) => Ok(Solid::Surface),
            (_, usual) => Ok(usual),
        }
    }

    /// Which of the keys were given that not every query has a use for.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("window", self.window.is_some()),
            ("tolerance", self.tolerance.is_some()),
            ("min_separation", self.min_separation.is_some()),
            ("budget", self.budget.is_some()),
            ("clearance", self.clearance),
            ("accuracy", self.accuracy.is_some()),
            ("start", self.start.is_some()),
            ("verify", self.verify),
            ("resolution", self.resolution.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(key, _)| key)
    }

    /// Refuses keys that a query has no use for.
    pub(crate) fn refuse(&self, query: &str, useless: &[&str]) -> Result<(), String> {
        self.given().find(|key| useless.contains(key)).map_or(Ok(()), |key| Err(no_such(query, key)))
    }

    /// For bodies at rest.
    pub(crate) fn refuse_all_but_solid(&self, query: &str) -> Result<(), String> {
        self.given().next().map_or(Ok(()), |key| Err(no_such(query, key)))
    }
}

fn no_such(query: &str, key: &str) -> String {
    format!("{key}: {query} has no such option")
}
