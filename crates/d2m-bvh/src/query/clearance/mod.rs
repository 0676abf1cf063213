//! The least distance of two moving bodies over a window of time.
//!
//! First a time at which the bodies are close is sought, without proof. From there two ways lead through the window, forwards and
//! backwards, at a level a little below the least distance that is known: the search for a first contact at that level proves
//! that the bodies stay further apart than the level until a pair of triangles comes within it. That pair is followed to its closest
//! time, which gives a smaller distance, and the search goes on with what is left, from that time both ways if it is in it, with the new
//! level: what was proven at a higher level holds for a lower one. Where nothing is left, the level is the lower bound.
//! docs/theory/questions.md, "Clearance".

mod meeting;
mod options;
mod sample;
mod way;

pub use options::{Clearance, ClearanceOptions, ClearanceStatus};

use super::carried_pair::CarriedPair;
use super::general_motion::tolerance_of;
use super::kept_motion::KeptMotions;
use super::meshes::of_meshes;
use super::rounded::Rounded;
use crate::covered_pair::CoveredPair;
use crate::{
    Budget, Contact, Evidence, Meter, Moving, QueryError, QueryOptions, Solid, StartState, TimeOfContact,
    Window,
};
use d2m_feature::{FeaturePair, TriangleFeature};
use d2m_mesh::margin::direction;
use d2m_mesh::parallel::map_in_order;
use sample::{Sample, Sampler, closer};
use way::{Way, WayEnd};

/// Part of the allowed width that the enclosure takes; the rest is for roundings.
const PART_OF_WIDTH: f64 = 0.9;
/// Part of the width that is the tolerance of the search: a pair that it finds is at most 3.3 of these above the level.
const PART_OF_TOLERANCE: f64 = 0.15;
/// The allowed width in tolerances, where that is more than the accuracy.
const TOLERANCES: f64 = 4.0;
/// The width of the first way through the window, as a part of the distance.
const COARSE_WIDTH: f64 = 0.25;
/// A pair that the search finds has to be closer than what is known by this part of the width, or rounding hides what is left.
const LEAST_GAIN: f64 = 0.25;

/// The least distance of two bodies over a window, enclosed.
///
/// Promise: `lower` ≤ min over the window of the distance ≤ `upper`, in real arithmetic, for any motions;
/// `upper − lower` ≤ max(R·`upper`, 4 δ), R the accuracy of the options, δ the tolerance of the answer, unless the status is
/// [`Undecided`](ClearanceStatus::Undecided) or a cutoff was given. Solids that hold each other have the clearance 0, and so have
/// bodies that are proven to share a point: then the time is that of the contact. Bodies that come within δ without being proven to share
/// a point have `lower` = 0 and a small `upper`; bodies that touch with no more between them than the roundings of placing them have
/// [0, 0], too ([`Clearance::upper`] states by how much that may be short).
///
/// ```
/// use d2m_bvh::{ClearanceOptions, ClearanceStatus, MeshTree, Moving, TriMesh, Window, clearance};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// // Passes above the tip.
/// let passing = ConstantTwist::REST.with_position(DVec3::new(-2.0, 0.0, 1.5)).with_linear_velocity(DVec3::X * 4.0);
/// let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &passing)];
/// let nearest = clearance(a, b, Window::UNIT, &ClearanceOptions::default())?;
/// assert_eq!(nearest.status, ClearanceStatus::Clear);
/// assert!(nearest.lower <= 0.5 && 0.5 <= nearest.upper && nearest.upper - nearest.lower <= 1e-6 * nearest.upper);
/// assert!((nearest.normal - DVec3::Z).length() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Bad input only: those of [`time_of_contact`](crate::time_of_contact), and [`QueryError::BadAccuracy`].
#[doc(alias = "minimum_distance")]
pub fn clearance(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &ClearanceOptions,
) -> Result<Clearance, QueryError> {
    let value = options.accuracy;
    if !(value.is_finite() && value > 0.0) {
        return Err(QueryError::BadAccuracy { value });
    }
    if options.cutoff.is_nan() || options.cutoff < 0.0 {
        return Err(QueryError::BadMinSeparation { value: options.cutoff });
    }
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let found = Descent::try_new(carried.seen(), window, options)?.run()?;
    carried.clearance_in_world(found)
}

