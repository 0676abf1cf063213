//! PLY: the header and binary contents are read by `ply-rs-bw`, texts here.
//!
//! In a text every coordinate is read as a double, also where the header says `float`: its digits are the body.

use super::polygon::Triangulation;
use super::{Fault, MeshReport, Precision, RawMesh};
use crate::text::{check_coordinate, coordinate, excerpt};
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};
use std::collections::HashSet;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let mut reader = Reader::new(bytes);
    let parser = Parser::<Element>::new();
    let header = parser.read_header(&mut reader).map_err(|error| fault(&error))?;
    let contents = reader.get_ref().len();
    check_names(&bytes[..bytes.len() - contents])?;
    for (name, definition) in &header.elements {
        // Nothing would be read for each of them, however many the header states.
        if definition.properties.is_empty() && definition.count > 0 {
            return Err(Fault::new(format!("element {name:?} has no properties")));
        }
        // Leaving them out would lose surface.
        if name == "tristrips" && definition.count > 0 {
            return Err(Fault::new("element \"tristrips\" is not supported: faces are needed"));
        }
    }
    let is_text = header.encoding == Encoding::Ascii;
    let stated = header.elements.get("vertex").map_or(0, |vertex| vertex.count);
    let mut parts = Parts { stated, ..Parts::default() };
    if is_text {
        let line = reader.line();
        read_text(&String::from_utf8_lossy(reader.into_inner()), line, &header, &mut parts)?;
    } else {
        for (name, definition) in &header.elements {
            let elements = parser
                .read_payload_for_element(&mut reader, definition, &header)
                .map_err(|error| Fault::new(format!("{name}: {}", fault(&error).reason)))?;
            for (index, element) in elements.into_iter().enumerate() {
                let added = parts.add(name, &element);
                added.map_err(|reason| Fault::new(format!("{name} {index}: {reason}")))?;
            }
        }
        let rest = reader.into_inner();
        // Writers end files with line feeds or zeros.
        if rest.iter().any(|byte| !byte.is_ascii_whitespace() && *byte != 0) {
            let reason = format!("{} bytes are left after the elements that the header states", rest.len());
            return Err(Fault::new(reason));
        }
    }
    let mut triangulation = Triangulation::default();
    for polygon in &parts.polygons {
        triangulation.add(polygon, &parts.vertices);
    }
    let Triangulation { triangles, counts: polygons, .. } = triangulation;
    let has_floats = header.elements.get("vertex").is_some_and(|vertex| {
        let types = AXES.iter().filter_map(|axis| vertex.properties.get(*axis));
        types.into_iter().any(|property| property.data_type == PropertyType::Scalar(ScalarType::Float))
    });
    let precision = if has_floats && !is_text {
        Precision::Single("PLY with float properties")
    } else {
        Precision::Double
    };
    let report = MeshReport { polygons, precision, ..MeshReport::default() };
    Ok(RawMesh { vertices: parts.vertices, triangles, report })
}

/// The parser would read the last of two elements or properties of one name in the place of both.
fn check_names(header: &[u8]) -> Result<(), Fault> {
    let (mut elements, mut properties) = (HashSet::new(), HashSet::new());
    let text = String::from_utf8_lossy(header);
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let (names, name) = match words.next() {
            Some("element") => {
                properties.clear();
                (&mut elements, words.next())
            }
            Some("property") => (&mut properties, words.last()),
            _ => continue,
        };
        let name = name.unwrap_or_default();
        if !names.insert(name.to_owned()) {
            let reason = format!("{} is defined for the second time", excerpt(name));
            return Err(Fault::at_line(index + 1, reason));
        }
    }
    Ok(())
}

/// One element a line; blank lines are skipped.
fn read_text(text: &str, first_line: usize, header: &Header, parts: &mut Parts) -> Result<(), Fault> {
    let lines = text.lines().enumerate().map(|(index, line)| (first_line + index, line));
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty());
    for (name, definition) in &header.elements {
        for index in 0..definition.count {
            let Some((line, words)) = lines.next() else {
                let reason = format!("{name}: the file ends after {index} of {}", definition.count);
                return Err(Fault::new(reason));
            };
            let mut element = Element::default();
            element
                .read_words(words, definition)
                .and_then(|()| parts.add(name, &element))
                .map_err(|reason| Fault::at_line(line, format!("{name} {index}: {reason}")))?;
        }
    }
    match lines.next() {
        None => Ok(()),
        Some((line, words)) => {
            let reason = format!("{} is left after the elements that the header states", excerpt(words));
            Err(Fault::at_line(line, reason))
        }
    }
}

