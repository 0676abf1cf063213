//! New boxes for moved vertices: the same triangles in the same nodes.

use super::mesh_tree::MeshTree;
use super::node::{Below, OrientedBox, WideNode};
use super::surface::{Extent, SizedBox, Surface};
use crate::{MeshError, TriMesh};
use glam::DVec3;

impl MeshTree {
    /// Moves the vertices and fits every box anew: axes, extents and margins are computed as at construction, so all
    /// promises hold as for a new tree, closedness included. Which triangles share a node stays as it is; after large
    /// deformations a new tree is faster to query.
    ///
    /// ```
    /// use d2m_bvh::{MeshTree, TriMesh};
    /// use glam::DVec3;
    /// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::try_new(vertices.clone(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// let mut tree = MeshTree::new(mesh);
    /// tree.refit(vertices.iter().map(|&p| p * DVec3::new(1.0, 1.0, 3.0)).collect())?;
    /// assert_eq!(tree.mesh().corners(3)[2], DVec3::Z * 3.0);
    /// assert_eq!(tree.validate(), Ok(()));
    /// # Ok::<(), d2m_bvh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// As [`TriMesh::try_new`]; the tree is then unchanged. Surplus vertices are allowed.
    pub fn refit(&mut self, vertices: Vec<DVec3>) -> Result<(), MeshError> {
        let mesh = TriMesh::try_new(vertices, self.mesh.triangles().to_vec())?;
        let extent = Extent::of(&mesh);
        let surface = Surface::new(&mesh, &extent);
        let mut order = Vec::with_capacity(mesh.triangle_count());
        let mut nodes = core::mem::take(&mut self.nodes);
        let mut refit = Refit { surface: &surface, nodes: &mut nodes, order: &mut order };
        let counts = refit.count(0);
        let root = refit.nodes[0].below(0);
        let SizedBox { boxed, size } =
            refit.surface.enclose(refit.order, &refit.surface.axes(refit.order), [0.0; 3]);
        let mut node = WideNode::empty([0.0; 3], 0);
        node.used = 1;
        node.set_box(0, &boxed, if matches!(root, Below::Triangle(_)) { 0.0 } else { size });
        node.set_below(0, root);
        refit.nodes[0] = node;
        if let Below::Node(below) = root {
            refit.fit(below, 0, &boxed, [0.0; 3], &counts);
        }
        *self = Self::from_nodes(mesh, nodes, &extent);
        Ok(())
    }
}

struct Refit<'a> {
    surface: &'a Surface<'a>,
    nodes: &'a mut Vec<WideNode>,
    /// Triangles in the order of a walk, so that each box has a run of them.
    order: &'a mut Vec<u32>,
}

impl Refit<'_> {
    /// Walks the tree and lists the triangles; returns how many there are below each node.
    fn count(&mut self, root: u32) -> Vec<u32> {
        let mut counts = vec![0; self.nodes.len()];
        self.walk(root, &mut counts);
        counts
    }

    fn walk(&mut self, node: u32, counts: &mut [u32]) {
        let before = self.order.len();
        for lane in 0..self.nodes[node as usize].used as usize {
            match self.nodes[node as usize].below(lane) {
                Below::Triangle(triangle) => self.order.push(triangle),
                Below::Node(child) => self.walk(child, counts),
            }
        }
        counts[node as usize] = (self.order.len() - before) as u32;
    }

    /// Fits the boxes of a node whose triangles start at `start`, and all below.
    fn fit(&mut self, index: u32, start: usize, above: &OrientedBox, from: [f32; 3], counts: &[u32]) {
        let old = self.nodes[index as usize].clone();
        let origin = [0, 1, 2].map(|k| from[k] + above.center[k]);
        let mut node = WideNode::empty(origin, old.parent);
        node.used = old.used;
        let mut at = start;
        for lane in 0..old.used as usize {
            let below = old.below(lane);
            let (count, leaf) = match below {
                Below::Triangle(_) => (1, true),
                Below::Node(child) => (counts[child as usize] as usize, false),
            };
            let part = &self.order[at..at + count];
            let SizedBox { boxed, size } = self.surface.enclose(part, &self.surface.axes(part), origin);
            node.set_box(lane, &boxed, if leaf { 0.0 } else { size });
            node.set_below(lane, below);
            if let Below::Node(child) = below {
                self.fit(child, at, &boxed, origin, counts);
            }
            at += count;
        }
        self.nodes[index as usize] = node;
    }
}
