//! `d2m batch` from the file of trials to the file of answers: the same flights in each form of motion that a line may have; and batches
//! of the library against their queries one by one.
use super::scenes::{BusyFigure, Target, threads, wrong};
use crate::TaskResult;
use crate::trials::{Law, Movement, Trial, generate, write};
use d2m::bvh::MeshTree;
use d2m::motion::{ConstantTwist, Pose, RigidMotion, Spline, SplineDegree};
use d2m::{Moving, QueryError, QueryOptions, TimeOfContact, Window, time_of_contact, time_of_contact_batch};
use glam::{DQuat, DVec3};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// The bodies, and how many flights.
const BODIES: [&str; 2] = ["shape:gear", "shape:gear"];
const COUNT: usize = 2000;
/// Poses of the keyframes of a flight; the angular speeds of the trials turn by less than half a circle between two.
const POSES: u32 = 9;
/// Forms of one flight differ by the rounding of poses, and each answer is within its tolerance (1e-10 of the length, at speeds that
/// are at least a tenth of the trials').
const SAME_TIME: f64 = 1e-7;

/// What a thread of a batch is to do, in parts of what it does with single queries.
const LEAST_PER_THREAD: f64 = 0.95;
/// How often single queries and batches are measured in turn, times the rounds.
const TURNS: usize = 4;

/// A form in which a motion is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Twist,
    Spans,
    Poses,
    Chain,
    /// The forms in turn.
    Mixed,
}

const FORMS: [(Form, &str); 5] = [
    (Form::Twist, "JSON lines, constant twists"),
    (Form::Spans, "JSON lines, keyframes of one span"),
    (Form::Poses, "JSON lines, keyframes of nine poses"),
    (Form::Chain, "JSON lines, links of arms of three joints"),
    (Form::Mixed, "JSON lines, every form in turn"),
];

fn vector(v: DVec3) -> serde_json::Value {
    serde_json::json!([v.x, v.y, v.z])
}

fn quaternion(q: DQuat) -> serde_json::Value {
    serde_json::json!([q.w, q.x, q.y, q.z])
}

/// The motion of one body over [0, 1].
fn motion(movement: &Movement, form: Form, line: usize) -> serde_json::Value {
    use serde_json::json;
    let Movement { rotation, position, velocity, angular_velocity } = *movement;
    let twist = || json!({ "x": vector(position), "q": quaternion(rotation), "v": vector(velocity), "w": vector(angular_velocity) });
    match form {
        Form::Twist => twist(),
        Form::Spans => json!({ "times": [0.0, 1.0], "spans": [twist()] }),
        Form::Poses => {
            let times: Vec<f64> = (0..POSES).map(|k| f64::from(k) / f64::from(POSES - 1)).collect();
            let pose = |&time: &f64| {
                let turned = DQuat::from_scaled_axis(angular_velocity * time) * rotation;
                json!({ "x": vector(position + velocity * time), "q": quaternion(turned) })
            };
            json!({ "times": times, "poses": times.iter().map(pose).collect::<Vec<_>>() })
        }
        Form::Chain => {
            let joint = |kind: &str, x: DVec3, along: DVec3| json!({ "x": vector(x), "q": [1.0, 0.0, 0.0, 0.0], "joint": kind, "axis": vector(along), "value": [0.0, along.length()] });
            let fixed = json!({ "x": [0.0, 0.0, 0.0], "q": quaternion(rotation), "joint": "fixed" });
            let joints = [
                joint("prismatic", position, velocity),
                joint("revolute", DVec3::ZERO, angular_velocity),
                fixed,
            ];
            json!({ "chain": joints })
        }
        Form::Mixed => motion(movement, [Form::Twist, Form::Spans, Form::Poses, Form::Chain][line % 4], line),
    }
}

/// What a line of the answers says.
struct Answer {
    status: String,
    time: f64,
    microseconds: f64,
}

