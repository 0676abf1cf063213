//! From a time at which the bodies are close, forwards or backwards: how far are they apart by more than a level?
//!
//! Near the time of the least distance every pair of triangles parts both ways, so a search that begins there is over soon, and one
//! that comes towards it is not: it approaches a double root.

use crate::query::meshes::of_meshes;
use crate::{Moving, QueryError, QueryOptions, SearchCounts, StartState, TimeOfContact, Window};
use d2m_motion::ConstantTwist;

/// A span of time that is to be proven, from a time on, later or earlier.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) from: f64,
    pub(super) to: f64,
}

/// How a way ended.
#[derive(Clone, Copy, Debug)]
pub(super) enum WayEnd {
    Clear,
    Undecided,
    /// One body is inside the other one.
    Contained,
    /// These triangles come near at this time; clear until then.
    Near {
        triangles: [u32; 2],
        time: f64,
    },
}

/// What a search along a way gave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) end: WayEnd,
    /// As it was searched.
    pub(super) way: Way,
    pub(super) work: SearchCounts,
    /// Proven: neither body is inside the other one.
    pub(super) is_outside: bool,
    /// That the search used.
    pub(super) tolerance: f64,
}

impl Way {
    /// The same span from a time within it on both ways, where it is within.
    pub(super) fn divided_at(self, time: f64) -> impl Iterator<Item = Self> {
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let is_within = low < time && time < high;
        let first = if is_within { Self { from: time, to: self.from } } else { self };
        [Some(first), is_within.then_some(Self { from: time, to: self.to })].into_iter().flatten()
    }

    /// Searches along it.
    pub(super) fn search(
        &self,
        bodies: [Moving<'_>; 2],
        options: &QueryOptions,
    ) -> Result<Found, QueryError> {
        let way = *self;
        let is_backward = way.to < way.from;
        let reversed = if is_backward { reversed(&bodies, way.to, way.from) } else { None };
        let way = match reversed {
            Some(_) => way,
            None => Way { from: way.from.min(way.to), to: way.from.max(way.to) },
        };
        let sign = if reversed.is_some() { -1.0 } else { 1.0 };
        let window = Window::try_new(sign * way.from, sign * way.to)?;
        let moving = match &reversed {
            Some([a, b]) => [Moving { motion: a, ..bodies[0] }, Moving { motion: b, ..bodies[1] }],
            None => bodies,
        };
        let answered = of_meshes(moving, window, options)?;
        let begin = window.start();
        let (end, is_outside, tolerance) = match answered.answer {
            TimeOfContact::Separated => (WayEnd::Clear, true, 0.0),
            TimeOfContact::Undecided { .. } => (WayEnd::Undecided, false, 0.0),
            TimeOfContact::Contact(contact) => {
                let is_held = contact.start == StartState::Contained && contact.time_lo == begin;
                let near = WayEnd::Near {
                    triangles: [contact.triangle_a, contact.triangle_b],
                    time: sign * contact.time_lo,
                };
                let end = if is_held { WayEnd::Contained } else { near };
                (end, contact.start == StartState::Apart && contact.time_lo > begin, contact.tolerance)
            }
        };
        Ok(Found { end, way, work: answered.work, is_outside, tolerance })
    }
}

/// The motions run backwards: at −t where the bodies are at t. Only signs change, so that is exact. `None` where a motion has no
/// constant twist between the two times.
fn reversed(bodies: &[Moving<'_>; 2], from: f64, to: f64) -> Option<[ConstantTwist; 2]> {
    let one = |body: &Moving<'_>| {
        let piece = body.motion.constant_twist_from(from)?;
        let twist = piece.until.is_none_or(|until| until >= to).then_some(piece.motion)?;
        Some(
            twist
                .with_linear_velocity(-twist.linear_velocity())
                .with_angular_velocity(-twist.angular_velocity())
                .with_reference_time(-twist.reference_time()),
        )
    };
    Some([one(&bodies[0])?, one(&bodies[1])?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshTree, TriMesh};
    use d2m_motion::RigidMotion;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DVec3;

    #[test]
    fn motions_run_backwards() {
        let tree = MeshTree::new(TriMesh::point(DVec3::X).unwrap());
        let mut random = KnuthRandom(7);
        for _ in 0..100 {
            let twists = [(); 2].map(|()| {
                let turn = random.moderate_turn().normalize();
                ConstantTwist::try_new(random.vector(), turn, random.vector(), random.vector() * 3.0)
                    .unwrap()
                    .with_reference_time(random.signed())
                    .with_at(random.vector())
            });
            let bodies = [Moving::new(&tree, &twists[0]), Moving::new(&tree, &twists[1])];
            let backwards = reversed(&bodies, -1.0, 1.0).expect("constant twists");
            for (there, back) in twists.iter().zip(&backwards) {
                let time = random.signed();
                let (p, q) = (random.vector(), there.pose_and_twist(time));
                let r = back.pose_and_twist(-time);
                assert!((q.0.transform_point(p) - r.0.transform_point(p)).length() < 1e-14);
                assert_eq!((q.1.linear, q.1.angular), (-r.1.linear, -r.1.angular));
            }
        }
    }

    #[test]
    fn a_way_is_divided_at_times_inside_only() {
        let ways = |time: f64| -> Vec<[f64; 2]> {
            Way { from: 3.0, to: 1.0 }.divided_at(time).map(|way| [way.from, way.to]).collect()
        };
        assert_eq!(ways(2.0), [[2.0, 3.0], [2.0, 1.0]]);
        assert_eq!([ways(1.0), ways(3.0), ways(9.0)], [[[3.0, 1.0]], [[3.0, 1.0]], [[3.0, 1.0]]]);
    }
}
