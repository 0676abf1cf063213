//! The spans of a window in which the bodies of a world are clear of each other.

use super::clearance::is_among;
use super::schedule::Schedule;
use super::{BodyId, PlannedMotion, World, WorldError};
use crate::batches::PAIRS;
use crate::box_tree::IndexPair;
use d2m_bvh::{ContactSpan, SpanStatus, Start, Window, contact_spans};
use d2m_mesh::parallel::map_in_order;

/// The spans of two bodies of a world.
///
/// ```
/// # use d2m_bvh::MeshTree;
/// # use std::sync::Arc;
/// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
/// use d2m_bvh::{QueryOptions, SpanStatus, Window};
/// use d2m_motion::ConstantTwist;
/// use d2m_world::{Body, World};
/// use glam::DVec3;
/// let mut world = World::new(QueryOptions::default());
/// let wall = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
/// let passing = ConstantTwist::REST.with_position(DVec3::X * -4.0).with_linear_velocity(DVec3::X * 8.0);
/// let thrown = world.add(Body::new(cube, passing));
/// let pairs = world.contact_spans(Window::UNIT, None)?;
/// assert_eq!((pairs[0].a, pairs[0].b, pairs[0].spans[1].status), (wall, thrown, SpanStatus::Contact));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub struct PairSpans {
    /// The first body: the one with the smaller place.
    pub a: BodyId,
    /// The second body.
    pub b: BodyId,
    /// Joined, in order, covering the window; not all of it is clear.
    pub spans: Vec<ContactSpan>,
}

impl World {
    /// In which spans of the window each pair is proven clear, further apart than its minimum separation, as
    /// [`d2m_bvh::contact_spans`] states them; ascending by places. Pairs that are clear all the time are left out, and so are
    /// ignored ones. [`join_spans`] says when all are clear. The budget of the world's options is one for each pair.
    ///
    /// ```
    /// # use d2m_bvh::MeshTree;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?)); // edges of length 1
    /// use d2m_bvh::{QueryOptions, SpanStatus, Window};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, World, join_spans};
    /// use glam::DVec3;
    /// let mut world = World::new(QueryOptions::default());
    /// let passing = ConstantTwist::REST.with_position(DVec3::X * -4.0).with_linear_velocity(DVec3::X * 16.0);
    /// world.add(Body::new(Arc::clone(&cube), passing));
    /// for x in [0.0, 8.0] {
    ///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * x)));
    /// }
    /// let pairs = world.contact_spans(Window::UNIT, None)?;
    /// assert_eq!(pairs.len(), 2); // it flies through both
    /// let all = join_spans(Window::UNIT, &pairs);
    /// let words: Vec<_> = all.iter().map(|span| span.status == SpanStatus::Clear).collect();
    /// assert_eq!(words, [true, false, true, false, true]);
    /// assert!((all[1].from - 3.0 / 16.0).abs() < 1e-5 && (all[1].to - 5.0 / 16.0).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bad input of a pair, with its names, also a resolution that is not positive; a motion that does not cover the window.
    pub fn contact_spans(
        &self,
        window: Window,
        resolution: Option<f64>,
    ) -> Result<Vec<PairSpans>, WorldError> {
        let mut schedule = Schedule::default();
        schedule.prepare(self.rules(), window, &[]).map_err(|uncovered| self.uncovered(uncovered))?;
        self.spans_of(&schedule.pairs(), window, resolution)
    }

