//! Two implementations and a slow oracle that must agree about a scene.

use super::distance::{ClosestPair, enclose_distance};
use super::{Moving, SphereTree, in_boxes, time_of_contact};
use crate::feature::RelativeMotion;
use d2m_bvh::{QueryOptions, TimeOfContact, TriMesh, Window};
use d2m_interval::Interval;
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::DVec3;

/// What [`cross_check`] found, of one scene or of several.
///
/// ```
/// use d2m_paper::CrossCheck;
/// let mut all = CrossCheck::default();
/// for scene in 0..3 {
///     let mut one = CrossCheck::default();
///     (one.scenes, one.contacts) = (1, usize::from(scene > 0));
///     all.add(one);
/// }
/// assert_eq!((all.scenes, all.contacts, all.complaints.is_empty()), (3, 2, true));
/// ```
#[derive(Clone, Debug, Default)]
pub struct CrossCheck {
    /// Scenes that were queried.
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

impl CrossCheck {
    /// With what was found in other scenes.
    pub fn add(&mut self, other: Self) {
        let sum = |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a + c, b + d];
        self.scenes += other.scenes;
        self.contacts += other.contacts;
        self.undecided = sum(self.undecided, other.undecided);
        self.open_brackets = sum(self.open_brackets, other.open_brackets);
        self.loose_brackets = sum(self.loose_brackets, other.loose_brackets);
        self.complaints.extend(other.complaints);
    }
}

/// Queries the default engine and the reference method for the first contact of two meshes and judges both answers with a
/// slow oracle: certified static distances along the window. Complaints begin with `name`.
///
/// An answer is faulted if the surfaces meet at a time that it calls free, or if the separation at `time_lo` is not within
/// (0, 3.4 δ]; brackets that do not reach the contact are counted.
///
/// ```
/// use d2m_bvh::{QueryOptions, TriMesh, Window};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let coming = ConstantTwist::REST.with_position(DVec3::Z * 3.0).with_linear_velocity(DVec3::Z * -4.0);
/// let motions = [coming, ConstantTwist::REST];
/// let meshes = [mesh.clone(), mesh];
/// let report = d2m_paper::cross_check("example", meshes, motions, Window::UNIT, &QueryOptions::DEFAULT);
/// assert_eq!((report.contacts, report.complaints.len()), (1, 0));
/// # Ok::<(), d2m_bvh::MeshError>(())
/// ```
pub fn cross_check(
    name: &str,
    meshes: [TriMesh; 2],
    motions: [ConstantTwist; 2],
    window: Window,
    options: &QueryOptions,
) -> CrossCheck {
    let mut report = CrossCheck { scenes: 1, ..CrossCheck::default() };
    let scene = CheckedScene { trees: meshes.map(SphereTree::new), motions, window, options: *options };
    scene.judge(&mut report, name);
    report
}

struct CheckedScene {
    trees: [SphereTree; 2],
    motions: [ConstantTwist; 2],
    window: Window,
    options: QueryOptions,
}

impl CheckedScene {
    fn judge(&self, report: &mut CrossCheck, name: &str) {
        let [a, b]: [Moving<'_>; 2] =
            core::array::from_fn(|i| Moving::new(&self.trees[i], &self.motions[i] as &dyn RigidMotion));
        let [of_a, of_b] = [a, b].map(in_boxes);
        let engine = d2m_bvh::time_of_contact(of_a, of_b, self.window, &self.options);
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
            meet |= pair.detail.upper == 0.0 && is_crossing(self.b.body, pair, margin);
            if meet { f64::NEG_INFINITY } else { f64::INFINITY }
        });
        meet
    }

    /// What is wrong with `answer`, if anything is.
    fn fault(&self, answer: &TimeOfContact, other: &TimeOfContact, window: Window) -> Option<String> {
        let free = match answer {
            TimeOfContact::Separated => window.end(),
            TimeOfContact::Undecided { clear_until } => *clear_until,
            TimeOfContact::Contact(c) => c.time_lo,
        };
        if !window.contains(free) {
            return Some(format!("time {free} outside the window"));
        }
        // What the other found is sampled most densely.
        let hint = other.contact().map_or(free, |c| c.time_hi);
        // What is separated does not meet at the window's end either.
        let at_end = || Some(free).filter(|&t| answer.is_separated() && self.clearly_meet(t));
        if let Some(t) = self.meeting_before(window.start(), free, hint).or_else(at_end) {
            return Some(format!("the surfaces meet at {t:?}"));
        }
        let contact = answer.contact()?;
        let scale = self.scale();
        if contact.start == d2m_bvh::StartState::Apart {
            let (lower, upper) = self.distance(contact.time_lo, f64::INFINITY);
            if lower <= 0.0 || upper > 3.4 * contact.tolerance + 1e-14 * scale {
                return Some(format!("distance at time_lo in [{lower:e}, {upper:e}]"));
            }
        }
        None
    }

    /// Is there no time in the contact's bracket at which the distance could be within the tolerance?
    fn is_open(&self, answer: &TimeOfContact) -> bool {
        let Some(c) = answer.contact().filter(|c| c.start == d2m_bvh::StartState::Apart) else {
            return false;
        };
        let allowed = 1.01 * c.tolerance + 1e-14 * self.scale();
        let close = |t: f64| self.distance(t, 4.0 * allowed).0 <= allowed;
        let between = |k: u32| c.time_lo + (c.time_hi - c.time_lo) * f64::from(k) / 64.0;
        !close(c.time_hi) && !(0..64).any(|k| close(between(k)))
    }

    /// Do the surfaces clearly meet before the contact's `time_hi`?
    fn is_loose(&self, answer: &TimeOfContact) -> bool {
        let Some(c) = answer.contact().filter(|c| c.start == d2m_bvh::StartState::Apart) else {
            return false;
        };
        let length = c.time_hi - c.time_lo;
        let at = |share: f64| self.meet(c.time_lo + length * share, 0.5 * c.tolerance);
        (1..32).any(|k| at(f64::from(k) / 32.0) || at(0.5f64.powi(k)))
    }

    fn scale(&self) -> f64 {
        self.a.body.bounding_sphere().radius.max(self.b.body.bounding_sphere().radius)
    }

    fn clearly_meet(&self, t: f64) -> bool {
        self.meet(t, 1e-13)
    }

    /// A time in \[start, free) at which the surfaces clearly meet.
    ///
    /// Certified advancement by static distances proves most of the span free; the rest is sampled, more closely near
    /// its end and around `hint`.
    fn meeting_before(&self, start: f64, free: f64, hint: f64) -> Option<f64> {
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
        times.retain(|x| *x >= start && *x < free);
        times.into_iter().find(|&x| self.clearly_meet(x))
    }

    /// A bound of the relative speed of any two points of the bodies.
    fn bound_speed(&self, span: Interval) -> f64 {
        let twists = [&self.a, &self.b].map(|m| m.motion.enclose_twist(span));
        let drift = (twists[0].linear - twists[1].linear).norm().hi();
        let turn = [&self.a, &self.b].into_iter().zip(&twists).map(|(m, twist)| {
            let sphere = m.body.bounding_sphere();
            let at = m.motion.enclose_pose(Interval::point(span.lo())).at;
            twist.angular.norm().hi() * ((sphere.center - at).length() + sphere.radius) * (1.0 + 1e-9)
        });
        (drift + turn.sum::<f64>()).max(f64::MIN_POSITIVE)
    }
}

