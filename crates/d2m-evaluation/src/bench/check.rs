//! `cargo xtask bench --check`: instructions of fixed pieces of work, counted by callgrind, against a baseline.
//!
//! Instruction counts do not depend on what else the machine does. Each operation is counted with the portable
//! instructions, and those that have a variant for AVX2 once more with it, where valgrind knows all its instructions
//! (3.19 does not know all of them).
use super::counted::{OPERATIONS, Operation};
use crate::TaskResult;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::Command;

type Error = Box<dyn std::error::Error>;

/// A count may be larger than the baseline's by this part.
const TOLERANCE: f64 = 0.02;
/// Relative to the root of the workspace.
const BASELINE: &str = "benches/instructions.csv";

/// Counts of the baseline by operation, and the compiler that they belong to.
#[derive(Debug, Default, PartialEq)]
struct Baseline {
    compiler: String,
    counts: BTreeMap<String, f64>,
}

impl Baseline {
    /// A line `compiler;…`, then lines `operation;instructions`.
    fn parse(text: &str) -> Self {
        let mut baseline = Self::default();
        for (name, value) in text.lines().filter_map(|line| line.split_once(';')) {
            if name == "compiler" {
                baseline.compiler = value.into();
            } else if let Ok(count) = value.parse() {
                baseline.counts.insert(name.into(), count);
            }
        }
        baseline
    }

    fn write(&self) -> String {
        let mut text = format!("compiler;{}\n", self.compiler);
        for (name, count) in &self.counts {
            let _ = writeln!(text, "{name};{count:.0}");
        }
        text
    }
}

/// What a count is against the baseline.
#[derive(Debug, PartialEq)]
enum Finding {
    Fine,
    Better,
    Worse,
    New,
}

fn compare(now: f64, before: Option<f64>) -> Finding {
    match before {
        None => Finding::New,
        Some(before) if now > before * (1.0 + TOLERANCE) => Finding::Worse,
        Some(before) if now < before * (1.0 - TOLERANCE) => Finding::Better,
        Some(_) => Finding::Fine,
    }
}

