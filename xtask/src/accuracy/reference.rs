//! The reference method and the engine on the scenes of `d2m_bvh::paper::cross_check`.
use super::{Outcome, Task};
use d2m::bvh::paper;

pub(super) fn run(task: &Task) -> Outcome {
    let found = paper::cross_check(task.count, task.seed);
    Outcome {
        cases: found.scenes,
        contacts: found.contacts,
        undecided: found.undecided.iter().sum(),
        false_negatives: found.complaints,
        false_alarms: Vec::new(),
        by_oracle: 0,
    }
}
