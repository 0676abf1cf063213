use super::*;
use crate::{MeshFormat, ReadOptions, parse_mesh};
use d2m_bvh::TriMesh;

/// Every double comes back from texts and doubles; what is too large for a float is clamped.
#[test]
fn extreme_numbers_survive() {
    let numbers =
        [[5e-324, -0.1, 1e60], [1.0 / 3.0, -1e-300, 2.0f64.powi(80)], [0.0, 7.0, 123_456_789.123_456_79]];
    let mesh = TriMesh::from_arrays(&numbers, &[[0, 1, 2]]).unwrap();
    let options = ReadOptions::new();
    assert_eq!(parse_mesh(obj_text(&mesh).as_bytes(), MeshFormat::Obj, &options).unwrap().mesh, mesh);
    assert_eq!(parse_mesh(&ply_bytes(&mesh), MeshFormat::Ply, &options).unwrap().mesh, mesh);
    let single = parse_mesh(&glb_bytes(&mesh).unwrap(), MeshFormat::Glb, &options).unwrap().mesh;
    assert_eq!(single.vertices()[0].z, f64::from(f32::MAX));
    for (vertex, exact) in single.vertices().iter().zip(mesh.vertices()).skip(1) {
        assert_eq!(*vertex, exact.as_vec3().as_dvec3());
    }
}
