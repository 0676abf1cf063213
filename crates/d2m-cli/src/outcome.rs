//! What a command answered: scripts get it as the exit code with `--exit-status`.

use d2m::bvh::{ClearanceStatus, TimeOfContact};

/// Ends a command that did its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Answered; the exit code does not say what the answer is.
    Answered,
    Contact,
    Separated,
    Undecided,
    /// A given answer is false.
    Refuted,
    /// A given answer could be neither proven nor refuted.
    NotProven,
}

impl Outcome {
    /// The answer itself if the user wants it.
    pub(crate) fn reported(self, exit_status: bool) -> Self {
        if exit_status { self } else { Self::Answered }
    }

    /// The exit code. Clear of those of bad usage (2) and bad input (3), and of those that shells use (126 and more).
    pub(crate) const fn code(self) -> u8 {
        match self {
            Self::Answered => 0,
            Self::Contact => 10,
            Self::Separated => 11,
            Self::Undecided => 12,
            Self::Refuted => 20,
            Self::NotProven => 21,
        }
    }
}

impl From<()> for Outcome {
    fn from((): ()) -> Self {
        Self::Answered
    }
}

impl From<&TimeOfContact> for Outcome {
    fn from(verdict: &TimeOfContact) -> Self {
        match verdict {
            TimeOfContact::Contact(_) => Self::Contact,
            TimeOfContact::Separated => Self::Separated,
            TimeOfContact::Undecided { .. } => Self::Undecided,
        }
    }
}

impl From<ClearanceStatus> for Outcome {
    fn from(status: ClearanceStatus) -> Self {
        match status {
            ClearanceStatus::Clear => Self::Separated,
            ClearanceStatus::Contact => Self::Contact,
            ClearanceStatus::Undecided => Self::Undecided,
        }
    }
}
