use crate::CancelFlag;
use core::time::Duration;

/// Limits on the work of one query. A query that meets one answers so: `Undecided`, or what it has proven until then.
///
/// Without limits a query still ends: the hard caps [`Budget::HARD_NODE_TESTS`] on its work and
/// [`Budget::HARD_QUEUED_PAIRS`] on its memory apply always, too.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Budget, Posed, Solid, bound_distance};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 2.0, ..Pose::IDENTITY });
/// let budget = Budget::UNLIMITED.with_node_tests(1);
/// let bounds = bound_distance(Posed::at_rest(&tree), above, Solid::Filled, &budget)?;
/// assert!(bounds.distance.is_none()); // one step is too few
/// assert!(bounds.lower <= 1.0 && 1.0 <= bounds.upper); // what was proven until then holds
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[non_exhaustive]
#[must_use]
pub struct Budget {
    /// Most node tests (one node against the children of another, or one step of a triangle pair).
    pub node_tests: Option<u64>,
    /// Most time on the clock. Read every few hundred node tests, so a query may exceed it by about 50 µs.
    pub wall_clock: Option<Duration>,
    /// Ends the query from another thread; read as often as the clock.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub cancel: Option<CancelFlag>,
}

impl Budget {
    /// The cap on node tests that holds without any budget: about a minute of work.
    pub const HARD_NODE_TESTS: u64 = 1 << 30;
    /// The cap on pairs of boxes that wait in the queue of a search, besides some 2¹⁵ between two checks of it. A
    /// pair takes 16 bytes; with room that is kept for more, a search stays below 100 MB.
    pub const HARD_QUEUED_PAIRS: usize = 1 << 20;
    /// No limit but the hard caps.
    pub const UNLIMITED: Self = Self { node_tests: None, wall_clock: None, cancel: None };

    /// At most `count` node tests.
    pub const fn with_node_tests(mut self, count: u64) -> Self {
        self.node_tests = Some(count);
        self
    }

    /// At most `time` on the clock.
    pub const fn with_wall_clock(mut self, time: Duration) -> Self {
        self.wall_clock = Some(time);
        self
    }

    /// Until somebody cancels.
    pub const fn with_cancel(mut self, flag: CancelFlag) -> Self {
        self.cancel = Some(flag);
        self
    }

    /// Is there a limit of node tests or of time?
    pub const fn is_limited(&self) -> bool {
        self.node_tests.is_some() || self.wall_clock.is_some()
    }
}
