//! Asks, judges, stores.
use super::body::Pair;
use super::catalogue::Entry;
use super::clock::{Phases, processor_seconds};
use super::method::{Method, Question};
use super::row::Row;
use super::store::{KnownPair, Store};
use super::{Options, peers, stopped, sweep};
use crate::TaskResult;
use crate::judge::{Claim, Judge, place};
use crate::machine::Machine;
use crate::statistics::Summary;
use crate::trials::Trial;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// Answers of parry that are compared with the judge's, per pair, speed and method: it is slow.
const PARRY_CHECKS: usize = 4;
/// Triangles of a pair beyond which parry's distance is not asked: one query then takes from seconds to minutes.
const PARRY_TRIANGLES: usize = 20_000;
/// And the paper's method: its trees and queries are made for models of the paper's size.
const PAPER_TRIANGLES: usize = 300_000;
/// How far parry's distance may be from ours: it iterates to a tolerance of about this on its own.
const PARRY_AGREES: f64 = 1e-7;

pub(super) fn run(options: &Options) -> TaskResult {
    let root = crate::workspace_root();
    let machine = Machine::this(&root);
    let store = Store::open(&root, &machine, &options.settings())?;
    let (entries, methods) = (options.entries()?, options.methods()?);
    let begin = Instant::now();
    let mut phases = Phases::default();
    let progress = bar(seconds_left(options, &entries, &methods, &store));
    let mut faults = Vec::new();
    let say = |text: &str| if progress.is_hidden() { println!("{text}") } else { progress.println(text) };
    for entry in &entries {
        progress.set_message(format!("{}: trees", entry.name));
        let pair = phases.time("trees", || entry.load())?;
        let triangles = [pair.a.triangle_count(), pair.b.triangle_count()];
        say(&format!("{} ({} + {} triangles)", pair.name, triangles[0], triangles[1]));
        let speeds = entry.trials.iter().map(|t| t.0).collect();
        store.note_pair(&KnownPair { name: pair.name.clone(), triangles, speeds })?;
        for (speed, trials) in &entry.trials {
            let mut accurate = None;
            for &method in &methods {
                progress.set_message(format!("{} @{speed} {}", pair.name, method.name()));
                let rows = if let Some(rows) = store.load(&pair.name, *speed, method.name()) {
                    rows
                } else {
                    let setting = Setting { options, pair: &pair, speed: *speed, trials, method };
                    let rows = setting.rows(accurate.as_deref(), &mut phases)?;
                    store.save(&pair.name, *speed, method.name(), &rows)?;
                    progress.inc(milliseconds(expected_seconds(options, method, trials.len())));
                    rows
                };
                say(&line(*speed, method, &rows));
                let name = &pair.name;
                let bad = rows.iter().filter(|row| !row.fault.is_empty() && method.is_ours());
                faults.extend(
                    bad.map(|r| format!("{name} @{speed} {} trial {}: {}", method.name(), r.trial, r.fault)),
                );
                if method == Method::Accurate {
                    accurate = Some(rows);
                }
            }
        }
    }
    if options.wants_sweeps() {
        let started = std::cell::Cell::new(false);
        let series = || {
            sweep::run(options, &store, say, |name| {
                progress.set_message(format!("series: {name}"));
                if started.replace(true) {
                    progress.inc(milliseconds(SERIES_SECONDS[usize::from(options.quick)]));
                }
            })
        };
        faults.extend(phases.time("series", series)?);
    }
    progress.finish_and_clear();
    println!(
        "{:.0} s, {:.0} s of processor time of all threads and peers: {}",
        begin.elapsed().as_secs_f64(),
        processor_seconds().unwrap_or(f64::NAN),
        phases.words()
    );
    for fault in faults.iter().take(20) {
        println!("WRONG  {fault}");
    }
    println!("rows in {}; `cargo xtask report` makes tables and figures of them", store.folder.display());
    if faults.is_empty() { Ok(()) } else { Err(format!("{} wrong answers", faults.len()).into()) }
}

/// Seconds of a group of series, in a full and in a quick run, on a machine of 4 GHz.
const SERIES_SECONDS: [f64; 2] = [60.0, 3.0];

/// About how long a method is busy with the trials of one pair and speed. Only the progress bar believes it.
fn expected_seconds(options: &Options, method: Method, trials: usize) -> f64 {
    let judge = if method.is_static() { 0.0 } else { 0.01 * trials as f64 };
    let rest = if method.is_slow() { options.cap() } else { 1e-4 * (options.rounds * trials) as f64 };
    judge + rest
}

/// About how long what the store lacks will take.
fn seconds_left(options: &Options, entries: &[Entry], methods: &[Method], store: &Store) -> f64 {
    let mut seconds = 0.0;
    for entry in entries {
        for (speed, trials) in &entry.trials {
            let open = methods.iter().filter(|m| store.load(&entry.name, *speed, m.name()).is_none());
            seconds += open.map(|&m| expected_seconds(options, m, trials.len())).sum::<f64>();
        }
    }
    if options.wants_sweeps() {
        seconds += sweep::STEPS as f64 * SERIES_SECONDS[usize::from(options.quick)];
    }
    seconds
}

fn milliseconds(seconds: f64) -> u64 {
    (1e3 * seconds) as u64
}

/// A bar over what is expected to take this long; it learns the true pace as it goes.
fn bar(seconds: f64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {percent} %, {eta} left  {msg}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(milliseconds(seconds)).with_style(style)
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

/// One file's worth of questions.
pub(super) struct Setting<'a> {
    pub(super) options: &'a Options,
    pub(super) pair: &'a Pair,
    pub(super) speed: f64,
    pub(super) trials: &'a [Trial],
    pub(super) method: Method,
}

