//! Which pairs the bench runs on: ten of embedded shapes, or those that a folder of trials names.
use super::body::{Body, Pair, write_obj};
use crate::machine::slug;
use crate::trials::{self, Law, Trial};
use d2m::bvh::TriMesh;
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
    /// The meshes of both bodies; one where they are equal.
    pub(crate) fn meshes(&self) -> Result<Vec<TriMesh>, Error> {
        match &self.shapes {
            Shapes::Embedded(a, b) if a == b => Ok(vec![Body::unit_shape(a)?]),
            Shapes::Embedded(a, b) => Ok(vec![Body::unit_shape(a)?, Body::unit_shape(b)?]),
            Shapes::Files(a, b) if a == b => Ok(vec![Body::unit_file(a)?]),
            Shapes::Files(a, b) => Ok(vec![Body::unit_file(a)?, Body::unit_file(b)?]),
        }
    }

    /// Builds or reads the meshes and their trees.
    pub(crate) fn load(&self) -> Result<Pair, Error> {
        let mut bodies = self.meshes()?.into_iter().map(Body::new);
        let a = bodies.next().ok_or("no mesh")?;
        let b = bodies.next().unwrap_or_else(|| Arc::clone(&a));
        Ok(Pair { name: self.name.clone(), a, b })
    }

    /// About how many triangles are to be read or made: for the progress bar.
    pub(crate) fn triangles_about(&self) -> usize {
        let of_spec = |spec: &String| {
            let digits = spec.split_once("triangles=").map_or("1000", |parts| parts.1);
            digits.split('&').next().and_then(|d| d.parse().ok()).unwrap_or(1000)
        };
        let of_file = |path: &PathBuf| std::fs::metadata(path).map_or(0, |m| m.len() as usize / 60);
        match &self.shapes {
            Shapes::Embedded(a, b) if a == b => of_spec(a),
            Shapes::Embedded(a, b) => of_spec(a) + of_spec(b),
            Shapes::Files(a, b) if a == b => of_file(a),
            Shapes::Files(a, b) => of_file(a) + of_file(b),
        }
    }
}

/// The names of the ten pairs.
pub(crate) fn pair_names() -> Vec<&'static str> {
    PAIRS.iter().map(|pair| pair.0).collect()
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

/// Writes meshes and trials of the pair of this name as `--models` and `--trials` read them.
pub(crate) fn export(wanted: &str, folder: &Path, seed: u64, count: usize) -> Result<(), Error> {
    let entries = embedded(seed, count);
    let entry = entries.iter().find(|e| e.name == wanted);
    let entry = entry.ok_or_else(|| format!("no pair {wanted}: {}", pair_names().join(", ")))?;
    std::fs::create_dir_all(folder)?;
    let meshes = entry.meshes()?;
    let name = slug(wanted);
    let names: Vec<String> =
        ["a", "b"].iter().take(meshes.len()).map(|end| format!("{name}-{end}")).collect();
    for (name, mesh) in names.iter().zip(&meshes) {
        write_obj(&folder.join(format!("{name}.obj")), mesh)?;
    }
    let (a, b) = (&names[0], &names[names.len() - 1]);
    for (speed, list) in &entry.trials {
        trials::write(&folder.join(format!("{a}__{b}__{speed}.csv")), list)?;
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let folder = std::env::temp_dir().join(format!("d2m-catalogue-{}", std::process::id()));
        export("box/icosphere", &folder, 1, 3).unwrap();
        let entries = files(&folder, &folder, 2).unwrap();
        assert_eq!(entries.len(), 1);
        assert_eq!(entries[0].trials[1].0, 512.0);
        assert_eq!(entries[0].trials[1].1, embedded(1, 3)[1].trials[1].1[..2]);
        let (read, made) = (entries[0].meshes().unwrap(), embedded(1, 3)[1].meshes().unwrap());
        assert!(read[1].vertices() == made[1].vertices() && read[0].triangles() == made[0].triangles());
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(export("no such pair", &folder, 1, 3).is_err());
    }

    #[test]
    fn ten_pairs_with_trials_of_their_own() {
        let entries = embedded(1, 2);
        assert_eq!(entries.len(), 10);
        let sizes: Vec<usize> = entries.iter().map(Entry::triangles_about).collect();
        assert_eq!((sizes[0], sizes[2], sizes[9]), (476, 4572, 1114624));
        assert!(QUICK.iter().all(|name| entries.iter().any(|e| e.name == *name)));
        assert_ne!(entries[0].trials[0].1, entries[1].trials[0].1);
        assert_eq!(
            entries[3].trials[1].1,
            embedded(1, 9)[3].trials[1].1[..2],
            "a short run is the start of a long one"
        );
    }
}
