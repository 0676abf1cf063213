//! Building trees; the tree is judged, box by box and by a query, before its construction is timed.
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use d2m::bvh::{Posed, collide};
use d2m::{MeshTree, Solid};

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("tree build");
    group.sample_size(10);
    for triangles in [5_856, 70_000] {
        let mesh =
            d2m::shapes::mesh(&format!("torus-knot?triangles={triangles}")).expect("an embedded shape");
        let tree = MeshTree::new(mesh.clone());
        assert!(tree.is_watertight());
        tree.validate().expect("boxes that enclose their triangles");
        let itself = collide(Posed::at_rest(&tree), Posed::at_rest(&tree), Solid::Surface);
        assert_eq!(itself, Ok(true), "a body touches itself");
        group.throughput(Throughput::Elements(mesh.triangle_count() as u64));
        group.bench_function(format!("{} triangles", mesh.triangle_count()), |b| {
            b.iter_batched(|| mesh.clone(), MeshTree::new, BatchSize::LargeInput);
        });
    }
    group.finish();
}

criterion_group!(benches, build);
criterion_main!(benches);
