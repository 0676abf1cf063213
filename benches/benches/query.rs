//! Queries on trees: time of contact, collide, distance; each judged before it is timed.
use criterion::{Criterion, criterion_group, criterion_main};
use d2m::bvh::{PairCache, Posed, collide, contact_exists, distance, time_of_contact_with};
use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Mode, Moving, QueryOptions, RigidMotion, Solid, Window, time_of_contact};
use d2m_benches::hard_scenes::{HardScene, grazing_cube, intermeshing_bars};
use d2m_benches::processor_time;
use std::hint::black_box;
use std::time::Instant;

fn queries(c: &mut Criterion) {
    let tree = |text: &str| MeshTree::new(d2m::shapes::mesh(text).expect("an embedded shape"));
    let pairs = [
        ("gear", tree("gear?triangles=476"), tree("gear?triangles=476")),
        ("pebble", tree("pebble?triangles=5856"), tree("pebble?triangles=5804&seed=2")),
        ("knot", tree("torus-knot?triangles=70000"), tree("torus-knot?triangles=70000")),
    ];
    let a = ConstantTwist::REST
        .with_position(DVec3::new(-2.0, 0.2, 0.1))
        .with_linear_velocity(DVec3::X * 2.0)
        .with_angular_velocity(DVec3::new(0.3, 1.0, -0.5));
    let b = ConstantTwist::REST
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
        let at = |motion: &ConstantTwist| motion.pose_and_twist(contact.time_lo).0;
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

/// Steps of a sequence.
const STEPS: u32 = 256;

/// The same pair asked again and again with slightly changed motions, with a cache and without; all answers are compared
/// before anything is timed.
fn sequences(c: &mut Criterion) {
    let tree = |text: &str| MeshTree::new(d2m::shapes::mesh(text).expect("an embedded shape"));
    let (a, b) = (tree("pebble?triangles=5856"), tree("pebble?triangles=5804&seed=2"));
    let options = QueryOptions::default();
    let step = |height: f64, k: u32| {
        ConstantTwist::REST
            .with_position(DVec3::new(-2.5, 0.1, height - 2e-4 * f64::from(k)))
            .with_linear_velocity(DVec3::new(4.0, 0.0, -1e-3 * f64::from(k)))
            .with_angular_velocity(DVec3::new(0.3, 1.0 + 1e-4 * f64::from(k), -0.5))
    };
    for (name, height) in [("no contact", 2.1), ("contact", 0.6)] {
        let motions: Vec<_> = (0..STEPS).map(|k| step(height, k)).collect();
        let still = Moving::new(&b, &ConstantTwist::REST);
        let cold = || -> Vec<_> {
            let ask = |m: &ConstantTwist| {
                time_of_contact(Moving::new(&a, m), still, Window::UNIT, &options).expect("valid input")
            };
            motions.iter().map(ask).collect()
        };
        let warm = || -> Vec<_> {
            let mut cache = PairCache::new();
            let ask = |m: &ConstantTwist| {
                time_of_contact_with(Moving::new(&a, m), still, Window::UNIT, &options, &mut cache)
            };
            motions.iter().map(ask).map(|answer| answer.expect("valid input")).collect()
        };
        let exists = |cached: bool| -> Vec<_> {
            let mut cache = PairCache::new();
            let mut ask = |m: &ConstantTwist| {
                if !cached {
                    cache.clear();
                }
                contact_exists(Moving::new(&a, m), still, Window::UNIT, &options, &mut cache)
                    .expect("valid input")
            };
            motions.iter().map(&mut ask).collect()
        };
        let answers = cold();
        assert!(answers.iter().all(|answer| answer.contact().is_some() == (name == "contact")), "{name}");
        assert_eq!(warm(), answers, "{name}");
        assert_eq!(exists(true), exists(false), "{name}");
        assert_eq!(exists(true), vec![Some(name == "contact"); motions.len()]);
        println!(
            "{name}, {STEPS} steps: time of contact with a cache {:.3} of without, whether there is one {:.3}",
            ratio(warm, cold),
            ratio(|| exists(true), || exists(false))
        );
        let mut group = c.benchmark_group(format!("sequence of {STEPS}, {name}"));
        group.sample_size(20);
        group.bench_function("time of contact", |b| b.iter(cold));
        group.bench_function("time of contact, cache", |b| b.iter(warm));
        group.bench_function("exists", |b| b.iter(|| exists(false)));
        group.bench_function("exists, cache", |b| b.iter(|| exists(true)));
        group.finish();
    }
}

/// One hard query on one thread and on two; the answers and the counts are compared before anything is timed.
fn threads(c: &mut Criterion) {
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
    let pools = [pool(1), pool(2)];
    let surface = QueryOptions::default().with_solid(Solid::Surface);
    for scene in [grazing_cube(4800, 1e-4, 0.0), intermeshing_bars(4800, 300.0, 0.0)] {
        let ask = |pool: &rayon::ThreadPool, scene: &HardScene| {
            pool.install(|| scene.ask_counted(&surface.with_parallel(true)))
        };
        let (one, two) = (ask(&pools[0], &scene), ask(&pools[1], &scene));
        assert_eq!(scene.fault(&one.answer), None);
        assert_eq!(one, two, "{}", scene.name);
        assert!(one.work.windows >= 50, "{:?}", one.work);
        let busiest = || {
            let [before, alone, shared] = [0, 1, 2].map(|asked| {
                if asked > 0 {
                    (0..20).for_each(|_| _ = black_box(ask(&pools[asked - 1], &scene)));
                }
                pools.each_ref().map(|pool| pool.broadcast(|_| seconds()))
            });
            let most = |k: usize, from: &[Vec<f64>; 2], to: &[Vec<f64>; 2]| {
                to[k].iter().zip(&from[k]).map(|(to, from)| to - from).fold(0.0, f64::max)
            };
            most(1, &alone, &shared) / most(0, &before, &alone)
        };
        println!(
            "{}, {} windows: two threads take {:.3} of one; the busier one works {:.3} of one",
            scene.name,
            one.work.windows,
            ratio(|| ask(&pools[1], &scene), || ask(&pools[0], &scene)),
            busiest()
        );
        let mut group = c.benchmark_group(format!("threads, {}", scene.name));
        group.sample_size(10);
        group.bench_function("1", |b| b.iter(|| ask(&pools[0], &scene)));
        group.bench_function("2", |b| b.iter(|| ask(&pools[1], &scene)));
        group.finish();
    }
}

/// Seconds that this thread has run, not a number where the system does not say.
fn seconds() -> f64 {
    processor_time().map_or(f64::NAN, |time| time.as_secs_f64())
}

/// Median of the ratios of the times of two tasks that take turns.
fn ratio<T, U>(first: impl Fn() -> T, second: impl Fn() -> U) -> f64 {
    let mut ratios: Vec<f64> = (0..15)
        .map(|_| {
            let clock = Instant::now();
            black_box(first());
            let middle = clock.elapsed().as_secs_f64();
            black_box(second());
            middle / (clock.elapsed().as_secs_f64() - middle)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

criterion_group!(benches, queries, sequences, threads);
criterion_main!(benches);
