//! Deliberate faults in the simulation of `d2m-dynamics`.
use super::{Mutant, patch};

pub(super) const MUTANTS: &[Mutant] = &[patch(
    "flights end after the contact, not before",
    "crates/d2m-dynamics/src/step.rs",
    "event(lo, hi, Cause::Contact)",
    "event(hi + 1e-4, hi + 1e-4, Cause::Contact)",
    "crates/d2m-dynamics/tests/scenes.rs::a_bullet_stops_at_a_plate",
)];
