use crate::{MAX_COORDINATE, MeshError, Topology, TriMesh, Validation};
use glam::DVec3;

const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn corners() -> Vec<DVec3> {
    vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]
}

#[test]
fn refusals_name_index_and_value() {
    assert_eq!(TriMesh::try_new(corners(), vec![]), Err(MeshError::NoTriangles));
    for value in [f64::INFINITY, f64::NEG_INFINITY, 1.1e60, -1e300, f64::NAN] {
        let mut vertices = corners();
        vertices[2].y = value;
        let error = TriMesh::try_new(vertices, FACES.to_vec()).unwrap_err();
        let message = error.to_string();
        assert!(message.starts_with("vertex 2: coordinate y is"), "{message}");
        assert_eq!(matches!(error, MeshError::NonFiniteVertex { .. }), !value.is_finite(), "{message}");
    }
    let mut vertices = corners();
    vertices[0].x = MAX_COORDINATE;
    assert!(TriMesh::try_new(vertices, FACES.to_vec()).is_ok());
    let error = TriMesh::try_new(corners(), vec![[0, 1, 2], [0, u32::MAX, 1]]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "triangle 1: vertex index 4294967295 is out of range, the mesh has 4 vertices"
    );
    assert!(TriMesh::try_new(vec![], vec![[0, 0, 0]]).is_err());
}

#[test]
fn seams_are_welded_and_degenerate_and_repeated_triangles_are_harmless() {
    // Every triangle with corners of its own, as an STL file has them, one zero negative.
    let soup: Vec<DVec3> = FACES.iter().flatten().map(|&vertex| corners()[vertex as usize]).collect();
    let mut soup: Vec<DVec3> =
        soup.iter().map(|&p| if p == DVec3::X { DVec3::new(1.0, -0.0, 0.0) } else { p }).collect();
    let mut faces: Vec<[u32; 3]> = (0..4).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let clean = Validation::new(&TriMesh::try_new(soup.clone(), faces.clone()).unwrap());
    assert!(clean.watertight && clean.consistently_oriented);
    assert_eq!((clean.euler_characteristic, clean.components, clean.duplicate_vertices), (2, 1, 8));
    assert!((clean.signed_volume - 1.0 / 6.0).abs() < 1e-15);
    soup.push(DVec3::splat(7.0));
    faces.push([1, 2, 0]); // the first triangle again
    faces.push([5, 5, 5]);
    faces.push([0, 1, 1]);
    let noisy = Validation::new(&TriMesh::try_new(soup, faces).unwrap());
    assert!(noisy.watertight && noisy.consistently_oriented);
    assert_eq!((noisy.duplicate_triangles, noisy.degenerate_triangles, noisy.unused_vertices), (1, 2, 1));
    assert_eq!(noisy.bounds_high, [1.0, 1.0, 1.0]);
}

#[test]
fn open_flipped_and_non_manifold_meshes_are_seen() {
    let open = Topology::new(&TriMesh::try_new(corners(), FACES[..3].to_vec()).unwrap());
    assert!(!open.is_watertight() && !open.is_consistently_oriented());
    let mut flipped = FACES;
    flipped[1].swap(0, 1);
    let flipped = TriMesh::try_new(corners(), flipped.to_vec()).unwrap();
    let validation = Validation::new(&flipped);
    assert!(validation.watertight && !validation.consistently_oriented);
    assert_eq!(validation.inconsistent_edges, 3);
    // Two tetrahedra glued along an edge: four sides there, still watertight and oriented.
    let mut vertices = corners();
    vertices.extend([-DVec3::X, -DVec3::Y]);
    let mut faces = FACES.to_vec();
    faces.extend([[0, 5, 4], [0, 4, 3], [0, 3, 5], [4, 5, 3]]);
    let glued = TriMesh::try_new(vertices, faces).unwrap();
    let validation = Validation::new(&glued);
    assert_eq!((validation.non_manifold_edges, validation.components), (1, 1));
    assert!(validation.watertight && validation.consistently_oriented);
    assert!(!Topology::new(&glued).is_oriented_manifold());
}

