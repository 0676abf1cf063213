//! Random small scenes on which two implementations and a slow oracle must agree.

use super::distance::enclose_distance;
use super::{Moving, SphereTree, time_of_contact};
use crate::{MeshTree, QueryOptions, Solid, TimeOfContact, TriMesh, Window};
use d2m_feature::paper::RelativeMotion;
use d2m_interval::Interval;
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::{DQuat, DVec3};

/// What a run of [`cross_check`] found.
#[derive(Clone, Debug, Default)]
pub struct CrossCheck {
    /// Scenes that were asked.
    pub scenes: usize,
    /// Scenes in which both methods found a contact.
    pub contacts: usize,
    /// Undecided answers of the default engine and of the reference method.
    pub undecided: [usize; 2],
    /// Contacts of the default engine and of the reference method whose bracket \[`time_lo`, `time_hi`\] holds no time
    /// (of 65 evaluated) at which the distance could be within the tolerance.
    pub open_brackets: [usize; 2],
    /// Contacts whose surfaces clearly meet well before `time_hi`, by more than half the tolerance: the bracket is loose,
    /// as happens when a feature pair was lost and the step back had to make up for it.
    pub loose_brackets: [usize; 2],
    /// What disagreed, one line each; empty when all is well.
    pub complaints: Vec<String>,
}

/// Asks the default engine and the reference method for the first contact of `count` random small scenes and judges
/// both answers with a slow oracle: certified static distances along the window.
///
/// An answer is faulted if the surfaces meet at a time that it calls free, if the separation at `time_lo` is not within
/// (0, 3.4 δ]; brackets that do not reach the contact are counted. The scenes favour what is hard: parallel faces, coplanar sliding, grazing,
/// fast spin, needles, equal motions, contacts at the ends of the window. Same seed, same scenes.
///
/// ```
/// let report = d2m_bvh::paper::cross_check(3, 1);
/// assert_eq!(report.scenes, 3);
/// assert!(report.complaints.is_empty(), "{:?}", report.complaints);
/// ```
pub fn cross_check(count: usize, seed: u64) -> CrossCheck {
    let mut report = CrossCheck::default();
    for index in 0..count {
        let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(index as u64));
        let scene = Scene::random(&mut random);
        report.scenes += 1;
        scene.judge(&mut report, &format!("seed {seed}, scene {index} ({})", scene.name));
    }
    report
}

/// The same for one given scene: two meshes with their motions over `window`.
///
/// ```
/// use d2m_bvh::{QueryOptions, TriMesh, Window, paper};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let coming = ConstantTwist::REST.with_position(DVec3::Z * 3.0).with_linear_velocity(DVec3::Z * -4.0);
/// let bodies = [(mesh.clone(), coming), (mesh, ConstantTwist::REST)];
/// let report = paper::cross_check_scene(bodies, Window::UNIT, &QueryOptions::DEFAULT);
/// assert_eq!((report.contacts, report.complaints.len()), (1, 0));
/// # Ok::<(), d2m_bvh::MeshError>(())
/// ```
pub fn cross_check_scene(
    bodies: [(TriMesh, ConstantTwist); 2],
    window: Window,
    options: &QueryOptions,
) -> CrossCheck {
    let mut report = CrossCheck { scenes: 1, ..CrossCheck::default() };
    let motions = [bodies[0].1, bodies[1].1];
    let trees = bodies.map(|(mesh, _)| SphereTree::new(mesh));
    let scene = Scene { name: String::new(), trees, motions, window, options: *options };
    scene.judge(&mut report, "scene");
    report
}

struct Scene {
    name: String,
    trees: [SphereTree; 2],
    motions: [ConstantTwist; 2],
    window: Window,
    options: QueryOptions,
}

