//! Wavefront OBJ, read by `tobj`.
//!
//! `tobj` says neither in which line a fault is nor what is there, and it renumbers vertices by first use. So a scan of the
//! `v` and `f` lines comes first: it names faults, hands clean lines on (without normals, textures, groups and comments,
//! which do not matter here), and knows the positions in file order, by which the faces that `tobj` reads are numbered.
//! Vertex n of the mesh is then the first `v` line, counted from 0, with that position.

use super::LoadError;
use super::polygon::triangulate;
use d2m::bvh::{MAX_COORDINATE, TriMesh};
use glam::DVec3;
use std::collections::HashMap;
use std::fmt::Write;

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, LoadError> {
    let text = String::from_utf8_lossy(bytes);
    let scan = Scan::new(text.trim_start_matches('\u{feff}'))?;
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut scan.clean.as_bytes(), &options, no_materials)
        .map_err(|error| LoadError::new(error.to_string()))?;
    let mut numbers = HashMap::with_capacity(scan.vertices.len());
    for (number, &vertex) in scan.vertices.iter().enumerate().rev() {
        numbers.insert(key(vertex), number as u32);
    }
    let mut triangles = Vec::new();
    for model in &models {
        let positions = model.mesh.positions.chunks_exact(3).map(DVec3::from_slice);
        let positions: Vec<u32> =
            positions.map(|position| numbers.get(&key(position)).copied().unwrap_or(u32::MAX)).collect();
        let mut corners = model.mesh.indices.iter().map(|&index| positions[index as usize]);
        // No list of corner counts means triangles only.
        let all_triangles = vec![3; model.mesh.indices.len() / 3];
        let counts =
            if model.mesh.face_arities.is_empty() { &all_triangles } else { &model.mesh.face_arities };
        for &count in counts {
            let polygon: Vec<u32> = corners.by_ref().take(count as usize).collect();
            triangles.extend(triangulate(&polygon, &scan.vertices));
        }
    }
    Ok(TriMesh::try_new(scan.vertices, triangles)?)
}

fn key(position: DVec3) -> [u64; 3] {
    position.to_array().map(f64::to_bits)
}

/// The `v` lines as points, and the `v` and `f` lines without anything else.
struct Scan {
    vertices: Vec<DVec3>,
    clean: String,
}

impl Scan {
    fn new(text: &str) -> Result<Self, LoadError> {
        let mut scan = Self { vertices: Vec::new(), clean: String::with_capacity(text.len()) };
        // Absolute indices may run ahead of their vertices; they are checked at the end.
        let mut highest = (0, 0);
        let mut continued: Option<(usize, String)> = None;
        // The empty line at the end closes one that ends in a backslash.
        for (index, content) in text.lines().chain([""]).enumerate() {
            let line = index + 1;
            let content = content.split('#').next().unwrap_or_default().trim_end();
            let (line, content) = match continued.take() {
                Some((line, start)) => (line, start + " " + content),
                None => (line, content.to_owned()),
            };
            if let Some(start) = content.strip_suffix('\\') {
                continued = Some((line, start.to_owned()));
                continue;
            }
            let mut words = content.split_whitespace();
            match words.next() {
                Some("v") => scan.vertex(words, line)?,
                Some("f") => highest = highest.max(scan.face(words, line)?),
                _ => {}
            }
        }
        let count = scan.vertices.len();
        if highest.0 > count {
            let reason = format!("vertex index {} is out of range, the file has {count} vertices", highest.0);
            return Err(LoadError::at_line(highest.1, reason));
        }
        Ok(scan)
    }

    fn vertex<'a>(&mut self, mut words: impl Iterator<Item = &'a str>, line: usize) -> Result<(), LoadError> {
        let number = self.vertices.len() + 1;
        let mut position = [0.0_f64; 3];
        self.clean.push('v');
        for (axis, coordinate) in ["x", "y", "z"].into_iter().zip(&mut position) {
            let fault = |what: String| LoadError::at_line(line, format!("vertex {number}: {axis} {what}"));
            let word = words.next().ok_or_else(|| fault("is missing".to_owned()))?;
            *coordinate = word.parse().map_err(|_| fault(format!("is {word:?}, not a number")))?;
            if !coordinate.is_finite() {
                return Err(fault(format!("is {word}, not a finite number")));
            }
            if coordinate.abs() > MAX_COORDINATE {
                return Err(fault(format!("is {word}, larger than the limit of {MAX_COORDINATE:e}")));
            }
            self.clean.push(' ');
            self.clean.push_str(word);
        }
        self.clean.push('\n');
        self.vertices.push(DVec3::from_array(position));
        Ok(())
    }

    /// Returns the highest index with its line.
    fn face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<(usize, usize), LoadError> {
        let count = self.vertices.len();
        let mut highest = 0;
        self.clean.push('f');
        for word in words {
            let index = word.split('/').next().unwrap_or_default();
            let number: i64 = index
                .parse()
                .map_err(|_| LoadError::at_line(line, format!("face: {word:?} is not a vertex index")))?;
            let absolute = if number < 0 {
                count.checked_sub(number.unsigned_abs() as usize).map_or(0, |index| index + 1)
            } else {
                number as usize
            };
            if absolute == 0 {
                let reason =
                    format!("vertex index {number} is out of range, {count} vertices are given so far");
                return Err(LoadError::at_line(line, reason));
            }
            highest = highest.max(absolute);
            let _ = write!(self.clean, " {absolute}"); // writing to a string cannot fail
        }
        self.clean.push('\n');
        Ok((highest, line))
    }
}
