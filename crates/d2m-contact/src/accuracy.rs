//! How exactly contacts are solved, and among how many bodies.

/// The residual of moving bodies may be this many times the precision, at most.
pub(super) const LOOSE: f64 = 1024.0;

/// How small the residual of a solution has to be. All but `relative` and `aim` are speeds, in the units of the rates.
///
/// ```
/// use d2m_contact::{Accuracy, Company};
/// let simulated = Accuracy { relative: 1e-3, slow: 0.1, company: Company::Crowd, ..Accuracy::exact(1e-8) };
/// assert_eq!((simulated.precision, simulated.aim), (1e-8, 1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// The residual that bodies at rest may have.
    pub precision: f64,
    /// The residual that moving bodies may have, as a part of their mean speed; at most 1024 times the precision counts.
    pub relative: f64,
    /// Bodies at rest are solved to this part of the precision where possible: errors of one step are still there in the next.
    pub aim: f64,
    /// How many other bodies there are.
    pub company: Company,
    /// Contacts that slide slower than this are tried as sticking ones first.
    pub slow: f64,
    /// Impulses of a crowd with a residual up to this are left as they are.
    pub still: Option<f64>,
    /// The bodies touch others that sleep, which any change of impulses may wake: no residual below `still` is sought.
    pub beside_sleepers: bool,
}

/// How many bodies there are besides those of a system.
///
/// ```
/// use d2m_contact::{Accuracy, Company};
/// assert_eq!(Accuracy::exact(1e-9).company, Company::Few);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Company {
    /// A few.
    Few,
    /// Many: sweeps come first, even in a system of few bodies.
    Crowd,
    /// Many, some of them connected with these by contacts, all of which have been solved once: solving these again need not be more exact than
    /// that was, but no contact may be left closing so fast that it ends a flight.
    Heap,
}

impl Accuracy {
    /// For a few bodies: the residual is at most `precision` wherever such a solution is found, and contacts stick where they can.
    #[must_use]
    pub const fn exact(precision: f64) -> Self {
        let (company, slow) = (Company::Few, f64::INFINITY);
        Self { precision, relative: 0.0, aim: 1.0, company, slow, still: None, beside_sleepers: false }
    }

    /// Is it that of [`Self::exact`]? Flights are tried shorter where there is no solution; who asks for an exact one can try nothing else.
    pub(super) fn is_exact(self) -> bool {
        self.slow == f64::INFINITY
    }

    pub(super) fn in_crowd(self) -> bool {
        self.company != Company::Few
    }
}
