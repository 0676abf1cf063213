//! Steps of simulations, if `cargo xtask bench dynamics` was run.
use super::parts::{figure, round};
use super::text;
use crate::bench::Store;
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

const TABLE: &str = "dynamics.csv";
const FIGURE: &str = "dynamics.svg";

/// One simulation by one program.
struct Row<'t> {
    scene: &'t str,
    by: &'t str,
    threads: &'t str,
    /// Simulated seconds for each second.
    real_time: f64,
    /// Microseconds a step.
    median: f64,
    worst: f64,
    /// What the judge found wrong; empty if nothing.
    fault: &'t str,
}

impl<'t> Row<'t> {
    fn parse(line: &'t str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let &[scene, by, threads, _, _, _, _, _, real_time, median, worst, _, fault] = fields.as_slice()
        else {
            return None;
        };
        let number = |field: &str| field.parse::<f64>().ok();
        let (real_time, median, worst) = (number(real_time)?, number(median)?, number(worst)?);
        Some(Self { scene, by, threads, real_time, median, worst, fault })
    }
}

/// Takes table and figure over as they are.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Error> {
    let Some(dynamics) = store.folder.parent().map(|parent| parent.join("dynamics")) else { return Ok(()) };
    for name in [TABLE, FIGURE] {
        if dynamics.join(name).exists() {
            std::fs::copy(dynamics.join(name), folder.join(name))?;
        }
    }
    Ok(())
}

/// The section of the page.
pub(super) fn write(page: &mut String, folder: &Path) -> Result<(), Error> {
    let table = text(folder, TABLE);
    let rows: Vec<Row<'_>> = table.lines().filter_map(Row::parse).collect();
    if rows.is_empty() {
        return Ok(());
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    writeln!(page, "### Simulations\n")?;
    writeln!(
        page,
        "From `cargo xtask bench dynamics --full`: 64 steps a second; each run is judged (no intersection, momentum, energy) before its \
        time counts. rapier steps the same triangles or convex parts, and lets bodies penetrate a little. rigid-ipc, whose bodies never intersect either, takes seconds to minutes a step (Ferguson et al. 2021, doi:10.1145/3450626.3459802); it was not run here. All columns: \
        [{TABLE}]({name}/{TABLE}).\n",
    )?;
    writeln!(page, "| scene | by | threads | times real time | median step, µs | worst, µs | judged |")?;
    writeln!(page, "|---|---|---|---|---|---|---|")?;
    for Row { scene, by, threads, real_time, median, worst, fault } in &rows {
        let judged = match (*by, *fault) {
            ("d2m", "") => "right",
            (_, fault) => fault,
        };
        let [real_time, median, worst] = [real_time, median, worst].map(|x| round(*x));
        writeln!(page, "| {scene} | {by} | {threads} | {real_time} | {median} | {worst} | {judged} |")?;
    }
    writeln!(page)?;
    figure(page, folder, "dynamics", "Time of a step against the number of boxes, with fitted exponents")
}

#[cfg(test)]
mod tests {
    use super::Row;

    #[test]
    fn rows_are_read_and_the_header_is_not() {
        let line = "boxes 100,d2m,2,100,12,128,2.0,0.89,2.24,6016.1,29372.2,300,";
        let row = Row::parse(line).unwrap();
        assert_eq!((row.scene, row.by, row.threads, row.fault), ("boxes 100", "d2m", "2", ""));
        assert_eq!((row.real_time, row.median, row.worst), (2.24, 6016.1, 29372.2));
        let header = "scene,by,threads,bodies,triangles,steps,simulated_s,wall_s,real_time,median_us,worst_us,events,fault";
        assert!(Row::parse(header).is_none());
    }
}
