use d2m_motion::OutsideDomain;
use thiserror::Error;

/// Bad input to a query. No query reports a hard case as an error, and none turns an error into "no contact".
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{DistanceOptions, Posed, QueryError, distance_within};
/// let rest = Posed::at_rest(&tree);
/// let refused = distance_within(rest, rest, &DistanceOptions::default().with_cutoff(-1.0));
/// assert_eq!(refused, Err(QueryError::BadMinSeparation { value: -1.0 }));
/// assert_eq!(refused.unwrap_err().to_string(), "min_separation -1.0 must be finite and not negative");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum QueryError {
    /// The time window is reversed, or an end or its length is not finite.
    #[error("time window [{start:?}, {end:?}] must be finite (its length too) and not reversed")]
    BadWindow {
        /// Requested first instant.
        start: f64,
        /// Requested last instant.
        end: f64,
    },
    /// The tolerance is not a finite positive number.
    #[error("tolerance {value:?} must be finite and positive")]
    BadTolerance {
        /// The refused value.
        value: f64,
    },
    /// The minimum separation is negative or not finite.
    #[error("min_separation {value:?} must be finite and not negative")]
    BadMinSeparation {
        /// The refused value.
        value: f64,
    },
    /// The radius of a body is negative or not finite.
    #[error("radius {value:?} of body {body} must be finite and not negative")]
    BadRadius {
        /// 0 for the first body, 1 for the second.
        body: usize,
        /// The refused value.
        value: f64,
    },
    /// The accuracy of a clearance is not a finite positive number.
    #[error("accuracy {value:?} must be finite and positive")]
    BadAccuracy {
        /// The refused value.
        value: f64,
    },
    /// The resolution of spans of time is not a finite positive number.
    #[error("resolution {value:?} must be finite and positive")]
    BadResolution {
        /// The refused value.
        value: f64,
    },
    /// The options say that the body is a filled solid, but its mesh does not close.
    #[error("body {body} is not watertight: use Solid::Surface")]
    NotWatertight {
        /// 0 for the first body, 1 for the second.
        body: usize,
    },
    /// The motion is not finite over the window, or leaves the range in which errors can be bounded: lengths and the
    /// reach of the query stay below 2¹⁰⁰⁰, the angle since the reference time below [`Self::MOST_ANGLE`]. A turn by less than 2⁻⁹⁰⁰ rad
    /// over the window must not have begun so long ago that it adds up to 2⁻⁶⁴ rad. A motion may not go so far or so
    /// fast that its rounding alone exceeds the bodies, what is between them at the start, and the tolerance of the options: from
    /// some 10¹³ times all of these in one window.
    #[error(
        "motion of body {body} is not finite over the window, or turns or goes too far for bounds on its rounding"
    )]
    BadMotion {
        /// 0 for the first body, 1 for the second.
        body: usize,
    },
    /// The window is not within the times that a motion covers.
    #[error("body {body}: {outside}")]
    OutsideMotion {
        /// 0 for the first body, 1 for the second.
        body: usize,
        /// The times of the motion and of the window.
        outside: OutsideDomain,
    },
    /// The pose is not finite, its quaternion is zero, or lengths exceed [`Self::LONGEST_AT_REST`].
    #[error(
        "pose of body {body} is not finite, has a zero quaternion or exceeds {:e}",
        Self::LONGEST_AT_REST
    )]
    BadPose {
        /// 0 for the first body, 1 for the second.
        body: usize,
    },
    /// The surfaces meet, or their distance is below rounding: they have no closest features.
    #[error(
        "triangle {triangle_a} of body 0 and triangle {triangle_b} of body 1 are not apart: no proximities"
    )]
    NotApart {
        /// Triangle of the first body.
        triangle_a: u32,
        /// Triangle of the second body.
        triangle_b: u32,
    },
}

impl QueryError {
    /// Most radians, 2⁴⁰, between the reference time of a motion and the window: poses are proven for less than 2⁵⁰, and
    /// sub-windows of a third of a radian are then long against the resolution of offsets.
    pub const MOST_ANGLE: f64 = 1_099_511_627_776.0;

    /// Longest length of poses and bodies at rest: squares and cubes of longer ones could overflow.
    pub const LONGEST_AT_REST: f64 = 1e100;
}
