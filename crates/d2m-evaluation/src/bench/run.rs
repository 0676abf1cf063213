//! Runs the queries, judges the answers and stores them.
use super::body::Pair;
use super::catalogue::Entry;
use super::clock::{Phases, processor_seconds};
use super::method::Method;
use super::progress::{self, Part, Progress};
use super::row::Row;
use super::setting::Setting;
use super::store::{KnownPair, Store};
use super::{Options, stopped, sweep};
use crate::TaskResult;
use crate::judge::Claim;
use crate::machine::Machine;
use crate::statistics::Summary;
use std::fmt::Write as _;
use std::time::Instant;

pub(super) fn run(options: &Options) -> TaskResult {
    let root = crate::workspace_root();
    let machine = Machine::this(&root);
    let store = Store::open(&root, &machine, &options.settings())?;
    let entries = if options.wants_pairs() { options.entries()? } else { Vec::new() };
    let (methods, steps) = (options.methods()?, sweep::open(options, &store)?);
    let progress = Progress::new(Progress::plan(options, &store, &entries, &methods, &steps));
    let mut run = Run {
        options,
        store: &store,
        methods,
        progress,
        begin: Instant::now(),
        phases: Phases::default(),
        left: 0,
    };
    for part in Part::ALL {
        if part == Part::Series {
            for step in &steps {
                run.step(step)?;
            }
            continue;
        }
        for entry in &entries {
            run.entry(part, entry)?;
        }
    }
    run.end(&entries)
}

/// A run under way.
struct Run<'a> {
    options: &'a Options,
    store: &'a Store,
    methods: Vec<Method>,
    progress: Progress,
    begin: Instant,
    phases: Phases,
    /// Pieces of work that were not begun because the time was over.
    left: usize,
}

