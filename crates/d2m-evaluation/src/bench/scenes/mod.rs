//! Many bodies, and bodies at rest: a row for each figure that scenes are to reach, each answer checked before its time counts.
mod distances;
mod saved;
pub(super) mod threads;
pub(super) mod trees;
mod worlds;

use crate::TaskResult;
use std::time::{Duration, Instant};

/// What a figure should be.
#[derive(Clone, Copy)]
pub(super) enum Target {
    AtMost(f64),
    AtLeast(f64),
    /// Nothing is asked.
    None,
}

/// One line of the table.
struct Figure {
    what: String,
    value: f64,
    unit: &'static str,
    target: Target,
}

impl Figure {
    fn print(&self) {
        let Self { what, value, unit, target } = self;
        let (wanted, reached) = match *target {
            Target::AtMost(most) => (format!("at most {most} {unit}"), *value <= most),
            Target::AtLeast(least) => (format!("at least {least} {unit}"), *value >= least),
            Target::None => (String::new(), true),
        };
        let word = match target {
            Target::None => "",
            _ if reached => "reached",
            _ => "MISSED",
        };
        println!("{what:<86} {value:>9.3} {unit:<6} {wanted:<20} {word}");
    }
}

fn figure(what: impl Into<String>, value: f64, unit: &'static str, target: Target) {
    Figure { what: what.into(), value, unit, target }.print();
}

/// Threads that wait for a processor for more than this part of the time say nothing about a program.
const BUSY: f64 = 0.02;

/// A figure that depends on a machine without other work.
pub(super) struct BusyFigure {
    pub(super) what: String,
    /// On the clock.
    pub(super) value: f64,
    /// The same by the processor time of the thread that works most.
    pub(super) by_processor: f64,
    pub(super) unit: &'static str,
    pub(super) target: Target,
    /// For which part of the time threads of this process waited for a processor.
    pub(super) waited: f64,
}

impl BusyFigure {
    /// Processor time is compared with what is wanted where other work makes threads wait.
    pub(super) fn print(self) {
        let Self { what, value, by_processor, unit, target, waited } = self;
        if waited <= BUSY {
            return figure(what, value, unit, target);
        }
        figure(what, value, unit, Target::None);
        let percent = 100.0 * waited;
        let what =
            format!("  threads waited for {percent:.0} % of the time: by processor time of the busiest one");
        figure(what, by_processor, unit, target);
    }
}

/// The least time of some rounds, with the last answer; `prepare` is not counted.
fn least_time<S, T>(
    rounds: usize,
    mut prepare: impl FnMut() -> S,
    mut work: impl FnMut(&mut S) -> T,
) -> (Duration, T) {
    let mut round = || {
        let mut state = prepare();
        let start = Instant::now();
        let answer = work(&mut state);
        (start.elapsed(), answer)
    };
    let (mut least, mut answer) = round();
    for _ in 1..rounds {
        let (time, again) = round();
        (least, answer) = (least.min(time), again);
    }
    (least, answer)
}

/// The least times of several pieces of work, done in turn so that they meet the same load of the machine; `prepare` is not counted.
fn least_in_turn<S>(
    rounds: usize,
    mut prepare: impl FnMut() -> S,
    works: &mut [&mut dyn FnMut(&mut S)],
) -> Vec<Duration> {
    let mut least = vec![Duration::MAX; works.len()];
    for _ in 0..rounds {
        for (least, work) in least.iter_mut().zip(works.iter_mut()) {
            let mut state = prepare();
            let start = Instant::now();
            work(&mut state);
            *least = start.elapsed().min(*least);
        }
    }
    least
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// `cargo xtask bench --only scenes`.
pub(super) fn run(rounds: usize) -> TaskResult {
    worlds::run(rounds)?;
    distances::run(rounds)?;
    saved::run(rounds)
}

/// An answer that is not right: its time does not count.
pub(super) fn wrong(what: &str) -> Box<dyn std::error::Error> {
    format!("wrong answer: {what}").into()
}
