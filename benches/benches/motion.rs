//! Poses and their enclosures; each enclosure is judged before it is timed.
use criterion::{Criterion, criterion_group, criterion_main};
use d2m::glam::DVec3;
use d2m::interval::Interval;
use d2m::{ConstantTwist, RigidMotion};
use std::hint::black_box;

fn enclosures(c: &mut Criterion) {
    let motion = ConstantTwist::REST
        .with_position(DVec3::new(1.0, -2.0, 0.5))
        .with_linear_velocity(DVec3::new(0.3, 4.0, -1.0))
        .with_angular_velocity(DVec3::new(1.0, -0.7, 2.0));
    let span = Interval::new(0.25, 0.3125);
    let (point, held) = (DVec3::new(0.4, 0.5, -0.6), motion.enclose_pose(span));
    for k in 0..=16 {
        let t = 0.25 + f64::from(k) / 256.0;
        let p = motion.pose_and_twist(t).0.transform_point(point);
        let q = held.enclose_point(point);
        let holds = |x: Interval, y: f64| x.lo() - 1e-14 <= y && y <= x.hi() + 1e-14;
        assert!(holds(q.x, p.x) && holds(q.y, p.y) && holds(q.z, p.z), "{k}");
    }
    let mut group = c.benchmark_group("linear motion");
    group.bench_function("pose and twist", |b| b.iter(|| motion.pose_and_twist(black_box(0.3))));
    group.bench_function("enclose pose", |b| b.iter(|| motion.enclose_pose(black_box(span))));
    group.bench_function("enclose twist", |b| b.iter(|| motion.enclose_twist(black_box(span))));
    group.finish();
}

criterion_group!(benches, enclosures);
criterion_main!(benches);
