//! What `cargo xtask bench --check` counts: fixed pieces of work, each prepared before counting begins.
use super::body::{Body, Pair};
use super::method::{Method, Question};
use crate::TaskResult;
use crate::trials::{self, Law};
use d2m::bvh::{InstructionSet, MeshTree};
use d2m::feature::{ContactOptions, PairMotion, StraightPaths};
use d2m::interval::{Interval, IntervalVec3, IntervalVec3X4, IntervalX4};
use d2m::motion::{ConstantTwist, RelativeMotion};
use d2m_testing::Random;
use d2m_testing::planted::families::{Family, Kind, plant};
use glam::DVec3;
use std::hint::black_box;

type Error = Box<dyn std::error::Error>;

/// An operation of the table.
pub(super) struct Operation {
    pub(super) name: &'static str,
    work: Work,
}

enum Work {
    /// Rotate a point by Rodrigues' formula, triple product, squared norm.
    Interval,
    /// The same on four at a time.
    IntervalFour,
    /// One relative motion, its frame at a time, jets of 16 points.
    Jets,
    Feature(Kind, How),
    /// A tree over this shape.
    Build(&'static str),
    Query {
        shapes: [&'static str; 2],
        speed: f64,
        spin: f64,
        method: Method,
    },
}

/// Paths of the vertices of a feature pair.
#[derive(Clone, Copy, PartialEq)]
enum How {
    Rigid,
    Straight,
}

/// Queries of a mesh operation.
const QUERIES: usize = 24;
/// Repetitions of the small operations; of each of four families for feature pairs.
const REPEATS: usize = 64;

const GEARS: [&str; 2] = ["gear?triangles=476"; 2];
const PEBBLES: [&str; 2] = ["pebble?triangles=5856", "pebble?triangles=5804&seed=2"];
const SCREW: [&str; 2] = ["screw?triangles=2828", "nut?triangles=2418"];
const KNOTS: [&str; 2] = ["torus-knot?triangles=20000"; 2];
const TORI: [&str; 2] = ["torus?triangles=1332", "torus?triangles=3240&tube=0.2"];

const fn operation(name: &'static str, work: Work) -> Operation {
    Operation { name, work }
}

const fn query(
    name: &'static str,
    shapes: [&'static str; 2],
    speed: f64,
    spin: f64,
    method: Method,
) -> Operation {
    Operation { name, work: Work::Query { shapes, speed, spin, method } }
}

pub(super) const OPERATIONS: [Operation; 22] = [
    operation("interval kernel", Work::Interval),
    operation("interval kernel, four at once", Work::IntervalFour),
    operation("jets of 16 points", Work::Jets),
    operation("rigid vertex/face", Work::Feature(Kind::PointTriangle, How::Rigid)),
    operation("rigid edge/edge", Work::Feature(Kind::EdgeEdge, How::Rigid)),
    operation("straight vertex/face", Work::Feature(Kind::PointTriangle, How::Straight)),
    operation("straight edge/edge", Work::Feature(Kind::EdgeEdge, How::Straight)),
    operation("tree of 5780 triangles", Work::Build(PEBBLES[0])),
    query("accurate gear @4", GEARS, 4.0, 3.0, Method::Accurate),
    query("accurate gear @512", GEARS, 512.0, 3.0, Method::Accurate),
    query("accurate screw/nut @4", SCREW, 4.0, 3.0, Method::Accurate),
    query("accurate screw/nut @512", SCREW, 512.0, 3.0, Method::Accurate),
    query("accurate pebble @4", PEBBLES, 4.0, 3.0, Method::Accurate),
    query("accurate pebble @512", PEBBLES, 512.0, 3.0, Method::Accurate),
    query("accurate pebble, spin 30", PEBBLES, 4.0, 30.0, Method::Accurate),
    query("accurate knot @4", KNOTS, 4.0, 3.0, Method::Accurate),
    query("accurate knot @512", KNOTS, 512.0, 3.0, Method::Accurate),
    query("Capoeira pebble @4", PEBBLES, 4.0, 3.0, Method::Capoeira),
    query("Capoeira pebble @512", PEBBLES, 512.0, 3.0, Method::Capoeira),
    query("collide pebble", PEBBLES, 4.0, 3.0, Method::Collide),
    query("distance pebble", PEBBLES, 4.0, 3.0, Method::Distance),
    query("paper's method torus @4", TORI, 4.0, 3.0, Method::Paper),
];

impl Operation {
    /// Is there code of its own for each instruction set?
    pub(super) const fn has_variants(&self) -> bool {
        matches!(self.work, Work::Query { method, .. } if !matches!(method, Method::Paper))
    }

    /// Operations in one run of the work: counts are divided by it.
    pub(super) fn repeats(&self) -> usize {
        match self.work {
            Work::Interval | Work::IntervalFour | Work::Jets => REPEATS,
            Work::Feature(..) => REPEATS * FAMILIES.len(),
            Work::Build(_) => 1,
            Work::Query { .. } => QUERIES,
        }
    }

    /// Prepares the work, does it once so that lazy tables are filled and memory is warm, and then once counted.
    fn run(&self) -> TaskResult {
        match self.work {
            Work::Interval => interval(),
            Work::IntervalFour => interval_four(),
            Work::Jets => jets(),
            Work::Feature(kind, how) => features(kind, how),
            Work::Build(shape) => {
                let mesh = super::built::shape(shape)?;
                twice(&mut || drop(black_box(MeshTree::new(black_box(mesh.clone())))));
            }
            Work::Query { shapes, speed, spin, method } => queries(shapes, (speed, spin), method)?,
        }
        Ok(())
    }
}

/// Warm, then counted.
fn twice(work: &mut dyn FnMut()) {
    work();
    counted_work(work);
}

/// Callgrind counts inside of this function only, by its name.
#[inline(never)]
fn counted_work(work: &mut dyn FnMut()) {
    work();
}

/// Axis, angle, point and two edges.
type KernelInput = (IntervalVec3, Interval, IntervalVec3, [IntervalVec3; 2]);

fn kernel_inputs() -> Vec<KernelInput> {
    let mut random = d2m_testing::Xoshiro256::new(3);
    let mut one = || {
        let (axis, p, edges) = (random.direction(), random.direction(), [(); 2].map(|()| random.direction()));
        let angle = random.range(0.0, 3.0);
        let wide = |p: DVec3| IntervalVec3::between(p - DVec3::splat(1e-3), p + DVec3::splat(1e-3));
        let angle = Interval::new(angle, angle + 0.01);
        (IntervalVec3::point(axis), angle, wide(p), edges.map(IntervalVec3::point))
    };
    (0..REPEATS).map(|_| one()).collect()
}

fn interval() {
    let inputs = kernel_inputs();
    twice(&mut || {
        for (axis, angle, p, edges) in black_box(&inputs) {
            let q = p.rotated(*axis, *angle);
            let _ = black_box((q.triple_product(edges[0], edges[1]), q.norm_squared()));
        }
    });
}

fn interval_four() {
    let fours: Vec<_> = kernel_inputs()
        .chunks_exact(4)
        .map(|c| {
            let four = |pick: fn(&KernelInput) -> IntervalVec3| {
                IntervalVec3X4::from_lanes([pick(&c[0]), pick(&c[1]), pick(&c[2]), pick(&c[3])])
            };
            let angle = IntervalX4::new([c[0].1, c[1].1, c[2].1, c[3].1]);
            (four(|x| x.0), angle, four(|x| x.2), [four(|x| x.3[0]), four(|x| x.3[1])])
        })
        .collect();
    twice(&mut || {
        for (axis, angle, p, edges) in black_box(&fours) {
            let q = p.rotated(*axis, *angle);
            black_box((q.dot(edges[0].cross(edges[1])), q.norm_squared()));
        }
    });
}

fn jets() {
    let mut random = d2m_testing::Xoshiro256::new(4);
    let motion = |random: &mut d2m_testing::Xoshiro256| {
        ConstantTwist::REST
            .with_position(random.direction() * 2.0)
            .with_linear_velocity(random.direction() * 4.0)
            .with_angular_velocity(random.direction() * 3.0)
    };
    let cases: Vec<_> = (0..REPEATS)
        .map(|_| {
            let points = [(); 16].map(|()| random.direction());
            (motion(&mut random), motion(&mut random), points)
        })
        .collect();
    twice(&mut || {
        for (a, b, points) in black_box(&cases) {
            let relative = RelativeMotion::new(a, b, 0.0, 1.0);
            let remainder = relative.point_remainder(1.0, 1.0);
            let frame = relative.frame(0.375);
            for point in points {
                black_box(frame.point_jet(*point, remainder));
            }
        }
    });
}

const FAMILIES: [Family; 4] = [Family::Far, Family::Near, Family::Hit, Family::Graze];

fn features(kind: Kind, how: How) {
    let mut random = Random::new(7);
    let planted: Vec<_> =
        (0..REPEATS).flat_map(|_| FAMILIES).map(|family| plant(kind, family, &mut random)).collect();
    let cases: Vec<_> = planted
        .iter()
        .map(|planted| {
            let (t0, t1) = planted.window;
            let pair = PairMotion::new(&planted.motion_a, &planted.motion_b, t0, t1);
            let (start, end) = planted.straight();
            let triangle = pair.place_triangle(&planted.b);
            (pair, triangle, StraightPaths::new(start, end), planted)
        })
        .collect();
    let options = ContactOptions::new();
    twice(&mut || {
        for (pair, triangle, straight, planted) in black_box(&cases) {
            let edge = [planted.b[0], planted.b[1]];
            let _ = black_box(match (how, kind) {
                (How::Rigid, Kind::PointTriangle) => pair.point_placed(planted.a[0], triangle, &options),
                (How::Rigid, Kind::EdgeEdge) => pair.edge_edge(planted.a, edge, &options),
                (How::Straight, Kind::PointTriangle) => straight.point_triangle(&options),
                (How::Straight, Kind::EdgeEdge) => straight.edge_edge(&options),
            });
        }
    });
}

fn queries(shapes: [&str; 2], (speed, spin): (f64, f64), method: Method) -> Result<(), Error> {
    let a = Body::embedded(shapes[0])?;
    let b = if shapes[0] == shapes[1] { a.clone() } else { Body::embedded(shapes[1])? };
    let pair = Pair { name: shapes.join("/"), a, b };
    let list = trials::generate(&Law { speed, spin, ..Law::PAPER }, 1, QUERIES);
    // Static queries at the middle of the window, where most pairs are near each other.
    let at = (2.05 + 0.4 * speed) / speed;
    let questions: Vec<Question<'_>> =
        list.iter().map(|trial| Question::new(&pair, trial, 1e-10, at)).collect::<Result<_, Error>>()?;
    twice(&mut || {
        for question in &questions {
            black_box(question.ask(black_box(method)));
        }
    });
    Ok(())
}

#[derive(clap::Args)]
#[group(skip)]
pub(crate) struct CountedOptions {
    name: String,
    /// Only the instructions that every machine of this kind has.
    #[arg(long)]
    portable: bool,
}

/// The program that callgrind watches: one operation.
pub(crate) fn run(options: &CountedOptions) -> TaskResult {
    let operation = OPERATIONS.iter().find(|o| o.name == options.name).ok_or("no such operation")?;
    if options.portable {
        InstructionSet::Portable.limit();
    }
    // This thread is the whole pool: what another one does for it would not be counted.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    operation.run()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_fit_a_table_of_commas() {
        let mut names: Vec<&str> = OPERATIONS.iter().map(|o| o.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), OPERATIONS.len());
        assert!(!names.iter().any(|name| name.contains(';')));
    }
}
