//! A sphere of a body.
use glam::DVec3;

/// A solid sphere of a body: the points within `radius` of `center`, body frame.
///
/// ```
/// use d2m_feature::{ContactOptions, FirstContact, PairMotion, Sphere};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let rolling = ConstantTwist::REST.with_position(4.0 * DVec3::X).with_linear_velocity(-4.0 * DVec3::X);
/// let sphere = Sphere { center: DVec3::ZERO, radius: 1.0 };
/// let pair = PairMotion::new(&rolling, &ConstantTwist::REST, 0.0, 1.0);
/// let FirstContact::Contact(contact) = pair.sphere_sphere(sphere, sphere, &ContactOptions::new()) else { panic!() };
/// assert!(contact.lo <= 0.5 && 0.5 <= contact.hi && contact.hi - contact.lo < 1e-9);
/// assert_eq!(Sphere::from((DVec3::ZERO, 1.0)), sphere);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Center, body frame.
    pub center: DVec3,
    /// Radius (≥ 0; a negative radius counts as 0).
    pub radius: f64,
}

/// From center and radius.
impl From<(DVec3, f64)> for Sphere {
    fn from((center, radius): (DVec3, f64)) -> Self {
        Self { center, radius }
    }
}
