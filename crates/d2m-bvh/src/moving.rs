use crate::{MeshTree, QueryOptions, Solid};
use d2m_feature::MovingTriangle;
use d2m_motion::{MovingBall, RigidMotion};

/// A body with its motion.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, Solid};
/// use d2m_motion::ConstantTwist;
/// let falling = ConstantTwist::REST.with_linear_velocity(DVec3::Z * -4.0);
/// let body = Moving::new(&tree, &falling); // borrows both, and may be copied
/// assert_eq!((body.solid, body.radius), (None, 0.0));
/// let rounded = body.with_solid(Solid::Surface).with_radius(0.1);
/// assert_eq!((rounded.solid, rounded.radius), (Some(Solid::Surface), 0.1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub struct Moving<'a, B = MeshTree> {
    /// The body in its own frame.
    pub body: &'a B,
    /// How the body frame moves through the world.
    pub motion: &'a dyn RigidMotion,
    /// What counts as contact with this body; none: what the options of the query say.
    pub solid: Option<Solid>,
    /// The body is everything within this distance of its mesh; zero for the mesh itself.
    pub radius: f64,
}

impl<'a, B> Moving<'a, B> {
    /// A body that moves so.
    pub const fn new(body: &'a B, motion: &'a dyn RigidMotion) -> Self {
        Self { body, motion, solid: None, radius: 0.0 }
    }

    /// The same with this meaning of the body's mesh, whatever that of the other body is: what is inside a solid body is in
    /// contact, be it a solid or an open sheet; nothing is inside of a surface.
    ///
    /// ```
    /// use d2m_bvh::{MeshTree, Moving, QueryOptions, Solid, TriMesh, Window, time_of_contact};
    /// use d2m_motion::ConstantTwist;
    /// use glam::DVec3;
    /// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    /// let solid = MeshTree::new(TriMesh::try_new(vertices.clone(), faces)?);
    /// // One small triangle inside of it.
    /// let inside = vertices[1..].iter().map(|p| *p * 0.1 + 0.1).collect();
    /// let sheet = MeshTree::new(TriMesh::try_new(inside, vec![[0, 1, 2]])?);
    /// let rest = ConstantTwist::REST;
    /// let [a, b] = [Moving::new(&solid, &rest), Moving::new(&sheet, &rest).with_solid(Solid::Surface)];
    /// let options = QueryOptions::default();
    /// assert!(time_of_contact(a, b, Window::UNIT, &options)?.contact().is_some());
    /// let hollow = a.with_solid(Solid::Surface);
    /// assert!(time_of_contact(hollow, b, Window::UNIT, &options)?.is_separated());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn with_solid(self, solid: Solid) -> Self {
        Self { solid: Some(solid), ..self }
    }

    /// The same with a radius: the body is everything within `radius` of its mesh (and of what a solid mesh holds). A point with a radius is
    /// a sphere, a segment a capsule, a box a rounded box: exact, without a tessellation. Witness points are on the rounded surfaces. The
    /// reference method (`d2m-paper`) knows no radius.
    ///
    /// ```
    /// use d2m_bvh::{MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact};
    /// use d2m_motion::ConstantTwist;
    /// use glam::DVec3;
    /// let point = MeshTree::new(TriMesh::point(DVec3::ZERO)?);
    /// let capsule = MeshTree::new(TriMesh::segment(-DVec3::Y, DVec3::Y)?);
    /// let falling = ConstantTwist::REST.with_position(DVec3::X * 2.0).with_linear_velocity(DVec3::X * -4.0);
    /// let ball = Moving::new(&point, &falling).with_radius(0.25);
    /// let post = Moving::new(&capsule, &ConstantTwist::REST).with_radius(0.75);
    /// let answer = time_of_contact(ball, post, Window::UNIT, &QueryOptions::default())?;
    /// let contact = answer.contact().expect("they meet");
    /// assert!(contact.time_lo <= 0.25 && contact.time_lo > 0.25 - 1e-9);
    /// assert!((contact.point_b - DVec3::X * 0.75).length() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// What counts as contact with this body in a query with these options.
    pub fn solid_in(&self, options: &QueryOptions) -> Solid {
        self.solid.unwrap_or(options.solid)
    }
}

impl<'a> Moving<'a> {
    /// All that matters of the body where constant twists are fitted to its motion.
    pub(crate) fn ball(self) -> MovingBall<'a> {
        MovingBall { motion: self.motion, center: self.body.center(), radius: self.body.radius() }
    }
}

/// These triangles of two bodies.
pub(crate) fn triangles_of<'a>(bodies: &[Moving<'a>; 2], triangles: [u32; 2]) -> [MovingTriangle<'a>; 2] {
    [0, 1].map(|k| {
        let Moving { body, motion, .. } = bodies[k];
        MovingTriangle { corners: body.mesh().corners(triangles[k] as usize), motion }
    })
}

impl<B> Clone for Moving<'_, B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<B> Copy for Moving<'_, B> {}

impl<B> core::fmt::Debug for Moving<'_, B> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Moving").field("motion", &self.motion.constant_twist()).finish_non_exhaustive()
    }
}
