//! Table of the runs: a line for the terminal, a row for the file.
use super::measure::{self, Run};
use super::peer;
use crate::machine::Machine;
use crate::statistics::Summary;
use std::fmt::Write as _;

/// Names of the columns. `settled`: simulated seconds for each second of the processor at the end of a run, where it runs on until it has settled;
/// `intersecting`: pairs of bodies that are not proven apart at its end, by our static query.
const COLUMNS: [&str; 19] = [
    "scene",
    "by",
    "version",
    "threads",
    "bodies",
    "triangles",
    "steps",
    "simulated_s",
    "wall_s",
    "cpu_s",
    "real_time",
    "settled",
    "median_us",
    "worst_us",
    "events",
    "skipped_s",
    "intersecting",
    "asked",
    "fault",
];

/// What was measured, and on what: above the lines of the terminal.
pub(super) fn heading(machine: &Machine) -> String {
    let load = machine.load.map_or_else(|| "unknown".into(), |load| load.to_string());
    let build = if cfg!(debug_assertions) { "dev build" } else { "release build" };
    let Machine { cpu, cores, commit, .. } = machine;
    format!(
        "{} {} (commit {commit}, {build}) beside {} {}, on {cpu}, {cores} cores, load {load}",
        measure::NAME,
        measure::VERSION,
        peer::NAME,
        peer::VERSION,
    )
}

/// All of it.
pub(super) fn table(rows: &[Run]) -> String {
    rows.iter().fold(COLUMNS.join(",") + "\n", |text, run| text + &row(run) + "\n")
}

/// A row, without its end.
fn row(run: &Run) -> String {
    let Run { scene, by, version, threads, bodies, triangles, events, skipped, .. } = run;
    let time = Summary::of(run.microseconds.iter().copied());
    let (median, worst) = time.map_or((0.0, 0.0), |time| (time.median, time.worst));
    let given = |figure: Option<f64>| figure.map(|x| format!("{x:.4}")).unwrap_or_default();
    let fields = [
        scene.clone(),
        (*by).into(),
        (*version).into(),
        threads.to_string(),
        bodies.to_string(),
        triangles.to_string(),
        run.microseconds.len().to_string(),
        format!("{:?}", run.took.simulated),
        format!("{:.6}", run.wall()),
        given(run.took.processor),
        format!("{:.4}", run.real_time()),
        given(run.took.settled),
        format!("{median:.2}"),
        format!("{worst:.2}"),
        events.to_string(),
        format!("{skipped:?}"),
        run.intersecting.map(|count| count.to_string()).unwrap_or_default(),
        run.asked.join("; "),
        run.fault.clone(),
    ];
    fields.map(|field| field.replace(',', ";")).join(",")
}

/// A line for the terminal, with a further one for each bound.
pub(super) fn line(run: &Run) -> String {
    let mut text = format!(
        "{:<26} {:<6} {:<7} {} thread: {:>4} bodies of {:>5} triangles",
        run.scene, run.by, run.version, run.threads, run.bodies, run.triangles
    );
    if let Some(time) = Summary::of(run.microseconds.iter().copied()) {
        let _ = write!(text, "  {:>9.1} µs a step (median), {:>9.1} worst", time.median, time.worst);
    }
    if let Some(seconds) = run.took.processor {
        let _ = write!(text, "  {seconds:>8.3} s of CPU");
    }
    let _ = write!(text, "  {:>7.2} × real time", run.real_time());
    match run.intersecting {
        Some(count) => _ = write!(text, "  {count} pairs intersect"),
        None => text += "  intersections unknown",
    }
    let _ = write!(text, "  {} s skipped", run.skipped);
    if !run.fault.is_empty() {
        let _ = write!(text, "  WRONG: {}", run.fault);
    }
    for asked in &run.asked {
        let _ = write!(text, "\n    {asked}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::bound::Took;
    use super::*;

    /// A value for each column, by its name.
    fn fields(run: &Run) -> Vec<(&'static str, String)> {
        let text = table(std::slice::from_ref(run));
        let row: Vec<String> = text.lines().nth(1).unwrap().split(',').map(String::from).collect();
        assert_eq!(row.len(), COLUMNS.len());
        COLUMNS.into_iter().zip(row).collect()
    }

    #[test]
    fn rows_name_versions_intersections_and_what_is_asked() {
        let run = Run {
            scene: "gears, joint".into(),
            by: peer::NAME,
            version: peer::VERSION,
            threads: 1,
            microseconds: vec![1e6, 3e6],
            took: Took { simulated: 8.0, processor: Some(3.5), settled: None },
            skipped: 0.25,
            intersecting: Some(150),
            asked: vec!["a".into(), "b".into()],
            ..Run::default()
        };
        let fields = fields(&run);
        for expected in [
            ("scene", "gears; joint"),
            ("version", peer::VERSION),
            ("cpu_s", "3.5000"),
            ("real_time", "2.0000"),
            ("settled", ""),
            ("worst_us", "3000000.00"),
            ("skipped_s", "0.25"),
            ("intersecting", "150"),
            ("asked", "a; b"),
            ("fault", ""),
        ] {
            assert!(fields.contains(&(expected.0, expected.1.into())), "{expected:?} in {fields:?}");
        }
        let line = line(&run);
        for part in [peer::VERSION, "3.500 s of CPU", "150 pairs intersect", "0.25 s skipped", "\n    b"] {
            assert!(line.contains(part), "{part} in {line}");
        }
    }

    /// The version is that of the linked engine: the one of the lock file.
    #[test]
    fn versions_are_those_of_the_lock_file() {
        let lock = std::fs::read_to_string(crate::workspace_root().join("Cargo.lock")).unwrap();
        let lock = lock.replace('\r', "");
        for (name, version) in [("rapier3d-f64", peer::VERSION), ("d2m-dynamics", measure::VERSION)] {
            assert!(
                lock.contains(&format!("name = \"{name}\"\nversion = \"{version}\"\n")),
                "{name} {version}"
            );
        }
    }
}
