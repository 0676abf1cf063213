//! Hostile families and metamorphic twins of the mesh engine, judged by an oracle in 320 bits that shares no code with it.
//!
//! Each scene is queried, and so are some twins of it: the same scene, expressed differently. Every answer is judged by itself, at
//! times where the construction, the answer, or the answer of a twin puts a contact.
mod exact;
mod families;
mod generic_families;
mod guise;
mod made;
mod scene;
mod shapes;
mod twins;

use super::{Outcome, Task};
use crate::bench::Sabotage;
use crate::judge::MOST_LEFT;
use crate::memory;
use d2m::bvh::Evidence;
use d2m_testing::Xoshiro256 as Random;
use exact::Placed;
use rayon::prelude::*;
use scene::{Answer, HostileScene, TimedAnswer};
use std::path::Path;

/// Twins of each scene.
const TWINS: usize = 3;
/// Distances err by this part of the scene's size: doubles, and some operations on them.
const DISTANCE_ERROR: f64 = 1e-14;

/// Bytes that a search may use, by the documented promise ([`d2m::Budget::HARD_QUEUED_PAIRS`]).
const A_QUERY: u64 = 100 << 20;
/// Bytes for the vertices of a scene of 1e5 triangles in 320 bits, and its candidate pairs.
const AN_ORACLE: u64 = 100 << 20;

/// What is wrong with an answer.
enum Fault {
    /// Contacts missed or late: the promise that must never break.
    Negative(String),
    /// Contacts, or evidence, that are not true.
    Alarm(String),
}

/// One scene with its twins.
struct Case {
    answer: Answer,
    faults: Vec<(Fault, HostileScene)>,
    /// Scenes whose query ended too late after its budget, while other work had the processor too.
    late: Vec<HostileScene>,
}

pub(super) fn run(task: &Task) -> Outcome {
    let before = memory::restart_peak();
    let cases: Vec<(usize, Case)> =
        (0..task.count).into_par_iter().map(|index| (index, case(task, index))).collect();
    // Every thread has one query and its oracle at a time.
    let allowed = before.unwrap_or(0) + rayon::current_num_threads() as u64 * (A_QUERY + AN_ORACLE);
    let peak = memory::peak();
    let mut outcome = Outcome { cases: cases.len(), peak_memory: Some(peak), ..Outcome::default() };
    if peak > allowed {
        outcome.false_alarms.push(format!("{peak} bytes were in use at once, of {allowed} allowed"));
    }
    for (index, case) in cases {
        outcome.contacts += usize::from(matches!(case.answer, Answer::Contact { .. }));
        outcome.undecided += usize::from(matches!(case.answer, Answer::Undecided { .. }));
        let family = families::FAMILIES[index % families::FAMILIES.len()].0;
        let late = case.late.into_iter().filter_map(|scene| {
            // Alone now, and more than once: what is late every time is late by its own work.
            let late = scene.query_often(5).late;
            let words = || format!("{late:?} later than a millisecond after its budget {:?}", scene.budget);
            (!late.is_zero()).then(|| (Fault::Alarm(words()), scene.clone()))
        });
        for (fault, scene) in case.faults.into_iter().chain(late.collect::<Vec<_>>()) {
            let kept = keep(&scene, task.seed, index);
            let line = |words: &str| format!("seed {} case {index} ({family}): {words}{kept}", task.seed);
            match fault {
                Fault::Negative(words) => outcome.false_negatives.push(line(&words)),
                Fault::Alarm(words) => outcome.false_alarms.push(line(&words)),
            }
        }
    }
    outcome
}

/// Writes a failing scene where `cargo xtask accuracy --case FILE` finds it.
fn keep(scene: &HostileScene, seed: u64, index: usize) -> String {
    let folder = crate::workspace_root().join("target/accuracy");
    let name = format!("hostile-{seed}-{index}.json");
    let written = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(folder.join(&name), format!("{:#}\n", scene.to_json())));
    written.map_or_else(
        |error| format!(" (not kept: {error})"),
        |()| format!(" (--case target/accuracy/{name})"),
    )
}

