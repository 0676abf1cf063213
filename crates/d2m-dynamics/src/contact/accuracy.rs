//! How exactly contacts are solved.

/// How much more than the precision may be left of bodies that move, at most.
pub(super) const LOOSE: f64 = 1024.0;

/// How exactly the law is to hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// Of rates: what is left of bodies at rest.
    pub(crate) precision: f64,
    /// The part of the bodies' mean speed that may be left, no more than [`LOOSE`] times the precision.
    pub(crate) relative: f64,
    /// The part of the precision that is aimed at where bodies rest: what is left of one step is there in the next one.
    pub(crate) aim: f64,
    pub(crate) company: Company,
    /// What slides slower than this could as well stick.
    pub(crate) slow: f64,
    /// What may be left of bodies of a crowd by the impulses that there are.
    pub(crate) still: Option<f64>,
    /// What sleeps beside them is woken by other solutions: these aim at that much, too.
    pub(crate) beside_sleepers: bool,
}

/// What else there is besides the bodies of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Company {
    /// No more than a few bodies.
    Few,
    /// Many bodies: sweeps come first also where few of them move.
    Crowd,
    /// Many bodies, some of which contacts connect with these, after the step's own solution: what is solved again is solved no more exactly
    /// than that, but ends no flight.
    Heap,
}

impl Accuracy {
    pub(super) fn in_crowd(self) -> bool {
        self.company != Company::Few
    }
}
