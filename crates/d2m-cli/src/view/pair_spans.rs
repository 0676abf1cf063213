//! What the answers to many pairs prove of the times of a window.

use super::{Holds, Span};
use crate::let_go::Beginning;
use d2m::bvh::Window;

/// Spans that cover a window: what was let go at the start, the times at which all pairs are proven apart, and what was found of single pairs or of the
/// times after that. `found` holds a span from the first contact of each pair that has one, and from where each undecided pair is no longer proven apart.
pub(super) fn spans_of_pairs(
    window: Window,
    beginnings: &[Beginning],
    clear: &str,
    found: Vec<Span>,
) -> Vec<Span> {
    let [start, end] = [window.start(), window.end()];
    let mut clear_from = start;
    let mut clear_until = found.iter().map(|span| span.from).fold(end, f64::min);
    let mut spans = Vec::new();
    for beginning in beginnings {
        match beginning {
            Beginning::Start => {}
            Beginning::Parted(pair) => {
                clear_from = clear_from.max(pair.left.hi);
                spans.push(Span::new(start, pair.left.hi, Holds::Contact, &pair.words()));
            }
            Beginning::NotParted => {
                clear_until = start;
                let text = "two bodies that are to part are not proven to have parted";
                spans.push(Span::new(start, end, Holds::Unknown, text));
            }
        }
    }
    // A single time is clear where it is the whole window and nothing was found.
    let is_all = spans.is_empty() && found.is_empty();
    if clear_from < clear_until || is_all {
        spans.push(Span::new(clear_from, clear_until, Holds::Clear, clear));
    }
    spans.extend(found);
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::bvh::{MeshTree, Moving, QueryOptions, Start};
    use d2m::motion::ConstantTwist;

    fn of_boxes(options: &QueryOptions, velocity: f64) -> Beginning {
        let cube = MeshTree::new(d2m::shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap());
        let leaving: ConstantTwist = format!("v={velocity},0,0").parse().unwrap();
        let [a, b] = [Moving::new(&cube, &ConstantTwist::REST), Moving::new(&cube, &leaving)];
        Beginning::of(["a", "b"], [a, b], Window::UNIT, options)
    }

    fn holds(beginnings: &[Beginning], found: Vec<Span>) -> Vec<(Holds, f64, f64)> {
        let spans = spans_of_pairs(Window::UNIT, beginnings, "clear", found);
        spans.iter().map(|span| (span.holds, span.from, span.to)).collect()
    }

    /// Boxes of length one in the same place, of which one leaves with a velocity of two: apart from 0.5 on.
    #[test]
    fn what_was_let_go_is_clear_once_it_has_parted() {
        let leave = QueryOptions::default().with_start(Start::Leave);
        let parted = of_boxes(&leave, 2.0);
        let Beginning::Parted(pair) = &parted else { panic!("they part") };
        let left = pair.left.hi;
        assert!((0.5..0.501).contains(&left), "{left}");
        let beginnings = [parted];
        assert_eq!(holds(&beginnings, Vec::new()), [(Holds::Contact, 0.0, left), (Holds::Clear, left, 1.0)]);
        // Two others meet before.
        let other = || vec![Span::new(0.25, 1.0, Holds::Undecided, "")];
        assert_eq!(holds(&beginnings, other()), [(Holds::Contact, 0.0, left), (Holds::Undecided, 0.25, 1.0)]);
        let staying = of_boxes(&leave, 0.5);
        assert!(matches!(staying, Beginning::NotParted));
        assert_eq!(holds(&[staying], Vec::new()), [(Holds::Unknown, 0.0, 1.0)]);
        // What is not to leave is in the answer.
        let reported = of_boxes(&QueryOptions::default(), 2.0);
        assert!(matches!(reported, Beginning::Start));
        let met = vec![Span::new(0.0, 0.0, Holds::Contact, "")];
        assert_eq!(holds(&[reported], met), [(Holds::Contact, 0.0, 0.0)]);
        assert_eq!(holds(&[], Vec::new()), [(Holds::Clear, 0.0, 1.0)]);
    }
}
