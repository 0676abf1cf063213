//! Sub-windows searched in parallel by several threads: the answer is bitwise identical to that of one thread.
//!
//! How a sub-window is searched depends on its span, and on what was done before it only in this: pairs of triangles are
//! tested to third order from a number of tests on, swept volumes are tried from an amount of work on, and the budget ends. A
//! sub-window that is searched before its turn starts from the counts of an earlier moment, which are never above the true ones, and gives up where
//! it would try swept volumes or the budget ends. When its turn comes, what it found is taken only if nothing of the three
//! falls into it with the true counts either: then the search by one thread would have done the same, operation by
//! operation. Otherwise it is searched again. See docs/theory/engine.md, "Several threads".

use crate::walk::counts::SearchCounts;
use crate::walk::effort::threads::{FIRST_WORK, windows_a_round};
use crate::walk::effort::{SECOND_ORDER_TESTS, THIRD_ORDER_TESTS};
use crate::walk::scratch::Scratch;
use crate::walk::state::{Ahead, Outcome, Search, Step, SubWindow};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What the search of one sub-window gave.
#[derive(Clone, Copy, Debug)]
struct Searched {
    /// The answer; none: apart all along.
    answer: Option<Outcome>,
    /// Of this sub-window alone.
    counts: SearchCounts,
    last_tested: [u32; 2],
}

