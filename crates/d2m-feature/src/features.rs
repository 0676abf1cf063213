//! A pair of features, one of each body.
use crate::sphere::Sphere;
use crate::units::Units;
use glam::DVec3;

/// A feature of A and one of B, each in the frame of its body.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Features {
    PointTriangle(DVec3, [DVec3; 3]),
    TrianglePoint([DVec3; 3], DVec3),
    Edges([DVec3; 2], [DVec3; 2]),
    Spheres(Sphere, Sphere),
}

impl Features {
    /// The largest magnitude of a number that they are given by.
    #[inline(always)]
    pub(crate) fn size(&self) -> f64 {
        match self {
            Self::PointTriangle(point, triangle) | Self::TrianglePoint(triangle, point) => {
                largest(&[*point]).max(largest(triangle))
            }
            Self::Edges(a, b) => largest(a).max(largest(b)),
            Self::Spheres(a, b) => largest(&[a.center, b.center]).max(a.radius.max(b.radius)),
        }
    }

    /// The same in other units; negative radii become zero.
    #[inline(always)]
    pub(crate) fn in_units(&self, units: &Units) -> Self {
        let sphere =
            |s: Sphere| Sphere { center: units.point(s.center), radius: units.length(s.radius.max(0.0)) };
        match *self {
            Self::PointTriangle(point, triangle) => {
                Self::PointTriangle(units.point(point), units.points(triangle))
            }
            Self::TrianglePoint(triangle, point) => {
                Self::TrianglePoint(units.points(triangle), units.point(point))
            }
            Self::Edges(a, b) => Self::Edges(units.points(a), units.points(b)),
            Self::Spheres(a, b) => Self::Spheres(sphere(a), sphere(b)),
        }
    }
}

/// The largest magnitude of a coordinate.
#[inline(always)]
pub(crate) fn largest(points: &[DVec3]) -> f64 {
    let mut most = 0.0;
    for p in points {
        for x in [p.x.abs(), p.y.abs(), p.z.abs()] {
            // (What is not a number is not counted: it excludes nothing later.)
            most = if x > most { x } else { most };
        }
    }
    most
}
