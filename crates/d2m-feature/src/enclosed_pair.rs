//! Two bodies of any C² motion over a window of time: the tests of [`PairMotion`](crate::PairMotion) through what the
//! motions enclose of themselves.
use crate::contact::{ContactDetails, FirstContact};
use crate::details;
use crate::edge_edge::EdgeEdgeTest;
use crate::options::ContactOptions;
use crate::path::{EnclosedMotions, EnclosedPath, Extent, FeaturePath};
use crate::point_triangle::{PointTriangleTest, TrianglePlanes};
use crate::rigid_query::answer_in;
use crate::rounding::{DOWN, UP, length_up};
use crate::sphere::Sphere;
use crate::sphere_sphere::SphereSphereTest;
use d2m_motion::RigidMotion;
use d2m_root::Piece;
use glam::DVec3;

/// Two motions of any kind over a window, with what all features of the two bodies share.
///
/// Every time that a query looks at costs the states of both motions there ([`RigidMotion::enclose_state`]) and their
/// twist rates around it; nothing else of a motion is asked. The promises are those of
/// [`PairMotion`](crate::PairMotion), as long as the enclosures keep theirs. Two motions of constant twist are better
/// asked there: 1.2 to 2 times as fast, and with extended precision far from the centre of rotation.
///
/// ```
/// use d2m_feature::{ContactOptions, EnclosedPairMotion, FirstContact};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let pair = EnclosedPairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let FirstContact::Contact(contact) = pair.point_triangle(DVec3::ZERO, &floor, &ContactOptions::new()) else {
///     panic!("the point falls onto the floor");
/// };
/// assert!(contact.lo <= 0.5 && 0.5 <= contact.hi && contact.hi - contact.lo < 1e-12);
/// ```
pub struct EnclosedPairMotion<'a> {
    forward: EnclosedMotions<'a>,
    backward: EnclosedMotions<'a>,
}

impl<'a> EnclosedPairMotion<'a> {
    /// Motion of body A and of body B over `[t0, t1]`.
    ///
    /// # Panics
    /// If a time is not finite or `t0 > t1`.
    pub fn new(a: &'a dyn RigidMotion, b: &'a dyn RigidMotion, t0: f64, t1: f64) -> Self {
        assert!(t0 <= t1 && t0.is_finite() && t1.is_finite(), "window [{t0}, {t1}]");
        let window = Piece { lo: t0, hi: t1 };
        Self { forward: EnclosedMotions::new(a, b, window), backward: EnclosedMotions::new(b, a, window) }
    }

    /// First contact of a point of A with a triangle of B (body frames).
    pub fn point_triangle(
        &self,
        point: DVec3,
        triangle: &[DVec3; 3],
        options: &ContactOptions,
    ) -> FirstContact {
        point_triangle(&self.forward, point, triangle, options)
    }

    /// First contact of a triangle of A with a point of B.
    pub fn triangle_point(
        &self,
        triangle: &[DVec3; 3],
        point: DVec3,
        options: &ContactOptions,
    ) -> FirstContact {
        point_triangle(&self.backward, point, triangle, options)
    }

    /// First contact of an edge of A with an edge of B.
    pub fn edge_edge(
        &self,
        edge_a: [DVec3; 2],
        edge_b: [DVec3; 2],
        options: &ContactOptions,
    ) -> FirstContact {
        // Seen from the slower body the bounds are smaller.
        if self.forward.turn_b() <= self.backward.turn_b() {
            edge_edge(&self.forward, edge_a, edge_b, options)
        } else {
            edge_edge(&self.backward, edge_b, edge_a, options)
        }
    }

    /// First contact of a ball of A (centre, radius) with a ball of B.
    pub fn sphere_sphere(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        options: &ContactOptions,
    ) -> FirstContact {
        let (sphere_a, sphere_b) = (sphere_a.into(), sphere_b.into());
        let motions = &self.forward;
        let sum = sphere_a.radius.max(0.0) + sphere_b.radius.max(0.0);
        let radii = (sum * DOWN, sum * UP);
        let separation = options.separation();
        let extent = Extent::of(sphere_b.center, radii.1, motions);
        let path = EnclosedPath::new(motions, [sphere_a.center; 2], extent, separation);
        let tolerance = options.wanted_tolerance(sum, extent.from_origin).max(4.0 * path.rounding());
        let part = path.window();
        let mut test =
            SphereSphereTest { path, center: sphere_b.center, radii, tolerance, separation, size: sum };
        answer_in(&mut test, part, motions.window().lo, options)
    }

    /// Where and how a point of A and a triangle of B touch at a time (the `lo` of a bracket).
    pub fn point_triangle_details(&self, point: DVec3, triangle: &[DVec3; 3], time: f64) -> ContactDetails {
        details::point_triangle(self.forward.a, self.forward.b, point, triangle, time)
    }

    /// Where and how a triangle of A and a point of B touch at a time.
    pub fn triangle_point_details(&self, triangle: &[DVec3; 3], point: DVec3, time: f64) -> ContactDetails {
        details::point_triangle(self.forward.b, self.forward.a, point, triangle, time).reversed()
    }

    /// Where and how an edge of A and an edge of B touch at a time.
    pub fn edge_edge_details(&self, edge_a: [DVec3; 2], edge_b: [DVec3; 2], time: f64) -> ContactDetails {
        details::edge_edge(self.forward.a, self.forward.b, edge_a, edge_b, time)
    }

    /// Where and how two balls (centre, radius) touch at a time.
    pub fn sphere_sphere_details(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        time: f64,
    ) -> ContactDetails {
        details::sphere_sphere(self.forward.a, self.forward.b, sphere_a.into(), sphere_b.into(), time)
    }
}

fn point_triangle(
    motions: &EnclosedMotions<'_>,
    point: DVec3,
    triangle: &[DVec3; 3],
    options: &ContactOptions,
) -> FirstContact {
    let separation = options.separation();
    let planes = TrianglePlanes::new(*triangle);
    let extent = Extent::of(planes.center, planes.radius, motions);
    let extent = Extent { from_origin: planes.extent, ..extent };
    let path = EnclosedPath::new(motions, [point; 2], extent, separation);
    let tolerance = options.wanted_tolerance(planes.size, planes.extent).max(4.0 * path.rounding());
    let part = path.window();
    let mut test = PointTriangleTest::new(path, &planes, tolerance, separation);
    answer_in(&mut test, part, motions.window().lo, options)
}

fn edge_edge(
    motions: &EnclosedMotions<'_>,
    edge_a: [DVec3; 2],
    edge_b: [DVec3; 2],
    options: &ContactOptions,
) -> FirstContact {
    let separation = options.separation();
    let (middle, half) = ((edge_b[0] + edge_b[1]) * 0.5, (edge_b[1] - edge_b[0]) * 0.5);
    let half_a = (edge_a[1] - edge_a[0]) * 0.5;
    let extent = Extent::of(middle, length_up(half), motions);
    let path = EnclosedPath::new(motions, edge_a, extent, separation);
    let (rounding, part) = (4.0 * path.rounding(), path.window());
    let mut test = EdgeEdgeTest::new(path, middle, half, half_a, separation);
    let (length_a, length_b) = test.half_lengths;
    let reach = extent.from_origin + length_a;
    test.tolerance = options.wanted_tolerance(2.0 * length_a.max(length_b), reach).max(rounding);
    answer_in(&mut test, part, motions.window().lo, options)
}
