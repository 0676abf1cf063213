use super::build::{Built, Progress, build};
use super::node::WideNode;
use super::normal_cones::NormalCones;
use super::surface::Extent;
use crate::TriMesh;
use crate::mesh::{Adjacency, Closedness};
use crate::parallel::both_of_many;
use crate::solid::Solid;
use glam::DVec3;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// A triangle mesh with its tree of oriented boxes: a rigid body ready for queries.
///
/// Promise: every box of the tree encloses its triangles in real arithmetic, so no query can overlook a triangle.
///
/// ```
/// use d2m_mesh::{MeshTree, TriMesh};
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// assert_eq!(tree.mesh().triangle_count(), 4);
/// assert!(tree.radius() >= 0.5 * 2f64.sqrt());
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshTree {
    pub(crate) mesh: TriMesh,
    pub(crate) nodes: Vec<WideNode>,
    /// Body coordinates of the origin of local coordinates.
    pub(crate) center: DVec3,
    /// Power of two by which local coordinates are divided.
    pub(crate) unit: f64,
    /// Bound on |p − center| over the triangles, body units.
    pub(crate) radius: f64,
    pub(crate) watertight: bool,
    /// Does the surface agree about its outside, so that it has a winding number about every point?
    pub(crate) oriented: bool,
    /// Triangles that repeat an earlier one with the same orientation, ascending: not part of the surface.
    pub(crate) repeated: Vec<u32>,
    /// One vertex of each connected component.
    pub(crate) components: Vec<u32>,
    /// No two vertices have equal positions.
    distinct: bool,
    /// A number that no other tree of the process has; clones share it.
    pub(crate) id: TreeId,
    /// Computed by the first query that needs it; clones share it.
    adjacency: OnceLock<Arc<Adjacency>>,
    /// By the first query that is worth it.
    cones: OnceLock<Arc<NormalCones>>,
}

/// The number of a tree; two trees with the same number have the same bits.
///
/// ```
/// use d2m_mesh::{MeshTree, TriMesh};
/// use glam::DVec3;
/// let tree = MeshTree::new(TriMesh::point(DVec3::X)?);
/// assert!(tree.clone().id() == tree.id());
/// assert!(MeshTree::new(tree.mesh().clone()).id() != tree.id());
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TreeId(u64);

impl TreeId {
    fn next() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Self(COUNT.fetch_add(1, Ordering::Relaxed))
    }
}

#[cfg(feature = "audit")]
impl TreeId {
    /// The number.
    pub(crate) const fn number(self) -> u64 {
        self.0
    }
}

impl core::fmt::Debug for TreeId {
    /// Without the number, which says nothing about the tree.
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("TreeId")
    }
}

impl MeshTree {
    /// Builds the tree of a mesh. The same bits at any number of threads.
    pub fn new(mesh: TriMesh) -> Self {
        Self::build(mesh, None)
    }

    /// As [`Self::new`]; reports to `progress` how many triangles are done, and how many there are, about once every few
    /// thousand triangles, from any thread.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TriMesh};
    /// use glam::DVec3;
    /// use std::sync::atomic::{AtomicUsize, Ordering};
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// let most = AtomicUsize::new(0);
    /// let tree = MeshTree::with_progress(mesh, &|done, _all| {
    ///     most.fetch_max(done, Ordering::Relaxed);
    /// });
    /// assert_eq!(most.into_inner(), tree.mesh().triangle_count());
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub fn with_progress(mesh: TriMesh, progress: &(dyn Fn(usize, usize) + Sync)) -> Self {
        Self::build(mesh, Some(progress))
    }

    fn build(mesh: TriMesh, progress: Option<Progress<'_>>) -> Self {
        let count = mesh.triangle_count();
        let (closedness, Built { nodes, extent }) =
            both_of_many(count, || Closedness::of(&mesh), || build(&mesh, progress));
        Self::from_parts(mesh, nodes, &extent, closedness)
    }

    /// A tree from its boxes, and what is known of the mesh.
    pub(super) fn from_parts(
        mesh: TriMesh,
        nodes: Vec<WideNode>,
        extent: &Extent,
        closedness: Closedness,
    ) -> Self {
        let Closedness { watertight, oriented, repeated, components, distinct } = closedness;
        let Extent { center, radius, unit } = *extent;
        let id = TreeId::next();
        let (adjacency, cones) = (OnceLock::new(), OnceLock::new());
        Self {
            mesh,
            nodes,
            center,
            unit,
            radius,
            watertight,
            oriented,
            repeated,
            components,
            distinct,
            id,
            adjacency,
            cones,
        }
    }

    /// What [`Self::from_parts`] was given.
    pub(super) fn closedness(&self) -> Closedness {
        let Self { watertight, oriented, distinct, .. } = *self;
        let (repeated, components) = (self.repeated.clone(), self.components.clone());
        Closedness { watertight, oriented, repeated, components, distinct }
    }

    /// The mesh.
    #[inline]
    pub const fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Gives the mesh back.
    pub fn into_mesh(self) -> TriMesh {
        self.mesh
    }

    /// The center about which the body's coordinates are kept, body frame: the middle of its bounding box.
    #[inline]
    pub const fn center(&self) -> DVec3 {
        self.center
    }

    /// A bound on the distance of every point of the body from [`Self::center`]; at most √3 times the least one.
    #[inline]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// The power of two by which the stored boxes are divided: the least one that is not below the radius.
    #[inline]
    pub const fn unit(&self) -> f64 {
        self.unit
    }

    /// The nodes of the tree, see [`node`](crate::node): box 0 is the root.
    #[inline]
    pub fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    /// Which tree it is: clones have the same number, no other tree of the process has it.
    #[inline]
    pub const fn id(&self) -> TreeId {
        self.id
    }

    /// Does the surface close (each edge shared by an even number of triangles, as `Topology` counts them)?
    pub const fn is_watertight(&self) -> bool {
        self.watertight
    }

    /// What counts as the body where nobody says otherwise: it is filled if the surface closes.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, Solid, TriMesh};
    /// use glam::DVec3;
    /// let sheet = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(MeshTree::new(sheet).usual_solid(), Solid::Surface);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub const fn usual_solid(&self) -> Solid {
        if self.watertight { Solid::Filled } else { Solid::Surface }
    }

    /// One vertex of each connected part of the surface; equal positions connect.
    pub fn component_vertices(&self) -> &[u32] {
        &self.components
    }

    /// Neighbours of vertices and edges: computed by the first query that needs them, in O(n log n) time.
    pub(crate) fn adjacency(&self) -> &Adjacency {
        self.adjacency.get_or_init(|| Arc::new(Adjacency::new(&self.mesh)))
    }

    /// Cones of normals of the boxes: about a microsecond a triangle, once.
    pub(crate) fn normal_cones(&self) -> &NormalCones {
        let cones = || Arc::new(NormalCones::new(&self.mesh, &self.nodes, self.adjacency()));
        self.cones.get_or_init(cones)
    }

    /// Resident bytes: mesh, boxes, this structure, and the neighbours of vertices and edges once a query for
    /// proximities has computed them.
    pub fn memory_bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(self.mesh.vertices())
            + size_of_val(self.mesh.triangles())
            + size_of_val(self.nodes.as_slice())
            + self.adjacency.get().map_or(0, |adjacency| adjacency.memory_bytes())
            + self.cones.get().map_or(0, |cones| cones.memory_bytes())
    }
}
