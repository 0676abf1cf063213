//! Two bodies of any C² motion over a window: jets of what the motions enclose of themselves, piece by piece.
use crate::contact::FirstContact;
use crate::edge_edge::EdgeEdgeTest;
use crate::features::{Features, largest};
use crate::motion_in_units::MotionInUnits;
use crate::options::ContactOptions;
use crate::path::{EnclosedMotions, EnclosedPath, Extent, FeaturePath};
use crate::point_triangle::{PointTriangleTest, TrianglePlanes};
use crate::rigid_query::{Answered, answer_in};
use crate::rounding::{DOWN, UP, length_up};
use crate::sphere_sphere::SphereSphereTest;
use crate::units::{SMALL, Units};
use d2m_motion::RigidMotion;
use d2m_root::Piece;
use glam::DVec3;

/// Two motions of any kind over a window, with what all features of the two bodies share.
///
/// Every time that a search evaluates costs the states of both motions there ([`RigidMotion::enclose_state`]) and their
/// twist rates around it. A window over joints ([`RigidMotion::smooth_until`]) is searched piece by piece, all of them
/// with one budget.
#[derive(Clone)]
pub(crate) struct EnclosedPair<'a> {
    a: &'a dyn RigidMotion,
    b: &'a dyn RigidMotion,
    start: f64,
    end: f64,
    units: Units,
    /// From the start of the window; `None` where the motions cannot be expressed in the units.
    first: Option<SmoothPiece<'a>>,
}

/// Both motions over a part of the window in which both are smooth, seen from either body.
#[derive(Clone)]
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

impl<'a> EnclosedPair<'a> {
    /// In units of the two motions; both are defined over the window.
    pub(crate) fn new([a, b]: [&'a dyn RigidMotion; 2], start: f64, end: f64) -> Self {
        let middle = Piece { lo: start, hi: end }.mid();
        let units = Units::of_states(&[a.enclose_state(middle), b.enclose_state(middle)], 0.0, start, end);
        let mut pair = Self { a, b, start, end, units, first: None };
        pair.first = pair.try_piece(start, &units);
        pair
    }

    pub(crate) const fn units(&self) -> &Units {
        &self.units
    }

    /// Both motions from a time to the first joint of either; `None` if that cannot be expressed in these units.
    fn try_piece(&self, from: f64, units: &Units) -> Option<SmoothPiece<'a>> {
        let mut end = self.end;
        let mut joints = [None; 2];
        for (joint, motion) in joints.iter_mut().zip([self.a, self.b]) {
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

    /// The answer of a query, smooth piece by smooth piece, in units that serve these features.
    pub(crate) fn first_contact(&self, features: &Features, options: &ContactOptions) -> FirstContact {
        let size = features.size().max(options.separation());
        let small = !self.units.serve(size) && self.units.dwarf(size);
        let units =
            if self.units.serve(size) || small { self.units } else { self.units.with_length_of(size) };
        let mut in_units = options.in_units(&units).at_cost(COST_OF_ENCLOSURES);
        let features = features.in_units(&units);
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
                let Answered { contact, evaluations } = piece.first_contact(&features, &in_units);
                in_units.max_evaluations = in_units.max_evaluations.saturating_sub(evaluations);
                contact
            } else if piece.never_near() {
                FirstContact::Clear
            } else {
                return FirstContact::Undecided { clear_until: from };
            };
            match units.answer_back(answer, from, self.end) {
                FirstContact::Clear if piece.end < self.end => from = piece.end,
                answer => return answer,
            }
        }
    }
}

impl SmoothPiece<'_> {
    fn first_contact(&self, features: &Features, options: &ContactOptions) -> Answered {
        match features {
            Features::PointTriangle(point, triangle) => {
                point_triangle(&self.forward, *point, triangle, options)
            }
            Features::TrianglePoint(triangle, point) => {
                point_triangle(&self.backward, *point, triangle, options)
            }
            // Seen from the slower body the bounds are smaller.
            &Features::Edges(a, b) if self.forward.turn_b() <= self.backward.turn_b() => {
                edge_edge(&self.forward, a, b, options)
            }
            &Features::Edges(a, b) => edge_edge(&self.backward, b, a, options),
            Features::Spheres(a, b) => {
                sphere_sphere(&self.forward, [a.center, b.center], a.radius + b.radius, options)
            }
        }
    }

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
