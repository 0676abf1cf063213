//! `cargo xtask bench dynamics`: what a step of a simulation costs. Each run is judged before its times count.
mod judge;
mod measure;
mod peer;
mod scene;

use crate::TaskResult;
use crate::figure::{Axis, LinePlot, Series};
use crate::machine::Machine;
use crate::statistics::{Summary, exponent};
use measure::Run;
use scene::Scene;
use std::fmt::Write as _;
use std::path::Path;

const HEADER: &str =
    "scene,by,threads,bodies,triangles,steps,simulated_s,wall_s,real_time,median_us,worst_us,events,fault";

/// Numbers of boxes of the figure.
const QUICK: &[usize] = &[10, 30];
const USUAL: &[usize] = &[10, 30, 100];
const FULL: &[usize] = &[10, 30, 100, 300, 1000];

/// Triangles of the bolt at least. With 2000 its facets and those of the nut interlock, and the screw rests in the nut.
const BOLT: usize = 5000;

/// Which runs are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    Quick,
    Usual,
    Full,
}

/// Runs everything, prints a line each; the table and the figure go to `.bench/dynamics`.
pub(super) fn run(extent: Extent) -> TaskResult {
    let root = crate::workspace_root();
    let folder = root.join(".bench/dynamics");
    std::fs::create_dir_all(&folder)?;
    let machine = serde_json::to_string_pretty(&Machine::this(&root))?;
    let (counts, triangles, threads): (&[usize], usize, &[usize]) = match extent {
        Extent::Quick => (QUICK, 2000, &[1]),
        Extent::Usual => (USUAL, 5000, &[1, 2]),
        Extent::Full => (FULL, 5000, &[1, 2]),
    };
    let mut rows = Vec::new();
    for &count in counts {
        rows.push(note(peer::boxes(count)));
        for &threads in threads {
            rows.push(note(measure::run(Scene::boxes(count)?, threads)?));
        }
    }
    for &threads in threads {
        rows.push(note(measure::run(Scene::bolt(triangles.max(BOLT))?, threads)?));
        rows.push(note(measure::run(Scene::gears(triangles)?, threads)?));
        rows.push(note(measure::run(Scene::sleeping(counts[counts.len() - 1].min(100))?, threads)?));
        rows.push(note(measure::run(Scene::crowd(counts[counts.len() - 1].min(50), triangles)?, threads)?));
    }
    let table = rows.iter().fold(format!("{HEADER}\n"), |text, run| text + &run.line() + "\n");
    std::fs::write(folder.join("dynamics.csv"), table)?;
    std::fs::write(folder.join("measured-on.json"), machine)?;
    draw(&rows, &folder.join("dynamics.svg"))?;
    println!("table and figure in {}", folder.display());
    let faults = rows.iter().filter(|run| !run.fault.is_empty()).count();
    if faults == 0 { Ok(()) } else { Err(format!("{faults} runs were judged wrong").into()) }
}

/// Prints a line for the terminal.
fn note(run: Run) -> Run {
    let mut text = format!(
        "{:<22} {:<7} {} thread: {:>4} bodies of {:>5} triangles",
        run.scene, run.by, run.threads, run.bodies, run.triangles
    );
    if let Some(time) = Summary::of(run.microseconds.iter().copied()) {
        let _ = write!(text, "  {:>9.1} µs a step (median), {:>9.1} worst", time.median, time.worst);
    }
    let _ = write!(text, "  {:>7.2} × real time", run.real_time());
    if !run.fault.is_empty() {
        let _ = write!(text, "  WRONG: {}", run.fault);
    }
    println!("{text}");
    run
}

/// Cost of a step against the number of boxes, of runs that were judged right.
fn draw(rows: &[Run], path: &Path) -> TaskResult {
    let sound = || rows.iter().filter(|run| run.scene.starts_with("boxes") && run.fault.is_empty());
    let mut names: Vec<(&str, usize)> = sound().map(|run| (run.by, run.threads)).collect();
    names.sort_unstable();
    names.dedup();
    let mut series = Vec::new();
    for (by, threads) in names {
        let of_name = sound().filter(|run| (run.by, run.threads) == (by, threads));
        let points: Vec<(f64, f64)> = of_name.map(|run| (run.bodies as f64, run.mean())).collect();
        let mut name = format!("{by}, {threads} thread{}", if threads > 1 { "s" } else { "" });
        if let Some(e) = exponent(&points) {
            let _ = write!(name, ": exponent {e:.2}");
            println!("{name}");
        }
        series.push(Series { name, points, spread: Vec::new() });
    }
    let values = |pick: fn(&(f64, f64)) -> f64| {
        series.iter().flat_map(move |s| s.points.iter().map(pick)).collect::<Vec<f64>>()
    };
    LinePlot {
        title: "Cost of a step: boxes that fall into a pile".into(),
        x: Axis::decades("boxes", values(|p| p.0)),
        y: Axis::decades("mean time of a step, µs", values(|p| p.1)),
        series,
    }
    .draw(path)
}
