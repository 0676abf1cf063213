//! Another unit of time, for pieces that reach far from zero.
use super::Piece;
use d2m_lanes::power_of_two_below;

/// A power of two: times are divided by it, exactly, so that a piece reaches between 1 and 2.
///
/// Only for pieces that reach beyond 1: then coefficients grow by the change of unit, and none underflows. (One that
/// overflows is infinite, and an infinite error bound cuts nothing.)
#[derive(Debug, Clone, Copy)]
pub(super) struct TimeUnit(f64);

impl TimeUnit {
    /// For a piece; `None` if it is not bounded, not beyond 1, or no piece.
    pub(super) fn of(part: Piece) -> Option<Self> {
        let reach = part.reach();
        (part.is_within(f64::MAX) && reach >= 1.0).then(|| Self(power_of_two_below(reach)))
    }

    /// The unit in units of the caller.
    pub(super) fn length(self) -> f64 {
        self.0
    }

    /// Holds the piece: an end that becomes subnormal moves outward.
    pub(super) fn piece(self, part: Piece) -> Piece {
        let (lo, hi) = (part.lo / self.0, part.hi / self.0);
        Piece {
            lo: if lo * self.0 == part.lo { lo } else { lo.next_down() },
            hi: if hi * self.0 == part.hi { hi } else { hi.next_up() },
        }
    }

    /// The part of `whole` that was kept of [`TimeUnit::piece`] of it.
    pub(super) fn restored(self, kept: Piece, whole: Piece) -> Piece {
        let in_units = self.piece(whole);
        Piece {
            lo: if kept.lo > in_units.lo { (kept.lo * self.0).max(whole.lo) } else { whole.lo },
            hi: if kept.hi < in_units.hi { (kept.hi * self.0).min(whole.hi) } else { whole.hi },
        }
    }
}
