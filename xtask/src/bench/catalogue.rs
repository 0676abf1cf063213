//! Which pairs the bench runs on: ten of embedded shapes, or those that a folder of trials names.
use super::body::{Body, Pair};
use crate::trials::{self, Law, Trial};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

type Error = Box<dyn std::error::Error>;

/// Name, shape A, shape B: from a few hundred triangles a body to 1.1 million.
const PAIRS: [(&str, &str, &str); 10] = [
    ("gear/gear", "gear?triangles=476", "gear?triangles=476"),
    ("box/icosphere", "box", "icosphere?triangles=1280"),
    ("torus/torus", "torus?triangles=1332", "torus?triangles=3240&tube=0.2"),
    ("screw/nut", "screw?triangles=2828", "nut?triangles=2418"),
    ("pebble/pebble", "pebble?triangles=5856", "pebble?triangles=5804&seed=2"),
    ("link/link", "chain-link?triangles=12000", "chain-link?triangles=12000"),
    ("wheel/pebble", "paddle-wheel?triangles=20000", "pebble?triangles=20000&roughness=1"),
    ("knot/knot", "torus-knot?triangles=70000", "torus-knot?triangles=70000"),
    ("knot/gear", "torus-knot?triangles=280000&p=3&q=2", "gear?triangles=280000&teeth=64"),
    ("pebble/pebble 1.1 M", "pebble?triangles=1114624&roughness=1", "pebble?triangles=1114624&roughness=1"),
];

/// The pairs of a quick run.
pub(crate) const QUICK: [&str; 4] = ["gear/gear", "torus/torus", "pebble/pebble", "knot/knot"];

/// The speeds of the paper's section VIII, units per unit of time.
pub(crate) const SPEEDS: [f64; 2] = [4.0, 512.0];

/// A pair that is not loaded yet, with the trials at each speed.
pub(crate) struct Entry {
    pub(crate) name: String,
    shapes: Shapes,
    pub(crate) trials: Vec<(f64, Vec<Trial>)>,
}

enum Shapes {
    Embedded(String, String),
    Files(PathBuf, PathBuf),
}

impl Entry {
    /// Builds or reads the meshes and their trees.
    pub(crate) fn load(&self) -> Result<Pair, Error> {
        let (a, b) = match &self.shapes {
            Shapes::Embedded(a, b) if a == b => {
                let body = Body::embedded(a)?;
                (Arc::clone(&body), body)
            }
            Shapes::Embedded(a, b) => (Body::embedded(a)?, Body::embedded(b)?),
            Shapes::Files(a, b) if a == b => {
                let body = Body::from_file(a)?;
                (Arc::clone(&body), body)
            }
            Shapes::Files(a, b) => (Body::from_file(a)?, Body::from_file(b)?),
        };
        Ok(Pair { name: self.name.clone(), a, b })
    }
}

/// The ten pairs with `count` trials of this seed at each speed.
pub(crate) fn embedded(seed: u64, count: usize) -> Vec<Entry> {
    let entry = |(index, &(name, a, b)): (usize, &(&str, &str, &str))| Entry {
        name: name.into(),
        shapes: Shapes::Embedded(a.into(), b.into()),
        trials: SPEEDS.map(|speed| (speed, draw(speed, seed, index, count))).to_vec(),
    };
    PAIRS.iter().enumerate().map(entry).collect()
}

/// Each pair and speed gets numbers of its own, so that leaving one out changes no other.
fn draw(speed: f64, seed: u64, index: usize, count: usize) -> Vec<Trial> {
    let own = seed.wrapping_mul(1_000_003).wrapping_add(2 * index as u64 + u64::from(speed > 100.0));
    trials::generate(&Law { speed, ..Law::PAPER }, own, count)
}

/// Files `A__B__SPEED.csv` in `trials`, models `A.obj` and `B.obj` in `models`.
pub(crate) fn files(models: &Path, folder: &Path, count: usize) -> Result<Vec<Entry>, Error> {
    let mut entries: BTreeMap<String, Entry> = BTreeMap::new();
    let list = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for file in list {
        let path = file?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let parts: Vec<&str> = stem.split("__").collect();
        let ([a, b, speed], true) = (&parts[..], path.extension().is_some_and(|e| e == "csv")) else {
            continue;
        };
        let speed: f64 = speed.parse().map_err(|_| format!("{}: no speed in the name", path.display()))?;
        let model = |name: &str| models.join(format!("{name}.obj"));
        let mut list = trials::read(&path)?;
        list.truncate(count);
        let name = format!("{a}/{b}");
        entries
            .entry(name.clone())
            .or_insert_with(|| Entry { name, shapes: Shapes::Files(model(a), model(b)), trials: Vec::new() })
            .trials
            .push((speed, list));
    }
    if entries.is_empty() {
        return Err(format!("{}: no file A__B__SPEED.csv", folder.display()).into());
    }
    let mut entries: Vec<Entry> = entries.into_values().collect();
    for entry in &mut entries {
        entry.trials.sort_by(|s, t| s.0.total_cmp(&t.0));
    }
    Ok(entries)
}
