//! When each mechanism of a search starts, and what it may cost.
//!
//! A search begins with what ordinary queries need and reaches for stronger, dearer means only where those have not sufficed.
//! Nothing here proves anything: any other numbers give answers as right, only later. They were found by measurement
//! (`docs/experiments.md`; "What each mechanism is worth" there).
//!
//! | mechanism | starts | gives up, or waits | where it is |
//! |---|---|---|---|
//! | bounds of second order for pairs of triangles | at once | – | [`separating_axis`] |
//! | boxes that pass each other | after 48 batches of a sub-window | – | `boxes/passing` |
//! | bounds of third order | after 192 tests of the search, or 16 of the pair | – | [`separating_axis`] |
//! | directions that turn with the bodies | after 1024 tests of the search, or 24 of the pair | – | `triangle_pair/turning` |
//! | a pair followed at once | when it is handed out | its time grew by 1/16, or 64 steps when out of turn | `pairs` |
//! | a fresh frame | the time grew by 1/128 | – | `best_first` |
//! | swept volumes, then screws | work of 256 and 1/8 test a triangle; 256 and one a triangle when 1/16 of the sub-window is done | after a success at a quarter more, else at eight times the work | `skip` |
//! | swept volumes that meet, by boxes | before bodies are measured | a pair for 32 triangles | `skip` |
//! | pairs of parts along a screw | – | a quarter of the work, and three for each triangle that may be near the other body | `skip` |
//! | planes between crowds | 4096 pairs wait, or 1024 batches | twice as many, and as much other work as it took | `crowd` |
//! | spans of time, divided | 64 sub-windows | 256 pairs in a span | `time_split` |
//! | several threads | 1024 node tests | each round 4096 tests a thread | `parallel` |
//! | swept volumes, screws and crowds, when the level is grazed | 64 times later | – | [`patience`] |
//!
//! What one mechanism does within itself stands with it: which directions a test tries ([`separating_axis`]), which planes part crowds (`crowd`), how
//! long spans of any motion are (`general_motion/span_length`), of contact (`staying_walk`), and where clearances are sampled (`clearance`). Tests
//! are counted for the whole search, so that pairs of a search that has become hard need not each find that out anew; threads that search
//! ahead therefore have to check that the true counts would have changed nothing (`parallel`).
//!
//! [`separating_axis`]: crate::pair::triangles::separating_axis

use crate::pair::triangles::separating_axis::BoundOrder;

/// Items that a batch may have before it is divided.
pub(crate) const BATCH: usize = 32;

/// Nodes are prefetched so many items before they are expanded: trees are larger than the caches near the processor.
pub(crate) const AHEAD: usize = 2;

/// Batches between two checks of the queue's length: it grows by less than 2¹⁵ items between them.
pub(crate) const MEMORY_CHECK: u32 = 128;

/// The frame is renewed when the time has grown by more than one part in this many: an older one is as right, its
/// bounds only begin earlier.
const FRESH: u32 = 128;

/// The key above which a frame at this key is renewed.
pub(crate) const fn fresh_until(key: u32) -> u32 {
    key + key / FRESH
}

/// Whether boxes are tested for passing each other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Passing {
    Untested,
    Tested,
}

/// Batches of a sub-window before that: about as many as ordinary queries have, which end with what meets first and need not know what
/// never would.
const ORDINARY_BATCHES: u32 = 48;

/// Whether boxes are tested for passing each other after so many batches of a sub-window.
#[inline(always)]
pub(crate) const fn boxes_may_pass(batches: u32) -> Passing {
    if batches > ORDINARY_BATCHES { Passing::Tested } else { Passing::Untested }
}

/// Tests of pairs of triangles of one search, and of one pair, that use bounds of second order; later ones use those of third
/// order. Ordinary queries need fewer.
pub(crate) const SECOND_ORDER_TESTS: u64 = 192;
const SECOND_ORDER_STEPS: u32 = 16;

/// Tests of a search, and of one pair, after which directions that turn with the bodies are tried where others last for a short
/// time only: they cost as much as a few tests.
pub(crate) const THIRD_ORDER_TESTS: u64 = 1024;
const THIRD_ORDER_STEPS: u32 = 24;

/// The bounds for the next test of a pair of triangles, which is the pair's `steps`-th and the search's `tests`-th.
#[inline(always)]
pub(crate) const fn bound_order(tests: u64, steps: u32) -> BoundOrder {
    if tests > THIRD_ORDER_TESTS || steps > THIRD_ORDER_STEPS {
        BoundOrder::Turning
    } else if tests > SECOND_ORDER_TESTS || steps > SECOND_ORDER_STEPS {
        BoundOrder::Third
    } else {
        BoundOrder::Second
    }
}

/// A pair that is advanced out of turn is left after so many steps; ordinary contacts take fewer than ten.
pub(crate) const MOST_STEPS_ALONE: u32 = 64;

/// A pair of triangles is advanced alone until its time has grown by one part in this many: what it finds early spares
/// the queue what comes later, and pairs that meet at the same features need one backward certificate each.
const FOLLOWED: u32 = 16;

/// And by so many steps of the key: some 2e-6 of the window.
const FOLLOWED_KEYS: u32 = 1024;

/// The key above which a pair goes back to the queue that was handed out with this one.
#[inline(always)]
pub(crate) const fn followed_until(key: u32) -> u32 {
    key + key / FOLLOWED + FOLLOWED_KEYS
}

