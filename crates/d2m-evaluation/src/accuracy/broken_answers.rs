//! Deliberately broken answers: the judge of the mesh family must notice them, or its silence means nothing.
use super::{Outcome, Task, mesh};
use crate::bench::Sabotage;

/// What the engine's answers are turned into, and its name.
const FAULTS: [(Sabotage, &str); 2] =
    [(Sabotage::Late(1e-6), "contacts late by 1e-6"), (Sabotage::Miss, "contacts called separated")];

/// Fewer cases may hold no contact at all.
const LEAST: usize = 100;

/// A fault that goes unnoticed counts as a false negative of this family.
pub(super) fn run(task: &Task) -> Outcome {
    let mut outcome = Outcome::default();
    for (sabotage, name) in FAULTS {
        let found = mesh::run(&Task {
            count: task.count.max(LEAST),
            seed: task.seed,
            lies: 0,
            sabotage: Some(sabotage),
        });
        outcome.cases += found.cases;
        outcome.contacts += found.contacts;
        outcome.undecided += found.undecided;
        if found.false_negatives.is_empty() && found.false_alarms.is_empty() {
            outcome.false_negatives.push(format!("seed {}: {name}, and the judge is silent", task.seed));
        }
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_engine_is_noticed() {
        let task = Task { count: 100, seed: 1, lies: 0, sabotage: None };
        let found = run(&task);
        assert!(found.false_negatives.is_empty(), "{found:?}");
        assert_eq!(found.cases, 200);
        let right = mesh::run(&task);
        assert!(right.false_negatives.is_empty() && right.false_alarms.is_empty(), "{right:?}");
        assert!(right.contacts > 20, "{right:?}");
        let late = mesh::run(&Task { sabotage: Some(Sabotage::Late(1e-6)), ..task });
        assert!(2 * (late.false_negatives.len() + late.false_alarms.len()) > late.contacts, "{late:?}");
    }
}
