//! The connected parts of a surface: which cross each other, which are inside out, and the volume of the solid.

use super::collide::try_colliding_pair;
use super::winding::contains;
use crate::mesh::Closedness;
use crate::meter::Meter;
use crate::{MeshTree, Posed, TriMesh};
use core::cell::OnceCell;
use glam::DVec3;

/// One connected part of a surface: triangles that are connected through equal positions of their vertices.
///
/// ```
/// use d2m_mesh::{MeshParts, TriMesh};
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3], [4, 5, 6]];
/// let apart = [5.0, 6.0, 7.0].map(|x| DVec3::new(x, x * x, 0.0));
/// let mesh = TriMesh::try_new([&corners[..], &apart].concat(), faces)?;
/// let parts = MeshParts::new(&mesh).parts;
/// assert_eq!((parts.len(), parts[0].triangles, parts[0].closed, parts[1].closed), (2, 4, true, false));
/// assert!((parts[0].signed_volume - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct MeshPart {
    /// The first triangle of the part in the mesh.
    pub first_triangle: u32,
    /// How many triangles it has.
    pub triangles: usize,
    /// Does it close by itself, with faces that agree about the outside?
    pub closed: bool,
    /// The volume that it encloses, rounded; negative if its faces look inwards: a cavity, or a part inside out.
    pub signed_volume: f64,
    /// Winding number of all other parts about it; `None` where it crosses one of them, or one does not close.
    pub winding_outside: Option<i32>,
}

/// The connected parts of a mesh.
///
/// ```
/// use d2m_mesh::{MeshParts, TriMesh};
/// use glam::DVec3;
/// let tetrahedron = |at: DVec3, size: f64| [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| at + p * size);
/// let faces = |k: u32| [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|i: u32| i + 4 * k));
/// let far = [tetrahedron(DVec3::ZERO, 1.0), tetrahedron(DVec3::X * 5.0, 1.0), tetrahedron(DVec3::X * 5.5, 1.0)].concat();
/// let mesh = TriMesh::try_new(far, [faces(0), faces(1), faces(2)].concat())?;
/// let parts = MeshParts::new(&mesh);
/// assert_eq!((parts.parts.len(), parts.crossing.as_slice()), (3, &[[1, 2]][..]));
/// assert_eq!(parts.solid_volume, None);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct MeshParts {
    /// The parts, in the order of their first triangles.
    pub parts: Vec<MeshPart>,
    /// Pairs of parts, by number, whose surfaces are not proven apart: they cross, touch, or repeat each other.
    pub crossing: Vec<[usize; 2]>,
    /// The volume of the points about which the winding number is not zero, rounded; `None` where parts cross or do not
    /// close.
    pub solid_volume: Option<f64>,
}

/// A part by itself.
struct Piece {
    mesh: TriMesh,
    closedness: Closedness,
    low: DVec3,
    high: DVec3,
    /// Only a part whose bounding box meets that of another needs one.
    tree: OnceCell<MeshTree>,
}

impl MeshParts {
    /// Takes the mesh apart. O(n log n) for parts whose boxes overlap few others.
    pub fn new(mesh: &TriMesh) -> Self {
        let labels = labels(mesh);
        let count = labels.iter().max().map_or(0, |most| most + 1);
        let mut members = vec![Vec::new(); count];
        for (triangle, &label) in labels.iter().enumerate() {
            members[label].push(triangle as u32);
        }
        let mut numbers = vec![None; mesh.vertex_count()];
        let pieces: Vec<Piece> =
            members.iter().map(|triangles| Piece::new(mesh, triangles, &mut numbers)).collect();
        let mut parts: Vec<MeshPart> =
            members.iter().zip(&pieces).map(|(triangles, piece)| piece.describe(triangles)).collect();
        let mut crossing = Vec::new();
        for [i, j] in near(&pieces) {
            let posed = [i, j].map(|k| Posed::at_rest(pieces[k].tree()));
            // Parts in a mesh are in no pose that could be refused; what is not known counts as crossing.
            if !matches!(try_colliding_pair(posed[0], posed[1]), Ok(None)) {
                crossing.push([i, j]);
                continue;
            }
            for [inner, outer] in [[i, j], [j, i]] {
                let sign = if parts[outer].signed_volume < 0.0 { -1 } else { 1 };
                if parts[outer].closed && pieces[outer].holds(&pieces[inner]) {
                    parts[inner].winding_outside = parts[inner].winding_outside.map(|winding| winding + sign);
                }
            }
        }
        crossing.sort_unstable();
        let all_close = parts.iter().all(|part| part.closed);
        for (k, part) in parts.iter_mut().enumerate() {
            if !all_close || crossing.iter().any(|pair| pair.contains(&k)) {
                part.winding_outside = None;
            }
        }
        let solid_volume = parts.iter().map(MeshPart::solid_volume).sum();
        Self { parts, crossing, solid_volume }
    }

    /// How many parts are inside out: their faces look inwards although they are no cavity of another part. Parts that cross
    /// others count when their own volume is negative.
    pub fn inverted_count(&self) -> usize {
        let is_inverted = |part: &&MeshPart| {
            part.signed_volume < 0.0 && part.winding_outside.is_none_or(|winding| winding <= 0)
        };
        self.parts.iter().filter(is_inverted).count()
    }
}

