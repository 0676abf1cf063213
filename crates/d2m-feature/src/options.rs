//! Options of a first-contact query.

/// Features smaller than their reach by more than this factor are worth extended precision.
const FAR: f64 = 1e5;

/// What counts as contact of two features, and when to give up.
///
/// ```
/// use d2m_feature::ContactOptions;
/// let options = ContactOptions::new().with_tolerance(1e-9).with_min_separation(1e-3);
/// assert_eq!(options.tolerance, Some(1e-9));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactOptions {
    /// δ: features within this distance (beyond the separation) may be reported as in contact. `None`: 1e-10 times
    /// the length of the features, and at least 1e-13 times the reach of the motion (unless that is more than 1e5
    /// times the length). It is raised to four times the rounding error where doubles cannot tell.
    pub tolerance: Option<f64>,
    /// Distance at which features count as touching (≥ 0; 0: the features themselves).
    pub min_separation: f64,
    /// Evaluations after which the answer is `Undecided`.
    pub max_evaluations: u32,
}

impl ContactOptions {
    /// The defaults: relative tolerance, no separation, 2²⁰ evaluations.
    pub const fn new() -> Self {
        Self { tolerance: None, min_separation: 0.0, max_evaluations: 1 << 20 }
    }

    /// With an absolute tolerance (a distance, > 0).
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// With a minimum separation (a distance, ≥ 0; NaN and negative values count as 0).
    pub const fn with_min_separation(self, min_separation: f64) -> Self {
        Self { min_separation, ..self }
    }

    /// With another limit of evaluations.
    pub const fn with_max_evaluations(self, max_evaluations: u32) -> Self {
        Self { max_evaluations, ..self }
    }

    /// The tolerance before rounding has its say, for features of a given length and a given reach of the motion.
    pub(crate) fn wanted_tolerance(&self, length: f64, reach: f64) -> f64 {
        let default =
            if reach <= FAR * length { (1e-10 * length).max(1e-13 * reach) } else { 1e-10 * length };
        self.tolerance.unwrap_or(default)
    }

    pub(crate) fn separation(&self) -> f64 {
        self.min_separation.max(0.0)
    }
}

impl Default for ContactOptions {
    fn default() -> Self {
        Self::new()
    }
}