    /// As [`World::contact_spans`], if these bodies moved so and all others as they do: of the pairs with one of these.
    ///
    /// ```
    /// # use d2m_bvh::{MeshTree, QueryOptions, Window};
    /// # use d2m_motion::ConstantTwist;
    /// # use d2m_world::{Body, World};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let at = |x: f64, v: f64| ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
    /// let mut world = World::new(QueryOptions::default());
    /// let wall = world.add(Body::new(Arc::clone(&cube), at(0.0, 0.0)));
    /// let cart = world.add(Body::new(cube, at(-5.0, 2.0)));
    /// use d2m_bvh::SpanStatus;
    /// use d2m_world::PlannedMotion;
    /// let plan = [PlannedMotion { body: cart, motion: Arc::new(at(-5.0, 16.0)) }]; // right through
    /// let pairs = world.contact_spans_of(&plan, Window::UNIT, None)?;
    /// assert_eq!((pairs[0].a, pairs[0].b), (wall, cart));
    /// assert!(pairs[0].spans.iter().any(|span| span.status == SpanStatus::Contact));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`World::contact_spans`].
    ///
    /// # Panics
    /// If a body was removed, or its name belongs to another world.
    pub fn contact_spans_of(
        &self,
        plan: &[PlannedMotion],
        window: Window,
        resolution: Option<f64>,
    ) -> Result<Vec<PairSpans>, WorldError> {
        let (world, planned) = self.planned(plan);
        let mut schedule = Schedule::default();
        schedule.prepare(world.rules(), window, &[]).map_err(|uncovered| world.uncovered(uncovered))?;
        let mut pairs = schedule.pairs();
        pairs.retain(|pair| is_among(&planned, *pair));
        world.spans_of(&pairs, window, resolution)
    }

    /// The spans of pairs that the boxes do not prove clear.
    fn spans_of(
        &self,
        pairs: &[IndexPair],
        window: Window,
        resolution: Option<f64>,
    ) -> Result<Vec<PairSpans>, WorldError> {
        let found = map_in_order(pairs, PAIRS, |&pair| {
            let [Some(a), Some(b)] = pair.map(|place| self.slots.at(place)) else { return Ok(Vec::new()) };
            let separation = self.filter.separation(pair, self.options.min_separation);
            let options = self.options.with_min_separation(separation).with_start(Start::Report);
            contact_spans(a.moving(), b.moving(), window, &options, resolution)
        });
        let mut listed = Vec::new();
        for (pair, found) in pairs.iter().zip(found) {
            let [a, b] = pair.map(|place| self.slots.id(place));
            let spans = found.map_err(|error| WorldError::Pair { a, b, error })?;
            if spans.iter().any(|span| span.status != SpanStatus::Clear) {
                listed.push(PairSpans { a, b, spans });
            }
        }
        Ok(listed)
    }
}

/// The spans of many pairs as one list: clear where all are, in contact where one is, else undecided. Joined, in order, covering the window.
///
/// ```
/// use d2m_bvh::{SpanStatus, Window};
/// let nothing_meets = d2m_world::join_spans(Window::UNIT, &[]);
/// assert_eq!((nothing_meets.len(), nothing_meets[0].status), (1, SpanStatus::Clear));
/// ```
pub fn join_spans(window: Window, pairs: &[PairSpans]) -> Vec<ContactSpan> {
    let ends = pairs.iter().flat_map(|pair| &pair.spans).flat_map(|span| [span.from, span.to]);
    let mut times: Vec<f64> = [window.start(), window.end()].into_iter().chain(ends).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    if let [only] = times[..] {
        times = vec![only; 2];
    }
    let mut joined: Vec<ContactSpan> = Vec::new();
    for span in times.windows(2) {
        let [from, to] = [span[0], span[1]];
        // Spans of a pair end where the next one begins, so one of them holds all of this.
        let holding = |pair: &PairSpans| {
            let holding = pair.spans.iter().filter(|of| of.from <= from && to <= of.to);
            let found = holding.max_by_key(|of| rank(of.status)).copied();
            found.unwrap_or(ContactSpan::new(from, to, SpanStatus::Undecided))
        };
        let of_pairs: Vec<ContactSpan> = pairs.iter().map(holding).collect();
        let status = of_pairs.iter().map(|of| of.status).max_by_key(|status| rank(*status));
        let status = status.unwrap_or(SpanStatus::Clear);
        let tolerances = of_pairs.iter().filter(|of| of.status == status).map(|of| of.tolerance);
        let tolerance = tolerances.fold(0.0, f64::max);
        match joined.last_mut().filter(|last| last.status == status) {
            Some(last) => (last.to, last.tolerance) = (to, last.tolerance.max(tolerance)),
            None => joined.push(ContactSpan::new(from, to, status).with_tolerance(tolerance)),
        }
    }
    joined
}

/// What counts more where several hold.
const fn rank(status: SpanStatus) -> u8 {
    match status {
        SpanStatus::Clear => 0,
        SpanStatus::Undecided => 1,
        SpanStatus::Contact => 2,
    }
}
