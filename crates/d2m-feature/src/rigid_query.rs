//! First contacts of features along rigid paths, in the units of a pair of motions.
use crate::contact::{ContactBracket, FirstContact};
use crate::edge_edge::EdgeEdgeTest;
use crate::options::ContactOptions;
use crate::path::{FeaturePath, FramedMotion, RigidPath};
use crate::point_triangle::{PointTriangleTest, TrianglePlanes};
use crate::rounding::{DOWN, UP, length_up};
use crate::sphere_sphere::SphereSphereTest;
use d2m_root::{Evidence, FirstRoot, Isolation, IsolatorOptions, Piece, PieceTest, isolate};
use glam::DVec3;

/// Part of the tolerance that rounding may take before positions are made in extended precision.
const PART_OF_ROUNDING: f64 = 0.25;
/// What an evaluation in extended precision counts as: it takes some 16 to 32 times as long.
const COST_OF_ANCHORS: u32 = 32;

/// Prepares a triangle of B.
pub(crate) fn place(framed: &FramedMotion, triangle: &[DVec3; 3]) -> TrianglePlanes {
    TrianglePlanes::new(triangle.map(|v| framed.motion.place_b(v)))
}

pub(crate) fn point_triangle(
    framed: &FramedMotion,
    point: DVec3,
    triangle: &[DVec3; 3],
    options: &ContactOptions,
) -> FirstContact {
    point_placed(framed, point, triangle, &place(framed, triangle), options)
}

pub(crate) fn point_placed(
    framed: &FramedMotion,
    point: DVec3,
    vertices: &[DVec3; 3],
    planes: &TrianglePlanes,
    options: &ContactOptions,
) -> FirstContact {
    let separation = options.separation();
    #[inline(always)]
    fn build<'a>(
        framed: &'a FramedMotion,
        point: DVec3,
        planes: &'a TrianglePlanes,
        separation: f64,
    ) -> PointTriangleTest<'a, RigidPath<'a>> {
        let point = framed.motion.place_a(point);
        let path = RigidPath::new(framed, point, DVec3::ZERO, planes.extent, separation);
        PointTriangleTest::new(path, planes, 0.0, separation)
    }
    let mut test = build(framed, point, planes, separation);
    first_contact(&mut test, framed, options).unwrap_or_else(|reach| {
        let anchored = FramedMotion::new(framed.motion.anchored(point, vertices[0]));
        let planes = place(&anchored, vertices);
        first_contact_anchored(&mut build(&anchored, point, &planes, separation), reach, &anchored, options)
    })
}

pub(crate) fn edge_edge(
    framed: &FramedMotion,
    edge_a: [DVec3; 2],
    edge_b: [DVec3; 2],
    options: &ContactOptions,
) -> FirstContact {
    let separation = options.separation();
    #[inline(always)]
    fn build(
        framed: &FramedMotion,
        edge_a: [DVec3; 2],
        edge_b: [DVec3; 2],
        separation: f64,
    ) -> EdgeEdgeTest<RigidPath<'_>> {
        // Half edges turn as differences, so that their error is relative to their own length.
        let half_a = framed.motion.turn_a((edge_a[1] - edge_a[0]) * 0.5);
        let half = framed.motion.turn_b((edge_b[1] - edge_b[0]) * 0.5);
        let point = framed.motion.place_a(edge_a[0]) + half_a;
        let middle = framed.motion.place_b(edge_b[0]) + half;
        let extent = length_up(middle) + length_up(half_a) + length_up(half);
        let path = RigidPath::new(framed, point, half_a, extent, separation);
        EdgeEdgeTest::new(path, middle, half, half_a, separation)
    }
    let mut test = build(framed, edge_a, edge_b, separation);
    first_contact(&mut test, framed, options).unwrap_or_else(|reach| {
        let anchored = FramedMotion::new(framed.motion.anchored(edge_a[0], edge_b[0]));
        let mut test = build(&anchored, edge_a, edge_b, separation);
        first_contact_anchored(&mut test, reach, &anchored, options)
    })
}

pub(crate) fn sphere_sphere(
    framed: &FramedMotion,
    centers: [DVec3; 2],
    radii: f64,
    options: &ContactOptions,
) -> FirstContact {
    let separation = options.separation();
    #[inline(always)]
    fn build(
        framed: &FramedMotion,
        centers: [DVec3; 2],
        size: f64,
        separation: f64,
    ) -> SphereSphereTest<RigidPath<'_>> {
        let radii = (size * DOWN, size * UP);
        let center = framed.motion.place_b(centers[1]);
        let extent = length_up(center) + radii.1;
        let path = RigidPath::new(framed, framed.motion.place_a(centers[0]), DVec3::ZERO, extent, separation);
        SphereSphereTest { path, center, radii, tolerance: 0.0, separation, size }
    }
    let mut test = build(framed, centers, radii, separation);
    first_contact(&mut test, framed, options).unwrap_or_else(|reach| {
        let anchored = FramedMotion::new(framed.motion.anchored(centers[0], centers[1]));
        first_contact_anchored(&mut build(&anchored, centers, radii, separation), reach, &anchored, options)
    })
}

