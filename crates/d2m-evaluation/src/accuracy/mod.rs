//! `cargo xtask accuracy`: random families against slow oracles. Any false negative fails the run.
mod audit;
mod broken_answers;
mod clearance;
mod feature;
mod hostile;
mod interval;
mod mesh;
mod proofs;
mod reference;
mod statics;
mod touching;

use crate::TaskResult;
use crate::bench::Sabotage;
use d2m::verify::Reason;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

#[derive(clap::Args)]
#[group(skip)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct Options {
    #[command(subcommand)]
    deeper: Option<Deeper>,
    /// Cases of each family, about; families that are slow take a share of it.
    #[arg(long, default_value_t = 20_000, value_parser = crate::at_least_one)]
    count: usize,
    /// Seed of the first round; the next one adds 1.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// A soak: go on with other seeds, all families each, for at least this long.
    #[arg(long, value_parser = crate::positive)]
    minutes: Option<f64>,
    /// Only families whose name contains this, as in `cargo xtask accuracy interval`.
    #[arg(value_name = "FAMILY")]
    family: Option<String>,
    /// Only families whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// Threads of the feature families; all processors by default. Answers do not depend on it.
    #[arg(long)]
    threads: Option<usize>,
    /// Answers and judges one scene again that a run has kept.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["minutes", "family", "only"])]
    case: Option<std::path::PathBuf>,
    /// False claims put to the verifier, in the family of this name: none may be verified.
    #[arg(long, default_value_t = 2000)]
    lies: usize,
    /// A deliberate fault, to see it found: `late=1e-6` or `miss`.
    #[arg(long = "break", hide = true)]
    sabotage: Option<Sabotage>,
}

/// What is judged besides answers.
#[derive(clap::Subcommand)]
enum Deeper {
    /// Every conclusion on the way to an answer, proven again; fails on any that is false.
    Audit(audit::Options),
}

/// What a family found.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) cases: usize,
    /// Cases that end in contact.
    pub(crate) contacts: usize,
    /// Answers "undecided": allowed, counted.
    pub(crate) undecided: usize,
    /// Cases that a quick first tier left to the slow oracle (features only).
    pub(crate) by_oracle: usize,
    /// Answers that the verifier neither proved nor refuted, by reason: allowed, counted.
    pub(crate) unproven: BTreeMap<Reason, usize>,
    /// The largest memory of the process in bytes, where a family counts it.
    pub(crate) peak_memory: Option<u64>,
    /// Contacts missed or late: one line each. None is allowed.
    pub(crate) false_negatives: Vec<String>,
    /// Contacts reported where the distance stays above the tolerance's bound: one line each. None is allowed.
    pub(crate) false_alarms: Vec<String>,
}

/// What a run wants of a family.
pub(crate) struct Task {
    pub(crate) count: usize,
    pub(crate) seed: u64,
    pub(crate) lies: usize,
    pub(crate) sabotage: Option<Sabotage>,
}

type Family = (&'static str, usize, fn(&Task) -> Outcome);

/// Name, the share of the count that a family takes (one in so many), and itself.
const FAMILIES: [Family; 15] = [
    ("feature: rigid vertex/face", 1, feature::rigid_vertex_face),
    ("feature: rigid edge/edge", 1, feature::rigid_edge_edge),
    ("feature: any motion vertex/face", 1, feature::enclosed_vertex_face),
    ("feature: any motion edge/edge", 1, feature::enclosed_edge_edge),
    ("feature: straight vertex/face", 1, feature::straight_vertex_face),
    ("feature: straight edge/edge", 1, feature::straight_edge_edge),
    ("interval: every operation", 1, interval::run),
    ("mesh: engine on random small scenes", 1, mesh::run),
    ("mesh: hostile scenes and their twins", 10, hostile::run),
    ("mesh: reference method and engine", 20, reference::run),
    ("mesh: collide and distance at rest", 2, statics::run),
    ("mesh: touching starts, their normals", 10, touching::run),
    ("mesh: clearance and spans, sampled", 2, clearance::run),
    ("verify: answers proven again, and lies", 10, proofs::run),
    ("mutants: broken answers are noticed", 100, broken_answers::run),
];

/// `cargo xtask accuracy`.
pub(crate) fn run(options: &Options) -> TaskResult {
    if let Some(Deeper::Audit(options)) = &options.deeper {
        return audit::run(options);
    }
    if let Some(path) = &options.case {
        return hostile::replay(path);
    }
    if let Some(threads) = options.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    let wanted =
        |name: &str| options.only.iter().chain(&options.family).all(|only| name.contains(only.as_str()));
    if !FAMILIES.iter().any(|family| wanted(family.0)) {
        let names: Vec<_> = FAMILIES.iter().map(|family| family.0).collect();
        return Err(format!("no such family; there are\n  {}", names.join("\n  ")).into());
    }
    let begin = Instant::now();
    let soak = options.minutes.map(|minutes| Duration::from_secs_f64(minutes * 60.0));
    let mut seed = options.seed;
    let (mut negatives, mut alarms, mut rounds) = (0, 0, 0);
    loop {
        for (name, share, family) in FAMILIES {
            // The first round is always whole; later ones end with the family in which the time is over.
            if !wanted(name) || rounds > 0 && soak.is_some_and(|time| begin.elapsed() >= time) {
                continue;
            }
            let start = Instant::now();
            let count = options.count.div_ceil(share);
            let found = family(&Task { count, seed, lies: options.lies, sabotage: options.sabotage });
            let slow = if found.by_oracle > 0 {
                format!(" ({} by the oracle of 192 bits)", found.by_oracle)
            } else {
                String::new()
            };
            let memory = found.peak_memory.map_or_else(String::new, |b| format!(", at most {} MB", b >> 20));
            println!(
                "{name:<40} seed {seed}: {} cases{slow}, {} contacts, {} undecided, {} false negatives, {} false alarms, {:.1} s{memory}",
                found.cases,
                found.contacts,
                found.undecided,
                found.false_negatives.len(),
                found.false_alarms.len(),
                start.elapsed().as_secs_f64()
            );
            for (reason, count) in &found.unproven {
                println!("  {count} neither proven nor refuted: {reason}");
            }
            for line in found.false_negatives.iter().take(5) {
                println!("  FALSE NEGATIVE  {line}");
            }
            for line in found.false_alarms.iter().take(5) {
                println!("  false alarm  {line}");
            }
            negatives += found.false_negatives.len();
            alarms += found.false_alarms.len();
            if !(found.false_negatives.is_empty() && found.false_alarms.is_empty()) {
                println!(
                    "  again: cargo xtask accuracy --count {} --seed {seed} --only \"{name}\"",
                    options.count
                );
            }
        }
        rounds += 1;
        seed += 1;
        let Some(time) = soak else { break };
        let (spent, time) = (begin.elapsed().as_secs_f64() / 60.0, time.as_secs_f64() / 60.0);
        println!(
            "soak: {rounds} round(s) in {spent:.1} of {time:.1} min, about {:.1} min left, {negatives} false negatives",
            (time - spent).max(0.0)
        );
        if spent >= time {
            break;
        }
    }
    println!(
        "{rounds} round(s), seeds {} to {}, {negatives} false negatives, {alarms} false alarms, {:.1} s",
        options.seed,
        seed - 1,
        begin.elapsed().as_secs_f64()
    );
    if negatives + alarms == 0 { Ok(()) } else { Err("the promise is broken: see the lines above".into()) }
}