impl Scene {
    fn random(random: &mut Random) -> Self {
        let (kind_a, mesh_a) = random.body();
        let (kind_b, mesh_b) = random.body();
        let (kind, motions) = random.motions();
        let trees = [SphereTree::new(mesh_a), SphereTree::new(mesh_b)];
        let closed = trees.iter().all(SphereTree::is_watertight);
        let solid = if closed && random.below(4) > 0 { Solid::Filled } else { Solid::Surface };
        let window = match random.below(6) {
            0 => Window::try_new(0.25, 0.75),
            1 => Window::try_new(-1.0, 1.0),
            _ => Window::try_new(0.0, 1.0),
        };
        Self {
            name: format!("{kind_a} and {kind_b}, {kind}, {solid:?}"),
            trees,
            motions,
            window: window.expect("ordered and finite"),
            options: QueryOptions::DEFAULT.with_solid(solid),
        }
    }

    fn judge(&self, report: &mut CrossCheck, name: &str) {
        let [a, b]: [Moving<'_>; 2] =
            core::array::from_fn(|i| Moving::new(&self.trees[i], &self.motions[i] as &dyn RigidMotion));
        let engines = self.trees.each_ref().map(|t| MeshTree::new(t.mesh().clone()));
        let engine = crate::time_of_contact(
            crate::Moving::new(&engines[0], &self.motions[0]),
            crate::Moving::new(&engines[1], &self.motions[1]),
            self.window,
            &self.options,
        );
        let reference = time_of_contact(a, b, self.window, &self.options);
        let answers = match (engine, reference) {
            (Ok(e), Ok(r)) => [("engine", e), ("reference", r)],
            (e, r) => {
                report.complaints.push(format!("{name}: errors {:?} and {:?}", e.err(), r.err()));
                return;
            }
        };
        if answers.iter().all(|(_, x)| x.contact().is_some()) {
            report.contacts += 1;
        }
        let oracle = Oracle { a, b, relative: RelativeMotion::new(a.motion, b.motion) };
        for (i, (who, answer)) in answers.iter().enumerate() {
            report.open_brackets[i] += usize::from(oracle.is_open(answer));
            report.loose_brackets[i] += usize::from(oracle.is_loose(answer));
            report.undecided[i] += usize::from(matches!(answer, TimeOfContact::Undecided { .. }));
            if let Some(fault) = oracle.fault(answer, &answers[1 - i].1, self.window) {
                report.complaints.push(format!(
                    "{name}: {who}: {fault}: {answer:?}; the other says {:?}",
                    answers[1 - i].1
                ));
            }
        }
    }
}

/// Certified distances at single times.
struct Oracle<'a> {
    a: Moving<'a>,
    b: Moving<'a>,
    relative: RelativeMotion<'a>,
}

