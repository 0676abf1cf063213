//! The geometries of a file, each read when it is first placed.

use super::{Fault, Ids, xml};
use crate::mesh::PolygonCounts;
use crate::mesh::assembly::Assembly;
use crate::mesh::polygon::Triangulation;
use crate::mesh::strips::{fan, strip};
use crate::text::{check_coordinate, excerpt};
use d2m_bvh::TriMesh;
use glam::{DAffine3, DVec3};
use roxmltree::{Node, NodeId};
use std::collections::HashMap;

pub(super) struct Geometries<'a, 'i, 'r> {
    ids: &'r Ids<'a, 'i>,
    /// None: without surface.
    known: HashMap<NodeId, Option<TriMesh>>,
    counts: PolygonCounts,
}

impl<'a, 'i, 'r> Geometries<'a, 'i, 'r> {
    pub(super) fn new(ids: &'r Ids<'a, 'i>) -> Self {
        Self { ids, known: HashMap::new(), counts: PolygonCounts::default() }
    }

    /// What was cut, each geometry counted once.
    pub(super) fn counts(&self) -> PolygonCounts {
        self.counts
    }

    pub(super) fn place(
        &mut self,
        geometry: Node<'a, 'i>,
        map: &DAffine3,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        if !self.known.contains_key(&geometry.id()) {
            let mesh = self.read(geometry)?;
            self.known.insert(geometry.id(), mesh);
        }
        match self.known.get(&geometry.id()) {
            Some(Some(mesh)) => assembly.add(mesh, map).map_err(|error| xml::fault(geometry, error.reason)),
            _ => Ok(()),
        }
    }

    fn read(&mut self, geometry: Node<'a, 'i>) -> Result<Option<TriMesh>, Fault> {
        if let Some(convex) = xml::child(geometry, "convex_mesh") {
            return Err(xml::fault(convex, "convex hulls are not supported"));
        }
        // Splines are curves.
        let Some(mesh) = xml::child(geometry, "mesh") else { return Ok(None) };
        let mut positions: Option<Positions> = None;
        let mut triangulation = Triangulation::default();
        for primitive in mesh.children().filter(Node::is_element) {
            let kind = match primitive.tag_name().name() {
                "triangles" => Kind::Triangles,
                "polylist" => Kind::Polylist,
                "polygons" => Kind::Polygons,
                "tristrips" => Kind::Strips,
                "trifans" => Kind::Fans,
                _ => continue, // sources, lines
            };
            let Some(input) = Input::of(primitive)? else {
                continue; // nothing refers to vertices: no corners
            };
            let vertices = self.ids.target(input.vertices, "source", "vertices")?;
            if positions.as_ref().is_none_or(|known| known.of != vertices.id()) {
                if positions.is_some() {
                    return Err(xml::fault(
                        primitive,
                        "a second list of vertices in one mesh is not supported",
                    ));
                }
                positions = Some(Positions { of: vertices.id(), list: self.positions(vertices)? });
            }
            let list = positions.as_ref().map_or(&[][..], |positions| &positions.list);
            Corners { primitive, input: &input, vertices: list }.add(kind, &mut triangulation)?;
        }
        let Triangulation { triangles, counts, .. } = triangulation;
        self.counts.add(counts);
        if triangles.is_empty() {
            return Ok(None);
        }
        let vertices = positions.map(|positions| positions.list).unwrap_or_default();
        TriMesh::try_new(vertices, triangles).map(Some).map_err(|error| xml::fault(mesh, error.to_string()))
    }

    /// The source of the positions of a list of vertices.
    fn positions(&self, vertices: Node<'a, 'i>) -> Result<Vec<DVec3>, Fault> {
        let is_position = |input: &Node<'_, '_>| input.attribute("semantic") == Some("POSITION");
        let input = xml::children(vertices, "input").find(is_position);
        let input = input.ok_or_else(|| xml::fault(vertices, "no input with the semantic POSITION"))?;
        let source = self.ids.target(input, "source", "source")?;
        let accessor =
            xml::child(source, "technique_common").and_then(|common| xml::child(common, "accessor"));
        let accessor = accessor.ok_or_else(|| xml::fault(source, "it has no accessor"))?;
        let array = self.ids.target(accessor, "source", "float_array")?;
        let values: Vec<f64> =
            xml::words(array).map(|word| xml::number(array, word)).collect::<Result<_, Fault>>()?;
        let stride: usize = xml::whole(accessor, "stride")?.unwrap_or(1);
        let offset: usize = xml::whole(accessor, "offset")?.unwrap_or(0);
        let count: usize = xml::whole(accessor, "count")?.unwrap_or(0);
        let end = count.checked_mul(stride).and_then(|length| length.checked_add(offset));
        if stride < 3 || end.is_none_or(|end| end > values.len()) {
            let reason = format!(
                "{count} positions of stride {stride} from {offset} do not fit into {} numbers",
                values.len()
            );
            return Err(xml::fault(accessor, reason));
        }
        // Parameters may stand in another order, or have no name and be left out.
        let names: Vec<Option<&str>> =
            xml::children(accessor, "param").map(|parameter| parameter.attribute("name")).collect();
        let place = |axis: usize, name: &str| {
            names
                .iter()
                .position(|other| *other == Some(name))
                .filter(|place| *place < stride)
                .unwrap_or(axis)
        };
        let places = [place(0, "X"), place(1, "Y"), place(2, "Z")];
        let position = |index: usize| -> Result<DVec3, Fault> {
            let values = places.map(|place| values[offset + index * stride + place]);
            for (axis, value) in ["x", "y", "z"].into_iter().zip(values) {
                check_coordinate(axis, value)
                    .map_err(|reason| xml::fault(array, format!("position {index}: {reason}")))?;
            }
            Ok(DVec3::from_array(values))
        };
        (0..count).map(position).collect()
    }
}

