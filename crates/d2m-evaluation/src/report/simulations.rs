//! Steps of simulations, if `cargo xtask bench dynamics` was run.
use super::parts::{figure, round};
use super::text;
use crate::bench::Store;
use crate::machine::Machine;
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

const TABLE: &str = "dynamics.csv";
/// Rows of a peer outside of Rust, which `peers/mujoco_scenes.py` writes beside the table.
const PEER_TABLE: &str = "mujoco.csv";
const FIGURE: &str = "dynamics.svg";
/// On what, and on which code: simulations are measured apart from queries.
const MEASURED_ON: &str = "dynamics-measured-on.json";

/// One simulation by one program.
#[derive(Debug, PartialEq)]
struct Row<'t> {
    scene: &'t str,
    by: &'t str,
    /// Of the program.
    version: &'t str,
    threads: &'t str,
    /// Seconds of the processor.
    processor: &'t str,
    /// Simulated seconds for each second.
    real_time: f64,
    /// Microseconds a step.
    median: f64,
    worst: f64,
    /// Pairs of bodies that are not proven apart at the end.
    intersecting: &'t str,
    /// Simulated seconds that were given up.
    skipped: &'t str,
    /// Bounds beside figures.
    asked: &'t str,
    /// What the judge found wrong; empty if nothing.
    fault: &'t str,
}

impl<'t> Row<'t> {
    /// By the names of the columns; those that an older table has not are empty.
    fn parse(header: &str, line: &'t str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let field = |name: &str| header.split(',').position(|column| column == name).map(|k| fields[k]);
        if fields.len() != header.split(',').count() {
            return None;
        }
        let number = |name: &str| field(name)?.parse::<f64>().ok();
        let given = |name: &str| field(name).unwrap_or_default();
        Some(Self {
            scene: field("scene")?,
            by: field("by")?,
            version: given("version"),
            threads: field("threads")?,
            processor: given("cpu_s"),
            real_time: number("real_time")?,
            median: number("median_us")?,
            worst: number("worst_us")?,
            intersecting: given("intersecting"),
            skipped: given("skipped_s"),
            asked: given("asked"),
            fault: field("fault")?,
        })
    }

    /// All rows of a table.
    fn all(table: &'t str) -> Vec<Self> {
        let mut lines = table.lines();
        let header = lines.next().unwrap_or_default();
        lines.filter_map(|line| Self::parse(header, line)).collect()
    }
}

/// The table with the peer's rows, each after that of the first program on its scene. Rows of other columns, or of scenes that are not in the
/// table, are left out.
fn with_peer(table: &str, peer: &str) -> String {
    let (header, rows) = peer.split_once('\n').unwrap_or_default();
    if table.lines().next() != Some(header) {
        return table.into();
    }
    let scene = |row: &str| row.split(',').next().map(str::to_owned);
    let mut left: Vec<&str> = rows.lines().collect();
    let mut text = String::new();
    for line in table.lines() {
        let found = left.iter().position(|row| scene(row) == scene(line));
        for line in [Some(line), found.map(|k| left.remove(k))].into_iter().flatten() {
            text += line;
            text.push('\n');
        }
    }
    text
}

/// Takes table and figure over; the table with the rows of the peer, if there are any.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Error> {
    let Some(dynamics) = store.folder.parent().map(|parent| parent.join("dynamics")) else { return Ok(()) };
    for (from, to) in [(FIGURE, FIGURE), ("measured-on.json", MEASURED_ON)] {
        if dynamics.join(from).exists() {
            std::fs::copy(dynamics.join(from), folder.join(to))?;
        }
    }
    if dynamics.join(TABLE).exists() {
        let table = with_peer(&text(&dynamics, TABLE), &text(&dynamics, PEER_TABLE));
        std::fs::write(folder.join(TABLE), table)?;
    }
    Ok(())
}

