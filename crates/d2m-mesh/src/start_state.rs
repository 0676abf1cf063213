/// How bodies stand at an instant: at rest, or at the start of the window of a query of moving ones.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, Solid, StartState, distance};
/// use d2m_motion::Pose;
/// let at = |x: f64| Posed::new(&tree, Pose { translation: DVec3::X * x, ..Pose::IDENTITY });
/// assert_eq!(distance(at(0.0), at(2.0), Solid::Filled)?.state, StartState::Apart);
/// assert_eq!(distance(at(0.0), at(0.5), Solid::Filled)?.state, StartState::Overlapping);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum StartState {
    /// Disjoint, and further apart than `min_separation`. `time_lo` is the start of the window all the same where the
    /// bodies meet before the next number for a time.
    #[default]
    Apart,
    /// Within `separation` of each other, which is at most 3.3 tolerances above `min_separation`. Where the surfaces are not proven
    /// apart, this is: the second body, moved by a few roundings along the normal, is proven apart from the first; and for poses that only
    /// shift the bodies, whose numbers are exact, their insides share no point. The normal is that of the features that touch, where
    /// they have one.
    Touching,
    /// Proven: the insides share a point (of surfaces: they cross), up to the rounding of the poses at the start;
    /// `Evidence::Crossing` of a contact says that the motions themselves prove it.
    Overlapping,
    /// The surfaces do not cross and one body lies inside the other (only with `Solid::Filled`).
    Contained,
    /// The surfaces are not proven apart, no direction is found along which they part, and no point inside of both: a peg that fits its
    /// hole exactly, say, or an overlap within rounding.
    Undecided,
}
