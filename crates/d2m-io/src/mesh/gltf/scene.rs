//! The nodes of a scene, their transforms and their meshes.

use super::buffers::Buffers;
use super::document::{Document, Node, Primitive};
use crate::mesh::Fault;
use crate::mesh::assembly::{Assembly, affine};
use crate::mesh::strips::{fan, strip};
use d2m_bvh::TriMesh;
use glam::{DAffine3, DQuat, DVec3};

/// Places every mesh of the scene: the one that the file names, or its first, or all nodes that are no children.
pub(super) fn place(
    document: &Document,
    buffers: &mut Buffers<'_>,
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    let count = document.nodes.len();
    let roots: Vec<usize> = match (document.scene, document.scenes.as_slice()) {
        (None, []) => {
            let mut is_child = vec![false; count];
            for child in document.nodes.iter().flat_map(|node| &node.children) {
                if let Some(slot) = is_child.get_mut(*child) {
                    *slot = true;
                }
            }
            (0..count).filter(|&node| !is_child[node]).collect()
        }
        (number, scenes) => {
            let number = number.unwrap_or(0);
            let scene = scenes.get(number);
            let scene = scene
                .ok_or_else(|| Fault::new(format!("scene {number} of {} does not exist", scenes.len())))?;
            scene.nodes.clone()
        }
    };
    let mut meshes: Vec<Option<Vec<TriMesh>>> = vec![None; document.meshes.len()];
    let mut visited = vec![false; count];
    let mut waiting: Vec<(usize, DAffine3)> =
        roots.into_iter().rev().map(|node| (node, DAffine3::IDENTITY)).collect();
    while let Some((index, parent)) = waiting.pop() {
        let fault = |reason: String| Fault::new(format!("node {index}: {reason}"));
        let node = document.nodes.get(index).ok_or_else(|| fault(format!("there are only {count}")))?;
        if std::mem::replace(&mut visited[index], true) {
            return Err(fault("it hangs in two places, or from itself".to_owned()));
        }
        let map = parent * transform(node).map_err(fault)?;
        if let Some(number) = node.mesh {
            let mesh = document.meshes.get(number);
            let mesh = mesh
                .ok_or_else(|| fault(format!("mesh {number} of {} does not exist", document.meshes.len())))?;
            if node.skin.is_some() {
                return Err(fault("meshes with skins are not supported".to_owned()));
            }
            if node.weights.iter().chain(&mesh.weights).any(|weight| *weight != 0.0) {
                return Err(fault("meshes that are morphed are not supported".to_owned()));
            }
            if meshes[number].is_none() {
                let parts = primitives(number, &mesh.primitives, buffers, assembly)?;
                meshes[number] = Some(parts);
            }
            for part in meshes[number].iter().flatten() {
                assembly.add(part, &map).map_err(|error| fault(error.reason))?;
            }
        }
        waiting.extend(node.children.iter().rev().map(|&child| (child, map)));
    }
    Ok(())
}

/// The transform of a node to its parent.
fn transform(node: &Node) -> Result<DAffine3, String> {
    let finite = |name: &str, values: &[f64]| match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(format!("{name} has {value}, not a finite number")),
        None => Ok(()),
    };
    if let Some(m) = node.matrix {
        finite("matrix", &m)?;
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return Err("the last row of its matrix is not 0, 0, 0, 1".to_owned());
        }
        return Ok(affine([0, 4, 8, 12].map(|column| [m[column], m[column + 1], m[column + 2]])));
    }
    let translation = node.translation.unwrap_or_default();
    let scale = node.scale.unwrap_or([1.0; 3]);
    let rotation = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    finite("translation", &translation)?;
    finite("scale", &scale)?;
    finite("rotation", &rotation)?;
    // Scaled first, so that no square overflows.
    let size = rotation.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    if size == 0.0 {
        return Err("its rotation is zero".to_owned());
    }
    let rotation = DQuat::from_array(rotation.map(|value| value / size)).normalize();
    Ok(DAffine3::from_scale_rotation_translation(
        DVec3::from_array(scale),
        rotation,
        DVec3::from_array(translation),
    ))
}

/// The surfaces of a mesh; points and lines are none.
fn primitives(
    mesh: usize,
    primitives: &[Primitive],
    buffers: &mut Buffers<'_>,
    assembly: &mut Assembly,
) -> Result<Vec<TriMesh>, Fault> {
    let mut parts = Vec::new();
    for (number, primitive) in primitives.iter().enumerate() {
        let within = |fault: Fault| Fault::new(format!("mesh {mesh}, primitive {number}: {}", fault.reason));
        let mode = primitive.mode.unwrap_or(4);
        if mode < 4 {
            continue;
        }
        let Some(&positions) = primitive.attributes.get("POSITION") else { continue };
        let allowance = &mut assembly.allowance;
        let vertices = buffers.positions(positions, allowance).map_err(within)?;
        let corners: Vec<u32> = match primitive.indices {
            Some(indices) => buffers.indices(indices, vertices.len(), allowance).map_err(within)?,
            None => (0..vertices.len() as u32).collect(),
        };
        let triangles: Vec<[u32; 3]> = match mode {
            4 => corners.as_chunks::<3>().0.to_vec(),
            5 => strip(&corners).collect(),
            6 => fan(&corners).collect(),
            _ => return Err(within(Fault::new(format!("{mode} is no mode of primitives")))),
        };
        if !triangles.is_empty() {
            parts.push(TriMesh::try_new(vertices, triangles).map_err(|error| within(error.into()))?);
        }
    }
    Ok(parts)
}
