//! Saved trees: what a command waits for that is given one.
use super::threads::{Cost, measure};
use super::{BusyFigure, Target, figure, least_time, milliseconds, wrong};
use crate::TaskResult;
use d2m::bvh::{MeshTree, Posed, ProximityOptions, proximities_with};
use d2m::glam::DVec3;
use d2m::motion::Pose;

/// Triangles, and the longest times in milliseconds on one thread and on two.
const LARGE: (&str, [f64; 2]) = ("torus-knot?triangles=2000000", [1000.0, 600.0]);

pub(super) fn run(rounds: usize) -> TaskResult {
    let (shape, most) = LARGE;
    let path = crate::workspace_root().join(".bench").join("scenes").join("saved.d2mtree");
    std::fs::create_dir_all(path.parent().unwrap_or(&path))?;
    let tree = MeshTree::new(d2m::shapes::mesh(shape)?);
    let bytes = tree.to_bytes();
    std::fs::write(&path, &bytes)?;
    for (threads, most) in [1, 2].into_iter().zip(most) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let read = || -> Result<MeshTree, Box<dyn std::error::Error + Send + Sync>> {
            Ok(MeshTree::try_from_bytes(&std::fs::read(&path)?)?)
        };
        let mut least = Cost { wall: f64::INFINITY, busiest: f64::INFINITY, waiting: 0.0 };
        let mut wall = 0.0;
        for _ in 0..rounds {
            let (cost, back) = measure(|| pool.install(read));
            if back.map_err(|error| error.to_string())?.to_bytes() != bytes {
                return Err(wrong("a tree that is read is another one"));
            }
            wall += cost.wall;
            least.wall = least.wall.min(cost.wall);
            least.busiest = least.busiest.min(cost.busiest);
            least.waiting += cost.waiting;
        }
        let count = tree.mesh().triangle_count();
        let [value, by_processor] = [least.wall, least.busiest].map(|seconds| seconds * 1e3);
        BusyFigure {
            what: format!("saved tree of {count} triangles read and validated, {threads} threads"),
            value,
            by_processor,
            unit: "ms",
            target: Target::AtMost(most),
            waited: least.waiting / wall,
        }
        .print();
    }
    std::fs::remove_file(&path)?;
    first_proximities(rounds)
}

/// The first call for a mesh finds the neighbors of its edges and vertices, which the tree then keeps.
fn first_proximities(rounds: usize) -> TaskResult {
    let mesh = d2m::shapes::mesh("torus-knot?triangles=70000")?;
    let fresh = MeshTree::new(mesh);
    let pose = Pose { translation: DVec3::X * (2.0 * fresh.radius()), ..Pose::IDENTITY };
    let options = ProximityOptions::new(0.05);
    let mut near =
        |tree: &mut MeshTree| proximities_with(Posed::new(tree, pose), Posed::at_rest(tree), &options);
    let fill = || MeshTree::new(fresh.mesh().clone());
    let (first, answer) = least_time(rounds, fill, &mut near);
    let mut used = fill();
    let again = near(&mut used)?;
    if answer? != again {
        return Err(wrong("the first proximities are others than the second"));
    }
    let (second, _) = least_time(rounds, || (), |()| near(&mut used).is_ok());
    let what = format!(
        "proximities, first call for a mesh of 70000 triangles ({:.3} ms after that)",
        milliseconds(second)
    );
    figure(what, milliseconds(first), "ms", Target::None);
    Ok(())
}
