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
        "slicing.time(last + 1));\n",
        "slicing.time(last));\n",
        "crates/d2m/tests/world.rs::changes_in_any_order_give_what_brute_force_gives",
    ),
    patch(
        "a pair is searched from the first time at which it may be in contact on, and a little later",
        "crates/d2m/src/world/schedule.rs",
        "slicing.time(first).max(meeting)",
        "slicing.time(first + 1).max(meeting)",
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
    patch(
        "a ball about the reference point that does not reach round the body",
        "crates/d2m/src/moving_ball.rs",
        "(off.norm() + rounded +",
        "(rounded +",
        "crates/d2m/src/moving_ball.rs::a_ball_holds_its_body_at_all_times",
    ),
    patch(
        "balls that touch within their separation are proven apart",
        "crates/d2m/src/moving_ball.rs",
        "(self.radius + other.radius + separation)",
        "(self.radius + other.radius)",
        "crates/d2m/src/moving_ball.rs::nothing_is_late_in_any_unit",
    ),
    patch(
        "balls that are apart at one end of a span only",
        "crates/d2m/src/moving_ball.rs",
        "is_apart(direction, begin) && is_apart(direction, until)",
        "is_apart(direction, begin)",
        "crates/d2m/src/moving_ball.rs::nothing_is_late_in_any_unit",
    ),
    patch(
        "a changed box keeps the bounds above it",
        "crates/d2m/src/box_tree.rs",
        "self.refit_above(boxes, place);",
        "let _ = place;",
        "crates/d2m/src/box_tree.rs::finds_exactly_the_pairs_that_brute_force_finds",
    ),
    patch(
        "bodies outside of the tree meet nothing",
        "crates/d2m/src/box_tree.rs",
        "(self.order.len() as u32..boxes.len() as u32).for_each(compare);",
        "",
        "crates/d2m/src/box_tree.rs::finds_exactly_the_pairs_that_brute_force_finds",
    ),
    patch(
        "where the budget ends, all other pairs are taken to be free for as long",
        "crates/d2m/src/world/search.rs",
        "goal == Goal::First && !self.schedule.may_begin_before(earliest)",
        "goal == Goal::First",
        "crates/d2m/src/world/tests.rs::a_budget_that_ends_says_nothing_of_pairs_behind_one_that_is_known",
    ),
];
