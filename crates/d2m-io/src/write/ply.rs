//! PLY.

use d2m_bvh::TriMesh;

/// The mesh as a binary PLY file of doubles: reading it gives the same mesh, bit by bit.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, parse_mesh, ply_bytes};
/// let mesh = d2m_shapes::mesh("gear?triangles=500").unwrap();
/// let again = parse_mesh(&ply_bytes(&mesh), MeshFormat::Ply, &ReadOptions::new())?;
/// assert_eq!(again.mesh, mesh);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
pub fn ply_bytes(mesh: &TriMesh) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertex_count(),
        mesh.triangle_count()
    )
    .into_bytes();
    for vertex in mesh.vertices() {
        bytes.extend(vertex.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    for corners in mesh.triangles() {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}
