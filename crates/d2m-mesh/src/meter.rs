use crate::{Budget, CancelFlag};
use std::time::Instant;

/// Steps between two readings of the clock: some microseconds of work.
const STEPS_A_READING: u64 = 64;

/// What a query, or several of them together, may still do of a [`Budget`], and what they have done.
///
/// One step costs as much as a node test.
///
/// ```
/// use d2m_mesh::{Budget, Exhausted, Meter};
/// let mut meter = Meter::new(&Budget::UNLIMITED.with_node_tests(3));
/// meter.spend(2);
/// assert_eq!((meter.step(), meter.step()), (Ok(()), Err(Exhausted)));
/// assert_eq!((meter.spent(), meter.rest().node_tests), (3, Some(0)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Meter {
    /// Steps that were allowed.
    most: Option<u64>,
    spent: u64,
    stop: Stop,
}

/// The budget ran out, or somebody cancelled.
///
/// ```
/// use d2m_mesh::{Budget, Exhausted, Meter};
/// let mut meter = Meter::new(&Budget::UNLIMITED.with_node_tests(2));
/// assert_eq!([meter.step(), meter.step(), meter.step()], [Ok(()), Ok(()), Err(Exhausted)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exhausted;

impl Meter {
    /// Of a query that begins now. A time that the clock cannot count is no limit.
    pub fn new(budget: &Budget) -> Self {
        Self { most: budget.node_tests, spent: 0, stop: Stop::new(budget) }
    }

    /// Everything is allowed.
    pub const fn unlimited() -> Self {
        Self::until(Stop::NEVER)
    }

    /// Any number of steps until then.
    #[inline]
    pub const fn until(stop: Stop) -> Self {
        Self { most: None, spent: 0, stop }
    }

    /// Takes one step, and reads the clock with the first and every 64th after it.
    ///
    /// # Errors
    /// [`Exhausted`] when none is left.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Exhausted> {
        if self.most.is_some_and(|most| self.spent >= most) {
            return Err(Exhausted);
        }
        let is_to_read = self.spent.is_multiple_of(STEPS_A_READING);
        self.spent += 1;
        if is_to_read { self.read_clock() } else { Ok(()) }
    }

    /// Reads the clock, and whether somebody cancelled.
    ///
    /// # Errors
    /// [`Exhausted`] when the time is over.
    #[cold]
    pub fn read_clock(&mut self) -> Result<(), Exhausted> {
        if self.stop.is_due() { Err(Exhausted) } else { Ok(()) }
    }

    /// Counts steps that were taken elsewhere.
    #[inline]
    pub const fn spend(&mut self, steps: u64) {
        self.spent = self.spent.saturating_add(steps);
    }

    /// Steps that were taken.
    #[inline]
    pub const fn spent(&self) -> u64 {
        self.spent
    }

    /// Is nothing left?
    pub fn is_exhausted(&self) -> bool {
        self.steps_left() == Some(0) || self.stop.is_due()
    }

    /// What is left, as a budget.
    pub fn rest(&self) -> Budget {
        self.stop.budget(self.steps_left())
    }

    /// Of the same time, but with at most so many steps from now on.
    pub fn at_most(&self, steps: u64) -> Self {
        let most = Some(self.steps_left().map_or(steps, |left| left.min(steps)));
        Self { most, spent: 0, stop: self.stop }
    }

    fn steps_left(&self) -> Option<u64> {
        self.most.map(|most| most.saturating_sub(self.spent))
    }
}

/// What ends a query from outside: the clock, and whoever cancels it.
///
/// ```
/// use d2m_mesh::{Budget, Stop};
/// use std::time::Duration;
/// assert!(!Stop::NEVER.is_due());
/// assert!(Stop::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO)).is_due());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    deadline: Option<Instant>,
    cancel: Option<CancelFlag>,
}

impl Stop {
    /// Nothing ends it.
    pub const NEVER: Self = Self { deadline: None, cancel: None };

    /// Of a query that begins now.
    pub fn new(budget: &Budget) -> Self {
        let deadline = budget.wall_clock.and_then(|time| Instant::now().checked_add(time));
        Self { deadline, cancel: budget.cancel }
    }

    /// Is it over?
    #[inline(always)]
    pub fn is_due(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.is_cancelled())
            || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// What is left, with so many node tests.
    fn budget(&self, node_tests: Option<u64>) -> Budget {
        let left = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        Budget { node_tests, wall_clock: self.deadline.map(left), cancel: self.cancel }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Canceller;
    use std::time::Duration;

    #[test]
    fn steps_and_time_end() {
        let mut few = Meter::new(&Budget::UNLIMITED.with_node_tests(3));
        assert!((0..3).all(|_| few.step() == Ok(())));
        assert_eq!(few.step(), Err(Exhausted));
        assert_eq!(few.rest(), Budget::UNLIMITED.with_node_tests(0));
        let mut short = Meter::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO));
        assert_eq!((0..STEPS_A_READING).filter(|_| short.step() == Err(Exhausted)).count(), 1);
        let mut all = Meter::unlimited();
        assert!((0..10_000).all(|_| all.step().is_ok()));
        assert_eq!(all.spent(), 10_000);
        assert_eq!(Meter::unlimited().rest(), Budget::UNLIMITED);
    }

    #[test]
    fn a_part_is_never_more_than_what_is_left() {
        let mut meter = Meter::new(&Budget::UNLIMITED.with_node_tests(10));
        meter.spend(7);
        assert_eq!(meter.at_most(2).rest().node_tests, Some(2));
        assert_eq!(meter.at_most(9).rest().node_tests, Some(3));
        meter.spend(u64::MAX);
        assert!(meter.is_exhausted() && meter.rest().node_tests == Some(0));
    }

    #[test]
    fn who_cancels_ends_it() {
        let canceller = Canceller::new();
        let mut meter = Meter::new(&Budget::UNLIMITED.with_cancel(canceller.flag()));
        assert!((0..1000).all(|_| meter.step().is_ok()) && !meter.is_exhausted());
        canceller.cancel();
        assert!((0..STEPS_A_READING).any(|_| meter.step().is_err()) && meter.is_exhausted());
    }
}
