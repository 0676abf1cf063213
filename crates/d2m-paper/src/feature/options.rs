//! Options of a feature test of the reference method.

use d2m_interval::Interval;
use d2m_root::SearchLimits;

/// Options of the paper's feature tests.
///
/// ```
/// use d2m_paper::PaperOptions;
/// let options = PaperOptions::DEFAULT.with_tolerance(1e-6).with_evaluations(1000);
/// assert_eq!((options.tolerance, options.evaluations), (1e-6, 1000));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct PaperOptions {
    /// δ, a distance: the bracket of a contact is so short that the features move less than about δ/4 in it. Features
    /// that come closer than δ without meeting may be reported as a contact.
    pub tolerance: f64,
    /// The most pieces of time one search may evaluate.
    pub evaluations: u32,
}

impl PaperOptions {
    /// Tolerance 1e-10, and as many pieces as [`SearchLimits::DEFAULT_EVALUATIONS`].
    pub const DEFAULT: Self = Self { tolerance: 1e-10, evaluations: SearchLimits::DEFAULT_EVALUATIONS };

    /// With this tolerance δ, a distance.
    pub const fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// With this many pieces.
    pub const fn with_evaluations(mut self, evaluations: u32) -> Self {
        self.evaluations = evaluations;
        self
    }

    /// ε_t = δ / 4V for features whose relative speed is at most `speed`.
    pub(crate) fn limits(&self, speed: f64) -> SearchLimits {
        let quotient =
            Interval::point(self.tolerance) / Interval::new(0.0, speed.max(f64::MIN_POSITIVE) * 4.0);
        SearchLimits::new(quotient.lo()).with_evaluations(self.evaluations)
    }
}

impl Default for PaperOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
