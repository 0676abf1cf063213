//! A tree as bytes, for files that are read much faster than a tree is built.
//!
//! All numbers are little-endian, floating-point numbers as their bits. In this order:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `d2mtree` and a zero |
//! | 4 + 4 | version of the form (2), zero |
//! | 3 × 8 | numbers of vertices, triangles and wide nodes |
//! | 4 × 8 | center and radius of the body |
//! | 24 each | vertices |
//! | 12 each | triangles: three vertex numbers |
//! | 16 + 68 a box each | wide nodes: origin (three `f32`), number of boxes; then of each box center, two axes, half extents (12 `f32`), what is cut off the edges (12 bytes), radius (`f32`), and the triangle (with the highest bit) or node below it |
//! | 8 | [`checksum`] of all bytes before |

use super::mesh_tree::MeshTree;
use super::node::{Below, LEAF, OrientedBox};
use super::parts::tree_of_parts;
use super::tree_error::TreeError;
use crate::MeshError;
use crate::parallel::both;
use read::{Reader, TreeParts};
use thiserror::Error;

mod read;
#[cfg(test)]
mod tests;

const MAGIC: [u8; 8] = *b"d2mtree\0";
const VERSION: u32 = 2;

/// Bytes of the parts, as in the table above.
const HEADER: usize = 8 + 4 + 4 + 3 * 8 + 4 * 8;
const VERTEX: usize = 24;
const TRIANGLE: usize = 12;
const NODE: usize = 16;
const BOX: usize = 68;
const CHECKSUM: usize = 8;

/// Why bytes are no tree.
///
/// ```
/// use d2m_mesh::{MeshTree, TreeFileError};
/// let fault = MeshTree::try_from_bytes(b"solid part").unwrap_err();
/// assert_eq!(fault, TreeFileError::NotATree);
/// assert!(fault.to_string().contains("does not begin with"));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TreeFileError {
    /// The first bytes are not those of a written tree.
    #[error("this is not a written tree: it does not begin with \"d2mtree\"")]
    NotATree,
    /// Written by another version of this crate.
    #[error("the tree was written in form {found}, and only form {expected} can be read", expected = VERSION)]
    Version {
        /// The form of the bytes.
        found: u32,
    },
    /// Bytes are missing, or there are too many.
    #[error("the tree has {found} bytes where its parts need {needed}")]
    Length {
        /// How many bytes there are.
        found: usize,
        /// How many bytes the stated parts take, as far as that is known.
        needed: usize,
    },
    /// A byte was changed since the tree was written.
    #[error("the tree is damaged: its checksum is {found:016x} and not {stated:016x}")]
    Damaged {
        /// The checksum of the bytes.
        found: u64,
        /// The checksum that was written.
        stated: u64,
    },
    /// The mesh in it is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The boxes do not enclose the mesh, or are not linked into one tree.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

impl MeshTree {
    /// The tree as bytes, from which [`Self::try_from_bytes`] makes the same tree, bit for bit. The bytes are the same on
    /// every platform.
    pub fn to_bytes(&self) -> Vec<u8> {
        let boxes: usize = self.nodes.iter().map(|node| node.used as usize).sum();
        let length = HEADER
            + VERTEX * self.mesh.vertex_count()
            + TRIANGLE * self.mesh.triangle_count()
            + NODE * self.nodes.len()
            + BOX * boxes
            + CHECKSUM;
        let mut bytes = Vec::with_capacity(length);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend([0; 4]);
        for count in [self.mesh.vertex_count(), self.mesh.triangle_count(), self.nodes.len()] {
            bytes.extend((count as u64).to_le_bytes());
        }
        let about = self.center.to_array().into_iter().chain([self.radius]);
        for number in about.chain(self.mesh.vertices().iter().flat_map(glam::DVec3::to_array)) {
            bytes.extend(number.to_le_bytes());
        }
        for &number in self.mesh.triangles().iter().flatten() {
            bytes.extend(number.to_le_bytes());
        }
        for node in &self.nodes {
            for number in node.origin {
                bytes.extend(number.to_le_bytes());
            }
            bytes.extend(node.used.to_le_bytes());
            for lane in 0..node.used as usize {
                let OrientedBox { center, axes: [first, second, _], half_extent, slabs, radius } =
                    node.oriented_box(lane);
                for number in center.into_iter().chain(first).chain(second).chain(half_extent) {
                    bytes.extend(number.to_le_bytes());
                }
                bytes.extend(slabs.as_flattened());
                bytes.extend(radius.to_le_bytes());
                let below = match node.below(lane) {
                    Below::Triangle(triangle) => triangle | LEAF,
                    Below::Node(node) => node,
                };
                bytes.extend(below.to_le_bytes());
            }
        }
        bytes.extend(checksum(&bytes).to_le_bytes());
        debug_assert_eq!(bytes.len(), length);
        bytes
    }

