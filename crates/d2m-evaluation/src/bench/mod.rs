//! `cargo xtask bench`: the paper's evaluation again, with peers, every answer judged before its time counts.
mod batch;
mod body;
mod built;
mod catalogue;
mod check;
mod clearances;
mod clock;
mod counted;
mod dynamics;
mod engine;
mod method;
mod peers;
mod progress;
mod robots;
mod row;
mod run;
mod scenes;
mod setting;
mod stopped;
mod store;
pub(crate) mod sweep;

pub(crate) use body::Body;
pub(crate) use catalogue::{export, pair_names};
pub(crate) use engine::Sabotage;
pub(crate) use method::Method;
pub(crate) use row::Row;
pub(crate) use store::Store;

use crate::TaskResult;
use catalogue::Entry;
use std::path::PathBuf;

/// How long it takes, for `--help`.
const DURATION: &str = "A whole run (ten pairs, two speeds, 256 trials, all methods, all series) takes about 40 minutes \
    on two quiet cores, with --cap 1 about 20. What matters most comes first: the engine on every pair, the series, the \
    slow peers. It can be stopped at any time: with the same commit, machine and options it goes on where it was, and \
    `cargo xtask report` shows what is there. Queries are timed on one thread while nothing else runs; judging uses all.";

/// A part of a run.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Only {
    Pairs,
    Series,
    /// Many bodies, bodies at rest, saved trees; some minutes.
    Scenes,
    /// `d2m batch` with each form of motion, from file to file, and what a thread of a batch does against single queries; a minute.
    Batch,
    /// How near bodies come that stay apart, against a query that finds only that; on the pairs, a minute.
    Clearances,
}

/// What else than queries can be measured.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    /// Steps of simulations: boxes that fall into a pile, a bolt, gears, a sleeping pile, pebbles and knots; beside rapier a stack, bins, a
    /// double pendulum, fast gears, nested dolls, with the targets of each.
    Dynamics,
    /// Scenes of hard kinds – inclines at their limit, wedges, arches, houses of cards, drums, presses, paddles, chains … – each held against what
    /// must happen by physics, with --cap seconds of the processor each (30); some minutes.
    Kinds,
    /// Construction and refit of trees, one thread and two, beside parry's; the first answer for two meshes; a minute.
    Trees,
    /// Edges of a planner: an arm of seven joints among five obstacles, or the robot of --robot; with --count so many edges a step.
    Robots,
}

#[derive(clap::Args, Clone, Debug)]
#[command(after_help = DURATION)]
pub(crate) struct Options {
    /// Measure this instead of queries.
    subject: Option<Subject>,
    /// With `robots`: this URDF file instead of the arm that is built in.
    #[arg(long, requires = "subject")]
    robot: Option<PathBuf>,
    /// With `robots`: the SRDF file of --robot.
    #[arg(long, requires = "robot")]
    srdf: Option<PathBuf>,
    /// With `dynamics` and `kinds`: only scenes whose name contains one of these.
    #[arg(long, value_delimiter = ',', requires = "subject")]
    scene: Vec<String>,
    /// With `kinds`: write the scenes as files to this folder, for `d2m simulate` and other judges, and run none.
    #[arg(long, value_name = "DIR", requires = "subject")]
    write: Option<PathBuf>,
    /// With `dynamics`: 300 and 1000 boxes, the bin of 1000 and fast gears on a pin too; minutes.
    #[arg(long, requires = "subject")]
    full: bool,
    /// Fewer trials, pairs and sweeps: under two minutes.
    #[arg(long)]
    quick: bool,
    /// Only the pairs, only the series, or, in place of both, scenes, batches or clearances.
    #[arg(long)]
    only: Option<Only>,
    /// Only pairs whose name contains one of these.
    #[arg(long, value_delimiter = ',')]
    pair: Vec<String>,
    /// Only these series, by name.
    #[arg(long, value_delimiter = ',')]
    series: Vec<String>,
    /// Begin nothing new after so many minutes; the same command goes on later.
    #[arg(long, value_parser = crate::positive)]
    minutes: Option<f64>,
    /// Only these methods, by name.
    #[arg(long, value_delimiter = ',')]
    method: Vec<String>,
    /// Trials per pair and speed; 256 as in the paper, 24 with --quick.
    #[arg(long, value_parser = crate::at_least_one)]
    count: Option<usize>,
    /// Times each fast query is asked; the least time counts.
    #[arg(long, default_value_t = 5, value_parser = crate::at_least_one)]
    rounds: usize,
    /// Seed of the trials, and of the scenes of `kinds`.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Tolerance, in units of the models' radius.
    #[arg(long, default_value_t = 1e-10, value_parser = crate::positive)]
    tolerance: f64,
    /// Seconds that a slow method may spend on one pair and speed; what is done by then counts.
    #[arg(long, value_parser = crate::positive)]
    cap: Option<f64>,
    /// Folder of OBJ models, with --trials.
    #[arg(long, requires = "trials")]
    models: Option<PathBuf>,
    /// Folder of trial files `A__B__SPEED.csv`, with --models.
    #[arg(long, requires = "models")]
    trials: Option<PathBuf>,
    /// Count the instructions of fixed pieces of work under callgrind and compare with the baseline: fails if one needs
    /// 2 % more. Measures no times.
    #[arg(long)]
    check: bool,
    /// With --check: make the counts the new baseline, benches/instructions.csv.
    #[arg(long, requires = "check")]
    accept: bool,
    /// A deliberate fault, to see it found: `late=1e-6` or `miss`.
    #[arg(long = "break", hide = true)]
    sabotage: Option<engine::Sabotage>,
}

