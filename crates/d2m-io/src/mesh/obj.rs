//! Wavefront OBJ.
//!
//! The `v` and `f` lines count; normals, textures, groups, materials, points and lines do not matter here. Coordinates
//! are doubles, correctly rounded whatever their number of digits. Vertices keep the numbers of the file.

use super::polygon::Triangulation;
use super::{Fault, MeshReport, RawMesh};
use crate::text::{coordinate, excerpt};
use glam::DVec3;

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut scan = Scan::default();
    let mut statement = Vec::new();
    for (index, content) in lines(text.trim_start_matches('\u{feff}')).enumerate() {
        let content = content.split('#').next().unwrap_or_default().trim_end();
        let (content, goes_on) = match content.strip_suffix('\\') {
            Some(start) => (start, true),
            None => (content, false),
        };
        statement.extend(content.split_whitespace().map(|word| Word { line: index + 1, text: word }));
        if !goes_on {
            scan.statement(&statement)?;
            statement.clear();
        }
    }
    scan.statement(&statement)?;
    scan.finish()
}

/// Lines that end in a line feed, a carriage return, or both.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

/// A word with its line, from 1: a statement may go on over lines that end in a backslash.
#[derive(Clone, Copy)]
struct Word<'a> {
    line: usize,
    text: &'a str,
}

#[derive(Default)]
struct Scan {
    vertices: Vec<DVec3>,
    /// Corners of all faces, and how many each has.
    corners: Vec<u32>,
    counts: Vec<usize>,
    /// The highest index with its line: absolute indices may run ahead of their vertices.
    highest: (usize, usize),
}

impl Scan {
    fn statement(&mut self, words: &[Word<'_>]) -> Result<(), Fault> {
        let Some((keyword, words)) = words.split_first() else { return Ok(()) };
        match keyword.text {
            "v" => self.vertex(keyword.line, words),
            "f" | "fo" => self.face(words),
            // Leaving them out would lose surface.
            "surf" => Err(Fault::at_line(keyword.line, "free-form surfaces are not supported")),
            _ => Ok(()),
        }
    }

    fn vertex(&mut self, line: usize, words: &[Word<'_>]) -> Result<(), Fault> {
        let number = self.vertices.len() + 1;
        let mut position = [0.0; 3];
        for (index, (axis, slot)) in ["x", "y", "z"].into_iter().zip(&mut position).enumerate() {
            let word = words.get(index);
            let line = word.map_or(line, |word| word.line);
            *slot = coordinate(axis, word.map(|word| word.text))
                .map_err(|reason| Fault::at_line(line, format!("vertex {number}: {reason}")))?;
        }
        self.vertices.push(DVec3::from_array(position));
        Ok(())
    }

    fn face(&mut self, words: &[Word<'_>]) -> Result<(), Fault> {
        for &Word { line, text } in words {
            let absolute = self.corner(text).map_err(|reason| Fault::at_line(line, reason))?;
            self.highest = self.highest.max((absolute, line));
            self.corners.push((absolute - 1) as u32);
        }
        self.counts.push(words.len());
        Ok(())
    }

    /// The number of a vertex, from 1, of `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative ones count back from the last.
    fn corner(&self, word: &str) -> Result<usize, String> {
        let fault = || format!("face: {} is not a vertex index", excerpt(word));
        let mut parts = word.split('/');
        let number: i64 = parts.next().unwrap_or_default().parse().map_err(|_| fault())?;
        let others_are_indices = parts.clone().all(|part| part.is_empty() || part.parse::<i64>().is_ok());
        if parts.count() > 2 || !others_are_indices {
            return Err(fault());
        }
        let count = self.vertices.len();
        let absolute = match usize::try_from(number) {
            Ok(absolute) => absolute,
            Err(_) => usize::try_from(number.unsigned_abs())
                .ok()
                .and_then(|back| count.checked_sub(back))
                .map_or(0, |index| index + 1),
        };
        if absolute == 0 {
            return Err(format!("vertex index {number} is out of range, {count} vertices are given so far"));
        }
        Ok(absolute)
    }

    fn finish(self) -> Result<RawMesh, Fault> {
        let (count, (highest, line)) = (self.vertices.len(), self.highest);
        if highest > count {
            let reason = format!("vertex index {highest} is out of range, the file has {count} vertices");
            return Err(Fault::at_line(line, reason));
        }
        let mut triangulation = Triangulation::default();
        let mut corners = self.corners.as_slice();
        for &count in &self.counts {
            let (polygon, rest) = corners.split_at(count);
            triangulation.add(polygon, &self.vertices);
            corners = rest;
        }
        let Triangulation { triangles, counts: polygons, .. } = triangulation;
        let report = MeshReport { polygons, ..MeshReport::default() };
        Ok(RawMesh { vertices: self.vertices, triangles, report })
    }
}