/// Does an edge of one triangle pass through the other one, reaching more than `margin` to both sides and crossing it
/// more than `margin` from its outline? An estimate.
fn is_crossing(b: &SphereTree, pair: &ClosestPair, margin: f64) -> bool {
    let corners_b = b.corners(pair.triangle_b);
    let passes = |edges: &[DVec3; 3], face: &[DVec3; 3]| {
        (0..3).any(|i| passes_through(edges[i], edges[(i + 1) % 3], face, margin + pair.rounding))
    };
    passes(&pair.corners_a, &corners_b) || passes(&corners_b, &pair.corners_a)
}

/// Does the segment reach more than `margin` to either side of the face, and cross it well inside? An estimate.
fn passes_through(p: DVec3, q: DVec3, face: &[DVec3; 3], margin: f64) -> bool {
    let [a, b, c] = *face;
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length == 0.0 {
        return false;
    }
    let n = normal / length;
    let (s, t) = ((p - a).dot(n), (q - a).dot(n));
    if s.min(t) >= -margin || s.max(t) <= margin {
        return false;
    }
    let x = p + (q - p) * (s / (s - t));
    let turn = |u: DVec3, v: DVec3| (v - u).cross(x - u).dot(n) / (v - u).length();
    turn(a, b).min(turn(b, c)).min(turn(c, a)) > margin
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_bvh::Solid;
    use d2m_testing::{SmallScene, Surface};

    fn draw(index: u64) -> (String, CheckedScene) {
        let mesh = |surface: &Surface| surface.clone().into_mesh(TriMesh::try_new);
        let drawn = SmallScene::draw(0, index, |surface| SphereTree::new(mesh(surface)).is_watertight());
        let solid = if drawn.filled { Solid::Filled } else { Solid::Surface };
        let scene = CheckedScene {
            trees: drawn.surfaces.each_ref().map(|surface| SphereTree::new(mesh(surface))),
            motions: drawn.motions,
            window: Window::try_new(drawn.window[0], drawn.window[1]).unwrap(),
            options: QueryOptions::DEFAULT.with_solid(solid),
        };
        (drawn.name, scene)
    }

    /// The judge sees an answer that is late, one that is missing, one that is far too early, and nothing in a good one.
    #[test]
    fn faults_of_answers_are_noticed() {
        let mut judged = 0;
        for index in 0..40 {
            let (name, scene) = draw(index);
            let [a, b]: [Moving<'_>; 2] =
                core::array::from_fn(|i| Moving::new(&scene.trees[i], &scene.motions[i] as &dyn RigidMotion));
            let answer = time_of_contact(a, b, scene.window, &scene.options).unwrap();
            let oracle = Oracle { a, b, relative: RelativeMotion::new(a.motion, b.motion) };
            let fault = |x: &TimeOfContact| oracle.fault(x, &answer, scene.window);
            assert_eq!(fault(&answer), None, "{name}");
            assert!(!oracle.is_open(&answer), "{name}: {answer:?}");
            let Some(contact) = answer.contact().filter(|c| c.closing_speed > 0.1) else { continue };
            if contact.start != d2m_bvh::StartState::Apart || contact.time_lo + 1e-3 > scene.window.end() {
                continue;
            }
            let shifted = |by: f64| {
                let mut other = *contact;
                other.time_lo += by / contact.closing_speed;
                other.time_hi = other.time_lo;
                TimeOfContact::Contact(other)
            };
            assert!(fault(&shifted(1e-8)).is_some(), "{name}: late by 1e-8");
            assert!(fault(&shifted(-1e-8)).is_some(), "{name}: early by 1e-8");
            assert!(oracle.is_open(&shifted(-1e-8)));
            judged += 1;
        }
        assert!(judged > 10, "{judged}");
    }
}
