//! Meshes and their trees.

use crate::arrays::{Doubles, rows, triangles, vector};
use crate::fault::{Fault, OrRaise};
use crate::supervise::pool;
use d2m::bvh::{MeshTree, TriMesh, Validation};
use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString, PyTuple};
use std::sync::Arc;

/// A triangle mesh in its body frame, checked once and immutable.
///
/// `Mesh(vertices, faces)` takes arrays of shape (n, 3) and (m, 3): vertices of any float type (rounded to the nearest
/// double) or whole type, faces of any whole type. `Mesh(mesh)` takes an object with `vertices` and `faces`, such as one of trimesh,
/// and `Mesh(path)` a file (.obj, .off, .stl, .ply, .gltf, .glb, .dae, .3mf, .d2mtree) or an embedded shape such as "shape:torus"
/// (`shapes()` lists them). Lengths are in any unit. Open meshes, soups, degenerate and duplicate triangles are fine.
///
/// Raises `InputError` with index and value: no triangles, a coordinate that is not finite or beyond 1e60, an index out of
/// range, another shape or dtype, a whole number that is no double.
///
/// >>> import d2m_ccd
/// >>> mesh = d2m_ccd.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
/// >>> mesh
/// Mesh(4 vertices, 4 triangles, watertight)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Mesh {
    pub(crate) mesh: Arc<TriMesh>,
    watertight: bool,
}

impl Mesh {
    fn of(mesh: TriMesh) -> Self {
        let watertight = d2m::bvh::Topology::new(&mesh).is_watertight();
        Self { mesh: Arc::new(mesh), watertight }
    }
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, faces=None))]
    fn new(vertices: &Bound<'_, PyAny>, faces: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        match geometry(vertices, faces)? {
            Geometry::Mesh(mesh) => Ok(Self::of(mesh)),
            Geometry::Tree(tree) => Ok(Self::of(tree.into_mesh())),
        }
    }

    /// The vertices, a copy of shape (n, 3).
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.mesh.vertices().iter().map(DVec3::to_array))
    }

    /// The triangles as vertex numbers, a copy of shape (m, 3).
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, self.mesh.triangles().iter().copied())
    }

    /// How many vertices there are.
    #[getter]
    fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }

    /// How many triangles there are.
    #[getter]
    fn triangle_count(&self) -> usize {
        self.mesh.triangle_count()
    }

    /// Does every edge carry an even number of triangles, so that the mesh bounds a solid?
    #[getter]
    const fn is_watertight(&self) -> bool {
        self.watertight
    }

    /// Counts of what is unusual (degenerate and duplicate triangles, boundary edges, …), volume, area and bounds.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Mesh("shape:box").validate()["boundary_edges"]
    /// 0
    fn validate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = py.detach(|| Validation::new(&self.mesh));
        let dict = PyDict::new(py);
        dict.set_item("degenerate_triangles", found.degenerate_triangles)?;
        dict.set_item("duplicate_triangles", found.duplicate_triangles)?;
        dict.set_item("duplicate_vertices", found.duplicate_vertices)?;
        dict.set_item("unused_vertices", found.unused_vertices)?;
        dict.set_item("boundary_edges", found.boundary_edges)?;
        dict.set_item("non_manifold_edges", found.non_manifold_edges)?;
        dict.set_item("inconsistent_edges", found.inconsistent_edges)?;
        dict.set_item("pinched_vertices", found.pinched_vertices)?;
        dict.set_item("components", found.components)?;
        dict.set_item("euler_characteristic", found.euler_characteristic)?;
        dict.set_item("watertight", found.watertight)?;
        dict.set_item("consistently_oriented", found.consistently_oriented)?;
        dict.set_item("signed_volume", found.signed_volume)?;
        dict.set_item("area", found.area)?;
        dict.set_item("bounds", rows(py, [found.bounds_low, found.bounds_high].into_iter())?)?;
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        describe("Mesh", &self.mesh, self.watertight)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, mesh) = (slf.py(), slf.get());
        (slf.get_type(), (mesh.vertices(py)?, mesh.faces(py)?)).into_pyobject(py)
    }
}

fn describe(class: &str, mesh: &TriMesh, watertight: bool) -> String {
    let closed = if watertight { "watertight" } else { "open" };
    format!("{class}({} vertices, {} triangles, {closed})", mesh.vertex_count(), mesh.triangle_count())
}

/// A mesh with its tree of oriented boxes: a rigid body ready for queries.
///
/// Takes what `Mesh` takes, or a `Mesh`. Building takes about a microsecond a triangle; the tree is immutable, may be
/// shared by any number of threads, and pickles by `to_bytes`.
///
/// Raises `InputError` as `Mesh` does.
///
/// >>> import d2m_ccd, pickle
/// >>> tree = d2m_ccd.Tree("shape:box")
/// >>> tree
/// Tree(8 vertices, 12 triangles, watertight)
/// >>> pickle.loads(pickle.dumps(tree)).to_bytes() == tree.to_bytes()
/// True
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Tree {
    pub(crate) tree: Arc<MeshTree>,
}

