//! Do two boxes hold features that face each other? By cones about the normals of the features of each.
//!
//! A pair of locally closest points p of A and q of B has its direction n = (q − p)/|q − p| in both normal cones. With the spheres about
//! the two boxes' triangles, centers c apart and radii r, n is within the angle φ of c, sin φ = (r_A + r_B)/|c|; and |n × a| ≤ s for the
//! double cone of either box. So the axes are no further from c, and from each other, than the sums of the sines say. For surfaces that
//! may share a point nothing is dropped: that they do is an answer, too.

use crate::resting::node_pair::RestingScene;
use crate::tree::normal_cones::{NormalCone, NormalCones};
use d2m_lanes::power_of_two;

/// For the roundings of a turned axis, of centers and their distance, and of the sums: below 2⁻⁴⁰ each.
const ROUNDING: f64 = power_of_two(-36);
/// Directions that the tests of features still accept leave the cones by 8 errors over the distance; they may on either side.
const DIRECTION_ERRORS: f64 = 16.0;

/// Cones of both trees, once a search takes as many steps as it takes to make them.
pub(super) struct Facing<'a> {
    scene: &'a RestingScene<'a>,
    /// Steps after which it is worth it; never for wider normal cones, which these do not hold.
    worth: Option<u64>,
    steps: u64,
    cones: Option<[&'a NormalCones; 2]>,
}

impl<'a> Facing<'a> {
    pub(super) fn new(scene: &'a RestingScene<'a>, cone_slack: f64) -> Self {
        let has_cones = cone_slack == 0.0 && (0..2).all(|body| !scene.is_point_like(body));
        let triangles: usize = scene.trees.iter().map(|tree| tree.mesh().triangle_count()).sum();
        Self { scene, worth: has_cones.then_some(triangles as u64), steps: 0, cones: None }
    }

    pub(super) fn count(&mut self) {
        self.steps += 1;
        if self.worth == Some(self.steps) {
            self.cones = Some(self.scene.trees.map(crate::MeshTree::normal_cones));
        }
    }

    /// False: no two features below these boxes, which are at least `bound` apart, are locally closest to each other.
    pub(super) fn may_be_closest(&self, pair: [u32; 2], bound: f64) -> bool {
        let Some(cones) = self.cones else { return true };
        let error = self.scene.error;
        if bound.is_nan() || bound <= error {
            return true;
        }
        let cone = [0, 1].map(|body| cones[body].of(pair[body]));
        let place = |body: usize, cone: &NormalCone| self.scene.place_sphere(body, cone.center, cone.radius);
        let [(from, radius), (to, radius_other)] = [place(0, cone[0]), place(1, cone[1])];
        let between = to - from;
        let distance = between.length();
        let slack = ROUNDING + DIRECTION_ERRORS * error / bound;
        let near = (radius + radius_other + error) / distance + slack;
        let axes = [0, 1].map(|body| self.scene.turn(body, cone[body].axis));
        // What is no number drops nothing.
        let is_turned_away =
            |body: usize| axes[body].cross(between).length() / distance > cone[body].sine + near;
        let are_askew = axes[0].cross(axes[1]).length() > cone[0].sine + cone[1].sine + slack;
        !(is_turned_away(0) || is_turned_away(1) || are_askew)
    }
}
