//! `d2m batch`: many trials of one pair.

use crate::arguments::BatchArguments;
use crate::engine::{Answer, Pair};
use crate::failure::Failure;
use crate::output::{Output, note, progress_bar};
use crate::report;
use crate::sizes::load_both;
use crate::trials::{self, Trial};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(arguments: &BatchArguments) -> Result<(), Failure> {
    let inputs = [Path::new(&arguments.a), Path::new(&arguments.b), &arguments.trials];
    let out = Output::new(&arguments.out)?.spare(inputs)?;
    let trials = trials::load(&arguments.trials)?;
    let [a, b] = load_both(&arguments.a, &arguments.b, &arguments.query.sizes)?;
    let pair = Pair::new(a, b, &arguments.query)?;
    let bar = progress_bar(trials.len(), "trials");
    let start = Instant::now();
    let answer = |(index, trial): (usize, &Trial)| {
        let answer = pair.answer_trial(trial);
        bar.inc(1);
        let place = || format!("{}, line {} (trial {index})", arguments.trials.display(), trial.line);
        answer.map_err(|failure| Failure::at(place(), failure))
    };
    let answers: Result<Vec<Answer>, Failure> = if arguments.threads == 1 {
        trials.iter().enumerate().map(answer).collect()
    } else {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.into()).build();
        let pool = pool.map_err(|error| Failure::at("--threads", error))?;
        pool.install(|| trials.par_iter().enumerate().map(answer).collect())
    };
    let elapsed = start.elapsed();
    bar.finish_and_clear();
    let answers = answers?;
    let mut text = report::CSV_HEADER.to_owned();
    for (trial, answer) in answers.iter().enumerate() {
        text.push_str(&report::csv_line(trial, answer));
    }
    out.write(&text)?;
    note(&summary(&answers));
    note(&format!(
        "trees built in {}, all trials in {}",
        report::duration(pair.preparation),
        report::duration(elapsed)
    ));
    Ok(())
}

/// Counts of the verdicts, median and worst time, largest separation.
fn summary(answers: &[Answer]) -> String {
    let count = |word: &str| answers.iter().filter(|answer| report::status(&answer.verdict) == word).count();
    let mut times: Vec<_> = answers.iter().map(|answer| answer.took).collect();
    times.sort_unstable();
    let separations =
        answers.iter().filter_map(|answer| answer.verdict.contact()).map(|contact| contact.separation);
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    format!(
        "{} trials: {} contact, {} separated, {} undecided; median {}, worst {}; largest separation {:.3e}",
        answers.len(),
        count("contact"),
        count("separated"),
        count("undecided"),
        report::duration(median),
        report::duration(worst),
        separations.fold(0.0, f64::max),
    )
}
