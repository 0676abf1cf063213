//! Random differential families: each operation against the exact reference, end points always among the
//! samples. Called by the tests of `d2m-interval` and by `cargo xtask accuracy interval`.

mod drawn;
mod judged;
mod table;

pub use drawn::Domain;
pub use judged::{Outcome, run_binary, run_unary, run_vectors};
pub use table::{Binary, BinaryOperation, Unary, UnaryOperation, binary, unary};

/// One family, ready to run.
pub type Job = Box<dyn Fn() -> Outcome + Send + Sync>;

/// Every family with `count` tuples (a fiftieth of it where the reference is slow), independent of each other.
pub fn jobs(count: u64, seed: u64) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    let few = count.div_ceil(50);
    for family in binary() {
        let count = if ["atan2", "pow"].contains(&family.name) { few } else { count };
        jobs.push(Box::new(move || run_binary(&family, count, seed)));
    }
    for family in unary() {
        let fast = ["sqr", "sqrt", "recip", "abs", "powi 3", "powi 8", "powi -3"].contains(&family.name);
        let count = if fast { count } else { few };
        jobs.push(Box::new(move || run_unary(&family, count, seed)));
    }
    jobs.push(Box::new(move || run_vectors(count, seed)));
    jobs
}
