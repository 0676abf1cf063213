//! Answers about paths, proven again by the verifier, which shares nothing with the search.

use crate::failure::Failure;
use crate::output::short;
use d2m::bvh::TimeOfContact;
use d2m::verify::{DEFAULT_STEPS, Verdict, Verifier};
use d2m_robot::{PathAnswer, PathBodies};

/// Was an answer proven again?
pub(super) enum Proof {
    Verified,
    /// Why it was not.
    Unverified(String),
}

/// Proves an answer pair by pair: the pair that meets as it was found, all others apart until then. The steps are for all pairs.
pub(super) fn prove(bodies: &PathBodies<'_>, answer: &PathAnswer) -> Result<Proof, Failure> {
    let window = bodies.window();
    let until = answer.free_until();
    let apart = if until < window.end() {
        TimeOfContact::Undecided { clear_until: until }
    } else {
        TimeOfContact::Separated
    };
    let found = answer.contact();
    let mut left = DEFAULT_STEPS;
    for &pair in bodies.pairs() {
        let met = found.filter(|found| {
            let [a, b] = found.bodies;
            pair == [a, b] || pair == [b, a]
        });
        let (pair, claimed) =
            met.map_or((pair, apart), |found| (found.bodies, TimeOfContact::Contact(found.contact)));
        let names = pair.map(|body| bodies.name(body));
        let moving = pair.map(|body| bodies.moving(body));
        if moving.iter().any(|body| body.radius > 0.0) {
            return Ok(unverified(names, "bodies with a radius are not proven again"));
        }
        let [a, b] = moving.map(|body| body.body.mesh());
        let verifier = Verifier::try_new(a, b).map_err(|error| Failure::at("--verify", error))?;
        match verifier.time_of_contact(&moving, window, bodies.options(), &claimed, left) {
            Verdict::Verified { steps } => left = left.saturating_sub(steps),
            Verdict::Refuted { time, distance, .. } => {
                let [time, lo, hi] = [time, distance.lo(), distance.hi()].map(short);
                return Ok(unverified(
                    names,
                    &format!("REFUTED: at t = {time} they are between {lo} and {hi} apart"),
                ));
            }
            Verdict::Unproven { clear_until, reason, .. } => {
                let reason = format!("not proven: {reason}; clear until {}", short(clear_until));
                return Ok(unverified(names, &reason));
            }
        }
    }
    Ok(Proof::Verified)
}

fn unverified([a, b]: [&str; 2], why: &str) -> Proof {
    Proof::Unverified(format!("{a} \u{2013} {b}: {why}"))
}
