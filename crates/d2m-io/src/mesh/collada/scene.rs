//! The nodes of a scene and their transforms.

use super::geometry::Geometries;
use super::{Fault, Ids, xml};
use crate::mesh::assembly::{Assembly, affine};
use d2m_motion::Pose;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use roxmltree::Node;

/// Elements that a scene may visit: files in which nodes instance each other again and again would never end.
const MOST_VISITS: usize = 1 << 22;

/// A node that waits for its turn.
struct Visit<'a, 'i> {
    node: Node<'a, 'i>,
    map: DAffine3,
    /// Instances of nodes on the way here.
    instances: usize,
}

/// Places every geometry that the scene instances.
pub(super) fn place<'a, 'i>(
    root: Node<'a, 'i>,
    ids: &Ids<'a, 'i>,
    geometries: &mut Geometries<'a, 'i, '_>,
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    let Some(scene) = chosen_scene(root, ids)? else {
        // A library of geometries alone: each as it is.
        let libraries = xml::children(root, "library_geometries");
        for geometry in libraries.flat_map(|library| xml::children(library, "geometry")) {
            geometries.place(geometry, &DAffine3::IDENTITY, assembly)?;
        }
        return Ok(());
    };
    let mut visits = 0_usize;
    let mut waiting: Vec<Visit<'a, 'i>> = Vec::new();
    waiting.push(Visit { node: scene, map: DAffine3::IDENTITY, instances: 0 });
    while let Some(Visit { node, map, instances }) = waiting.pop() {
        visits += 1 + node.children().count();
        if visits > MOST_VISITS || instances > ids.nodes.len() {
            let reason = if instances > ids.nodes.len() {
                "the node instances itself".to_owned()
            } else {
                format!("nodes instance each other so often that more than {MOST_VISITS} would be visited")
            };
            return Err(xml::fault(node, reason));
        }
        let map = if node.tag_name().name() == "node" { map * transform(node)? } else { map };
        let mut next = Vec::new();
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "node" => next.push(Visit { node: child, map, instances }),
                "instance_node" => {
                    let target = ids.target(child, "url", "node")?;
                    next.push(Visit { node: target, map, instances: instances + 1 });
                }
                "instance_geometry" => {
                    geometries.place(ids.target(child, "url", "geometry")?, &map, assembly)?;
                }
                // Leaving it out would lose surface.
                "instance_controller" => {
                    return Err(xml::fault(child, "skins and morphs are not supported"));
                }
                _ => {}
            }
        }
        // In the order of the file.
        waiting.extend(next.into_iter().rev());
    }
    Ok(())
}

/// The scene that the file names, or else its first.
fn chosen_scene<'a, 'i>(root: Node<'a, 'i>, ids: &Ids<'a, 'i>) -> Result<Option<Node<'a, 'i>>, Fault> {
    let instance = xml::child(root, "scene").and_then(|scene| xml::child(scene, "instance_visual_scene"));
    match instance {
        Some(instance) => ids.target(instance, "url", "visual_scene").map(Some),
        None => {
            Ok(xml::child(root, "library_visual_scenes")
                .and_then(|library| xml::child(library, "visual_scene")))
        }
    }
}

/// The transforms of a node, the first of them outermost.
fn transform(node: Node<'_, '_>) -> Result<DAffine3, Fault> {
    let mut map = DAffine3::IDENTITY;
    for child in node.children().filter(Node::is_element) {
        map *= match child.tag_name().name() {
            "matrix" => matrix(child)?,
            "translate" => {
                DAffine3::from_translation(DVec3::from_array(xml::numbers(child, xml::words(child))?))
            }
            "scale" => DAffine3::from_scale(DVec3::from_array(xml::numbers(child, xml::words(child))?)),
            "rotate" => {
                let [x, y, z, degrees] = xml::numbers(child, xml::words(child))?;
                rotation(child, DVec3::new(x, y, z), degrees)?
            }
            other @ ("lookat" | "skew") => {
                return Err(xml::fault(child, format!("the transform {other} is not supported")));
            }
            _ => continue,
        };
    }
    Ok(map)
}

/// Sixteen numbers, row by row.
fn matrix(node: Node<'_, '_>) -> Result<DAffine3, Fault> {
    let m: [f64; 16] = xml::numbers(node, xml::words(node))?;
    if m[12..] != [0.0, 0.0, 0.0, 1.0] {
        return Err(xml::fault(node, format!("the last row is {:?} and not 0 0 0 1", &m[12..])));
    }
    Ok(affine([0, 1, 2, 3].map(|column| [m[column], m[4 + column], m[8 + column]])))
}

/// A turn about an axis. Quarter turns about coordinate axes are exact.
fn rotation(node: Node<'_, '_>, axis: DVec3, degrees: f64) -> Result<DAffine3, Fault> {
    let Some(axis) = axis.try_normalize() else {
        return Err(xml::fault(node, format!("the axis is {:?}, which has no direction", axis.to_array())));
    };
    let rest = degrees % 360.0; // exact
    if rest % 90.0 == 0.0 {
        let (sin, cos) = match (rest / 90.0).rem_euclid(4.0) {
            0.0 => (0.0, 1.0),
            1.0 => (1.0, 0.0),
            2.0 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        };
        let column = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
        let columns = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        return Ok(DAffine3::from_mat3(columns));
    }
    let turn: DQuat = Pose::from_rotation_vector(DVec3::ZERO, axis * rest.to_radians()).rotation;
    Ok(DAffine3::from_quat(turn))
}
