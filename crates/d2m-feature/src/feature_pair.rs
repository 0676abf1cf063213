/// Which features of two triangle meshes meet, by ids in the meshes.
///
/// Edges are named by their two vertices, the smaller id first. A contact at a vertex or along an edge is reported
/// as one of the feature pairs that contain it.
///
/// ```
/// use d2m_feature::FeaturePair;
/// let meeting = FeaturePair::EdgeEdge { edge_a: [3, 7], edge_b: [0, 1] }; // by the ids of their vertices
/// assert!(matches!(meeting, FeaturePair::EdgeEdge { edge_a: [3, _], .. }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FeaturePair {
    /// A vertex of A against a triangle of B.
    VertexFace {
        /// Vertex of A.
        vertex: u32,
        /// Triangle of B.
        face: u32,
    },
    /// A triangle of A against a vertex of B.
    FaceVertex {
        /// Triangle of A.
        face: u32,
        /// Vertex of B.
        vertex: u32,
    },
    /// An edge of A against an edge of B.
    EdgeEdge {
        /// Vertices of the edge of A.
        edge_a: [u32; 2],
        /// Vertices of the edge of B.
        edge_b: [u32; 2],
    },
}
