//! How exactly contacts are solved.

/// How much more than the precision may be left of bodies that move, at most.
pub(super) const LOOSE: f64 = 1024.0;

/// How exactly the law is to hold.
///
/// ```
/// use d2m_contact::{Accuracy, Company};
/// let simulated = Accuracy { relative: 1e-3, slow: 0.1, company: Company::Crowd, ..Accuracy::exact(1e-8) };
/// assert_eq!((simulated.precision, simulated.aim), (1e-8, 1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// Of rates: what is left of bodies at rest.
    pub precision: f64,
    /// The part of the bodies' mean speed that may be left, no more than 1024 times the precision.
    pub relative: f64,
    /// The part of the precision that is aimed at where bodies rest: what is left of one step is there in the next one.
    pub aim: f64,
    /// What else there is.
    pub company: Company,
    /// What slides slower than this could as well stick.
    pub slow: f64,
    /// What may be left of bodies of a crowd by the impulses that there are.
    pub still: Option<f64>,
    /// What sleeps beside them is woken by other solutions: these aim at that much, too.
    pub beside_sleepers: bool,
}

/// What else there is besides the bodies of a system.
///
/// ```
/// use d2m_contact::{Accuracy, Company};
/// assert_eq!(Accuracy::exact(1e-9).company, Company::Few);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Company {
    /// No more than a few bodies.
    Few,
    /// Many bodies: sweeps come first also where few of them move.
    Crowd,
    /// Many bodies, some of which contacts connect with these, after the step's own solution: what is solved again is solved no more exactly
    /// than that, but ends no flight.
    Heap,
}

impl Accuracy {
    /// Of few bodies: what is left of rates is no more than this wherever such a solution is found, and what can stick does.
    #[must_use]
    pub const fn exact(precision: f64) -> Self {
        let (company, slow) = (Company::Few, f64::INFINITY);
        Self { precision, relative: 0.0, aim: 1.0, company, slow, still: None, beside_sleepers: false }
    }

    pub(super) fn in_crowd(self) -> bool {
        self.company != Company::Few
    }
}
