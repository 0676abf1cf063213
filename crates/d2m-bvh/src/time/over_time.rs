//! The search from the start of the query's window to its end: sub-windows of limited rotation, one after the other.

use crate::walk::state::{Outcome, Search, Step};

impl Search<'_> {
    /// Searches sub-window after sub-window.
    pub(crate) fn run(mut self) -> Outcome {
        let mut next = self.window_from(0.0);
        while let Some(window) = next {
            let step = self.search_span(window);
            #[cfg(feature = "rayon")]
            let step = match step {
                Step::ClearUntil(until) if self.parallel && until < self.scene.end => {
                    self.search_in_parallel(until)
                }
                other => other,
            };
            match step {
                Step::Answer(outcome) => return outcome,
                Step::ClearUntil(until) if until >= self.scene.end => return Outcome::Separated,
                Step::ClearUntil(until) => next = self.window_from(until),
            }
        }
        Outcome::Separated
    }
}
