//! Queries on trees: time of contact, collide, distance; each judged before it is timed.
use criterion::{Criterion, criterion_group, criterion_main};
use d2m::bvh::{Posed, collide, distance};
use d2m::glam::DVec3;
use d2m::{LinearMotion, MeshTree, Mode, Moving, QueryOptions, RigidMotion, Solid, Window, time_of_contact};
use std::hint::black_box;

fn queries(c: &mut Criterion) {
    let tree = |text: &str| MeshTree::new(d2m::shapes::mesh(text).expect("an embedded shape"));
    let pairs = [
        ("gear", tree("gear?triangles=476"), tree("gear?triangles=476")),
        ("pebble", tree("pebble?triangles=5856"), tree("pebble?triangles=5804&seed=2")),
        ("knot", tree("torus-knot?triangles=70000"), tree("torus-knot?triangles=70000")),
    ];
    let a = LinearMotion::REST
        .with_position(DVec3::new(-2.0, 0.2, 0.1))
        .with_linear_velocity(DVec3::X * 2.0)
        .with_angular_velocity(DVec3::new(0.3, 1.0, -0.5));
    let b = LinearMotion::REST
        .with_position(DVec3::X * 2.0)
        .with_linear_velocity(DVec3::X * -2.0)
        .with_angular_velocity(DVec3::new(-1.0, 0.2, 0.4));
    let options = QueryOptions::default().with_tolerance(1e-10);
    for (name, mesh_a, mesh_b) in &pairs {
        let ask = |options: &QueryOptions| {
            time_of_contact(Moving::new(mesh_a, &a), Moving::new(mesh_b, &b), Window::UNIT, options)
                .expect("valid input")
        };
        let answer = ask(&options);
        let contact = answer.contact().expect("they meet");
        let at = |motion: &LinearMotion| motion.pose_and_twist(contact.time_lo).0;
        let (pose_a, pose_b) = (at(&a), at(&b));
        let still = || (Posed::new(mesh_a, pose_a), Posed::new(mesh_b, pose_b));
        let left = distance(still().0, still().1, Solid::Surface).expect("valid input");
        assert!(left.lower > 0.0 && left.upper <= 3.3e-10, "{name}: {left:?}");
        assert!(!collide(still().0, still().1, Solid::Surface).expect("valid input"), "{name}");

        let mut group = c.benchmark_group(format!("query {name}"));
        group.bench_function("time of contact", |b| b.iter(|| ask(black_box(&options))));
        let fast = options.with_mode(Mode::Capoeira);
        group.bench_function("time of contact, Capoeira", |b| b.iter(|| ask(black_box(&fast))));
        group.bench_function("collide at the time of contact", |b| {
            b.iter(|| collide(black_box(still().0), still().1, Solid::Surface));
        });
        group.bench_function("distance at the time of contact", |b| {
            b.iter(|| distance(black_box(still().0), still().1, Solid::Surface));
        });
        group.finish();
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