/// [`clearance`] of many pairs of bodies, in order. On all threads of the current rayon pool with the feature `rayon`; each query runs
/// on one thread, so the answers have the same bits at any number of threads (but for a budget of wall-clock time).
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{ClearanceOptions, Moving, Window, clearance_batch};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let window = Window::try_new(0.0, 0.1)?;
/// let all = clearance_batch(&[(a, b), (b, b)], window, &ClearanceOptions::default());
/// let [apart, same] = &all[..] else { panic!("one answer a pair") };
/// assert!(apart.as_ref().is_ok_and(|nearest| nearest.lower > 0.5));
/// assert!(same.as_ref().is_ok_and(|nearest| nearest.lower == 0.0)); // a body on top of itself
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn clearance_batch(
    pairs: &[(Moving<'_>, Moving<'_>)],
    window: Window,
    options: &ClearanceOptions,
) -> Vec<Result<Clearance, QueryError>> {
    let one = |&(a, b): &(Moving<'_>, Moving<'_>)| clearance(a, b, window, options);
    let kept = KeptMotions::new(pairs);
    map_in_order(&kept.in_pairs(pairs), 1, one)
}

/// The hard cap on one search holds for all of them together.
fn limited(budget: &Budget) -> Meter {
    let most = budget.node_tests.unwrap_or(Budget::HARD_NODE_TESTS);
    Meter::new(&budget.with_node_tests(most))
}

/// What the search is to prove.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Further apart than this.
    separation: f64,
    tolerance: f64,
    /// Of the enclosure.
    width: f64,
}

/// How wide the enclosure of one way through the window is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    Coarse,
    Accurate,
}

/// One query on its way.
struct Descent<'a> {
    sampler: Sampler<'a>,
    options: ClearanceOptions,
    rounded: Rounded,
    /// δ as used.
    tolerance: f64,
    meter: Meter,
    /// The clearance is proven to be at least this.
    proven: f64,
    /// What is not proven yet at the level of the pass.
    ways: Vec<Way>,
    /// What ways are searched with: surfaces once neither body is known to be inside the other one.
    searched: [Moving<'a>; 2],
    /// With a budget the first pass is a wide enclosure: then there is one also where the budget does not last for more.
    pass: Pass,
}

