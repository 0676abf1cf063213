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
        "crates/d2m-root/src/isolator/first_zero_bound.rs",
        "const EARLY: f64 = 1.0 - 16.0 * UNIT;",
        "const EARLY: f64 = 1.0 + 16.0 * UNIT;",
        "crates/d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "½ twice in the discriminant of the isolator",
        "crates/d2m-root/src/isolator/first_zero_bound.rs",
        "let product = 2.0 * gap * curvature;",
        "let product = gap * curvature;",
        "crates/d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "both ends of a contracted piece are rebuilt from its middle",
        "crates/d2m-root/src/isolator/cubic.rs",
        "let moved = Piece { lo: down(part.lo - m), hi: up(part.hi - m) };",
        "let moved = Piece { lo: part.lo - m, hi: part.hi - m };\npart = Piece { lo: m + moved.lo, hi: m + moved.hi };",
        "crates/d2m-root/tests/exact.rs::a_linear_function_keeps_its_zero_at_an_end",
    ),
    patch(
        "a quadratic's own rounding is not counted",
        "crates/d2m-root/src/isolator/quadratic.rs",
        "const EVALUATION: f64 = 9.0 * UNIT;",
        "const EVALUATION: f64 = 0.0 * UNIT;",
        "crates/d2m-root/tests/exact.rs::planted_quadratics_keep_their_zero",
    ),
    patch(
        "a cubic's own rounding is not counted",
        "crates/d2m-root/src/isolator/cubic.rs",
        "* UNIT + UNDERFLOW",
        "* 0.0 + UNDERFLOW",
        "crates/d2m-root/tests/exact.rs::cubics_lose_no_time_in_the_band",
    ),
    patch(
        "a cube of a short time meets the jerk after it vanished",
        "crates/d2m-root/src/isolator/cubic.rs",
        "curvature: self.curvature + self.jerk * m,\n        };\n        (quadratic, (1.0 / 24.0) * self.jerk.abs() * r * r * r)",
        "curvature: self.curvature + self.jerk * m,\n        };\n        (quadratic, (1.0 / 24.0) * self.jerk.abs() * (r * r * r))",
        "crates/d2m-root/tests/exact.rs::products_beyond_the_range_of_doubles_are_not_late",
    ),
    patch(
        "a discriminant that underflows",
        "crates/d2m-root/src/isolator/first_zero_bound.rs",
        "size > LEAST_SIZE &&",
        "size >= 0.0 &&",
        "crates/d2m-root/tests/exact.rs::products_beyond_the_range_of_doubles_are_not_late",
    ),
    patch(
        "a zero that overflows",
        "crates/d2m-root/src/isolator/first_zero_bound.rs",
        " && zero < GREATEST_ZERO {",
        " {",
        "crates/d2m-root/tests/exact.rs::products_beyond_the_range_of_doubles_are_not_late",
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
