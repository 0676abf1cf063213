//! Meshes from files, from saved trees and from embedded shapes.

use crate::fault::{Fault, OrRaise};
use crate::supervise::pool;
use d2m::bvh::{MeshTree, TriMesh};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// What a path names.
pub(crate) enum Loaded {
    /// A mesh.
    Mesh(TriMesh),
    /// A mesh with its tree.
    Tree(Box<MeshTree>),
}

/// Loads `shape:…` or a file by its extension.
pub(crate) fn load(source: &Bound<'_, PyAny>) -> PyResult<Loaded> {
    if let Some(shape) =
        source.extract::<String>().ok().as_deref().and_then(|text| text.strip_prefix("shape:"))
    {
        return Ok(Loaded::Mesh(d2m::shapes::mesh(shape).or_raise()?));
    }
    let path: PathBuf = source.extract()?;
    source.py().detach(|| load_file(&path)).or_raise()
}

fn load_file(path: &Path) -> Result<Loaded, Fault> {
    let at = |reason: String| Fault::new(format!("{}: {reason}", path.display()));
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if extension == "d2mtree" {
        let bytes = std::fs::read(path).map_err(|error| at(error.to_string()))?;
        let tree = pool(None)?.install(|| MeshTree::try_from_bytes(&bytes));
        return Ok(Loaded::Tree(Box::new(tree.map_err(|error| at(error.to_string()))?)));
    }
    let read = d2m_io::read_mesh(path).map_err(|error| Fault::new(error.to_string()))?;
    Ok(Loaded::Mesh(read.mesh))
}