impl Search<'_> {
    /// Searches sub-windows from `start` on by several threads, while that pays.
    pub(crate) fn search_in_parallel(&mut self, mut start: f64) -> Step {
        loop {
            let windows = self.windows_worth_searching(start);
            if windows.len() < 2 {
                return Step::ClearUntil(start);
            }
            let known = self.scratch.counts;
            let results = self.search_at_once(&windows);
            for (window, searched) in windows.iter().zip(results) {
                let Some(searched) = searched.filter(|searched| self.would_do_the_same(&known, searched))
                else {
                    return Step::ClearUntil(start);
                };
                if searched.counts.triangle_looks > 0 {
                    self.scratch.last_tested = searched.last_tested;
                }
                self.scratch.counts = self.scratch.counts.with(&searched.counts);
                match searched.answer {
                    None => start = window.end,
                    Some(answer) => return Step::Answer(answer),
                }
                if start >= self.scene.end {
                    return Step::ClearUntil(start);
                }
            }
        }
    }

    /// The next sub-windows: so many that the threads are busy, and the search goes on without swept volumes for so long.
    fn windows_worth_searching(&self, mut start: f64) -> Vec<SubWindow> {
        let (counts, threads) = (&self.scratch.counts, rayon::current_num_threads());
        let mut windows = Vec::new();
        if threads < 2 || self.work() < FIRST_WORK {
            return windows;
        }
        let mean = ((counts.node_tests + counts.triangle_looks) / counts.windows.max(1)).max(1);
        let until_sweep = self.limits.sweep_from.saturating_sub(self.work()) / mean;
        let each = windows_a_round(mean);
        let most = (each * threads as u64).min(until_sweep) as usize;
        while windows.len() < most
            && start < self.scene.end
            && let Some(window) = self.window_from(start)
        {
            windows.push(window);
            start = window.end;
        }
        windows
    }

    /// What each sub-window gives from the counts of now on; none where it was given up.
    fn search_at_once(&mut self, windows: &[SubWindow]) -> Vec<Option<Searched>> {
        let threads = rayon::current_num_threads().min(windows.len());
        let (next, answered) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
        let results: Vec<OnceLock<Searched>> = windows.iter().map(|_| OnceLock::new()).collect();
        let (scene, limits, known) = (self.scene, self.limits, self.scratch.counts);
        let instructions = self.instructions;
        let work = |scratch: &mut Scratch| {
            // In the order of time, so that little is wasted after an answer.
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= windows.len() {
                    return;
                }
                let ahead = Ahead { number, answered: &answered };
                if ahead.is_useless() {
                    return;
                }
                scratch.counts = known;
                let mut search = Search {
                    scene,
                    scratch,
                    limits,
                    instructions,
                    scales: None,
                    ahead: Some(ahead),
                    parallel: false,
                };
                let step = search.search_span(windows[number]);
                let answer = match step {
                    Step::Answer(Outcome::OutOfBudget(_)) => continue,
                    Step::Answer(answer) => Some(answer),
                    Step::ClearUntil(_) => None,
                };
                if let Some(Outcome::Found(_)) = answer {
                    answered.fetch_min(number, Ordering::Relaxed);
                }
                let (counts, last_tested) = (scratch.counts.without(&known), scratch.last_tested);
                // Each number is handed out once.
                _ = results[number].set(Searched { answer, counts, last_tested });
            }
        };
        let helpers = &mut self.scratch.helpers;
        helpers.resize_with(threads.max(helpers.len()), Scratch::new);
        rayon::scope(|scope| {
            for helper in &mut helpers[..threads] {
                scope.spawn(|_| work(helper));
            }
        });
        results.into_iter().map(OnceLock::into_inner).collect()
    }

    /// Would the sub-window have been searched in the same way from the true counts as from those `known` before?
    fn would_do_the_same(&self, known: &SearchCounts, searched: &Searched) -> bool {
        let after = self.scratch.counts.with(&searched.counts);
        let same_order = [SECOND_ORDER_TESTS, THIRD_ORDER_TESTS].iter().all(|&limit| {
            after.triangle_looks <= limit
                || known.triangle_looks >= limit
                || searched.counts.triangle_looks == 0
        });
        same_order && after.work() < self.limits.sweep_from && after.work() < self.limits.most_tests
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::scene::MovingScene;
    use crate::{Budget, MeshTree, Mode, Moving, QueryOptions, TriMesh, Window, time_of_contact};
    use d2m_motion::ConstantTwist;
    use d2m_testing::{Draw, KnuthRandom, Surface};
    use glam::{DQuat, DVec3};

    fn ring(rings: u32, sides: u32, tube: f64) -> MeshTree {
        MeshTree::new(Surface::wavy_torus(rings, sides, tube).into_mesh(TriMesh::try_new))
    }

    /// Motions of two rings that interlock, spin and drift apart, close to each other for long.
    fn interlocked(random: &mut KnuthRandom, spin: f64, drift: f64) -> [ConstantTwist; 2] {
        let upright = DQuat::from_rotation_x(1.57 + 0.2 * random.signed());
        let drift = random.vector() * drift;
        let place = DVec3::X * (0.9 + 0.15 * random.signed());
        let turning = (DVec3::Z + random.vector() * 0.05) * spin;
        [
            ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, drift, turning),
            ConstantTwist::try_new(place, upright, DVec3::ZERO, DVec3::Y * spin * random.signed()),
        ]
        .map(Result::unwrap)
    }

    /// Interlocked rings that spin and drift, close to each other for long: every number of threads gives the outcome
    /// and the counts of one thread, whatever the mode and wherever a budget ends.
    #[test]
    fn any_number_of_threads_does_the_same() {
        let mut random = KnuthRandom(9);
        let trees = [ring(16, 6, 0.3), ring(24, 8, 0.35), ring(8, 4, 0.25)];
        let pools = [1, 2, 3, 8].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap());
        let (mut found, mut apart, mut ended, mut helped) = (0, 0, 0, 0);
        for round in 0..40 {
            let (a, b) = (&trees[round % 3], &trees[round / 3 % 3]);
            let spin = [10.0, 60.0, 300.0][round % 3];
            let drift = [0.0, 0.02, 0.2, 0.6][round / 2 % 4];
            let motions = interlocked(&mut random, spin, drift);
            let options = QueryOptions::default()
                .with_parallel(true)
                .with_mode([Mode::Accurate, Mode::Exists, Mode::Capoeira][round / 5 % 3]);
            let scene = MovingScene::new((a, motions[0]), (b, motions[1]), Window::UNIT, &options);
            let mut ask = |options: &QueryOptions, threads: usize| {
                let mut scratch = Scratch::new();
                let outcome = pools[threads].install(|| Search::new(&scene, options, &mut scratch).run());
                helped += usize::from(!scratch.helpers.is_empty());
                (format!("{outcome:?}"), scratch.counts)
            };
            let (_, all) = ask(&options, 0);
            for part in [2.0, 0.999, 0.4] {
                let budget = Budget::UNLIMITED.with_node_tests((all.work() as f64 * part) as u64 + 1);
                let options = options.with_budget(budget);
                let alone = ask(&options.with_parallel(false), 0);
                for threads in 0..4 {
                    assert_eq!(ask(&options, threads), alone, "scene {round}, {part} of the work");
                }
                found += u32::from(alone.0.contains("Found"));
                apart += u32::from(alone.0.contains("Separated"));
                ended += u32::from(alone.0.contains("OutOfBudget"));
            }
        }
        assert!(found > 15 && apart > 15 && ended > 15 && helped > 60, "{found} {apart} {ended} {helped}");
    }

    /// One memory for searches of many and of few triangles by turns: none refers to triangles of the search before it, although
    /// what other threads search before its turn may come to where swept volumes are due.
    #[test]
    fn memory_of_larger_bodies_is_of_no_use() {
        let mut random = KnuthRandom(31);
        let trees = [ring(32, 8, 0.3), ring(8, 3, 0.3)];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let (mut scratch, mut helped) = (Scratch::new(), 0);
        let options = QueryOptions::default().with_parallel(true);
        for round in 0..60 {
            let tree = &trees[round % 2];
            let [a, b] = interlocked(&mut random, 600.0, 0.02);
            let scene = MovingScene::new((tree, a), (tree, b), Window::UNIT, &options);
            let together = pool.install(|| Search::new(&scene, &options, &mut scratch).run());
            let alone = Search::new(&scene, &options.with_parallel(false), &mut Scratch::new()).run();
            assert_eq!(format!("{together:?}"), format!("{alone:?}"), "round {round}");
            helped += usize::from(scratch.counts.work() > FIRST_WORK);
        }
        assert!(helped > 20, "{helped}");
    }

    /// What a query leaves in the memory of its thread is of no use to the next one, whose contact another thread finds: its
    /// bodies are elsewhere by a millionth, and meet in the same sub-window.
    #[test]
    fn nothing_of_an_earlier_query_is_reported() {
        let mut random = KnuthRandom(4);
        let trees = [ring(16, 6, 0.3), ring(24, 8, 0.35)];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let alone = QueryOptions::default();
        let mut met = 0;
        for _ in 0..24 {
            let upright = DQuat::from_rotation_x(1.57 + 0.1 * random.signed());
            let drift = random.vector() * 0.6;
            let spin = (DVec3::Z + random.vector() * 0.05) * 100.0;
            let a = ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, drift, spin).unwrap();
            let place = DVec3::X * (0.95 + 0.1 * random.signed());
            let at =
                |place: DVec3| ConstantTwist::try_new(place, upright, DVec3::ZERO, DVec3::Y * 40.0).unwrap();
            let (b, beside) = (at(place), at(place + DVec3::Y * 1e-6));
            let ask = |b: &ConstantTwist, options: &QueryOptions| {
                let bodies = [Moving::new(&trees[0], &a), Moving::new(&trees[1], b)];
                time_of_contact(bodies[0], bodies[1], Window::UNIT, options).unwrap()
            };
            let wanted = pool.install(|| ask(&b, &alone));
            let got = pool.install(|| {
                let _ = ask(&beside, &alone);
                ask(&b, &alone.with_parallel(true))
            });
            assert_eq!(got, wanted);
            met += u32::from(got.contact().is_some_and(|contact| contact.time_lo > 0.01));
        }
        assert!(met > 8, "{met}");
    }
}
