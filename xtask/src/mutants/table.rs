//! The deliberate faults. docs/guarantees.md holds the same table; `cargo xtask tidy` compares the two and checks that
//! each text still occurs exactly once.

/// A fault and the test that must notice it.
pub(crate) struct Mutant {
    pub(crate) name: &'static str,
    pub(crate) change: Change,
    /// `file.rs::test`.
    pub(crate) test: &'static str,
}

/// What is wrong.
#[derive(Clone, Copy)]
pub(crate) enum Change {
    /// In this file this text, which occurs once, becomes that.
    Patch { file: &'static str, from: &'static str, to: &'static str },
    /// The test makes the wrong variant itself and asserts that the same samples refute it.
    InTest,
}

const fn patch(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
    test: &'static str,
) -> Mutant {
    Mutant { name, change: Change::Patch { file, from, to }, test }
}

const fn in_test(name: &'static str, test: &'static str) -> Mutant {
    Mutant { name, change: Change::InTest, test }
}

pub(crate) const MUTANTS: &[Mutant] = &[
    // Intervals.
    patch(
        "no outward rounding",
        "d2m-interval/src/round.rs",
        "x.abs().times(F64x2::splat(HALF_ULP)).plus(F64x2::splat(TINY))",
        "x.abs().times(F64x2::splat(0.0))",
        "d2m-interval/tests/differential.rs::no_loss_and_tight",
    ),
    patch(
        "underflow is not covered",
        "d2m-interval/src/round.rs",
        "pub(crate) const TINY: f64 = f64::from_bits((1023 - 501) << 52);",
        "pub(crate) const TINY: f64 = 0.0;",
        "d2m-interval/tests/special_cases.rs::overflow_and_underflow",
    ),
    patch(
        "sine and cosine without the kernel's error",
        "d2m-interval/src/elementary/trig.rs",
        "pub(super) const PAD: f64 = f64::from_bits(0x3CAE_0000_0000_0000);",
        "pub(super) const PAD: f64 = 0.0;",
        "d2m-interval/tests/differential.rs::no_loss_and_tight",
    ),
    in_test(
        "outward rounding removed on one side, one last place inwards",
        "d2m-interval/tests/differential.rs::mutants_without_outward_rounding_die",
    ),
    in_test(
        "a forgotten extremum, a wrong quadrant of sine and cosine",
        "d2m-interval/tests/differential.rs::mutants_of_the_quadrant_die",
    ),
    // Motions.
    patch(
        "jerk of a path without 3U",
        "d2m-motion/src/relative/bounds.rs",
        "(3.0 * k.across + k.b * k.b * reach.min(k.reach))",
        "(k.b * k.b * reach.min(k.reach))",
        "d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    patch(
        "half of K2 in the acceleration of a path",
        "d2m-motion/src/relative/bounds.rs",
        "across, k2, k3, k4, rounding }",
        "across, k2: 0.5 * k2, k3, k4, rounding }",
        "d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    patch(
        "rounding of frames not counted",
        "d2m-motion/src/relative/bounds.rs",
        "const ROUNDING: f64 = 128.0;",
        "const ROUNDING: f64 = 0.0;",
        "d2m-motion/src/relative/tests.rs::remainders_hold_and_are_nearly_reached",
    ),
    in_test(
        "K3 = w³, no bY in V, a remainder without E",
        "d2m-motion/src/relative/tests.rs::bounds_of_the_derivatives_hold_and_are_nearly_reached",
    ),
    in_test(
        "a term of the third derivative of any motion left out",
        "d2m-motion/src/relative/any_tests.rs::the_third_derivative_is_bounded_with_every_term",
    ),
    in_test(
        "no margin, no stray in a batch",
        "d2m-feature/src/batch/tests.rs::planted_contacts_are_never_rejected_and_the_margin_is_needed",
    ),
    // Roots.
    patch(
        "½ twice in the inclusion function",
        "d2m-root/src/inclusion_function.rs",
        "Parabola::new(self.value.lo(), self.slope.lo(), self.second_derivative.lo())",
        "Parabola::new(self.value.lo(), self.slope.lo(), 0.5 * self.second_derivative.lo())",
        "d2m-root/tests/paper_errata.rs::half_twice_is_late",
    ),
    patch(
        "what lies behind a refused root is dropped",
        "d2m-root/src/hrfoi.rs",
        "if part.hi() < piece.hi() {",
        "if part.hi() < part.lo() {",
        "d2m-root/tests/paper_errata.rs::a_refused_root_does_not_end_the_search",
    ),
    patch(
        "a sphere pair is judged at the epoch",
        "d2m-root/src/inclusion_function.rs",
        "let p = if shift.hi() <= 0.0 {",
        "let p = if shift.hi() < f64::INFINITY {",
        "d2m-root/src/inclusion_function.rs::judged_at_the_start_of_what_is_searched",
    ),
    patch(
        "the first zero of a quadratic rounded up",
        "d2m-root/src/isolator/quadratic.rs",
        "const EARLY: f64 = 1.0 - 16.0 * UNIT;",
        "const EARLY: f64 = 1.0 + 16.0 * UNIT;",
        "d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "½ twice in the discriminant of the isolator",
        "d2m-root/src/isolator/quadratic.rs",
        "let product = 2.0 * gap * curvature;",
        "let product = gap * curvature;",
        "d2m-root/src/isolator/tests.rs::first_zeros_are_early_and_tight",
    ),
    patch(
        "the isolator drops what lies behind a clear part",
        "d2m-root/src/isolator/search.rs",
        "rest.push(Piece { lo: clear_hi, ..piece });",
        "",
        "d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    in_test("the paper's literal Algorithm 2", "d2m-root/tests/paper_errata.rs::half_twice_is_late"),
    // Features.
    patch(
        "Γ inverted, paper's vertex/face",
        "d2m-feature/src/paper/gamma/point_triangle.rs",
        "!side.certainly_apart(",
        "side.certainly_apart(",
        "d2m-feature/tests/paper_planted.rs::planted_vertex_face",
    ),
    patch(
        "Γ inverted, closed-form vertex/face",
        "d2m-feature/src/point_triangle/mod.rs",
        "Band { lo: lo - margin, hi: hi + margin }",
        "Band { lo: hi + margin, hi: f64::INFINITY }",
        "d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    patch(
        "the plane without the path's remainder",
        "d2m-feature/src/point_triangle/mod.rs",
        "plane.clip(planes.slab(), |h| remainder.bound(h), searched)",
        "plane.clip(planes.slab(), |h| 0.0 * remainder.bound(h), searched)",
        "d2m-feature/tests/first_contact.rs::planted_contacts_are_never_missed_and_never_late",
    ),
    in_test(
        "the paper's literal Algorithm 5",
        "d2m-feature/tests/paper_enclosures.rs::half_twice_loses_an_overlap",
    ),
    // Trees.
    patch(
        "extents of boxes not rounded outward",
        "d2m-bvh/src/tree/surface.rs",
        "let half = self.half.map(|h| round_up(h + slack));",
        "let half = self.half.map(|h| (h + slack) as f32);",
        "d2m-bvh/src/tree/tests.rs::boxes_enclose_in_more_than_double_precision",
    ),
    in_test("boxes of a tree shrunk", "d2m-bvh/src/tree/tests.rs::any_shrunk_or_broken_tree_is_refused"),
    patch(
        "edges of boxes cut off two steps too far",
        "d2m-bvh/src/tree/bevel.rs",
        "(room - 1e-9).min(f64::from(MOST))",
        "(room + 2.0).min(f64::from(MOST))",
        "d2m-bvh/src/tree/tests.rs::boxes_enclose_in_more_than_double_precision",
    ),
    // The default engine.
    patch(
        "the cut of another edge",
        "d2m-bvh/src/search/entry_time.rs",
        ".byte_of(cosines[i], cosines[j], along)",
        ".byte_of(cosines[j], cosines[i], along)",
        "d2m-bvh/src/search/entry_time.rs::bevelled_boxes_reach_as_far_as_their_points",
    ),
    patch(
        "along the line of the centres one of the boxes has no size",
        "d2m-bvh/src/search/entry_time.rs",
        "(reach_line.first() + reach_line.second())",
        "reach_line.first()",
        "d2m-bvh/src/search/tests.rs::entry_times_of_boxes_hold_and_are_sharp",
    ),
    patch(
        "the cut of the opposite edge",
        "d2m-bvh/src/search/node_test.rs",
        "bevels.to_bits().swap_bytes()",
        "bevels.to_bits()",
        "d2m-bvh/src/search/tests.rs::entry_times_of_boxes_hold_and_are_sharp",
    ),
    patch(
        "half of the spin of the opened box",
        "d2m-bvh/src/search/entry_time.rs",
        "L::splat(scale.spin[0]) * L::load(&wide.radius)",
        "L::splat(0.5 * scale.spin[0]) * L::load(&wide.radius)",
        "d2m-bvh/src/search/tests.rs::half_the_spin_is_noticed",
    ),
    patch(
        "half of the spin of the other box",
        "d2m-bvh/src/search/node_test.rs",
        "let swing = scale.spin[1] * radius;",
        "let swing = 0.5 * scale.spin[1] * radius;",
        "d2m-bvh/src/search/tests.rs::half_the_spin_is_noticed",
    ),
    patch(
        "gaps of boxes without their error: −0.02 of the margin",
        "d2m-bvh/src/search/node_test.rs",
        "gap_margin: GAP_ERROR * (norm(&center)",
        "gap_margin: -0.02 * GAP_ERROR * (norm(&center)",
        "d2m-bvh/src/search/tests.rs::boxes_called_apart_at_rest_are_apart",
    ),
    patch(
        "no acceleration of boxes",
        "d2m-bvh/src/search/scene.rs",
        "acceleration: round_up(acceleration),",
        "acceleration: 0.0 * acceleration as f32,",
        "d2m-bvh/src/search/tests.rs::half_the_acceleration_is_noticed",
    ),
    patch(
        "nine tenths of the level",
        "d2m-bvh/src/search/scene.rs",
        "floor: round_up((self.pair.level *",
        "floor: round_up((0.9 * self.pair.level *",
        "d2m-bvh/src/search/tests.rs::entry_times_of_boxes_hold_and_are_sharp",
    ),
    patch(
        "½ twice in the time of triangles",
        "d2m-bvh/src/search/triangle_pair.rs",
        "let root = (v * v + 2.0 * m * g).sqrt();",
        "let root = (v * v + m * g).sqrt();",
        "d2m-bvh/src/search/tests.rs::half_the_acceleration_of_triangles_is_noticed",
    ),
    patch(
        "half of the acceleration of triangles",
        "d2m-bvh/src/search/triangle_pair.rs",
        "first_time(low, high, need, scale.acceleration * length)",
        "first_time(low, high, need, 0.5 * scale.acceleration * length)",
        "d2m-bvh/src/search/tests.rs::half_the_acceleration_of_triangles_is_noticed",
    ),
    patch(
        "the circles of a sweep smaller by 1e-5",
        "d2m-bvh/src/search/swept.rs",
        "(n - self.body.axis * along).length() * self.ring.far",
        "(n - self.body.axis * along).length() * self.ring.far * 0.99999",
        "d2m-bvh/src/search/swept.rs::sweeps_reach_exactly_as_far_as_the_bodies",
    ),
    patch(
        "the hole of a sweep wider by 1e-5",
        "d2m-bvh/src/search/swept.rs",
        "take(outer.ring.near - far, -drift);",
        "take(outer.ring.near + 1e-5 - far, -drift);",
        "d2m-bvh/src/search/swept.rs::sweeps_inside_a_hole",
    ),
    patch(
        "the drift of a sweep not counted",
        "d2m-bvh/src/search/swept.rs",
        "let drift = n.dot(self.velocity);",
        "let drift = 0.9 * n.dot(self.velocity);",
        "d2m-bvh/src/search/swept.rs::sweeps_end_in_time",
    ),
    patch(
        "triangles of one class taken for equal",
        "d2m-bvh/src/search/picture.rs",
        "one.slack = one.slack.max(beside * (1.0 + 1e-12));",
        "one.slack = one.slack.max(0.0 * beside);",
        "d2m-bvh/src/search/helix.rs::triangles_of_a_class_count_where_they_are",
    ),
    patch(
        "looking back with the velocities of looking forward",
        "d2m-bvh/src/search/frame.rs",
        "let back = |v: &Quad| (D::splat(0.0) - D::load(v)).store();",
        "let back = |v: &Quad| D::load(v).store();",
        "d2m-bvh/src/search/tests.rs::half_the_acceleration_of_triangles_is_noticed",
    ),
    in_test(
        "another pitch, half of the climb, no drift of a screw",
        "d2m-bvh/src/search/helix.rs::mutants_of_the_screw_die",
    ),
    in_test(
        "half of the third derivative of triangles, accelerations about another point",
        "d2m-bvh/src/search/tests.rs::mutants_of_the_third_derivative_die",
    ),
    patch(
        "the frame passes an item that waits",
        "d2m-bvh/src/search/queue.rs",
        "self.least = self.least.min(item.key);",
        "self.least = item.key;",
        "d2m-bvh/src/search/queue.rs::no_live_key_is_below_the_one_handed_out",
    ),
    patch(
        "registers pack the pairs of other lanes",
        "d2m-bvh/src/search/avx.rs",
        "order[bits] |= lane << (8 * place);",
        "order[bits] |= (7 - lane) << (8 * place);",
        "d2m-bvh/tests/instruction_sets.rs::a_limit_changes_no_bit_of_any_answer",
    ),
    patch(
        "late by 1e-6",
        "d2m-bvh/src/query/report.rs",
        "let time = crate::search::time_from(found.start, found.offset)",
        "let time = (1e-6 + crate::search::time_from(found.start, found.offset))",
        "d2m-bvh/tests/engine.rs::separation_at_lo_is_what_is_promised_and_nothing_touches_before",
    ),
    patch(
        "a contact is called clear",
        "d2m-bvh/src/search/window.rs",
        "Some(found) if found.offset <= length => Step::Answer(Outcome::Found(found)),",
        "Some(found) if found.offset < 0.0 * length => Step::Answer(Outcome::Found(found)),",
        "d2m-bvh/tests/engine.rs::separation_at_lo_is_what_is_promised_and_nothing_touches_before",
    ),
    patch(
        "the end of the budget is called clear",
        "d2m-bvh/src/query/time_of_contact.rs",
        "Outcome::OutOfBudget(until) => TimeOfContact::Undecided { clear_until: until },",
        "Outcome::OutOfBudget(_) => TimeOfContact::Separated,",
        "d2m-bvh/tests/engine.rs::modes_and_budgets_are_consistent",
    ),
    patch(
        "a body inside the other is not looked for",
        "d2m-bvh/src/query/time_of_contact.rs",
        "        && start_decided\n",
        "        && !start_decided\n",
        "d2m-bvh/tests/engine.rs::starts_that_touch_cross_or_hold",
    ),
    patch(
        "spins that differ from query to query count half",
        "d2m-bvh/src/query/course.rs",
        "let turning = (self.omegas[k] - earlier.omegas[k]).length() * common;",
        "let turning = (self.omegas[k] - earlier.omegas[k]).length() * common * 0.5;",
        "d2m-bvh/src/query/course.rs::deviations_hold_and_each_term_is_needed",
    ),
    patch(
        "a refit body passes for the same",
        "d2m-bvh/src/tree/refit.rs",
        "*self = Self::from_nodes(mesh, nodes, &extent);",
        "*self = Self { stamp: self.stamp, ..Self::from_nodes(mesh, nodes, &extent) };",
        "d2m-bvh/tests/warm_start.rs::a_refit_is_noticed",
    ),
    patch(
        "what other threads found is taken unexamined",
        "d2m-bvh/src/search/ahead.rs",
        "searched.filter(|searched| self.would_do_the_same(&known, searched))",
        "searched",
        "d2m-bvh/src/search/ahead.rs::any_number_of_threads_does_the_same",
    ),
    patch(
        "twice the step of conservative advancement",
        "d2m-bvh/src/query/any_motion.rs",
        "(t + free).next_down().min(until)",
        "(t + 2.0 * free).next_down().min(until)",
        "d2m-bvh/tests/engine.rs::any_motion_agrees_with_the_closed_form",
    ),
    in_test(
        "nine tenths of the level or of the speeds of boxes",
        "d2m-bvh/src/search/tests.rs::mutants_of_the_entry_times_die",
    ),
    in_test("half of the spin of a needle", "d2m-bvh/src/search/tests.rs::half_the_spin_is_noticed"),
    // Static queries.
    patch(
        "the distance's lower bound is its upper bound",
        "d2m-bvh/src/query/distance.rs",
        "Found::Pair(Best { lower: lower * (1.0 - 2.0 * UNIT_F64), ..best })",
        "Found::Pair(Best { lower: lower.max(best.distance.upper * 1.0001), ..best })",
        "d2m-bvh/tests/static_query.rs::random_solids_and_soups",
    ),
    patch(
        "collide looks at the first child only",
        "d2m-bvh/src/query/collide.rs",
        "lanes &= lanes - 1;",
        "lanes = 0;",
        "d2m-bvh/tests/static_query.rs::random_solids_and_soups",
    ),
    patch(
        "the crossing pair that was met first is told",
        "d2m-bvh/src/query/distance.rs",
        "=> Found::Pair(crossing(&scene, best)),",
        "=> Found::Pair(best),",
        "d2m-bvh/tests/static_query.rs::random_solids_and_soups",
    ),
    // The reference method.
    patch(
        "only the first bracket of a vertex/face pair is searched",
        "d2m-bvh/src/paper/leaf_pair.rs",
        "still_open(Interval::new(part.lo(), jet.span().hi()), best.as_ref())",
        "still_open(part, best.as_ref())",
        "d2m-bvh/tests/paper.rs::every_scene_has_its_answer",
    ),
    patch(
        "a leaf pair without its edges",
        "d2m-bvh/src/paper/leaf_pair.rs",
        "        self.edges(&frames[0], best, meter)\n",
        "        Ok(())\n",
        "d2m-bvh/tests/paper.rs::every_scene_has_its_answer",
    ),
    patch(
        "only the earliest pair of spheres is followed",
        "d2m-bvh/src/paper/traverse.rs",
        "for (i, &(overlap, part_a, part_b)) in pairs.iter().enumerate() {",
        "for (i, &(overlap, part_a, part_b)) in pairs.iter().enumerate().take(1) {",
        "d2m-bvh/tests/paper.rs::every_scene_has_its_answer",
    ),
    in_test(
        "answers of both methods early or late by 1e-8",
        "d2m-bvh/src/paper/cross_check.rs::the_judge_has_teeth",
    ),
    // The evaluation itself.
    in_test("an engine that is late by 1e-6, or misses", "xtask/src/judge/tests.rs::faults_are_found"),
    in_test(
        "accuracy and bench asked of a broken engine",
        "xtask/src/accuracy/teeth.rs::a_broken_engine_is_noticed",
    ),
];
