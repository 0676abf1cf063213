//! Chooses the mutants of a run and says which of them no test notices.
use super::Error;
use super::record::{Judged, Record};
use super::round::Round;
use super::table::{self, Mutant};
use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::Path;

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct Options {
    /// Only mutants of which the name, the file or the test contains this, or one of these.
    #[arg(long)]
    only: Vec<String>,
    /// Go on with a run that ended early: leave out those that have a result at this commit.
    #[arg(long)]
    rest: bool,
    /// Print the table and do nothing.
    #[arg(long)]
    list: bool,
    /// Targets that are built and run at the same time, each in its own copy of the sources.
    #[arg(long, default_value = "1")]
    jobs: NonZeroUsize,
}

/// `cargo xtask mutants`.
pub(super) fn run(options: &Options, root: &Path) -> Result<(), Error> {
    let all = table::read(root)?;
    let wanted = |m: &&Mutant| {
        options.only.is_empty() || options.only.iter().any(|only| m.row().contains(only.as_str()))
    };
    let mutants: Vec<&Mutant> = all.iter().filter(wanted).collect();
    if options.list {
        for mutant in mutants {
            println!("{}", mutant.row());
        }
        return Ok(());
    }
    if mutants.is_empty() {
        return Err("no such mutant (see --list)".into());
    }
    let findings = super::check(root);
    if !findings.is_empty() {
        return Err(findings.join("\n").into());
    }
    let record = Record::new(root, &all)?;
    let known = if options.rest { record.known()? } else { BTreeSet::new() };
    let judged = Round::new(root, record, &mutants, &known)?.run(options.jobs.get())?;
    let left: Vec<&Judged<'_>> = judged.iter().filter(|one| !one.outcome.is_kill()).collect();
    println!("{} mutants, {} of them not killed", judged.len(), left.len());
    if left.is_empty() {
        return Ok(());
    }
    let left: Vec<String> =
        left.iter().map(|one| format!("{}: {}", one.outcome.word(), one.mutant.name)).collect();
    Err(left.join("\n").into())
}