/// A piece test along a rigid path, built before its tolerance is known.
trait RigidTest: PieceTest {
    fn path(&self) -> &RigidPath<'_>;
    /// Size of the features, for the default tolerance.
    fn length(&self) -> f64;
    fn set_tolerance(&mut self, tolerance: f64);
}

macro_rules! rigid_test {
    ($test:ty, $length:expr) => {
        impl RigidTest for $test {
            fn path(&self) -> &RigidPath<'_> {
                &self.path
            }
            fn length(&self) -> f64 {
                $length(self)
            }
            fn set_tolerance(&mut self, tolerance: f64) {
                self.tolerance = tolerance;
            }
        }
    };
}
rigid_test!(PointTriangleTest<'_, RigidPath<'_>>, |test: &Self| test.planes.size);
rigid_test!(EdgeEdgeTest<RigidPath<'_>>, |test: &Self| 2.0 * test.half_lengths.0.max(test.half_lengths.1));
rigid_test!(SphereSphereTest<RigidPath<'_>>, |test: &Self| test.size);

/// The answer of a test whose rounding the tolerance covers; if it does not, how far the features reach: they are to be
/// queried again from anchors near them.
fn first_contact(
    test: &mut impl RigidTest,
    framed: &FramedMotion,
    options: &ContactOptions,
) -> Result<FirstContact, f64> {
    let path = test.path();
    let reach = path.reach();
    let tolerance = options.wanted_tolerance(test.length(), reach);
    // Also NaN is queried again.
    if path.rounding() <= PART_OF_ROUNDING * tolerance {
        let tolerance = tolerance.max(path.time_rounding());
        test.set_tolerance(tolerance);
        Ok(answer(test, framed, options))
    } else {
        Err(reach)
    }
}

/// The answer of a test from anchors, with the tolerance that the features would have without and what rounding needs.
fn first_contact_anchored(
    test: &mut impl RigidTest,
    reach: f64,
    anchored: &FramedMotion,
    options: &ContactOptions,
) -> FirstContact {
    let path = test.path();
    let rounding = (path.rounding() / PART_OF_ROUNDING).max(path.time_rounding());
    test.set_tolerance(options.wanted_tolerance(test.length(), reach).max(rounding));
    answer(test, anchored, &options.at_cost(COST_OF_ANCHORS))
}

/// Isolates the first contact and expresses the answer in real time.
fn answer(test: &mut impl RigidTest, framed: &FramedMotion, options: &ContactOptions) -> FirstContact {
    let (motion, window) = (&framed.motion, test.path().window());
    match answer_in(test, window, 0.0, options).contact {
        FirstContact::Clear => FirstContact::Clear,
        FirstContact::Undecided { clear_until } => {
            FirstContact::Undecided { clear_until: motion.time_down(clear_until) }
        }
        FirstContact::Contact(contact) => {
            let lo = motion.time_down(contact.lo);
            let hi = motion.time_up(contact.hi).max(lo);
            FirstContact::Contact(ContactBracket { lo, hi, ..contact })
        }
    }
}

/// An answer, and the evaluations that it took.
pub(crate) struct Answered {
    pub(crate) contact: FirstContact,
    pub(crate) evaluations: u32,
}

impl Answered {
    /// Without any evaluation.
    pub(crate) const fn at_once(contact: FirstContact) -> Self {
        Self { contact, evaluations: 0 }
    }
}

/// Isolates in the part of the window in which the features come within reach of each other, in the test's own time.
#[inline]
pub(crate) fn answer_in(
    test: &mut impl PieceTest,
    part: Option<Piece>,
    start: f64,
    options: &ContactOptions,
) -> Answered {
    let Some(part) = part else {
        return Answered::at_once(FirstContact::Clear);
    };
    let tolerance = test.tolerance();
    if tolerance.is_nan() || tolerance == f64::INFINITY {
        // Nothing is known of where the features are.
        return Answered::at_once(FirstContact::Undecided { clear_until: part.lo });
    }
    let mut limits = IsolatorOptions::new().with_max_evaluations(options.max_evaluations);
    if part.lo > start {
        // It starts where the spheres about both features meet.
        limits = limits.with_start_apart();
    }
    let Isolation { root, evaluations } = isolate(test, part, &limits);
    let contact = match root {
        FirstRoot::Clear => FirstContact::Clear,
        FirstRoot::Undecided { clear_until } => FirstContact::Undecided { clear_until },
        FirstRoot::Found { bracket: Piece { lo, hi }, evidence, distance } => match evidence {
            Evidence::Crossing | Evidence::WithinTolerance => {
                FirstContact::Contact(ContactBracket { lo, hi, evidence, distance, tolerance })
            }
            // As narrow as the clock allows, neither apart nor within the tolerance.
            _ => FirstContact::Undecided { clear_until: lo },
        },
    };
    Answered { contact, evaluations }
}
