//! Deliberate faults in `d2m-interval`.
use super::{Mutant, in_test, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    // Intervals.
    patch(
        "no outward rounding",
        "crates/d2m-interval/src/round.rs",
        "x.abs() * F64x2::splat(HALF_ULP) + F64x2::splat(TINY)",
        "x.abs() * F64x2::splat(0.0)",
        "crates/d2m-interval/tests/differential.rs::no_loss_and_tight",
    ),
    patch(
        "underflow is not covered",
        "crates/d2m-interval/src/round.rs",
        "pub(crate) const TINY: f64 = power_of_two(-501);",
        "pub(crate) const TINY: f64 = 0.0;",
        "crates/d2m-interval/tests/special_cases.rs::overflow_and_underflow",
    ),
    patch(
        "sine and cosine without the kernel's error",
        "crates/d2m-interval/src/elementary/trig.rs",
        "pub(super) const PAD: f64 = f64::from_bits(0x3CAE_0000_0000_0000);",
        "pub(super) const PAD: f64 = 0.0;",
        "crates/d2m-interval/tests/differential.rs::no_loss_and_tight",
    ),
    patch(
        "widths of intervals are compared after rounding",
        "crates/d2m-interval/src/round.rs",
        "    exact_difference(a, b) < exact_difference(c, d)\n}",
        "    a - b < c - d\n}",
        "crates/d2m-interval/tests/laws.rs::a_point_is_narrower_than_the_narrowest_interval",
    ),
    patch(
        "a fused product of large numbers is rounded twice",
        "crates/d2m-interval/src/arith.rs",
        "            fused_up_large(a, b, c, negated)\n",
        "            up(up(flip(product)) + flip(c))\n",
        "crates/d2m-interval/tests/laws.rs::fused_products_beyond_1e299",
    ),
    patch(
        "hexadecimal digits that are cut off count as zeros",
        "crates/d2m-interval/src/text/number.rs",
        "result.cut_off |= digit != 0;",
        "result.cut_off |= digit > 15;",
        "crates/d2m-interval/tests/text.rs::any_number_of_digits_is_read_exactly",
    ),
    in_test(
        "outward rounding removed on one side, one last place inwards",
        "crates/d2m-interval/tests/differential.rs::mutants_without_outward_rounding_die",
    ),
    in_test(
        "a forgotten extremum, a wrong quadrant of sine and cosine",
        "crates/d2m-interval/tests/differential.rs::mutants_of_the_quadrant_die",
    ),
];
