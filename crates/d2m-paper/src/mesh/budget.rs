//! What a feature search costs of a query's budget.

use d2m_bvh::{Budget, Exhausted, Meter};

/// The cap without any budget, about a minute of work: tests cost more here than in the default engine, whose cap is
/// [`Budget::HARD_NODE_TESTS`].
pub(crate) const MOST_TESTS: u64 = Budget::HARD_NODE_TESTS >> 4;

/// Pieces of time of one feature search when nothing but their number limits a query, and when it may end at any time.
const MOST_EVALUATIONS: u64 = 1 << 17;
const MOST_EVALUATIONS_IN_A_HURRY: u64 = 1 << 12;

fn is_in_a_hurry(budget: &Budget) -> bool {
    budget.wall_clock.is_some() || budget.cancel.is_some()
}

/// The most pieces of time that one feature search may evaluate.
pub(crate) fn evaluations(meter: &Meter) -> u32 {
    let rest = meter.rest();
    let cap = if is_in_a_hurry(&rest) { MOST_EVALUATIONS_IN_A_HURRY } else { MOST_EVALUATIONS };
    rest.node_tests.unwrap_or(cap).min(cap) as u32
}

/// Takes the pieces of time that a feature search has evaluated off the budget.
pub(crate) fn charge(meter: &mut Meter, evaluations: u32) -> Result<(), Exhausted> {
    meter.spend(u64::from(evaluations));
    if evaluations > 0 { meter.read_clock() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::time::Duration;

    #[test]
    fn evaluations_are_tests() {
        let mut meter = Meter::new(&Budget::UNLIMITED.with_node_tests(9));
        assert_eq!((evaluations(&meter), charge(&mut meter, 7), evaluations(&meter)), (9, Ok(()), 2));
        let mut meter = Meter::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO));
        assert_eq!(charge(&mut meter, 1), Err(Exhausted));
        assert_eq!(u64::from(evaluations(&meter)), MOST_EVALUATIONS_IN_A_HURRY);
    }
}
