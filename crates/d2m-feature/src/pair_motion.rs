//! Two moving bodies over a window of time: query here for the first contact of a pair of features.
use crate::contact::{ContactDetails, FirstContact};
use crate::details;
use crate::enclosed_pair::EnclosedPair;
use crate::features::{Features, largest};
use crate::motion_in_units::MotionInUnits;
use crate::options::ContactOptions;
use crate::sphere::Sphere;
use crate::twist_pair::{InUnits, TwistPair};
use crate::units::Units;
use d2m_motion::RigidMotion;
use glam::DVec3;
use std::fmt;

/// Two motions over a window `[t0, t1]`, with what all features of the two bodies share.
///
/// Every query promises: no contact before the `lo` that it returns, and none at all when it returns
/// [`FirstContact::Clear`] – in floating point, for every finite input, as long as the motions keep their promises.
/// Geometry is given in body frames.
///
/// Two constant twists ([`RigidMotion::constant_twist`]) are evaluated in closed form, and with extended precision far from
/// their reference points. Of other motions each evaluation encloses the states of both ([`RigidMotion::enclose_state`]) and their
/// twist rates: 1.2 to 2 times as long, 3 to 6 times with nothing but interval enclosures. A window over joints
/// ([`RigidMotion::smooth_until`]) is searched piece by piece, all of them with one budget; outside of the domain of a motion
/// the answer is [`FirstContact::Undecided`].
///
/// The numbers of a query are multiplied by powers of two that bring lengths and times near one: answers are the same for
/// every exact scaling of lengths or times, up to that scaling. Where quantities of one query differ by more than 2²⁰⁰ the
/// answer may be [`FirstContact::Undecided`] from the start.
///
/// ```
/// use d2m_feature::{ContactOptions, FirstContact, PairMotion};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
/// let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let FirstContact::Contact(contact) = pair.point_triangle(DVec3::ZERO, &floor, &ContactOptions::new()) else {
///     panic!("the point falls onto the floor");
/// };
/// assert!(contact.lo <= 0.5 && 0.5 <= contact.hi && contact.hi - contact.lo < 1e-12);
/// ```
#[derive(Clone)]
pub struct PairMotion<'a> {
    motions: [&'a dyn RigidMotion; 2],
    start: f64,
    source: Source<'a>,
}

/// Where jets of features come from.
#[derive(Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "the usual case is large, and an allocation costs more than its move"
)]
enum Source<'a> {
    /// Closed form.
    Twists(TwistPair),
    /// What the motions enclose of themselves: in a box, because it is larger still.
    Enclosed(Box<EnclosedPair<'a>>),
    /// A motion is not defined over the window.
    Outside,
}

/// A triangle of B prepared for many points of A over one window ([`PairMotion::place_triangle`]).
///
/// ```
/// use d2m_feature::{ContactOptions, PairMotion};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// // A point falls by 2 from a height of 1.
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z * -2.0);
/// let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let placed = pair.place_triangle(&floor);
/// for x in [0.0, 0.1, 0.2] {
///     let point = DVec3::X * x;
///     let options = ContactOptions::new();
///     assert_eq!(pair.point_placed(point, &placed, &options), pair.point_triangle(point, &floor, &options));
/// }
/// ```
#[derive(Debug, Clone)]
pub struct PlacedTriangle {
    /// Body frame, as given.
    vertices: [DVec3; 3],
    size: f64,
    /// In the units of the pair that placed it, if it has a closed form and these serve the triangle.
    placed: Option<InUnits>,
}

impl<'a> PairMotion<'a> {
    /// Motion of body A and of body B over `[t0, t1]`.
    ///
    /// # Panics
    /// If a time is not finite or `t0 > t1`.
    pub fn new(a: &'a dyn RigidMotion, b: &'a dyn RigidMotion, t0: f64, t1: f64) -> Self {
        assert!(t0 <= t1 && t0.is_finite() && t1.is_finite(), "window [{t0}, {t1}]");
        let is_defined = [a, b].into_iter().all(|motion| {
            let domain = motion.domain();
            domain.contains(t0) && domain.contains(t1)
        });
        let source = match (a.constant_twist(), b.constant_twist()) {
            _ if !is_defined => Source::Outside,
            (Some(a), Some(b)) => Source::Twists(TwistPair::new(&[a, b], t0, t1)),
            _ => Source::Enclosed(Box::new(EnclosedPair::new([a, b], t0, t1))),
        };
        Self { motions: [a, b], start: t0, source }
    }

    /// The motions of A and B.
    pub const fn motions(&self) -> [&'a dyn RigidMotion; 2] {
        self.motions
    }

