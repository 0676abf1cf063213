//! The parts of a tree from bytes.

use super::{BOX, CHECKSUM, HEADER, MAGIC, NODE, TRIANGLE, TreeFileError, VERTEX};
use crate::parallel::{both, map_in_order};
use crate::tree::node::{Below, LEAF, OrientedBox, WIDTH, WideNode};
use crate::tree::parts::node_of_parts;
use crate::tree::tree_error::TreeError;
use crate::{MeshError, TriMesh};
use d2m_lanes::three::cross;
use glam::DVec3;

/// What the bytes state, unchecked but for the mesh.
pub(super) struct TreeParts {
    pub(super) mesh: TriMesh,
    pub(super) nodes: Vec<WideNode>,
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl TreeParts {
    /// From all bytes, whatever they are; there are enough for a header and a checksum. Takes memory in proportion to their
    /// number.
    pub(super) fn try_read(bytes: &[u8]) -> Result<Self, TreeFileError> {
        let length = |needed: usize| TreeFileError::Length { found: bytes.len(), needed };
        let mut reader = Reader { rest: &bytes[MAGIC.len() + 2 * 4..bytes.len() - CHECKSUM] };
        let mut header = || Some(([reader.count()?, reader.count()?, reader.count()?], reader.f64s::<4>()?));
        let ([vertices, triangles, nodes], [x, y, z, radius]) = header().ok_or(length(HEADER))?;
        // What cannot be counted is more than there is.
        let size = |count: usize, size: usize| count.saturating_mul(size);
        let (vertices, triangles) = (size(vertices, VERTEX), size(triangles, TRIANGLE));
        let least = [HEADER + CHECKSUM, vertices, triangles, size(nodes, NODE)];
        let least = least.into_iter().fold(0, usize::saturating_add);
        if least > bytes.len() {
            return Err(length(least));
        }
        let (vertices, rest) = reader.rest.split_at(vertices);
        let (triangles, rest) = rest.split_at(triangles);
        let origins = node_starts(rest, nodes)?;
        let (needed, found) = (origins.needed + (bytes.len() - rest.len()), bytes.len());
        if needed != found {
            return Err(TreeFileError::Length { found, needed });
        }
        let (mesh, nodes) = both(
            || read_mesh(vertices, triangles),
            || map_in_order(&origins.starts, 1, |&start| read_node(&rest[start..])),
        );
        Ok(Self { mesh: mesh?, nodes, center: DVec3::new(x, y, z), radius })
    }
}

/// Where nodes begin.
struct NodeStarts {
    starts: Vec<usize>,
    /// Bytes that all of them take; or those up to the end of the first one that is not there in full.
    needed: usize,
}

/// Nodes follow each other, and each states how many boxes it has.
fn node_starts(bytes: &[u8], count: usize) -> Result<NodeStarts, TreeError> {
    let mut starts = Vec::with_capacity(count);
    let mut needed = 0;
    for node in 0..count {
        let Some(bytes) = bytes.get(needed..needed + NODE) else {
            needed += NODE;
            break;
        };
        let used = Reader { rest: &bytes[NODE - 4..] }.u32().map_or(0, |used| used as usize);
        if used > WIDTH {
            return Err(TreeError::Link { node });
        }
        starts.push(needed);
        needed += NODE + used * BOX;
    }
    Ok(NodeStarts { starts, needed })
}

fn read_node(bytes: &[u8]) -> WideNode {
    let mut reader = Reader { rest: bytes };
    let (origin, used) = (reader.f32s().unwrap_or_default(), reader.u32().unwrap_or(0));
    node_of_parts(origin, (0..used).map_while(|_| reader.boxed()))
}

fn read_mesh(vertices: &[u8], triangles: &[u8]) -> Result<TriMesh, MeshError> {
    let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
    let (numbers, _) = vertices.as_chunks();
    let (positions, _) = numbers.as_chunks();
    let positions = positions.iter().map(|[x, y, z]| DVec3::new(number(x), number(y), number(z)));
    let (indices, _) = triangles.as_chunks();
    let (corners, _) = indices.as_chunks();
    let corners = corners.iter().map(|corners: &[[u8; 4]; 3]| corners.map(u32::from_le_bytes));
    TriMesh::try_new(positions.collect(), corners.collect())
}

/// Reads numbers; `None` where bytes are missing.
pub(super) struct Reader<'a> {
    pub(super) rest: &'a [u8],
}

impl Reader<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(*first)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    /// A number of parts; what no memory could hold is more than there can be.
    fn count(&mut self) -> Option<usize> {
        self.bytes().map(|bytes| usize::try_from(u64::from_le_bytes(bytes)).unwrap_or(usize::MAX))
    }

    fn f32s<const N: usize>(&mut self) -> Option<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.bytes().map(f32::from_le_bytes)?;
        }
        Some(numbers)
    }

    fn f64s<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.bytes().map(f64::from_le_bytes)?;
        }
        Some(numbers)
    }

    fn boxed(&mut self) -> Option<(OrientedBox, Below)> {
        let bytes: [u8; BOX] = self.bytes()?;
        let (words, _) = bytes.as_chunks::<4>();
        let number = |k: usize| f32::from_le_bytes(words[k]);
        let three = |k: usize| [number(k), number(k + 1), number(k + 2)];
        let (first, second) = (three(3), three(6));
        let (axes, slabs) = ([first, second, cross(&first, &second)], [words[12], words[13], words[14]]);
        let boxed = OrientedBox { center: three(0), axes, half_extent: three(9), slabs, radius: number(15) };
        let below = u32::from_le_bytes(words[16]);
        let below = if below & LEAF != 0 { Below::Triangle(below & !LEAF) } else { Below::Node(below) };
        Some((boxed, below))
    }
}
