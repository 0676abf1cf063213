//! A tree in a serde format: the mesh, and the boxes as they are. Reading one checks every promise again.
//!
//! Many JSON libraries change the last place of a floating-point number, and a box that is a little smaller encloses
//! nothing. So `f32` are written as their bits, integers that every library keeps, and `f64` as
//! [`ExactNumber`](crate::mesh::ExactNumber).

use super::mesh_tree::MeshTree;
use super::node::{Below, LEAF, OrientedBox, WIDTH, WideNode};
use super::parts::{node_of_parts, tree_of_parts};
use super::slabs::Slabs;
use super::tree_error::TreeError;
use crate::TriMesh;
use crate::mesh::ExactNumber;
use d2m_lanes::three::cross;
use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// What is written.
#[derive(Serialize, Deserialize)]
struct TreeForm<Node> {
    mesh: TriMesh,
    center: [ExactNumber; 3],
    radius: ExactNumber,
    nodes: Vec<Node>,
}

/// A wide node: where its centers count from, and its boxes.
#[derive(Serialize, Deserialize)]
struct NodeForm {
    origin_bits: [u32; 3],
    boxes: Vec<BoxForm>,
}

#[derive(Serialize, Deserialize)]
struct BoxForm {
    /// Of the center, the first two axes, the half extents and the radius.
    bits: [u32; 13],
    slabs: Slabs,
    below: BelowForm,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum BelowForm {
    Triangle(u32),
    Node(u32),
}

impl From<BelowForm> for Below {
    fn from(form: BelowForm) -> Self {
        match form {
            BelowForm::Triangle(triangle) => Self::Triangle(triangle),
            BelowForm::Node(node) => Self::Node(node),
        }
    }
}

impl Serialize for MeshTree {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let form = TreeForm {
            mesh: self.mesh.clone(),
            center: self.center.to_array().map(ExactNumber),
            radius: ExactNumber(self.radius),
            nodes: self.nodes.iter().map(NodeForm::from).collect(),
        };
        form.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MeshTree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        TreeForm::<NodeForm>::deserialize(deserializer)?.try_into().map_err(de::Error::custom)
    }
}

impl From<&WideNode> for NodeForm {
    fn from(node: &WideNode) -> Self {
        let boxes =
            (0..node.used as usize).map(|lane| BoxForm::new(&node.oriented_box(lane), node.below(lane)));
        Self { origin_bits: node.origin.map(f32::to_bits), boxes: boxes.collect() }
    }
}

impl BoxForm {
    fn new(boxed: &OrientedBox, below: Below) -> Self {
        let OrientedBox { center: c, axes: [a, b, _], half_extent: h, slabs, radius } = *boxed;
        let numbers = [c[0], c[1], c[2], a[0], a[1], a[2], b[0], b[1], b[2], h[0], h[1], h[2], radius];
        let below = match below {
            Below::Triangle(triangle) => BelowForm::Triangle(triangle),
            Below::Node(node) => BelowForm::Node(node),
        };
        Self { bits: numbers.map(f32::to_bits), slabs, below }
    }

    fn boxed(&self) -> OrientedBox {
        let n = self.bits.map(f32::from_bits);
        let three = |at: usize| [n[at], n[at + 1], n[at + 2]];
        let (first, second) = (three(3), three(6));
        OrientedBox {
            center: three(0),
            axes: [first, second, cross(&first, &second)],
            half_extent: three(9),
            slabs: self.slabs,
            radius: n[12],
        }
    }
}

impl TryFrom<TreeForm<NodeForm>> for MeshTree {
    type Error = TreeError;

    fn try_from(form: TreeForm<NodeForm>) -> Result<Self, TreeError> {
        let mut nodes = Vec::with_capacity(form.nodes.len());
        for (index, node) in form.nodes.iter().enumerate() {
            let is_numbered = |boxed: &BoxForm| match boxed.below {
                BelowForm::Triangle(number) | BelowForm::Node(number) => number < LEAF,
            };
            if node.boxes.len() > WIDTH || !node.boxes.iter().all(is_numbered) {
                return Err(TreeError::Link { node: index });
            }
            let boxes = node.boxes.iter().map(|form| (form.boxed(), form.below.into()));
            nodes.push(node_of_parts(node.origin_bits.map(f32::from_bits), boxes));
        }
        let center = DVec3::from_array(form.center.map(|ExactNumber(number)| number));
        tree_of_parts(form.mesh, nodes, center, form.radius.0)
    }
}
