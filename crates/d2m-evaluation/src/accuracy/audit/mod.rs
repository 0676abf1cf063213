//! `cargo xtask accuracy audit`: what the engine concludes on its way, judged one by one.
#[cfg(feature = "audit")]
mod axles;
#[cfg(feature = "audit")]
mod case;
#[cfg(feature = "audit")]
pub(super) mod families;
#[cfg(feature = "audit")]
mod report;

use crate::TaskResult;

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct Options {
    /// Conclusions that are judged before it ends, about.
    #[arg(long, default_value_t = 1_000_000)]
    pub(super) claims: u64,
    /// Seed of all families.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Ends after so many seconds at the latest.
    #[arg(long, value_parser = crate::positive)]
    pub(super) seconds: Option<f64>,
    /// Only families whose name contains this.
    #[arg(long)]
    pub(super) only: Option<String>,
    /// Only this case of the families, and all of its conclusions.
    #[arg(long)]
    pub(super) case: Option<u64>,
    /// Of each place of the engine and case so many conclusions are judged, and so many of every power of two that follows.
    #[arg(long, default_value_t = 64)]
    pub(super) each: u64,
    /// Steps of one proof at most.
    #[arg(long, default_value_t = 1 << 12)]
    pub(super) steps: u64,
}

/// An audit needs an engine that reports.
#[cfg(not(feature = "audit"))]
pub(super) fn run(_: &Options) -> TaskResult {
    Err("built without the feature audit: start it as cargo xtask accuracy audit".into())
}

/// Asks all families in turns until enough was judged.
#[cfg(feature = "audit")]
pub(super) fn run(options: &Options) -> TaskResult {
    use case::Case;
    use d2m::audit::{Auditor, Effort};
    use families::FAMILIES;
    let wanted: Vec<_> = FAMILIES
        .iter()
        .filter(|(name, _)| options.only.iter().all(|only| name.contains(only.as_str())))
        .collect();
    if wanted.is_empty() {
        let names: Vec<_> = FAMILIES.iter().map(|family| family.0).collect();
        return Err(format!("no such family; there are {}", names.join(", ")).into());
    }
    let each = if options.case.is_some() { u64::MAX } else { options.each };
    let auditor = Auditor::new(Effort { each, most_steps: options.steps });
    let mut report = report::Report::new(options);
    let cases = options.case.map_or(0..u64::MAX, |case| case..case + 1);
    'cases: for index in cases {
        for (name, family) in &wanted {
            auditor.begin(&format!("--only {name} --seed {} --case {index}", options.seed));
            family(&Case { auditor: &auditor, seed: options.seed, index });
            if report.add(name, &auditor.take()) {
                break 'cases;
            }
        }
    }
    report.finish()
}
