use super::*;
use glam::DQuat;

fn shape(text: &str) -> TriMesh {
    d2m_shapes::mesh(text).unwrap()
}

fn moved(mesh: &TriMesh, by: DVec3, turn: DQuat) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    (mesh.vertices().iter().map(|&p| turn * p + by).collect(), mesh.triangles().to_vec())
}

fn joined(parts: &[(Vec<DVec3>, Vec<[u32; 3]>)]) -> TriMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (v, t) in parts {
        let base = vertices.len() as u32;
        vertices.extend(v);
        triangles.extend(t.iter().map(|c| c.map(|i| i + base)));
    }
    TriMesh::try_new(vertices, triangles).unwrap()
}

fn flipped((v, t): (Vec<DVec3>, Vec<[u32; 3]>)) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    (v, t.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

#[test]
fn far_from_the_origin_and_turned() {
    let turn = DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize();
    let by = DVec3::new(1e3, -2e3, 5e2);
    let (v, t) = moved(&shape("box?x=0.5&y=1&z=1.5"), by, turn);
    let brick = MassProperties::try_from_density(&TriMesh::try_new(v, t).unwrap(), 3.0).unwrap();
    let r = DMat3::from_quat(turn);
    let wanted = r * DMat3::from_diagonal(DVec3::new(13.0, 10.0, 5.0) * 18.0 / 12.0) * r.transpose();
    assert!((brick.mass - 18.0).abs() < 1e-10 && (brick.center - by).length() < 1e-10);
    assert!(largest(&(brick.inertia - wanted)) < 1e-9, "{:?}", brick.inertia);
}

#[test]
fn a_ball_of_many_triangles_is_nearly_a_ball() {
    let sphere = MassProperties::try_from_mass(&shape("icosphere?triangles=20000"), 2.0).unwrap();
    assert!(
        (sphere.inertia.x_axis.x / sphere.inertia.z_axis.z - 1.0).abs() < 1e-4
            && sphere.center.length() < 1e-12
    );
    assert_eq!(sphere.mass, 2.0);
}

#[test]
fn a_shell_is_the_difference_and_inward_is_outward() {
    let outer = moved(&shape("box?x=1&y=1&z=1"), DVec3::ZERO, DQuat::IDENTITY);
    let inner = moved(&shape("box?x=0.5&y=0.5&z=0.5"), DVec3::ZERO, DQuat::IDENTITY);
    let shell = joined(&[outer.clone(), flipped(inner.clone())]);
    let mass = MassProperties::try_from_density(&shell, 1.0).unwrap();
    assert!((mass.mass - 7.0).abs() < 1e-13);
    let inside_out = joined(&[flipped(outer.clone()), inner.clone()]);
    let same = MassProperties::try_from_density(&inside_out, 1.0).unwrap();
    assert!((same.mass - 7.0).abs() < 1e-13 && same.inertia.x_axis.x > 0.0);
    // A box inside a box, both solid.
    let twice = joined(&[outer, inner]);
    assert_eq!(
        MassProperties::try_from_density(&twice, 1.0),
        Err(MassError::PartsOverlap { first: 0, second: 12 })
    );
}

#[test]
fn parts_that_cross_are_named_and_parts_apart_are_summed() {
    let one = shape("box?x=1&y=1&z=1");
    let at = |x: f64| moved(&one, DVec3::X * x, DQuat::IDENTITY);
    let crossing = joined(&[at(0.0), at(9.0), at(10.0)]);
    assert_eq!(
        MassProperties::try_from_density(&crossing, 1.0),
        Err(MassError::PartsOverlap { first: 12, second: 24 })
    );
    let apart = MassProperties::try_from_density(&joined(&[at(-2.0), at(2.0)]), 1.0).unwrap();
    assert!((apart.mass - 16.0).abs() < 1e-13 && apart.center.length() < 1e-13);
}

#[test]
fn open_surfaces_and_bad_numbers_are_refused() {
    let mesh = shape("box?x=1&y=1&z=1");
    let open = TriMesh::try_new(mesh.vertices().to_vec(), mesh.triangles()[1..].to_vec()).unwrap();
    assert!(matches!(MassProperties::try_from_density(&open, 1.0), Err(MassError::Open { .. })));
    assert!(matches!(MassProperties::try_from_density(&mesh, 0.0), Err(MassError::Density { .. })));
    let bad = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    assert!(matches!(MassProperties::try_new(1.0, DVec3::ZERO, bad), Err(MassError::Inertia { .. })));
    assert!(matches!(
        MassProperties::try_new(f64::NAN, DVec3::ZERO, DMat3::IDENTITY),
        Err(MassError::Mass { .. })
    ));
}
