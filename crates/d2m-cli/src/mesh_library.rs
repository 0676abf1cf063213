//! The meshes that a scene file names, each read once.

use crate::failure::Failure;
use crate::load::{Loaded, load_with};
use d2m::bvh::MeshTree;
use d2m_io::ReadOptions;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Trees by mesh and scale: bodies with the same share one.
#[derive(Debug)]
pub(crate) struct MeshLibrary {
    folder: PathBuf,
    trees: BTreeMap<(String, [u64; 3]), Arc<MeshTree>>,
}

impl MeshLibrary {
    /// Meshes are named relative to the folder of the scene file.
    pub(crate) fn new(scene: &Path) -> Self {
        Self { folder: scene.parent().unwrap_or(Path::new("")).to_owned(), trees: BTreeMap::new() }
    }

    /// The mesh of a file or `shape:…`, scaled.
    pub(crate) fn mesh(&self, mesh: &str, scale: DVec3) -> Result<Loaded, Failure> {
        let source = if mesh.starts_with("shape:") {
            mesh.to_owned()
        } else {
            self.folder.join(mesh).to_string_lossy().into_owned()
        };
        load_with(&source, &ReadOptions::new().with_scale(scale))
    }

    /// The tree of such a mesh.
    pub(crate) fn tree(&mut self, mesh: &str, scale: DVec3) -> Result<Arc<MeshTree>, Failure> {
        let key = (mesh.to_owned(), scale.to_array().map(f64::to_bits));
        if let Some(tree) = self.trees.get(&key) {
            return Ok(Arc::clone(tree));
        }
        let tree = Arc::new(self.mesh(mesh, scale)?.into_tree());
        self.trees.insert(key, Arc::clone(&tree));
        Ok(tree)
    }
}
