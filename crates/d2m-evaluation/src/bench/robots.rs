//! Edges of a sampling planner: an arm of seven joints and ten links among five obstacles, or any robot of files. Answers are held against
//! the judge's distances at many times before their time counts.
use super::Options;
use super::body::Body;
use super::clock::processor_seconds;
use crate::TaskResult;
use crate::judge::{BoxTree, Hint, Placement, cross, separation};
use d2m::bvh::{MeshTree, QueryOptions, TriMesh};
use d2m::robot::{
    EdgeChecker, Obstacle, PathAnswer, PathBodies, Robot, RobotOptions, RobotScene, Srdf, Trajectory,
    TrajectoryPoint,
};
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// What an edge may take, and how many a thread should check in a second.
const WANTED_MICROSECONDS: f64 = 1e3;
const WANTED_RATE: f64 = 2e3;
/// Each joint moves by at most so much along an edge, radians or units of length.
const STEPS: [f64; 4] = [0.1, 0.3, 1.0, 4.0];
/// Edges of each step that are judged, and times at which each is: in a few seconds a step, as few pairs are near enough for more than a
/// test of their largest boxes.
const JUDGED: usize = 200;
const SAMPLES: u32 = 24;
/// By how much distances of rounded poses may be off, in units of length: robots are some of them wide.
const ROUNDING: f64 = 1e-12;
/// Links of the arm that is built in, that no joint moves first: base, seven links, hand and finger.
const LINKS: usize = 10;
/// Joints that move.
const JOINTS: usize = 7;

/// `cargo xtask bench robots`.
pub(super) fn run(options: &Options) -> TaskResult {
    let scene = scene(options)?;
    let robot = Arc::clone(scene.robot());
    let count = options.count.unwrap_or(if options.quick { 1_000 } else { 10_000 });
    let names: Vec<&str> = robot.joint_names().into_iter().take(JOINTS).collect();
    let limits: Vec<[f64; 2]> = names
        .iter()
        .map(|name| {
            let limits = robot.find_joint(name).and_then(|joint| robot.limits(joint).position);
            limits.unwrap_or([-std::f64::consts::PI, std::f64::consts::PI])
        })
        .collect();
    println!(
        "{}: {} links, {} joints, {count} edges a step; wanted: {WANTED_MICROSECONDS} µs an edge at most, {WANTED_RATE} a second a thread",
        robot.name(),
        robot.link_names().len(),
        names.len(),
    );
    let edges = scene.edges(&names)?;
    for step in STEPS {
        let mut random = Random(options.seed);
        let drawn = Drawn::new(&edges, &limits, step, count, &mut random)?;
        judge(&scene, &edges, &names, &drawn)?;
        measure(&edges, step, &drawn)?;
    }
    Ok(())
}

/// Edges from anywhere free towards anywhere.
struct Drawn(Vec<[Vec<f64>; 2]>);

impl Drawn {
    fn new(
        edges: &EdgeChecker<'_>,
        limits: &[[f64; 2]],
        step: f64,
        count: usize,
        random: &mut Random,
    ) -> Result<Self, Error> {
        let mut drawn = Vec::with_capacity(count);
        while drawn.len() < count {
            let mut draw = || -> Vec<f64> { limits.iter().map(|&[lo, hi]| random.between(lo, hi)).collect() };
            let (from, to) = (draw(), draw());
            let to: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a).clamp(-step, step)).collect();
            if edges.check(&from, &from)?.is_free() {
                drawn.push([from, to]);
            }
        }
        Ok(Self(drawn))
    }
}

