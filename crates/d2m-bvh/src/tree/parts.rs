//! A tree from parts that came from elsewhere.

use super::mesh_tree::MeshTree;
use super::node::{Below, LEAF, OrientedBox, WIDTH, WideNode};
use super::slabs::MOST;
use super::surface::{Extent, size_of_box, unit_of};
use super::validate::TreeError;
use crate::TriMesh;
use glam::DVec3;

/// Wide nodes that are put together box by box, and checked at the end.
pub(super) struct NodeParts {
    nodes: Vec<WideNode>,
}

impl NodeParts {
    pub(super) fn with_capacity(count: usize) -> Self {
        Self { nodes: Vec::with_capacity(count) }
    }

    /// Begins the next node, whose centers count from `origin`.
    pub(super) fn begin(&mut self, origin: [f32; 3]) {
        self.nodes.push(WideNode::empty(origin, 0));
    }

    /// Adds a box to the node that was begun last.
    pub(super) fn add(&mut self, boxed: &OrientedBox, below: Below) -> Result<(), TreeError> {
        let index = self.nodes.len().saturating_sub(1);
        let link = TreeError::Link { node: index };
        let node = self.nodes.last_mut().ok_or(link)?;
        let lane = node.used as usize;
        if lane >= WIDTH {
            return Err(link);
        }
        if boxed.slabs.iter().flatten().any(|&steps| steps > MOST) {
            return Err(TreeError::Shape { node: index, lane });
        }
        let size = match below {
            Below::Triangle(number) | Below::Node(number) if number >= LEAF => return Err(link),
            Below::Triangle(_) => 0.0,
            Below::Node(_) => size_of_box(boxed),
        };
        node.used += 1;
        node.set_box(lane, boxed, size);
        node.set_below(lane, below);
        Ok(())
    }

    /// Links the nodes and checks every promise of the tree.
    pub(super) fn finish(self, mesh: TriMesh, center: DVec3, radius: f64) -> Result<MeshTree, TreeError> {
        let mut nodes = self.nodes;
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
        let tree = MeshTree::from_nodes(mesh, nodes, &extent);
        tree.validate()?;
        Ok(tree)
    }
}