impl Setting<'_> {
    fn rows(&self, accurate: Option<&[Row]>, phases: &mut Phases) -> Result<Vec<Row>, Error> {
        match self.method {
            Method::ParryCast => return phases.time("asked", || stopped::rows(self)),
            Method::AdvanceParry | Method::ParryDistance if self.triangle_count() > PARRY_TRIANGLES => {
                return Ok(Vec::new());
            }
            Method::Paper if self.triangle_count() > PAPER_TRIANGLES => return Ok(Vec::new()),
            _ => {}
        }
        let times_of_contact = self.places(accurate);
        let questions: Vec<(usize, Question<'_>)> = times_of_contact
            .iter()
            .map(|&(i, at)| {
                Ok((
                    i,
                    Question::new(self.pair, &self.trials[i], self.options.tolerance, at)?
                        .with_cap(self.options.cap()),
                ))
            })
            .collect::<Result<_, Error>>()?;
        phases.time("lazy trees", || self.prepare());
        // One thread asks and nothing else runs; only then all threads judge.
        let asked = phases.time("asked", || self.ask(&questions));
        Ok(phases.time("judged", || self.judged(&questions, asked)))
    }

    /// Builds what the method needs of the bodies and others do not.
    fn prepare(&self) {
        for body in [&self.pair.a, &self.pair.b] {
            match self.method {
                Method::Paper => {
                    body.spheres();
                }
                Method::AdvanceParry | Method::ParryIntersection | Method::ParryDistance => {
                    body.parry();
                }
                _ => {}
            }
        }
    }

    fn triangle_count(&self) -> usize {
        self.pair.a.triangle_count() + self.pair.b.triangle_count()
    }

    /// Which trials, and the time for static methods: only those that end in contact.
    fn places(&self, accurate: Option<&[Row]>) -> Vec<(usize, f64)> {
        if !self.method.is_static() {
            return (0..self.trials.len()).map(|i| (i, 0.0)).collect();
        }
        let rows = accurate.unwrap_or_default();
        let contact = |row: &Row| match row.claim {
            Claim::Contact { lo, .. } if row.fault.is_empty() => Some((row.trial, lo)),
            _ => None,
        };
        rows.iter().filter_map(contact).collect()
    }

    /// Answers with the least time of the rounds, until the cap of a slow method.
    fn ask(&self, questions: &[(usize, Question<'_>)]) -> Vec<(Claim, f64)> {
        let slow = self.method.is_slow();
        let rounds = if slow { 1 } else { self.options.rounds.max(1) };
        let begin = Instant::now();
        let mut asked: Vec<(Claim, f64)> = Vec::new();
        for round in 0..rounds {
            for (place, (_, question)) in questions.iter().enumerate() {
                if slow && begin.elapsed().as_secs_f64() > self.options.cap() {
                    break;
                }
                let start = Instant::now();
                let claim = std::hint::black_box(question.ask(self.method));
                let microseconds = start.elapsed().as_secs_f64() * 1e6;
                if round == 0 {
                    asked.push((claim, microseconds));
                } else {
                    asked[place].1 = asked[place].1.min(microseconds);
                }
            }
        }
        asked
    }

    fn judged(&self, questions: &[(usize, Question<'_>)], asked: Vec<(Claim, f64)>) -> Vec<Row> {
        let sabotage = self.options.sabotage.filter(|_| self.method == Method::Accurate);
        let mut rows: Vec<Row> = questions
            .par_iter()
            .zip(asked)
            .map(|((trial, question), (claim, microseconds))| {
                let claim = sabotage.map_or(claim, |fault| fault.spoil(claim));
                let verdict = if self.method.is_static() {
                    Ok(f64::INFINITY)
                } else {
                    self.judge(question.trial).check(&claim, self.method.is_exact())
                };
                let (separation, fault) = match verdict {
                    Ok(separation) => (separation, String::new()),
                    Err(fault) => (f64::INFINITY, fault.to_string()),
                };
                Row { trial: *trial, claim, separation, parry_separation: f64::NAN, microseconds, fault }
            })
            .collect();
        if self.method.is_ours()
            && self.method != Method::AdvanceOwn
            && self.triangle_count() <= PARRY_TRIANGLES
        {
            self.ask_parry(&mut rows);
        }
        rows
    }

    fn judge<'a>(&'a self, trial: &'a Trial) -> Judge<'a> {
        Judge { a: &self.pair.a.boxes, b: &self.pair.b.boxes, trial }
    }

    /// The second opinion on the separation, on some trials.
    fn ask_parry(&self, rows: &mut [Row]) {
        let contacts: Vec<(&mut Row, f64)> = rows
            .iter_mut()
            .filter_map(|row| match row.claim {
                Claim::Contact { lo, .. } if row.separation.is_finite() => Some((row, lo)),
                _ => None,
            })
            .take(PARRY_CHECKS)
            .collect();
        contacts.into_par_iter().for_each(|(row, lo)| {
            let trial = &self.trials[row.trial];
            let (at_a, at_b) = (place(&trial.a, lo), place(&trial.b, lo));
            row.parry_separation = peers::distance(self.pair.a.parry(), self.pair.b.parry(), &at_a, &at_b);
            if (row.parry_separation - row.separation).abs() > PARRY_AGREES {
                row.fault = format!("parry measures a separation of {:.3e}", row.parry_separation);
            }
        });
    }
}
