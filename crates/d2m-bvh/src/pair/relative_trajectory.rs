//! How two bodies move past each other, and by how much two such relative trajectories deviate.
//!
//! Points a of A and b of B, from the reference points, are (x_A − x_B) + R_A a − R_B b apart. Along another trajectory with
//! the same bodies this vector differs, at the same time after the start, by at most
//! |Δ(x_A − x_B)| + ‖ΔR_A‖ρ_A + ‖ΔR_B‖ρ_B + |Δat_A| + |Δat_B|. The first term is a norm of something linear in time, so it
//! is largest at an end; ‖ΔR‖ at time τ is at most its value at the start plus |Δω|τ. So is the difference of any two
//! distances. See docs/theory/engine.md, "What one query proves for the next".

use crate::pair::motion::rotation::Columns;
use crate::pair::motion::track::given_relative_position;
use crate::pair::motion::units::Units;
use crate::pair::scene::MovingScene;
use d2m_mesh::margin::UNIT_F64;
use d2m_mesh::node::TreeId;
use glam::DVec3;

/// Part of the sizes of both scenes, and of the deviation, that covers all roundings here: positions err by 64·2⁻⁵³ of the size, entries
/// of rotations by 16·2⁻⁵³, and some thirty operations follow.
const TRAJECTORY_ERROR: f64 = 4096.0 * UNIT_F64;

/// Two bodies over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RelativeTrajectory {
    /// Which trees.
    trees: [TreeId; 2],
    /// The units of times and lengths.
    units: Units,
    /// Length of the window.
    length: f64,
    /// Reference point of A from that of B at the start, and its velocity.
    apart: DVec3,
    velocity: DVec3,
    rotations: [Columns; 2],
    omegas: [DVec3; 2],
    /// From the reference points to the centers of the trees, body frames.
    arms: [DVec3; 2],
    /// Bounds on the distances of the bodies' points from them.
    reach: [f64; 2],
    /// Bound on the speed at which any two points come closer.
    speed: f64,
    size: f64,
}

impl RelativeTrajectory {
    pub(crate) fn of(scene: &MovingScene<'_>) -> Self {
        let (a, b) = (&scene.a, &scene.b);
        let velocity = a.motion.linear_velocity() - b.motion.linear_velocity();
        Self {
            trees: [a, b].map(|body| body.tree.id()),
            units: scene.units,
            length: scene.end,
            apart: DVec3::from_array(given_relative_position(&a.motion, &b.motion).map(|x| x.hi)),
            velocity,
            rotations: [a, b].map(|body| body.motion.rotation(0.0)),
            omegas: [a, b].map(|body| body.motion.angular_velocity()),
            arms: [a, b].map(|body| body.motion.given_arm()),
            reach: [a.given_reach(), b.given_reach()],
            speed: velocity.length() + scene.spin_speed,
            size: scene.size,
        }
    }

    /// If the bodies are further apart than d at all times of `earlier`, they are further apart than d minus this at
    /// all times of `self`, in the unit of the meshes. `None` for other bodies.
    pub(crate) fn deviation(&self, earlier: &Self) -> Option<f64> {
        if self.trees != earlier.trees {
            return None;
        }
        // Units are powers of two.
        let (length, time) =
            (earlier.units.length() / self.units.length(), earlier.units.time() / self.units.time());
        let common = self.length.min(earlier.length * time);
        let shift = self.apart - earlier.apart * length;
        let later = shift + (self.velocity - earlier.velocity * (length / time)) * common;
        let mut sum = shift.length().max(later.length());
        for k in 0..2 {
            let turned: f64 =
                (0..3).map(|i| (self.rotations[k][i] - earlier.rotations[k][i]).length_squared()).sum();
            let turning = (self.omegas[k] - earlier.omegas[k] / time).length() * common;
            let moved = self.arms[k] - earlier.arms[k] * length;
            sum += (turned.sqrt() + turning) * self.reach[k] + moved.length();
        }
        // A longer window: what is left after the common part.
        sum += self.speed * (self.length - common);
        let sum = sum * (1.0 + TRAJECTORY_ERROR) + TRAJECTORY_ERROR * (self.size + earlier.size * length);
        Some(sum * self.units.length())
    }

