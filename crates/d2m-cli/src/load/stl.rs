//! STL, binary or text, read by `stl_io`. Equal corners become one vertex, so that the mesh has a topology.

use super::LoadError;
use d2m::bvh::TriMesh;
use glam::DVec3;
use std::collections::HashMap;
use std::io::{self, Cursor};
use stl_io::Triangle;

/// Bytes before the triangles of a binary file, and of each triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, LoadError> {
    let mut soup = Soup::default();
    // A binary file may start with "solid" too, so its exact length decides first.
    let stated =
        bytes.get(80..84).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    let needed = stated.map(|count| HEADER + RECORD * count);
    let starts_as_text =
        bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    if needed == Some(bytes.len()) {
        binary(bytes, &mut soup)?;
    } else if starts_as_text {
        text(&String::from_utf8_lossy(bytes), &mut soup)?;
    } else {
        return Err(LoadError::new(match (stated, needed) {
            (Some(count), Some(needed)) => {
                format!(
                    "the header states {count} triangles, {needed} bytes, but the file has {}",
                    bytes.len()
                )
            }
            _ => format!("neither a text STL (\"solid\") nor a binary one: {} bytes only", bytes.len()),
        }));
    }
    Ok(TriMesh::try_new(soup.vertices, soup.triangles)?)
}

fn binary(bytes: &[u8], soup: &mut Soup) -> Result<(), LoadError> {
    // The reader takes any header that starts with "solid" for text.
    let without_title = [&[0; 80], &bytes[80..]].concat();
    let mut reader = Cursor::new(without_title);
    let triangles = stl_io::create_stl_reader(&mut reader);
    for triangle in triangles.map_err(|error| LoadError::new(error.to_string()))? {
        let triangle = triangle.map_err(|error| soup.fault(&error))?;
        soup.add(&triangle)?;
    }
    Ok(())
}

/// The lines between `solid` and `endsolid` of all parts of the file, seven for each triangle.
fn text(text: &str, soup: &mut Soup) -> Result<(), LoadError> {
    let mut clean = "solid \n".to_owned();
    let mut places = Vec::new();
    let mut is_open = false;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim().to_ascii_lowercase();
        match line.split_whitespace().next() {
            None => {}
            Some("solid") => is_open = true,
            Some("endsolid") => is_open = false,
            Some(_) => {
                places.push(index + 1);
                clean.push_str(&line);
                clean.push('\n');
            }
        }
    }
    if is_open {
        return Err(LoadError::new("the text ends without \"endsolid\""));
    }
    clean.push_str("endsolid\n");
    let mut reader = Cursor::new(clean);
    let triangles = stl_io::create_stl_reader(&mut reader);
    for triangle in triangles.map_err(|error| LoadError::new(error.to_string()))? {
        let number = soup.triangles.len();
        let at_line = |error: LoadError| LoadError { line: places.get(7 * number).copied(), ..error };
        let triangle = triangle.map_err(|error| at_line(soup.fault(&error)))?;
        soup.add(&triangle).map_err(at_line)?;
    }
    Ok(())
}

/// Triangles with their corners welded.
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    known: HashMap<[u32; 3], u32>,
}

impl Soup {
    fn fault(&self, error: &io::Error) -> LoadError {
        LoadError::new(format!("triangle {}: {error}", self.triangles.len()))
    }

    fn add(&mut self, triangle: &Triangle) -> Result<(), LoadError> {
        let number = self.triangles.len();
        let mut corners = [0; 3];
        for (corner, (slot, vertex)) in corners.iter_mut().zip(triangle.vertices.iter().enumerate()) {
            let coordinates: [f32; 3] = (*vertex).into();
            if let Some(value) = coordinates.iter().find(|value| !value.is_finite()) {
                let reason =
                    format!("triangle {number}, corner {slot}: coordinate {value} is not a finite number");
                return Err(LoadError::new(reason));
            }
            // Adding 0 turns −0 into +0.
            let coordinates = coordinates.map(|value| value + 0.0);
            *corner = *self.known.entry(coordinates.map(f32::to_bits)).or_insert_with(|| {
                self.vertices.push(DVec3::from_array(coordinates.map(f64::from)));
                self.vertices.len() as u32 - 1
            });
        }
        self.triangles.push(corners);
        Ok(())
    }
}
