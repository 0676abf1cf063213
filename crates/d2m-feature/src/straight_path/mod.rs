//! Four vertices that move on straight segments, each on its own: deforming meshes.
mod edge_edge;
mod linear;
mod point_triangle;
mod straight_test;
mod triple_product;

use crate::contact::{ContactBracket, FirstContact};
use crate::options::ContactOptions;
use crate::rigid_query::answer_in;
use crate::rounding::{UNIT, UP};
use crate::units::Units;
use d2m_lanes::power_of_two;
use d2m_root::Piece;
use glam::DVec3;
use straight_test::StraightTest;

/// Four points, each moving from its start (t = 0) to its end (t = 1) at constant velocity: `(1 − t)·start + t·end`.
///
/// Answers are the same for every exact scaling of the coordinates (finite; 2⁻⁹⁰⁰ to 2⁹⁰⁰ and beyond).
///
/// ```
/// use d2m_feature::{ContactOptions, FirstContact, StraightPaths};
/// use glam::DVec3;
/// let triangle = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
/// let start = [DVec3::Z, triangle[0], triangle[1], triangle[2]];
/// let end = [-DVec3::Z, triangle[0], triangle[1], triangle[2]];
/// let paths = StraightPaths::new(start, end);
/// let FirstContact::Contact(contact) = paths.point_triangle(&ContactOptions::new()) else { panic!() };
/// assert!(contact.lo <= 0.5 && 0.5 <= contact.hi && contact.hi - contact.lo < 1e-10);
/// let apart = ContactOptions::new().with_min_separation(0.25);
/// let FirstContact::Contact(earlier) = paths.point_triangle(&apart) else { panic!() };
/// assert!((earlier.lo - 0.375).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightPaths {
    start: [DVec3; 4],
    end: [DVec3; 4],
}

/// 2⁻¹⁰⁰ and 2¹⁰⁰: products of three lengths between them, and of what rounding leaves of them, stay within 2±⁵⁰⁰, far from
/// what under- or overflows.
const SMALLEST: f64 = power_of_two(-100);
const LARGEST: f64 = power_of_two(100);

const WINDOW: Option<Piece> = Some(Piece { lo: 0.0, hi: 1.0 });

impl StraightPaths {
    /// Starts and ends of the four points: point and triangle, or edge A and edge B.
    pub const fn new(start: [DVec3; 4], end: [DVec3; 4]) -> Self {
        Self { start, end }
    }

    /// First contact of the first point with the triangle of the other three, t in [0, 1].
    pub fn point_triangle(&self, options: &ContactOptions) -> FirstContact {
        let lines = Lines::new(self);
        if lines.are_ordinary() {
            point_triangle(&lines, options)
        } else {
            self.answer_in_other_units(options, point_triangle)
        }
    }

    /// First contact of the edge of the first two points with the edge of the last two, t in [0, 1].
    pub fn edge_edge(&self, options: &ContactOptions) -> FirstContact {
        let lines = Lines::new(self);
        if lines.are_ordinary() {
            edge_edge(&lines, options)
        } else {
            self.answer_in_other_units(options, edge_edge)
        }
    }

    /// The largest coordinate is brought into [1, 2): what underflows then is far below its rounding.
    #[cold]
    fn answer_in_other_units(
        &self,
        options: &ContactOptions,
        query: fn(&Lines, &ContactOptions) -> FirstContact,
    ) -> FirstContact {
        let most = self.start.iter().chain(&self.end).fold(DVec3::ZERO, |most, p| most.max(p.abs()));
        let units = Units::of_size(most.max_element());
        let paths = Self { start: units.points(self.start), end: units.points(self.end) };
        back(query(&Lines::new(&paths), &options.in_units(&units)), &units)
    }
}

#[inline(always)]
fn point_triangle(lines: &Lines, options: &ContactOptions) -> FirstContact {
    answer_in(&mut StraightTest::of_point(lines, options), WINDOW, 0.0, options).contact
}

#[inline(always)]
fn edge_edge(lines: &Lines, options: &ContactOptions) -> FirstContact {
    answer_in(&mut StraightTest::of_edges(lines, options), WINDOW, 0.0, options).contact
}

/// A contact's distances in the units of the input.
fn back(answer: FirstContact, units: &Units) -> FirstContact {
    match answer {
        FirstContact::Contact(contact) => FirstContact::Contact(ContactBracket {
            distance: units.length_up(contact.distance),
            tolerance: units.length_up(contact.tolerance),
            ..contact
        }),
        other => other,
    }
}

/// The four points as start and velocity, and what bounds their rounding.
pub(crate) struct Lines {
    start: [DVec3; 4],
    velocity: [DVec3; 4],
    /// Largest distance of any point from the origin at any time (the ends: convex), rounded up.
    magnitude: f64,
}

impl Lines {
    #[inline(always)]
    fn new(paths: &StraightPaths) -> Self {
        // One common origin near the features: what is far from the world's origin keeps its digits.
        let origin = paths.start[1];
        // Written out: a closure over an array is a call.
        let ([s0, s1, s2, s3], [e0, e1, e2, e3]) = (paths.start, paths.end);
        let start = [s0 - origin, DVec3::ZERO, s2 - origin, s3 - origin];
        let velocity = [e0 - s0, e1 - s1, e2 - s2, e3 - s3];
        let square = |p: DVec3| (p - origin).length_squared();
        let squares = [square(s0), square(s2), square(s3), square(e0), square(e1), square(e2), square(e3)];
        let magnitude = largest(&squares).sqrt() * UP;
        Self { start, velocity, magnitude }
    }

    /// No product of coordinates over- or underflows: the largest difference is in [2⁻¹⁰⁰, 2¹⁰⁰].
    #[inline(always)]
    fn are_ordinary(&self) -> bool {
        (SMALLEST..=LARGEST).contains(&self.magnitude)
    }

    /// Bound of the error of a sum of differences of the points at a time of the window, dotted with a vector of
    /// length at most 1: 48 units of the magnitude for two points, 64 for the four of two edges
    /// (docs/theory/features.md counts 36 and 54).
    fn error(&self, units: f64) -> f64 {
        units * UNIT * self.magnitude
    }
}

/// The largest of non-negative numbers; a NaN is not counted (it excludes nothing later).
#[inline(always)]
fn largest<const N: usize>(numbers: &[f64; N]) -> f64 {
    let mut most = 0.0;
    for &number in numbers {
        most = larger(number, most);
    }
    most
}

#[inline(always)]
fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}
