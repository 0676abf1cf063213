//! Options of a first-contact query.
use crate::units::Units;

/// How many times its own length a feature may be from the reference point for the default tolerance to follow that
/// distance. Farther away the position is made in extended precision, and the tolerance keeps to the length.
const FAR: f64 = 1e5;
/// Default tolerance as a part of the length of the features.
const PART_OF_LENGTH: f64 = 1e-10;
/// Default tolerance as a part of the reach of the motion: 900 units in the last place, four times what the rounding of a
/// frame (128·2⁻⁵³ of the reach, docs/theory/features.md) needs.
const PART_OF_REACH: f64 = 1e-13;
/// Default budget: an evaluation takes 0.1 to 0.7 µs, so that the budget ends within half a second also on a slow core.
const EVALUATIONS: u32 = 1 << 19;

/// What counts as contact of two features, and when to give up.
///
/// ```
/// use d2m_feature::ContactOptions;
/// let options = ContactOptions::new().with_tolerance(1e-9).with_min_separation(1e-3);
/// assert_eq!(options.tolerance, Some(1e-9));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ContactOptions {
    /// δ: features within this distance (beyond the separation) may be reported as in contact. `None`: 1e-10 times
    /// the length of the features, and at least 1e-13 times the reach of the motion (unless that is more than 1e5
    /// times the length). It is raised to four times the rounding error where that is larger.
    pub tolerance: Option<f64>,
    /// Distance at which features count as touching (≥ 0; 0: the features themselves).
    pub min_separation: f64,
    /// Evaluations after which the answer is `Undecided` (default 2¹⁹: within a second). Where positions need extended
    /// precision an evaluation counts as 32, for motions that enclose themselves as 8.
    pub max_evaluations: u32,
}

impl ContactOptions {
    /// The defaults: relative tolerance, no separation, 2¹⁹ evaluations.
    pub const fn new() -> Self {
        Self { tolerance: None, min_separation: 0.0, max_evaluations: EVALUATIONS }
    }

    /// With an absolute tolerance (a distance, > 0; what is smaller than rounding needs, and NaN, is raised to that).
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
        let default = if reach <= FAR * length {
            (PART_OF_LENGTH * length).max(PART_OF_REACH * reach)
        } else {
            PART_OF_LENGTH * length
        };
        self.tolerance.unwrap_or(default)
    }

    pub(crate) fn separation(&self) -> f64 {
        self.min_separation.max(0.0)
    }

    /// The same with lengths in other units.
    #[inline(always)]
    pub(crate) fn in_units(&self, units: &Units) -> Self {
        Self {
            tolerance: self.tolerance.map(|tolerance| units.length(tolerance)),
            min_separation: units.length(self.min_separation),
            ..*self
        }
    }

    /// The same where an evaluation costs `cost` times as much: the budget is meant in time.
    pub(crate) fn at_cost(&self, cost: u32) -> Self {
        Self { max_evaluations: self.max_evaluations.div_ceil(cost), ..*self }
    }
}

impl Default for ContactOptions {
    fn default() -> Self {
        Self::new()
    }
}
