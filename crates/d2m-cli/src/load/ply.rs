//! PLY, text or binary, read by `ply-rs-bw`.

use super::LoadError;
use super::polygon::triangulate;
use d2m::bvh::{MAX_COORDINATE, TriMesh};
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Encoding, Property, PropertyAccess, PropertyAccessResult};

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, LoadError> {
    let mut reader = Reader::new(bytes);
    let parser = Parser::<Element>::new();
    let header = parser.read_header(&mut reader).map_err(|error| fault(&error))?;
    let is_text = header.encoding == Encoding::Ascii;
    let (mut vertices, mut polygons) = (Vec::new(), Vec::new());
    let mut line = reader.line();
    for (name, definition) in &header.elements {
        // Nothing would be read for each of them, however many the header states.
        if definition.properties.is_empty() && !is_text && definition.count > 0 {
            return Err(LoadError::new(format!("element {name:?} has no properties")));
        }
        let elements =
            parser.read_payload_for_element(&mut reader, definition, &header).map_err(|error| {
                let error = fault(&error);
                LoadError {
                    line: error.line.filter(|_| is_text),
                    reason: format!("{name}: {}", error.reason),
                }
            })?;
        let first_line = line;
        line += elements.len();
        let at = |index: usize, reason: String| {
            let line = is_text.then_some(first_line + index);
            LoadError { line, reason: format!("{name} {index}: {reason}") }
        };
        match name.as_str() {
            "vertex" => {
                for (index, element) in elements.into_iter().enumerate() {
                    vertices.push(element.position().map_err(|reason| at(index, reason))?);
                }
            }
            "face" => {
                for (index, element) in elements.into_iter().enumerate() {
                    polygons.push(element.polygon().map_err(|reason| at(index, reason))?);
                }
            }
            // Leaving them out would lose surface.
            "tristrips" if !elements.is_empty() => {
                return Err(LoadError::new("element \"tristrips\" is not supported: faces are needed"));
            }
            _ => {}
        }
    }
    let triangles = polygons.iter().flat_map(|polygon| triangulate(polygon, &vertices)).collect();
    Ok(TriMesh::try_new(vertices, triangles)?)
}

/// The parser's messages span lines: what it says first, the text it quotes, and a chain of causes that is left out.
fn fault(error: &ParseError) -> LoadError {
    let text = error.to_string();
    let mut lines = text.lines().map(str::trim);
    let first = lines.next().unwrap_or_default();
    let first =
        first.strip_prefix("Line ").and_then(|rest| rest.split_once(": ")).map_or(first, |(_, rest)| rest);
    let quoted =
        lines.find_map(|line| line.strip_prefix("String: '")).map(|line| line.trim_end_matches('\'').trim());
    let reason = match quoted {
        Some(quoted) if first.starts_with("Couldn't read") => format!("cannot read {quoted:?}"),
        Some(quoted) => format!("{} found {quoted:?}", first.trim_end_matches('.')),
        None => first.to_owned(),
    };
    LoadError { line: error.line(), reason }
}

/// What matters of a vertex or a face.
#[derive(Default)]
struct Element {
    coordinates: [Option<f64>; 3],
    indices: Option<Vec<i64>>,
}

impl Element {
    fn position(&self) -> Result<DVec3, String> {
        let mut position = [0.0; 3];
        for ((axis, value), slot) in ["x", "y", "z"].into_iter().zip(self.coordinates).zip(&mut position) {
            *slot = value.ok_or_else(|| format!("{axis} is missing"))?;
            if !slot.is_finite() {
                return Err(format!("{axis} is {slot}, not a finite number"));
            }
            if slot.abs() > MAX_COORDINATE {
                return Err(format!("{axis} is {slot:e}, larger than the limit of {MAX_COORDINATE:e}"));
            }
        }
        Ok(DVec3::from_array(position))
    }

    fn polygon(&self) -> Result<Vec<u32>, String> {
        let indices = self.indices.as_ref().ok_or("the list vertex_indices is missing")?;
        let check =
            |&index: &i64| u32::try_from(index).map_err(|_| format!("vertex index {index} is out of range"));
        indices.iter().map(check).collect()
    }
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            "vertex_indices" | "vertex_index" => {
                self.indices = match property {
                    Property::ListChar(list) => Some(list.into_iter().map(i64::from).collect()),
                    Property::ListUChar(list) => Some(list.into_iter().map(i64::from).collect()),
                    Property::ListShort(list) => Some(list.into_iter().map(i64::from).collect()),
                    Property::ListUShort(list) => Some(list.into_iter().map(i64::from).collect()),
                    Property::ListInt(list) => Some(list.into_iter().map(i64::from).collect()),
                    Property::ListUInt(list) => Some(list.into_iter().map(i64::from).collect()),
                    _ => return PropertyAccessResult::UnsupportedType,
                };
                return PropertyAccessResult::Set;
            }
            _ => return PropertyAccessResult::Ignored,
        };
        self.coordinates[axis] = Some(match property {
            Property::Char(value) => value.into(),
            Property::UChar(value) => value.into(),
            Property::Short(value) => value.into(),
            Property::UShort(value) => value.into(),
            Property::Int(value) => value.into(),
            Property::UInt(value) => value.into(),
            Property::Float(value) => value.into(),
            Property::Double(value) => value,
            _ => return PropertyAccessResult::UnsupportedType,
        });
        PropertyAccessResult::Set
    }
}