/// The section of the page.
pub(super) fn write(page: &mut String, folder: &Path) -> Result<(), Error> {
    let table = text(folder, TABLE);
    let rows = Row::all(&table);
    if rows.is_empty() {
        return Ok(());
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    writeln!(page, "### Simulations\n")?;
    writeln!(
        page,
        "From `cargo xtask bench dynamics --full`: 64 steps a second, 100 of joints, fast gears and dolls; each run is judged (nothing skipped, \
        no energy gained, all bodies apart at the end) before its time counts. rapier steps boxes as its cuboids and all else as the same \
        triangles, and lets bodies penetrate: how many pairs intersect at the end is found by our static query for both. MuJoCo, if \
        `peers/mujoco_scenes.py` was run, steps the scenes of boxes with the options that it comes with (it takes other meshes for their \
        convex hulls); its pairs are counted by separating axes. rigid-ipc, whose \
        bodies never intersect either, takes seconds to minutes a step (Ferguson et al. 2021, doi:10.1145/3450626.3459802); it was not run \
        here. All columns: [{TABLE}]({name}/{TABLE}).\n",
    )?;
    if let Ok(machine) = serde_json::from_str::<Machine>(&text(folder, MEASURED_ON)) {
        let Machine { rustc, commit, commit_date, .. } = &machine;
        let load =
            machine.load.map_or(String::new(), |load| format!(", load average {load:.1} when it began"));
        writeln!(page, "Commit {commit} of {commit_date}, {rustc}{load}.\n")?;
    }
    writeln!(
        page,
        "| scene | by | threads | CPU, s | times real time | median step, µs | worst, µs | pairs that intersect | skipped, s | judged | asked |"
    )?;
    writeln!(page, "|---|---|---|---|---|---|---|---|---|---|---|")?;
    for row in &rows {
        let judged = match (row.by, row.fault) {
            ("d2m", "") => "right",
            (_, fault) => fault,
        };
        let Row { scene, by, version, threads, processor, intersecting, skipped, asked, .. } = row;
        let [real_time, median, worst] = [row.real_time, row.median, row.worst].map(round);
        let by = [by, version].map(|part| *part).join(" ");
        writeln!(
            page,
            "| {scene} | {} | {threads} | {processor} | {real_time} | {median} | {worst} | {intersecting} | {skipped} | {judged} | {asked} |",
            by.trim_end()
        )?;
    }
    writeln!(page)?;
    figure(page, folder, "dynamics", "Time of a step against the number of boxes, with fitted exponents")
}

#[cfg(test)]
mod tests {
    use super::{Row, with_peer};

    #[test]
    fn rows_of_the_peer_stand_after_the_first_of_their_scene() {
        let table = "scene,by,fault\na,rapier,\na,d2m,\nb,rapier,\nb,d2m,\n";
        let peer = "scene,by,fault\nb,MuJoCo,late\nc,MuJoCo,\n";
        let merged = "scene,by,fault\na,rapier,\na,d2m,\nb,rapier,\nb,MuJoCo,late\nb,d2m,\n";
        assert_eq!(with_peer(table, peer), merged);
        assert_eq!(with_peer(table, "scene,by\nb,MuJoCo\n"), table);
        assert_eq!(with_peer(table, ""), table);
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let header = "scene,by,version,threads,simulated_s,cpu_s,real_time,median_us,worst_us,skipped_s,intersecting,asked,fault";
        let table = format!(
            "{header}\nboxes 100,rapier,0.9.1,2,2.0,0.7,2.24,6016.1,29372.2,0.0,7,a: met,\nboxes 1\n"
        );
        let rows = Row::all(&table);
        let row = Row {
            scene: "boxes 100",
            by: "rapier",
            version: "0.9.1",
            threads: "2",
            processor: "0.7",
            real_time: 2.24,
            median: 6016.1,
            worst: 29372.2,
            intersecting: "7",
            skipped: "0.0",
            asked: "a: met",
            fault: "",
        };
        assert_eq!(rows, [row]);
    }

    /// A table that was measured before versions were stated.
    #[test]
    fn older_tables_have_no_versions() {
        let header = "scene,by,threads,bodies,triangles,steps,simulated_s,wall_s,real_time,median_us,worst_us,events,fault";
        let line = "boxes 100,d2m,2,100,12,128,2.0,0.89,2.24,6016.1,29372.2,300,";
        let row = Row::parse(header, line).unwrap();
        assert_eq!((row.scene, row.by, row.threads, row.fault), ("boxes 100", "d2m", "2", ""));
        assert_eq!((row.real_time, row.median, row.worst), (2.24, 6016.1, 29372.2));
        assert_eq!((row.version, row.processor, row.intersecting), ("", "", ""));
    }
}
