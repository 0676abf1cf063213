//! New boxes for moved vertices: the same triangles in the same nodes.

use super::bottom_up::{Fitting, Lanes, Place, Scratch, Subtree};
use super::fit::Moments;
use super::mesh_tree::MeshTree;
use super::node::{Below, LEAF, WideNode};
use super::surface::{Extent, Surface};
use crate::MeshError;
use crate::parallel::{both, both_of_many, is_alone};
use glam::DVec3;

impl MeshTree {
    /// Moves the vertices and fits every box anew: axes, extents and margins are computed as at construction, so all
    /// promises hold as for a new tree, closedness included. Which triangles share a node stays as it is; after large
    /// deformations a new tree is faster to query.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TriMesh};
    /// use glam::DVec3;
    /// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::try_new(vertices.clone(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let mut tree = MeshTree::new(mesh);
    /// tree.refit(vertices.iter().map(|&p| p * DVec3::new(1.0, 1.0, 3.0)).collect())?;
    /// assert_eq!(tree.mesh().corners(3)[2], DVec3::Z * 3.0);
    /// assert_eq!(tree.validate(), Ok(()));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// As [`crate::TriMesh::try_new`]; the tree is then unchanged. Surplus vertices are allowed.
    pub fn refit(&mut self, vertices: Vec<DVec3>) -> Result<(), MeshError> {
        let mesh = self.mesh.try_move(vertices)?;
        let extent = Extent::of(&mesh);
        let surface = Surface::new(&mesh, &extent);
        let before = self.closedness();
        let mut nodes = core::mem::take(&mut self.nodes);
        let is_divided = nodes.len() > GRAIN && !is_alone() && is_in_order(&nodes);
        let refit = Refit { fitting: Fitting::new(&surface), is_divided };
        let fit = || {
            let (root, rest) = nodes.split_at_mut(1);
            let tree = refit.subtree(root[0].below(0), rest, 1);
            refit.fitting.root(&tree, &mut root[0]);
        };
        let (closedness, ()) = both_of_many(mesh.triangle_count(), || before.of_moved(&mesh), fit);
        *self = Self::from_parts(mesh, nodes, &extent, closedness);
        Ok(())
    }
}

/// Are the nodes numbered in the order of a walk from the root? Those of a built tree are.
fn is_in_order(nodes: &[WideNode]) -> bool {
    let mut next = 1;
    // Nodes that are met and not yet walked, the next one last.
    let mut waiting = vec![0];
    while let Some(index) = waiting.pop() {
        let node: &WideNode = &nodes[index as usize];
        if index != 0 && index != next {
            return false;
        }
        next = index + 1;
        for lane in (0..node.used as usize).rev() {
            if let Below::Node(child) = node.below(lane) {
                waiting.push(child);
            }
        }
    }
    true
}

/// Nodes below a box that are fitted by one thread.
const GRAIN: usize = 512;

struct Refit<'a> {
    fitting: Fitting<'a>,
    /// Among threads: what is below a box is then a run of nodes.
    is_divided: bool,
}

impl Refit<'_> {
    /// What is below a box: a triangle, or one of these nodes, of which the first has the number `first`.
    fn subtree(&self, below: Below, nodes: &mut [WideNode], first: u32) -> Subtree {
        if nodes.len() <= GRAIN || !self.is_divided {
            return self.fitting.subtree(|scratch| self.lane(below, nodes, first, scratch));
        }
        let (node, rest) = nodes.split_at_mut(1);
        let lanes: Vec<Below> = (0..node[0].used as usize).map(|lane| node[0].below(lane)).collect();
        let place = Place { node: first, parent: node[0].parent };
        let subtrees = self.side_by_side(&lanes, rest, first + 1);
        self.fitting.node_above(subtrees, place, &mut node[0])
    }

    /// Lanes of a node, whose nodes are these, in their order.
    fn side_by_side(&self, lanes: &[Below], nodes: &mut [WideNode], first: u32) -> Vec<Subtree> {
        if let &[lane] = lanes {
            return vec![self.subtree(lane, nodes, first)];
        }
        let (low, high) = lanes.split_at(lanes.len() / 2);
        let begin = high.iter().find_map(|below| match *below {
            Below::Node(node) => Some(node),
            Below::Triangle(_) => None,
        });
        let begin = begin.unwrap_or(first + nodes.len() as u32);
        let (nodes_low, nodes_high) = nodes.split_at_mut((begin - first) as usize);
        let (mut subtrees, rest) =
            both(|| self.side_by_side(low, nodes_low, first), || self.side_by_side(high, nodes_high, begin));
        subtrees.extend(rest);
        subtrees
    }

    fn lane(
        &self,
        below: Below,
        nodes: &mut [WideNode],
        first: u32,
        scratch: &mut Scratch,
    ) -> (Below, Moments) {
        let index = match below {
            Below::Triangle(triangle) => return self.fitting.triangle(triangle, scratch),
            Below::Node(index) => (index - first) as usize,
        };
        let (used, parent) = (nodes[index].used as usize, nodes[index].parent);
        let children = nodes[index].child;
        if children[..used].iter().all(|child| child & LEAF != 0) {
            let triangles = children.map(|child| child & !LEAF);
            let node = &mut nodes[index];
            return (below, self.fitting.node_of_triangles(&triangles[..used], parent, node, scratch));
        }
        let mut lanes = Lanes::new(scratch);
        for lane in 0..used {
            let (below, moments) = self.lane(nodes[index].below(lane), nodes, first, scratch);
            lanes.add(below, moments, scratch);
        }
        let moments = self.fitting.node(&mut lanes, parent, &mut nodes[index], scratch);
        (below, moments)
    }
}
