//! parry's nonlinear cast in a process of its own: a query may take minutes and cannot be interrupted, so the
//! process is ended when the time is over.
use super::Options as BenchOptions;
use super::peers;
use super::row::Row;
use super::setting::Setting;
use crate::TaskResult;
use crate::judge::{Claim, Judge};
use rayon::prelude::*;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

type Error = Box<dyn std::error::Error>;

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct StoppedOptions {
    #[command(flatten)]
    bench: BenchOptions,
    #[arg(long)]
    speed: f64,
}

/// The child: a line `ready`, then a line `time microseconds` per trial until it is ended.
pub(crate) fn run(options: &StoppedOptions) -> TaskResult {
    let entries = options.bench.entries()?;
    let entry = entries.first().ok_or("no pair")?;
    let trials = &entry.trials.iter().find(|t| t.0 == options.speed).ok_or("no such speed")?.1;
    let meshes: Vec<peers::Mesh> = entry.meshes()?.iter().map(peers::mesh).collect();
    let (a, b) = (meshes.first().ok_or("no mesh")?, meshes.last().ok_or("no mesh")?);
    let mut out = std::io::stdout().lock();
    writeln!(out, "ready")?;
    for trial in trials {
        let start = Instant::now();
        let hit = std::hint::black_box(peers::cast(a, b, &trial.a, &trial.b));
        let microseconds = start.elapsed().as_secs_f64() * 1e6;
        let time = hit.unwrap_or(f64::INFINITY);
        writeln!(out, "{time:?} {microseconds:?}")?;
        out.flush()?;
    }
    Ok(())
}

/// What the child answers within the cap; the query that it was stopped in counts as undecided.
pub(super) fn rows(setting: &Setting<'_>) -> Result<Vec<Row>, Error> {
    let options = setting.options;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["parry-cast", "--speed", &setting.speed.to_string(), "--pair", &setting.pair.name]);
    command.args(["--seed", &options.seed.to_string(), "--count", &setting.trials.len().to_string()]);
    if let (Some(models), Some(trials)) = (&options.models, &options.trials) {
        command.arg("--models").arg(models).arg("--trials").arg(trials);
    }
    let mut child = command.stdout(Stdio::piped()).spawn()?;
    let lines = BufReader::new(child.stdout.take().ok_or("no output of the child")?).lines();
    let (sender, receiver) = mpsc::channel();
    let reader = std::thread::spawn(move || {
        for line in lines.map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    // Meshes and trees do not count.
    let ready = receiver.recv_timeout(Duration::from_secs(120));
    let deadline = Instant::now() + Duration::from_secs_f64(options.cap());
    let mut answers = Vec::new();
    let mut stopped = None;
    let mut last = Instant::now();
    while ready.is_ok() && answers.len() < setting.trials.len() {
        let left = deadline.saturating_duration_since(Instant::now());
        match receiver.recv_timeout(left) {
            Ok(line) => {
                answers.push(line);
                last = Instant::now();
            }
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
            Err(mpsc::RecvTimeoutError::Timeout) => {
                let claim = Claim::Undecided { clear_until: 0.0 };
                let microseconds = last.elapsed().as_secs_f64() * 1e6;
                stopped =
                    Some(Row::judged(answers.len(), claim, microseconds, Ok::<_, Error>(f64::INFINITY)));
                break;
            }
        }
    }
    // Both fail only when the child has ended by itself.
    let _ = child.kill();
    let _ = child.wait();
    let _ = reader.join();
    if let Err(error) = ready {
        return Err(format!("the process of the peer did not start: {error}").into());
    }
    // Judged only now, so that the judge takes no time from the peer.
    let judged = answers.par_iter().enumerate().filter_map(|(trial, line)| answer(setting, trial, line));
    Ok(judged.collect::<Vec<Row>>().into_iter().chain(stopped).collect())
}

fn answer(setting: &Setting<'_>, trial: usize, line: &str) -> Option<Row> {
    let (time, microseconds) = line.split_once(' ')?;
    let (time, microseconds): (f64, f64) = (time.parse().ok()?, microseconds.parse().ok()?);
    let claim = if time.is_finite() {
        Claim::Contact { lo: time, hi: time, tolerance: 1e-4 }
    } else {
        Claim::Separated
    };
    let judge = Judge { a: &setting.pair.a.boxes, b: &setting.pair.b.boxes, trial: &setting.trials[trial] };
    let known = setting.known.get(trial).copied().unwrap_or_default();
    Some(Row::judged(trial, claim, microseconds, judge.check_after(known, &claim, false)))
}
