//! Deliberate faults in `d2m-feature`.
use super::{Mutant, in_test, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    // Features.
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
        "Band { lo: lo - margin, hi: hi + margin }",
        "Band { lo: hi + margin, hi: f64::INFINITY }",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    patch(
        "the plane without the path's remainder",
        "crates/d2m-feature/src/point_triangle/mod.rs",
        "plane.clip(planes.slab(), |h| remainder.bound(h), searched)",
        "plane.clip(planes.slab(), |h| 0.0 * remainder.bound(h), searched)",
        "crates/d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    in_test(
        "the paper's literal Algorithm 5",
        "crates/d2m-feature/tests/paper_enclosures.rs::half_twice_loses_an_overlap",
    ),
];