/// `cargo xtask accuracy --case FILE`: asks and judges one scene that was kept.
pub(super) fn replay(path: &Path) -> crate::TaskResult {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let scene = HostileScene::from_json(&value)
        .ok_or_else(|| format!("{}: not a scene of this task", path.display()))?;
    let TimedAnswer { answer, late } = scene.query_often(5);
    println!("{answer:?}");
    if !late.is_zero() {
        return Err(format!("{late:?} later than a millisecond after its budget").into());
    }
    match judge(&scene, &answer, &[]) {
        None => Ok(()),
        Some(Fault::Negative(words) | Fault::Alarm(words)) => Err(words.into()),
    }
}

/// Asks a scene and its twins, for an audit: with a budget of node tests only, since what judges takes time, too.
#[cfg(feature = "audit")]
pub(super) fn ask(seed: u64, index: u64) {
    const MOST_TESTS: u64 = 1 << 15;
    let (scene, mut random) = draw(seed, index as usize);
    let ask = |scene: &HostileScene| {
        let budget = d2m::Budget::UNLIMITED.with_node_tests(MOST_TESTS);
        let _ = HostileScene { budget, ..scene.clone() }.query_often(1);
    };
    ask(&scene);
    for _ in 0..TWINS {
        ask(&twins::twin(&scene, &mut random).0);
    }
}

/// A scene, and what its twins are drawn from.
fn draw(seed: u64, index: usize) -> (HostileScene, Random) {
    let mut random = Random::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(index as u64));
    let family = families::FAMILIES[index % families::FAMILIES.len()].1;
    (family(&mut random), random)
}

fn case(task: &Task, index: usize) -> Case {
    let (scene, mut random) = draw(task.seed, index);
    let TimedAnswer { answer, late: beyond } = scene.query_often(1);
    let answer = spoil(task.sabotage, answer, scene.window);
    let mut faults = Vec::new();
    let mut late = Vec::new();
    if !beyond.is_zero() {
        late.push(scene.clone());
    }
    let mut times = Vec::new();
    for _ in 0..TWINS {
        let (twin, change) = twins::twin(&scene, &mut random);
        let TimedAnswer { answer: said, late: beyond } = twin.query_often(1);
        if !beyond.is_zero() {
            late.push(twin.clone());
        }
        let back = |t: f64| (t - change.time_shift) / change.time_scale;
        let mut brackets_there: Vec<f64> = Vec::new();
        if let Answer::Contact { lo, hi, .. } = said {
            times.extend([back(lo), back(hi)]);
        }
        if let Answer::Contact { lo, hi, .. } = answer {
            brackets_there.extend([change.time(lo), change.time(hi)]);
        }
        if let Some(fault) = judge(&twin, &said, &brackets_there) {
            faults.push((named(fault, change.name), twin.clone()));
        } else if let Some(fault) = compare(&answer, &said, &change) {
            faults.push((named(fault, change.name), twin.clone()));
        }
    }
    if let Some(fault) = judge(&scene, &answer, &times) {
        faults.push((fault, scene));
    }
    Case { answer, faults, late }
}

fn named(fault: Fault, twin: &str) -> Fault {
    match fault {
        Fault::Negative(words) => Fault::Negative(format!("twin \"{twin}\": {words}")),
        Fault::Alarm(words) => Fault::Alarm(format!("twin \"{twin}\": {words}")),
    }
}

fn spoil(sabotage: Option<Sabotage>, answer: Answer, window: [f64; 2]) -> Answer {
    match (sabotage, answer) {
        (Some(Sabotage::Miss), Answer::Contact { .. }) => Answer::Separated,
        (Some(Sabotage::Late(by)), Answer::Contact { lo, hi, separation, tolerance, evidence, .. }) => {
            let later = |t: f64| (t + by * (window[1] - window[0])).min(window[1]);
            Answer::Contact {
                lo: later(lo),
                hi: later(hi),
                separation,
                tolerance,
                evidence,
                starts_apart: true,
            }
        }
        _ => answer,
    }
}

