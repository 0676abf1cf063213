//! COLLADA (`.dae`), as robots use it: geometries of triangles, polygons and strips, placed by the nodes of the scene.
//!
//! The unit that the file states counts; the axis that it calls "up" is reported and not turned, as in the tools of ROS (RViz,
//! MoveIt): robot descriptions place a mesh by its own axes. All numbers are doubles.

mod geometry;
mod scene;

use super::assembly::Assembly;
use super::{Fault, RawMesh, UpAxis, xml};
use crate::text::excerpt;
use geometry::Geometries;
use roxmltree::Node;
use std::collections::HashMap;

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let document = xml::document(text.trim_start_matches('\u{feff}'))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err(xml::fault(root, "the root element of a COLLADA file is <COLLADA>"));
    }
    let ids = Ids::new(root);
    let mut geometries = Geometries::new(&ids);
    let mut assembly = Assembly::new(bytes.len());
    scene::place(root, &ids, &mut geometries, &mut assembly)?;
    let polygons = geometries.counts();
    let mut raw = assembly.finish();
    raw.report.polygons = polygons;
    let asset = xml::child(root, "asset");
    if let Some(unit) = asset.and_then(|asset| xml::child(asset, "unit")) {
        raw.report.meters_per_unit = meters(unit)?;
    }
    raw.report.up_axis = match asset.and_then(|asset| xml::child(asset, "up_axis")).and_then(|up| up.text()) {
        Some(text) => match text.trim() {
            "X_UP" => Some(UpAxis::X),
            "Y_UP" => Some(UpAxis::Y),
            "Z_UP" => Some(UpAxis::Z),
            _ => None,
        },
        None => None,
    };
    Ok(raw)
}

fn meters(unit: Node<'_, '_>) -> Result<Option<f64>, Fault> {
    let Some(word) = unit.attribute("meter") else { return Ok(None) };
    let meters = xml::number(unit, word)?;
    if meters > 0.0 {
        Ok(Some(meters))
    } else {
        Err(xml::fault(unit, format!("meter is {meters}, not positive")))
    }
}

/// Elements by their `id`.
struct Ids<'a, 'i> {
    nodes: HashMap<&'a str, Vec<Node<'a, 'i>>>,
}

impl<'a, 'i> Ids<'a, 'i> {
    fn new(root: Node<'a, 'i>) -> Self {
        let mut nodes: HashMap<&'a str, Vec<Node<'a, 'i>>> = HashMap::new();
        for node in root.descendants() {
            if let Some(id) = node.attribute("id") {
                nodes.entry(id).or_default().push(node);
            }
        }
        Self { nodes }
    }

    /// What an attribute such as `url="#id"` refers to, an element of a name.
    fn target(&self, node: Node<'a, 'i>, attribute: &str, name: &str) -> Result<Node<'a, 'i>, Fault> {
        let url = xml::attribute(node, attribute)?;
        let shown = excerpt(url);
        let Some(id) = url.strip_prefix('#') else {
            return Err(xml::fault(node, format!("{attribute} {shown} is outside of this file")));
        };
        let all = self.nodes.get(id).map(Vec::as_slice).unwrap_or_default();
        let mut fitting = all.iter().filter(|target| target.tag_name().name() == name);
        match (fitting.next(), fitting.next()) {
            (Some(target), None) => Ok(*target),
            (Some(_), Some(_)) => Err(xml::fault(node, format!("two of <{name}> have the id {shown}"))),
            (None, _) => Err(xml::fault(node, format!("{attribute} {shown} is the id of no <{name}>"))),
        }
    }
}
