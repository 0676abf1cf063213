use crate::{Budget, Solid};

/// δ as a part of the larger body's radius, if none is given.
const DEFAULT_TOLERANCE: f64 = 1e-10;

/// How far a query goes.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Mode, Moving, QueryOptions, Window, time_of_contact};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let ask = |mode| time_of_contact(a, b, Window::UNIT, &QueryOptions::default().with_mode(mode));
/// let accurate = *ask(Mode::Accurate)?.contact().expect("they meet");
/// assert!(accurate.time_lo <= 0.25 && accurate.time_lo > 0.25 - 1e-9);
/// let early = *ask(Mode::Capoeira)?.contact().expect("they meet");
/// assert!(early.time_lo <= 0.25); // proven free until there, too; not how near that is to the contact
/// assert!(ask(Mode::Exists)?.contact().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Mode {
    /// The time of contact to the tolerance.
    #[default]
    Accurate,
    /// Early stop at the first pair of triangles that come as close as their own size. `time_lo` is certified as
    /// always: no contact before. The contact itself is not: its evidence is [`Evidence::Early`](crate::Evidence::Early),
    /// and bodies that pass each other so closely without touching are reported too. The distance left at `time_lo` is
    /// the `separation` of the answer: above `min_separation` by at most the sum of the radii of the two triangles' boxes, for
    /// motions whose twists are not constant a fifteenth more of that, or by 3.3 tolerances.
    Capoeira,
    /// Only whether there is a contact: the answer may be any time of contact, and nothing is promised about the time
    /// before it. What is proven of the meeting is said by the contact's `evidence`, as in every mode.
    Exists,
}

/// What counts of bodies that are in contact at the start of the window.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, Start, StartState, Window, time_of_contact};
/// use d2m_motion::ConstantTwist;
/// // Stands on the tip of the other one, and is lifted.
/// let lifted = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z);
/// let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &lifted)];
/// let options = QueryOptions::default();
/// let found = time_of_contact(a, b, Window::UNIT, &options)?;
/// assert!(found.contact().is_some_and(|contact| contact.start != StartState::Apart));
/// assert!(time_of_contact(a, b, Window::UNIT, &options.with_start(Start::Leave))?.is_separated());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Start {
    /// It is the answer.
    #[default]
    Report,
    /// It counts no more once the bodies are proven further apart than `min_separation` + δ for the first time: the answer is the first
    /// contact after that, with [`Contact::left`](crate::Contact::left). Bodies that never part are in contact from the start. See
    /// [`departure`](crate::departure).
    Leave,
}

/// Options of a query.
///
/// ```
/// use d2m_bvh::{Mode, QueryOptions, Solid};
/// let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(1e-6);
/// assert_eq!(options.tolerance, Some(1e-6));
/// assert_eq!(options.mode, Mode::Accurate);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
#[must_use]
pub struct QueryOptions {
    /// δ, a distance in the scene's units. `None`: 1e-10 times the scene's length scale, the larger of the radii of
    /// the two bodies about their own centers.
    pub tolerance: Option<f64>,
    /// What counts as contact.
    pub solid: Solid,
    /// How far the query goes.
    pub mode: Mode,
    /// Limits on the work.
    pub budget: Budget,
    /// Report the first time at which the distance is at most this, a length in the scene's units. Zero: contact. The
    /// search stops at a distance of up to this plus 3.3 tolerances; see [`Contact`](crate::Contact).
    pub min_separation: f64,
    /// What counts of bodies that are in contact at the start.
    pub start: Start,
    /// Search spans of time side by side, on all threads of the current rayon pool (feature `rayon`). The answer has the
    /// same bits at any number of threads. Of use for queries of more than about a millisecond with much
    /// rotation (a span is 0.3 radians of both bodies together); those that are shorter do not notice it.
    pub parallel: bool,
    /// Set where the level is a little below the least distance of the bodies: many pairs pass close to it, and neither planes between
    /// crowds of them nor swept volumes prove them apart. Triangles of A and of B that are about the closest at the start: most pairs
    /// that are close are apart along the line between these two.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) grazing: Option<[u32; 2]>,
}

impl QueryOptions {
    /// Default options: accurate, filled solids, tolerance 1e-10 of the scene's length scale, no budget.
    pub const DEFAULT: Self = Self {
        tolerance: None,
        solid: Solid::Filled,
        mode: Mode::Accurate,
        budget: Budget::UNLIMITED,
        min_separation: 0.0,
        start: Start::Report,
        parallel: false,
        grazing: None,
    };

    /// With this tolerance δ, a distance.
    pub const fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    /// With this meaning of contact.
    pub const fn with_solid(mut self, solid: Solid) -> Self {
        self.solid = solid;
        self
    }

    /// With this mode.
    pub const fn with_mode(mut self, mode: Mode) -> Self {
        self.mode = mode;
        self
    }

    /// With this budget.
    pub const fn with_budget(mut self, budget: Budget) -> Self {
        self.budget = budget;
        self
    }

    /// With this separation that counts as contact.
    pub const fn with_min_separation(mut self, distance: f64) -> Self {
        self.min_separation = distance;
        self
    }

    /// With this treatment of bodies that are in contact at the start.
    pub const fn with_start(mut self, start: Start) -> Self {
        self.start = start;
        self
    }

    /// δ of two bodies of which the larger one has this radius, about its own center and with what it has around its mesh: the
    /// given one, or 1e-10 times the radius. What is given is not checked here. Bodies whose distance at the start is at most the minimum
    /// separation plus this are in contact there; a pair whose places round by more has a larger tolerance ([`Contact`](crate::Contact)).
    ///
    /// ```
    /// use d2m_bvh::QueryOptions;
    /// assert_eq!(QueryOptions::default().tolerance_of(2.0), 2e-10);
    /// assert_eq!(QueryOptions::default().with_tolerance(0.5).tolerance_of(2.0), 0.5);
    /// ```
    pub fn tolerance_of(&self, radius: f64) -> f64 {
        self.tolerance.unwrap_or(DEFAULT_TOLERANCE * radius)
    }

    /// On all threads of the current rayon pool, or on one.
    pub const fn with_parallel(mut self, parallel: bool) -> Self {
        self.parallel = parallel;
        self
    }
}
