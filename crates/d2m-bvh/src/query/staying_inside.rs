//! A point of one body that is deep inside of the other, which is filled: how long does it stay there?
//!
//! A point p that goes with body K is in K and, at a time t₀, in the other body, further than d from its surface. Seen from that body it
//! moves with the velocity v_K + ω_K × (p − c_K) − v − ω × (p − c). Ways out of a solid lead through its surface, so that p is in both
//! bodies until it has come as far as d: for a time of d over its greatest speed. This holds where no two triangles cross for
//! long, as of teeth that pass through each other, and where none ever do, as of boxes with sides in common planes.

use super::at_start::deviation;
use crate::{MeshTree, Meter, Moving, Posed, Solid, TriMesh};
use d2m_interval::Interval;
use d2m_lanes::UP;
use d2m_mesh::at_rest::{holds, middle_of_boxes};
use d2m_mesh::distance;
use d2m_motion::Ball;
use glam::DVec3;

/// Corners of triangles of each body at most that are tried.
const MOST: usize = 12;
/// Node tests that a point counts for in a budget.
const TESTS_A_POINT: u64 = 64;

/// A point of one body that is inside of the other at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeepPoint {
    /// What it goes with.
    body: usize,
    /// In that body's own frame.
    point: DVec3,
    /// Its distance from the other body's surface is no less.
    depth: f64,
    time: f64,
}

/// A point that may be deep, as of a [`DeepPoint`].
struct Candidate {
    body: usize,
    point: DVec3,
    /// Of its own body: then it is in that, whatever the rounding.
    is_corner: bool,
}

