//! One run: a program for each target with all the switches, then those faults that must be built alone.
use super::Error;
use super::build::Built;
use super::planted::Planted;
use super::program::{End, run_test};
use super::record::{Judged, Outcome, Record};
use super::table::{Change, Mutant};
use super::target::{Kind, Selection, Target};
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A test that takes this many times as long as with the right code hangs.
const PATIENCE: u32 = 20;
/// And at least this long.
const LEAST: Duration = Duration::from_secs(30);
/// A test with the right code that takes longer than this is no test.
const LONGEST: Duration = Duration::from_secs(3600);

/// Targets that are built at once, as arguments of cargo, and the numbers of the mutants that their tests must notice.
struct Group {
    targets: Vec<String>,
    numbers: Vec<usize>,
}

/// A mutant without a switch, after those that spoil the same crate and those of the same target.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Alone<'a> {
    package: &'a str,
    targets: Vec<String>,
    number: usize,
    limit: Duration,
}

/// The mutants of one run and what became of them, shared by the workers.
pub(super) struct Round<'a> {
    source: &'a Path,
    record: Record<'a>,
    mutants: &'a [&'a Mutant],
    /// Of the mutants.
    targets: Vec<Target>,
    /// All of their packages.
    selection: Selection,
    groups: Vec<Group>,
    /// The first group that no worker has taken.
    next: AtomicUsize,
    judged: Mutex<Vec<Judged<'a>>>,
    progress: ProgressBar,
}

