//! Runs a scene step by step.
use super::judge;
use super::scene::Scene;
use std::time::Instant;

/// What a run took, and what was wrong with it.
pub(super) struct Run {
    pub(super) scene: String,
    pub(super) by: &'static str,
    pub(super) threads: usize,
    pub(super) bodies: usize,
    pub(super) triangles: usize,
    /// Of each step.
    pub(super) microseconds: Vec<f64>,
    pub(super) simulated: f64,
    pub(super) events: u64,
    pub(super) fault: String,
}

impl Run {
    fn wall(&self) -> f64 {
        self.microseconds.iter().sum::<f64>() * 1e-6
    }

    /// Simulated seconds a second.
    pub(super) fn real_time(&self) -> f64 {
        self.simulated / self.wall()
    }

    /// Of a step, in microseconds.
    pub(super) fn mean(&self) -> f64 {
        self.wall() * 1e6 / self.microseconds.len() as f64
    }

    /// Its line in the table.
    pub(super) fn line(&self) -> String {
        let mut sorted = self.microseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let (median, worst) = (sorted[sorted.len() / 2], sorted[sorted.len() - 1]);
        format!(
            "{},{},{},{},{},{},{:?},{:.6},{:.4},{median:.2},{worst:.2},{},{}",
            self.scene,
            self.by,
            self.threads,
            self.bodies,
            self.triangles,
            self.microseconds.len(),
            self.simulated,
            self.wall(),
            self.real_time(),
            self.events,
            self.fault.replace(',', ";")
        )
    }
}

/// Runs the scene on so many threads, then judges it.
pub(super) fn run(mut scene: Scene, threads: usize) -> Result<Run, Box<dyn std::error::Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let starts: Vec<_> = scene.ids.iter().map(|&id| scene.simulation.position(id)).collect();
    let (mut segments, mut microseconds, mut events) = (Vec::new(), Vec::new(), 0);
    let (mut fault, begin) = (String::new(), scene.before);
    while scene.simulation.time() < begin + scene.seconds {
        let counts = scene.simulation.time() >= begin;
        let start = Instant::now();
        let report = pool.install(|| scene.simulation.step());
        let took = start.elapsed().as_secs_f64() * 1e6;
        match report {
            Ok(report) => {
                if counts {
                    microseconds.push(took);
                    events += u64::from(report.events);
                }
                segments.extend(report.segments);
            }
            Err(error) => {
                fault = error.to_string();
                break;
            }
        }
    }
    segments.extend(scene.simulation.finish());
    if fault.is_empty() {
        fault = judge::fault(&scene, &starts, &segments);
    }
    if microseconds.is_empty() {
        return Err(format!("{}: {fault}", scene.name).into());
    }
    Ok(Run {
        by: "d2m",
        threads,
        bodies: scene.ids.len(),
        triangles: scene.triangles,
        simulated: microseconds.len() as f64 * scene.simulation.options().step,
        microseconds,
        events,
        fault,
        scene: scene.name,
    })
}
