//! Wavefront OBJ.

use d2m_bvh::TriMesh;
use std::fmt::Write;

/// The mesh as a Wavefront OBJ text. Every number has the digits that give its bits back, so reading the text gives the same mesh.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, obj_text, parse_mesh};
/// let mesh = d2m_shapes::mesh("gear?triangles=500").unwrap();
/// let again = parse_mesh(obj_text(&mesh).as_bytes(), MeshFormat::Obj, &ReadOptions::new())?;
/// assert_eq!(again.mesh, mesh);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
pub fn obj_text(mesh: &TriMesh) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    for vertex in mesh.vertices() {
        let _ = writeln!(text, "v {} {} {}", vertex.x, vertex.y, vertex.z);
    }
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|vertex| u64::from(vertex) + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}
