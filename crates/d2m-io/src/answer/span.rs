//! What an answer proves of spans of time.

use d2m_bvh::{Contact, Evidence, StartState, TimeOfContact, Window};
use serde_json::{Value, json};

/// What is proven of a span of time.
///
/// ```
/// use d2m_io::Holds;
/// assert_eq!([Holds::Clear, Holds::Unknown].map(Holds::word), ["clear", "unknown"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Holds {
    /// No two bodies that count are in contact.
    Clear,
    /// The contact is within this span.
    Contact,
    /// The search could not decide.
    Undecided,
    /// Nobody asked.
    Unknown,
}

impl Holds {
    /// As it is written.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Contact => "contact",
            Self::Undecided => "undecided",
            Self::Unknown => "unknown",
        }
    }
}

/// A span of time, with what is proven of it in words.
///
/// ```
/// use d2m_io::{Holds, ProvenSpan};
/// let span = ProvenSpan::new(0.0, 0.5, Holds::Clear, "no contact");
/// assert_eq!(span.to_json()["status"], "clear");
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ProvenSpan {
    /// Its start.
    pub from: f64,
    /// Its end.
    pub to: f64,
    /// What is proven.
    pub holds: Holds,
    /// The same in words.
    pub text: String,
}

impl ProvenSpan {
    /// A span with what is proven of it.
    pub fn new(from: f64, to: f64, holds: Holds, text: &str) -> Self {
        Self { from, to, holds, text: text.to_owned() }
    }

    /// As pages take it.
    pub fn to_json(&self) -> Value {
        json!({ "from": self.from, "to": self.to, "status": self.holds.word(), "text": self.text })
    }
}

/// What the first contact proves of the times of its window: spans in order, joined, covering it.
///
/// ```
/// use d2m_bvh::{TimeOfContact, Window};
/// use d2m_io::{Holds, proven_spans};
/// let spans = proven_spans(&TimeOfContact::Undecided { clear_until: 0.25 }, Window::UNIT);
/// assert_eq!(spans.iter().map(|span| span.holds).collect::<Vec<_>>(), [Holds::Clear, Holds::Undecided]);
/// assert_eq!((spans[0].to, spans[1].to), (0.25, 1.0));
/// // Nothing is known even of the first time.
/// let nothing = proven_spans(&TimeOfContact::Undecided { clear_until: 0.0 }, Window::UNIT);
/// assert_eq!(nothing.iter().map(|span| span.holds).collect::<Vec<_>>(), [Holds::Undecided]);
/// ```
pub fn proven_spans(verdict: &TimeOfContact, window: Window) -> Vec<ProvenSpan> {
    let (start, end) = (window.start(), window.end());
    let clear = |until: f64| ProvenSpan::new(start, until, Holds::Clear, "proven apart");
    // Before the first time of the window there is nothing that could be clear.
    let clear_before = |time: f64| (time > start).then(|| clear(time));
    match verdict {
        TimeOfContact::Separated => vec![clear(end)],
        TimeOfContact::Undecided { clear_until } => {
            let rest =
                ProvenSpan::new(*clear_until, end, Holds::Undecided, "not decided: the budget ran out");
            clear_before(*clear_until).into_iter().chain([rest]).collect()
        }
        // Only that nothing meets before is proven.
        TimeOfContact::Contact(Contact {
            time_lo,
            evidence: Evidence::Early,
            start: StartState::Apart,
            ..
        }) => {
            let text = "the search stopped early: there may be no contact";
            let rest = ProvenSpan::new(*time_lo, end, Holds::Undecided, text);
            clear_before(*time_lo).into_iter().chain([rest]).collect()
        }
        TimeOfContact::Contact(contact) => {
            let after = "after the first contact: not examined";
            let met =
                ProvenSpan::new(contact.time_lo, contact.time_hi, Holds::Contact, contact_text(contact));
            let rest = ProvenSpan::new(contact.time_hi, end, Holds::Unknown, after);
            clear_before(contact.time_lo).into_iter().chain([met, rest]).collect()
        }
    }
}

const fn contact_text(contact: &Contact) -> &'static str {
    match contact.start {
        StartState::Apart => "the first contact is in this bracket",
        StartState::Touching => "touching at the start",
        StartState::Overlapping => "overlapping at the start",
        StartState::Contained => "one inside the other at the start",
        StartState::Undecided => "meeting at the start, touching or overlapping",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where nothing is proven of the first time, none of the spans is clear; what is separated at a single time is clear then.
    #[test]
    fn no_span_of_no_length_is_clear_unless_that_is_all() {
        let window = Window::try_new(0.5, 1.0).unwrap();
        let holds = |verdict: &TimeOfContact, window: Window| {
            proven_spans(verdict, window).iter().map(|span| span.holds).collect::<Vec<_>>()
        };
        let undecided = |clear_until: f64| holds(&TimeOfContact::Undecided { clear_until }, window);
        assert_eq!(undecided(0.5), [Holds::Undecided]);
        assert_eq!(undecided(0.75), [Holds::Clear, Holds::Undecided]);
        let moment = Window::try_new(0.5, 0.5).unwrap();
        assert_eq!(holds(&TimeOfContact::Separated, moment), [Holds::Clear]);
    }
}
