//! The deliberate faults, one file a crate, two for the largest. `cargo xtask tidy` checks that each text still occurs exactly once.
mod bvh;
mod bvh_search;
mod cli;
mod dynamics;
mod facade;
mod feature;
mod interval;
mod motion;
mod root;
mod xtask;

/// A fault and the test that must notice it.
pub(crate) struct Mutant {
    pub(crate) name: &'static str,
    pub(crate) change: Change,
    /// `file.rs::test`.
    pub(crate) test: &'static str,
}

/// What is wrong.
#[derive(Clone, Copy)]
pub(crate) enum Change {
    /// In this file this text, which occurs once, becomes that.
    Patch { file: &'static str, from: &'static str, to: &'static str },
    /// The test makes the wrong variant itself and asserts that the same samples refute it.
    InTest,
}

const fn patch(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
    test: &'static str,
) -> Mutant {
    Mutant { name, change: Change::Patch { file, from, to }, test }
}

const fn in_test(name: &'static str, test: &'static str) -> Mutant {
    Mutant { name, change: Change::InTest, test }
}

/// Every deliberate fault, in the order of the layers.
pub(crate) fn all() -> impl Iterator<Item = &'static Mutant> {
    [
        interval::MUTANTS,
        motion::MUTANTS,
        root::MUTANTS,
        feature::MUTANTS,
        bvh::MUTANTS,
        bvh_search::MUTANTS,
        facade::MUTANTS,
        cli::MUTANTS,
        dynamics::MUTANTS,
        xtask::MUTANTS,
    ]
    .into_iter()
    .flatten()
}
