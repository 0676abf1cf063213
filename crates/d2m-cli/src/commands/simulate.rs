//! `d2m simulate`: bodies under forces and contacts, to a run file.

use crate::arguments::SimulateArguments;
use crate::failure::Failure;
use crate::output::{Output, note, progress_bar};
use crate::report::duration;
use crate::simulation::{Scene, header, read_scene, segment};
use d2m_dynamics::{Segment, StepError};
use std::time::{Duration, Instant};

/// Steps whose end is within this part of a step of the end of the simulation are the last one: rounding of `end / step`.
const ROUNDING: f64 = 1e-6;

/// Runs the command.
pub(crate) fn run(arguments: &SimulateArguments) -> Result<(), Failure> {
    let out = Output::new(&arguments.out)?.spare([arguments.scene.as_path()])?;
    let scene = read_scene(&arguments.scene)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.into()).build();
    let pool = pool.map_err(|error| Failure::at("--threads", error))?;
    let name = arguments.scene.display().to_string();
    let (text, took, stopped) = pool.install(|| simulate(scene, &name));
    out.write(&text)?;
    if let Some(error) = stopped {
        Err(Failure::at(name, error))
    } else {
        note(&format!("simulated in {}", duration(took)));
        Ok(())
    }
}

/// The run file, the time that the steps took, and why it ended early.
fn simulate(mut scene: Scene, name: &str) -> (String, Duration, Option<StepError>) {
    let step = scene.simulation.options().step;
    let steps = (scene.end / step - ROUNDING).ceil().max(1.0);
    let bar = progress_bar(steps as usize, "steps");
    let mut text = header(name, &scene.names, &scene.simulation, &scene.ids);
    let mut first = true;
    let mut write = |segments: &[Segment], took: Duration| {
        let wall = took.as_secs_f64() / segments.len().max(1) as f64;
        for part in segments {
            segment(&mut text, part, &scene.names, first, wall);
            first = false;
        }
    };
    let mut total = Duration::ZERO;
    let mut stopped = None;
    let (mut events, mut skipped) = (0, 0.0);
    for k in 1..=steps as u64 {
        let end = if k == steps as u64 { scene.end } else { k as f64 * step };
        let start = Instant::now();
        let answer = scene.simulation.step_to(end);
        let took = start.elapsed();
        total += took;
        match answer {
            Ok(report) => {
                events += report.events;
                skipped += report.segments.iter().map(|s| s.skipped).sum::<f64>();
                write(&report.segments, took);
            }
            Err(error) => {
                stopped = Some(error);
                break;
            }
        }
        bar.inc(1);
        let each = total.as_secs_f64() / scene.simulation.time().max(f64::MIN_POSITIVE);
        bar.set_message(format!("{each:.3} s a simulated second, {events} events"));
    }
    bar.finish_and_clear();
    let last = scene.simulation.finish();
    skipped += last.iter().map(|s| s.skipped).sum::<f64>();
    write(&last, Duration::ZERO);
    let time = scene.simulation.time();
    let each = total.as_secs_f64() / time.max(f64::MIN_POSITIVE);
    note(&format!(
        "{time} simulated, {each:.4} s a simulated second, {events} contact events, {skipped} skipped"
    ));
    (text, total, stopped)
}
