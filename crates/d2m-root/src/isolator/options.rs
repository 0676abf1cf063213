//! Limits of the isolator.

/// Limits of [`isolate`](crate::isolate).
///
/// ```
/// let options = d2m_root::IsolatorOptions::new().with_max_evaluations(1000);
/// assert_eq!(options.max_evaluations, 1000);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[must_use]
pub struct IsolatorOptions {
    /// Evaluations and measurements after which the search gives up with a certified time until which all is clear.
    /// The hardest known family (coplanar sliding just above the tolerance) takes about 1200; the default is 2²⁰.
    pub max_evaluations: u32,
    /// The caller knows that there is no contact at the start of the window: it is not measured there (a contact at
    /// the very start would still be found, later).
    pub start_apart: bool,
}

impl IsolatorOptions {
    /// The defaults.
    pub const fn new() -> Self {
        Self { max_evaluations: 1 << 20, start_apart: false }
    }

    /// With another limit of evaluations.
    pub const fn with_max_evaluations(self, max_evaluations: u32) -> Self {
        Self { max_evaluations, ..self }
    }

    /// Without a measurement at the start of the window.
    pub const fn with_start_apart(self) -> Self {
        Self { start_apart: true, ..self }
    }
}

impl Default for IsolatorOptions {
    fn default() -> Self {
        Self::new()
    }
}
