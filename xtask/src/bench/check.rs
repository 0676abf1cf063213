//! `cargo xtask bench --check`: instructions of fixed sets of queries, counted by callgrind, against a baseline.
//!
//! Instruction counts do not depend on what else the machine does. Valgrind shows the program a processor with AVX2
//! and without AVX-512, so the counts are those of the AVX2 code on any newer x86-64 machine.
use super::body::{Body, Pair};
use super::method::{Method, Question};
use crate::TaskResult;
use crate::trials::{self, Law};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::process::Command;

type Error = Box<dyn std::error::Error>;

/// A count may be larger than the baseline's by this part.
const TOLERANCE: f64 = 0.03;
/// With another compiler than the baseline's.
const TOLERANCE_OF_OTHER_COMPILERS: f64 = 0.15;
/// Relative to the root of the workspace.
const BASELINE: &str = "xtask/instructions.csv";
/// Name of a set, shapes, speed, spin, method.
const SETS: [(&str, [&str; 2], f64, f64, Method); 9] = [
    ("accurate gear @4", ["gear?triangles=476"; 2], 4.0, 3.0, Method::Accurate),
    (
        "accurate pebble @4",
        ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"],
        4.0,
        3.0,
        Method::Accurate,
    ),
    (
        "accurate pebble @512",
        ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"],
        512.0,
        3.0,
        Method::Accurate,
    ),
    (
        "accurate pebble spin 30",
        ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"],
        4.0,
        30.0,
        Method::Accurate,
    ),
    ("accurate knot @4", ["torus-knot?triangles=20000"; 2], 4.0, 3.0, Method::Accurate),
    (
        "Capoeira pebble @4",
        ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"],
        4.0,
        3.0,
        Method::Capoeira,
    ),
    ("collide pebble", ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"], 4.0, 3.0, Method::Collide),
    (
        "distance pebble",
        ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"],
        4.0,
        3.0,
        Method::Distance,
    ),
    (
        "paper's method torus @4",
        ["torus?triangles=1332", "torus?triangles=3240&tube=0.2"],
        4.0,
        3.0,
        Method::Paper,
    ),
];
const QUERIES: usize = 24;

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct SetOptions {
    name: String,
}

/// The program that callgrind watches: one set.
pub(crate) fn run_set(options: &SetOptions) -> TaskResult {
    let set = SETS.iter().find(|set| set.0 == options.name).ok_or("no such set")?;
    let &(name, [a, b], speed, spin, method) = set;
    let a = Body::embedded(a)?;
    let pair = Pair { name: name.into(), b: if b == set.1[0] { a.clone() } else { Body::embedded(b)? }, a };
    let list = trials::generate(&Law { speed, spin, ..Law::PAPER }, 1, QUERIES);
    // Static queries at the middle of the window, where most pairs are near each other.
    let at = (2.05 + 0.4 * speed) / speed;
    let questions: Vec<Question<'_>> =
        list.iter().map(|trial| Question::new(&pair, trial, 1e-10, at)).collect::<Result<_, Error>>()?;
    counted_queries(&questions, method);
    Ok(())
}

/// Callgrind counts inside of this function only, by its name.
#[inline(never)]
fn counted_queries(questions: &[Question<'_>], method: Method) {
    for question in questions {
        black_box(question.ask(black_box(method)));
    }
}

/// Instructions per query of one set; `None` where this version of valgrind does not know an instruction of the code
/// (3.19 and some forms of AVX).
fn count(name: &str) -> Result<Option<f64>, Error> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*counted_queries*")
        .arg(std::env::current_exe()?)
        .args(["counted-set", name])
        .output()?;
    let text = String::from_utf8_lossy(&output.stderr);
    if text.contains("Unrecognised instruction") {
        return Ok(None);
    }
    let number = text.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse::<f64>().ok());
    match number {
        Some(number) if output.status.success() && number > 0.0 => Ok(Some(number / QUERIES as f64)),
        _ => Err(format!("callgrind on {name}: {}", text.lines().last().unwrap_or_default()).into()),
    }
}

/// Compares with the baseline, or writes it.
pub(super) fn run(update: bool) -> TaskResult {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("bench --check: skipped, valgrind is not installed (Debian: apt-get install valgrind)");
        return Ok(());
    }
    let root = crate::workspace_root();
    let compiler = crate::machine::Machine::this(&root).rustc;
    let text = std::fs::read_to_string(root.join(BASELINE)).unwrap_or_default();
    let baseline: BTreeMap<&str, &str> = text.lines().filter_map(|line| line.split_once(',')).collect();
    let same = baseline.get("compiler") == Some(&compiler.as_str());
    let tolerance = if same { TOLERANCE } else { TOLERANCE_OF_OTHER_COMPILERS };
    let mut lines = vec![format!("compiler,{compiler}")];
    let mut worse = Vec::new();
    for (name, ..) in SETS {
        let Some(now) = count(name)? else {
            println!(
                "{name:<26} skipped: this valgrind does not know an instruction of the code; try a newer one"
            );
            continue;
        };
        lines.push(format!("{name},{now:.0}"));
        let before: Option<f64> = baseline.get(name).and_then(|n| n.parse().ok());
        let ratio = before.map_or(f64::NAN, |before| now / before);
        println!("{name:<26} {now:>12.0} instructions a query, {ratio:.3} of the baseline");
        if before.is_none() && !update {
            println!("{name:<26} has no baseline: write one with --update-baseline");
        }
        if ratio > 1.0 + tolerance {
            worse.push(name);
        }
    }
    if update {
        std::fs::write(root.join(BASELINE), lines.join("\n") + "\n")?;
        println!("written to {BASELINE}");
        return Ok(());
    }
    println!("allowed: {:.2} of the baseline", 1.0 + tolerance);
    if worse.is_empty() {
        Ok(())
    } else {
        Err(format!("more instructions than allowed: {}", worse.join(", ")).into())
    }
}