    /// Prepares a triangle of B (body frame) for [`PairMotion::point_placed`]: that saves time between constant twists, and changes
    /// no answer.
    pub fn place_triangle(&self, triangle: &[DVec3; 3]) -> PlacedTriangle {
        let size = largest(triangle);
        let placed = match &self.source {
            Source::Twists(pair) => pair.place(triangle, size),
            Source::Enclosed(_) | Source::Outside => None,
        };
        PlacedTriangle { vertices: *triangle, size, placed }
    }

    /// First contact of a point of A with a triangle of B.
    pub fn point_triangle(
        &self,
        point: DVec3,
        triangle: &[DVec3; 3],
        options: &ContactOptions,
    ) -> FirstContact {
        self.first_contact(&Features::PointTriangle(point, *triangle), options)
    }

    /// First contact of a triangle of A with a point of B.
    pub fn triangle_point(
        &self,
        triangle: &[DVec3; 3],
        point: DVec3,
        options: &ContactOptions,
    ) -> FirstContact {
        self.first_contact(&Features::TrianglePoint(*triangle, point), options)
    }

    /// First contact of a point of A with a triangle of B that this pair has prepared.
    pub fn point_placed(
        &self,
        point: DVec3,
        triangle: &PlacedTriangle,
        options: &ContactOptions,
    ) -> FirstContact {
        if let (Source::Twists(pair), Some(placed)) = (&self.source, &triangle.placed)
            && let size = largest(&[point]).max(triangle.size)
            && let Some(answer) = pair.point_placed(point, placed, size, options)
        {
            return answer;
        }
        self.point_triangle(point, &triangle.vertices, options)
    }

    /// First contact of an edge of A with an edge of B.
    pub fn edge_edge(
        &self,
        edge_a: [DVec3; 2],
        edge_b: [DVec3; 2],
        options: &ContactOptions,
    ) -> FirstContact {
        self.first_contact(&Features::Edges(edge_a, edge_b), options)
    }

    /// First contact of a solid sphere of A with one of B.
    pub fn sphere_sphere(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        options: &ContactOptions,
    ) -> FirstContact {
        self.first_contact(&Features::Spheres(sphere_a.into(), sphere_b.into()), options)
    }

    /// Where and how a point of A and a triangle of B touch at a time (the `lo` of a bracket).
    pub fn point_triangle_details(&self, point: DVec3, triangle: &[DVec3; 3], time: f64) -> ContactDetails {
        self.details(&Features::PointTriangle(point, *triangle), time)
    }

    /// Where and how a triangle of A and a point of B touch at a time.
    pub fn triangle_point_details(&self, triangle: &[DVec3; 3], point: DVec3, time: f64) -> ContactDetails {
        self.details(&Features::TrianglePoint(*triangle, point), time)
    }

    /// Where and how an edge of A and an edge of B touch at a time.
    pub fn edge_edge_details(&self, edge_a: [DVec3; 2], edge_b: [DVec3; 2], time: f64) -> ContactDetails {
        self.details(&Features::Edges(edge_a, edge_b), time)
    }

    /// Where and how two spheres touch at a time.
    pub fn sphere_sphere_details(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        time: f64,
    ) -> ContactDetails {
        self.details(&Features::Spheres(sphere_a.into(), sphere_b.into()), time)
    }

    #[inline(always)]
    fn first_contact(&self, features: &Features, options: &ContactOptions) -> FirstContact {
        match &self.source {
            Source::Twists(pair) => pair.first_contact(features, options),
            Source::Enclosed(pair) => pair.first_contact(features, options),
            Source::Outside => FirstContact::Undecided { clear_until: self.start },
        }
    }

    fn details(&self, features: &Features, time: f64) -> ContactDetails {
        let units = match &self.source {
            Source::Twists(pair) => *pair.units(),
            Source::Enclosed(pair) => *pair.units(),
            Source::Outside => Units::NONE,
        };
        let size = features.size();
        let units = if units.serve(size) { units } else { units.with_length_of(size) };
        let [a, b] = self.motions.map(|motion| MotionInUnits::try_new(motion, &units, self.start, None));
        let (Some(a), Some(b)) = (a, b) else {
            // Nothing better than the numbers as they are.
            return details::of(features, self.motions, time);
        };
        let there = details::of(&features.in_units(&units), [&a, &b], units.time(time));
        ContactDetails {
            time,
            point_a: units.point_back(there.point_a),
            point_b: units.point_back(there.point_b),
            closing_speed: units.speed_back(there.closing_speed),
            ..there
        }
    }
}

impl fmt::Debug for PairMotion<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("PairMotion");
        match &self.source {
            Source::Twists(pair) => fields.field("twists", pair).finish(),
            Source::Enclosed(_) | Source::Outside => {
                fields.field("start", &self.start).finish_non_exhaustive()
            }
        }
    }
}
