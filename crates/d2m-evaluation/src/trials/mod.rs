//! Trials: two motions over [0, 1], read from a file or drawn from a seed.
mod file;
mod generate;

pub(crate) use file::{read, write};
pub(crate) use generate::{Law, generate};

use crate::TaskResult;
use glam::{DQuat, DVec3};
use std::path::PathBuf;

/// A body point r is at R(t) r + x(t) with x(t) = position + t·velocity and
/// R(t) = exp(\[angular_velocity\] t)·R(rotation), t in [0, 1], everything in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Movement {
    /// Orientation at t = 0, unit to rounding; the mathematics normalises it.
    pub(crate) rotation: DQuat,
    /// Position of the body's origin at t = 0.
    pub(crate) position: DVec3,
    /// Units per unit of time.
    pub(crate) velocity: DVec3,
    /// Radians per unit of time.
    pub(crate) angular_velocity: DVec3,
}

/// One query: both bodies' movements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    pub(crate) a: Movement,
    pub(crate) b: Movement,
}

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
        crate::bench::export(pair, folder, options.seed, options.count)?;
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

#[cfg(test)]
mod tests;
