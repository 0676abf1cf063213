//! `cargo xtask bench dynamics`: what a step of a simulation costs. Each run is judged before its times count.
mod bound;
mod compared;
mod energy;
mod judge;
pub(super) mod kinds;
mod measure;
mod peer;
mod scene;
mod scene_file;
mod table;

use crate::TaskResult;
use crate::figure::{Axis, LinePlot, Series};
use crate::machine::Machine;
use crate::statistics::exponent;
use compared::Bearing;
use measure::Run;
use scene::{Error, Scene};
use std::fmt::Write as _;
use std::path::Path;

/// Numbers of boxes of the figure.
const QUICK: &[usize] = &[10, 30];
const USUAL: &[usize] = &[10, 30, 100];
const FULL: &[usize] = &[10, 30, 100, 300, 1000];

/// Triangles of the bolt at least. With 2000 its facets and those of the nut interlock, and the screw rests in the nut.
const BOLT: usize = 5000;

/// Target of the exponent of the cost of a step by the number of boxes.
const EXPONENT: f64 = 1.15;

/// Which runs are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    Quick,
    Usual,
    Full,
}

/// A run to be made: its scene is built when its turn comes.
struct Job {
    /// How its scene's name begins.
    name: String,
    build: Box<dyn Fn() -> Result<Scene, Error>>,
    threads: &'static [usize],
    is_compared: bool,
}

impl Job {
    fn new(
        name: impl Into<String>,
        threads: &'static [usize],
        build: impl Fn() -> Result<Scene, Error> + 'static,
    ) -> Self {
        Self { name: name.into(), build: Box::new(build), threads, is_compared: false }
    }

    /// Beside rapier, on one thread.
    fn compared(name: impl Into<String>, build: impl Fn() -> Result<Scene, Error> + 'static) -> Self {
        Self { is_compared: true, ..Self::new(name, &[1], build) }
    }

    /// All runs of the scene, rapier's first; each is printed. Scenes that are compared are written to files, for peers outside of Rust.
    fn run(&self, files: &Path) -> Result<Vec<Run>, Error> {
        let mut rows = Vec::new();
        if self.is_compared {
            let scene = (self.build)()?;
            scene_file::write(&scene, files)?;
            rows.push(measure::run_peer(&scene)?);
            println!("{}", table::line(&rows[0]));
        }
        for &threads in self.threads {
            let scene = (self.build)()?;
            let bounds = scene.bounds.clone();
            let mut run = measure::run(scene, threads)?;
            // A wrong run has no times that count.
            if run.fault.is_empty() {
                let peer = rows.iter().find(|row| row.by == peer::NAME).map(|row| &row.took);
                run.asked = bounds.iter().map(|bound| bound.judged(&run.took, peer)).collect();
            }
            println!("{}", table::line(&run));
            rows.push(run);
        }
        Ok(rows)
    }
}

/// The runs of an extent. Long ones come last.
fn jobs(extent: Extent) -> Vec<Job> {
    let (counts, triangles, threads): (&'static [usize], usize, &'static [usize]) = match extent {
        Extent::Quick => (QUICK, 2000, &[1]),
        Extent::Usual => (USUAL, 5000, &[1, 2]),
        Extent::Full => (FULL, 5000, &[1, 2]),
    };
    let most = counts[counts.len() - 1];
    let boxes = |&count: &usize| Job {
        threads,
        ..Job::compared(format!("boxes {count}"), move || Scene::boxes(count))
    };
    let mut jobs: Vec<Job> = counts.iter().map(boxes).collect();
    jobs.push(Job::new("bolt", threads, move || Scene::bolt(triangles.max(BOLT))));
    jobs.push(Job::new("gears", threads, move || Scene::gears(triangles)));
    jobs.push(Job::new("sleeping boxes", threads, move || Scene::sleeping(most.min(100))));
    jobs.push(Job::new("pebbles and knots", threads, move || Scene::crowd(most.min(50), triangles)));
    jobs.push(Job::compared("double pendulum on joints", Scene::double_pendulum));
    jobs.push(Job::compared("stack of 30", || Scene::stack(30)));
    if extent == Extent::Quick {
        return jobs;
    }
    jobs.push(Job::compared("bin of 100 boxes", || Scene::bin(100, 5)));
    jobs.push(Job::compared("knots 20", || Scene::knots(20)));
    jobs.push(Job::compared("gears at 200 rad/s on a joint", || Scene::fast_gears(Bearing::Joint)));
    jobs.push(Job::compared("nested dolls", || Scene::dolls(6)));
    if extent == Extent::Full {
        jobs.push(Job::compared("gears at 200 rad/s on a pin", || Scene::fast_gears(Bearing::Pin)));
        jobs.push(Job::compared("bin of 1000 boxes", || Scene::bin(1000, 10)));
    }
    jobs
}

/// Runs all scenes, or those whose names contain one of these; prints a line each. The table and the figure go to `.bench/dynamics`.
pub(super) fn run(extent: Extent, wanted: &[String]) -> TaskResult {
    let root = crate::workspace_root();
    let folder = root.join(".bench/dynamics");
    std::fs::create_dir_all(&folder)?;
    let machine = Machine::this(&root);
    println!("{}", table::heading(&machine));
    let is_wanted =
        |job: &Job| wanted.is_empty() || wanted.iter().any(|part| job.name.contains(part.as_str()));
    let mut rows = Vec::new();
    for job in jobs(extent).iter().filter(|job| is_wanted(job)) {
        rows.extend(job.run(&folder.join("scenes"))?);
    }
    if rows.is_empty() {
        return Err("no such scene".into());
    }
    std::fs::write(folder.join("dynamics.csv"), table::table(&rows))?;
    std::fs::write(folder.join("measured-on.json"), serde_json::to_string_pretty(&machine)?)?;
    if rows.iter().any(is_of_the_figure) {
        draw(&rows, &folder.join("dynamics.svg"))?;
    }
    println!("table and figure in {}", folder.display());
    // What rapier does wrong is stated and is no failure of ours.
    let faults = rows.iter().filter(|run| run.by != peer::NAME && !run.fault.is_empty()).count();
    if faults == 0 { Ok(()) } else { Err(format!("{faults} runs were judged wrong").into()) }
}

/// Boxes, in a run that was judged right.
fn is_of_the_figure(run: &Run) -> bool {
    run.scene.starts_with("boxes") && run.fault.is_empty()
}

/// Cost of a step against the number of boxes, of runs that were judged right.
fn draw(rows: &[Run], path: &Path) -> TaskResult {
    let sound = || rows.iter().filter(|run| is_of_the_figure(run));
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
            println!("{name} (asked of ours: ≤ {EXPONENT})");
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
