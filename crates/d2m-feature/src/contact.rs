//! Answers of a first-contact query.
use d2m_root::Evidence;
use glam::DVec3;

/// First contact of two moving features over a window of time.
///
/// ```
/// use d2m_feature::{ContactOptions, FirstContact, PairMotion};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// // A point falls by 2 from a height of 1.
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z * -2.0);
/// let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// match pair.point_triangle(DVec3::ZERO, &floor, &ContactOptions::new()) {
///     FirstContact::Clear => panic!("proven free, which would be wrong here"),
///     FirstContact::Contact(contact) => assert!(contact.lo <= 0.5 && 0.5 <= contact.hi),
///     FirstContact::Undecided { clear_until } => panic!("only with a limit; free until {clear_until}"),
/// }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum FirstContact {
    /// No contact anywhere in the window.
    Clear,
    /// The first contact lies in the bracket.
    Contact(ContactBracket),
    /// The limit of evaluations was reached, or the numbers do not allow an answer (rotations beyond 10⁹ rad in the window,
    /// quantities that differ by more than 2²⁰⁰, a clock too coarse to follow the features); no contact before `clear_until`.
    Undecided {
        /// No contact from the start of the window to here.
        clear_until: f64,
    },
}

/// A two-sided enclosure of the first contact.
///
/// Promise: no contact in `[t0, lo)`; and, as the evidence says, a true contact at some time of `[lo, hi]`
/// ([`Evidence::Crossing`]), or a time in it at which the distance is proven to be at most `tolerance` beyond the minimum
/// separation ([`Evidence::WithinTolerance`]; also for features that touch at the start, with `lo = hi = t0`).
///
/// ```
/// use d2m_feature::{ContactOptions, FirstContact, PairMotion};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// // A point falls by 2 from a height of 1.
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z * -2.0);
/// let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let FirstContact::Contact(contact) = pair.point_triangle(DVec3::ZERO, &floor, &ContactOptions::new())
///     else { panic!("it falls onto the triangle") };
/// assert!(contact.hi - contact.lo < 1e-9 && contact.distance <= contact.tolerance);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactBracket {
    /// No contact before this time of the window.
    pub lo: f64,
    /// Contact (or a distance within the tolerance) at some time up to this one.
    pub hi: f64,
    /// How the contact is known.
    pub evidence: Evidence,
    /// Proven upper bound of the distance (beyond the minimum separation) at some time of the bracket; 0 for a crossing,
    /// negative where spheres overlap.
    pub distance: f64,
    /// The tolerance δ that was used: the one of the options, unless rounding or the resolution of time hides such a
    /// distance. Then it is as large as they need.
    pub tolerance: f64,
}

/// Where and how two features touch. Plain floating point at one time: it describes, it proves nothing.
///
/// ```
/// use d2m_feature::PairMotion;
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// // A point falls by 2 from a height of 1.
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z * -2.0);
/// let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let details = pair.point_triangle_details(DVec3::ZERO, &floor, 0.25);
/// assert!((details.point_a - DVec3::Z * 0.5).length() < 1e-15 && details.point_b.length() < 1e-15);
/// assert!((details.normal - DVec3::NEG_Z).length() < 1e-15 && (details.closing_speed - 2.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactDetails {
    /// The time that it describes (the start of the bracket).
    pub time: f64,
    /// Closest point on A, world.
    pub point_a: DVec3,
    /// Closest point on B, world.
    pub point_b: DVec3,
    /// Unit vector from A to B, world. Where the features touch, the normal of the face or the common normal of the
    /// edges, on the side from which they approach; zero if neither exists.
    pub normal: DVec3,
    /// Weights of A's vertices at `point_a`: 1 for a vertex or sphere, 2 for an edge, 3 for a face; the rest are 0.
    pub barycentric_a: [f64; 3],
    /// Weights of B's vertices at `point_b`.
    pub barycentric_b: [f64; 3],
    /// Speed of approach along the normal; negative if the features separate.
    pub closing_speed: f64,
}

impl ContactDetails {
    /// The same contact with the bodies exchanged.
    pub(crate) fn reversed(self) -> Self {
        Self {
            point_a: self.point_b,
            point_b: self.point_a,
            normal: -self.normal,
            barycentric_a: self.barycentric_b,
            barycentric_b: self.barycentric_a,
            ..self
        }
    }
}
