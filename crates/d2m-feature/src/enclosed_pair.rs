//! Two bodies of any C² motion over a window of time: the tests of [`PairMotion`](crate::PairMotion) through what the
//! motions enclose of themselves.
use crate::contact::{ContactBracket, ContactDetails, FirstContact};
use crate::details;
use crate::edge_edge::EdgeEdgeTest;
use crate::motion_in_units::MotionInUnits;
use crate::options::ContactOptions;
use crate::pair_motion::largest;
use crate::path::{EnclosedMotions, EnclosedPath, Extent, FeaturePath};
use crate::point_triangle::{PointTriangleTest, TrianglePlanes};
use crate::rigid_query::{Answered, answer_in};
use crate::rounding::{DOWN, UP, length_up};
use crate::sphere::Sphere;
use crate::sphere_sphere::SphereSphereTest;
use crate::units::Units;
use d2m_lanes::power_of_two;
use d2m_motion::RigidMotion;
use d2m_root::Piece;
use glam::DVec3;

/// Two motions of any kind over a window, with what all features of the two bodies share.
///
/// Every time that a search evaluates costs the states of both motions there ([`RigidMotion::enclose_state`]) and their
/// twist rates around it. The promises are those of [`PairMotion`](crate::PairMotion), as long as the enclosures keep
/// theirs. A window over joints ([`RigidMotion::smooth_until`]) is searched piece by piece, all of them with one
/// budget; outside of the domain of a motion the answer is [`FirstContact::Undecided`]. Two motions of constant twist
/// are better queried as a `PairMotion`: 1.2 to 2 times as fast, and with extended precision far from the reference point.
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
    a: &'a dyn RigidMotion,
    b: &'a dyn RigidMotion,
    start: f64,
    end: f64,
    units: Units,
    first: Option<SmoothPiece<'a>>,
}

/// Both motions over a part of the window in which both are smooth, seen from either body.
struct SmoothPiece<'a> {
    /// A seen from B.
    forward: EnclosedMotions<'a>,
    /// B seen from A.
    backward: EnclosedMotions<'a>,
    /// The end of the part, in the units of the input.
    end: f64,
}

/// What an evaluation counts as: with nothing but interval enclosures it takes some eight times as long as in closed form.
const COST_OF_ENCLOSURES: u32 = 8;
/// Part of the features' length up to which enclosures may leave their distance unknown: beyond it a contact would say
/// little, and the answer is `Undecided`.
const WIDE: f64 = 1.0 / 1024.0;
/// Part of the distance of the bodies that counts as length there: for points, and for features far from their bodies.
const FAR_AWAY: f64 = 1e-6;
/// The size of features that are too small for the units of the motion, in these.
const SMALL: f64 = power_of_two(-200);

impl<'a> EnclosedPairMotion<'a> {
    /// Motion of body A and of body B over `[t0, t1]`.
    ///
    /// # Panics
    /// If a time is not finite or `t0 > t1`.
    pub fn new(a: &'a dyn RigidMotion, b: &'a dyn RigidMotion, t0: f64, t1: f64) -> Self {
        assert!(t0 <= t1 && t0.is_finite() && t1.is_finite(), "window [{t0}, {t1}]");
        let units = if let (Some(a), Some(b)) = (a.constant_twist(), b.constant_twist()) {
            Units::of_motions(&[a, b], t0, t1)
        } else {
            let middle = Piece { lo: t0, hi: t1 }.mid();
            Units::of_states(&[a.enclose_state(middle), b.enclose_state(middle)], t0, t1)
        };
        let mut pair = Self { a, b, start: t0, end: t1, units, first: None };
        pair.first = pair.try_piece(t0, &units);
        pair
    }

