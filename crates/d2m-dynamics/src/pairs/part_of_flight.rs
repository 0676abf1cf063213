//! Proofs for parts of a flight, where one for the whole flight fails.

use d2m_bvh::Window;

/// The number of equal parts of a flight.
pub(crate) const MOST: u32 = 8;

/// Until when something is proven in a window; `is_proven` judges the times from one to another one. No
/// earlier than the window begins.
pub(crate) fn proven_until(window: Window, is_proven: impl Fn(f64, f64) -> bool) -> f64 {
    let time = |part: u32| {
        let passed = window.length() * (f64::from(part) / f64::from(MOST));
        if part == MOST { window.end() } else { (window.start() + passed).min(window.end()) }
    };
    let (mut done, mut next) = (0, MOST);
    while next > 0 && done < MOST {
        if is_proven(time(done), time(done + next)) {
            done += next;
        } else {
            next /= 2;
        }
    }
    time(done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    /// A proof by parts holds as far as these follow each other without a gap.
    #[test]
    fn what_is_proven_of_parts_holds_until_the_first_one_that_fails() {
        let window = Window::try_new(2.0, 10.0).unwrap();
        for (until, longest, expected) in
            [(20.0, 9.0, 10.0), (20.0, 2.5, 10.0), (5.9, 9.0, 5.0), (2.5, 9.0, 2.0)]
        {
            let shown = RefCell::new(Vec::new());
            let is_proven = |from: f64, to: f64| {
                let holds = to <= until && to - from <= longest;
                if holds {
                    shown.borrow_mut().push([from, to]);
                }
                holds
            };
            assert_eq!(proven_until(window, is_proven), expected);
            let shown = shown.into_inner();
            let ends = shown.iter().map(|[_, to]| *to);
            let begins: Vec<f64> = core::iter::once(2.0).chain(ends).collect();
            assert!(shown.iter().zip(&begins).all(|([from, _], begin)| from == begin), "{shown:?}");
            assert_eq!(begins.last(), Some(&expected));
        }
    }
}
