//! A tree in a serde format: the mesh, and the boxes as they are. Reading one checks every promise again.
//!
//! Many JSON libraries change the last place of a floating-point number, and a box that is a little smaller encloses
//! nothing. So `f32` are written as their bits, integers that every library keeps, and `f64` as
//! [`ExactNumber`](crate::mesh::ExactNumber). The form that was written before, with plain numbers in `center`, `axes`,
//! `half_extent`, `radius` and `origin`, is read from self-describing formats where its numbers arrive unchanged.

use super::mesh_tree::MeshTree;
use super::node::{Below, LEAF, OrientedBox, WIDTH, WideNode};
use super::parts::{node_of_parts, tree_of_parts};
use super::slabs::Slabs;
use super::tree_error::TreeError;
use crate::TriMesh;
use crate::mesh::ExactNumber;
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
    /// Of the center, the three axes, the half extents and the radius.
    bits: [u32; 16],
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

/// A node of either form.
#[derive(Deserialize)]
struct EitherNode {
    origin_bits: Option<[u32; 3]>,
    origin: Option<[f32; 3]>,
    boxes: Vec<EitherBox>,
}

#[derive(Deserialize)]
struct EitherBox {
    bits: Option<[u32; 16]>,
    center: Option<[f32; 3]>,
    axes: Option<[[f32; 3]; 3]>,
    half_extent: Option<[f32; 3]>,
    radius: Option<f32>,
    /// Nothing is cut off where they are left out. They had another name before.
    #[serde(default, alias = "bevels")]
    slabs: Slabs,
    below: BelowForm,
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
        if deserializer.is_human_readable() {
            let form = TreeForm::<EitherNode>::deserialize(deserializer)?;
            let mut nodes = Vec::with_capacity(form.nodes.len());
            for (index, node) in form.nodes.into_iter().enumerate() {
                nodes.push(node.try_into().map_err(|missing| {
                    de::Error::custom(format_args!("node {index}: field `{missing}` is missing"))
                })?);
            }
            let TreeForm { mesh, center, radius, .. } = form;
            TreeForm { mesh, center, radius, nodes }.try_into().map_err(de::Error::custom)
        } else {
            TreeForm::<NodeForm>::deserialize(deserializer)?.try_into().map_err(de::Error::custom)
        }
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
        let OrientedBox { center: c, axes: [a, b, d], half_extent: h, slabs, radius } = *boxed;
        let numbers = [
            c[0], c[1], c[2], a[0], a[1], a[2], b[0], b[1], b[2], d[0], d[1], d[2], h[0], h[1], h[2], radius,
        ];
        let below = match below {
            Below::Triangle(triangle) => BelowForm::Triangle(triangle),
            Below::Node(node) => BelowForm::Node(node),
        };
        Self { bits: numbers.map(f32::to_bits), slabs, below }
    }

    fn boxed(&self) -> OrientedBox {
        let n = self.bits.map(f32::from_bits);
        let three = |at: usize| [n[at], n[at + 1], n[at + 2]];
        OrientedBox {
            center: three(0),
            axes: [three(3), three(6), three(9)],
            half_extent: three(12),
            slabs: self.slabs,
            radius: n[15],
        }
    }
}

impl TryFrom<EitherNode> for NodeForm {
    type Error = &'static str;

    fn try_from(node: EitherNode) -> Result<Self, &'static str> {
        let origin_bits =
            node.origin_bits.or(node.origin.map(|origin| origin.map(f32::to_bits))).ok_or("origin_bits")?;
        let boxes = node.boxes.into_iter().map(BoxForm::try_from).collect::<Result<_, _>>()?;
        Ok(Self { origin_bits, boxes })
    }
}

impl TryFrom<EitherBox> for BoxForm {
    type Error = &'static str;

    fn try_from(form: EitherBox) -> Result<Self, &'static str> {
        let EitherBox { bits, center, axes, half_extent, radius, slabs, below } = form;
        if let Some(bits) = bits {
            return Ok(Self { bits, slabs, below });
        }
        let center = center.ok_or("bits")?;
        let axes = axes.ok_or("axes")?;
        let half_extent = half_extent.ok_or("half_extent")?;
        let radius = radius.ok_or("radius")?;
        let boxed = OrientedBox { center, axes, half_extent, slabs, radius };
        let form = Self::new(&boxed, Below::Node(0));
        Ok(Self { below, ..form })
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
