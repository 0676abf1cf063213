//! Where a whole body can be, from its outermost box.

use super::mesh_tree::MeshTree;
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::power_of_two;
use d2m_motion::IntervalPose;
use glam::DVec3;

/// Covers the deviation of the stored axes from orthonormal, at most 5.2·2⁻²⁴ (see the node's layout).
const AXES_ERROR: f64 = power_of_two(-21);

impl MeshTree {
    /// Encloses every point of the body in every pose of a set, in world axes: the outermost oriented box, turned and
    /// moved, or its sphere where that is smaller.
    ///
    /// ```text
    /// |R(p − c)|ⱼ ≤ min(r, Σᵢ |R aᵢ|ⱼ hᵢ)   for a box with center c, axes aᵢ, half extents hᵢ and radius r
    /// ```
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TriMesh};
    /// use d2m_interval::Interval;
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// use glam::DVec3;
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let tree = MeshTree::new(mesh);
    /// let motion = ConstantTwist::REST.with_linear_velocity(DVec3::X * 8.0);
    /// let swept = tree.enclose_placed(&motion.enclose_pose(Interval::new(0.0, 1.0)));
    /// assert!(swept.lo().x <= 0.0 && swept.hi().x >= 9.0 && swept.hi().x < 10.0);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub fn enclose_placed(&self, poses: &IntervalPose) -> IntervalVec3 {
        let root = &self.nodes[0];
        let boxed = root.oriented_box(0);
        let wide = |v: [f32; 3]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
        // Products with a power of two are exact; the sums are rounded outward.
        let local = IntervalVec3::point(wide(root.origin) * self.unit) + wide(boxed.center) * self.unit;
        let center = poses.rotation.mul_vec(local + self.center - poses.at) + poses.translation;
        let radius = Interval::point(f64::from(boxed.radius) * self.unit);
        let axes = boxed.axes.map(|axis| poses.rotation.mul_point(wide(axis)));
        let grown = |middle: Interval, size: fn(IntervalVec3) -> f64| {
            let mut reach = radius * AXES_ERROR;
            for (axis, half) in axes.iter().zip(boxed.half_extent) {
                reach += Interval::point(size(*axis)) * (f64::from(half) * self.unit);
            }
            let reach = reach.hi().min(radius.hi());
            middle + Interval::new(-reach, reach)
        };
        IntervalVec3::new(
            grown(center.x, |axis| axis.x.mag()),
            grown(center.y, |axis| axis.y.mag()),
            grown(center.z, |axis| axis.z.mag()),
        )
    }
}

#[cfg(test)]
mod tests {
    use crate::{MeshTree, TriMesh};
    use d2m_interval::Interval;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom, Surface};
    use glam::DVec3;

    #[test]
    fn every_vertex_stays_inside_and_little_room_is_left() {
        let stretched = Surface::wavy_torus(12, 7, 0.2).map(|p| p * DVec3::new(4.0, 0.5, 0.25) + DVec3::X);
        let tree = MeshTree::new(stretched.into_mesh(TriMesh::try_new));
        let mut random = KnuthRandom(7);
        for round in 0..300 {
            let motion = ConstantTwist::try_new(
                random.vector() * 9.0,
                random.moderate_turn().normalize(),
                random.vector(),
                random.vector(),
            );
            let motion = motion.unwrap().with_at(random.vector());
            let length = [0.0, 1e-3, 0.1, 40.0][round % 4];
            let swept = tree.enclose_placed(&motion.enclose_pose(Interval::new(0.5, 0.5 + length)));
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for step in 0..=8 {
                let pose = motion.pose_and_twist(0.5 + length * f64::from(step) / 8.0).0;
                for &vertex in tree.mesh().vertices() {
                    let p = pose.transform_point(vertex);
                    (low, high) = (low.min(p), high.max(p));
                }
            }
            let rounding = 1e-13;
            assert!(
                (low - swept.lo()).min_element() > -rounding && (swept.hi() - high).min_element() > -rounding
            );
            if length == 0.0 {
                // The box of a long thin body, in any direction: not its sphere.
                let (size, sphere) = (swept.hi() - swept.lo(), 2.0 * tree.radius());
                assert!(size.element_product() < 0.7 * sphere * sphere * sphere, "{swept:?} {low} {high}");
            }
        }
    }
}
