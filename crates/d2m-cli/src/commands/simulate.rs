//! `d2m simulate`: bodies under forces and contacts, to a run file.

use crate::arguments::SimulateArguments;
use crate::engine::{number, threads};
use crate::failure::Failure;
use crate::load::named;
use crate::output::{Output, Stream, digits, note, progress_bar, short};
use crate::report::duration;
use crate::simulation::{Line, SimulatedScene, Thinner, are_told_apart, header, read_scene, segment};
use d2m_dynamics::{BodyId, Segment, StepError};
use std::time::{Duration, Instant};

/// Steps whose end is within this part of a step of the end of the simulation are the last one: rounding of `end / step`.
const ROUNDING: f64 = 1e-6;

/// Runs the command.
pub(crate) fn run(arguments: &SimulateArguments) -> Result<(), Failure> {
    let out = Output::new(&arguments.out)?.spare([arguments.scene.as_path()])?;
    let every = arguments.every.as_ref().map(|text| number("--every", text, "a positive time", |t| t > 0.0));
    let every = every.transpose()?;
    let scene = read_scene(&arguments.scene)?;
    out.spare_inputs()?;
    if let Some(every) = every.filter(|&every| !are_told_apart(every, scene.end)) {
        let end = scene.end;
        return Err(Failure::at(
            "--every",
            format!("{every:?} divides the time until {end:?} in too many segments"),
        ));
    }
    warn_of_gap(&scene);
    let pool = threads(arguments.threads.or(scene.threads).unwrap_or(1).into())?;
    let name = named(&arguments.scene);
    let ended = pool.install(|| simulate(scene, &name, &out, every.map(Thinner::new)))?;
    if let Some(error) = ended.early {
        Err(Failure::at(name, format!("{error}; {}", ended.written)))
    } else {
        note(&format!("simulated in {}", duration(ended.took)));
        Ok(())
    }
}

/// The part of a body's radius beyond which a gap is said to be large: then it shows, and closes the body's clearances.
const LARGE_GAP: f64 = 0.05;

fn warn_of_gap(scene: &SimulatedScene) {
    let gap = scene.simulation.options().gap;
    let radius = |id: BodyId| scene.simulation.radius(id);
    let ids = || scene.ids.iter().copied().filter(|&id| scene.simulation.mass_properties(id).is_some());
    let Some(smallest) = ids().reduce(|a, b| if radius(b) < radius(a) { b } else { a }) else { return };
    if gap > LARGE_GAP * radius(smallest) {
        let name = scene.simulation.name(smallest);
        let part = 100.0 * gap / radius(smallest);
        note(&format!(
            "d2m: warning: the gap of {gap:?} is {part:.0} % of the radius of body {name}: give a smaller one"
        ));
    }
}

/// How a run ended.
struct Ended {
    /// The time that the steps took.
    took: Duration,
    /// Why it could not go on.
    early: Option<StepError>,
    /// What the run file holds, in words.
    written: String,
}

/// The run file, written step by step.
struct RunFile<'s> {
    out: &'s Output,
    /// None before the first step is done: a scene that is refused leaves no file.
    stream: Option<Stream>,
    header: String,
    names: &'s [String],
    /// Writes at even times only.
    thinner: Option<Thinner>,
    /// The end of the last segment that was written.
    until: Option<f64>,
}

impl RunFile<'_> {
    /// The end of the run is written, too.
    fn finish(&mut self, segments: &[Segment]) -> Result<(), Failure> {
        self.write(segments, Duration::ZERO)?;
        match self.thinner.take().and_then(|mut thinner| thinner.finish()) {
            Some(last) => self.append(&[last], Some(Line::Thinned), 0.0),
            None => Ok(()),
        }
    }

    fn write(&mut self, segments: &[Segment], took: Duration) -> Result<(), Failure> {
        let Some(mut thinner) = self.thinner.take() else {
            return self.append(segments, None, took.as_secs_f64());
        };
        let mut took = took.as_secs_f64();
        let written = thinner
            .add(segments, |segments| self.append(segments, Some(Line::Thinned), core::mem::take(&mut took)));
        self.thinner = Some(thinner);
        written
    }

    /// Appends segments, all as lines of one kind if it is given.
    fn append(&mut self, segments: &[Segment], kind: Option<Line>, took: f64) -> Result<(), Failure> {
        let wall = took / segments.len().max(1) as f64;
        let mut text = String::new();
        let mut first = !self.header.is_empty() && !segments.is_empty();
        if first {
            text = core::mem::take(&mut self.header);
        }
        for part in segments {
            let line = kind.unwrap_or(if first { Line::First } else { Line::Later });
            segment(&mut text, part, self.names, line, wall);
            first = false;
        }
        if text.is_empty() {
            return Ok(());
        }
        let stream = match &mut self.stream {
            Some(stream) => stream,
            none => none.insert(self.out.stream()?),
        };
        let result = stream.lines(&text);
        // The reader of a closed pipe has what it wanted.
        result.map_err(|failure| match failure {
            Failure::Input(reason) => Failure::Input(format!("{reason}; {}", self.words())),
            Failure::ClosedPipe => Failure::ClosedPipe,
        })?;
        self.until = segments.last().map(|segment| segment.end);
        Ok(())
    }

    /// What is written.
    fn words(&self) -> String {
        match self.until {
            Some(time) => format!("{} holds the run until t = {time:?}", self.out),
            None if self.stream.is_some() => format!("{} holds no segment", self.out),
            None => format!("nothing was written to {}", self.out),
        }
    }
}

fn simulate(
    mut scene: SimulatedScene,
    name: &str,
    out: &Output,
    thinner: Option<Thinner>,
) -> Result<Ended, Failure> {
    let step = scene.simulation.options().step;
    let steps = (scene.end / step - ROUNDING).ceil().max(1.0);
    let bar = progress_bar(steps as usize, "steps");
    let header = header(name, &scene.names, &scene.simulation, &scene.ids);
    let mut file = RunFile { out, stream: None, header, names: &scene.names, thinner, until: None };
    let mut ended = Ended { took: Duration::ZERO, early: None, written: String::new() };
    let (mut events, mut skipped) = (0u64, 0.0);
    for k in 1..=steps as u64 {
        let end = if k == steps as u64 { scene.end } else { k as f64 * step };
        let start = Instant::now();
        let answer = scene.simulation.step_to(end);
        let took = start.elapsed();
        ended.took += took;
        match answer {
            Ok(report) => {
                events += u64::from(report.events);
                skipped += report.segments.iter().map(|s| s.skipped).sum::<f64>();
                file.write(&report.segments, took)?;
            }
            Err(error @ StepError::Setup(_)) if file.stream.is_none() => {
                bar.finish_and_clear();
                return Ok(Ended { early: Some(error), written: file.words(), ..ended });
            }
            Err(error) => {
                ended.early = Some(error);
                break;
            }
        }
        bar.inc(1);
        let each = ended.took.as_secs_f64() / scene.simulation.time().max(f64::MIN_POSITIVE);
        bar.set_message(format!("{each:.3} s a simulated second, {events} events"));
    }
    bar.finish_and_clear();
    let last = scene.simulation.finish();
    skipped += last.iter().map(|s| s.skipped).sum::<f64>();
    file.finish(&last)?;
    let time = scene.simulation.time();
    // A run that ends before its first step has no pace.
    let pace = if time > 0.0 {
        format!("{} s a simulated second, ", digits(ended.took.as_secs_f64() / time))
    } else {
        String::new()
    };
    note(&format!("{} simulated, {pace}{events} contact events, {} skipped", short(time), short(skipped)));
    ended.written = file.words();
    Ok(ended)
}
