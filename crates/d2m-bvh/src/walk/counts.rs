//! How much a query has done.

/// An answer and what it took to find it.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Answered, Moving, QueryOptions, Window, time_of_contact_counted};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let Answered { answer, work } = time_of_contact_counted(a, b, Window::UNIT, &QueryOptions::default())?;
/// assert!(answer.contact().is_some() && work.work() > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Answered<T> {
    /// The answer.
    pub answer: T,
    /// All that was done for it.
    pub work: SearchCounts,
}

/// Counts of the work of one query, for profiles: the same on every machine.
///
/// ```
/// # use d2m_bvh::{MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact_counted};
/// # use d2m_motion::ConstantTwist;
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?);
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let ask = || time_of_contact_counted(a, b, Window::UNIT, &QueryOptions::default());
/// let work = ask()?.work;
/// assert!(work.windows >= 1 && work.work() >= work.node_tests);
/// assert_eq!(work, ask()?.work); // the same each time, and on every machine
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SearchCounts {
    /// Sub-windows that were searched.
    pub windows: u64,
    /// Batches handed out by the queue.
    pub frames: u64,
    /// Wide nodes that were expanded against a box.
    pub node_tests: u64,
    /// Pairs of boxes that were queued.
    pub queued: u64,
    /// Separating-axis tests of pairs of triangles.
    pub triangle_looks: u64,
    /// Attempts to skip time by swept volumes or a common screw.
    pub sweeps: u64,
    /// Pairs of parts that were compared for that.
    pub swept_pairs: u64,
}

impl SearchCounts {
    /// All in node tests, as a [`Budget`](crate::Budget) counts them.
    pub const fn work(&self) -> u64 {
        self.node_tests + self.triangle_looks + self.swept_pairs
    }

    /// With what `other` adds.
    pub(crate) fn with(&self, other: &Self) -> Self {
        self.combined(other, u64::wrapping_add)
    }

    /// Without what was counted by `earlier`.
    #[cfg(feature = "rayon")]
    pub(crate) fn without(&self, earlier: &Self) -> Self {
        self.combined(earlier, u64::wrapping_sub)
    }

    fn combined(&self, other: &Self, op: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            windows: op(self.windows, other.windows),
            frames: op(self.frames, other.frames),
            node_tests: op(self.node_tests, other.node_tests),
            queued: op(self.queued, other.queued),
            triangle_looks: op(self.triangle_looks, other.triangle_looks),
            sweeps: op(self.sweeps, other.sweeps),
            swept_pairs: op(self.swept_pairs, other.swept_pairs),
        }
    }
}
