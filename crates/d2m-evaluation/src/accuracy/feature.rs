//! Single feature pairs on planted contacts, the families of d2m-feature's tests. What is clearly right
//! in double-double is passed at once; everything else goes to an oracle of 192 bits.
use super::{Outcome, Task};
use d2m_testing::planted::families::{FAMILIES, Family, Kind};
use d2m_testing::planted::judge::{Tally, enclosed_family, rigid_family, straight_family};
use rayon::prelude::*;

/// Queries of one piece of work.
const CHUNK: u64 = 250;

type Ask = fn(Kind, Family, u64, u64) -> Tally;

/// A point and a triangle, constant twists.
pub(super) fn rigid_vertex_face(task: &Task) -> Outcome {
    run(task, Kind::PointTriangle, rigid_family, |_| true)
}

/// Two edges, constant twists.
pub(super) fn rigid_edge_edge(task: &Task) -> Outcome {
    run(task, Kind::EdgeEdge, rigid_family, |_| true)
}

/// A point and a triangle, any motion.
pub(super) fn enclosed_vertex_face(task: &Task) -> Outcome {
    run(task, Kind::PointTriangle, enclosed_family, |_| true)
}

/// Two edges, any motion.
pub(super) fn enclosed_edge_edge(task: &Task) -> Outcome {
    run(task, Kind::EdgeEdge, enclosed_family, |_| true)
}

/// A point and a triangle, straight vertex paths.
pub(super) fn straight_vertex_face(task: &Task) -> Outcome {
    run(task, Kind::PointTriangle, straight_family, has_straight_twin)
}

/// Two edges, straight vertex paths.
pub(super) fn straight_edge_edge(task: &Task) -> Outcome {
    run(task, Kind::EdgeEdge, straight_family, has_straight_twin)
}

fn has_straight_twin(family: Family) -> bool {
    !matches!(family, Family::Window | Family::Fast)
}

fn run(task: &Task, kind: Kind, ask: Ask, takes_part: fn(Family) -> bool) -> Outcome {
    let families: Vec<Family> = FAMILIES.into_iter().filter(|family| takes_part(*family)).collect();
    let count = (task.count as u64).div_ceil(families.len() as u64);
    let work: Vec<(Family, u64, u64)> = families
        .iter()
        .flat_map(|family| {
            (0..count.div_ceil(CHUNK)).map(move |chunk| (*family, chunk, CHUNK.min(count - chunk * CHUNK)))
        })
        .collect();
    let tallies: Vec<Tally> = work
        .par_iter()
        .map(|(family, chunk, size)| {
            // Distinct for every seed, family and chunk.
            let seed = (task.seed << 40) ^ ((*family as u64) << 32) ^ chunk;
            ask(kind, *family, *size, seed)
        })
        .collect();
    let mut outcome = Outcome::default();
    for tally in tallies {
        outcome.cases += tally.queries as usize;
        outcome.contacts += tally.true_contacts as usize;
        outcome.undecided += tally.undecided as usize;
        outcome.by_oracle += tally.by_oracle as usize;
        outcome.false_negatives.extend(tally.false_negatives);
        outcome.false_alarms.extend(tally.false_positives);
    }
    outcome
}
