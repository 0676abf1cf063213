//! Deliberate faults in `d2m-root`.
use super::{Mutant, in_test, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    // Roots.
    patch(
        "½ twice in the inclusion function",
        "crates/d2m-root/src/inclusion_function.rs",
        "Parabola::new(self.value.lo(), self.slope.lo(), self.second_derivative.lo())",
        "Parabola::new(self.value.lo(), self.slope.lo(), 0.5 * self.second_derivative.lo())",
        "crates/d2m-root/tests/paper_errata.rs::half_twice_is_late",
    ),
    patch(
        "what lies behind a refused root is dropped",
        "crates/d2m-root/src/hrfoi.rs",
        "if part.hi() < piece.hi() {",
        "if part.hi() < part.lo() {",
        "crates/d2m-root/tests/paper_errata.rs::a_refused_root_does_not_end_the_search",
    ),
    patch(
        "a sphere pair is judged at the epoch",
        "crates/d2m-root/src/inclusion_function.rs",
        "let p = if shift.hi() <= 0.0 {",
        "let p = if shift.hi() < f64::INFINITY {",
        "crates/d2m-root/src/inclusion_function.rs::judged_at_the_start_of_what_is_searched",
    ),
    patch(
        "the first zero of a quadratic rounded up",
        "crates/d2m-root/src/isolator/quadratic.rs",
        "const EARLY: f64 = 1.0 - 16.0 * UNIT;",
        "const EARLY: f64 = 1.0 + 16.0 * UNIT;",
        "crates/d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "½ twice in the discriminant of the isolator",
        "crates/d2m-root/src/isolator/quadratic.rs",
        "let product = 2.0 * gap * curvature;",
        "let product = gap * curvature;",
        "crates/d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "the isolator drops what lies behind a clear part",
        "crates/d2m-root/src/isolator/search.rs",
        "rest.push(Piece { lo: clear_hi, ..piece });",
        "",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    in_test("the paper's literal Algorithm 2", "crates/d2m-root/tests/paper_errata.rs::half_twice_is_late"),
];
