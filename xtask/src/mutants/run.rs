//! Builds each mutant, runs the test that must notice it, and says whether it did.
use super::copy::Copy;
use super::record::{Judged, record};
use super::table::{self, Change, Mutant};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

type Error = super::Error;

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct Options {
    /// Only mutants of which the name, the file or the test contains this, or one of these.
    #[arg(long)]
    only: Vec<String>,
    /// Print the table and do nothing.
    #[arg(long)]
    list: bool,
    /// Mutants that are built and asked at the same time, each in its own copy of the sources.
    #[arg(long, default_value = "1")]
    jobs: NonZeroUsize,
}

/// What became of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Passed,
    Failed,
    /// Still running after the limit: a fault that hangs is noticed too.
    Hung,
}

/// What becomes of a mutant that no test notices.
const SURVIVES: &str = "SURVIVES";

/// A test that takes this many times as long as with the right code hangs.
const PATIENCE: u32 = 20;
/// And at least this long.
const LEAST: Duration = Duration::from_secs(120);

/// `cargo xtask mutants`.
pub(super) fn run(options: &Options, root: &Path) -> Result<(), Error> {
    let all = table::read(root)?;
    let wanted = |m: &&Mutant| {
        options.only.is_empty() || options.only.iter().any(|only| m.row().contains(only.as_str()))
    };
    let mutants: Vec<&Mutant> = all.iter().filter(wanted).collect();
    if options.list {
        for mutant in mutants {
            println!("{}", mutant.row());
        }
        return Ok(());
    }
    if mutants.is_empty() {
        return Err("no such mutant (see --list)".into());
    }
    let findings = super::check(root);
    if !findings.is_empty() {
        return Err(findings.join("\n").into());
    }
    let round = Round {
        source: root,
        all: &all,
        mutants,
        next: AtomicUsize::new(0),
        times: Mutex::new(BTreeMap::new()),
        judged: Mutex::new(Vec::new()),
        progress: bar(0),
    };
    round.progress.set_length(round.mutants.len() as u64);
    let copies: Result<Vec<Copy>, Error> =
        (0..options.jobs.get()).map(|worker| Copy::new(root, worker)).collect();
    let copies = copies?;
    let results: Vec<Result<(), Error>> = std::thread::scope(|scope| {
        let workers: Vec<_> = copies.iter().map(|copy| scope.spawn(|| round.work(copy))).collect();
        let lost = |_| Err("a worker panicked".into());
        workers.into_iter().map(|worker| worker.join().unwrap_or_else(lost)).collect()
    });
    round.progress.finish_and_clear();
    results.into_iter().collect::<Result<(), Error>>()?;
    let judged = locked(&round.judged);
    let survivors: Vec<&str> =
        judged.iter().filter(|one| one.word == SURVIVES).map(|one| &*one.mutant.name).collect();
    println!("{} mutants, {} survive", round.mutants.len(), survivors.len());
    if survivors.is_empty() { Ok(()) } else { Err(format!("survivors: {}", survivors.join("; ")).into()) }
}

/// The mutants of one run and what became of them, shared by the workers.
struct Round<'a> {
    source: &'a Path,
    all: &'a [Mutant],
    mutants: Vec<&'a Mutant>,
    /// The first mutant that no worker has taken.
    next: AtomicUsize,
    /// How long each test takes with the right code.
    times: Mutex<BTreeMap<&'a str, Duration>>,
    judged: Mutex<Vec<Judged<'a>>>,
    progress: ProgressBar,
}