    /// Both motions from a time to the first joint of either; `None` if that cannot be expressed in these units, or where a
    /// motion is not defined.
    fn try_piece(&self, from: f64, units: &Units) -> Option<SmoothPiece<'a>> {
        let mut end = self.end;
        let mut joints = [None; 2];
        for (joint, motion) in joints.iter_mut().zip([self.a, self.b]) {
            let domain = motion.domain();
            if !(domain.contains(self.start) && domain.contains(self.end)) {
                return None;
            }
            *joint = motion.smooth_until(from);
            match *joint {
                Some(time) if time > from => end = end.min(time),
                // A joint that is not ahead is a fault of the motion.
                Some(_) => return None,
                None => {}
            }
        }
        let a = MotionInUnits::try_new(self.a, units, from, joints[0])?;
        let b = MotionInUnits::try_new(self.b, units, from, joints[1])?;
        let window = Piece { lo: units.time(from), hi: units.time(end) };
        (window.lo.is_finite() && window.hi.is_finite()).then(|| SmoothPiece {
            forward: EnclosedMotions::new(a, b, window),
            backward: EnclosedMotions::new(b, a, window),
            end,
        })
    }

    /// First contact of a point of A with a triangle of B (body frames).
    pub fn point_triangle(
        &self,
        point: DVec3,
        triangle: &[DVec3; 3],
        options: &ContactOptions,
    ) -> FirstContact {
        let size = largest(&[point]).max(largest(triangle));
        self.answer(size, options, &|piece, units, options| {
            let triangle = units.points(*triangle);
            point_triangle(&piece.forward, units.point(point), &triangle, options)
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
        self.answer(size, options, &|piece, units, options| {
            let triangle = units.points(*triangle);
            point_triangle(&piece.backward, units.point(point), &triangle, options)
        })
    }

    /// First contact of an edge of A with an edge of B.
    pub fn edge_edge(
        &self,
        edge_a: [DVec3; 2],
        edge_b: [DVec3; 2],
        options: &ContactOptions,
    ) -> FirstContact {
        let size = largest(&edge_a).max(largest(&edge_b));
        self.answer(size, options, &|piece, units, options| {
            let (edge_a, edge_b) = (units.points(edge_a), units.points(edge_b));
            // Seen from the slower body the bounds are smaller.
            if piece.forward.turn_b() <= piece.backward.turn_b() {
                edge_edge(&piece.forward, edge_a, edge_b, options)
            } else {
                edge_edge(&piece.backward, edge_b, edge_a, options)
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
        self.answer(size, options, &|piece, units, options| {
            let centers = [units.point(sphere_a.center), units.point(sphere_b.center)];
            let radii = units.length(sphere_a.radius.max(0.0)) + units.length(sphere_b.radius.max(0.0));
            sphere_sphere(&piece.forward, centers, radii, options)
        })
    }

    /// The answer of a query, smooth piece by smooth piece, in units that serve features of this size.
    fn answer(
        &self,
        size: f64,
        options: &ContactOptions,
        query: &dyn Fn(&SmoothPiece<'_>, &Units, &ContactOptions) -> Answered,
    ) -> FirstContact {
        let size = size.max(options.separation());
        let small = !self.units.serve(size) && self.units.dwarf(size);
        let units =
            if self.units.serve(size) || small { self.units } else { self.units.with_length_of(size) };
        let mut in_units = options.in_units(&units).at_cost(COST_OF_ENCLOSURES);
        let mut from = self.start;
        loop {
            let built;
            let piece = match &self.first {
                Some(first) if from == self.start && units == self.units => first,
                _ => match self.try_piece(from, &units) {
                    Some(piece) => {
                        built = piece;
                        &built
                    }
                    None => return FirstContact::Undecided { clear_until: from },
                },
            };
            let answer = if !small {
                let Answered { contact, evaluations } = query(piece, &units, &in_units);
                in_units.max_evaluations = in_units.max_evaluations.saturating_sub(evaluations);
                contact
            } else if piece.never_near() {
                FirstContact::Clear
            } else {
                return FirstContact::Undecided { clear_until: from };
            };
            match answer {
                FirstContact::Clear if piece.end >= self.end => return FirstContact::Clear,
                FirstContact::Clear => from = piece.end,
                FirstContact::Undecided { clear_until } => {
                    return FirstContact::Undecided { clear_until: units.time_down(clear_until).max(from) };
                }
                FirstContact::Contact(contact) => {
                    let lo = units.time_down(contact.lo).max(from);
                    let hi = units.time_up(contact.hi).min(self.end).max(lo);
                    let (distance, tolerance) =
                        (units.length_up(contact.distance), units.length_up(contact.tolerance));
                    return FirstContact::Contact(ContactBracket { lo, hi, distance, tolerance, ..contact });
                }
            }
        }
    }

    /// Where and how a point of A and a triangle of B touch at a time (the `lo` of a bracket).
    pub fn point_triangle_details(&self, point: DVec3, triangle: &[DVec3; 3], time: f64) -> ContactDetails {
        details::point_triangle(self.a, self.b, point, triangle, time)
    }

    /// Where and how a triangle of A and a point of B touch at a time.
    pub fn triangle_point_details(&self, triangle: &[DVec3; 3], point: DVec3, time: f64) -> ContactDetails {
        details::point_triangle(self.b, self.a, point, triangle, time).reversed()
    }

    /// Where and how an edge of A and an edge of B touch at a time.
    pub fn edge_edge_details(&self, edge_a: [DVec3; 2], edge_b: [DVec3; 2], time: f64) -> ContactDetails {
        details::edge_edge(self.a, self.b, edge_a, edge_b, time)
    }

    /// Where and how two spheres touch at a time.
    pub fn sphere_sphere_details(
        &self,
        sphere_a: impl Into<Sphere>,
        sphere_b: impl Into<Sphere>,
        time: f64,
    ) -> ContactDetails {
        details::sphere_sphere(self.a, self.b, sphere_a.into(), sphere_b.into(), time)
    }
}

impl SmoothPiece<'_> {
    /// True if features that are too small for the units certainly never come near each other.
    fn never_near(&self) -> bool {
        // Each is within √3(size + at) of its reference point, and the separation is at most the size; 2√3 < 4.
        let at = largest(&[self.forward.at_a(), self.forward.at_b()]);
        self.forward.times_within(4.0 * at + 8.0 * SMALL).is_none()
    }
}

/// The wanted tolerance, raised to four times what rounding and the widths of the enclosures at one time leave unknown;
/// `None` if these are too wide for an answer.
fn try_tolerance(
    wanted: f64,
    length: f64,
    path: &EnclosedPath<'_>,
    motions: &EnclosedMotions<'_>,
) -> Option<f64> {
    let unknown = 4.0 * path.rounding();
    let bearable = WIDE * (length + FAR_AWAY * motions.bound_distance());
    // Also NaN is too wide. An impossible contact costs no tolerance.
    (unknown <= wanted.max(bearable) || path.window().is_none()).then_some(wanted.max(unknown))
}

fn sphere_sphere(
    motions: &EnclosedMotions<'_>,
    centers: [DVec3; 2],
    size: f64,
    options: &ContactOptions,
) -> Answered {
    let radii = (size * DOWN, size * UP);
    let separation = options.separation();
    let extent = Extent::of(centers[1], radii.1, motions);
    let path = EnclosedPath::new(motions, [centers[0]; 2], extent, separation);
    let wanted = options.wanted_tolerance(size, extent.from_origin);
    let Some(tolerance) = try_tolerance(wanted, size, &path, motions) else {
        return Answered::at_once(FirstContact::Undecided { clear_until: motions.window().lo });
    };
    let part = path.window();
    let mut test = SphereSphereTest { path, center: centers[1], radii, tolerance, separation, size };
    answer_in(&mut test, part, motions.window().lo, options)
}

fn point_triangle(
    motions: &EnclosedMotions<'_>,
    point: DVec3,
    triangle: &[DVec3; 3],
    options: &ContactOptions,
) -> Answered {
    let separation = options.separation();
    let planes = TrianglePlanes::new(*triangle);
    let extent = Extent::of(planes.center, planes.radius, motions);
    let extent = Extent { from_origin: planes.extent, ..extent };
    let path = EnclosedPath::new(motions, [point; 2], extent, separation);
    let wanted = options.wanted_tolerance(planes.size, planes.extent);
    let Some(tolerance) = try_tolerance(wanted, planes.size, &path, motions) else {
        return Answered::at_once(FirstContact::Undecided { clear_until: motions.window().lo });
    };
    let part = path.window();
    let mut test = PointTriangleTest::new(path, &planes, tolerance, separation);
    answer_in(&mut test, part, motions.window().lo, options)
}

fn edge_edge(
    motions: &EnclosedMotions<'_>,
    edge_a: [DVec3; 2],
    edge_b: [DVec3; 2],
    options: &ContactOptions,
) -> Answered {
    let separation = options.separation();
    let (middle, half) = ((edge_b[0] + edge_b[1]) * 0.5, (edge_b[1] - edge_b[0]) * 0.5);
    let half_a = (edge_a[1] - edge_a[0]) * 0.5;
    let extent = Extent::of(middle, length_up(half), motions);
    let path = EnclosedPath::new(motions, edge_a, extent, separation);
    let part = path.window();
    let mut test = EdgeEdgeTest::new(path, middle, half, half_a, separation);
    let (length_a, length_b) = test.half_lengths;
    let (reach, length) = (extent.from_origin + length_a, 2.0 * length_a.max(length_b));
    let wanted = options.wanted_tolerance(length, reach);
    match try_tolerance(wanted, length, &test.path, motions) {
        Some(tolerance) => test.tolerance = tolerance,
        None => return Answered::at_once(FirstContact::Undecided { clear_until: motions.window().lo }),
    }
    answer_in(&mut test, part, motions.window().lo, options)
}
