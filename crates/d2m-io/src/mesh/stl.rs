//! STL, binary (read by `stl_io`) or text. Corners are vertices of their own; whoever reads merges them, so that the
//! mesh has a topology.
//!
//! A binary file holds single precision. The numbers of a text are read as doubles: rounded to single precision they
//! would be another body.

use super::{Fault, MeshReport, Precision, RawMesh};
use crate::text::{coordinate, excerpt};
use glam::DVec3;
use std::io::Cursor;

/// Bytes before the triangles of a binary file, and of each triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    // A binary file may start with "solid" too, so its exact length decides first.
    let stated =
        bytes.get(80..84).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    let needed = stated.map(|count| count.saturating_mul(RECORD).saturating_add(HEADER));
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes).trim_ascii_start();
    let starts_as_text = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let (soup, precision) = if needed == Some(bytes.len()) {
        (binary(bytes)?, Precision::Single("binary STL"))
    } else if starts_as_text && !bytes.contains(&0) {
        (Text::new(&String::from_utf8_lossy(bytes)).parse()?, Precision::Double)
    } else {
        return Err(Fault::new(match (stated, needed) {
            (Some(count), Some(needed)) => {
                format!(
                    "the header states {count} triangles, {needed} bytes, but the file has {}",
                    bytes.len()
                )
            }
            _ => format!("neither a text STL (\"solid\") nor a binary one: {} bytes only", bytes.len()),
        }));
    };
    let report = MeshReport { precision, ..MeshReport::default() };
    Ok(RawMesh { vertices: soup.vertices, triangles: soup.triangles, report })
}

fn binary(bytes: &[u8]) -> Result<Soup, Fault> {
    let mut soup = Soup::default();
    // The reader takes any header that starts with "solid" for text.
    let without_title = [&[0; 80], &bytes[80..]].concat();
    let mut reader = Cursor::new(without_title);
    let triangles = stl_io::create_stl_reader(&mut reader);
    for (number, triangle) in triangles.map_err(|error| Fault::new(error.to_string()))?.enumerate() {
        let triangle = triangle.map_err(|error| Fault::new(format!("triangle {number}: {error}")))?;
        let mut corners = [DVec3::ZERO; 3];
        for (corner, (slot, vertex)) in corners.iter_mut().zip(triangle.vertices).enumerate() {
            let coordinates: [f32; 3] = vertex.into();
            if let Some(value) = coordinates.iter().find(|value| !value.is_finite()) {
                let reason =
                    format!("triangle {number}, corner {corner}: coordinate {value} is not a finite number");
                return Err(Fault::new(reason));
            }
            *slot = DVec3::from_array(coordinates.map(f64::from));
        }
        soup.add(corners);
    }
    Ok(soup)
}

/// The words of a text, with where they are.
struct Text<'a> {
    words: std::iter::Peekable<Box<dyn Iterator<Item = (usize, &'a str)> + 'a>>,
    /// Line of the last word.
    line: usize,
}

impl<'a> Text<'a> {
    fn new(text: &'a str) -> Self {
        let lines = text.trim_start_matches('\u{feff}').split('\n').enumerate();
        let words =
            lines.flat_map(|(index, line)| line.split_whitespace().map(move |word| (index + 1, word)));
        let words: Box<dyn Iterator<Item = _> + 'a> = Box::new(words);
        Self { words: words.peekable(), line: 1 }
    }

    /// All parts of the file, each from `solid` to `endsolid`; what stands behind these two words is a title.
    fn parse(mut self) -> Result<Soup, Fault> {
        let mut soup = Soup::default();
        let mut is_open = false;
        while let Some((line, word)) = self.next() {
            let is = |expected: &str| word.eq_ignore_ascii_case(expected);
            if is("solid") || is("endsolid") {
                is_open = is("solid");
                while self.words.next_if(|&(next, _)| next == line).is_some() {}
            } else if is("facet") && is_open {
                let number = soup.triangles.len();
                let corners = self.facet().map_err(|Fault { line, reason }| {
                    let reason = format!("triangle {number}: {reason}");
                    Fault { line, reason }
                })?;
                soup.add(corners);
            } else {
                let expected = if is_open { "\"facet\" or \"endsolid\"" } else { "\"solid\"" };
                return Err(Fault::at_line(line, format!("{expected} is expected, not {}", excerpt(word))));
            }
        }
        if is_open { Err(Fault::new("the text ends without \"endsolid\"")) } else { Ok(soup) }
    }

    fn next(&mut self) -> Option<(usize, &'a str)> {
        let found = self.words.next();
        self.line = found.map_or(self.line, |(line, _)| line);
        found
    }

    fn expect(&mut self, expected: &str) -> Result<(), Fault> {
        match self.next() {
            Some((_, word)) if word.eq_ignore_ascii_case(expected) => Ok(()),
            Some((line, word)) => {
                Err(Fault::at_line(line, format!("{expected:?} is expected, not {}", excerpt(word))))
            }
            None => Err(Fault::at_line(self.line, format!("the text ends where {expected:?} is expected"))),
        }
    }

    /// What follows the word `facet`. Normals are not read: writers put anything there.
    fn facet(&mut self) -> Result<[DVec3; 3], Fault> {
        self.expect("normal")?;
        for _ in 0..3 {
            self.next();
        }
        self.expect("outer")?;
        self.expect("loop")?;
        let mut corners = [DVec3::ZERO; 3];
        for (number, corner) in corners.iter_mut().enumerate() {
            self.expect("vertex")?;
            let mut position = [0.0; 3];
            for (axis, slot) in ["x", "y", "z"].into_iter().zip(&mut position) {
                let word = self.next().map(|(_, word)| word);
                *slot = coordinate(axis, word)
                    .map_err(|reason| Fault::at_line(self.line, format!("corner {number}: {reason}")))?;
            }
            *corner = DVec3::from_array(position);
        }
        self.expect("endloop")?;
        self.expect("endfacet")?;
        Ok(corners)
    }
}

/// Triangles, each with vertices of its own.
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    fn add(&mut self, corners: [DVec3; 3]) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners);
        self.triangles.push([first, first.wrapping_add(1), first.wrapping_add(2)]);
    }
}