impl<'a> Round<'a> {
    /// All of the mutants get their switches; those of which the names are known are not judged.
    pub(super) fn new(
        source: &'a Path,
        record: Record<'a>,
        mutants: &'a [&'a Mutant],
        known: &BTreeSet<String>,
    ) -> Result<Self, Error> {
        let targets: Result<Vec<Target>, Error> =
            mutants.iter().map(|mutant| mutant.target(source)).collect();
        let targets = targets?;
        let selection = Selection::of(&targets);
        let mut kinds: BTreeMap<&Kind, Vec<usize>> = BTreeMap::new();
        let left = |number: &usize| !known.contains(&mutants[*number].name);
        for number in (0..mutants.len()).filter(left) {
            let target = &targets[number];
            kinds.entry(&target.kind).or_default().push(number);
        }
        let group = |(kind, numbers)| Group { targets: selection.arguments(kind), numbers };
        let groups: Vec<Group> = kinds.into_iter().map(group).collect();
        let progress = bar(groups.iter().map(|group| group.numbers.len()).sum());
        let (next, judged) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        Ok(Self { source, record, mutants, targets, selection, groups, next, judged, progress })
    }

    /// Judges every mutant with that many workers, each in a copy of its own.
    pub(super) fn run(self, workers: usize) -> Result<Vec<Judged<'a>>, Error> {
        let alone = Mutex::new(BTreeSet::new());
        let results: Vec<Result<(), Error>> = std::thread::scope(|scope| {
            let (round, alone) = (&self, &alone);
            let work = |worker| scope.spawn(move || round.work(worker, alone));
            let threads: Vec<_> = (0..workers).map(work).collect();
            let lost = |_| Err("a worker panicked".into());
            threads.into_iter().map(|thread| thread.join().unwrap_or_else(lost)).collect()
        });
        self.progress.finish_and_clear();
        results.into_iter().collect::<Result<(), Error>>()?;
        Ok(self.judged.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes groups until there are none left, then mutants that have no switch.
    fn work<'b>(&'b self, worker: usize, alone: &Mutex<BTreeSet<Alone<'b>>>) -> Result<(), Error> {
        let mut planted = Planted::new(self.source, worker, self.mutants)?;
        while let Some(group) = self.groups.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            self.judge_group(&mut planted, group, alone).inspect_err(|_| {
                // The other workers end with what they have.
                self.next.store(self.groups.len(), Ordering::Relaxed);
                locked(alone).clear();
            })?;
        }
        loop {
            let Some(one) = locked(alone).pop_first() else { return Ok(()) };
            self.judge_alone(&planted, &one).inspect_err(|_| locked(alone).clear())?;
        }
    }

    /// Judges the mutants of a target that have a switch, and puts the others aside.
    fn judge_group<'b>(
        &'b self,
        planted: &mut Planted<'_>,
        group: &Group,
        alone: &Mutex<BTreeSet<Alone<'b>>>,
    ) -> Result<(), Error> {
        self.progress.set_message(format!("builds {}", group.targets.join(" ")));
        let programs = planted.programs(&group.targets)?;
        let mut limits: BTreeMap<&str, Option<Duration>> = BTreeMap::new();
        for &number in &group.numbers {
            let mutant = self.mutants[number];
            self.progress.set_message(mutant.name.clone());
            let program = programs.of(&planted.copy, mutant.package_folder())?;
            // The test must pass with the right code first.
            let limit = if let Some(&known) = limits.get(&*mutant.test) {
                known
            } else {
                let begin = Instant::now();
                let end = run_test(&planted.copy, program, mutant, None, LONGEST)?;
                let limit = (end == End::Passed).then(|| LEAST.max(begin.elapsed() * PATIENCE));
                *limits.entry(&mutant.test).or_insert(limit)
            };
            let outcome = match (&mutant.change, limit) {
                (_, None) => Outcome::FailsAnyway,
                (Change::InTest, Some(_)) => Outcome::KilledInTest,
                (Change::Patch { .. }, Some(limit)) if planted.has_switch(number) => {
                    run_test(&planted.copy, program, mutant, Some(number), limit)?.into()
                }
                (Change::Patch { .. }, Some(limit)) => {
                    let (package, targets) = (mutant.package(), self.alone(number));
                    locked(alone).insert(Alone { package, targets, number, limit });
                    continue;
                }
            };
            self.note(number, outcome)?;
        }
        Ok(())
    }

    /// What is built for one mutant: of libraries, whose tests cargo builds all or one package at a time, only its own.
    fn alone(&self, number: usize) -> Vec<String> {
        let target = &self.targets[number];
        match target.kind {
            Kind::Library => Selection::of([target]).arguments(&target.kind),
            Kind::Program(_) | Kind::Test(_) => self.selection.arguments(&target.kind),
        }
    }

    fn judge_alone(&self, planted: &Planted<'_>, one: &Alone<'_>) -> Result<(), Error> {
        let mutant = self.mutants[one.number];
        self.progress.set_message(format!("alone: {}", mutant.name));
        let outcome = match planted.build_alone(one.number, &one.targets)? {
            Built::Programs(programs) => {
                let program = programs.of(&planted.copy, mutant.package_folder())?;
                run_test(&planted.copy, program, mutant, None, one.limit)?.into()
            }
            Built::Refused(refusal) => {
                self.say(&refusal.text);
                Outcome::DoesNotCompile
            }
        };
        self.note(one.number, outcome)
    }

    /// Writes an outcome down at once: what a run found counts although it ends early.
    fn note(&self, number: usize, outcome: Outcome) -> Result<(), Error> {
        let mutant = self.mutants[number];
        let mut judged = locked(&self.judged);
        judged.push(Judged { mutant, outcome });
        self.record.write(&judged)?;
        self.say(&format!("{:<18} {:<56} {}", outcome.word(), mutant.name, mutant.test));
        self.progress.inc(1);
        Ok(())
    }

    fn say(&self, line: &str) {
        if self.progress.is_hidden() {
            println!("{line}");
        } else {
            self.progress.println(line);
        }
    }
}

/// A worker that panics ends the run with an error; what it had locked is whole.
fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn bar(length: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {eta} left  {msg}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let progress = ProgressBar::new(length as u64).with_style(style);
    progress.enable_steady_tick(Duration::from_millis(500));
    progress
}
