//! Where the time of a run goes.
use std::time::{Duration, Instant};

/// Seconds by what they were spent on: on the clock, and of the processor.
#[derive(Default)]
pub(super) struct Phases {
    spent: Vec<(&'static str, Duration, f64)>,
}

impl Phases {
    /// Does the work and adds its time to the phase.
    pub(super) fn time<T>(&mut self, phase: &'static str, work: impl FnOnce() -> T) -> T {
        let (start, before) = (Instant::now(), processor_seconds().unwrap_or_default());
        let result = work();
        self.add(phase, start.elapsed(), processor_seconds().unwrap_or_default() - before);
        result
    }

    fn add(&mut self, phase: &'static str, time: Duration, processor: f64) {
        match self.spent.iter_mut().find(|s| s.0 == phase) {
            Some(spent) => (spent.1, spent.2) = (spent.1 + time, spent.2 + processor),
            None => self.spent.push((phase, time, processor)),
        }
    }

    /// `trees 1.2 s (1.0), asked 3.4 s (3.3)`.
    pub(super) fn words(&self) -> String {
        let word = |(phase, time, processor): &(&str, Duration, f64)| {
            format!("{phase} {:.1} s ({processor:.1})", time.as_secs_f64())
        };
        self.spent.iter().map(word).collect::<Vec<_>>().join(", ")
    }
}

/// Processor time of this process and its ended children, where the system reports it: it does not grow while other
/// work has the processor.
pub(super) fn processor_seconds() -> Option<f64> {
    parse(&std::fs::read_to_string("/proc/self/stat").ok()?)
}

/// Processor time of this thread, where the system reports it: finer than that of the process.
pub(super) fn thread_seconds() -> Option<f64> {
    first_of(&std::fs::read_to_string("/proc/thread-self/schedstat").ok()?)
}

/// In seconds.
const NANOSECOND: f64 = 1e-9;

/// The first number of proc(5)'s schedstat, in nanoseconds.
fn first_of(schedstat: &str) -> Option<f64> {
    Some(schedstat.split_whitespace().next()?.parse::<f64>().ok()? * NANOSECOND)
}

/// Fields 14 to 17 of proc(5)'s stat, in hundredths of a second; the second field may hold spaces.
fn parse(stat: &str) -> Option<f64> {
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = fields.get(11..15)?.iter().map(|f| f.parse::<f64>().ok()).sum::<Option<f64>>()?;
    Some(ticks / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_of_the_processor_time() {
        let stat = "7 (a (b) c) R 1 2 3 4 5 6 7 8 9 10 100 20 30 5 20 0 1";
        assert_eq!(parse(stat), Some(1.55));
        assert_eq!(parse("7 (a) R 1"), None);
        assert_eq!((first_of("1500000000 7 3\n"), first_of("")), (Some(1.5), None));
    }

    #[test]
    fn phases_add_up() {
        let mut phases = Phases::default();
        phases.add("trees", Duration::from_millis(1200), 1.0);
        phases.add("asked", Duration::from_millis(300), 0.3);
        phases.add("trees", Duration::from_millis(800), 1.5);
        assert_eq!(phases.words(), "trees 2.0 s (2.5), asked 0.3 s (0.3)");
    }
}