    /// Both reaches: a deviation of that size is no small change.
    pub(crate) fn extent(&self) -> f64 {
        (self.reach[0] + self.reach[1]) * self.units.length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_motion::ConstantTwist;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DQuat;

    fn trajectory(trees: &[MeshTree; 2], motions: &[ConstantTwist; 2], window: Window) -> RelativeTrajectory {
        let scene = MovingScene::new(
            (&trees[0], motions[0]),
            (&trees[1], motions[1]),
            window,
            &QueryOptions::default(),
        );
        RelativeTrajectory::of(&scene)
    }

    /// Changes of one kind each, of either body: no two points come together by more than the deviation, and for some
    /// they nearly do, so that no term can be left out or made smaller.
    #[test]
    fn deviations_hold_and_each_term_is_needed() {
        let mut random = KnuthRandom(3);
        let corners = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].to_vec();
        let mesh = TriMesh::try_new(corners.clone(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        let trees = [0, 1].map(|_| MeshTree::new(mesh.clone()));
        for kind in 0..6 {
            let mut sharpest: f64 = 0.0;
            for round in 0..400 {
                let old = [0, 1].map(|_| {
                    let q = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.5);
                    let spin = random.vector() * [0.0, 0.2, 3.0][round % 3];
                    ConstantTwist::try_new(random.vector() * 3.0, q, random.vector(), spin).unwrap()
                });
                let mut new = old;
                let (m, small) = (&mut new[round / 3 % 2], 10f64.powi(-((round % 5) as i32)));
                let axis = random.vector().normalize();
                *m = match kind {
                    0 => m.with_position(m.position() + random.vector() * small),
                    1 => m.with_linear_velocity(m.linear_velocity() + random.vector() * small),
                    2 => m.with_orientation(DQuat::from_axis_angle(axis, small) * m.orientation()),
                    3 => m.with_angular_velocity(m.angular_velocity() + axis * small),
                    4 => m.with_at(random.vector() * small),
                    _ => *m,
                };
                let longer = if kind == 5 { 1.0 + small } else { 1.0 };
                let windows =
                    [Window::try_new(2.0, 3.0).unwrap(), Window::try_new(-1.0, longer - 1.0).unwrap()];
                // Windows start at the motions' reference times.
                let [old_at, new_at] =
                    [(old, 2.0), (new, -1.0)].map(|(m, t)| m.map(|m| m.with_reference_time(t)));
                let deviation = trajectory(&trees, &new_at, windows[1])
                    .deviation(&trajectory(&trees, &old_at, windows[0]))
                    .unwrap();
                for after in [0.0, 0.3, 1.0, longer] {
                    let before = after.min(1.0);
                    let place = |m: &ConstantTwist, after: f64| -> Vec<DVec3> {
                        let m = m.rebase(m.reference_time() + after);
                        let turn = m.orientation().normalize();
                        corners.iter().map(|p| m.position() + turn * (p - m.at())).collect()
                    };
                    let (was, is) = (old_at.map(|m| place(&m, before)), new_at.map(|m| place(&m, after)));
                    for (i, j) in (0..36).map(|k| (k / 6, k % 6)) {
                        let change = (was[0][i] - was[1][j]).length() - (is[0][i] - is[1][j]).length();
                        assert!(change <= deviation, "kind {kind}: {change} > {deviation}");
                        sharpest = sharpest.max(change / deviation);
                    }
                }
            }
            assert!(sharpest > [0.9, 0.9, 0.4, 0.5, 0.9, 0.4][kind], "kind {kind}: {sharpest}");
        }
    }

    #[test]
    fn other_bodies_cannot_be_compared() {
        let mesh = TriMesh::try_new(vec![DVec3::X, DVec3::Y, DVec3::Z], vec![[0, 1, 2]]).unwrap();
        let tree = || MeshTree::new(mesh.clone());
        let mut trees = [tree(), tree()];
        let still = [ConstantTwist::REST; 2];
        let first = trajectory(&trees, &still, Window::UNIT);
        assert!(first.deviation(&trajectory(&trees.clone(), &still, Window::UNIT)).unwrap() < 1e-11);
        assert_eq!(first.deviation(&trajectory(&[tree(), tree()], &still, Window::UNIT)), None);
        trees[1].refit(vec![DVec3::X, DVec3::Y, DVec3::Z * 2.0]).unwrap();
        assert_eq!(trajectory(&trees, &still, Window::UNIT).deviation(&first), None);
    }
}