#[pymethods]
impl Tree {
    #[new]
    #[pyo3(signature = (mesh, faces=None))]
    fn new(py: Python<'_>, mesh: &Bound<'_, PyAny>, faces: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        Ok(Self { tree: new_tree(py, mesh, faces)? })
    }

    /// The tree that `to_bytes` has written.
    ///
    /// Raises `InputError` for other bytes, bytes that were changed, and forged ones that are no tree.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Tree.from_bytes(d2m_ccd.Tree("shape:box").to_bytes()).triangle_count
    /// 12
    #[staticmethod]
    fn from_bytes(py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let tree = py.detach(|| pool(None)?.install(|| MeshTree::try_from_bytes(data).map_err(Fault::from)));
        Ok(Self { tree: Arc::new(tree.or_raise()?) })
    }

    /// The tree as bytes, the same on every platform; `from_bytes` makes the same tree of them, bit for bit.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Tree("shape:box").to_bytes()[:7]
    /// b'd2mtree'
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| self.tree.to_bytes()))
    }

    /// The mesh, a copy.
    #[getter]
    fn mesh(&self) -> Mesh {
        let watertight = self.tree.is_watertight();
        Mesh { mesh: Arc::new(self.tree.mesh().clone()), watertight }
    }

    /// How many triangles there are.
    #[getter]
    fn triangle_count(&self) -> usize {
        self.tree.mesh().triangle_count()
    }

    /// Does every edge carry an even number of triangles, so that the mesh bounds a solid?
    #[getter]
    fn is_watertight(&self) -> bool {
        self.tree.is_watertight()
    }

    /// The middle of the bounding box, body frame, shape (3,).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.tree.center().to_array())
    }

    /// A bound on the distance of every point of the body from `center`.
    #[getter]
    fn radius(&self) -> f64 {
        self.tree.radius()
    }

    fn __repr__(&self) -> String {
        describe("Tree", self.tree.mesh(), self.tree.is_watertight())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        (slf.get_type().getattr(intern!(py, "from_bytes"))?, (slf.get().to_bytes(py),)).into_pyobject(py)
    }
}

/// What a mesh argument holds.
enum Geometry {
    Mesh(TriMesh),
    Tree(Box<MeshTree>),
}

fn geometry(mesh: &Bound<'_, PyAny>, faces: Option<&Bound<'_, PyAny>>) -> PyResult<Geometry> {
    let py = mesh.py();
    if let Some(faces) = faces {
        return Ok(Geometry::Mesh(mesh_of_arrays(mesh, faces)?));
    }
    if let Ok(mesh) = mesh.cast::<Mesh>() {
        return Ok(Geometry::Mesh((*mesh.get().mesh).clone()));
    }
    if let Ok(tree) = mesh.cast::<Tree>() {
        return Ok(Geometry::Tree(Box::new((*tree.get().tree).clone())));
    }
    if mesh.is_instance_of::<PyString>() || mesh.hasattr(intern!(py, "__fspath__"))? {
        return crate::files::load(mesh).map(|mesh| match mesh {
            crate::files::Loaded::Mesh(mesh) => Geometry::Mesh(mesh),
            crate::files::Loaded::Tree(tree) => Geometry::Tree(tree),
        });
    }
    match (mesh.getattr_opt(intern!(py, "vertices"))?, mesh.getattr_opt(intern!(py, "faces"))?) {
        (Some(vertices), Some(faces)) => Ok(Geometry::Mesh(mesh_of_arrays(&vertices, &faces)?)),
        _ => Err(pyo3::exceptions::PyTypeError::new_err(format!(
            "{} is no mesh: arrays of vertices and faces, an object that has them, or a path is expected",
            mesh.get_type().name()?
        ))),
    }
}

fn mesh_of_arrays(vertices: &Bound<'_, PyAny>, faces: &Bound<'_, PyAny>) -> PyResult<TriMesh> {
    let numbers = Doubles::new(vertices, "vertices", &[None, Some(3)])?;
    let corners = numbers.slice().as_chunks::<3>().0.iter().copied().map(DVec3::from_array).collect();
    TriMesh::try_new(corners, triangles(faces, "faces")?).or_raise()
}

/// The tree of whatever `Tree` takes; that of a `Tree` itself is shared.
fn new_tree(
    py: Python<'_>,
    mesh: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
) -> PyResult<Arc<MeshTree>> {
    if let (Ok(tree), None) = (mesh.cast::<Tree>(), faces) {
        return Ok(Arc::clone(&tree.get().tree));
    }
    match geometry(mesh, faces)? {
        Geometry::Tree(tree) => Ok(Arc::from(tree)),
        Geometry::Mesh(mesh) => {
            let tree = py.detach(|| Ok::<_, Fault>(pool(None)?.install(|| MeshTree::new(mesh))));
            Ok(Arc::new(tree.or_raise()?))
        }
    }
}

/// The tree of an argument for a body; a tree is built of what is none.
pub(crate) fn tree_argument(any: &Bound<'_, PyAny>) -> PyResult<Arc<MeshTree>> {
    new_tree(any.py(), any, None)
}