/// How much longer a search goes on before it examines swept volumes and crowds if its level is close to the least distance: they hardly ever
/// prove anything then.
const GRAZING_PATIENCE: u64 = 64;

/// The factor of all that a search does before that; `grazed`: triangles whose line parts most pairs.
pub(crate) const fn patience(grazed: Option<[u32; 2]>) -> u64 {
    if grazed.is_some() { GRAZING_PATIENCE } else { 1 }
}

/// Node tests, besides one for each [`TRIANGLES_A_TEST`] triangles, before swept volumes are compared for the first time:
/// ordinary queries end before that, or are well on their way.
const FIRST_SWEEP: u64 = 256;

/// As many triangles are measured for a sweep in the time of one node test.
const TRIANGLES_A_TEST: u64 = 8;

/// A search that has covered this part of its sub-window is making progress: it gets a node test for each triangle before swept
/// volumes are compared.
pub(crate) const ON_ITS_WAY: f64 = 0.0625;

/// The work at which swept volumes of bodies of so many triangles together are compared first.
pub(crate) const fn first_sweep(triangles: u64, patience: u64) -> u64 {
    patience * (FIRST_SWEEP + triangles / TRIANGLES_A_TEST)
}

/// The same for a search that is [on its way](ON_ITS_WAY).
pub(crate) const fn first_sweep_on_its_way(triangles: u64, patience: u64) -> u64 {
    patience * (FIRST_SWEEP + triangles)
}

/// What a comparison of swept volumes may cost after so much work: as much again.
pub(crate) const fn most_swept(work: u64) -> u64 {
    work + FIRST_SWEEP
}

/// Pairs of parts whose sweeps are compared before bodies of so many triangles together are measured: a tenth of the time that this takes.
pub(crate) const fn swept_before(triangles: u64) -> u64 {
    triangles / TRIANGLES_A_SWEPT_PAIR
}

/// See [`swept_before`].
const TRIANGLES_A_SWEPT_PAIR: u64 = 32;

/// Node tests in the time of one comparison of two parts along a screw.
const TESTS_A_SCREW_PAIR: u64 = 4;

/// Pairs of parts that may be compared along a screw for each triangle that was projected: about as much time as the projections took.
pub(crate) const SCREW_PAIRS_A_TRIANGLE: u64 = 3;

/// The same for comparisons along a screw, in pairs of parts.
pub(crate) const fn most_screw_pairs(work: u64) -> u64 {
    most_swept(work) / TESTS_A_SCREW_PAIR
}

/// The work at which swept volumes are compared again, after a comparison that was due at `due`, ended at `work` and proved something.
pub(crate) const fn sweep_after_success(work: u64, due: u64) -> u64 {
    work + due / 4
}

/// The same where it proved nothing.
pub(crate) const fn sweep_after_failure(work: u64) -> u64 {
    8 * work
}

/// What a skip along a screw has to gain where the search may go on from any time, as a part of a sub-window: bodies that drift off their common
/// screw meet soon.
pub(crate) const LEAST_PART_OF_A_WINDOW: f64 = 0.25;

/// As many pairs that wait are a crowd, and as many batches in one window make one: several times as many as in
/// ordinary queries of a million triangles.
pub(crate) const CROWD: usize = 1 << 12;
pub(crate) const CROWD_OF_BATCHES: u32 = 1 << 10;

/// Batches between two counts of the pairs that wait, or tests of triangle pairs if it takes that many sooner: a pair that
/// turns fast may need a thousand tests.
pub(crate) const CROWD_CHECK: u32 = 32;
pub(crate) const CROWD_CHECK_TESTS: u64 = 1 << 12;

/// Node tests that planes for parts of the time may cost, for each pair that waits: less than a few steps of each pair.
pub(crate) const WORK_A_PAIR: u64 = 16;

/// Most planes that are tried one after the other before the search goes on.
pub(crate) const MOST_PLANES: u32 = 64;

/// How often the time that is left is halved at most for one plane: after that pairs are as fast one by one.
pub(crate) const MOST_HALVINGS: u32 = 16;

/// Queries of fewer sub-windows are searched one sub-window after the other: most meet within the first few, and a span costs
/// about as much as it saves then.
pub(crate) const FEW_SUB_WINDOWS: f64 = 64.0;

/// More pairs than this are handed on to the parts of a span as they are: the search of the parts has a queue for them.
pub(crate) const MOST_PAIRS_OF_SPAN: usize = 256;

/// Tests of a part of a span that is not halved any more, besides half a test for each of its pairs: if they are not enough, the
/// bodies are near each other in it, and it is searched in any case.
pub(crate) const LAST_TESTS: usize = 8;

#[cfg(feature = "rayon")]
pub(crate) mod threads {
    //! When several threads are worth while.

    /// Work of a search, in node tests, before it is worth while to wake other threads.
    pub(crate) const FIRST_WORK: u64 = 1024;
    /// Work of each thread before the results are taken, for sub-windows like those so far: more than it costs to wake it.
    const ROUND_WORK: u64 = 4096;
    /// Sub-windows of each thread before the results are taken: at least, and at most.
    const LEAST_WINDOWS: u64 = 4;
    const MOST_WINDOWS: u64 = 512;

    /// Sub-windows of each thread in one round, where one costs `mean` on average.
    pub(crate) fn windows_a_round(mean: u64) -> u64 {
        (ROUND_WORK / mean).clamp(LEAST_WINDOWS, MOST_WINDOWS)
    }
}
