//! OFF: text, with doubles. The variants that state more than a place for each vertex (`COFF`, `NOFF`, `STOFF`) are read without what they add.

use super::polygon::Triangulation;
use super::{Fault, MeshReport, RawMesh};
use crate::text::{coordinate, excerpt};
use glam::DVec3;

/// A line that holds more than a comment.
struct Line<'a> {
    number: usize,
    text: &'a str,
}

impl Line<'_> {
    fn fault(&self, reason: impl std::fmt::Display) -> Fault {
        Fault::at_line(self.number, reason.to_string())
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(index, text)| Line {
            number: index + 1,
            text: text.split('#').next().unwrap_or_default().trim(),
        })
        .filter(|line| !line.text.is_empty());
    let header = lines.next().ok_or_else(|| Fault::new("the file holds nothing but comments"))?;
    let counts = counts_of(header, &mut lines)?;
    // Nothing is made for a stated count before its lines are there.
    let mut vertices = Vec::new();
    for index in 0..counts.vertices {
        let line = lines.next().ok_or_else(|| ends_early("vertex", index, counts.vertices))?;
        vertices.push(vertex(&line).map_err(|reason| line.fault(format!("vertex {index}: {reason}")))?);
    }
    let mut triangulation = Triangulation::default();
    for index in 0..counts.faces {
        let line = lines.next().ok_or_else(|| ends_early("face", index, counts.faces))?;
        let polygon = face(&line, vertices.len());
        let polygon = polygon.map_err(|reason| line.fault(format!("face {index}: {reason}")))?;
        triangulation.add(&polygon, &vertices);
    }
    if let Some(line) = lines.next() {
        let left = excerpt(line.text);
        return Err(line.fault(format!("{left} is left after the faces that the header states")));
    }
    let Triangulation { triangles, counts: polygons, .. } = triangulation;
    Ok(RawMesh { vertices, triangles, report: MeshReport { polygons, ..MeshReport::default() } })
}

struct Counts {
    vertices: usize,
    faces: usize,
}

/// The counts stand behind the keyword or in the next line; the keyword may be left out.
fn counts_of<'a>(header: Line<'a>, lines: &mut impl Iterator<Item = Line<'a>>) -> Result<Counts, Fault> {
    let (keyword, rest) = header.text.split_once(char::is_whitespace).unwrap_or((header.text, ""));
    let is_keyword = keyword.ends_with("OFF");
    if is_keyword && keyword.trim_end_matches("OFF").contains(['4', 'n']) {
        return Err(header.fault(format!("{keyword} has coordinates of more than three dimensions")));
    }
    if rest.trim() == "BINARY" {
        return Err(header.fault("binary OFF is not supported"));
    }
    let line = match (is_keyword, rest.trim()) {
        (true, "") => {
            lines.next().ok_or_else(|| header.fault("the file ends where its counts are expected"))?
        }
        (true, rest) => Line { number: header.number, text: rest },
        (false, _) => header,
    };
    let mut words = line.text.split_whitespace();
    let mut count = |what: &str| {
        let word = words.next().ok_or_else(|| line.fault(format!("the number of {what} is missing")))?;
        word.parse().map_err(|_| line.fault(format!("{} is not a number of {what}", excerpt(word))))
    };
    Ok(Counts { vertices: count("vertices")?, faces: count("faces")? })
}

fn ends_early(what: &str, index: usize, count: usize) -> Fault {
    Fault::new(format!("{what}: the file ends after {index} of {count}"))
}

fn vertex(line: &Line<'_>) -> Result<DVec3, String> {
    let mut words = line.text.split_whitespace();
    let mut position = [0.0; 3];
    for (axis, slot) in ["x", "y", "z"].into_iter().zip(&mut position) {
        *slot = coordinate(axis, words.next())?;
    }
    Ok(DVec3::from_array(position))
}

/// A number of corners and as many indices; colors may follow.
fn face(line: &Line<'_>, vertices: usize) -> Result<Vec<u32>, String> {
    let mut words = line.text.split_whitespace();
    let word = words.next().unwrap_or_default();
    let count: usize = word.parse().map_err(|_| format!("{} is not a number of corners", excerpt(word)))?;
    let mut polygon = Vec::new();
    for index in 0..count {
        let word = words.next().ok_or_else(|| format!("it has {index} of {count} corners"))?;
        let corner: u32 =
            word.parse().map_err(|_| format!("vertex index {} is not a number", excerpt(word)))?;
        if corner as usize >= vertices {
            return Err(format!("vertex index {corner} is out of range, the file has {vertices} vertices"));
        }
        polygon.push(corner);
    }
    Ok(polygon)
}
