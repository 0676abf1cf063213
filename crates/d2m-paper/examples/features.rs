//! Runs the reference method's feature tests over a file of cases (JSON lines) and prints one result line a case.
//!
//! `cargo run --release -p d2m-feature --example paper_features -- CASES.jsonl > RESULTS.jsonl`

use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use d2m_paper::{PaperOptions, RelativeMotion, Sphere, edge_edge, point_triangle, sphere_sphere};
use d2m_root::RootSearch;
use glam::{DQuat, DVec3};
use serde_json::Value;

fn vector(v: &Value) -> DVec3 {
    let c = |i: usize| v[i].as_f64().expect("a number");
    DVec3::new(c(0), c(1), c(2))
}

fn motion(m: &Value) -> ConstantTwist {
    let q = |i: usize| m["q"][i].as_f64().expect("a number");
    let orientation = DQuat::from_xyzw(q(1), q(2), q(3), q(0));
    ConstantTwist::try_new(vector(&m["x"]), orientation, vector(&m["v"]), vector(&m["w"])).expect("a motion")
}

fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        for line in text.lines().filter(|l| !l.trim().is_empty()) {
            let case: Value = serde_json::from_str(line).expect("a JSON line");
            if case["kind"].as_str().is_some_and(|k| k.ends_with("_linear")) {
                continue;
            }
            let (a, b) = (motion(&case["motionA"]), motion(&case["motionB"]));
            let relative = RelativeMotion::new(&a, &b);
            let window = Interval::new(case["t0"].as_f64().unwrap(), case["t1"].as_f64().unwrap());
            let options = PaperOptions::DEFAULT;
            let started = std::time::Instant::now();
            let found = match case["kind"].as_str() {
                Some("point_triangle") => {
                    let triangle = core::array::from_fn(|i| vector(&case["B"]["tri"][i]));
                    point_triangle(&relative, vector(&case["A"]["p"]), &triangle, window, &options)
                }
                Some("edge_edge") => {
                    let edge = |s: &str| core::array::from_fn(|i| vector(&case[s]["edge"][i]));
                    edge_edge(&relative, &edge("A"), &edge("B"), window, &options)
                }
                Some("sphere_sphere") => {
                    let sphere = |s: &str| Sphere {
                        center: vector(&case[s]["c"]),
                        radius: case[s]["r"].as_f64().unwrap(),
                    };
                    sphere_sphere(&relative, &sphere("A"), &sphere("B"), window, &options)
                }
                other => panic!("unknown kind {other:?}"),
            };
            let microseconds = started.elapsed().as_secs_f64() * 1e6;
            let id = &case["id"];
            match found {
                RootSearch::None => {
                    println!("{{\"id\": {id}, \"status\": \"miss\", \"microseconds\": {microseconds}}}");
                }
                RootSearch::Bracket(t) => println!(
                    "{{\"id\": {id}, \"status\": \"hit\", \"t_lo\": {:?}, \"t_hi\": {:?}, \"microseconds\": {microseconds}}}",
                    t.lo(),
                    t.hi()
                ),
                RootSearch::Undecided { clear_until } => println!(
                    "{{\"id\": {id}, \"status\": \"undecided\", \"t_lo\": {clear_until:?}, \"t_hi\": {:?}, \"microseconds\": {microseconds}}}",
                    window.hi()
                ),
            }
        }
    }
}
