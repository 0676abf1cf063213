//! Deliberate faults in `xtask`.
use super::{Mutant, in_test};

pub(super) const MUTANTS: &[Mutant] = &[
    // The evaluation itself.
    in_test("an engine that is late by 1e-6, or misses", "xtask/src/judge/tests.rs::faults_are_found"),
    in_test(
        "accuracy and bench asked of a broken engine",
        "xtask/src/accuracy/broken_answers.rs::a_broken_engine_is_noticed",
    ),
];
