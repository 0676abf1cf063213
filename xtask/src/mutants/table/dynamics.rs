//! Deliberate faults in the simulation of `d2m-dynamics`.
use super::{Mutant, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    patch(
        "impulses may add what energy they like",
        "crates/d2m-dynamics/src/account.rs",
        "if excess.is_nan() || excess <= 0.0 {",
        "if excess.is_nan() || excess <= f64::MAX {",
        "crates/d2m-dynamics/src/account.rs::impulses_between_two_bodies_add_none",
    ),
    patch(
        "accounts forget what bodies have gained before",
        "crates/d2m-dynamics/src/account.rs",
        "let gained = held + (after - before);",
        "let gained = (after - before).max(held - held);",
        "crates/d2m-dynamics/src/account.rs::accounts_are_paid_from_velocities_against_each_other",
    ),
    patch(
        "room is made whatever it lifts",
        "crates/d2m-dynamics/src/account.rs",
        "(1.0 - left / lift).max(0.0)",
        "1.0",
        "crates/d2m-dynamics/src/account.rs::room_is_made_as_far_as_the_account_goes",
    ),
    patch(
        "flights that events cut keep the velocity of longer ones",
        "crates/d2m-dynamics/src/step/plan.rs",
        "const UNBALANCED: f64 = 1.0 / 4096.0;",
        "const UNBALANCED: f64 = 1e9;",
        "crates/d2m-dynamics/tests/energy.rs::a_falling_chain_gains_none",
    ),
    patch(
        "contacts that flights lead to are left to events",
        "crates/d2m-dynamics/src/step/expect.rs",
        "const MOST_ROUNDS: u32 = 4;",
        "const MOST_ROUNDS: u32 = 0;",
        "crates/d2m-dynamics/tests/energy.rs::a_pile_without_restitution_meets_no_events_and_gains_none",
    ),
    patch(
        "of the corners that land flat only those within the gap are met",
        "crates/d2m-dynamics/src/contact/rows.rs",
        "const NEAR: f64 = 1.5;",
        "const NEAR: f64 = 1.0;",
        "crates/d2m-dynamics/tests/scenes.rs::cubes_without_friction_fall_flat_and_stack",
    ),
    patch(
        "contacts where hardly any room is left push along the normals of faces only",
        "crates/d2m-dynamics/src/pairs.rs",
        "const TIGHT: f64 = 0.3;",
        "const TIGHT: f64 = 0.0;",
        "crates/d2m-dynamics/tests/hostile.rs::cubes_that_fall_on_each_others_edges_keep_moving",
    ),
    patch(
        "bodies whose spheres overlap are not queried",
        "crates/d2m-dynamics/src/step/flights.rs",
        "distance - closer - a.radius - b.radius - gap > SPHERES * sizes",
        "distance - closer - 0.5 * (a.radius + b.radius) - gap > SPHERES * sizes",
        "crates/d2m-dynamics/tests/scenes.rs::head_on",
    ),
    patch(
        "spheres are compared without the rounding of their distance",
        "crates/d2m-dynamics/src/step/flights.rs",
        "const SPHERES: f64 = 32.0 * f64::EPSILON;",
        "const SPHERES: f64 = 0.0;",
        "crates/d2m-dynamics/src/step/flights.rs::spheres_that_overlap_by_less_than_rounding_are_not_apart",
    ),
    patch(
        "bodies that bounce keep no speed",
        "crates/d2m-dynamics/src/contact/impact.rs",
        "-scale * contacts[k].material.restitution * rates[k]",
        "-0.5 * scale * contacts[k].material.restitution * rates[k]",
        "crates/d2m-dynamics/tests/scenes.rs::head_on",
    ),
    patch(
        "the inertia of a mesh counts the sums of corners twice",
        "crates/d2m-dynamics/src/mass/mod.rs",
        "s[j] * s[k]) / 20.0",
        "2.0 * s[j] * s[k]) / 20.0",
        "crates/d2m-dynamics/src/mass/tests.rs::far_from_the_origin_and_turned",
    ),
    patch(
        "flights end after the contact, not before",
        "crates/d2m-dynamics/src/step/flights.rs",
        "event(lo, hi, Cause::Contact)",
        "event(hi + 1e-4, hi + 1e-4, Cause::Contact)",
        "crates/d2m-dynamics/tests/scenes.rs::a_bullet_stops_at_a_plate",
    ),
];
