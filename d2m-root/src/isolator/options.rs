//! Limits of the isolator.

/// Limits of [`isolate`](crate::isolate).
///
/// ```
/// let options = d2m_root::IsolatorOptions::new().with_max_evaluations(1000);
/// assert_eq!(options.max_evaluations, 1000);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct IsolatorOptions {
    /// Evaluations and measurements after which the search gives up with a certified time until which all is clear.
    /// The hardest known family (coplanar sliding just above the tolerance) takes about 1200; the default is 2²⁰.
    pub max_evaluations: u32,
}

impl IsolatorOptions {
    /// The defaults.
    pub const fn new() -> Self {
        Self { max_evaluations: 1 << 20 }
    }

    /// With another limit of evaluations.
    pub const fn with_max_evaluations(self, max_evaluations: u32) -> Self {
        Self { max_evaluations }
    }
}

impl Default for IsolatorOptions {
    fn default() -> Self {
        Self::new()
    }
}
