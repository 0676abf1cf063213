//! What vector instructions are worth: the same queries with each instruction set of this processor, in one run.
use super::super::Options;
use super::super::catalogue;
use super::super::method::{Method, Question};
use crate::judge::{Claim, Judge};
use d2m::bvh::InstructionSet;
use rayon::prelude::*;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// One method on one pair at one speed.
pub(super) struct Variants {
    pub(super) name: String,
    /// The least times of the rounds, microseconds, by query, for each set of [`InstructionSet::available`].
    pub(super) times: Vec<Vec<f64>>,
}

/// The highest ratio of portable to best that is wanted.
pub(crate) const WANTED: f64 = 2.5;

/// Times of the pairs of a quick run, the instruction sets in turn within each round; complaints about answers that
/// are wrong, or that differ in a bit from set to set.
pub(super) fn measure(options: &Options, count: usize) -> Result<(Vec<Variants>, Vec<String>), Error> {
    let (mut found, mut wrong) = (Vec::new(), Vec::new());
    for entry in catalogue::embedded(options.seed, count) {
        if !catalogue::QUICK.contains(&entry.name.as_str()) {
            continue;
        }
        let pair = entry.load()?;
        for (speed, trials) in &entry.trials {
            let question = |i: usize, at: f64| Question::new(&pair, &trials[i], options.tolerance, at);
            let all: Vec<Question<'_>> =
                (0..trials.len()).map(|i| question(i, 0.0)).collect::<Result<_, Error>>()?;
            let contacts: Vec<(usize, f64)> = all
                .par_iter()
                .enumerate()
                .filter_map(|(i, question)| {
                    let claim = question.ask(Method::Accurate);
                    let judge = Judge { a: &pair.a.boxes, b: &pair.b.boxes, trial: &trials[i] };
                    match (judge.check(&claim, true), claim) {
                        (Ok(_), Claim::Contact { lo, .. }) => Some((i, lo)),
                        _ => None,
                    }
                })
                .collect();
            let at_contact: Vec<Question<'_>> =
                contacts.iter().map(|&(i, at)| question(i, at)).collect::<Result<_, Error>>()?;
            let methods = [Method::Accurate, Method::Capoeira, Method::Collide, Method::Distance];
            for method in methods {
                let name = format!("{} {} at speed {speed}", pair.name, method.title());
                let questions = if method.is_static() { &at_contact } else { &all };
                let (times, agree) = compare(questions, method, options.rounds.max(3));
                if !agree {
                    wrong.push(format!("{name}: instruction sets give different bits"));
                }
                found.push(Variants { name, times });
            }
        }
    }
    Ok((found, wrong))
}

/// Least times by set and query, and whether all sets gave the same bits.
fn compare(questions: &[Question<'_>], method: Method, rounds: usize) -> (Vec<Vec<f64>>, bool) {
    let sets = InstructionSet::available();
    let mut times = vec![vec![f64::INFINITY; questions.len()]; sets.len()];
    let mut agree = true;
    for (i, question) in questions.iter().enumerate() {
        let mut first: Option<[u64; 4]> = None;
        for _ in 0..rounds {
            for (set, times) in sets.iter().zip(&mut times) {
                set.limit();
                let start = Instant::now();
                let claim = std::hint::black_box(question.ask(method));
                times[i] = times[i].min(start.elapsed().as_secs_f64() * 1e6);
                agree &= *first.get_or_insert(bits(&claim)) == bits(&claim);
            }
        }
    }
    // The last set is the best one: no limit is left behind.
    (times, agree)
}

fn bits(claim: &Claim) -> [u64; 4] {
    match *claim {
        Claim::Separated => [0; 4],
        Claim::Contact { lo, hi, tolerance } => [1, lo.to_bits(), hi.to_bits(), tolerance.to_bits()],
        Claim::Undecided { clear_until } => [2, clear_until.to_bits(), 0, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_agree_and_are_all_timed() {
        let entry = &catalogue::embedded(1, 3)[0];
        let pair = entry.load().unwrap();
        let questions: Vec<Question<'_>> =
            entry.trials[0].1.iter().map(|t| Question::new(&pair, t, 1e-10, 0.0).unwrap()).collect();
        let (times, agree) = compare(&questions, Method::Accurate, 1);
        assert!(agree);
        assert_eq!(times.len(), InstructionSet::available().len());
        assert!(times.iter().flatten().all(|t| t.is_finite()));
    }
}
