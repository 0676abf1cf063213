//! Deliberate faults in `d2m-feature`.
use super::{Mutant, in_test, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    // Features.
    patch(
        "straight paths in the units of the input",
        "crates/d2m-feature/src/straight_path/mod.rs",
        "Units::of_size(most.max_element())",
        "Units::of_size(0.0)",
        "crates/d2m-feature/tests/scaling.rs::exact_scalings_of_straight_paths_change_nothing",
    ),
    patch(
        "a pair of motions in the units of the input",
        "crates/d2m-feature/src/pair_motion.rs",
        "Units::of_motions(&motions, t0, t1)",
        "Units::NONE",
        "crates/d2m-feature/tests/scaling.rs::exact_scalings_change_no_verdict_and_no_relative_time",
    ),
    patch(
        "features called small that are not",
        "crates/d2m-feature/src/units.rs",
        "exponent(size) < self.length - EXPONENT_OF_RANGE",
        "exponent(size) < i32::MAX",
        "crates/d2m-feature/tests/scaling.rs::features_and_motions_of_different_sizes",
    ),
    patch(
        "rounding of a straight point not counted",
        "crates/d2m-feature/src/straight_path/point_triangle.rs",
        "lines.error(48.0)",
        "lines.error(0.0)",
        "crates/d2m-feature/tests/exactly_planted.rs::straight_paths_that_touch_exactly",
    ),
    patch(
        "rounding of straight edges not counted",
        "crates/d2m-feature/src/straight_path/edge_edge.rs",
        "lines.error(64.0)",
        "lines.error(0.0)",
        "crates/d2m-feature/tests/exactly_planted.rs::straight_paths_that_touch_exactly",
    ),
    patch(
        "separation left out of the volume of straight paths",
        "crates/d2m-feature/src/straight_path/triple_product.rs",
        "(separation * lb * lc + rounding)",
        "rounding",
        "crates/d2m-feature/tests/exactly_planted.rs::straight_paths_that_touch_exactly",
    ),
    patch(
        "separation left out of parts seen along a normal",
        "crates/d2m-feature/src/straight_path/triple_product.rs",
        " + separation * ly;",
        ";",
        "crates/d2m-feature/tests/exactly_planted.rs::straight_paths_that_touch_exactly",
    ),
    patch(
        "two quadratics without their sagitta",
        "crates/d2m-feature/src/edge_edge/products.rs",
        "width * width * (0.125 * (1.0 + 4.0 * f64::EPSILON))",
        "width * width * (0.125 * (1.0 - 4096.0 * f64::EPSILON))",
        "crates/d2m-feature/src/edge_edge/products.rs::two_quadratics_that_exceed_are_positive",
    ),
    patch(
        "half of the radius about a triangle",
        "crates/d2m-feature/src/point_triangle/planes.rs",
        "length_up(v - center)",
        "0.5 * length_up(v - center)",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    patch(
        "the distance along the axis in place of the one across it",
        "crates/d2m-motion/src/relative/bounds.rs",
        "length(omega.cross(v))",
        "length(omega * (omega.dot(v) / (omega.length() + f64::MIN_POSITIVE)))",
        "crates/d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    patch(
        "a plain normal of nearly parallel edges",
        "crates/d2m-feature/src/accurate_cross.rs",
        "difference + (lost + ((p_error - q_error) + low))",
        "difference + 0.0 * (lost + ((p_error - q_error) + low))",
        "crates/d2m-feature/src/triangle_distance/tests.rs::edges_that_cross_at_small_angles",
    ),
    patch(
        "Γ inverted, paper's vertex/face",
        "crates/d2m-feature/src/paper/gamma/point_triangle.rs",
        "!side.certainly_apart(",
        "side.certainly_apart(",
        "crates/d2m-feature/tests/paper_planted.rs::planted_vertex_face",
    ),
    patch(
        "Γ inverted, closed-form vertex/face",
        "crates/d2m-feature/src/point_triangle/mod.rs",
        "side.clip_beyond(Band { lo, hi }, margin, beside)",
        "side.clip_beyond(Band { lo: hi + 2.0 * margin, hi: f64::INFINITY }, margin, beside)",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    patch(
        "the plane without the path's remainder",
        "crates/d2m-feature/src/point_triangle/mod.rs",
        "plane.clip_beyond(planes.slab, |h| remainder.bound(h), searched)",
        "plane.clip(planes.slab, |h| 0.0 * remainder.bound(h), searched)",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    in_test(
        "the paper's literal Algorithm 5",
        "crates/d2m-feature/tests/paper_enclosures.rs::half_twice_loses_an_overlap",
    ),
];