/// The parser's messages span lines: what it says first, and a chain of causes that is left out.
fn fault(error: &ParseError) -> Fault {
    let text = error.to_string();
    let mut lines = text.lines().map(str::trim);
    let first = lines.next().unwrap_or_default();
    let first =
        first.strip_prefix("Line ").and_then(|rest| rest.split_once(": ")).map_or(first, |(_, rest)| rest);
    let quoted =
        lines.find_map(|line| line.strip_prefix("String: '")).map(|line| line.trim_end_matches('\'').trim());
    let reason = match quoted.map(excerpt) {
        Some(quoted) if first.starts_with("Couldn't") => format!("cannot read {quoted}"),
        Some(quoted) => format!("{} found {quoted}", first.trim_end_matches('.')),
        None => first.to_owned(),
    };
    Fault { line: error.line(), reason }
}

/// What matters of the elements.
#[derive(Default)]
struct Parts {
    /// Vertices by the header, which faces may name before they are read.
    stated: usize,
    vertices: Vec<DVec3>,
    polygons: Vec<Vec<u32>>,
}

impl Parts {
    fn add(&mut self, name: &str, element: &Element) -> Result<(), String> {
        match name {
            "vertex" => self.vertices.push(element.position()?),
            "face" => self.polygons.push(element.polygon(self.stated)?),
            _ => {}
        }
        Ok(())
    }
}

/// What matters of a vertex or a face.
#[derive(Default)]
struct Element {
    coordinates: [Option<f64>; 3],
    indices: Option<Vec<i64>>,
}

fn axis_of(name: &str) -> Option<usize> {
    AXES.iter().position(|axis| *axis == name)
}

fn is_polygon(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

impl Element {
    fn read_words(&mut self, line: &str, definition: &ElementDef) -> Result<(), String> {
        let mut words = line.split_whitespace();
        for (name, property) in &definition.properties {
            let missing = || format!("{name} is missing");
            match property.data_type {
                PropertyType::Scalar(_) => {
                    let word = words.next().ok_or_else(missing)?;
                    if let Some(axis) = axis_of(name) {
                        self.coordinates[axis] = Some(coordinate(name, Some(word))?);
                    }
                }
                PropertyType::List(..) => {
                    let word = words.next().ok_or_else(missing)?;
                    let not_a_count = |_| format!("{name}: {} is not a length", excerpt(word));
                    let count: usize = word.parse().map_err(not_a_count)?;
                    let mut list = Vec::new();
                    for index in 0..count {
                        let word =
                            words.next().ok_or_else(|| format!("{name} has {index} of {count} entries"))?;
                        if is_polygon(name) {
                            let not_an_index = |_| format!("vertex index {} is not a number", excerpt(word));
                            list.push(word.parse().map_err(not_an_index)?);
                        }
                    }
                    if is_polygon(name) {
                        self.indices = Some(list);
                    }
                }
            }
        }
        match words.next() {
            None => Ok(()),
            Some(word) => Err(format!("{} is left after its properties", excerpt(word))),
        }
    }

    fn position(&self) -> Result<DVec3, String> {
        let mut position = [0.0; 3];
        for ((axis, value), slot) in AXES.into_iter().zip(self.coordinates).zip(&mut position) {
            *slot = value.ok_or_else(|| format!("{axis} is missing"))?;
            check_coordinate(axis, *slot)?;
        }
        Ok(DVec3::from_array(position))
    }

    fn polygon(&self, vertex_count: usize) -> Result<Vec<u32>, String> {
        let indices = self.indices.as_ref().ok_or("the list vertex_indices is missing")?;
        let check = |&index: &i64| {
            let known = u32::try_from(index).ok().filter(|&known| (known as usize) < vertex_count);
            known.ok_or_else(|| {
                format!("vertex index {index} is out of range, the file has {vertex_count} vertices")
            })
        };
        indices.iter().map(check).collect()
    }
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if is_polygon(name) {
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
        let Some(axis) = axis_of(name) else { return PropertyAccessResult::Ignored };
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
