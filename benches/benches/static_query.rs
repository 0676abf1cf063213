//! Static queries near contact, building and refitting. Each answer is judged before it is timed.

use criterion::{Criterion, criterion_group, criterion_main};
use d2m::bvh::{DistanceOptions, MeshTree, Posed, Solid, StartState, collide, distance, distance_within};
use d2m::motion::Pose;
use glam::{DQuat, DVec3};
use std::hint::black_box;

/// Moves B along x until a bisection leaves it between 0 and 1e-9 from A.
fn near_contact(a: &MeshTree, b: &MeshTree, turn: DQuat) -> Pose {
    let pose = |x: f64| Pose { rotation: turn, translation: DVec3::X * x, at: DVec3::ZERO };
    let apart = |x: f64| !collide(Posed::at_rest(a), Posed::new(b, pose(x)), Solid::Filled).unwrap();
    let (mut near, mut far) = (0.0, 3.0 * (a.radius() + b.radius()));
    assert!(!apart(near) && apart(far));
    while far - near > 5e-10 {
        let middle = 0.5 * (near + far);
        if apart(middle) {
            far = middle;
        } else {
            near = middle;
        }
    }
    pose(far)
}

fn static_queries(criterion: &mut Criterion) {
    let turn = DQuat::from_xyzw(0.1, 0.4, -0.2, 0.88);
    for (name, first, second) in [
        ("knots_70000", "torus-knot?triangles=70000", "torus-knot?triangles=70000"),
        ("knot_icosphere", "torus-knot?triangles=6000", "icosphere?triangles=5000"),
        ("box_knot", "box", "torus-knot?triangles=2000"),
    ] {
        let tree = |text: &str| MeshTree::new(d2m::shapes::mesh(text).expect("known shape"));
        let (a, b) = (tree(first), tree(second));
        let (pa, pb) = (Posed::at_rest(&a), Posed::new(&b, near_contact(&a, &b, turn)));
        let found = distance(pa, pb, Solid::Filled).unwrap();
        assert!(found.state == StartState::Apart && found.value < 1e-8, "{found:?}");
        let mut group = criterion.benchmark_group(format!("static/{name}"));
        group.bench_function("collide", |bench| {
            bench.iter(|| assert!(!collide(black_box(pa), black_box(pb), Solid::Filled).unwrap()));
        });
        group.bench_function("distance_cold", |bench| {
            bench.iter(|| distance(black_box(pa), black_box(pb), Solid::Filled).unwrap());
        });
        group.bench_function("distance_warm", |bench| {
            let first = Some([found.triangle_a, found.triangle_b]);
            let options = DistanceOptions::default().with_first(first);
            let warm = distance_within(pa, pb, &options).unwrap();
            assert_eq!(warm, Some(found));
            bench.iter(|| distance_within(black_box(pa), black_box(pb), &options).unwrap());
        });
        let far = Pose { translation: pb.pose.translation * 1.5, ..pb.pose };
        group.bench_function("distance_far", |bench| {
            bench.iter(|| distance(black_box(pa), Posed::new(&b, far), Solid::Filled).unwrap());
        });
        let deep = Posed::new(&b, Pose { translation: pb.pose.translation * 0.5, ..pb.pose });
        if distance(pa, deep, Solid::Filled).unwrap().state == StartState::Overlapping {
            group.bench_function("distance_overlapping", |bench| {
                bench.iter(|| distance(black_box(pa), deep, Solid::Filled).unwrap());
            });
        }
        if a.mesh().triangle_count() > 10_000 {
            group.sample_size(20);
            group.bench_function("build", |bench| bench.iter(|| MeshTree::new(a.mesh().clone())));
            group.bench_function("refit", |bench| {
                let mut tree = a.clone();
                bench.iter(|| tree.refit(a.mesh().vertices().to_vec()).unwrap());
            });
        }
        group.finish();
    }
}

criterion_group!(benches, static_queries);
criterion_main!(benches);