impl<'a> Descent<'a> {
    fn try_new(
        bodies: [Moving<'a>; 2],
        window: Window,
        options: &ClearanceOptions,
    ) -> Result<Self, QueryError> {
        let rounded = Rounded::try_new([&bodies[0], &bodies[1]])?;
        let query = QueryOptions { tolerance: options.tolerance, ..QueryOptions::DEFAULT };
        let query = rounded.options(bodies.map(|body| body.body), &query)?;
        let is_limited = options.budget != Budget::UNLIMITED;
        Ok(Self {
            sampler: Sampler { bodies, window },
            options: *options,
            rounded,
            tolerance: tolerance_of(&bodies, &query),
            meter: limited(&options.budget),
            proven: 0.0,
            ways: Vec::new(),
            searched: bodies,
            pass: if is_limited { Pass::Coarse } else { Pass::Accurate },
        })
    }

    /// The width that the enclosure may have when the meshes come within `upper` of each other.
    fn width(&self, upper: f64) -> f64 {
        let distance = (upper - self.rounded.sum()).max(0.0);
        PART_OF_WIDTH * (self.options.accuracy * distance).max(TOLERANCES * self.tolerance)
    }

    /// The level to be proven when the meshes come within `upper`, and the tolerance of the search; none where enclosures of the motions
    /// know so little that neither is a number.
    fn level(&self, upper: f64) -> Option<Level> {
        let width = match self.pass {
            Pass::Coarse => self.width(upper).max(COARSE_WIDTH * self.distance(upper)),
            Pass::Accurate => self.width(upper),
        };
        let separation = (upper - self.rounded.sum() - width).min(self.options.cutoff).max(0.0);
        let tolerance = if separation > 0.0 { PART_OF_TOLERANCE * width } else { self.tolerance };
        width.is_finite().then_some(Level { separation, tolerance, width })
    }

    /// Everything is to be proven, from a time on both ways.
    fn begin(&mut self, from: f64) {
        let window = self.sampler.window;
        self.ways.clear();
        let ways = [window.start(), window.end()].map(|to| Way { from, to });
        self.ways.extend(ways.iter().filter(|way| way.from != way.to));
        if self.ways.is_empty() {
            self.ways.push(ways[0]);
        }
        self.proven = f64::INFINITY;
    }

    fn run(mut self) -> Result<Clearance, QueryError> {
        // What the query refuses is refused before anything is computed of it.
        self.refuse_bad_input()?;
        let mut best = self.sampler.first(|upper| self.width(upper));
        let mut least_proven = 0.0;
        self.begin(best.time);
        loop {
            let Some(level) = self.level(best.upper) else {
                return self.unbounded(&best);
            };
            if level.separation == 0.0 {
                return self.near_zero(&best);
            }
            let Some(way) = self.ways.pop() else {
                let lower = self.proven.min(self.distance(best.upper));
                if self.pass == Pass::Accurate || lower >= self.options.cutoff {
                    #[cfg(feature = "audit")]
                    self.conclude(&best, lower);
                    return Ok(self.describe(&best, lower, ClearanceStatus::Clear));
                }
                (self.pass, least_proven) = (Pass::Accurate, lower);
                self.begin(best.time);
                continue;
            };
            let undecided =
                |this: &Self, best| Ok(this.describe(best, least_proven, ClearanceStatus::Undecided));
            let Some(options) = self.options_at(level.separation, level.tolerance, Some(best.triangles))
            else {
                return undecided(&self, &best);
            };
            let found = way.search(self.searched, &options)?;
            self.meter.spend(found.work.work() + 1);
            if found.is_outside {
                self.searched = self.searched.map(|body| body.with_solid(Solid::Surface));
            }
            self.proven = self.proven.min(level.separation + 0.5 * level.tolerance);
            match found.end {
                WayEnd::Clear => {}
                WayEnd::Undecided => return undecided(&self, &best),
                WayEnd::Contained => return self.near_zero(&best),
                // Around there nothing is known of the motions.
                WayEnd::Near { .. } if found.tolerance == f64::INFINITY => return undecided(&self, &best),
                WayEnd::Near { triangles, time } => {
                    let near = self.sampler.pair_at(triangles, time);
                    let lowest = self.sampler.settle(near, |upper| self.width(upper));
                    if lowest.upper >= best.upper - LEAST_GAIN * level.width {
                        // Rounding hides what is left of the width.
                        self.tolerance = (2.0 * self.tolerance).max(found.tolerance).max(level.width);
                    }
                    best = closer(best, lowest);
                    self.ways.extend(Way { from: time, ..found.way }.divided_at(best.time));
                }
            }
        }
    }

    /// No upper bound is known: what can be proven is that the bodies stay apart.
    fn unbounded(self, best: &Sample) -> Result<Clearance, QueryError> {
        let found = self.near_zero(best)?;
        let is_wide = found.status == ClearanceStatus::Clear;
        Ok(if is_wide { Clearance { status: ClearanceStatus::Undecided, ..found } } else { found })
    }

    /// Bodies that may meet: the first contact decides.
    fn near_zero(mut self, best: &Sample) -> Result<Clearance, QueryError> {
        let Some(options) = self.options_at(0.0, self.tolerance, None) else {
            return Ok(self.describe(best, 0.0, ClearanceStatus::Undecided));
        };
        let [a, b] = self.sampler.bodies;
        let found = of_meshes([a, b], self.sampler.window, &options)?;
        self.meter.spend(found.work.work() + 1);
        match found.answer {
            TimeOfContact::Separated => {
                // The search proves more than its separation: at least half a tolerance above it.
                let lower = (0.5 * self.tolerance).min(self.distance(best.upper));
                #[cfg(feature = "audit")]
                self.conclude(best, lower);
                Ok(self.describe(best, lower, ClearanceStatus::Clear))
            }
            TimeOfContact::Undecided { .. } => Ok(self.describe(best, 0.0, ClearanceStatus::Undecided)),
            TimeOfContact::Contact(contact) if contact.start == StartState::Contained => {
                Ok(self.meeting(&contact, best))
            }
            TimeOfContact::Contact(contact) => Ok(self.contact(&contact, best)),
        }
    }

    /// The least distance is enclosed by these two. Of the meshes: the radii are added again, rounded downwards.
    #[cfg(feature = "audit")]
    fn conclude(&self, best: &Sample, lower: f64) {
        use super::concluded::{Claimed, conclude_apart, conclude_of_triangles, sum_of_distances};
        use d2m_mesh::audit::{Place, Promise};
        let Sampler { bodies, window } = &self.sampler;
        let distance = sum_of_distances(lower, self.rounded.sum(), 0.0);
        let whole = Claimed { from: window.start(), to: window.end(), distance };
        conclude_apart(Place::ClearanceBound, bodies, whole);
        let at = Claimed { from: best.time, to: best.time, distance: best.upper };
        conclude_of_triangles(Place::ClearanceBound, Promise::Meets, bodies, best.triangles, at);
    }

    /// # Errors
    /// Those of the query, found by one that has no budget for anything.
    fn refuse_bad_input(&self) -> Result<(), QueryError> {
        let nothing = Budget::UNLIMITED.with_node_tests(0);
        let options = self.query_options(0.0, 0.0, None).with_budget(nothing);
        let options = QueryOptions { tolerance: self.options.tolerance, ..options };
        let [a, b] = self.sampler.bodies;
        of_meshes([a, b], self.sampler.window, &options).map(|_| ())
    }

    fn query_options(&self, level: f64, tolerance: f64, grazing: Option<[u32; 2]>) -> QueryOptions {
        let sum = self.rounded.sum();
        let separation = if sum == 0.0 { level } else { (level + sum).next_up() };
        // Points without a radius have no tolerance of their own: rounding gives the least one.
        let tolerance = (tolerance > 0.0).then_some(tolerance);
        QueryOptions { tolerance, grazing, ..QueryOptions::DEFAULT }
            .with_min_separation(separation)
            .with_solid(self.options.solid)
            .with_parallel(self.options.parallel)
    }

    /// The options of the search at a level; `None` when the budget is used up.
    fn options_at(&self, level: f64, tolerance: f64, grazing: Option<[u32; 2]>) -> Option<QueryOptions> {
        let options = self.query_options(level, tolerance, grazing);
        (!self.meter.is_exhausted()).then(|| options.with_budget(self.meter.rest()))
    }

    /// The distance of the rounded bodies, from that of their meshes; not below it.
    fn distance(&self, upper: f64) -> f64 {
        let [a, b] = self.rounded.radii;
        if a + b == 0.0 { upper } else { (upper - (a + b).next_down()).next_up().max(0.0) }
    }

    /// The bodies come within the tolerance of each other.
    fn contact(&mut self, contact: &Contact, best: &Sample) -> Clearance {
        let triangles = [contact.triangle_a, contact.triangle_b];
        let met = self.sampler.pair_at(triangles, contact.time_lo);
        let lowest = self
            .sampler
            .settle(closer(met, self.sampler.pair_at(triangles, contact.time_hi)), |_| self.tolerance);
        let shares = |sample: &Sample| sample.crosses || self.distance(sample.upper) == 0.0;
        let crossing = contact.evidence == Evidence::Crossing && self.rounded.sum() == 0.0;
        let is_met = crossing || shares(&lowest) || shares(best) || self.share_a_point_from(contact);
        if is_met {
            return self.meeting(contact, &lowest);
        }
        // Where numbers for time are too far apart for the tolerance, as much is left at the time of contact as the search says.
        let tolerance = self.tolerance.max(contact.tolerance);
        Clearance { tolerance, ..self.describe(&closer(met, lowest), 0.0, ClearanceStatus::Contact) }
    }

    /// The bodies are proven to share a point.
    fn meeting(&self, contact: &Contact, best: &Sample) -> Clearance {
        let rounded = self.rounded.answer(TimeOfContact::Contact(*contact));
        let contact = rounded.contact().copied().unwrap_or(*contact);
        Clearance {
            lower: 0.0,
            upper: 0.0,
            time: contact.time_lo,
            point_a: contact.point_a,
            point_b: contact.point_b,
            normal: contact.normal,
            feature: contact.feature,
            triangle_a: contact.triangle_a,
            triangle_b: contact.triangle_b,
            tolerance: self.tolerance.max(contact.tolerance),
            ..self.describe(best, 0.0, ClearanceStatus::Contact)
        }
    }

    fn describe(&self, best: &Sample, lower: f64, status: ClearanceStatus) -> Clearance {
        let [point_a, point_b] = best.points;
        let normal = direction(best.near.point_b - best.near.point_a);
        let [radius_a, radius_b] = self.rounded.radii;
        Clearance {
            lower,
            upper: self.distance(best.upper),
            time: best.time,
            point_a: point_a + normal * radius_a,
            point_b: point_b - normal * radius_b,
            normal,
            feature: self.feature(best),
            triangle_a: best.triangles[0],
            triangle_b: best.triangles[1],
            tolerance: self.tolerance,
            status,
        }
    }

    fn feature(&self, best: &Sample) -> FeaturePair {
        let corners = |k: usize| self.sampler.bodies[k].body.mesh().triangles()[best.triangles[k] as usize];
        let (a, b) = (corners(0), corners(1));
        let edge = |t: [u32; 3], k: u8| {
            let (p, q) = (t[usize::from(k)], t[(usize::from(k) + 1) % 3]);
            [p.min(q), p.max(q)]
        };
        let [face_a, face_b] = best.triangles;
        match (best.near.feature_a, best.near.feature_b) {
            (TriangleFeature::Edge(i), TriangleFeature::Edge(j)) => {
                FeaturePair::EdgeEdge { edge_a: edge(a, i), edge_b: edge(b, j) }
            }
            // An edge within the plane of a face: one of its ends stands for it.
            (TriangleFeature::Vertex(i), _) | (TriangleFeature::Edge(i), TriangleFeature::Face) => {
                FeaturePair::VertexFace { vertex: a[usize::from(i)], face: face_b }
            }
            (_, TriangleFeature::Vertex(j)) | (TriangleFeature::Face, TriangleFeature::Edge(j)) => {
                FeaturePair::FaceVertex { face: face_a, vertex: b[usize::from(j)] }
            }
            (TriangleFeature::Face, TriangleFeature::Face) => {
                FeaturePair::VertexFace { vertex: a[0], face: face_b }
            }
        }
    }
}