fn answers(path: &Path) -> Result<Vec<Answer>, Error> {
    let text = std::fs::read_to_string(path)?;
    text.lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let [_, status, time, _, _, microseconds, ..] = fields[..] else {
                return Err(format!("{}: {line}", path.display()).into());
            };
            Ok(Answer { status: status.to_owned(), time: time.parse()?, microseconds: microseconds.parse()? })
        })
        .collect()
}

/// What the command took and answered.
struct CommandRun {
    /// The least time of the whole command.
    seconds: f64,
    answers: Vec<Answer>,
}

fn run_command(program: &Path, trials: &Path, rounds: usize) -> Result<CommandRun, Error> {
    let out = trials.with_extension("answers");
    let mut least = f64::INFINITY;
    for _ in 0..rounds {
        let start = Instant::now();
        let output = Command::new(program)
            .arg("batch")
            .args(BODIES)
            .arg("--trials")
            .arg(trials)
            .arg("--out")
            .arg(&out)
            .output()?;
        least = least.min(start.elapsed().as_secs_f64());
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
    }
    Ok(CommandRun { seconds: least, answers: answers(&out)? })
}

/// The command, built as it is released.
fn program() -> Result<PathBuf, Error> {
    let root = crate::workspace_root();
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--release", "--quiet", "--package", "d2m-cli"])
        .current_dir(&root)
        .status()?;
    if !built.success() {
        return Err("d2m-cli does not build".into());
    }
    let folder = std::env::current_exe()?.parent().map_or_else(PathBuf::new, Path::to_path_buf);
    Ok(folder.join(format!("d2m{}", std::env::consts::EXE_SUFFIX)))
}

/// `cargo xtask bench --only batch`.
pub(super) fn run(rounds: usize) -> TaskResult {
    let program = program()?;
    let folder = crate::workspace_root().join(".bench").join("batch");
    std::fs::create_dir_all(&folder)?;
    let flights: Vec<Trial> = generate(&Law::PAPER, 16, COUNT);
    let path = folder.join("trials.csv");
    write(&path, &flights)?;
    println!("{COUNT} flights of two gears, one thread{:>21}{:>12}{:>12}", "whole, µs", "query, µs", "ratio");
    let CommandRun { seconds: plain, answers: expected } = run_command(&program, &path, rounds)?;
    let print = |name: &str, whole: f64, found: &[Answer]| {
        let query = found.iter().map(|answer| answer.microseconds).sum::<f64>() / COUNT as f64;
        let whole_each = whole * 1e6 / COUNT as f64;
        println!("{name:<46}{whole_each:>12.1}{query:>12.1}{:>12.2}", whole / plain);
    };
    print("CSV, constant twists", plain, &expected);
    for (form, name) in FORMS {
        let path = folder.join(format!("{form:?}.jsonl").to_lowercase());
        let mut text = String::new();
        for (k, flight) in flights.iter().enumerate() {
            let line = serde_json::json!({
                "a": motion(&flight.a, form, k), "b": motion(&flight.b, form, k + 1), "window": [0.0, 1.0],
            });
            text.push_str(&line.to_string());
            text.push('\n');
        }
        std::fs::write(&path, text)?;
        let CommandRun { seconds: whole, answers: found } = run_command(&program, &path, rounds)?;
        if found.len() != expected.len() {
            return Err(format!("{name}: {} answers", found.len()).into());
        }
        for (k, (x, y)) in found.iter().zip(&expected).enumerate() {
            // Both are infinite where the bodies stay apart.
            let same = x.status == y.status && (x.time == y.time || (x.time - y.time).abs() <= SAME_TIME);
            if !same {
                let (x, y) = ((&x.status, x.time), (&y.status, y.time));
                return Err(format!("{name}, line {}: {x:?} and not {y:?}", k + 1).into());
            }
        }
        print(name, whole, &found);
    }
    per_thread(rounds, &flights, &expected)
}

