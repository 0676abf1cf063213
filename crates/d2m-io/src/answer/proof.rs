//! What the verifier found of an answer, in words and in JSON.

use super::words::short_number;
use d2m_verify::Verdict;
use serde_json::{Value, json};

/// What became of a claim, in one sentence.
///
/// ```
/// use d2m_verify::Verdict;
/// let words = |steps| d2m_io::verdict_sentence(&Verdict::Verified { steps });
/// assert_eq!(words(1), "yes, by an independent proof of 1 step");
/// assert_eq!(words(37), "yes, by an independent proof of 37 steps");
/// ```
pub fn verdict_sentence(verdict: &Verdict) -> String {
    match *verdict {
        Verdict::Verified { steps: 1 } => "yes, by an independent proof of 1 step".to_owned(),
        Verdict::Verified { steps } => format!("yes, by an independent proof of {steps} steps"),
        Verdict::Refuted { time, triangles: [a, b], distance } => format!(
            "REFUTED: at t = {} triangle {a} of A and triangle {b} of B are between {} and {} apart",
            short_number(time),
            short_number(distance.lo()),
            short_number(distance.hi())
        ),
        Verdict::Unproven { clear_until, reason, pair } => {
            let place =
                pair.map_or(String::new(), |[a, b]| format!(" (triangle {a} of A and triangle {b} of B)"));
            format!("not proven: {reason}{place}; clear until {}", short_number(clear_until))
        }
    }
}

/// Adds to a JSON answer what became of it: `verified`, with `proof_steps` where it is true, `why` where it is not, and the
/// `counterexample` of a refutation (`{"time", "distance": [lo, hi], "triangles": [of A, of B]}`).
///
/// ```
/// use d2m_verify::Verdict;
/// let mut answer = serde_json::json!({ "status": "separated" });
/// d2m_io::put_verdict(&Verdict::Verified { steps: 3 }, &mut answer);
/// assert_eq!(answer, serde_json::json!({ "status": "separated", "verified": true, "proof_steps": 3 }));
/// ```
pub fn put_verdict(verdict: &Verdict, answer: &mut Value) {
    answer["verified"] = json!(matches!(verdict, Verdict::Verified { .. }));
    match *verdict {
        Verdict::Verified { steps } => answer["proof_steps"] = json!(steps),
        Verdict::Refuted { time, triangles, distance } => {
            let distance = [distance.lo(), distance.hi()];
            answer["why"] = json!(verdict_sentence(verdict));
            answer["counterexample"] = json!({ "time": time, "distance": distance, "triangles": triangles });
        }
        Verdict::Unproven { .. } => answer["why"] = json!(verdict_sentence(verdict)),
    }
}

/// What of the proofs of several claims counts: a refutation, else the first that is not proven, else all steps.
///
/// ```
/// use d2m_verify::Verdict;
/// let steps = |steps| Verdict::Verified { steps };
/// assert_eq!(d2m_io::joined_verdict([steps(2), steps(5)]), steps(7));
/// ```
pub fn joined_verdict(verdicts: impl IntoIterator<Item = Verdict>) -> Verdict {
    verdicts.into_iter().fold(Verdict::Verified { steps: 0 }, |joined, verdict| match (joined, verdict) {
        (Verdict::Verified { steps }, Verdict::Verified { steps: more }) => {
            Verdict::Verified { steps: steps + more }
        }
        (Verdict::Verified { .. }, _) | (Verdict::Unproven { .. }, Verdict::Refuted { .. }) => verdict,
        _ => joined,
    })
}
