//! Static queries on posed bodies: clearance with witnesses, a cutoff, a warm start, colliding triangles, refit.

use d2m_bvh::{
    DistanceOptions, MeshTree, Posed, Solid, TriMesh, collide, colliding_pairs, distance, distance_within,
};
use d2m_motion::Pose;
use glam::{DQuat, DVec3};

/// A closed ring of 2·across·around triangles.
fn ring(across: u32, around: u32) -> TriMesh {
    let turn = |k: u32, n: u32| (f64::from(k) / f64::from(n) * core::f64::consts::TAU).sin_cos();
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    let at = |i: u32, j: u32| (i % across) * around + j % around;
    for i in 0..across {
        for j in 0..around {
            let ((s, c), (t, d)) = (turn(i, across), turn(j, around));
            corners.push(DVec3::new((1.0 + 0.3 * d) * c, (1.0 + 0.3 * d) * s, 0.3 * t));
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    TriMesh::try_new(corners, triangles).expect("good mesh")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut tree = MeshTree::new(ring(96, 48));
    let quarter = DQuat::from_rotation_x(core::f64::consts::FRAC_PI_2);
    let linked = |shift: f64| Pose { rotation: quarter, translation: DVec3::X * shift, at: DVec3::ZERO };

    // Two linked rings do not touch, although each one's box holds much of the other.
    let (a, b) = (Posed::at_rest(&tree), Posed::new(&tree, linked(1.0)));
    assert!(!collide(a, b, Solid::Filled)?);
    let clearance = distance(a, b, Solid::Filled)?;
    println!("clearance {} in [{}, {}]", clearance.value, clearance.lower, clearance.upper);
    println!("between {} and {}", clearance.point_a, clearance.point_b);
    assert!((clearance.value - 0.4).abs() < 2e-3);

    // A slow slide: each query starts from the last one's triangles, and the answers are the same bits.
    let mut options = DistanceOptions::default().with_cutoff(0.25);
    for step in 0..=40 {
        let b = Posed::new(&tree, linked(1.0 + 0.01 * f64::from(step)));
        match distance_within(a, b, &options)? {
            Some(near) => {
                options = options.with_first(Some([near.triangle_a, near.triangle_b]));
                assert_eq!(near, distance(a, b, Solid::Filled)?);
                println!("shift {:.2}: {:.6} {:?}", 1.0 + 0.01 * f64::from(step), near.value, near.state);
            }
            None => println!("shift {:.2}: more than 0.25", 1.0 + 0.01 * f64::from(step)),
        }
    }

    let crossing = Posed::new(&tree, linked(1.5));
    println!("{} pairs of triangles meet", colliding_pairs(a, crossing)?.len());

    // The same tree for a deformed ring: new boxes, the same nodes.
    let thinner = tree.mesh().vertices().iter().map(|p| *p * DVec3::new(1.0, 1.0, 0.5)).collect();
    tree.refit(thinner)?;
    tree.validate()?;
    println!("{} bytes a triangle", tree.memory_bytes() / tree.mesh().triangle_count());
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
