//! From the rows of a run to the tables that are kept.
use super::table::{HEADER, Line};
use crate::bench::{Method, Row, Store, sweep};
use std::collections::BTreeMap;
use std::path::Path;

/// Writes `summary.csv`, the series, and what they were measured on.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    remove_old(folder)?;
    let mut lines = Vec::new();
    let mut all: BTreeMap<(u64, Method), Vec<Row>> = BTreeMap::new();
    for pair in store.pairs() {
        for speed in pair.speeds {
            for method in Method::ALL {
                let Some(rows) = store.load(&pair.name, speed, method.name()) else { continue };
                lines.push(Line::of(&pair.name, pair.triangles, (speed, method), &rows));
                all.entry((speed.to_bits(), method)).or_default().extend(rows);
            }
        }
    }
    for ((speed, method), rows) in all {
        lines.push(Line::of("all", [0, 0], (f64::from_bits(speed), method), &rows));
    }
    let table: Vec<String> =
        std::iter::once(HEADER.to_string()).chain(lines.iter().map(Line::write)).collect();
    std::fs::write(folder.join("summary.csv"), table.join("\n") + "\n")?;
    for name in sweep::NAMES {
        let points = sweep::load(store, name);
        if !points.is_empty() {
            std::fs::write(folder.join(format!("series-{name}.csv")), sweep::write(&points))?;
        }
    }
    let wrong = sweep::wrong(store);
    if !wrong.is_empty() {
        std::fs::write(folder.join("series-wrong.txt"), wrong)?;
    }
    super::peers::collect(store, folder)?;
    super::fcl_distances::collect(store, folder)?;
    super::simulations::collect(store, folder)?;
    for name in ["machine.json", "settings.txt"] {
        std::fs::write(folder.join(name), store.load_text(name).unwrap_or_default())?;
    }
    Ok(())
}

/// Tables and figures of an earlier run must not pass for this one's.
fn remove_old(folder: &Path) -> std::io::Result<()> {
    for file in std::fs::read_dir(folder)? {
        let path = file?.path();
        let is_ours = path.extension().is_some_and(|e| e == "svg" || e == "csv")
            || path.file_name().is_some_and(|name| name == "series-wrong.txt");
        if is_ours {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}
