/// What counts as contact.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, Solid, collide};
/// // A small tetrahedron inside of another one.
/// let small = vertices.iter().map(|p| *p * 0.1 + 0.1).collect();
/// let small = MeshTree::new(TriMesh::try_new(small, faces)?);
/// let [outer, inner] = [Posed::at_rest(&tree), Posed::at_rest(&small)];
/// assert!(collide(outer, inner, Solid::Filled)?);
/// assert!(!collide(outer, inner, Solid::Surface)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum Solid {
    /// The bodies are solid: a body inside the other is in contact. For watertight meshes.
    ///
    /// A point is in the solid where the winding number of the surface about it is not zero. So parts that overlap are
    /// solid where they overlap, a part that is inside out is solid, and a cavity is a part inside another one with
    /// the opposite orientation; equal triangles with equal orientation count once, with opposite orientation they cancel.
    /// Where faces disagree about the outside there is no winding number, and the parity of the crossings of a ray decides.
    #[default]
    Filled,
    /// Only the surfaces count: open meshes, polygon soup, hollow shells.
    Surface,
}

/// The same meaning of both bodies.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces)?);
/// use d2m_mesh::{Posed, Solid, collide};
/// // One triangle inside of a solid, which has it, whatever it is itself.
/// let inside = vertices[1..].iter().map(|p| *p * 0.1 + 0.1).collect();
/// let sheet = MeshTree::new(TriMesh::try_new(inside, vec![[0, 1, 2]])?);
/// let [solid, sheet] = [Posed::at_rest(&tree), Posed::at_rest(&sheet)];
/// assert!(collide(solid, sheet, [Solid::Filled, Solid::Surface])?);
/// assert!(!collide(solid, sheet, Solid::Surface)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl From<Solid> for [Solid; 2] {
    fn from(solid: Solid) -> Self {
        [solid; 2]
    }
}
