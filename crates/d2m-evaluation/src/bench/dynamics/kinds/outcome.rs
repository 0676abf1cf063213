//! Runs a scene within its time, and judges it.
use super::super::energy::risen;
use super::super::judge::{intersecting, parted};
use super::super::scene::Error;
use super::law::{Ran, kinetic};
use super::proven::proven;
use super::trial::Case;
use crate::bench::clock::thread_seconds;
use d2m_dynamics::{Segment, StepError};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::Instant;

/// What became of a scene.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    pub(super) kind: &'static str,
    pub(super) name: String,
    pub(super) bodies: usize,
    pub(super) simulated: f64,
    /// Seconds of the processor, or of the clock where the system reports none.
    pub(super) seconds: f64,
    pub(super) events: u64,
    pub(super) skipped: f64,
    /// Pairs in sampled flights that were proven apart all along by the verifier, and those that it left open.
    pub(super) proven: usize,
    pub(super) open: usize,
    /// What went wrong.
    pub(super) faults: Vec<String>,
}

/// Runs the scene for as long as it lasts, or until it has taken so many seconds.
pub(super) fn run(case: &Case, limit: f64) -> Result<Outcome, Error> {
    let mut trial = case.trial()?;
    let is_driven = trial.is_driven();
    let scene = &mut trial.scene;
    let (energy, momentum) = kinetic(scene);
    let mut outcome =
        Outcome { kind: case.kind, name: case.name.clone(), bodies: scene.ids.len(), ..Outcome::default() };
    let mut track = vec![(0.0, scene.poses())];
    let (mut segments, mut ended): (Vec<Segment>, Option<StepError>) = (Vec::new(), None);
    let (clock, begun) = (Instant::now(), thread_seconds());
    let took = || match (begun, thread_seconds()) {
        (Some(begun), Some(now)) => now - begun,
        _ => clock.elapsed().as_secs_f64(),
    };
    while scene.simulation.time() < scene.seconds - 1e-9 {
        match scene
            .simulation
            .step_to((scene.simulation.time() + scene.simulation.options().step).min(scene.seconds))
        {
            Ok(report) => {
                outcome.events += u64::from(report.events);
                segments.extend(report.segments);
                track.push((scene.simulation.time(), scene.poses()));
            }
            Err(error) => {
                ended = Some(error);
                track.push((scene.simulation.time(), scene.poses()));
                break;
            }
        }
        if took() > limit {
            outcome.faults.push(format!("not done after {limit} s, at t = {:.3}", scene.simulation.time()));
            break;
        }
    }
    (outcome.seconds, outcome.simulated) = (took(), scene.simulation.time());
    let is_whole = outcome.faults.is_empty();
    segments.extend(scene.simulation.finish());
    let faults = &mut outcome.faults;
    outcome.skipped = segments.iter().map(|segment| segment.skipped).sum();
    if outcome.skipped > 0.0 {
        faults.push(format!("{:.3e} s given up", outcome.skipped));
    }
    match &ended {
        Some(StepError::Crushed { .. } | StepError::Cornered { .. }) if trial.is_crushing => {}
        Some(error) => faults.push(error.to_string()),
        None => {}
    }
    if !is_driven {
        faults.extend(risen(scene, &segments));
    }
    faults.extend(parted(scene, &track[0].1));
    match intersecting(scene, &scene.poses()) {
        Ok(0) => {}
        Ok(count) => faults.push(format!("{count} pairs intersect at the end")),
        Err(error) => faults.push(error),
    }
    let found = proven(scene, &segments)?;
    (outcome.proven, outcome.open) = (found.proven, found.open);
    faults.extend(found.faults);
    if is_whole && (ended.is_none() || trial.is_crushing) {
        let ran = Ran { scene: &trial.scene, track: &track, ended: ended.as_ref(), energy, momentum };
        faults.extend(trial.laws.iter().filter_map(|law| (law.check)(&ran)));
    }
    Ok(outcome)
}

impl Outcome {
    /// For the terminal.
    pub(super) fn line(&self) -> String {
        let Self { name, seconds, simulated, events, proven, open, .. } = self;
        let verdict =
            if self.faults.is_empty() { "ok".into() } else { format!("WRONG: {}", self.faults.join("; ")) };
        format!(
            "{name:<64} {seconds:>7.2} s for {simulated:<6.3} {events:>6} events, {proven:>4} proven, {open:>2} open  {verdict}"
        )
    }
}

/// A line for each kind.
pub(super) fn summary(outcomes: &[Outcome]) -> String {
    let mut kinds: BTreeMap<&str, (usize, usize, f64)> = BTreeMap::new();
    for outcome in outcomes {
        let (right, all, seconds) = kinds.entry(outcome.kind).or_default();
        *right += usize::from(outcome.faults.is_empty());
        *all += 1;
        *seconds += outcome.seconds;
    }
    let mut text = String::new();
    let mut sum = (0, 0, 0.0);
    for (kind, (right, all, seconds)) in kinds {
        let _ = writeln!(text, "{kind:<12} {right:>3} of {all:>3} right, {seconds:>8.2} s of CPU");
        sum = (sum.0 + right, sum.1 + all, sum.2 + seconds);
    }
    let _ = writeln!(text, "{:<12} {:>3} of {:>3} right, {:>8.2} s of CPU", "all", sum.0, sum.1, sum.2);
    text
}

/// For the file.
pub(super) fn table(outcomes: &[Outcome]) -> String {
    let mut text = String::from("kind,scene,bodies,simulated_s,cpu_s,events,skipped_s,proven,open,fault\n");
    for outcome in outcomes {
        let Outcome { kind, name, bodies, simulated, seconds, events, skipped, proven, open, faults } =
            outcome;
        let [name, fault] = [name, &faults.join("; ")].map(|text| text.replace(',', ";"));
        let _ = writeln!(
            text,
            "{kind},{name},{bodies},{simulated:?},{seconds:.4},{events},{skipped:?},{proven},{open},{fault}"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every row has a value for each column, and kinds are counted.
    #[test]
    fn rows_have_a_value_for_each_column() {
        let wrong = Outcome {
            kind: "press",
            name: "press on 2, slow".into(),
            faults: vec!["a, b".into()],
            ..Outcome::default()
        };
        let right = Outcome { kind: "press", name: "press on 1".into(), ..Outcome::default() };
        let outcomes = [wrong, right];
        let columns: Vec<usize> = table(&outcomes).lines().map(|line| line.split(',').count()).collect();
        assert_eq!(columns, [10, 10, 10]);
        assert!(summary(&outcomes).starts_with("press          1 of   2 right"));
        assert!(outcomes[0].line().contains("WRONG: a, b") && outcomes[1].line().ends_with("ok"));
    }
}
