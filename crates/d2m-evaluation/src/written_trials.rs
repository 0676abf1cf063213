//! `cargo xtask trials`: trials as files, for other programs.
use crate::TaskResult;
use crate::bench::export;
use crate::trials::{Law, generate, read, write};
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Relative speed of the centers, units per unit of time.
    #[arg(long, default_value_t = 4.0, value_parser = crate::positive)]
    speed: f64,
    /// How many trials.
    #[arg(long, default_value_t = 256, value_parser = crate::at_least_one)]
    count: usize,
    /// Seed of the generator.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// File to write: CSV without header, 26 numbers a line.
    #[arg(long, required_unless_present = "pair")]
    out: Option<PathBuf>,
    /// Instead: meshes and trials of this pair of the bench, as `bench --models DIR --trials DIR` reads them.
    #[arg(long, requires = "folder")]
    pair: Option<String>,
    /// With --pair: where to; it is made if need be.
    #[arg(long, requires = "pair")]
    folder: Option<PathBuf>,
}

/// `cargo xtask trials`.
pub(crate) fn run(options: &Options) -> TaskResult {
    if let (Some(pair), Some(folder)) = (&options.pair, &options.folder) {
        export(pair, folder, options.seed, options.count)?;
        eprintln!("{pair}: meshes and {} trials a speed in {}", options.count, folder.display());
    }
    if let Some(out) = &options.out {
        let law = Law { speed: options.speed, ..Law::PAPER };
        let trials = generate(&law, options.seed, options.count);
        write(out, &trials)?;
        if read(out)? != trials {
            return Err(format!("{}: reads back differently", out.display()).into());
        }
        eprintln!("{} trials of seed {} in {}", options.count, options.seed, out.display());
    }
    Ok(())
}