impl<'a> Round<'a> {
    /// Takes mutants until there are none left.
    fn work(&self, copy: &Copy) -> Result<(), Error> {
        while let Some(mutant) = self.mutants.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            let word = self.judge(copy, mutant).inspect_err(|_| {
                // The other workers end with the mutants that they have.
                self.next.store(self.mutants.len(), Ordering::Relaxed);
            })?;
            locked(&self.judged).push(Judged { mutant, word });
            // At once: a run takes hours, and what it found counts although it ends early.
            record(self.source, self.all, &locked(&self.judged))?;
            let line = format!("{word:<18} {:<56} {}", mutant.name, mutant.test);
            if self.progress.is_hidden() {
                println!("{line}");
            } else {
                self.progress.println(line);
            }
            self.progress.inc(1);
        }
        Ok(())
    }

    /// What becomes of one mutant. Its test must pass with the right code first.
    fn judge(&self, copy: &Copy, mutant: &'a Mutant) -> Result<&'static str, Error> {
        let known = locked(&self.times).get(mutant.test.as_str()).copied();
        let time = if let Some(time) = known {
            time
        } else {
            self.progress.set_message(format!("right code: {}", mutant.test().name));
            let program = build(copy, mutant)?;
            let begin = Instant::now();
            if run_test(copy, &program, mutant, Duration::from_secs(3600))? != End::Passed {
                return Err(format!("{} fails without any mutant", mutant.test).into());
            }
            let time = begin.elapsed();
            locked(&self.times).insert(&mutant.test, time);
            time
        };
        // A mutant that lives in its test is dead now.
        let Change::Patch { file, from, to } = &mutant.change else { return Ok("killed in the test") };
        self.progress.set_message(mutant.name.clone());
        copy.patch(file, from, to)?;
        let limit = LEAST.max(time * PATIENCE);
        let end = build(copy, mutant).and_then(|program| run_test(copy, &program, mutant, limit));
        copy.restore(file)?;
        Ok(match end.map_err(|e| format!("mutant \"{}\": {e}", mutant.name))? {
            End::Failed => "killed",
            End::Hung => "killed (it hangs)",
            End::Passed => SURVIVES,
        })
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

/// Builds the target in which the test lives. A mutant that does not compile is an error of the table, not a kill.
fn build(copy: &Copy, mutant: &Mutant) -> Result<PathBuf, Error> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["test", "--locked", "--no-run", "--message-format=json"])
        .args(mutant.target(&copy.root)?)
        .current_dir(&copy.root)
        .env("CARGO_TARGET_DIR", &copy.build)
        // Each mutant is built once and asked once: most of the time is the compiler's.
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "1")
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .env_remove("CARGO_MANIFEST_DIR")
        .output()?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let tail: Vec<&str> = text.lines().rev().take(5).collect();
        let tail: Vec<&str> = tail.into_iter().rev().collect();
        return Err(format!("does not compile: {}", tail.join("\n")).into());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let messages = text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let program = messages
        .filter(|m| m["reason"] == "compiler-artifact" && m["profile"]["test"] == true)
        .filter_map(|m| m["executable"].as_str().map(PathBuf::from))
        .next_back();
    program.ok_or_else(|| "cargo names no test program".into())
}

/// Runs the one test.
fn run_test(copy: &Copy, program: &Path, mutant: &Mutant, limit: Duration) -> Result<End, Error> {
    let test = mutant.test().name;
    let folder = copy.root.join(mutant.package_folder());
    let path = copy.build.join("output.txt");
    let output = File::create(&path)?;
    let mut child = Command::new(program)
        .arg(test)
        .current_dir(&folder)
        .env("CARGO_MANIFEST_DIR", &folder)
        .stdout(output.try_clone()?)
        .stderr(output)
        .stdin(Stdio::null())
        .spawn()?;
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if begin.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(End::Hung);
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    if !status.success() {
        // A panic, or an abort (overflow of the stack, a panic while panicking).
        return Ok(End::Failed);
    }
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    // A test that should panic is named so between its name and the result.
    let ended = |line: &str| line.ends_with(" ... ok") && line.contains(&format!("{test} "));
    if text.lines().any(ended) {
        Ok(End::Passed)
    } else {
        Err(format!("{} is not among the tests of its target", mutant.test).into())
    }
}