struct Positions {
    of: NodeId,
    list: Vec<DVec3>,
}

#[derive(Clone, Copy)]
enum Kind {
    Triangles,
    Polylist,
    Polygons,
    Strips,
    Fans,
}

/// Where the vertices stand among the indices of a primitive.
struct Input<'a, 'i> {
    vertices: Node<'a, 'i>,
    offset: usize,
    stride: usize,
}

impl<'a, 'i> Input<'a, 'i> {
    fn of(primitive: Node<'a, 'i>) -> Result<Option<Self>, Fault> {
        let mut stride = 0_usize;
        let mut found = None;
        for input in xml::children(primitive, "input") {
            let offset: u16 = xml::whole(input, "offset")?.unwrap_or(0);
            stride = stride.max(usize::from(offset) + 1);
            if input.attribute("semantic") == Some("VERTEX") {
                found = Some((input, usize::from(offset)));
            }
        }
        Ok(found.map(|(vertices, offset)| Self { vertices, offset, stride }))
    }
}

/// The corners of one primitive.
struct Corners<'a, 'i, 'r> {
    primitive: Node<'a, 'i>,
    input: &'r Input<'a, 'i>,
    vertices: &'r [DVec3],
}

impl<'a, 'i> Corners<'a, 'i, '_> {
    fn add(&self, kind: Kind, triangulation: &mut Triangulation) -> Result<(), Fault> {
        if matches!(kind, Kind::Polygons)
            && let Some(holes) = xml::child(self.primitive, "ph")
        {
            return Err(xml::fault(holes, "polygons with holes are not supported"));
        }
        if matches!(kind, Kind::Polylist) {
            return self.add_polylist(triangulation);
        }
        for list in xml::children(self.primitive, "p") {
            let corners = self.corners(list)?;
            match kind {
                Kind::Triangles => {
                    let (triangles, rest) = corners.as_chunks::<3>();
                    if !rest.is_empty() {
                        let reason = format!("{} corners are no whole triangles", corners.len());
                        return Err(xml::fault(list, reason));
                    }
                    triangulation.triangles.extend(triangles);
                }
                Kind::Strips => triangulation.triangles.extend(strip(&corners)),
                Kind::Fans => triangulation.triangles.extend(fan(&corners)),
                Kind::Polygons | Kind::Polylist => triangulation.add(&corners, self.vertices),
            }
        }
        Ok(())
    }

    fn add_polylist(&self, triangulation: &mut Triangulation) -> Result<(), Fault> {
        let Some(list) = xml::child(self.primitive, "p") else { return Ok(()) };
        let all = self.corners(list)?;
        let mut left = all.as_slice();
        let counts = xml::children(self.primitive, "vcount").flat_map(xml::words);
        for word in counts {
            let count: usize = word
                .parse()
                .map_err(|_| xml::fault(self.primitive, format!("vcount has {}", excerpt(word))))?;
            let Some((polygon, rest)) = left.split_at_checked(count) else {
                let reason = format!("vcount states more corners than the {} of <p>", all.len());
                return Err(xml::fault(self.primitive, reason));
            };
            triangulation.add(polygon, self.vertices);
            left = rest;
        }
        if left.is_empty() {
            Ok(())
        } else {
            let reason = format!("{} corners of <p> are left after vcount", left.len());
            Err(xml::fault(self.primitive, reason))
        }
    }

    /// The indices of the vertices, one of every `stride` indices.
    fn corners(&self, list: Node<'a, 'i>) -> Result<Vec<u32>, Fault> {
        let Input { offset, stride, .. } = *self.input;
        let mut corners = Vec::new();
        let mut count = 0_usize;
        for word in xml::words(list) {
            if count % stride == offset {
                let index: u32 = word.parse().map_err(|_| {
                    xml::fault(list, format!("vertex index {} is not a number", excerpt(word)))
                })?;
                if index as usize >= self.vertices.len() {
                    let reason = format!(
                        "vertex index {index} is out of range, the mesh has {} vertices",
                        self.vertices.len()
                    );
                    return Err(xml::fault(list, reason));
                }
                corners.push(index);
            }
            count += 1;
        }
        if count.is_multiple_of(stride) {
            Ok(corners)
        } else {
            Err(xml::fault(list, format!("{count} indices are no whole corners of {stride}")))
        }
    }
}
