//! What a second thread wins, on a machine where others may be at work.
use super::{BusyFigure, Target, wrong};
use crate::TaskResult;
use d2m::{PairContact, Window, World};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// How long to wait until threads that have no work sleep: their times are exact then.
const UNTIL_ASLEEP: Duration = Duration::from_millis(2);

/// What the threads of this process have done so far, in seconds.
#[derive(Clone, Default)]
struct Threads {
    /// On a processor, by the number of the thread.
    running: BTreeMap<u32, f64>,
    /// Ready, but without a processor, all together.
    waiting: f64,
}

impl Threads {
    /// From proc(5)'s schedstat; nothing where there is none.
    fn now() -> Self {
        std::thread::sleep(UNTIL_ASLEEP);
        let mut threads = Self::default();
        for entry in std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten() {
            let number = entry.file_name().to_string_lossy().parse();
            let text = std::fs::read_to_string(entry.path().join("schedstat")).unwrap_or_default();
            let mut seconds = text.split_whitespace().map(|word| word.parse().unwrap_or(0.0) * 1e-9);
            if let (Ok(number), Some(running), Some(waiting)) = (number, seconds.next(), seconds.next()) {
                threads.running.insert(number, running);
                threads.waiting += waiting;
            }
        }
        threads
    }
}

/// What one piece of work has cost, in seconds.
#[derive(Clone, Copy)]
pub(in crate::bench) struct Cost {
    pub(in crate::bench) wall: f64,
    /// Processor time of the thread that worked most.
    pub(in crate::bench) busiest: f64,
    pub(in crate::bench) waiting: f64,
}

pub(in crate::bench) fn measure<T>(work: impl FnOnce() -> T) -> (Cost, T) {
    let before = Threads::now();
    let start = Instant::now();
    let answer = work();
    let wall = start.elapsed().as_secs_f64();
    let after = Threads::now();
    let ran = |(number, time): (&u32, &f64)| time - before.running.get(number).unwrap_or(&0.0);
    let busiest = after.running.iter().map(ran).fold(0.0, f64::max);
    (Cost { wall, busiest, waiting: after.waiting - before.waiting }, answer)
}

/// One thread and two in turn, so that both see the same load of the machine; the least of each counts.
pub(super) fn run(rounds: usize, fresh: &World) -> TaskResult {
    let [one, two] = [1, 2].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build());
    let pools = [one?, two?];
    let mut costs: [Vec<Cost>; 2] = [Vec::new(), Vec::new()];
    let mut answers: [Option<Vec<PairContact>>; 2] = [None, None];
    for _ in 0..4 * rounds {
        for (k, pool) in pools.iter().enumerate() {
            let mut world = fresh.clone();
            let (cost, answer) = measure(|| pool.install(|| world.contacts(Window::UNIT)));
            costs[k].push(cost);
            answers[k] = Some(answer?);
        }
    }
    if answers[0] != answers[1] {
        return Err(wrong("two threads give other bits than one"));
    }
    let least = |k: usize, what: fn(&Cost) -> f64| costs[k].iter().map(what).fold(f64::INFINITY, f64::min);
    let [one, two] = [0, 1].map(|k| least(k, |cost| cost.wall));
    let [one_busiest, two_busiest] = [0, 1].map(|k| least(k, |cost| cost.busiest));
    let sum = |what: fn(&Cost) -> f64| costs.iter().flatten().map(what).sum::<f64>();
    let waited = sum(|cost| cost.waiting) / sum(|cost| cost.wall);
    let count = answers[0].as_ref().map_or(0, Vec::len);
    let what = format!("all {count} contacts of 300 knots ({:.1} ms): one thread over two", one * 1e3);
    let (value, by_processor) = (one / two, one_busiest / two_busiest);
    BusyFigure { what, value, by_processor, unit: "times", target: Target::AtLeast(1.7), waited }.print();
    Ok(())
}
