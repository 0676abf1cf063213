//! Pieces of a motion that follow each other in time.
use d2m_interval::Interval;

/// Pieces at increasing times: `pieces[i]` from `times[i]` to `times[i + 1]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sequence<M> {
    pub(crate) times: Vec<f64>,
    pub(crate) pieces: Vec<M>,
}

impl<M> Sequence<M> {
    /// The piece that begins at or before `t`; the first or last one outside.
    pub(crate) fn index_from(&self, t: f64) -> usize {
        self.times.partition_point(|&time| time <= t).saturating_sub(1).min(self.pieces.len() - 1)
    }

    /// The piece that ends at or after `t`.
    fn index_until(&self, t: f64) -> usize {
        self.times.partition_point(|&time| time < t).saturating_sub(1).min(self.pieces.len() - 1)
    }

    /// The piece of [`Sequence::index_from`].
    pub(crate) fn piece_from(&self, t: f64) -> &M {
        &self.pieces[self.index_from(t)]
    }

    /// From the first to the last time.
    pub(crate) fn domain(&self) -> Interval {
        Interval::new(self.times[0], self.times[self.pieces.len()])
    }

    /// The first time after `t` at which pieces meet.
    pub(crate) fn next_joint(&self, t: f64) -> Option<f64> {
        let index = self.index_from(t);
        (index + 1 < self.pieces.len()).then(|| self.times[index + 1])
    }

    /// A hull over the pieces that have a part of the interval.
    pub(crate) fn over<T>(
        &self,
        t: Interval,
        enclose: impl Fn(&M, Interval) -> T,
        hull: impl Fn(T, T) -> T,
    ) -> T {
        let first = self.index_from(t.lo());
        let last = if t.lo() < t.hi() { self.index_until(t.hi()).max(first) } else { first };
        let part = |index: usize| {
            let lo = if index == first { t.lo() } else { self.times[index] };
            let hi = if index == last { t.hi() } else { self.times[index + 1] };
            enclose(&self.pieces[index], Interval::try_new(lo, hi).unwrap_or(Interval::ENTIRE))
        };
        (first + 1..=last).fold(part(first), |whole, index| hull(whole, part(index)))
    }
}
