//! Deliberate faults in the simulation of `d2m-dynamics`.
use super::{Mutant, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    patch(
        "flights that events cut keep the velocity of longer ones",
        "crates/d2m-dynamics/src/step/plan.rs",
        "const UNBALANCED: f64 = 1.0 / 4096.0;",
        "const UNBALANCED: f64 = 1e9;",
        "crates/d2m-dynamics/tests/energy.rs::a_falling_chain_gains_none",
    ),
    patch(
        "flights end after the contact, not before",
        "crates/d2m-dynamics/src/step/flights.rs",
        "event(lo, hi, Cause::Contact)",
        "event(hi + 1e-4, hi + 1e-4, Cause::Contact)",
        "crates/d2m-dynamics/tests/scenes.rs::a_bullet_stops_at_a_plate",
    ),
];