/// The same flights in the library: what a thread of a batch does, over what one does with single queries. Of splines, whose body B moves alike in
/// all of them, too.
fn per_thread(rounds: usize, flights: &[Trial], expected: &[Answer]) -> TaskResult {
    let tree = MeshTree::new(d2m::shapes::mesh("gear")?);
    let twist = |m: &Movement| ConstantTwist::try_new(m.position, m.rotation, m.velocity, m.angular_velocity);
    let twists: Vec<[ConstantTwist; 2]> = flights
        .iter()
        .map(|flight| Ok([twist(&flight.a)?, twist(&flight.b)?]))
        .collect::<Result<_, d2m::motion::MotionError>>()?;
    let pairs: Vec<Pair<'_>> =
        twists.iter().map(|[a, b]| (Moving::new(&tree, a), Moving::new(&tree, b))).collect();
    let answers = row(rounds, "constant twists", &pairs)?;
    for (k, (answer, expected)) in answers.iter().zip(expected).enumerate() {
        let time = answer.as_ref().ok().and_then(TimeOfContact::contact).map_or(f64::INFINITY, |c| c.time_lo);
        if time != expected.time && (time - expected.time).abs() > SAME_TIME {
            return Err(wrong(&format!("flight {} at {time}, and {} by the command", k + 1, expected.time)));
        }
    }
    let splines: Vec<Spline> =
        twists.iter().map(|[a, _]| spline(a)).collect::<Result<_, d2m::motion::MotionError>>()?;
    let common = &spline(&twists[0][1])?;
    let pairs: Vec<Pair<'_>> =
        splines.iter().map(|a| (Moving::new(&tree, a), Moving::new(&tree, common))).collect();
    row(rounds, "splines, against one", &pairs)?;
    Ok(())
}

type Pair<'a> = (Moving<'a>, Moving<'a>);

/// Through five of its poses.
fn spline(twist: &ConstantTwist) -> Result<Spline, d2m::motion::MotionError> {
    let frames: Vec<(f64, Pose)> =
        [0.0, 0.25, 0.5, 0.75, 1.0].map(|time| (time, twist.pose_and_twist(time).0)).into();
    Spline::try_through(&frames, SplineDegree::Cubic)
}

/// One thread and two, in turn with single queries; the answers.
fn row(
    rounds: usize,
    name: &str,
    pairs: &[Pair<'_>],
) -> Result<Vec<Result<TimeOfContact, QueryError>>, Error> {
    let options = QueryOptions::default();
    let single = || pairs.iter().map(|&(a, b)| time_of_contact(a, b, Window::UNIT, &options)).collect();
    let expected: Vec<_> = single();
    for (count, threads) in [(1, "one thread"), (2, "two threads")] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
        let mut least = [[f64::INFINITY; 2]; 2];
        let (mut waiting, mut wall) = (0.0, 0.0);
        for _ in 0..TURNS * rounds {
            let (alone, _) = threads::measure(|| std::hint::black_box(single()));
            let (together, found) =
                threads::measure(|| pool.install(|| time_of_contact_batch(pairs, Window::UNIT, &options)));
            if found != expected {
                return Err(wrong("a batch gives other bits than single queries"));
            }
            for (least, cost) in least.iter_mut().zip([&alone, &together]) {
                *least = [least[0].min(cost.wall), least[1].min(cost.busiest)];
                (waiting, wall) = (waiting + cost.waiting, wall + cost.wall);
            }
        }
        let part = |clock: usize| least[0][clock] / (least[1][clock] * count as f64);
        BusyFigure {
            what: format!("batch of {name}, {threads}: queries a thread over single ones"),
            value: part(0),
            by_processor: part(1),
            unit: "times",
            target: Target::AtLeast(LEAST_PER_THREAD),
            waited: waiting / wall,
        }
        .print();
    }
    Ok(expected)
}
