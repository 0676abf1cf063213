//! `cargo xtask bench kinds`: scenes of hard kinds, each with what must happen by physics.
mod chains;
mod driven;
mod friction;
mod hits;
mod law;
mod mechanisms;
mod outcome;
mod proven;
mod solids;
mod towers;
mod trial;

use super::scene::Error;
use super::scene_file;
use crate::TaskResult;
use crate::bench::Options;
use crate::bench::progress::Progress;
use std::fmt::Write as _;
use std::path::Path;
use trial::Case;

/// Seconds of the processor that a scene may take, if nothing else is said.
const LIMIT: f64 = 30.0;

/// Of each kind with so many scenes one is run where only a quick look is wanted.
const QUICK: usize = 8;

/// All scenes, kind after kind.
fn cases(seed: u64) -> Vec<Case> {
    let mut cases = Vec::new();
    friction::cases(&mut cases);
    towers::cases(&mut cases, seed);
    driven::cases(&mut cases, seed);
    hits::cases(&mut cases, seed);
    chains::cases(&mut cases);
    mechanisms::cases(&mut cases);
    cases
}

/// Those that are wanted.
fn wanted(options: &Options) -> Result<Vec<Case>, Error> {
    let mut cases = cases(options.seed);
    if options.quick {
        cases = cases.into_iter().step_by(QUICK).collect();
    }
    if !options.scene.is_empty() {
        cases.retain(|case| options.scene.iter().any(|part| case.name.contains(part.as_str())));
    }
    if cases.is_empty() { Err("no such scene".into()) } else { Ok(cases) }
}

/// Runs them and prints a line each, then a line for each kind; the table goes to `.bench/dynamics/kinds.csv`. Or writes them as files.
pub(in crate::bench) fn run(options: &Options) -> TaskResult {
    let cases = wanted(options)?;
    if let Some(folder) = &options.write {
        return write(&cases, folder);
    }
    let progress = Progress::new(cases.iter().map(|case| case.seconds).sum());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let limit = options.cap.unwrap_or(LIMIT);
    let mut outcomes = Vec::new();
    for case in &cases {
        progress.tell(&case.name);
        let outcome = pool.install(|| outcome::run(case, limit).map_err(|error| error.to_string()))?;
        progress.say(&outcome.line());
        progress.done(case.seconds);
        outcomes.push(outcome);
    }
    progress.end();
    print!("{}", outcome::summary(&outcomes));
    let folder = crate::workspace_root().join(".bench/dynamics");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("kinds.csv"), outcome::table(&outcomes))?;
    println!("table in {}", folder.join("kinds.csv").display());
    let wrong = outcomes.iter().filter(|outcome| !outcome.faults.is_empty()).count();
    if wrong == 0 { Ok(()) } else { Err(format!("{wrong} of {} scenes go wrong", outcomes.len()).into()) }
}

/// The scenes as files that `d2m simulate` reads, beside `laws.csv`, which says what must happen in each.
fn write(cases: &[Case], folder: &Path) -> TaskResult {
    let mut laws = String::from("scene,law\n");
    for case in cases {
        let trial = case.trial()?;
        scene_file::write(&trial.scene, folder)?;
        for law in &trial.laws {
            let _ = writeln!(laws, "{},{}", scene_file::stem(&trial.scene), law.words.replace(',', ";"));
        }
    }
    std::fs::write(folder.join("laws.csv"), laws)?;
    println!("{} scenes in {}", cases.len(), folder.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of each kind, the first, for at most a quarter of a second of it: built, run and judged by what holds at any time.
    #[test]
    fn scenes_of_each_kind_start_apart_and_run() {
        let mut kinds = std::collections::BTreeSet::new();
        for case in cases(1) {
            if !kinds.insert(case.kind) {
                continue;
            }
            let trial = case.trial().unwrap();
            assert!(!trial.laws.is_empty() && !trial.scene.ids.is_empty(), "{}", case.name);
            let mut simulation = trial.scene.simulation;
            for _ in 0..3 {
                let report = simulation.step().unwrap_or_else(|error| panic!("{}: {error}", case.name));
                assert!(report.segments.iter().all(|segment| segment.skipped == 0.0), "{}", case.name);
            }
        }
        assert!(kinds.len() >= 20, "{kinds:?}");
    }

    /// Quick ones are judged right from end to end, and names are those of files.
    #[test]
    fn small_scenes_do_what_physics_asks() {
        let all = cases(1);
        let names: std::collections::BTreeSet<_> = all.iter().map(|case| case.name.clone()).collect();
        assert_eq!(names.len(), all.len());
        for name in [
            "incline of 10 degrees at 0.99",
            "hit of mass 3e0 with restitution 0.5",
            "press on 1 boxes that leaves -1",
        ] {
            let case = all.iter().find(|case| case.name.starts_with(name)).unwrap();
            let outcome = outcome::run(case, LIMIT).unwrap();
            assert_eq!(outcome.faults, Vec::<String>::new(), "{name}");
            assert!(outcome.proven > 0, "{name}");
        }
    }
}