impl Run<'_> {
    /// Is there time for one more piece of work?
    fn has_time(&mut self) -> bool {
        let has =
            self.options.minutes.is_none_or(|minutes| self.begin.elapsed().as_secs_f64() < 60.0 * minutes);
        self.left += usize::from(!has);
        has
    }

    /// One pair in one part of the run. Nothing is loaded when all is done already.
    fn entry(&mut self, part: Part, entry: &Entry) -> TaskResult {
        let open = progress::open(self.store, entry, part, &self.methods);
        let mut pair = None;
        if !open.is_empty() {
            if !self.has_time() {
                return Ok(());
            }
            let seconds = progress::tree_seconds(entry);
            self.progress.begin(part, &format!("{}: trees", entry.name), seconds);
            let loaded = self.phases.time("trees", || entry.load())?;
            self.progress.done(seconds);
            let triangles = [loaded.a.triangle_count(), loaded.b.triangle_count()];
            self.progress.say(&format!("{} ({} + {} triangles)", loaded.name, triangles[0], triangles[1]));
            let speeds = entry.trials.iter().map(|t| t.0).collect();
            self.store.note_pair(&KnownPair { name: loaded.name.clone(), triangles, speeds })?;
            pair = Some(loaded);
        }
        for place in 0..entry.trials.len() {
            for method in self.methods.clone() {
                if part.asks(method) {
                    self.rows(part, entry, (place, method), pair.as_ref())?;
                }
            }
        }
        Ok(())
    }

    /// Asks one method at one speed, unless the store has its rows.
    fn rows(
        &mut self,
        part: Part,
        entry: &Entry,
        (place, method): (usize, Method),
        pair: Option<&Pair>,
    ) -> TaskResult {
        let (speed, trials) = &entry.trials[place];
        let stored = self.store.load(&entry.name, *speed, method.name());
        let (None, Some(pair)) = (stored, pair) else { return Ok(()) };
        if !self.has_time() {
            return Ok(());
        }
        let seconds = progress::ask_seconds(self.options, method, trials.len());
        self.progress.begin(part, &format!("{} @{speed} {}", entry.name, method.name()), seconds);
        let accurate = self.store.load(&entry.name, *speed, Method::Accurate.name());
        let known = self.known(entry, place);
        let setting = Setting { options: self.options, pair, speed: *speed, trials, method, known: &known };
        let rows = match method {
            Method::ParryCast => self.phases.time("asked", || stopped::rows(&setting))?,
            _ => setting.rows(accurate.as_deref(), &mut self.phases)?,
        };
        self.store.save(&entry.name, *speed, method.name(), &rows)?;
        self.progress.done(seconds);
        self.progress.say(&line(*speed, method, &rows));
        Ok(())
    }

    /// For each trial, up to when the answers in the store that were found right say it is free.
    fn known(&self, entry: &Entry, place: usize) -> Vec<f64> {
        let (speed, trials) = &entry.trials[place];
        let mut known = vec![0.0; trials.len()];
        for method in Method::ALL.into_iter().filter(|m| !m.is_static()) {
            let rows = self.store.load(&entry.name, *speed, method.name()).unwrap_or_default();
            for row in rows.iter().filter(|row| row.fault.is_empty()) {
                known[row.trial] = row.claim.free_until().max(known[row.trial]);
            }
        }
        known
    }

    fn step(&mut self, step: &sweep::Step) -> TaskResult {
        if !self.has_time() {
            return Ok(());
        }
        self.progress.begin(Part::Series, &format!("series {step}"), step.seconds);
        let say = |text: &str| self.progress.say(text);
        self.phases.time("series", || sweep::measure(self.options, self.store, step, say))?;
        self.progress.done(step.seconds);
        Ok(())
    }

    /// Answers of ours that were found wrong, in this run or in the one that it goes on with.
    fn faults(&self, entries: &[Entry]) -> Vec<String> {
        let mut faults: Vec<String> = sweep::wrong(self.store).lines().map(String::from).collect();
        for entry in entries {
            for (speed, _) in &entry.trials {
                for method in self.methods.iter().filter(|m| m.is_ours()) {
                    let rows = self.store.load(&entry.name, *speed, method.name()).unwrap_or_default();
                    let place = format!("{} @{speed} {}", entry.name, method.name());
                    let bad = rows.iter().filter(|row| !row.fault.is_empty());
                    faults.extend(bad.map(|row| format!("{place} trial {}: {}", row.trial, row.fault)));
                }
            }
        }
        faults
    }

    /// Sums up, and fails if an answer was wrong.
    fn end(self, entries: &[Entry]) -> TaskResult {
        self.progress.end();
        let faults = self.faults(entries);
        println!(
            "{:.0} s, {:.0} s of processor time of all threads and peers: {}",
            self.begin.elapsed().as_secs_f64(),
            processor_seconds().unwrap_or(f64::NAN),
            self.phases.words()
        );
        for fault in faults.iter().take(20) {
            println!("WRONG  {fault}");
        }
        if self.left > 0 {
            println!("the time is over before the work is done; the same command goes on with the rest");
        }
        println!(
            "rows in {}; `cargo xtask report` makes tables and figures of them",
            self.store.folder.display()
        );
        if faults.is_empty() { Ok(()) } else { Err(format!("{} wrong answers", faults.len()).into()) }
    }
}

/// A line for the terminal.
fn line(speed: f64, method: Method, rows: &[Row]) -> String {
    let times = Summary::of(rows.iter().filter(|r| r.fault.is_empty()).map(|r| r.microseconds));
    let left = Summary::of(rows.iter().map(|r| r.separation));
    let contacts = rows.iter().filter(|r| matches!(r.claim, Claim::Contact { .. })).count();
    let wrong = rows.iter().filter(|r| !r.fault.is_empty()).count();
    let mut text =
        format!("  @{speed:<4} {:<26} {:>4} asked {contacts:>4} contacts", method.title(), rows.len());
    if let Some(t) = times {
        let _ = write!(text, "  {:>10.1} µs median  {:>10.1} worst", t.median, t.worst);
    }
    if let (Some(s), false) = (left, method.is_static()) {
        let _ = write!(text, "  separation {:.1e} … {:.1e}", s.least, s.worst);
    }
    if wrong > 0 {
        let _ = write!(text, "  {wrong} WRONG");
    }
    text
}