    /// The tree that [`Self::to_bytes`] has written.
    ///
    /// Promise: what is returned passed [`Self::validate`], so every query may rely on it wherever the bytes came from.
    /// Takes memory in proportion to the bytes given, whatever they state.
    ///
    /// ```
    /// use d2m_mesh::{MeshTree, TreeFileError, TriMesh};
    /// use glam::DVec3;
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y * 0.1], vec![[0, 1, 2]])?;
    /// let mut bytes = MeshTree::new(mesh).to_bytes();
    /// let tree = MeshTree::try_from_bytes(&bytes)?;
    /// assert_eq!(tree.mesh().vertices()[2], DVec3::Y * 0.1);
    /// bytes[100] ^= 1;
    /// assert!(matches!(MeshTree::try_from_bytes(&bytes), Err(TreeFileError::Damaged { .. })));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`TreeFileError`]: other bytes, a byte that was changed, or forged bytes that are no tree.
    pub fn try_from_bytes(bytes: &[u8]) -> Result<Self, TreeFileError> {
        let length = |needed: usize| TreeFileError::Length { found: bytes.len(), needed };
        if !bytes.starts_with(&MAGIC) {
            return Err(TreeFileError::NotATree);
        }
        if bytes.len() < HEADER + CHECKSUM {
            return Err(length(HEADER + CHECKSUM));
        }
        let found = Reader { rest: &bytes[MAGIC.len()..] }.u32().ok_or(length(HEADER))?;
        if found != VERSION {
            return Err(TreeFileError::Version { found });
        }
        let (summed, end) = bytes.split_at(bytes.len() - CHECKSUM);
        let (found, parts) = both(|| checksum(summed), || TreeParts::try_read(bytes));
        let stated = u64_at_end(end);
        if found != stated {
            return Err(TreeFileError::Damaged { found, stated });
        }
        // Whatever the bytes are: someone may have forged the checksum, too.
        let TreeParts { mesh, nodes, center, radius } = parts?;
        Ok(tree_of_parts(mesh, nodes, center, radius)?)
    }
}

/// In a serde format a tree is its bytes, one number each: no library rounds them, and reading checks every promise again.
#[cfg(feature = "serde")]
impl serde::Serialize for MeshTree {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_bytes().serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for MeshTree {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::try_from_bytes(&Vec::<u8>::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

fn u64_at_end(bytes: &[u8]) -> u64 {
    bytes.last_chunk().map_or(0, |last| u64::from_le_bytes(*last))
}

/// Of the bytes in words of eight, the last filled up with zeros, and of their number. Each step is a bijection of the
/// state for a given word and of the word for a given state, so bytes of one length that differ in one word only always have
/// different checksums.
fn checksum(bytes: &[u8]) -> u64 {
    // 2⁶⁴ divided by the golden ratio: odd, so multiplication by it is a bijection, and its bits are well mixed.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let step = |state: u64, word: u64| {
        let product = (state ^ word).wrapping_mul(FACTOR);
        product ^ (product >> 32)
    };
    let (words, rest) = bytes.as_chunks::<8>();
    let state = words.iter().fold(bytes.len() as u64, |state, word| step(state, u64::from_le_bytes(*word)));
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    step(state, u64::from_le_bytes(last))
}
