//! How much a query may still do.

use crate::Budget;
use std::time::Instant;

/// Counts node and feature tests against a [`Budget`].
#[derive(Debug)]
pub(crate) struct Meter {
    left: u64,
    deadline: Option<Instant>,
    until_clock: u32,
}

/// A limit was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exhausted;

/// The cap without any budget, about a minute of work: tests cost more here than in the default engine, whose cap is
/// [`Budget::HARD_NODE_TESTS`].
const MOST_TESTS: u64 = Budget::HARD_NODE_TESTS >> 4;

/// Tests between two readings of the clock.
const CLOCK_STRIDE: u32 = 128;

impl Meter {
    pub(crate) fn new(budget: &Budget) -> Self {
        let left = budget.node_tests.unwrap_or(MOST_TESTS).min(MOST_TESTS);
        let deadline = budget.wall_clock.and_then(|limit| Instant::now().checked_add(limit));
        Self { left, deadline, until_clock: 1 }
    }

    /// Spends one test.
    pub(crate) fn spend(&mut self) -> Result<(), Exhausted> {
        self.left = self.left.checked_sub(1).ok_or(Exhausted)?;
        self.until_clock -= 1;
        if self.until_clock == 0 {
            self.until_clock = CLOCK_STRIDE;
            if self.deadline.is_some_and(|end| Instant::now() >= end) {
                self.left = 0;
                return Err(Exhausted);
            }
        }
        Ok(())
    }

    /// Takes the pieces of time that a feature search has evaluated off the budget.
    pub(crate) fn charge(&mut self, evaluations: u32) {
        self.left = self.left.saturating_sub(u64::from(evaluations));
        if self.deadline.is_some() {
            self.until_clock = 1;
        }
    }

    /// The most pieces of time that one feature search may evaluate.
    pub(crate) fn evaluations(&self) -> u32 {
        let cap = if self.deadline.is_some() { 1 << 12 } else { 1 << 17 };
        self.left.min(cap) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::time::Duration;

    #[test]
    fn counts_and_clock() {
        let mut meter = Meter::new(&Budget::UNLIMITED.with_node_tests(2));
        assert_eq!((meter.spend(), meter.spend(), meter.spend()), (Ok(()), Ok(()), Err(Exhausted)));
        let mut meter = Meter::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO));
        assert_eq!(meter.spend(), Err(Exhausted));
        assert_eq!(meter.evaluations(), 0);
        assert!((0..1000).all(|_| Meter::new(&Budget::UNLIMITED).spend().is_ok()));
    }
}
