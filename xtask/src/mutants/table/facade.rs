//! Deliberate faults in the broad phase and the worlds of `d2m`.
use super::{Mutant, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    patch(
        "boxes of bodies without the reach of the body",
        "crates/d2m-bvh/src/tree/placed_bounds.rs",
        "let reach = reach.hi().min(radius.hi());",
        "let reach = 0.9 * reach.hi().min(radius.hi());",
        "crates/d2m-bvh/src/tree/placed_bounds.rs::every_vertex_stays_inside_and_little_room_is_left",
    ),
    patch(
        "what was proven of a pair outlives a change of its bodies",
        "crates/d2m/src/world/search.rs",
        "state.versions == entry.versions",
        "state.versions <= entry.versions",
        "crates/d2m/tests/world.rs::changes_in_any_order_give_what_brute_force_gives",
    ),
    patch(
        "the last slice in which bodies may meet is left out",
        "crates/d2m/src/world/schedule.rs",
        "end: slicing.time(last + 1)",
        "end: slicing.time(last)",
        "crates/d2m/tests/world.rs::changes_in_any_order_give_what_brute_force_gives",
    ),
    patch(
        "a pair is searched from the first time at which it may be in contact on, and a little later",
        "crates/d2m/src/world/schedule.rs",
        "start: slicing.time(first)",
        "start: slicing.time(first + 1)",
        "crates/d2m/tests/world.rs::changes_in_any_order_give_what_brute_force_gives",
    ),
    patch(
        "a changed body keeps the boxes of its old motion",
        "crates/d2m/src/world/schedule.rs",
        "self.enclose(rules.slots, span, changed);",
        "",
        "crates/d2m/tests/world.rs::changes_in_any_order_give_what_brute_force_gives",
    ),
    patch(
        "pairs with a larger separation of their own are found by the usual one only",
        "crates/d2m/src/world/filter.rs",
        "separation.is_nan() || separation > usual",
        "separation.is_nan()",
        "crates/d2m/tests/hostile_world.rs::a_huge_separation_is_that_of_its_pair",
    ),
];
