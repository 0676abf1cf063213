//! A tree from parts that came from elsewhere.

use super::mesh_tree::MeshTree;
use super::node::{Below, OrientedBox, WIDTH, WideNode};
use super::surface::{Extent, unit_of};
use super::tree_error::TreeError;
use super::validate::ClaimedTree;
use crate::TriMesh;
use crate::mesh::Closedness;
use crate::parallel::both;
use glam::DVec3;

/// A wide node, below no other so far. Not more than [`WIDTH`] boxes, none with a number of [`LEAF`] or more below it.
///
/// [`LEAF`]: super::node::LEAF
pub(super) fn node_of_parts(origin: [f32; 3], boxes: impl Iterator<Item = (OrientedBox, Below)>) -> WideNode {
    let mut node = WideNode::empty(origin, 0);
    for (lane, (boxed, below)) in boxes.take(WIDTH).enumerate() {
        node.used = lane as u32 + 1;
        node.set_box(lane, &boxed);
        node.set_below(lane, below);
    }
    node
}

/// Links the nodes and checks every promise of the tree.
pub(super) fn tree_of_parts(
    mesh: TriMesh,
    mut nodes: Vec<WideNode>,
    center: DVec3,
    radius: f64,
) -> Result<MeshTree, TreeError> {
    for index in 0..nodes.len() {
        for lane in 0..nodes[index].used as usize {
            if let Below::Node(child) = nodes[index].below(lane) {
                let child = child as usize;
                let below = nodes.get_mut(child).ok_or(TreeError::Link { node: child })?;
                below.parent = (index * WIDTH + lane) as u32;
            }
        }
    }
    let extent = Extent { center, radius, unit: unit_of(radius) };
    let claimed = ClaimedTree { mesh: &mesh, nodes: &nodes, extent };
    let (checked, closedness) = both(|| claimed.check(), || Closedness::of(&mesh));
    checked?;
    Ok(MeshTree::from_parts(mesh, nodes, &extent, closedness))
}
