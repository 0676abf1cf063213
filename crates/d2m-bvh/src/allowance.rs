use crate::Budget;
use std::time::Instant;

/// Steps between two readings of the clock: some microseconds of work.
const STEPS_A_READING: u32 = 64;

/// What is left of the [`Budget`] of a query for what it does besides its search: containment, the state at the start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowance {
    /// Node tests that are left; none: no limit.
    steps: Option<u64>,
    deadline: Option<Instant>,
    until_reading: u32,
}

/// The budget ran out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exhausted;

impl Allowance {
    /// Everything is allowed.
    pub(crate) const fn unlimited() -> Self {
        Self { steps: None, deadline: None, until_reading: STEPS_A_READING }
    }

    /// Any number of steps until a time.
    pub(crate) const fn until(deadline: Option<Instant>) -> Self {
        Self { steps: None, deadline, until_reading: STEPS_A_READING }
    }

    /// Of a query that begins now. A time that the clock cannot count is no limit.
    pub(crate) fn new(budget: &Budget) -> Self {
        let deadline = budget.wall_clock.and_then(|time| Instant::now().checked_add(time));
        Self { steps: budget.node_tests, deadline, until_reading: STEPS_A_READING }
    }

    /// Takes one step, which costs as much as a node test.
    #[inline(always)]
    pub(crate) fn step(&mut self) -> Result<(), Exhausted> {
        if let Some(steps) = &mut self.steps {
            *steps = steps.checked_sub(1).ok_or(Exhausted)?;
        }
        self.until_reading -= 1;
        if self.until_reading == 0 { self.read_clock() } else { Ok(()) }
    }

    /// Reads the clock.
    #[cold]
    pub(crate) fn read_clock(&mut self) -> Result<(), Exhausted> {
        self.until_reading = STEPS_A_READING;
        match self.deadline {
            Some(deadline) if Instant::now() >= deadline => Err(Exhausted),
            _ => Ok(()),
        }
    }

    /// What is left, as a budget.
    pub(crate) fn rest(&self) -> Budget {
        let left = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        Budget { node_tests: self.steps, wall_clock: self.deadline.map(left) }
    }

    /// As much time, but at most so many steps.
    pub(crate) fn at_most(&self, steps: u64) -> Self {
        Self { steps: Some(self.steps.map_or(steps, |left| left.min(steps))), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn steps_and_time_end() {
        let mut few = Allowance::new(&Budget::UNLIMITED.with_node_tests(3));
        assert!((0..3).all(|_| few.step() == Ok(())));
        assert_eq!(few.step(), Err(Exhausted));
        assert_eq!(few.rest(), Budget::UNLIMITED.with_node_tests(0));
        let mut short = Allowance::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO));
        assert_eq!((0..STEPS_A_READING).filter(|_| short.step() == Err(Exhausted)).count(), 1);
        let mut all = Allowance::unlimited();
        assert!((0..10_000).all(|_| all.step().is_ok()));
        assert_eq!(Allowance::unlimited().rest(), Budget::UNLIMITED);
    }
}
