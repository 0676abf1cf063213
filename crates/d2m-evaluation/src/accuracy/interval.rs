//! Interval arithmetic: every operation of `d2m-interval` on random intervals against exact big-integer arithmetic,
//! the family that the crate's own tests run with a smaller count.
use super::Task;
use d2m_testing::elementary::families;
use rayon::prelude::*;

/// Runs all operations, prints a line for each: a result that loses the exact value is a false negative, one that
/// is wider than promised a false alarm.
pub(crate) fn run(task: &Task) -> super::Outcome {
    let found: Vec<_> =
        families::jobs(task.count as u64, task.seed).into_par_iter().map(|job| job()).collect();
    let mut outcome = super::Outcome::default();
    for operation in found {
        println!(
            "  {:<18} {:>9} tuples, {} lost, at most {} last places too wide (allowed {})",
            operation.name, operation.checked, operation.lost, operation.worst, operation.allowed
        );
        outcome.cases += operation.checked as usize;
        if operation.lost > 0 {
            outcome.false_negatives.push(format!("{}: {}", operation.name, operation.example));
        } else if !operation.passed() {
            outcome.false_alarms.push(format!("{}: {}", operation.name, operation.example));
        }
    }
    outcome
}
