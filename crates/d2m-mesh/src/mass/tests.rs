use super::*;
use d2m_testing::Surface;
use glam::DQuat;

fn brick(x: f64, y: f64, z: f64) -> Surface {
    let half = DVec3::new(x, y, z);
    Surface::cuboid(-half, half)
}

fn mesh_of(surface: Surface) -> TriMesh {
    surface.into_mesh(TriMesh::try_new)
}

#[test]
fn far_from_the_origin_and_turned() {
    let turn = DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize();
    let by = DVec3::new(1e3, -2e3, 5e2);
    let mesh = mesh_of(brick(0.5, 1.0, 1.5).map(|p| turn * p + by));
    let brick = MassProperties::try_from_density(&mesh, 3.0).unwrap();
    let r = DMat3::from_quat(turn);
    let wanted = r * DMat3::from_diagonal(DVec3::new(13.0, 10.0, 5.0) * 18.0 / 12.0) * r.transpose();
    assert!((brick.mass - 18.0).abs() < 1e-10 && (brick.center - by).length() < 1e-10);
    assert!(largest(&(brick.inertia - wanted)) < 1e-9, "{:?}", brick.inertia);
}

#[test]
fn a_cone_of_many_sides_is_nearly_a_cone() {
    let cone = mesh_of(Surface::cone(4000, 2.0, 3.0));
    let cone = MassProperties::try_from_mass(&cone, 5.0).unwrap();
    let (along, across) = (0.3 * 5.0 * 4.0, 3.0 / 80.0 * 5.0 * (4.0 * 4.0 + 9.0));
    let moments = principal_moments(&cone.inertia);
    assert_eq!(cone.mass, 5.0);
    assert!((moments - DVec3::new(across, across, along)).length() < 1e-4, "{moments}");
}

#[test]
fn a_shell_is_the_difference_and_inward_is_outward() {
    let (outer, inner) = (brick(1.0, 1.0, 1.0), brick(0.5, 0.5, 0.5));
    let shell = mesh_of(outer.clone().with(&inner.clone().inverted()));
    let mass = MassProperties::try_from_density(&shell, 1.0).unwrap();
    assert!((mass.mass - 7.0).abs() < 1e-13);
    let inside_out = mesh_of(outer.clone().inverted().with(&inner));
    let same = MassProperties::try_from_density(&inside_out, 1.0).unwrap();
    assert!((same.mass - 7.0).abs() < 1e-13 && same.inertia.x_axis.x > 0.0);
    // A box inside a box, both solid.
    let twice = mesh_of(outer.with(&inner));
    assert_eq!(
        MassProperties::try_from_density(&twice, 1.0),
        Err(MassError::PartsOverlap { first: 0, second: 12 })
    );
}

#[test]
fn parts_that_cross_are_named_and_parts_apart_are_summed() {
    let at = |x: f64| brick(1.0, 1.0, 1.0).map(|p| p + DVec3::X * x);
    let crossing = mesh_of(at(0.0).with(&at(9.0)).with(&at(10.0)));
    assert_eq!(
        MassProperties::try_from_density(&crossing, 1.0),
        Err(MassError::PartsOverlap { first: 12, second: 24 })
    );
    let apart = MassProperties::try_from_density(&mesh_of(at(-2.0).with(&at(2.0))), 1.0).unwrap();
    assert!((apart.mass - 16.0).abs() < 1e-13 && apart.center.length() < 1e-13);
}

#[test]
fn open_surfaces_and_bad_numbers_are_refused() {
    let mesh = mesh_of(brick(1.0, 1.0, 1.0));
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

/// A triangle that repeats another one encloses nothing, nor do triangles without area.
#[test]
fn repeated_and_flat_triangles_change_nothing() {
    let mesh = mesh_of(brick(1.0, 1.0, 1.0));
    let wanted = MassProperties::try_from_density(&mesh, 1.0).unwrap();
    let with = |more: [u32; 3]| {
        let mut vertices = mesh.vertices().to_vec();
        vertices.push(DVec3::splat(9.0));
        let triangles = mesh.triangles().iter().copied().chain([more]).collect();
        MassProperties::try_from_density(&TriMesh::try_new(vertices, triangles).unwrap(), 1.0)
    };
    let repeated = with(mesh.triangles()[3]).unwrap();
    assert_eq!(
        (repeated.mass, repeated.center, repeated.inertia),
        (wanted.mass, wanted.center, wanted.inertia)
    );
    let last = mesh.vertex_count() as u32;
    let flat = with([last; 3]).unwrap();
    assert!((flat.mass - wanted.mass).abs() < 1e-12 && (flat.center - wanted.center).length() < 1e-12);
    let [a, b, _] = mesh.triangles()[3];
    assert!(matches!(with([a, b, last]), Err(MassError::Open { .. })));
}
