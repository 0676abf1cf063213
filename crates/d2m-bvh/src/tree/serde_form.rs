//! A tree in a file: the mesh, and the boxes as they are. Reading one checks every promise again.

use super::bevel::{Bevels, MOST};
use super::mesh_tree::MeshTree;
use super::node::{Below, OrientedBox, WIDTH, WideNode};
use super::surface::{Extent, size_of_box, unit_of};
use super::validate::TreeError;
use crate::TriMesh;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What is written.
#[derive(Serialize, Deserialize)]
pub(super) struct TreeForm {
    mesh: TriMesh,
    center: [f64; 3],
    radius: f64,
    nodes: Vec<NodeForm>,
}

/// A wide node: where its centres count from, and its boxes.
#[derive(Serialize, Deserialize)]
struct NodeForm {
    origin: [f32; 3],
    boxes: Vec<BoxForm>,
}

#[derive(Serialize, Deserialize)]
struct BoxForm {
    center: [f32; 3],
    axes: [[f32; 3]; 3],
    half_extent: [f32; 3],
    /// Nothing is cut off where they are left out.
    #[serde(default)]
    bevels: Bevels,
    radius: f32,
    below: BelowForm,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum BelowForm {
    Triangle(u32),
    Node(u32),
}

impl From<MeshTree> for TreeForm {
    fn from(tree: MeshTree) -> Self {
        let one = |node: &WideNode| {
            let boxes = (0..node.used as usize).map(|lane| {
                let OrientedBox { center, axes, half_extent, bevels, radius } = node.oriented_box(lane);
                let below = match node.below(lane) {
                    Below::Triangle(triangle) => BelowForm::Triangle(triangle),
                    Below::Node(node) => BelowForm::Node(node),
                };
                BoxForm { center, axes, half_extent, bevels, radius, below }
            });
            NodeForm { origin: node.origin, boxes: boxes.collect() }
        };
        let nodes = tree.nodes.iter().map(one).collect();
        Self { mesh: tree.mesh, center: tree.center.to_array(), radius: tree.radius, nodes }
    }
}

impl TryFrom<TreeForm> for MeshTree {
    type Error = TreeError;

    fn try_from(form: TreeForm) -> Result<Self, TreeError> {
        let mut nodes = Vec::with_capacity(form.nodes.len());
        for (index, from) in form.nodes.iter().enumerate() {
            if from.boxes.len() > WIDTH {
                return Err(TreeError::Link { node: index });
            }
            let mut node = WideNode::empty(from.origin, 0);
            node.used = from.boxes.len() as u32;
            for (lane, b) in from.boxes.iter().enumerate() {
                if b.bevels.iter().flatten().any(|&steps| steps > MOST) {
                    return Err(TreeError::Shape { node: index, lane });
                }
                let boxed = OrientedBox {
                    center: b.center,
                    axes: b.axes,
                    half_extent: b.half_extent,
                    bevels: b.bevels,
                    radius: b.radius,
                };
                let (below, size) = match b.below {
                    BelowForm::Triangle(triangle) if triangle < 1 << 31 => (Below::Triangle(triangle), 0.0),
                    BelowForm::Node(child) if child < 1 << 31 => (Below::Node(child), size_of_box(&boxed)),
                    BelowForm::Triangle(_) | BelowForm::Node(_) => {
                        return Err(TreeError::Link { node: index });
                    }
                };
                node.set_box(lane, &boxed, size);
                node.set_below(lane, below);
            }
            nodes.push(node);
        }
        for index in 0..nodes.len() {
            for lane in 0..nodes[index].used as usize {
                if let Below::Node(child) = nodes[index].below(lane) {
                    let child = child as usize;
                    let below = nodes.get_mut(child).ok_or(TreeError::Link { node: child })?;
                    below.parent = (index * WIDTH + lane) as u32;
                }
            }
        }
        let radius = form.radius;
        let extent = Extent { center: DVec3::from_array(form.center), radius, unit: unit_of(radius) };
        let tree = Self::from_nodes(form.mesh, nodes, &extent);
        tree.validate()?;
        Ok(tree)
    }
}
