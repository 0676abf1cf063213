//! Static distances beside FCL's, if `crates/d2m-evaluation/peers/run_all.py` was run after `cargo xtask bench --only scenes`.
use super::parts::round;
use super::text;
use crate::bench::Store;
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

const FILE: &str = "distance-fcl.csv";

/// One pair at one distance.
struct Row<'t> {
    pair: &'t str,
    /// Beyond contact, in sizes of the larger body.
    gap: f64,
    /// Microseconds of ours and of FCL's.
    ours: f64,
    fcl: f64,
}

impl<'t> Row<'t> {
    /// None for the line that states the cost of a call from Python.
    fn parse(line: &'t str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let &[pair, gap, _, _, ours, fcl, _] = fields.as_slice() else { return None };
        Some(Self { pair, gap: gap.parse().ok()?, ours: ours.parse().ok()?, fcl: fcl.parse().ok()? })
    }
}

/// Our time as a part of FCL's.
fn ratio(row: &Row<'_>) -> f64 {
    row.ours / row.fcl
}

/// Takes the table over as it is.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Error> {
    let Some(rows) = store.folder.parent().map(|parent| text(&parent.join("peers"), "distance.csv")) else {
        return Ok(());
    };
    if !rows.is_empty() {
        std::fs::write(folder.join(FILE), rows)?;
    }
    Ok(())
}

/// The section of the page: a line for each pair.
pub(super) fn write(page: &mut String, folder: &Path) -> Result<(), Error> {
    let table = text(folder, FILE);
    let rows: Vec<Row<'_>> = table.lines().filter_map(Row::parse).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(page, "### Static distance beside FCL\n")?;
    writeln!(
        page,
        "From `crates/d2m-evaluation/peers/fcl_distance.py` after `cargo xtask bench --only scenes`: the same meshes and poses, from {:e} to {} sizes \
        of the larger body beyond contact ([{FILE}]({}/{FILE}) has all rows). µs; both distances agree to 1e-6.\n",
        rows.iter().map(|row| row.gap).fold(f64::INFINITY, f64::min),
        rows.iter().map(|row| row.gap).fold(0.0, f64::max),
        folder.file_name().unwrap_or_default().display(),
    )?;
    writeln!(
        page,
        "| pair | d2m, nearest | d2m, slowest | FCL, nearest | FCL, slowest | d2m / FCL, best | worst |"
    )?;
    writeln!(page, "|---|---|---|---|---|---|---|")?;
    for of_pair in rows.chunk_by(|row, other| row.pair == other.pair) {
        let largest = |of: fn(&Row<'_>) -> f64| of_pair.iter().map(of).fold(0.0, f64::max);
        let best = of_pair.iter().map(ratio).fold(f64::INFINITY, f64::min);
        let [pair, nearest] = [of_pair[0].pair.replace('_', "/"), round(of_pair[0].ours)];
        writeln!(
            page,
            "| {pair} | {nearest} | {} | {} | {} | {best:.3} | {:.3} |",
            round(largest(|row| row.ours)),
            round(of_pair[0].fcl),
            round(largest(|row| row.fcl)),
            largest(ratio),
        )?;
    }
    Ok(writeln!(page)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_and_the_line_of_a_call_is_not() {
        let row = Row::parse("box_pebble,0.0001,9.3e-05,9.3e-05,7.5,463.5,0.016").unwrap();
        assert_eq!((row.pair, row.gap, row.ours, row.fcl), ("box_pebble", 1e-4, 7.5, 463.5));
        assert!(Row::parse("one triangle a body,,,,,1.3,").is_none());
        assert!(Row::parse("pair,gap,distance,fcl_distance,microseconds,fcl_microseconds,ratio").is_none());
    }
}
