//! Where results wait between runs: `.bench/<commit>__<machine>__<settings>/`, one file per pair, speed and method.
use super::row::{HEADER, Row};
use crate::machine::Machine;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of one run.
pub(crate) struct Store {
    pub(crate) folder: PathBuf,
}

impl Store {
    /// The folder for this commit, machine and these settings. Work on an unclean tree starts afresh, because the
    /// same commit then does not mean the same code.
    pub(crate) fn open(root: &Path, machine: &Machine, settings: &str) -> std::io::Result<Self> {
        let key = format!("{}__{}__{:08x}", machine.commit, machine.slug(), hash(settings));
        let folder = root.join(".bench").join(key);
        if machine.is_dirty && folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("settings.txt"), settings)?;
        let description = folder.join("machine.json");
        if !description.exists() {
            fs::write(description, serde_json::to_string_pretty(machine)?)?;
        }
        Ok(Self { folder })
    }

    /// The newest folder that a run left, but for runs with a deliberate fault.
    pub(crate) fn newest(root: &Path) -> Option<Self> {
        let folders = fs::read_dir(root.join(".bench")).ok()?.filter_map(Result::ok);
        let dated = folders.filter_map(|f| Some((f.metadata().ok()?.modified().ok()?, f.path())));
        let stores = dated.map(|(time, folder)| (time, Self { folder }));
        let is_sound = |store: &Self| {
            let settings = store.load_text("settings.txt").unwrap_or_default();
            store.load_text("machine.json").is_some() && !settings.contains("break Some")
        };
        stores.filter(|(_, store)| is_sound(store)).max_by_key(|(time, _)| *time).map(|(_, store)| store)
    }

    fn path(&self, pair: &str, speed: f64, method: &str) -> PathBuf {
        self.folder.join(format!("{}__{speed}__{method}.csv", crate::machine::slug(pair)))
    }

    /// What an earlier run finished.
    pub(crate) fn load(&self, pair: &str, speed: f64, method: &str) -> Option<Vec<Row>> {
        let text = fs::read_to_string(self.path(pair, speed, method)).ok()?;
        let mut lines = text.lines();
        if lines.next()? != HEADER {
            return None;
        }
        lines.map(Row::parse).collect()
    }

    /// Writes the rows of a pair, speed and method.
    pub(crate) fn save(&self, pair: &str, speed: f64, method: &str, rows: &[Row]) -> std::io::Result<()> {
        let lines: Vec<String> =
            std::iter::once(HEADER.to_string()).chain(rows.iter().map(Row::line)).collect();
        write(&self.path(pair, speed, method), &(lines.join("\n") + "\n"))
    }

    /// A table of another kind, by its name.
    pub(crate) fn save_text(&self, name: &str, text: &str) -> std::io::Result<()> {
        write(&self.folder.join(name), text)
    }

    pub(crate) fn load_text(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.folder.join(name)).ok()
    }
}

/// All or nothing: a half-written file must not pass for a finished one.
fn write(path: &Path, text: &str) -> std::io::Result<()> {
    let part = path.with_extension("part");
    fs::write(&part, text)?;
    fs::rename(part, path)
}

/// A pair of which the store has rows.
pub(crate) struct KnownPair {
    pub(crate) name: String,
    pub(crate) triangles: [usize; 2],
    pub(crate) speeds: Vec<f64>,
}

impl Store {
    /// Remembers the pairs of a run, in order: `name,triangles A,triangles B,speed,speed…` a line.
    pub(crate) fn note_pair(&self, pair: &KnownPair) -> std::io::Result<()> {
        let mut text = self.load_text(PAIRS).unwrap_or_default();
        if !text.lines().any(|line| line.split(',').next() == Some(&pair.name)) {
            let speeds: Vec<String> = pair.speeds.iter().map(f64::to_string).collect();
            let [a, b] = pair.triangles;
            text = format!("{text}{},{a},{b},{}\n", pair.name, speeds.join(","));
            self.save_text(PAIRS, &text)?;
        }
        Ok(())
    }

    /// The pairs of the run.
    pub(crate) fn pairs(&self) -> Vec<KnownPair> {
        let parse = |line: &str| {
            let mut fields = line.split(',');
            let name = fields.next()?.to_string();
            let triangles = [fields.next()?.parse().ok()?, fields.next()?.parse().ok()?];
            Some(KnownPair { name, triangles, speeds: fields.filter_map(|f| f.parse().ok()).collect() })
        };
        self.load_text(PAIRS).unwrap_or_default().lines().filter_map(parse).collect()
    }
}

const PAIRS: &str = "pairs.csv";

/// FNV-1a.
fn hash(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193))
}