impl Oracle<'_> {
    fn distance(&self, t: f64, cutoff: f64) -> (f64, f64) {
        let found = enclose_distance(self.a.body, self.b.body, &self.relative.placement(t), cutoff);
        (found.lower, found.upper)
    }

    /// Do the surfaces meet at `t`, an edge passing through a face by more than `margin`?
    fn meet(&self, t: f64, margin: f64) -> bool {
        let place = self.relative.placement(t);
        let mut meet = false;
        super::distance::visit_close_pairs(self.a.body, self.b.body, &place, 1e-9, |pair| {
            meet |= pair.detail.upper == 0.0 && super::start::is_crossing(self.b.body, pair, margin);
            if meet { f64::NEG_INFINITY } else { f64::INFINITY }
        });
        meet
    }

    /// What is wrong with `answer`, if anything is.
    fn fault(&self, answer: &TimeOfContact, other: &TimeOfContact, window: Window) -> Option<String> {
        let (free, end) = match answer {
            TimeOfContact::Separated => (window.end(), true),
            TimeOfContact::Undecided { clear_until } => (*clear_until, false),
            TimeOfContact::Contact(c) => (c.time_lo, false),
        };
        if !window.contains(free) {
            return Some(format!("time {free} outside the window"));
        }
        // What the other found is sampled most densely.
        let hint = other.contact().map_or(free, |c| c.time_hi);
        if let Some(t) = self.meeting_before(window.start(), free, end, hint) {
            return Some(format!("the surfaces meet at {t:?}"));
        }
        let contact = answer.contact()?;
        let scale = self.scale();
        if contact.start == crate::StartState::Apart {
            let (lower, upper) = self.distance(contact.time_lo, f64::INFINITY);
            if lower <= 0.0 || upper > 3.4 * contact.tolerance + 1e-14 * scale {
                return Some(format!("distance at time_lo in [{lower:e}, {upper:e}]"));
            }
        }
        None
    }

    /// Is there no time in the contact's bracket at which the distance could be within the tolerance?
    fn is_open(&self, answer: &TimeOfContact) -> bool {
        let Some(c) = answer.contact().filter(|c| c.start == crate::StartState::Apart) else { return false };
        let allowed = 1.01 * c.tolerance + 1e-14 * self.scale();
        let close = |t: f64| self.distance(t, 4.0 * allowed).0 <= allowed;
        let between = |k: u32| c.time_lo + (c.time_hi - c.time_lo) * f64::from(k) / 64.0;
        !close(c.time_hi) && !(0..64).any(|k| close(between(k)))
    }

    /// Do the surfaces clearly meet before the contact's `time_hi`?
    fn is_loose(&self, answer: &TimeOfContact) -> bool {
        let Some(c) = answer.contact().filter(|c| c.start == crate::StartState::Apart) else { return false };
        let length = c.time_hi - c.time_lo;
        let at = |share: f64| self.meet(c.time_lo + length * share, 0.5 * c.tolerance);
        (1..32).any(|k| at(f64::from(k) / 32.0) || at(0.5f64.powi(k)))
    }

    fn scale(&self) -> f64 {
        self.a.body.bounding_sphere().radius.max(self.b.body.bounding_sphere().radius)
    }

    /// A time in \[start, free) – or up to `free` where that is included – at which the surfaces clearly meet.
    ///
    /// Certified advancement by static distances proves most of the span free; the rest is sampled, more closely near
    /// its end and around `hint`.
    fn meeting_before(&self, start: f64, free: f64, included: bool, hint: f64) -> Option<f64> {
        let span = Interval::new(start, free);
        let speed = self.bound_speed(span);
        let mut t = start;
        // The larger the meshes, the fewer samples.
        let leaves = self.a.body.leaf_count() + self.b.body.leaf_count();
        let samples = (8000 / leaves).clamp(24, 400) as u32;
        for _ in 0..samples {
            let (lower, _) = self.distance(t, f64::INFINITY);
            let step = lower / speed * (1.0 - 1e-9);
            if t + step >= free {
                return None;
            }
            if lower < 1e-9 {
                break;
            }
            t += step;
        }
        let left = free - t;
        let mut times: Vec<f64> =
            (0..=samples).map(|k| t + left * f64::from(k) / f64::from(samples)).collect();
        let halvings = samples.min(48) as i32;
        for k in 1..halvings {
            let close = left * 0.5f64.powi(k * 48 / halvings);
            times.extend([free - close, hint - close, hint + close]);
        }
        times.retain(|x| *x >= start && (*x < free || (included && *x <= free)));
        times.into_iter().find(|x| self.meet(*x, 1e-13))
    }

    /// A bound of the relative speed of any two points of the bodies.
    fn bound_speed(&self, span: Interval) -> f64 {
        let twists = [&self.a, &self.b].map(|m| m.motion.enclose_twist(span));
        let drift = (twists[0].linear - twists[1].linear).norm().hi();
        let turn = [&self.a, &self.b].into_iter().zip(&twists).map(|(m, twist)| {
            let ball = m.body.bounding_sphere();
            let at = m.motion.enclose_pose(Interval::point(span.lo())).at;
            twist.angular.norm().hi() * ((ball.center - at).length() + ball.radius) * (1.0 + 1e-9)
        });
        (drift + turn.sum::<f64>()).max(f64::MIN_POSITIVE)
    }
}

struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let mut random = Self(seed ^ 0x9E37_79B9_7F4A_7C15);
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// In \[−1, 1), a multiple of 2⁻⁵².
    fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// In \[−1, 1\], a multiple of 1/8.
    fn eighth(&mut self) -> f64 {
        self.below(17) as f64 / 8.0 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn grid_vector(&mut self) -> DVec3 {
        DVec3::new(self.eighth(), self.eighth(), self.eighth())
    }

    fn body(&mut self) -> (&'static str, TriMesh) {
        const BOX: [[u32; 3]; 12] = [
            [0, 4, 6],
            [0, 6, 2],
            [1, 3, 7],
            [1, 7, 5],
            [0, 1, 5],
            [0, 5, 4],
            [2, 6, 7],
            [2, 7, 3],
            [0, 2, 3],
            [0, 3, 1],
            [4, 5, 7],
            [4, 7, 6],
        ];
        const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let corners = |lo: DVec3, hi: DVec3| -> Vec<DVec3> {
            (0..8u32)
                .map(|i| {
                    let pick = |bit: u32, l: f64, h: f64| if i & bit == 0 { l } else { h };
                    DVec3::new(pick(1, lo.x, hi.x), pick(2, lo.y, hi.y), pick(4, lo.z, hi.z))
                })
                .collect()
        };
        let (name, vertices, triangles) = match self.below(8) {
            0 | 1 => ("cube", corners(DVec3::splat(-0.5), DVec3::splat(0.5)), BOX.to_vec()),
            2 => {
                let size = DVec3::splat(1.125) + self.grid_vector();
                ("box", corners(-0.5 * size, 0.5 * size), BOX.to_vec())
            }
            3 => {
                let thin = DVec3::new(1.0, 0.75, 10f64.powi(-(self.below(6) as i32)));
                ("plate", corners(-thin, thin), BOX.to_vec())
            }
            4 => {
                let thin = 10f64.powi(-(self.below(5) as i32) - 1);
                ("needle", corners(DVec3::new(-1.0, -thin, -thin), DVec3::new(1.0, thin, thin)), BOX.to_vec())
            }
            5 => {
                let v = (0..4).map(|_| self.vector()).collect();
                ("tetrahedron", v, TETRAHEDRON.to_vec())
            }
            6 => {
                let n = 1 + self.below(3) as u32;
                let v = (0..3 * n).map(|_| if n == 1 { self.grid_vector() } else { self.vector() }).collect();
                ("soup", v, (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
            }
            _ => {
                let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
                let v = (0..6).map(|_| flat(self.grid_vector())).collect();
                ("flat soup", v, vec![[0, 1, 2], [3, 4, 5]])
            }
        };
        (name, TriMesh::try_new(vertices, triangles).expect("finite corners"))
    }

    fn orientation(&mut self) -> DQuat {
        match self.below(3) {
            0 => DQuat::IDENTITY,
            1 => {
                let turns = [
                    DQuat::from_xyzw(1.0, 0.0, 0.0, 1.0),
                    DQuat::from_xyzw(0.0, 0.0, 1.0, 1.0),
                    DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0),
                ];
                turns[self.below(3) as usize]
            }
            _ => DQuat::from_xyzw(self.number(), self.number(), self.number(), self.number()),
        }
    }

    fn motions(&mut self) -> (&'static str, [ConstantTwist; 2]) {
        let motion = |random: &mut Self, x: DVec3, v: DVec3, w: DVec3| {
            ConstantTwist::try_new(x, random.orientation(), v, w).expect("finite")
        };
        let far = 1.0 + 2.0 * self.number().abs();
        let side = self.grid_vector() * 0.5;
        let from = DVec3::new(side.x, side.y, far);
        let zero = DVec3::ZERO;
        match self.below(9) {
            0 => {
                let speed = [2.0, 8.0, 512.0, 1e5][self.below(4) as usize];
                let fall = DVec3::new(0.0, 0.0, -speed);
                ("falling", [motion(self, from, fall, zero), motion(self, zero, zero, zero)])
            }
            1 => {
                let v = self.vector() * 4.0 - from;
                ("drifting", [motion(self, from, v, zero), motion(self, zero, zero, zero)])
            }
            2 => {
                let (v, w, u) = (self.vector() - from, self.vector() * 3.0, self.vector() * 3.0);
                ("tumbling", [motion(self, from, v, w), motion(self, zero, zero, u)])
            }
            3 => {
                let (w, u) = (self.vector() * 40.0, self.vector() * 40.0);
                ("spinning", [motion(self, from, -0.5 * from, w), motion(self, zero, zero, u)])
            }
            4 => {
                let slide = DVec3::new(4.0 * self.eighth(), 4.0, 0.0);
                let high = DVec3::new(side.x, -2.0, self.eighth());
                ("sliding", [motion(self, high, slide, zero), motion(self, zero, zero, zero)])
            }
            5 => {
                let (v, w) = (self.vector() * 8.0, self.vector() * 3.0);
                let a = ConstantTwist::try_new(from, DQuat::IDENTITY, v, w).expect("finite");
                let b = a.with_position(self.grid_vector() * 0.25);
                ("moving alike", [a, b])
            }
            6 => {
                let axis = DVec3::new(0.0, 0.0, 2.0 + 4.0 * self.eighth());
                let beside = DVec3::new(1.0 + 0.25 * self.eighth(), side.y, 0.0);
                ("turning beside", [motion(self, beside, zero, axis), motion(self, zero, zero, zero)])
            }
            7 => {
                let (w, offset) = (self.vector() * 2.0, self.vector() * 1e4);
                let (v, u) = (self.vector() * 300.0 - from * 300.0, self.vector());
                let mut pair = [motion(self, from, v, w), motion(self, zero, zero, u)];
                for m in &mut pair {
                    *m = m.with_position(m.position() + offset);
                }
                ("fast and far off", pair)
            }
            _ => {
                let (v, w) = (self.vector() * 2.0, self.vector() * 2.0);
                let near = self.grid_vector() * 0.75;
                ("close by", [motion(self, near, v, w), motion(self, zero, zero, zero)])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The judge sees an answer that is late, one that is missing, one that is far too early, and nothing in a good one.
    #[test]
    fn the_judge_has_teeth() {
        let mut judged = 0;
        for index in 0..40 {
            let scene = Scene::random(&mut Random::new(index));
            let [a, b]: [Moving<'_>; 2] =
                core::array::from_fn(|i| Moving::new(&scene.trees[i], &scene.motions[i] as &dyn RigidMotion));
            let answer = time_of_contact(a, b, scene.window, &scene.options).unwrap();
            let oracle = Oracle { a, b, relative: RelativeMotion::new(a.motion, b.motion) };
            let fault = |x: &TimeOfContact| oracle.fault(x, &answer, scene.window);
            assert_eq!(fault(&answer), None, "{}", scene.name);
            assert!(!oracle.is_open(&answer), "{}: {answer:?}", scene.name);
            let Some(contact) = answer.contact().filter(|c| c.closing_speed > 0.1) else { continue };
            if contact.start != crate::StartState::Apart || contact.time_lo + 1e-3 > scene.window.end() {
                continue;
            }
            let shifted = |by: f64| {
                let mut other = *contact;
                other.time_lo += by / contact.closing_speed;
                other.time_hi = other.time_lo;
                TimeOfContact::Contact(other)
            };
            assert!(fault(&shifted(1e-8)).is_some(), "{}: late by 1e-8", scene.name);
            assert!(fault(&shifted(-1e-8)).is_some(), "{}: early by 1e-8", scene.name);
            assert!(oracle.is_open(&shifted(-1e-8)));
            judged += 1;
        }
        assert!(judged > 10, "{judged}");
    }

    #[test]
    fn same_seed_same_scenes() {
        let name = |i| Scene::random(&mut Random::new(i)).name;
        assert_eq!((0..9).map(name).collect::<Vec<_>>(), (0..9).map(name).collect::<Vec<_>>());
    }
}
