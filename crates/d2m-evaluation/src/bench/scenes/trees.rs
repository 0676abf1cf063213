//! `cargo xtask bench trees`: what a mesh waits for before its first query, beside parry's tree of the same mesh.
use super::threads::{Cost, measure};
use super::{BusyFigure, Target, figure, least_time, milliseconds, wrong};
use crate::TaskResult;
use crate::bench::peers;
use d2m::bvh::{MeshTree, TriMesh};
use d2m::glam::DVec3;
use d2m::{ConstantTwist, Moving, QueryOptions, Window, time_of_contact};
use rayon::ThreadPool;

const SHAPES: [&str; 3] =
    ["pebble?triangles=5856", "torus-knot?triangles=70000", "pebble?triangles=1000000&roughness=1"];

/// Microseconds a triangle on one thread: construction, refit.
const MOST: [f64; 2] = [0.5, 0.1];
/// One thread over two.
const LEAST_GAIN: f64 = 1.9;
/// Bytes a triangle.
const MOST_BYTES: f64 = 110.0;
/// Milliseconds from the numbers of two meshes of 70 000 triangles to the first answer.
const MOST_FIRST: f64 = 100.0;

/// The least of some rounds, with what threads have waited in all of them.
struct Least {
    cost: Cost,
    wall: f64,
}

impl Least {
    const fn new() -> Self {
        Self { cost: Cost { wall: f64::INFINITY, busiest: f64::INFINITY, waiting: 0.0 }, wall: 0.0 }
    }

    fn add<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let (cost, answer) = measure(work);
        self.cost.wall = self.cost.wall.min(cost.wall);
        self.cost.busiest = self.cost.busiest.min(cost.busiest);
        self.cost.waiting += cost.waiting;
        self.wall += cost.wall;
        answer
    }

    /// In microseconds for each of so many triangles.
    fn print(&self, what: String, count: usize, target: Target) {
        let each = 1e6 / count as f64;
        let (value, by_processor) = (self.cost.wall * each, self.cost.busiest * each);
        let waited = self.cost.waiting / self.wall;
        BusyFigure { what, value, by_processor, unit: "µs", target, waited }.print();
    }
}

pub(in crate::bench) fn run(rounds: usize) -> TaskResult {
    let pool = |count: usize| rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pools = [pool(1)?, pool(2)?];
    for shape in SHAPES {
        one(shape, rounds, &pools)?;
    }
    first_answer(rounds, &pools)
}

/// The construction on one thread and on two, parry's, and a refit: in turn, so that all meet the same load of the machine.
fn one(shape: &str, rounds: usize, pools: &[ThreadPool; 2]) -> TaskResult {
    let mesh = d2m::shapes::mesh(shape)?;
    let count = mesh.triangle_count();
    let tree = MeshTree::new(mesh.clone());
    tree.validate()?;
    let (bytes, memory) = (tree.to_bytes(), tree.memory_bytes());
    let mut refitted = tree;
    let mut least = [(); 4].map(|()| Least::new());
    for _ in 0..rounds {
        for (pool, least) in pools.iter().zip(&mut least) {
            let fresh = mesh.clone();
            let built = least.add(|| pool.install(|| MeshTree::new(fresh)));
            if built.to_bytes() != bytes {
                return Err(wrong("the number of threads changes bits of a tree"));
            }
        }
        let _ = least[2].add(|| pools[0].install(|| peers::mesh(&mesh)));
        let same = mesh.vertices().to_vec();
        least[3].add(|| pools[0].install(|| refitted.refit(same)))?;
    }
    if refitted.to_bytes() != bytes {
        return Err(wrong("a refit to the same vertices changes bits of a tree"));
    }
    let [alone, two, parry, refit] = &least;
    alone.print(format!("tree of {count} triangles, a triangle"), count, Target::AtMost(MOST[0]));
    parry.print("  parry3d-f64's".into(), count, Target::None);
    refit.print("  refit".into(), count, Target::AtMost(MOST[1]));
    BusyFigure {
        what: "  one thread over two".into(),
        value: alone.cost.wall / two.cost.wall,
        by_processor: alone.cost.busiest / two.cost.busiest,
        unit: "times",
        target: Target::AtLeast(LEAST_GAIN),
        waited: (alone.cost.waiting + two.cost.waiting) / (alone.wall + two.wall),
    }
    .print();
    figure("  memory, with the mesh", memory as f64 / count as f64, "bytes", Target::AtMost(MOST_BYTES));
    Ok(())
}

/// From the numbers of two meshes to the verdict of one query.
fn first_answer(rounds: usize, pools: &[ThreadPool; 2]) -> TaskResult {
    let mesh = d2m::shapes::mesh("torus-knot?triangles=70000")?;
    let falling = ConstantTwist::REST.with_position(DVec3::Z * 4.0).with_linear_velocity(DVec3::Z * -4.0);
    let numbers = || [(); 2].map(|()| (mesh.vertices().to_vec(), mesh.triangles().to_vec()));
    for pool in pools {
        let (time, answer) = least_time(rounds, numbers, |numbers| {
            pool.install(|| -> Result<bool, Box<dyn std::error::Error + Send + Sync>> {
                let [a, b] = core::mem::take(numbers).map(|(v, t)| TriMesh::try_new(v, t).map(MeshTree::new));
                let (a, b) = (a?, b?);
                let (a, b) = (Moving::new(&a, &falling), Moving::new(&b, &ConstantTwist::REST));
                Ok(time_of_contact(a, b, Window::UNIT, &QueryOptions::default())?.contact().is_some())
            })
        });
        if !answer.map_err(|error| error.to_string())? {
            return Err(wrong("two knots that fly at each other meet"));
        }
        let threads = pool.current_num_threads();
        let what = format!("first answer for two meshes of 70000 triangles, {threads} threads");
        figure(what, milliseconds(time), "ms", Target::AtMost(MOST_FIRST));
    }
    Ok(())
}
