//! Two bodies of constant twist over a window of time: query here for the first contact of a pair of features.
use crate::contact::{ContactBracket, ContactDetails, FirstContact};
use crate::details;
use crate::options::ContactOptions;
use crate::path::FramedMotion;
use crate::point_triangle::TrianglePlanes;
use crate::rigid_query;
use crate::sphere::Sphere;
use crate::units::Units;
use d2m_lanes::power_of_two;
use d2m_motion::{ConstantTwist, RelativeMotion};
use glam::DVec3;
use std::sync::OnceLock;

/// Two motions of constant twist over a window `[t0, t1]`, with what all features of the two bodies share.
///
/// Every query promises: no contact before the `lo` that it returns, and none at all when it returns
/// [`FirstContact::Clear`] – in floating point, for every finite input. Geometry is given in body frames.
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
#[derive(Debug, Clone)]
pub struct PairMotion {
    motions: [ConstantTwist; 2],
    start: f64,
    end: f64,
    units: Units,
    sides: Option<Sides>,
}

/// The relative motion seen from either body, in the units of the pair.
#[derive(Debug, Clone)]
struct Sides {
    /// A seen from B.
    forward: FramedMotion,
    /// B seen from A, once that is needed.
    backward: OnceLock<FramedMotion>,
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
    /// In the units of the pair that placed it, if these serve it.
    placed: Option<InUnits>,
}

/// A triangle in the units of a pair.
#[derive(Debug, Clone)]
struct InUnits {
    /// Body frame.
    vertices: [DVec3; 3],
    /// In the epoch frame.
    planes: TrianglePlanes,
}

/// How many times the size of the features the relative motion may reach in their units: beyond it doubles say nothing
/// about a contact, and products of four lengths would overflow.
const LARGEST_REACH: f64 = power_of_two(200);
/// The size of features that are too small for the units of the motion, in these.
const SMALL: f64 = power_of_two(-200);

impl PairMotion {
    /// Motion of body A and of body B over `[t0, t1]`.
    ///
    /// # Panics
    /// If a time is not finite or `t0 > t1`.
    pub fn new(a: &ConstantTwist, b: &ConstantTwist, t0: f64, t1: f64) -> Self {
        assert!(t0 <= t1 && t0.is_finite() && t1.is_finite(), "window [{t0}, {t1}]");
        let motions = [*a, *b];
        Self::in_units(&motions, t0, t1, Units::of_motions(&motions, t0, t1))
    }

    fn in_units(motions: &[ConstantTwist; 2], start: f64, end: f64, units: Units) -> Self {
        let (from, to) = (units.time(start), units.time(end));
        let [a, b] = motions;
        let sides = match (units.try_motion(a, start), units.try_motion(b, start)) {
            (Some(a), Some(b)) if from.is_finite() && to.is_finite() => {
                let forward = FramedMotion::new(RelativeMotion::new(&a, &b, from, to));
                Some(Sides { forward, backward: OnceLock::new() })
            }
            _ => None,
        };
        Self { motions: *motions, start, end, units, sides }
    }

    /// The motions of A and B.
    pub const fn motions(&self) -> &[ConstantTwist; 2] {
        &self.motions
    }

