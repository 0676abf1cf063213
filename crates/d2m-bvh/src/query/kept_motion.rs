//! Motions that several pairs of a batch have in common: what is computed of one for a pair is kept for the others.
//!
//! Searches of motions whose twist is not constant begin alike, whatever the other body does: with poses at the start of the window and of each piece,
//! and with spans from there that are halved until fitted twists are near enough.

use crate::Moving;
use d2m_motion::{KeptMotion, RigidMotion};
use std::borrow::Cow;
use std::collections::HashMap;

/// Motions of a batch that are kept at most: each takes some 50 000 bytes.
const MOST_MOTIONS: usize = 64;
/// Both bodies of each query.
type Pairs<'a> = [(Moving<'a>, Moving<'a>)];

/// The motions that more than one body of a batch has.
pub(super) struct KeptMotions<'a> {
    motions: Vec<KeptMotion<'a>>,
    /// Which of them the bodies of each pair have; nothing where there are none.
    of_pairs: Vec<[Option<usize>; 2]>,
}

impl<'a> KeptMotions<'a> {
    pub(super) fn new(pairs: &Pairs<'a>) -> Self {
        // By address and type: bodies with the same two have one motion. `None`: met once.
        let mut met: HashMap<*const (dyn RigidMotion + 'a), Option<usize>> = HashMap::new();
        let mut motions = Vec::new();
        let bodies = pairs.iter().flat_map(|(a, b)| [a, b]);
        for motion in bodies.map(|body| body.motion).filter(|motion| motion.constant_twist().is_none()) {
            let number = met.entry(motion).and_modify(|number| {
                if number.is_none() && motions.len() < MOST_MOTIONS {
                    *number = Some(motions.len());
                    motions.push(KeptMotion::new(motion));
                }
            });
            number.or_insert(None);
        }
        if motions.is_empty() {
            return Self { motions, of_pairs: Vec::new() };
        }
        let number = |body: &Moving<'a>| met.get(&core::ptr::from_ref(body.motion)).copied().flatten();
        let of_pairs = pairs.iter().map(|(a, b)| [number(a), number(b)]).collect();
        Self { motions, of_pairs }
    }

    /// The same pairs, with the motions that are kept in place of their own.
    pub(super) fn in_pairs<'s>(&'s self, pairs: &'s Pairs<'a>) -> Cow<'s, Pairs<'s>> {
        if self.motions.is_empty() {
            return Cow::Borrowed(pairs);
        }
        let kept = |body: Moving<'s>, number: Option<usize>| match number {
            Some(number) => Moving { motion: &self.motions[number], ..body },
            None => body,
        };
        let all = pairs.iter().zip(&self.of_pairs);
        Cow::Owned(all.map(|(&(a, b), &[of_a, of_b])| (kept(a, of_a), kept(b, of_b))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ClearanceOptions, MeshTree, QueryOptions, TriMesh, Window};
    use crate::{clearance, clearance_batch, time_of_contact, time_of_contact_batch};
    use core::sync::atomic::{AtomicUsize, Ordering};
    use d2m_interval::Interval;
    use d2m_motion::{
        CertifiedState, IntervalPose, IntervalTwist, Kinematics, Pose, Spline, SplineDegree, Twist,
    };
    use d2m_testing::{Draw, KnuthRandom, Surface};
    use glam::{DQuat, DVec3};

    /// A spline that counts how many of its poses, states and bounds are asked for.
    struct Counted {
        motion: Spline,
        asked: AtomicUsize,
    }

    impl Counted {
        fn count(&self) -> &Spline {
            self.asked.fetch_add(1, Ordering::Relaxed);
            &self.motion
        }
    }

    impl RigidMotion for Counted {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            self.count().pose_and_twist(t)
        }
        fn enclose_pose(&self, t: Interval) -> IntervalPose {
            self.motion.enclose_pose(t)
        }
        fn enclose_twist(&self, t: Interval) -> IntervalTwist {
            self.motion.enclose_twist(t)
        }
        fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
            self.motion.enclose_twist_rate(t)
        }
        fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
            self.count().enclose_state_about(t, origin)
        }
        fn enclose_kinematics(&self, t: Interval) -> Kinematics {
            self.count().enclose_kinematics(t)
        }
        fn smooth_until(&self, t: f64) -> Option<f64> {
            self.motion.smooth_until(t)
        }
    }

    /// Nearly a straight way, and a steady turn.
    fn spline(random: &mut KnuthRandom, from: DVec3, to: DVec3) -> Spline {
        let (start, turn) = (DQuat::from_scaled_axis(random.vector()), random.vector());
        let frames = [0.0, 0.25, 0.5, 0.75, 1.0].map(|time: f64| {
            let rotation = DQuat::from_scaled_axis(turn * time) * start;
            let translation = from.lerp(to, time + 0.1 * time * time);
            (time, Pose { translation, rotation, at: DVec3::ZERO })
        });
        Spline::try_through(&frames, SplineDegree::Cubic).unwrap()
    }

    /// The bits of single queries, for two thirds of the questions to the motion that the pairs have in common.
    #[test]
    fn a_motion_that_pairs_have_in_common_is_asked_once() {
        let mut random = KnuthRandom(91);
        let tree = MeshTree::new(Surface::wavy_torus(24, 12, 0.3).into_mesh(TriMesh::try_new));
        let common = spline(&mut random, DVec3::ZERO, DVec3::new(0.3, -0.2, 0.1));
        let common = Counted { motion: common, asked: AtomicUsize::new(0) };
        let asked = || common.asked.swap(0, Ordering::Relaxed);
        let moved: Vec<Spline> = (0..40)
            .map(|_| {
                let from = random.vector().normalize() * 5.0;
                let to = random.vector() * 4.0 - from;
                spline(&mut random, from, to)
            })
            .collect();
        // On either side.
        let pair = |k: usize| {
            let both = [Moving::new(&tree, &moved[k]), Moving::new(&tree, &common)];
            if k.is_multiple_of(2) { (both[0], both[1]) } else { (both[1], both[0]) }
        };
        let pairs: Vec<_> = (0..moved.len()).map(pair).collect();
        let options = QueryOptions::default();
        let single: Vec<_> =
            pairs.iter().map(|&(a, b)| time_of_contact(a, b, Window::UNIT, &options)).collect();
        let alone = asked();
        let batch = time_of_contact_batch(&pairs, Window::UNIT, &options);
        let shared = asked();
        assert_eq!(batch, single);
        let met = batch.iter().flatten().filter(|answer| answer.contact().is_some()).count();
        assert!(met > 10 && met < 40, "{met}");
        assert!(3 * shared < 2 * alone, "{shared} of {alone}");
        let options = ClearanceOptions::default();
        let single: Vec<_> = pairs.iter().map(|&(a, b)| clearance(a, b, Window::UNIT, &options)).collect();
        assert_eq!(clearance_batch(&pairs, Window::UNIT, &options), single);
    }
}