fn measure(edges: &EdgeChecker<'_>, step: f64, Drawn(drawn): &Drawn) -> TaskResult {
    let (start, before) = (Instant::now(), processor_seconds());
    let (mut times, mut free) = (Vec::with_capacity(drawn.len()), 0);
    for [from, to] in drawn {
        let start = Instant::now();
        free += usize::from(edges.check(from, to)?.is_free());
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    let rate = drawn.len() as f64 / start.elapsed().as_secs_f64();
    let work = before.zip(processor_seconds()).map(|(before, after)| drawn.len() as f64 / (after - before));
    times.sort_by(f64::total_cmp);
    let at = |percent: usize| times[(times.len() - 1) * percent / 100];
    let all = Instant::now();
    let answers = edges.check_all(drawn.iter().map(|[from, to]| (&from[..], &to[..])))?;
    let together = drawn.len() as f64 / all.elapsed().as_secs_f64();
    if answers.iter().filter(|answer| answer.is_free()).count() != free {
        return Err("a batch answers otherwise than its edges one by one".into());
    }
    let reached = if work.unwrap_or(rate) >= WANTED_RATE { "reached" } else { "MISSED" };
    println!(
        "steps of {step:<4}: {free:>5} free; median {:>6.0} µs, 99 of 100 below {:>6.0}, worst {:>6.0}; a second a thread {rate:>6.0} by the \
         clock, {} by processor time ({reached}); {together:.0} on {} threads",
        at(50),
        at(99),
        at(100),
        work.map_or("unknown".to_owned(), |work| format!("{work:>6.0}")),
        std::thread::available_parallelism().map_or(1, usize::from),
    );
    Ok(())
}

/// # Errors
/// A pair that is nearer before the end of what is free than the rounding of poses, a free edge that is not, or a contact that is none.
fn judge(scene: &RobotScene, edges: &EdgeChecker<'_>, names: &[&str], Drawn(drawn): &Drawn) -> TaskResult {
    let joints: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    let mut trees: Vec<BoxTree> = Vec::new();
    for [from, to] in drawn.iter().take(JUDGED) {
        let answer = edges.check(from, to)?;
        let points = vec![TrajectoryPoint::new(0.0, from.clone()), TrajectoryPoint::new(1.0, to.clone())];
        let path = Trajectory::new(joints.clone(), points);
        let bodies = scene.bodies_along(&path)?;
        if trees.is_empty() {
            let mesh = |body: usize| bodies.moving(body).body.mesh();
            let build = |mesh: &TriMesh| BoxTree::build(mesh.vertices(), mesh.triangles());
            trees = (0..bodies.len()).map(|body| build(mesh(body))).collect();
        }
        let until = answer.free_until();
        for sample in 0..=SAMPLES {
            let time = until * f64::from(sample) / f64::from(SAMPLES);
            let places = places(&bodies, time);
            for &pair in bodies.pairs() {
                if is_met(&bodies, &trees, &places, pair) {
                    return Err(format!("wrong answer: {pair:?} meet at {time} of {from:?} to {to:?}").into());
                }
            }
        }
        if let PathAnswer::Contact(found) = &answer {
            let places = places(&bodies, found.contact.time_hi);
            let distance = distance(&bodies, &trees, &places, found.bodies);
            if distance > found.contact.tolerance + ROUNDING {
                return Err(format!("wrong answer: {distance:e} apart, {from:?} to {to:?}").into());
            }
        }
    }
    Ok(())
}

/// Where all bodies are.
fn places(bodies: &PathBodies<'_>, time: f64) -> Vec<Placement> {
    let poses = (0..bodies.len()).map(|body| bodies.moving(body).motion.pose_and_twist(time).0);
    poses.map(|pose| Placement::new(pose.rotation, pose.transform_point(DVec3::ZERO))).collect()
}

/// Do the surfaces share points, by the judge? Of bodies with radii: are they within them?
fn is_met(bodies: &PathBodies<'_>, trees: &[BoxTree], places: &[Placement], [a, b]: [usize; 2]) -> bool {
    if bodies.moving(a).radius + bodies.moving(b).radius > 0.0 {
        return distance(bodies, trees, places, [a, b]) <= 0.0;
    }
    cross(&trees[a], &trees[b], &places[a], &places[b])
}

/// By the judge: of surfaces, less the radii of the bodies; less than zero where a pair is within them.
fn distance(bodies: &PathBodies<'_>, trees: &[BoxTree], places: &[Placement], [a, b]: [usize; 2]) -> f64 {
    let apart = separation(&trees[a], &trees[b], &places[a], &places[b], &mut Hint::default());
    apart - bodies.moving(a).radius - bodies.moving(b).radius
}

/// The robot of files, or the one that is built in, among five boxes.
fn scene(options: &Options) -> Result<RobotScene, Error> {
    let robot = match &options.robot {
        Some(file) => Robot::read(file, &RobotOptions::new())?,
        None => arm()?,
    };
    let srdf = match (&options.srdf, &options.robot) {
        (Some(file), _) => Some(Srdf::read(file)?),
        (None, None) => Some(Srdf::parse("arm.srdf", &srdf())?),
        (None, Some(_)) => None,
    };
    let mut scene = RobotScene::new(Arc::new(robot), srdf.as_ref(), QueryOptions::default())?;
    let tree = Arc::new(MeshTree::new(d2m::shapes::mesh("box?x=0.1&y=0.15&z=0.2")?));
    let places = [[0.6, 0.1, 0.2], [-0.5, 0.4, 0.6], [0.3, -0.6, 0.8], [0.0, 0.7, 0.3], [0.5, 0.5, 0.9]];
    for (k, at) in places.into_iter().enumerate() {
        let turn = DQuat::from_xyzw(0.1 * k as f64, 0.2, -0.1, 1.0);
        let name = format!("obstacle {k}");
        scene.add_obstacle(Obstacle::at_rest(name, Arc::clone(&tree), DVec3::from_array(at), turn)?)?;
    }
    Ok(scene)
}

/// Links of 500 triangles, each a pebble along z.
fn arm() -> Result<Robot, Error> {
    let mut text = String::from("<robot name=\"arm of seven joints\">");
    let mut options = RobotOptions::new();
    for k in 0..LINKS {
        write!(
            text,
            "<link name=\"l{k}\"><collision><geometry><mesh filename=\"l{k}\"/></geometry></collision></link>"
        )?;
        let pebble = Body::unit_shape(&format!("pebble?triangles=500&seed={}", k + 1))?;
        let size = if k < LINKS - 2 { DVec3::new(0.06, 0.06, 0.13) } else { DVec3::new(0.03, 0.06, 0.05) };
        let vertices = pebble.vertices().iter().map(|&at| (at + DVec3::Z * 0.7) * size).collect();
        let mesh = TriMesh::try_new(vertices, pebble.triangles().to_vec())?;
        options = options.with_mesh(format!("l{k}"), DVec3::ONE, Arc::new(MeshTree::new(mesh)));
        let Some(parent) = k.checked_sub(1) else { continue };
        let (kind, height) = if k <= JOINTS { ("revolute", 0.17) } else { ("fixed", 0.1) };
        let axis = if k % 2 == 1 { "0 0 1" } else { "0 1 0" };
        write!(
            text,
            "<joint name=\"j{k}\" type=\"{kind}\"><parent link=\"l{parent}\"/><child link=\"l{k}\"/><origin xyz=\"0 0 {height}\"/>\
             <axis xyz=\"{axis}\"/><limit lower=\"-2.2\" upper=\"2.2\" velocity=\"2\"/></joint>"
        )?;
    }
    text.push_str("</robot>");
    Ok(Robot::parse("arm.urdf", &text, &options)?)
}

/// Links that are two joints apart are never checked, as assistants for real arms find.
fn srdf() -> String {
    let pairs = (2..LINKS)
        .map(|k| format!("<disable_collisions link1=\"l{}\" link2=\"l{k}\" reason=\"Never\"/>", k - 2));
    format!("<robot name=\"arm\">{}</robot>", pairs.collect::<Vec<_>>().concat())
}
