//! From the rows of a run to the tables that are kept.
use super::table::{HEADER, Line};
use crate::bench::{Method, Row, Store, sweep};
use std::collections::BTreeMap;
use std::path::Path;

/// Writes `summary.csv`, the series, and what they were measured on.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
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
    for name in ["machine.json", "settings.txt"] {
        std::fs::write(folder.join(name), store.load_text(name).unwrap_or_default())?;
    }
    Ok(())
}
