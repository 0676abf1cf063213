//! Meshes for JavaScript: checked, and with their trees.

use d2m::bvh::{MeshTree, TriMesh};
use d2m::shapes::Shape;
use d2m_io::{MeshFormat, ReadOptions, parse_mesh};
use glam::DVec3;
use js_sys::Error;
use std::path::Path;
use wasm_bindgen::prelude::wasm_bindgen;

/// Triangles of one mesh. A tree of them and what builds it need less than the 4 GiB that a page's memory can have; memory that runs out
/// would end the program, which no error could state.
const MOST_TRIANGLES: usize = 4_000_000;

/// A triangle mesh with its tree: built once, for any number of queries.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Mesh {
    pub(crate) tree: MeshTree,
}

impl Mesh {
    fn checked(mesh: TriMesh) -> Result<Self, String> {
        few(mesh.triangle_count())?;
        Ok(Self { tree: MeshTree::new(mesh) })
    }

    /// Of coordinates, three a vertex, and of indices of vertices, three a triangle.
    pub(crate) fn of_arrays(positions: &[f64], triangles: &[u32]) -> Result<Self, String> {
        for (what, length) in [("positions", positions.len()), ("triangles", triangles.len())] {
            if length % 3 != 0 {
                return Err(format!("{what}: the length {length} is no multiple of three"));
            }
        }
        few(triangles.len() / 3)?;
        let vertices = positions.as_chunks().0.iter().copied().map(DVec3::from_array).collect();
        let mesh = TriMesh::try_new(vertices, triangles.as_chunks().0.to_vec());
        Self::checked(mesh.map_err(|error| error.to_string())?)
    }

    /// Of the text form of a shape.
    pub(crate) fn of_shape(text: &str) -> Result<Self, String> {
        let text = text.strip_prefix("shape:").unwrap_or(text);
        let shape: Shape = text.parse().map_err(|error: d2m::shapes::ShapeError| error.to_string())?;
        few(shape.value("triangles").unwrap_or_default() as usize)?;
        Self::checked(shape.build())
    }

    /// Of the bytes of a file.
    pub(crate) fn of_bytes(bytes: &[u8], name: &str) -> Result<Self, String> {
        let format = MeshFormat::from_path(Path::new(name))
            .ok_or_else(|| format!("{name}: unknown kind of mesh: expected {}", MeshFormat::EXTENSIONS))?;
        let read =
            parse_mesh(bytes, format, &ReadOptions::new()).map_err(|error| error.in_file(name).to_string());
        Self::checked(read?.mesh)
    }
}

fn few(count: usize) -> Result<(), String> {
    if count <= MOST_TRIANGLES {
        return Ok(());
    }
    Err(format!("the mesh has {count} triangles: a page has memory for {MOST_TRIANGLES}"))
}

fn thrown<T>(result: Result<T, String>) -> Result<T, Error> {
    result.map_err(|reason| Error::new(&reason))
}

#[wasm_bindgen]
impl Mesh {
    /// A mesh of coordinates (x, y, z of each vertex) and of triangles (three indices of vertices each).
    ///
    /// # Errors
    /// Throws an `Error` that names the array, or index and value: coordinates that are not finite, indices out of range, no triangles.
    #[wasm_bindgen(constructor)]
    pub fn new(positions: &[f64], triangles: &[u32]) -> Result<Self, Error> {
        thrown(Self::of_arrays(positions, triangles))
    }

    /// A built-in shape such as `"gear?teeth=24"`, with or without the command's `shape:` in front.
    ///
    /// # Errors
    /// Throws an `Error`: no such shape or parameter, or a value out of its range.
    pub fn shape(text: &str) -> Result<Self, Error> {
        thrown(Self::of_shape(text))
    }

    /// The mesh of a file's bytes; its name's extension says the format (`.obj`, `.stl`, `.ply`, `.off`, `.gltf`, `.glb`, `.dae`, `.3mf`).
    ///
    /// # Errors
    /// Throws an `Error` that names the file, line or index, and the value found.
    pub fn parse(bytes: &[u8], name: &str) -> Result<Self, Error> {
        thrown(Self::of_bytes(bytes, name))
    }

    /// Number of triangles.
    #[wasm_bindgen(getter, js_name = triangleCount)]
    pub fn triangle_count(&self) -> usize {
        self.tree.mesh().triangle_count()
    }

    /// Does the mesh bound a solid?
    #[wasm_bindgen(getter, js_name = isWatertight)]
    pub fn is_watertight(&self) -> bool {
        self.tree.is_watertight()
    }

    /// Coordinates: x, y, z of each vertex.
    pub fn positions(&self) -> Vec<f64> {
        self.tree.mesh().vertices().iter().flat_map(DVec3::to_array).collect()
    }

    /// Indices of vertices: three of each triangle, in the order in which answers number the triangles.
    pub fn triangles(&self) -> Vec<u32> {
        self.tree.mesh().triangles().as_flattened().to_vec()
    }
}