/// Exact twins have the same verdict, and the same times up to the tolerance's share of the clock.
fn compare(answer: &Answer, twin: &Answer, change: &twins::Change) -> Option<Fault> {
    if !(change.is_exact && change.keeps_first) {
        return None;
    }
    match (answer, twin) {
        (
            Answer::Contact { lo, hi, evidence, .. },
            Answer::Contact { lo: low, hi: high, evidence: shown, .. },
        ) => {
            // A bracket that proves a crossing must not end before the other's begins. One that proves nearness may: the
            // tolerances of the two differ where one is given and the other is the default, and what is within a tolerance at
            // one time may still be disjoint later.
            let before = |lo: f64, hi: f64| hi < lo - (lo.abs() + hi.abs()) * 2f64.powi(-48);
            let apart = *evidence == Evidence::Crossing && hi > lo && before(*low, change.time(*hi))
                || *shown == Evidence::Crossing && high > low && before(change.time(*lo), *high);
            apart.then(|| {
                Fault::Alarm(format!(
                    "brackets [{:?}, {:?}] and [{low:?}, {high:?}] exclude each other",
                    change.time(*lo),
                    change.time(*hi)
                ))
            })
        }
        (Answer::Separated, Answer::Contact { evidence: Evidence::Crossing, lo, .. }) => {
            Some(Fault::Alarm(format!("separated, but the twin crosses at {lo:?}")))
        }
        (Answer::Contact { evidence: Evidence::Crossing, lo, .. }, Answer::Separated) => {
            Some(Fault::Negative(format!("separated, but the scene crosses at {:?}", change.time(*lo))))
        }
        _ => None,
    }
}

/// What is wrong with an answer, by the oracle.
fn judge(scene: &HostileScene, answer: &Answer, more: &[f64]) -> Option<Fault> {
    let [start, end] = scene.window;
    let free = answer.free_until(scene.window);
    let is_free = |t: f64| t < free || matches!(answer, Answer::Separated) && t <= end;
    // Fine meshes take the oracle long: fewer times, but always the construction's.
    let many = scene.bodies[0].triangles.len() * scene.bodies[1].triangles.len() < 1 << 17;
    let crowded = (0..if many { 14 } else { 3 }).map(|k| free - (free - start) * 0.1f64.powi(k));
    let even = (0..if many { 6 } else { 1 }).map(|k| start + (free - start) * f64::from(k) / 6.0);
    let ends = [free.next_down(), free.next_down().next_down(), start, end];
    let times = scene.planted.iter().chain(more).copied().chain(ends).chain(crowded).chain(even);
    let mut tested: Vec<f64> =
        times.filter(|&t| t.is_finite() && t >= start && t <= end && is_free(t)).collect();
    tested.sort_by(f64::total_cmp);
    tested.dedup();
    if matches!(answer, Answer::Refused) {
        return None;
    }
    if let Some(t) = tested.into_iter().find(|&t| Placed::new(scene, t).meet()) {
        return Some(Fault::Negative(format!("{answer:?}, and the bodies share points at {t:?}")));
    }
    let Answer::Contact { lo, hi, separation, tolerance, evidence, starts_apart } = *answer else {
        return None;
    };
    if !(lo >= start && hi >= lo && hi <= end) {
        return Some(Fault::Negative(format!("{answer:?} is no bracket of the window")));
    }
    let room = DISTANCE_ERROR * scene.size();
    let at_lo = Placed::new(scene, lo);
    if starts_apart {
        if at_lo.meet() {
            return Some(Fault::Negative(format!("{answer:?}, and the bodies share points at lo")));
        }
        let most = scene.min_separation + MOST_LEFT * tolerance + room;
        if evidence != Evidence::Early {
            let left = at_lo.distance(2.0 * most);
            if left > most {
                return Some(Fault::Alarm(format!("{answer:?}: {left:e} is left at lo")));
            }
            if separation > most {
                return Some(Fault::Alarm(format!(
                    "{answer:?}: the separation stated is more than promised"
                )));
            }
        }
    }
    if evidence == Evidence::Early {
        return None;
    }
    // Some time of the bracket is near: tried at its ends and between.
    let within = scene.min_separation + tolerance + room;
    let near = |t: f64| {
        let placed = Placed::new(scene, t);
        placed.meet() || placed.distance(2.0 * within) <= within
    };
    let near_somewhere = near(hi) || (0..=8).any(|k| near(lo + (hi - lo) * f64::from(k) / 8.0));
    (!near_somewhere).then(|| Fault::Alarm(format!("{answer:?}: nothing is near anywhere in the bracket")))
}

#[cfg(test)]
mod tests;
