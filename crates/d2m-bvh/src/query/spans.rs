//! The spans of a window in which two bodies are clear of each other, and those in which they are in contact. Clear spans end where a search of
//! the first contact ends; ends of contact are found by [`super::staying_walk`].

use super::carried_pair::CarriedPair;
#[cfg(feature = "audit")]
use super::concluded::{Claimed, conclude_apart};
use super::general_motion::tolerance_of;
use super::rounded::Rounded;
use super::staying_walk::{Next, Walk};
use crate::covered_pair::CoveredPair;
use crate::{Contact, Evidence, Mode, Moving, QueryError, QueryOptions, StartState, TimeOfContact, Window};
use d2m_lanes::power_of_two;
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;

/// What is known of a span of time.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, SpanStatus, Window, contact_spans};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// // From the first contact on the bodies are in contact until the window ends.
/// let spans = contact_spans(a, b, Window::try_new(0.0, 0.4)?, &QueryOptions::default(), Some(1e-3))?;
/// let [clear, contact] = &spans[..] else { panic!("{spans:?}") };
/// assert_eq!((clear.status, contact.status), (SpanStatus::Clear, SpanStatus::Contact));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum SpanStatus {
    /// Proven further apart than `min_separation` at every time of the closed span.
    Clear,
    /// Proven within L = `min_separation` + δ, with δ the span's tolerance, at times of the span that are no more than the resolution apart, and no more than that from
    /// its ends.
    Contact,
    /// Neither is proven.
    Undecided,
}

/// A closed span of time.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, SpanStatus, Window, contact_spans};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let spans = contact_spans(a, b, Window::try_new(0.0, 0.2)?, &QueryOptions::default(), None)?;
/// let [span] = &spans[..] else { panic!("{spans:?}") };
/// assert_eq!((span.from, span.to, span.status), (0.0, 0.2, SpanStatus::Clear));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ContactSpan {
    /// First time.
    pub from: f64,
    /// Last time; the next span begins here.
    pub to: f64,
    /// What is known.
    pub status: SpanStatus,
    /// δ: that of the query, or more in a span of contact where rounding, or enclosures of the motions, resolve no less.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tolerance: f64,
}

impl ContactSpan {
    /// A span from one time to another with what is known of it, and with the tolerance of the query.
    ///
    /// ```
    /// use d2m_bvh::{ContactSpan, SpanStatus};
    /// assert_eq!(ContactSpan::new(0.0, 0.5, SpanStatus::Clear).to, 0.5);
    /// ```
    pub const fn new(from: f64, to: f64, status: SpanStatus) -> Self {
        Self { from, to, status, tolerance: 0.0 }
    }

    /// With this tolerance.
    ///
    /// ```
    /// use d2m_bvh::{ContactSpan, SpanStatus};
    /// assert_eq!(ContactSpan::new(0.0, 0.5, SpanStatus::Contact).with_tolerance(1e-9).tolerance, 1e-9);
    /// ```
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }
}

/// The spans of a window, joined, in order, in which two bodies are clear of each other or in contact.
///
/// Promise: they cover the window. In a clear span the distance is above `min_separation` at every time, ends included, and it ends where
/// a search from its start ends: within 3.3 tolerances above `min_separation`, or at the end of the window. A contact span begins and ends
/// at an end of the window or within `resolution` of a time at which the distance is proven to be at most L = `min_separation` + δ; clear
/// times shorter than `resolution` may be inside. A body that jumps, or that passes through another one from one number for time to the next, is
/// in no contact that is proven: that step is undecided. `resolution`: a time; `None`: 1e-6 of the window.
/// Every [`Mode`] counts as accurate: spans end at first contacts.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, SpanStatus, TriMesh, Window, contact_spans};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// // Flies through the other one.
/// let flying = ConstantTwist::REST.with_position(DVec3::X * -2.0).with_linear_velocity(DVec3::X * 4.0);
/// let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &flying)];
/// let spans = contact_spans(a, b, Window::UNIT, &QueryOptions::default(), None)?;
/// let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
/// assert_eq!(statuses, [SpanStatus::Clear, SpanStatus::Contact, SpanStatus::Clear]);
/// assert!((spans[1].from - 0.25).abs() < 1e-5 && (spans[1].to - 0.75).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`time_of_contact`](crate::time_of_contact), and [`QueryError::BadResolution`].
pub fn contact_spans(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
    resolution: Option<f64>,
) -> Result<Vec<ContactSpan>, QueryError> {
    if let Some(value) = resolution
        && !(value.is_finite() && value > 0.0)
    {
        return Err(QueryError::BadResolution { value });
    }
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let [a, b] = carried.seen();
    let rounded = Rounded::try_new([&a, &b])?;
    let mut options = rounded.options([a.body, b.body], options)?;
    options.mode = Mode::Accurate;
    let tolerance = tolerance_of(&[a, b], &options);
    let resolution = resolution.unwrap_or(window.default_resolution());
    let walk = Walk::new([a, b], window, &options, tolerance, resolution);
    let mut search =
        Search { walk, wanted: tolerance, tolerance, spans: Vec::new(), now: window.start(), within: None };
    search.run()?;
    Ok(search.spans.into_iter().map(|span| span.with_tolerance(rounded.tolerance(span.tolerance))).collect())
}

