//! Distances and closest features of bodies with radii, from those of their meshes.

use crate::margin::sum_of_radii;
use crate::{Distance, Proximity, StartState};

impl Distance {
    /// The distance of the bodies that are everything within these radii, finite and not negative, of the meshes (and of what solid ones
    /// hold) whose distance this is. Witness points are on the rounded surfaces. Of bodies that are neither proven apart nor proven to
    /// overlap the state is [`StartState::Undecided`].
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, Posed, Solid, StartState, TriMesh, distance};
    /// use glam::DVec3;
    /// let point = |x: f64| TriMesh::point(DVec3::X * x).map(MeshTree::new);
    /// let (a, b) = (point(0.0)?, point(3.0)?);
    /// let centers = distance(Posed::at_rest(&a), Posed::at_rest(&b), Solid::Surface)?;
    /// let spheres = centers.with_radii([1.0, 0.5]);
    /// assert!(spheres.lower <= 1.5 && 1.5 <= spheres.upper && spheres.upper - spheres.lower < 1e-12);
    /// assert!((spheres.point_a - DVec3::X).length() < 1e-15 && spheres.state == StartState::Apart);
    /// assert_eq!(centers.with_radii([2.0, 1.5]).state, StartState::Overlapping);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_radii(mut self, radii: [f64; 2]) -> Self {
        let [least, most] = sum_of_radii(radii);
        if most == 0.0 || self.state == StartState::Contained {
            return self;
        }
        let (lower, upper) = ((self.lower - most).next_down(), (self.upper - least).next_up());
        self.state = match self.state {
            StartState::Apart if lower > 0.0 => StartState::Apart,
            StartState::Apart | StartState::Undecided if upper >= 0.0 => StartState::Undecided,
            _ => StartState::Overlapping,
        };
        self.value = if self.state == StartState::Apart { (self.value - most).max(lower) } else { 0.0 };
        (self.lower, self.upper) = (lower.max(0.0), upper.max(0.0));
        self.point_a += self.normal * radii[0];
        self.point_b -= self.normal * radii[1];
        self
    }
}

impl Proximity {
    /// The same of bodies that are everything within these radii, finite and not negative, of the meshes: points on the rounded surfaces,
    /// and their distance, which is below zero where these overlap.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, Posed, TriMesh, proximities};
    /// use glam::DVec3;
    /// let point = |x: f64| TriMesh::point(DVec3::X * x).map(MeshTree::new);
    /// let (a, b) = (point(0.0)?, point(3.0)?);
    /// let near = proximities(Posed::at_rest(&a), Posed::at_rest(&b), 4.0)?;
    /// let spheres = near[0].with_radii([1.0, 0.5]);
    /// assert!((spheres.distance - 1.5).abs() < 1e-15 && (spheres.point_b - DVec3::X * 2.5).length() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_radii(mut self, radii: [f64; 2]) -> Self {
        self.distance -= radii[0] + radii[1];
        self.point_a += self.normal * radii[0];
        self.point_b -= self.normal * radii[1];
        self
    }
}
