//! `cargo xtask report`: tables and figures in docs/results, from the rows that the bench left.
mod collect;
mod fcl_distances;
mod figures;
mod page;
mod parts;
mod peers;
mod series;
mod simulations;
mod table;

use crate::TaskResult;
use crate::bench::Store;
use crate::machine::Machine;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct Options {
    /// A folder of `.bench` to take rows from; the newest otherwise.
    #[arg(long)]
    from: Option<PathBuf>,
    /// Only draw again what docs/results holds.
    #[arg(long)]
    redraw: bool,
}

/// `cargo xtask report`.
pub(crate) fn run(options: &Options) -> TaskResult {
    let root = crate::workspace_root();
    let results = root.join("docs/results");
    if !options.redraw {
        let store = match &options.from {
            Some(folder) => Store { folder: folder.clone() },
            None => Store::newest(&root).ok_or("no results: run `cargo xtask bench` first")?,
        };
        let machine: Machine =
            serde_json::from_str(&store.load_text("machine.json").ok_or("no machine.json")?)?;
        let folder = results.join(machine.slug());
        std::fs::create_dir_all(&folder)?;
        collect::collect(&store, &folder)?;
        eprintln!("tables of {} in {}", store.folder.display(), folder.display());
    }
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(&results)?.filter_map(|f| Some(f.ok()?.path())).collect();
    folders.retain(|folder| folder.join("summary.csv").exists());
    folders.sort();
    for folder in &folders {
        figures::draw(folder)?;
    }
    page::write(&results.join("README.md"), &folders)?;
    eprintln!("{}", results.join("README.md").display());
    Ok(())
}

/// A file of a result folder, empty if it is not there.
fn text(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap_or_default()
}
