//! Runs a scene step by step.
use super::bound::Took;
use super::judge;
use super::peer::{self, Peer};
use super::scene::{Error, Scene};
use crate::bench::clock::{processor_seconds, thread_seconds};
use d2m_dynamics::Segment;
use std::time::Instant;

/// Our engine, and the version of all crates of this workspace.
pub(super) const NAME: &str = "d2m";
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The last part of a run, also of what it runs on after its time, by which a scene has settled, in simulated seconds.
const SETTLED: f64 = 1.0;

/// What a run took, and what was wrong with it.
#[derive(Default)]
pub(super) struct Run {
    pub(super) scene: String,
    pub(super) by: &'static str,
    pub(super) version: &'static str,
    pub(super) threads: usize,
    pub(super) bodies: usize,
    pub(super) triangles: usize,
    /// Of each step.
    pub(super) microseconds: Vec<f64>,
    pub(super) took: Took,
    pub(super) events: u64,
    /// Simulated seconds that were given up.
    pub(super) skipped: f64,
    /// Pairs of bodies that are not proven apart at the end.
    pub(super) intersecting: Option<usize>,
    /// Each bound beside its figure.
    pub(super) asked: Vec<String>,
    pub(super) fault: String,
}

impl Run {
    pub(super) fn wall(&self) -> f64 {
        self.microseconds.iter().sum::<f64>() * 1e-6
    }

    /// Simulated seconds a second.
    pub(super) fn real_time(&self) -> f64 {
        self.took.simulated / self.wall()
    }

    /// Of a step, in microseconds.
    pub(super) fn mean(&self) -> f64 {
        self.wall() * 1e6 / self.microseconds.len() as f64
    }

    /// Without times.
    fn of(scene: &Scene, by: &'static str, version: &'static str, threads: usize) -> Self {
        let (scene, bodies, triangles) = (scene.name.clone(), scene.ids.len(), scene.triangles);
        Self { scene, by, version, threads, bodies, triangles, ..Self::default() }
    }

    /// With the intersections at the end; where the bodies are nowhere, that is the fault.
    fn counted(mut self, found: Result<usize, String>) -> Self {
        match found {
            Ok(count) => self.intersecting = Some(count),
            Err(error) if self.fault.is_empty() => self.fault = error,
            Err(_) => {}
        }
        self
    }
}

/// Times of steps, on the clock and of the processor.
struct Watch {
    threads: usize,
    microseconds: Vec<f64>,
    processor: Option<f64>,
    /// Of the last steps, which are settled, in seconds: of the processor, and on the clock.
    last: Option<f64>,
    last_on_clock: f64,
}

/// What the time of a step belongs to.
#[derive(Clone, Copy)]
struct Counted {
    run: bool,
    last: bool,
}

impl Counted {
    /// At this time since the times began to count.
    fn at(since: f64, scene: &Scene) -> Self {
        let run = (0.0..scene.seconds).contains(&since);
        Self { run, last: since >= scene.seconds + scene.after - SETTLED }
    }
}

impl Watch {
    fn new(threads: usize) -> Self {
        Self { threads, microseconds: Vec::new(), processor: Some(0.0), last: Some(0.0), last_on_clock: 0.0 }
    }

    fn now(&self) -> Option<f64> {
        if self.threads == 1 { thread_seconds() } else { processor_seconds() }
    }

    /// Does a step.
    fn time<T>(&mut self, counted: Counted, step: impl FnOnce() -> T) -> T {
        let (before, start) = (self.now(), Instant::now());
        let result = step();
        let on_clock = start.elapsed().as_secs_f64();
        let took = self.now().zip(before).map(|(now, before)| now - before);
        let add = |sum: Option<f64>| sum.zip(took).map(|(sum, took)| sum + took);
        if counted.run {
            self.microseconds.push(on_clock * 1e6);
            self.processor = add(self.processor);
        }
        if counted.last {
            self.last = add(self.last);
            self.last_on_clock += on_clock;
        }
        result
    }

    fn written(self, run: Run, step: f64) -> Run {
        let simulated = self.microseconds.len() as f64 * step;
        // What sleeps takes less than a tick of the processor's clock.
        let last = self.last.map(|last| if last > 0.0 { last } else { self.last_on_clock });
        let settled = last.filter(|&last| last > 0.0).map(|last| simulated.min(SETTLED) / last);
        let took = Took { simulated, processor: self.processor, settled };
        Run { took, microseconds: self.microseconds, ..run }
    }
}

/// Runs the scene on so many threads, then judges it.
pub(super) fn run(mut scene: Scene, threads: usize) -> Result<Run, Error> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let starts = scene.poses();
    let mut run = Run::of(&scene, NAME, VERSION, threads);
    let (mut segments, mut watch) = (Vec::<Segment>::new(), Watch::new(threads));
    let end = scene.before + scene.seconds + scene.after;
    // The steps run where the pool does, so that the thread's own time is theirs.
    pool.install(|| {
        while scene.simulation.time() < end {
            let counted = Counted::at(scene.simulation.time() - scene.before, &scene);
            match watch.time(counted, || scene.simulation.step()) {
                Ok(report) => {
                    run.events += if counted.run { u64::from(report.events) } else { 0 };
                    segments.extend(report.segments);
                }
                Err(error) => {
                    run.fault = error.to_string();
                    break;
                }
            }
        }
    });
    segments.extend(scene.simulation.finish());
    run.skipped = segments.iter().map(|segment| segment.skipped).sum();
    if run.fault.is_empty() {
        run.fault = judge::fault(&scene, &starts, &segments);
    }
    if watch.microseconds.is_empty() {
        return Err(format!("{}: {}", scene.name, run.fault).into());
    }
    let mut run = watch
        .written(run, scene.simulation.options().step)
        .counted(judge::intersecting(&scene, &scene.poses()));
    if run.fault.is_empty() && run.intersecting != Some(0) {
        run.fault = "bodies are not proven apart at the end".into();
    }
    Ok(run)
}

/// Runs the scene in rapier, as many steps.
pub(super) fn run_peer(scene: &Scene) -> Result<Run, Error> {
    let mut peer = Peer::new(scene)?;
    let (step, mut watch) = (scene.simulation.options().step, Watch::new(1));
    for k in 0..((scene.seconds + scene.after) / step).ceil() as usize {
        watch.time(Counted::at(k as f64 * step, scene), || peer.step());
    }
    let run = watch.written(Run::of(scene, peer::NAME, peer::VERSION, 1), step);
    let fault = peer.fault(scene);
    Ok(Run { fault, ..run }.counted(judge::intersecting(scene, &peer.poses())))
}