impl MeshPart {
    /// What it adds to the volume of the solid.
    fn solid_volume(&self) -> Option<f64> {
        let outside = self.winding_outside?;
        let inside = outside + if self.signed_volume < 0.0 { -1 } else { 1 };
        Some(match (outside != 0, inside != 0) {
            (false, true) => self.signed_volume.abs(),
            (true, false) => -self.signed_volume.abs(),
            _ => 0.0,
        })
    }
}

/// The number of the part of each triangle.
fn labels(mesh: &TriMesh) -> Vec<usize> {
    let roots = crate::mesh::part_roots(mesh);
    let mut numbers = vec![None; mesh.vertex_count()];
    let mut count = 0;
    let number = |triangle: &[u32; 3]| {
        *numbers[roots[triangle[0] as usize] as usize].get_or_insert_with(|| {
            count += 1;
            count - 1
        })
    };
    mesh.triangles().iter().map(number).collect()
}

/// Pairs of parts whose bounding boxes overlap: sorted along x and swept.
fn near(pieces: &[Piece]) -> Vec<[usize; 2]> {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&i, &j| pieces[i].low.x.total_cmp(&pieces[j].low.x));
    let (mut pairs, mut open): (Vec<[usize; 2]>, Vec<usize>) = (Vec::new(), Vec::new());
    for &k in &order {
        open.retain(|&other| pieces[other].high.x >= pieces[k].low.x);
        for &other in &open {
            let (a, b) = (&pieces[k], &pieces[other]);
            if a.low.cmple(b.high).all() && b.low.cmple(a.high).all() {
                pairs.push([k.min(other), k.max(other)]);
            }
        }
        open.push(k);
    }
    pairs
}

impl Piece {
    /// `numbers` is for the vertices of the mesh, none of which another part has.
    fn new(mesh: &TriMesh, triangles: &[u32], numbers: &mut [Option<u32>]) -> Self {
        let mut vertices = Vec::new();
        let mut corner = |vertex: u32| {
            *numbers[vertex as usize].get_or_insert_with(|| {
                vertices.push(mesh.vertices()[vertex as usize]);
                vertices.len() as u32 - 1
            })
        };
        let own: Vec<[u32; 3]> =
            triangles.iter().map(|&t| mesh.triangles()[t as usize].map(&mut corner)).collect();
        let (low, high) = vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let mesh = TriMesh::try_new(vertices, own).expect("a part of a checked mesh");
        let closedness = Closedness::of(&mesh);
        Self { mesh, closedness, low, high, tree: OnceCell::new() }
    }

    fn tree(&self) -> &MeshTree {
        self.tree.get_or_init(|| MeshTree::new(self.mesh.clone()))
    }

    fn describe(&self, triangles: &[u32]) -> MeshPart {
        let Closedness { watertight, oriented, repeated, .. } = &self.closedness;
        let center = self.low * 0.5 + self.high * 0.5;
        let counts = |k: &usize| repeated.binary_search(&(*k as u32)).is_err();
        let volume = |k: usize| {
            let [a, b, c] = self.mesh.corners(k).map(|p| p - center);
            a.dot(b.cross(c)) / 6.0
        };
        MeshPart {
            first_triangle: triangles[0],
            triangles: triangles.len(),
            closed: *watertight && *oriented,
            signed_volume: (0..self.mesh.triangle_count()).filter(counts).map(volume).sum(),
            winding_outside: Some(0),
        }
    }

    /// Is the other part, whose surface does not touch this one, inside?
    fn holds(&self, other: &Self) -> bool {
        let tree = self.tree();
        let vertex = other.mesh.corners(0)[0] - tree.center();
        contains(tree, vertex, &mut Meter::unlimited()) != Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::Surface;

    fn joined(parts: &[(f64, f64, bool)]) -> TriMesh {
        let surfaces = parts.iter().map(|&(x, half, inverted)| {
            let cube = Surface::cube(half).map(|vertex| vertex + DVec3::X * x);
            if inverted { cube.inverted() } else { cube }
        });
        surfaces.reduce(|all, next| all.with(&next)).expect("a part").into_mesh(TriMesh::try_new)
    }

    /// Cubes at x with half sides, some inside out: parts, crossings, inverted ones and the volume.
    #[test]
    fn parts_crossings_and_volumes() {
        for (cubes, crossing, inverted, volume) in [
            (vec![(0.0, 1.0, false)], 0, 0, Some(8.0)),
            (vec![(0.0, 1.0, true)], 0, 1, Some(8.0)),
            (vec![(0.0, 1.0, false), (5.0, 0.5, true)], 0, 1, Some(9.0)),
            // A cavity, an island in it, a part in the middle of another one.
            (vec![(0.0, 2.0, false), (0.0, 1.0, true)], 0, 0, Some(56.0)),
            (vec![(0.0, 2.0, false), (0.0, 1.0, true), (0.0, 0.5, false)], 0, 0, Some(57.0)),
            (vec![(0.0, 2.0, false), (0.0, 1.0, false)], 0, 0, Some(64.0)),
            // Parts that overlap, and one that is repeated.
            (vec![(0.0, 1.0, false), (1.5, 1.25, false), (9.0, 1.0, false)], 1, 0, None),
        ] {
            let parts = MeshParts::new(&joined(&cubes));
            assert_eq!(parts.parts.len(), cubes.len());
            assert_eq!((parts.crossing.len(), parts.inverted_count()), (crossing, inverted), "{cubes:?}");
            assert_eq!(parts.solid_volume, volume, "{cubes:?}");
        }
        let open = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]).unwrap();
        let parts = MeshParts::new(&open);
        assert!(!parts.parts[0].closed && parts.solid_volume.is_none());
    }
}