impl Options {
    fn count(&self) -> usize {
        self.count.unwrap_or(if self.quick { 24 } else { 256 })
    }

    fn cap(&self) -> f64 {
        self.cap.unwrap_or(if self.quick { 0.7 } else { 15.0 })
    }

    /// Whoever names series wants no pairs.
    fn wants_pairs(&self) -> bool {
        self.only != Some(Only::Series) && self.series.is_empty()
    }

    /// Series belong to whole runs on the embedded shapes.
    fn wants_series(&self) -> bool {
        let is_part = !self.pair.is_empty() || !self.method.is_empty() || self.models.is_some();
        self.only == Some(Only::Series) || !self.series.is_empty() || (self.only.is_none() && !is_part)
    }

    /// Everything that the numbers depend on.
    fn settings(&self) -> String {
        format!(
            "quick {}\ncount {}\nrounds {}\nseed {}\ntolerance {:e}\ncap {}\nmodels {:?}\ntrials {:?}\nbreak {:?}\n",
            self.quick,
            self.count(),
            self.rounds,
            self.seed,
            self.tolerance,
            self.cap(),
            self.models.as_ref().and_then(|p| p.file_name()),
            self.trials.as_ref().and_then(|p| p.file_name()),
            self.sabotage,
        )
    }

    fn entries(&self) -> Result<Vec<Entry>, Box<dyn std::error::Error>> {
        let mut entries = match (&self.models, &self.trials) {
            (Some(models), Some(trials)) => catalogue::files(models, trials, self.count())?,
            _ => catalogue::embedded(self.seed, self.count()),
        };
        if !self.pair.is_empty() {
            entries.retain(|entry| self.pair.iter().any(|wanted| entry.name.contains(wanted.as_str())));
        }
        if self.quick && self.pair.is_empty() && self.models.is_none() {
            entries.retain(|entry| catalogue::QUICK.contains(&entry.name.as_str()));
        }
        if entries.is_empty() { Err("no such pair".into()) } else { Ok(entries) }
    }

    fn methods(&self) -> Result<Vec<Method>, String> {
        let find = |name: &String| {
            let found = Method::ALL.into_iter().find(|method| method.name() == name);
            found.ok_or_else(|| format!("no method {name}: {}", Method::ALL.map(Method::name).join(", ")))
        };
        if self.method.is_empty() { Ok(Method::ALL.to_vec()) } else { self.method.iter().map(find).collect() }
    }
}

/// `cargo xtask bench`.
pub(crate) fn run(options: &Options) -> TaskResult {
    let extent = match (options.quick, options.full) {
        (true, _) => dynamics::Extent::Quick,
        (false, true) => dynamics::Extent::Full,
        (false, false) => dynamics::Extent::Usual,
    };
    match (options.subject, options.only) {
        _ if options.check => check::run(options.accept),
        (Some(Subject::Dynamics), _) => dynamics::run(extent, &options.scene),
        (Some(Subject::Kinds), _) => dynamics::kinds::run(options),
        (Some(Subject::Trees), _) => scenes::trees::run(options.rounds),
        (Some(Subject::Robots), _) => robots::run(options),
        (None, Some(Only::Scenes)) => scenes::run(options.rounds),
        (None, Some(Only::Batch)) => batch::run(options.rounds),
        (None, Some(Only::Clearances)) => clearances::run(options),
        (None, _) => run::run(options),
    }
}

pub(crate) use counted::{CountedOptions, run as run_counted};
pub(crate) use stopped::{StoppedOptions, run as run_stopped};