    /// Prepares a triangle of B (body frame) for [`PairMotion::point_placed`].
    pub fn place_triangle(&self, triangle: &[DVec3; 3]) -> PlacedTriangle {
        let size = largest(triangle);
        let placed = match &self.sides {
            Some(sides) if self.units.serve(size) => {
                let vertices = self.units.points(*triangle);
                Some(InUnits { vertices, planes: rigid_query::place(&sides.forward, &vertices) })
            }
            _ => None,
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
        let size = largest(&[point]).max(largest(triangle));
        self.answer(size, options, |sides, units, options| {
            let (point, triangle) = (units.point(point), units.points(*triangle));
            rigid_query::point_triangle(&sides.forward, point, &triangle, options)
        })
    }

    /// First contact of a triangle of A with a point of B.
    pub fn triangle_point(
        &self,
        triangle: &[DVec3; 3],
        point: DVec3,
        options: &ContactOptions,
    ) -> FirstContact {
        let size = largest(&[point]).max(largest(triangle));
        self.answer(size, options, |sides, units, options| {
            let (point, triangle) = (units.point(point), units.points(*triangle));
            rigid_query::point_triangle(sides.backward(), point, &triangle, options)
        })
    }

    /// First contact of a point of A with a triangle of B that this pair has prepared.
    pub fn point_placed(
        &self,
        point: DVec3,
        triangle: &PlacedTriangle,
        options: &ContactOptions,
    ) -> FirstContact {
        let size = largest(&[point]).max(triangle.size);
        if let (Some(InUnits { vertices, planes }), Some(sides)) = (&triangle.placed, &self.sides)
            && self.units.serve(size.max(options.separation()))
        {
            let units = &self.units;
            let (point, options) = (units.point(point), options.in_units(units));
            return self.back(rigid_query::point_placed(&sides.forward, point, vertices, planes, &options));
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
        let size = largest(&edge_a).max(largest(&edge_b));
        self.answer(size, options, |sides, units, options| {
            let (edge_a, edge_b) = (units.points(edge_a), units.points(edge_b));
            // Seen from the slower body the bounds are smaller (8–16 % fewer evaluations).
            if sides.forward.motion.speed_b() <= sides.forward.motion.speed_a() {
                rigid_query::edge_edge(&sides.forward, edge_a, edge_b, options)
            } else {
                rigid_query::edge_edge(sides.backward(), edge_b, edge_a, options)
            }
        })
    }

    /// First contact of a solid sphere of A with one of B.
    pub fn sphere_sphere(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        options: &ContactOptions,
    ) -> FirstContact {
        let (sphere_a, sphere_b) = (sphere_a.into(), sphere_b.into());
        let size = largest(&[sphere_a.center, sphere_b.center]).max(sphere_a.radius.max(sphere_b.radius));
        self.answer(size, options, |sides, units, options| {
            let centers = [units.point(sphere_a.center), units.point(sphere_b.center)];
            let radii = units.length(sphere_a.radius.max(0.0)) + units.length(sphere_b.radius.max(0.0));
            rigid_query::sphere_sphere(&sides.forward, centers, radii, options)
        })
    }

    /// Where and how a point of A and a triangle of B touch at a time (the `lo` of a bracket).
    pub fn point_triangle_details(&self, point: DVec3, triangle: &[DVec3; 3], time: f64) -> ContactDetails {
        let size = largest(&[point]).max(largest(triangle));
        self.details(size, time, |[a, b], units, time| {
            details::point_triangle(a, b, units.point(point), &units.points(*triangle), time)
        })
    }

    /// Where and how a triangle of A and a point of B touch at a time.
    pub fn triangle_point_details(&self, triangle: &[DVec3; 3], point: DVec3, time: f64) -> ContactDetails {
        let size = largest(&[point]).max(largest(triangle));
        self.details(size, time, |[a, b], units, time| {
            let triangle = units.points(*triangle);
            details::point_triangle(b, a, units.point(point), &triangle, time).reversed()
        })
    }

    /// Where and how an edge of A and an edge of B touch at a time.
    pub fn edge_edge_details(&self, edge_a: [DVec3; 2], edge_b: [DVec3; 2], time: f64) -> ContactDetails {
        let size = largest(&edge_a).max(largest(&edge_b));
        self.details(size, time, |[a, b], units, time| {
            let (edge_a, edge_b) = (units.points(edge_a), units.points(edge_b));
            details::edge_edge(a, b, edge_a, edge_b, time)
        })
    }

    /// Where and how two spheres touch at a time.
    pub fn sphere_sphere_details(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        time: f64,
    ) -> ContactDetails {
        let (sphere_a, sphere_b) = (sphere_a.into(), sphere_b.into());
        let size = largest(&[sphere_a.center, sphere_b.center]).max(sphere_a.radius.max(sphere_b.radius));
        self.details(size, time, |[a, b], units, time| {
            let sphere = |s: Sphere| Sphere { center: units.point(s.center), radius: units.length(s.radius) };
            details::sphere_sphere(a, b, sphere(sphere_a), sphere(sphere_b), time)
        })
    }

    /// The answer of a query in units that serve features of this size.
    #[inline(always)]
    fn answer(
        &self,
        size: f64,
        options: &ContactOptions,
        query: impl Fn(&Sides, &Units, &ContactOptions) -> FirstContact,
    ) -> FirstContact {
        let size = size.max(options.separation());
        match &self.sides {
            Some(sides) if self.units.serve(size) => {
                self.back(query(sides, &self.units, &options.in_units(&self.units)))
            }
            _ => self.answer_in_other_units(size, options, &query),
        }
    }

    #[cold]
    fn answer_in_other_units(
        &self,
        size: f64,
        options: &ContactOptions,
        query: &dyn Fn(&Sides, &Units, &ContactOptions) -> FirstContact,
    ) -> FirstContact {
        let undecided = FirstContact::Undecided { clear_until: self.start };
        if !size.is_finite() {
            return undecided;
        }
        if let Some(sides) = &self.sides
            && self.units.dwarf(size)
            && sides.never_near(&self.units, &self.motions)
        {
            return FirstContact::Clear;
        }
        let other = Self::in_units(&self.motions, self.start, self.end, self.units.with_length_of(size));
        match &other.sides {
            // Also NaN is left undecided.
            Some(sides) if sides.forward.motion.bound_reach(0.0) <= LARGEST_REACH => {
                other.back(query(sides, &other.units, &options.in_units(&other.units)))
            }
            _ => undecided,
        }
    }

    /// An answer in the units of the input, its times inside the window.
    #[inline(always)]
    fn back(&self, answer: FirstContact) -> FirstContact {
        let units = &self.units;
        match answer {
            FirstContact::Clear => FirstContact::Clear,
            FirstContact::Undecided { clear_until } => {
                FirstContact::Undecided { clear_until: units.time_down(clear_until).max(self.start) }
            }
            FirstContact::Contact(contact) => {
                let lo = units.time_down(contact.lo).max(self.start);
                let hi = units.time_up(contact.hi).min(self.end).max(lo);
                let (distance, tolerance) =
                    (units.length_up(contact.distance), units.length_up(contact.tolerance));
                FirstContact::Contact(ContactBracket { lo, hi, distance, tolerance, ..contact })
            }
        }
    }

    fn details(
        &self,
        size: f64,
        time: f64,
        describe: impl Fn([&ConstantTwist; 2], &Units, f64) -> ContactDetails,
    ) -> ContactDetails {
        let units = if self.units.serve(size) { self.units } else { self.units.with_length_of(size) };
        let [a, b] = &self.motions;
        let in_units = (units.try_motion(a, self.start), units.try_motion(b, self.start));
        let (Some(a), Some(b)) = in_units else {
            // Nothing better than the numbers as they are.
            return describe([a, b], &Units::NONE, time);
        };
        let there = describe([&a, &b], &units, units.time(time));
        ContactDetails {
            time,
            point_a: units.point_back(there.point_a),
            point_b: units.point_back(there.point_b),
            closing_speed: units.speed_back(there.closing_speed),
            ..there
        }
    }
}

impl Sides {
    #[inline]
    fn backward(&self) -> &FramedMotion {
        self.backward.get_or_init(|| FramedMotion::new(self.forward.motion.reversed()))
    }

    /// True if features that are too small for the units certainly never come near each other.
    fn never_near(&self, units: &Units, motions: &[ConstantTwist; 2]) -> bool {
        let at = largest(&[units.point(motions[0].at()), units.point(motions[1].at())]);
        // Each is within √3(size + at) of its reference point, and the separation is at most the size; 2√3 < 4.
        self.forward.motion.times_within(4.0 * at + 8.0 * SMALL).is_none()
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
