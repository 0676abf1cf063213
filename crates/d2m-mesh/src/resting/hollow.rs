//! How far surfaces are from points and segments of their own axes.

use super::distance::{DistanceOptions, distance_within};
use crate::{MeshTree, Posed, Solid, TriMesh};
use d2m_motion::Pose;
use glam::DVec3;

impl MeshTree {
    /// A lower bound of the distance of the mesh's surface from a point of its frame: how much room there is about it, also inside of what is hollow.
    /// Zero where that does not show.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TriMesh};
    /// use glam::DVec3;
    /// let wall = MeshTree::new(TriMesh::try_new(vec![DVec3::X, DVec3::X + DVec3::Y, DVec3::X + DVec3::Z], vec![[0, 1, 2]])?);
    /// let room = wall.bound_distance_from_point(DVec3::ZERO);
    /// assert!(room <= 1.0 && room > 1.0 - 1e-9);
    /// assert_eq!(wall.bound_distance_from_point(DVec3::X), 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bound_distance_from_point(&self, point: DVec3) -> f64 {
        TriMesh::point(point).map_or(0.0, |point| self.bound_distance_from(point))
    }

    /// The same from a segment with these ends.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TriMesh};
    /// use glam::DVec3;
    /// let wall = MeshTree::new(TriMesh::try_new(vec![DVec3::X, DVec3::X + DVec3::Y, DVec3::X + DVec3::Z], vec![[0, 1, 2]])?);
    /// let room = wall.bound_distance_from_segment([DVec3::X * -3.0, DVec3::X * 0.5]);
    /// assert!(room <= 0.5 && room > 0.5 - 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bound_distance_from_segment(&self, [start, end]: [DVec3; 2]) -> f64 {
        TriMesh::segment(start, end).map_or(0.0, |segment| self.bound_distance_from(segment))
    }

    fn bound_distance_from(&self, other: TriMesh) -> f64 {
        let options = DistanceOptions::default().with_solid(Solid::Surface);
        let other = Self::new(other);
        let [other, own] = [&other, self].map(|tree| Posed::new(tree, Pose::IDENTITY));
        distance_within(other, own, &options).ok().flatten().map_or(0.0, |found| found.lower)
    }
}
