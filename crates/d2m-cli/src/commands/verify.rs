//! `d2m verify`: an answer of `d2m toc`, `d2m clearance` or `d2m spans` proven again.

use crate::answer_file::{Question, read_answer};
use crate::arguments::VerifyArguments;
use crate::engine::{Pair, check_size};
use crate::failure::Failure;
use crate::load::{named, read};
use crate::outcome::Outcome;
use crate::output::print;
use crate::sizes::load_both;
use crate::verification::{PairVerifier, joined};
use serde_json::json;
use std::path::Path;

/// Runs the command.
pub(crate) fn run(arguments: &VerifyArguments) -> Result<Outcome, Failure> {
    let (window, [motion_a, motion_b]) = arguments.motions.parse()?;
    let answer = Path::new(&arguments.answer);
    let (place, bytes) = (named(answer), read(answer)?);
    let [a, b] = load_both(&arguments.a, &arguments.b, &arguments.query.sizes)?;
    let pair = Pair::new(a, b, &arguments.query)?;
    check_size("--motion-a", &motion_a, &pair.a)?;
    check_size("--motion-b", &motion_b, &pair.b)?;
    let verifier = PairVerifier::new(&pair)?;
    let question = Question { motions: [&motion_a, &motion_b], window, start: arguments.start };
    let promises = read_answer(&place, &bytes, &verifier, &question)?;
    let proofs = promises.iter().map(|promise| verifier.prove([&motion_a, &motion_b], window, promise));
    let proof = joined(proofs);
    print(&if arguments.json {
        let mut object = json!({});
        proof.put(&mut object);
        format!("{object}\n")
    } else {
        format!("verified    {}\n", proof.sentence())
    })?;
    Ok(if proof.is_verified() {
        Outcome::Answered
    } else if proof.is_refuted() {
        Outcome::Refuted
    } else {
        Outcome::NotProven
    })
}