/// Instructions of one operation; `None` where this valgrind does not know an instruction of the code.
fn count(operation: &Operation, portable: bool) -> Result<Option<f64>, String> {
    let name = operation.name;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*counted_work*")
        .arg(std::env::current_exe().map_err(|e| e.to_string())?)
        .args(["counted", name])
        .args(portable.then_some("--portable"))
        .output()
        .map_err(|e| format!("valgrind: {e}"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    if text.contains("Unrecognised instruction") || text.contains("unhandled instruction") {
        return Ok(None);
    }
    let number = text.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse::<f64>().ok());
    match number {
        Some(number) if output.status.success() && number > 0.0 => {
            Ok(Some(number / operation.repeats() as f64))
        }
        _ => Err(format!("callgrind on {name}: {}", text.lines().last().unwrap_or_default())),
    }
}

/// Counts everything; compares with the baseline, or makes the counts the baseline.
pub(super) fn run(accept: bool) -> TaskResult {
    if Command::new("valgrind").arg("--version").output().is_err() {
        return Err("bench --check counts with valgrind, which is not installed \
            (Debian: apt-get install valgrind; Fedora: dnf install valgrind); nothing was compared"
            .into());
    }
    let root = crate::workspace_root();
    let machine = crate::machine::Machine::this(&root);
    let compiler = format!("{}, {}", machine.rustc, machine.system);
    let baseline = Baseline::parse(&std::fs::read_to_string(root.join(BASELINE)).unwrap_or_default());
    let work: Vec<(&Operation, bool)> = OPERATIONS
        .iter()
        .flat_map(|o| if o.has_variants() { vec![(o, true), (o, false)] } else { vec![(o, true)] })
        .collect();
    let progress = bar(work.len());
    // Counts, not times: they may run in parallel.
    let counted: Vec<Result<Option<f64>, String>> = work
        .par_iter()
        .map(|(operation, portable)| {
            let found = count(operation, *portable);
            progress.inc(1);
            found
        })
        .collect();
    progress.finish_and_clear();
    let mut now = Baseline { compiler: compiler.clone(), counts: BTreeMap::new() };
    let (mut worse, mut new, mut unknown) = (Vec::new(), Vec::new(), Vec::new());
    println!("{:<38} {:>14} {:>14} {:>7}", "operation", "instructions", "baseline", "ratio");
    for ((operation, portable), found) in work.iter().zip(counted) {
        let name = if *portable { operation.name.into() } else { format!("{}, AVX2", operation.name) };
        let Some(count) = found? else {
            unknown.push(name);
            continue;
        };
        let before = baseline.counts.get(&name).copied();
        let finding = compare(count, before);
        let (old, ratio) =
            before.map_or(("–".into(), "–".into()), |b| (format!("{b:.0}"), format!("{:.3}", count / b)));
        let word = match finding {
            Finding::Fine => "",
            Finding::Better => "  better",
            Finding::Worse => "  WORSE",
            Finding::New => "  new",
        };
        println!("{name:<38} {count:>14.0} {old:>14} {ratio:>7}{word}");
        match finding {
            Finding::Worse => worse.push(name.clone()),
            // Which variants can be counted depends on valgrind: they may be missing.
            Finding::New if *portable => new.push(name.clone()),
            Finding::New | Finding::Fine | Finding::Better => {}
        }
        now.counts.insert(name, count);
    }
    if !unknown.is_empty() {
        println!("not counted, this valgrind does not know an instruction of them: {}", unknown.join("; "));
    }
    if accept {
        std::fs::write(root.join(BASELINE), now.write())?;
        println!("accepted: {BASELINE} holds these counts now ({compiler})");
        return Ok(());
    }
    verdict(&baseline, &compiler, &worse, &new).map_err(Error::from)
}

/// Fails for what is worse or unknown; only says so where the counts belong to another compiler.
fn verdict(baseline: &Baseline, compiler: &str, worse: &[String], new: &[String]) -> Result<(), String> {
    println!("allowed: {TOLERANCE} more than the baseline ({})", baseline.compiler);
    let mut complaints = Vec::new();
    if !worse.is_empty() {
        complaints.push(format!("more instructions than allowed: {}", worse.join("; ")));
    }
    if !new.is_empty() {
        complaints.push(format!("no baseline: {} (write it with --accept)", new.join("; ")));
    }
    let complaint = complaints.join(". ");
    if complaint.is_empty() {
        Ok(())
    } else if baseline.compiler == compiler || baseline.compiler.is_empty() {
        Err(complaint)
    } else {
        println!("WARNING  {complaint}");
        println!("this compiler is {compiler}: counts of different compilers differ, so this is no failure");
        Ok(())
    }
}

fn bar(length: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {eta} left  counting instructions");
    ProgressBar::new(length as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_baseline_gives_itself_back() {
        let counts = BTreeMap::from([("accurate gear @4, AVX2".into(), 1234.0), ("kernel".into(), 56.0)]);
        let baseline = Baseline { compiler: "rustc 1.2.3".into(), counts };
        assert_eq!(Baseline::parse(&baseline.write()), baseline);
        assert_eq!(Baseline::parse(""), Baseline::default());
    }

    #[test]
    fn only_more_than_the_tolerance_is_worse() {
        assert_eq!(compare(1019.0, Some(1000.0)), Finding::Fine);
        assert_eq!(compare(1021.0, Some(1000.0)), Finding::Worse);
        assert_eq!(compare(979.0, Some(1000.0)), Finding::Better);
        assert_eq!(compare(1.0, None), Finding::New);
    }

    #[test]
    fn another_compiler_only_warns() {
        let baseline = Baseline { compiler: "rustc 1".into(), counts: BTreeMap::new() };
        let worse = ["kernel".to_string()];
        assert!(verdict(&baseline, "rustc 1", &worse, &[]).is_err());
        assert!(verdict(&baseline, "rustc 1", &[], &worse).is_err());
        assert!(verdict(&baseline, "rustc 2", &worse, &[]).is_ok());
        assert!(verdict(&baseline, "rustc 1", &[], &[]).is_ok());
    }
}
