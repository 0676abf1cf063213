//! The answer of a query for a person: a headline and lines, each with a label.

use super::words::{
    clearance_words, evidence_sentence, feature_sentence, fixed, short_number, start_word, vector_words,
};
use d2m_bvh::{Clearance, Contact, QueryOptions, StartState, TimeOfContact, Window};

/// A headline and lines, each with a label. What the command prints and a page shows.
///
/// ```
/// use d2m_bvh::{QueryOptions, TimeOfContact, Window};
/// let half = TimeOfContact::Undecided { clear_until: 0.5 };
/// let answer: d2m_io::AnswerLines = d2m_io::answer_lines(&half, Window::UNIT, &QueryOptions::default(), None);
/// assert!(answer.headline.starts_with("UNDECIDED") && answer.lines.iter().any(|[_, text]| text.contains("0.5")));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AnswerLines {
    /// The verdict, and when.
    pub headline: String,
    /// Labels and what is stated.
    pub lines: Vec<[String; 2]>,
}

/// What is proven, line by line. `clearance`: that of bodies that stay apart, where it was asked.
///
/// ```
/// use d2m_bvh::{QueryOptions, TimeOfContact, Window};
/// let answer = d2m_io::answer_lines(&TimeOfContact::Separated, Window::UNIT, &QueryOptions::default(), None);
/// assert_eq!(answer.headline, "SEPARATED");
/// assert_eq!(answer.lines, [["certified", "no contact anywhere from 0 to 1"]]);
/// ```
pub fn answer_lines(
    verdict: &TimeOfContact,
    window: Window,
    options: &QueryOptions,
    clearance: Option<&Clearance>,
) -> AnswerLines {
    let mut lines = Vec::new();
    let mut line = |label: &str, value: String| lines.push([label.to_owned(), value]);
    let [start, end] = [window.start(), window.end()].map(short_number);
    let headline = match verdict {
        TimeOfContact::Separated => {
            line("certified", format!("no contact anywhere from {start} to {end}"));
            if let Some(found) = clearance {
                let enclosure = clearance_words([found.lower, found.upper], found.status);
                line("clearance", format!("{enclosure} at t = {}", short_number(found.time)));
            }
            "SEPARATED".to_owned()
        }
        TimeOfContact::Undecided { clear_until } => {
            // Of no time nothing is said: the bodies may be in contact at the start.
            let free = *clear_until > window.start();
            let until = format!("no contact from {start} until {}", short_number(*clear_until));
            line("certified", if free { until } else { "nothing".to_owned() });
            let then =
                "the budget or the time was used up (or the cap that holds without them); more may decide";
            line("then", then.to_owned());
            "UNDECIDED".to_owned()
        }
        TimeOfContact::Contact(contact) => {
            contact_lines(&mut line, contact, options, window.start());
            format!("CONTACT at t = {}", short_number(contact.time_lo))
        }
    };
    AnswerLines { headline, lines }
}

fn contact_lines(
    line: &mut dyn FnMut(&str, String),
    contact: &Contact,
    options: &QueryOptions,
    window_start: f64,
) {
    let width = contact.time_hi - contact.time_lo;
    line(
        "time",
        format!("[{}, {}]  width {width:.2e}", short_number(contact.time_lo), short_number(contact.time_hi)),
    );
    match contact.start {
        StartState::Apart if options.min_separation > 0.0 => {
            let distance = short_number(options.min_separation);
            line(
                "certified",
                format!("further apart than {distance} before and at the first of these times"),
            );
        }
        StartState::Apart => {
            line("certified", "no contact before; disjoint at the first of these times".to_owned());
        }
        // A later keyframe begins with the bodies within the tolerance of each other.
        start if contact.time_lo > window_start => {
            line("certified", format!("no contact before; {} at this time", start_word(start)));
        }
        start => line("certified", format!("in contact from the start of the window: {}", start_word(start))),
    }
    line("evidence", evidence_sentence(contact, options.min_separation));
    // Bodies that overlap from the start have no separation, no normal and no closing speed.
    let apart = matches!(contact.start, StartState::Apart | StartState::Touching);
    if apart {
        let raised = match options.tolerance {
            Some(given) if contact.tolerance > given => {
                format!(" (raised from {given:.2e}: the rounding of these lengths and times allows no less)")
            }
            _ => String::new(),
        };
        let left =
            format!("{:.4e} left then, tolerance {:.2e}{raised}", contact.separation, contact.tolerance);
        line("separation", left);
        line("normal", format!("{} from A to B", vector_words(contact.normal)));
    }
    for (label, point, triangle, weights) in [
        ("point on A", contact.point_a, contact.triangle_a, contact.barycentric_a),
        ("point on B", contact.point_b, contact.triangle_b, contact.barycentric_b),
    ] {
        if contact.start == StartState::Contained {
            continue;
        }
        let [p, q, r] = weights;
        line(label, format!("{} · triangle {triangle} at {p:.6}, {q:.6}, {r:.6}", vector_words(point)));
    }
    if contact.start != StartState::Contained {
        line("features", feature_sentence(contact.feature));
    }
    if apart {
        line("closing", format!("{} along the normal, per unit of time", fixed(contact.closing_speed, 6)));
    }
}
