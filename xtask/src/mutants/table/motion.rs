//! Deliberate faults in `d2m-motion`.
use super::{Mutant, in_test, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    // Motions.
    patch(
        "screws leave out rotations whose squares underflow",
        "crates/d2m-motion/src/screw.rs",
        "(size > 0.0).then(",
        "(size * size > 0.0).then(",
        "crates/d2m-motion/src/tests.rs::screws_turn_at_any_rate",
    ),
    patch(
        "jerk of a path without 3U",
        "crates/d2m-motion/src/relative/bounds.rs",
        "(3.0 * k.across + k.b * k.swept_within(reach))",
        "(k.b * k.swept_within(reach))",
        "crates/d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    patch(
        "half of K3 in the third derivative of a path",
        "crates/d2m-motion/src/relative/bounds.rs",
        "across, k3, k4, rounding }",
        "across, k3: 0.5 * k3, k4, rounding }",
        "crates/d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    patch(
        "rounding of frames not counted",
        "crates/d2m-motion/src/relative/bounds.rs",
        "const ROUNDING: f64 = 128.0;",
        "const ROUNDING: f64 = 0.0;",
        "crates/d2m-motion/src/relative/tests.rs::remainders_hold_and_are_nearly_reached",
    ),
    patch(
        "rounding of an anchored position not counted",
        "crates/d2m-motion/src/relative/anchor.rs",
        "const ROUNDING: f64 = 32.0;",
        "const ROUNDING: f64 = 0.0;",
        "crates/d2m-motion/src/relative/tests.rs::directions_and_anchors_keep_their_remainders",
    ),
    patch(
        "what a number leaves of the time of a retimed motion is dropped",
        "crates/d2m-motion/src/retimed.rs",
        "let moved = here.linear.center * rest;",
        "let moved = here.linear.center * (0.0 * rest);",
        "crates/d2m-motion/src/retimed.rs::states_are_sharp_far_from_the_origin_of_time",
    ),
    patch(
        "Coriolis acceleration once in a composition",
        "crates/d2m-motion/src/kinematics.rs",
        "+ coriolis\n                    + coriolis",
        "+ coriolis",
        "crates/d2m-motion/src/chain_tests.rs::enclosures_of_chains_hold_and_are_tight",
    ),
    patch(
        "nine tenths of a span in the value of a joint",
        "crates/d2m-motion/src/joint_value.rs",
        "let r = up(half + lost.abs());",
        "let r = up(0.9 * half + lost.abs());",
        "crates/d2m-motion/src/chain_tests.rs::enclosures_of_chains_hold_and_are_tight",
    ),
    in_test(
        "K3 = w³, no bY in V, a remainder without E",
        "crates/d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    in_test(
        "a term of the third derivative of any motion left out",
        "crates/d2m-motion/src/relative/any_tests.rs::the_third_derivative_is_bounded_with_every_term",
    ),
];
