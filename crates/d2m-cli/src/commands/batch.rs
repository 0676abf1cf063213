//! `d2m batch`: many trials of one pair.

use crate::arguments::BatchArguments;
use crate::engine::{Answer, Pair, number, threads};
use crate::failure::Failure;
use crate::load::named;
use crate::outcome::Outcome;
use crate::output::{Output, note, progress_bar};
use crate::partial::Partial;
use crate::report;
use crate::sizes::load_both;
use crate::travel::Travel;
use crate::trials::{self, Trial};
use crate::verification::{PairVerifier, joined, promises_of};
use d2m::motion::RigidMotion;
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(arguments: &BatchArguments) -> Result<Outcome, Failure> {
    let inputs = [Path::new(&arguments.a), Path::new(&arguments.b), &arguments.trials];
    let out = Output::new(&arguments.out)?.spare(inputs)?;
    if arguments.resume && arguments.trials == Path::new("-") {
        return Err(Failure::at(
            "--resume",
            "standard input cannot be read again: name a file with --trials",
        ));
    }
    let share = |text| number("--verify", text, "a share from 0 to 1", |share| (0.0..=1.0).contains(&share));
    let share = arguments.verify.as_deref().map(share).transpose()?;
    let wanted = arguments.further;
    let trials = trials::load(&arguments.trials)?;
    let [a, b] = load_both(&arguments.a, &arguments.b, &arguments.query.sizes)?;
    out.spare_inputs()?;
    let pair = Pair::new(a, b, &arguments.query)?;
    let mut partial = if arguments.resume { Some(Partial::open(arguments, &out)?) } else { None };
    let known = partial.as_ref().map_or(0, Partial::count).min(trials.len());
    if known > 0 {
        note(&format!("{known} of {} trials were answered before", trials.len()));
    }
    let bar = progress_bar(trials.len(), "trials");
    bar.set_position(known as u64);
    let start = Instant::now();
    let answer = |(index, trial): (usize, &Trial)| {
        let answer = pair.answer_trial(trial, wanted);
        bar.inc(1);
        let place = || format!("{}, line {} (trial {index})", named(&arguments.trials), trial.line);
        answer.map_err(|failure| Failure::at(place(), failure))
    };
    let pool = threads(arguments.threads.into())?;
    let mut answers: Vec<Answer> = Vec::with_capacity(trials.len() - known);
    // Without --resume all at once; with it in parts that are kept.
    let part = if arguments.resume { PART } else { trials.len() };
    for first in (known..trials.len()).step_by(part) {
        let chunk = &trials[first..trials.len().min(first + part)];
        let found: Result<Vec<Answer>, Failure> = if arguments.threads == 1 {
            chunk.iter().enumerate().map(|(index, trial)| answer((first + index, trial))).collect()
        } else {
            pool.install(|| {
                chunk.par_iter().enumerate().map(|(index, trial)| answer((first + index, trial))).collect()
            })
        };
        let found = found?;
        if let Some(partial) = &mut partial {
            let lines = found
                .iter()
                .enumerate()
                .map(|(index, answer)| report::csv_line(first + index, answer, wanted));
            partial.append(&lines.collect::<String>())?;
        }
        answers.extend(found);
    }
    let elapsed = start.elapsed();
    bar.finish_and_clear();
    let mut text = report::csv_header(wanted);
    if let Some(partial) = &partial {
        text.push_str(partial.lines());
    } else {
        for (trial, answer) in answers.iter().enumerate() {
            text.push_str(&report::csv_line(trial, answer, wanted));
        }
    }
    out.write(&text)?;
    if let Some(partial) = partial {
        partial.remove();
    }
    if !answers.is_empty() {
        note(&summary(&answers));
    }
    note(&format!(
        "trees built in {}, all trials in {}",
        report::duration(pair.preparation),
        report::duration(elapsed)
    ));
    warn_of_orientations(arguments, &trials);
    match share {
        Some(share) => prove(share, &pair, &trials[known..], &answers),
        None => Ok(Outcome::Answered),
    }
}

/// Trials that are kept together by `--resume`: some milliseconds to a second of work.
const PART: usize = 256;

/// One warning for all quaternions that are not of length one, and one for all bodies that turn more than once.
fn warn_of_orientations(arguments: &BatchArguments, trials: &[Trial]) {
    let warn = |is_odd: &dyn Fn(&Trial) -> bool, what: &str| {
        let mut odd = trials.iter().filter(|trial| is_odd(trial));
        if let Some(first) = odd.next() {
            note(&format!(
                "d2m: warning: {}: {} trials have {what}, the first in line {}",
                named(&arguments.trials),
                1 + odd.count(),
                first.line
            ));
        }
    };
    warn(&|trial| trial.has_odd_orientation, "a quaternion that is not of length 1, which is normalized");
    let turns = |trial: &Trial| {
        [&trial.motion_a, &trial.motion_b]
            .into_iter()
            .any(|motion| Travel::of_turns_far(motion, trial.window))
    };
    warn(&turns, "a body that turns more than once in the window (angles are radians)");
}

/// Proves a share of the answers again, evenly spread.
fn prove(share: f64, pair: &Pair, trials: &[Trial], answers: &[Answer]) -> Result<Outcome, Failure> {
    let verifier = PairVerifier::new(pair)?;
    let is_chosen = |index: usize| ((index + 1) as f64 * share).floor() > (index as f64 * share).floor();
    let (mut verified, mut count, mut outcome) = (0, 0, Outcome::Answered);
    for (index, (trial, answer)) in trials.iter().zip(answers).enumerate().filter(|(k, _)| is_chosen(*k)) {
        let motions: [&dyn RigidMotion; 2] = [&trial.motion_a, &trial.motion_b];
        let promises = promises_of(answer);
        let proof = joined(promises.iter().map(|promise| verifier.prove(motions, trial.window, promise)));
        count += 1;
        verified += u32::from(proof.is_verified());
        if !proof.is_verified() {
            note(&format!("line {} (trial {index}): {}", trial.line, proof.sentence()));
        }
        if proof.is_refuted() {
            outcome = Outcome::Refuted;
        }
    }
    note(&format!("{verified} of {count} answers verified"));
    Ok(outcome)
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