/// What is known of the bodies where a search begins.
#[derive(Clone, Copy, Debug)]
enum Beginning {
    /// Nothing.
    Anywhere,
    /// They are proven further apart than the level.
    Above,
}

/// What is known of bodies that a search found near each other.
#[derive(Clone, Copy, Debug)]
enum Met {
    /// They are within the level at this time.
    Within(f64),
    /// Nothing shows that; how the next search begins.
    Unknown(Beginning),
}

struct Search<'a> {
    walk: Walk<'a>,
    /// That of the query, and of the level of the last contact.
    wanted: f64,
    tolerance: f64,
    spans: Vec<ContactSpan>,
    now: f64,
    /// The last time at which the bodies were proven within the level, or the start of a bracket with such a time.
    within: Option<f64>,
}

impl Search<'_> {
    fn run(&mut self) -> Result<(), QueryError> {
        let end = self.walk.window.end();
        let mut from = Beginning::Anywhere;
        loop {
            let found = match from {
                Beginning::Anywhere => self.walk.contact_from(self.now, end)?,
                Beginning::Above => self.walk.contact_from_above(self.now, end)?,
            };
            let Some(answer) = found else {
                self.push(end, SpanStatus::Undecided);
                return Ok(());
            };
            let contact = match answer {
                TimeOfContact::Separated => {
                    self.push(end, SpanStatus::Clear);
                    return Ok(());
                }
                TimeOfContact::Undecided { clear_until } => {
                    self.push(clear_until.next_down().min(end), SpanStatus::Clear);
                    self.push(end, SpanStatus::Undecided);
                    return Ok(());
                }
                TimeOfContact::Contact(contact) => contact,
            };
            if contact.start == StartState::Apart || contact.time_lo > self.now {
                self.push(contact.time_lo, SpanStatus::Clear);
            }
            self.set_level(&contact)?;
            let mut met = match self.meeting(&contact, from)? {
                Met::Within(time) => time,
                Met::Unknown(_) if self.now >= end => return Ok(()),
                Met::Unknown(next) => {
                    from = next;
                    continue;
                }
            };
            from = Beginning::Anywhere;
            loop {
                let next = self.walk.next(met)?;
                if let Next::Apart { last, .. } = next {
                    self.within = Some(last);
                }
                match next {
                    Next::End => {
                        self.push(end, SpanStatus::Contact);
                        return Ok(());
                    }
                    Next::Unknown { last } => {
                        self.push(last, SpanStatus::Contact);
                        self.push(end, SpanStatus::Undecided);
                        return Ok(());
                    }
                    Next::Within { last, at } => {
                        self.push(last, SpanStatus::Contact);
                        self.push(at, SpanStatus::Undecided);
                        met = at;
                    }
                    Next::Apart { last, at } if at - last <= self.walk.resolution => {
                        self.push(at, SpanStatus::Contact);
                        break;
                    }
                    Next::Apart { last, at } => {
                        self.push(last, SpanStatus::Contact);
                        self.push(at, SpanStatus::Undecided);
                        break;
                    }
                }
            }
        }
    }

    /// Where rounding raises the tolerance of a search, so it does the level of the contact that it found: a search from the end of the
    /// contact's bracket begins within that then.
    ///
    /// What a jump, or the resolution of time, leaves between bodies raises the tolerance of a contact as well. That is about its bracket, and
    /// says nothing of any time after it: it would be a level within which bodies far from each other stay.
    fn set_level(&mut self, contact: &Contact) -> Result<(), QueryError> {
        self.tolerance = self.wanted;
        if contact.tolerance > self.wanted
            && let Some(TimeOfContact::Contact(after)) =
                self.walk.contact_from(contact.time_hi, self.walk.window.end())?
            && after.start != StartState::Apart
        {
            self.tolerance = self.wanted.max(after.tolerance);
        }
        self.walk.level = self.walk.options.min_separation + self.tolerance;
        Ok(())
    }

    /// A time at which the bodies are within the level, from where a search found them near; where nothing shows one within the
    /// resolution, what is not known is a span of its own.
    ///
    /// Searches stop up to 3.3 tolerances above the separation: of bodies that part, the next one, from a time at which they are proven further
    /// apart than the level, must not stop there, or each of them would come no further than the least part of a resolution. Where a search of that
    /// kind stopped at once, as its tolerance was raised, the time goes on by the resolution.
    fn meeting(&mut self, contact: &Contact, from: Beginning) -> Result<Met, QueryError> {
        let (end, resolution) = (self.walk.window.end(), self.walk.resolution);
        let mut first = contact.time_lo;
        if contact.evidence > Evidence::Early {
            let [lo, hi] = [contact.time_lo, contact.time_hi];
            // The bracket proves it of one of its times, whether or not a given one does, unless that is a tolerance beyond the level's.
            let proves = contact.evidence == Evidence::Crossing || contact.tolerance <= self.tolerance;
            let is_single = lo == hi && proves;
            // What is in contact where the search begins is so long before a bracket that the search came to since.
            let times = if hi - lo > resolution { [lo, hi] } else { [hi, lo] };
            for time in times {
                if self.walk.is_within(time) {
                    return Ok(self.met_at(time));
                }
            }
            if is_single {
                return Ok(self.met_at(hi));
            }
            if proves && hi - lo <= resolution {
                self.push(hi, SpanStatus::Contact);
                self.within = Some(lo);
            }
            first = hi;
        }
        let least = match from {
            Beginning::Above if first <= self.now => 1.0,
            Beginning::Anywhere | Beginning::Above => power_of_two(-30),
        };
        let last = (first + resolution).max(first.next_up()).min(end);
        for part in [0.0, power_of_two(-30), power_of_two(-20), power_of_two(-10), 0.125, 0.5, 1.0] {
            let later = if part < 1.0 { (first + part * resolution).min(last) } else { last };
            if self.walk.is_within(later) {
                return Ok(self.met_at(later));
            }
            if part >= least && self.walk.is_apart(later)? {
                // Bodies that part are a little above the level for a while, still near a time of contact.
                let near = self.within.is_some_and(|within| later - within <= resolution);
                self.push(later, if near { SpanStatus::Contact } else { SpanStatus::Undecided });
                return Ok(Met::Unknown(Beginning::Above));
            }
        }
        self.push(last, SpanStatus::Undecided);
        Ok(Met::Unknown(Beginning::Anywhere))
    }

    /// Within the level at a time; what is more than the resolution before it is not known.
    fn met_at(&mut self, time: f64) -> Met {
        if time - self.now > self.walk.resolution {
            self.push(time, SpanStatus::Undecided);
        }
        Met::Within(time)
    }

    /// The span from where the last one ended; joined with that if nothing else is known of it. None of no length, but in a window of none.
    fn push(&mut self, to: f64, status: SpanStatus) {
        let from = self.now;
        if to < from || to == from && self.walk.window.length() > 0.0 {
            return;
        }
        #[cfg(feature = "audit")]
        if status == SpanStatus::Clear {
            let claimed = Claimed { from, to, distance: self.walk.options.min_separation };
            conclude_apart(Place::ClearSpan, &self.walk.bodies, claimed);
        }
        let tolerance = if status == SpanStatus::Contact { self.tolerance } else { self.wanted };
        match self.spans.last_mut() {
            Some(last) if last.status == status => {
                (last.to, last.tolerance) = (to, last.tolerance.max(tolerance));
            }
            _ => self.spans.push(ContactSpan { from, to, status, tolerance }),
        }
        self.now = to;
    }
}
