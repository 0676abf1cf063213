//! glTF in one binary file.

use d2m_bvh::TriMesh;
use glam::Vec3;

/// The mesh as a binary glTF 2.0 file, for viewers: one mesh without normals or materials. **Coordinates are rounded to single precision**,
/// because glTF has no other; a coordinate beyond its range becomes its largest number. Nothing is turned, so what points along z does so still,
/// although glTF calls y "up". None for a mesh of more than 4 GB, which the format cannot hold.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, glb_bytes, parse_mesh};
/// let mesh = d2m_shapes::mesh("box?x=1&y=2&z=4").unwrap();
/// let bytes = glb_bytes(&mesh).unwrap();
/// let again = parse_mesh(&bytes, MeshFormat::Glb, &ReadOptions::new())?;
/// assert_eq!(again.mesh, mesh);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
pub fn glb_bytes(mesh: &TriMesh) -> Option<Vec<u8>> {
    let limit = f64::from(f32::MAX);
    let positions: Vec<Vec3> =
        mesh.vertices().iter().map(|p| p.map(|x| x.clamp(-limit, limit)).as_vec3()).collect();
    let low = positions.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = positions.iter().copied().reduce(Vec3::max).unwrap_or_default();
    let (vertices, corners) = (positions.len(), 3 * mesh.triangle_count());
    let (first, second) = (12 * vertices, 4 * corners);
    // The least numbers that a reader needs: 5126 are floats, 5125 indices, 34962 and 34963 what they are for.
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"d2m"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":{low:?},"max":{high:?}}},{{"bufferView":1,"componentType":5125,"count":{corners},"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteLength":{first},"target":34962}},{{"buffer":0,"byteOffset":{first},"byteLength":{second},"target":34963}}],"buffers":[{{"byteLength":{}}}]}}"#,
        first + second,
        low = low.to_array(),
        high = high.to_array(),
    )
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + first + second;
    let word = |number: usize| u32::try_from(number).ok().map(u32::to_le_bytes);
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    bytes.extend(word(2)?);
    bytes.extend(word(total)?);
    bytes.extend(word(json.len())?);
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend(word(first + second)?);
    bytes.extend(b"BIN\0");
    bytes.extend(positions.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes));
    bytes.extend(mesh.triangles().iter().flatten().flat_map(|index| index.to_le_bytes()));
    Some(bytes)
}
