//! `d2m batch`: many trials of one pair.

use crate::arguments::{BatchArguments, FurtherArguments};
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
use d2m::bvh::TimeOfContact;
use d2m::motion::RigidMotion;
use rayon::prelude::*;
use std::borrow::Cow;
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
    let mut partial =
        if arguments.resume { Some(Partial::open(arguments, &pair, &out, trials.len())?) } else { None };
    let known = partial.as_ref().map_or(0, Partial::count);
    // The lines of an ended run hold less than a proof needs: the trials that are to be proven are queried once more.
    let again: Vec<usize> = (0..known).filter(|&trial| is_proven(share, trial)).collect();
    if known > 0 {
        let again = match again.len() {
            0 => String::new(),
            count => format!("; {count} of them are asked again, to be proven"),
        };
        note(&format!("{known} of {} trials were answered before{again}", trials.len()));
    }
    let bar = progress_bar(trials.len() + again.len(), "trials");
    bar.set_position(known as u64);
    let start = Instant::now();
    let answer = |trial: usize| {
        let asked = &trials[trial];
        let answer = pair.answer_trial(asked, wanted);
        bar.inc(1);
        let place = || format!("{}, line {} (trial {trial})", named(&arguments.trials), asked.line);
        answer.map(|answer| Answered { trial, answer }).map_err(|failure| Failure::at(place(), failure))
    };
    let pool = threads(arguments.threads.into())?;
    let answer_all = |trials: Vec<usize>| -> Result<Vec<Answered>, Failure> {
        if arguments.threads == 1 {
            trials.into_iter().map(answer).collect()
        } else {
            pool.install(|| trials.into_par_iter().map(answer).collect())
        }
    };
    let again = answer_all(again)?;
    let mut answers: Vec<Answered> = Vec::with_capacity(trials.len() - known);
    // Without --resume all at once; with it in parts that are kept.
    let part = if arguments.resume { PART } else { trials.len() };
    for first in (known..trials.len()).step_by(part) {
        let found = answer_all((first..trials.len().min(first + part)).collect())?;
        if let Some(partial) = &mut partial {
            partial.append(&found.iter().map(|found| found.line(wanted)).collect::<String>())?;
        }
        answers.extend(found);
    }
    let elapsed = start.elapsed();
    bar.finish_and_clear();
    let mut text = report::csv_header(wanted);
    if let Some(partial) = &partial {
        let mut lines: Vec<Cow<'_, str>> = partial.lines().split_inclusive('\n').map(Cow::Borrowed).collect();
        for found in &again {
            lines[found.trial] = Cow::Owned(found.line(wanted));
        }
        text.extend(lines);
    } else {
        text.extend(answers.iter().map(|found| found.line(wanted)));
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
    if share.is_none() {
        return Ok(Outcome::Answered);
    }
    let chosen = again.iter().chain(answers.iter().filter(|found| is_proven(share, found.trial)));
    prove(&pair, &trials, chosen)
}

/// The answer to a trial, by its number in the results.
struct Answered {
    trial: usize,
    answer: Answer,
}

impl Answered {
    /// Its line of the results.
    fn line(&self, wanted: FurtherArguments) -> String {
        report::csv_line(self.trial, &self.answer, wanted)
    }
}

/// Is a trial of the share that is proven again? They are evenly spread over all trials.
fn is_proven(share: Option<f64>, trial: usize) -> bool {
    share.is_some_and(|share| ((trial + 1) as f64 * share).floor() > (trial as f64 * share).floor())
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

/// Proves answers again.
fn prove<'a>(
    pair: &Pair,
    trials: &[Trial],
    answers: impl Iterator<Item = &'a Answered>,
) -> Result<Outcome, Failure> {
    let verifier = PairVerifier::new(pair)?;
    let (mut verified, mut count, mut outcome) = (0, 0, Outcome::Answered);
    for Answered { trial: index, answer } in answers {
        let trial = &trials[*index];
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
fn summary(answers: &[Answered]) -> String {
    let verdicts = || answers.iter().map(|found| &found.answer.verdict);
    let count = |word: &str| verdicts().filter(|verdict| report::status(verdict) == word).count();
    let mut times: Vec<_> = answers.iter().map(|found| found.answer.took).collect();
    times.sort_unstable();
    let separations = verdicts().filter_map(TimeOfContact::contact).map(|contact| contact.separation);
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