impl DeepPoint {
    /// The deepest of some points of one body that are inside of the other, if that is filled: corners of these triangles, and, if both are
    /// filled, the middles of what the bounding boxes share.
    pub(super) fn find(
        bodies: &[Moving<'_>; 2],
        solids: [Solid; 2],
        pairs: &[[u32; 2]],
        time: f64,
        meter: &mut Meter,
    ) -> Option<Self> {
        let poses = bodies.map(|body| body.motion.pose_and_twist(time).0);
        let off = [0, 1].map(|k| deviation(&bodies[k], &poses[k], time, poses[1].translation));
        let blur = (off[0] + off[1]) * UP;
        let posed = [0, 1].map(|k| Posed::new(bodies[k].body, poses[k]));
        let middles = [(1, posed), (0, [posed[1], posed[0]])].into_iter().filter_map(|(body, posed)| {
            Some(Candidate { body, point: middle_of_boxes(&posed)?, is_corner: false })
        });
        let mut best: Option<Self> = None;
        for Candidate { body, point, is_corner } in corners(bodies, pairs).into_iter().chain(middles) {
            // A surface holds nothing, and of itself it has no more than its triangles.
            if solids[1 - body] == Solid::Surface || !is_corner && solids[body] == Solid::Surface {
                continue;
            }
            // What is found is as good without the others.
            if meter.is_exhausted() {
                break;
            }
            meter.spend(TESTS_A_POINT);
            // In its body's own frame the point is what it is.
            let Ok(mesh) = TriMesh::point(point) else { continue };
            let tree = MeshTree::new(mesh);
            let placed = Posed::new(&tree, poses[body]);
            let (own, other) = (posed[body], posed[1 - body]);
            // The other one first: points on its surface end here.
            if !holds(other, placed, blur, meter).unwrap_or(false)
                || !(is_corner || holds(own, placed, 0.0, meter).unwrap_or(false))
            {
                continue;
            }
            let Ok(apart) = distance(other, placed, Solid::Surface) else { continue };
            let depth = apart.lower - blur;
            if depth > best.map_or(0.0, |best| best.depth) {
                best = Some(Self { body, point, depth, time });
            }
        }
        best
    }

    /// Is it proven to be in both bodies until `to`? No joint of the motions is before that.
    pub(super) fn stays_until(&self, bodies: &[Moving<'_>; 2], to: f64) -> bool {
        let span = Interval::new(self.time, to);
        let own = bodies[self.body].motion.enclose_kinematics(span).following(self.point);
        let other = bodies[1 - self.body].motion.enclose_kinematics(span);
        let tails = Ball::point(own.position_tail) - Ball::point(other.position_tail);
        let apart = own.position - other.position + tails;
        let speed = own.linear - other.linear - other.angular.cross(apart);
        let way = speed.bound_length() * ((to - self.time) * UP) * UP;
        // What is not a number is no proof.
        way < self.depth
    }

    /// About until when it stays, if it goes on as fast.
    pub(super) fn guess(&self, bodies: &[Moving<'_>; 2]) -> f64 {
        let states = bodies.map(|body| body.motion.pose_and_twist(self.time));
        let place = states[self.body].0.transform_point(self.point);
        let [a, b] = states.map(|(pose, twist)| twist.velocity_of(place - pose.translation));
        self.time + self.depth / (a - b).length()
    }
}

/// Corners of some pairs of triangles, each once, and one vertex of each part of the bodies: where one holds the other, no triangles are near.
fn corners(bodies: &[Moving<'_>; 2], pairs: &[[u32; 2]]) -> Vec<Candidate> {
    let mut found = Vec::new();
    for body in [0, 1] {
        let tree = bodies[body].body;
        let mesh = tree.mesh();
        let mut ids: Vec<u32> = pairs.iter().flat_map(|pair| mesh.triangles()[pair[body] as usize]).collect();
        ids.extend(tree.component_vertices());
        ids.sort_unstable();
        ids.dedup();
        let step = 1 + ids.len() / MOST;
        let points = ids.into_iter().step_by(step).map(|v| mesh.vertices()[v as usize]);
        found.extend(points.map(|point| Candidate { body, point, is_corner: true }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::ConstantTwist;
    use d2m_testing::Surface;

    fn cube(half: f64) -> MeshTree {
        MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
    }

    fn find(bodies: &[Moving<'_>; 2]) -> Option<DeepPoint> {
        DeepPoint::find(bodies, [Solid::Filled; 2], &[[0, 0], [5, 7]], 0.0, &mut Meter::unlimited())
    }

    /// A small cube in the middle of a large one leaves it after a way of 1, along x or carried around: no sooner than it says.
    #[test]
    fn what_is_inside_stays_there_until_it_has_come_as_far_as_the_surface() {
        let (large, small) = (cube(1.0), cube(0.125));
        let still = ConstantTwist::REST;
        let straight = still.with_linear_velocity(DVec3::X * 2.0);
        let slow = still.with_linear_velocity(DVec3::X * 0.5);
        // The large one turns about its own middle: seen from it the small one's corners go in circles.
        let turning = still.with_angular_velocity(DVec3::Z * 3.0);
        let far = still.with_position(DVec3::X * 0.5);
        let of = |of_large, of_small| [Moving::new(&large, of_large), Moving::new(&small, of_small)];
        for (bodies, speed) in [
            (of(&still, &straight), 2.0),
            (of(&straight, &still), 2.0),
            (of(&straight, &slow), 1.5),
            (of(&turning, &far), 3.0 * (0.375_f64 * 0.375 + 0.125 * 0.125).sqrt()),
        ] {
            let point = find(&bodies).unwrap();
            assert!(point.depth > 0.3 && point.depth <= 1.0, "{point:?}");
            let exit = point.depth / speed;
            assert!(point.stays_until(&bodies, 0.5 * exit), "{point:?}");
            assert!(!point.stays_until(&bodies, 1.5 * exit), "{point:?}");
            let [a, b] = bodies;
            let exchanged = [b, a];
            let other = find(&exchanged).unwrap();
            assert!((other.depth - point.depth).abs() < 1e-12, "{other:?} {point:?}");
        }
    }

    /// Of the points that one way through them all would cost, half as many tests pay for the first ones alone, and none for none.
    #[test]
    fn points_are_sought_for_as_long_as_the_budget_lasts() {
        let (large, small) = (cube(1.0), cube(0.125));
        let still = ConstantTwist::REST;
        let bodies = [Moving::new(&large, &still), Moving::new(&small, &still)];
        let spent = |most: u64| {
            let mut meter = Meter::unlimited().at_most(most);
            let found = DeepPoint::find(&bodies, [Solid::Filled; 2], &[[0, 0], [5, 7]], 0.0, &mut meter);
            (found.is_some(), meter.spent())
        };
        let (_, all) = spent(u64::MAX);
        assert_eq!(spent(0), (false, 0));
        assert!(spent(all / 2).1 < all / 2 + 2 * TESTS_A_POINT);
    }

    /// Bodies that share no point, or only points of their surfaces, have none that is deep.
    #[test]
    fn no_point_is_deep_where_insides_share_none() {
        let (a, b) = (cube(1.0), cube(1.0));
        for (x, is_deep) in [(1.5, true), (2.0, false), (2.5, false)] {
            let place = ConstantTwist::REST.with_position(DVec3::X * x);
            let bodies = [Moving::new(&a, &ConstantTwist::REST), Moving::new(&b, &place)];
            assert_eq!(find(&bodies).is_some(), is_deep, "{x}");
        }
    }
}
