//! Meshes and trees of the product, as the bench builds them.
use d2m::bvh::{MeshTree, TriMesh};

/// An embedded shape by its text form.
pub(crate) fn shape(text: &str) -> Result<TriMesh, Box<dyn std::error::Error>> {
    Ok(d2m::shapes::mesh(text)?)
}

/// The default engine's tree.
pub(crate) fn build(mesh: TriMesh) -> MeshTree {
    MeshTree::new(mesh)
}