#[test]
fn every_neighbour_relation_is_mutual() {
    let mesh = TriMesh::try_new(corners(), FACES.to_vec()).unwrap();
    let topology = Topology::new(&mesh);
    assert!(topology.is_oriented_manifold());
    for triangle in 0..4 {
        for side in 0..3 {
            let other = topology.neighbour(triangle, side).unwrap();
            let back = (0..3).filter(|&side| topology.neighbour(other, side) == Some(triangle)).count();
            assert_eq!(back, 1);
            let edge = topology.edges()[topology.edge_of(triangle, side).unwrap() as usize];
            let corners = mesh.triangles()[triangle as usize];
            let mut ends = [corners[side], corners[(side + 1) % 3]];
            ends.sort_unstable();
            assert_eq!(edge.vertices, ends);
        }
    }
}

#[test]
fn degenerate_means_exactly_collinear() {
    // Tiny and thin, but with area; then three multiples of one point.
    let thin = vec![DVec3::ZERO, DVec3::X * 1e-200, DVec3::Y * 1e-200];
    let count = |vertices: Vec<DVec3>| {
        Validation::new(&TriMesh::try_new(vertices, vec![[0, 1, 2]]).unwrap()).degenerate_triangles
    };
    assert_eq!(count(thin), 0);
    let p = DVec3::new(0.1, 0.7, -0.3);
    assert_eq!(count(vec![p, p * 2.0, p * -4.0]), 1);
    assert_eq!(count(vec![p, p * 3.0, p * 7.0]), 0, "fl(3p) is not on the line");
}

#[test]
fn pinched_vertices_are_counted() {
    let validation = |vertices: Vec<DVec3>, faces: Vec<[u32; 3]>| {
        Validation::new(&TriMesh::try_new(vertices, faces).unwrap())
    };
    assert_eq!(validation(corners(), FACES.to_vec()).pinched_vertices, 0);
    assert_eq!(validation(corners(), FACES[..2].to_vec()).pinched_vertices, 0);
    // Two tetrahedra that share one vertex, and two that share an edge, where all triangles are joined.
    let mut vertices = corners();
    vertices.extend([-DVec3::X, -DVec3::Y, -DVec3::Z]);
    let second = [[0, 4, 5], [0, 6, 4], [0, 5, 6], [4, 6, 5]];
    assert_eq!(validation(vertices.clone(), [FACES, second].concat()).pinched_vertices, 1);
    // The same with a vertex of its own at that position, and one triangle twice.
    vertices.push(DVec3::ZERO);
    let second = second.map(|t: [u32; 3]| t.map(|i| if i == 0 { 7 } else { i }));
    assert_eq!(validation(vertices, [&FACES[..], &second[..], &second[..1]].concat()).pinched_vertices, 1);
}

/// Mirrors whose determinant rounds to zero or overflows turn their triangles round all the same.
#[test]
fn the_outside_stays_outside_under_any_map() {
    let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mesh = TriMesh::from_soup(&[[o, y, x], [o, x, z], [o, z, y], [x, y, z]]).unwrap();
    for (scale, mirrored) in [
        (DVec3::new(-1e-200, 1e-200, 1e-200), true),
        (DVec3::new(1e-200, -1e-200, -1e-200), false),
        (DVec3::new(1e40, 1e40, -1e-50), true),
        (DVec3::splat(-5e-324), true),
        (DVec3::new(0.0, -1.0, 1.0), false),
    ] {
        let image = mesh.clone().transformed(&glam::DAffine3::from_scale(scale)).unwrap();
        let [a, b, c] = mesh.triangles()[3];
        let expected = if mirrored { [a, c, b] } else { [a, b, c] };
        assert_eq!(image.triangles()[3], expected, "{scale}");
        assert_eq!(image.vertices()[1], mesh.vertices()[1] * scale);
    }
    let bad = mesh.transformed(&glam::DAffine3::from_translation(DVec3::new(0.0, f64::NAN, 0.0)));
    assert!(matches!(bad, Err(MeshError::NonFiniteVertex { vertex: 0, axis: 'y', .. })), "{bad:?}");
}

#[test]
fn merging_keeps_corners_and_what_is_unused() {
    let vertices = vec![DVec3::X, DVec3::ZERO, -DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mesh = TriMesh::try_new(vertices, vec![[0, 2, 4], [3, 1, 4]]).unwrap();
    let merged = mesh.clone().merged();
    assert_eq!(merged.vertices(), [DVec3::X, DVec3::ZERO, DVec3::Y, DVec3::Z]);
    for triangle in 0..2 {
        assert_eq!(merged.corners(triangle), mesh.corners(triangle));
    }
    assert_eq!(merged.clone().merged(), merged);
    let nothing = TriMesh::from_soup(&[]);
    assert_eq!(nothing, Err(MeshError::NoTriangles));
}
