//! The hard feature cases with high-precision truth (`testdata/cases.jsonl`) through the reference method.

use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use d2m_paper::{PaperOptions, RelativeMotion, Sphere, edge_edge, point_triangle, sphere_sphere};
use d2m_root::RootSearch;
use d2m_testing::fixed::Fix;
use dashu_int::IBig;
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

/// A plain decimal, rounded up by at most 2⁻²⁵⁶.
fn decimal(text: &str) -> Fix {
    let (digits, sign) = text.strip_prefix('-').map_or((text, 1), |d| (d, -1));
    let (whole, rest) = digits.split_once('.').unwrap_or((digits, ""));
    let n: IBig = format!("{whole}{rest}").parse().expect("digits");
    Fix((n << 256usize) * sign / IBig::from(10).pow(rest.len()) + 1)
}

#[test]
fn no_contact_missed_and_none_late() {
    let mut cases = 0;
    for line in include_str!("../../d2m-feature/testdata/cases.jsonl").lines() {
        let case: Value = serde_json::from_str(line).unwrap();
        // The reference method has no straight paths.
        if !case["kind"].as_str().unwrap().ends_with("_linear") {
            cases += 1;
            judge(&case);
        }
    }
    assert_eq!(cases, 157);
}

fn judge(case: &Value) {
    let id = &case["id"];
    let (a, b) = (motion(&case["motionA"]), motion(&case["motionB"]));
    let relative = RelativeMotion::new(&a, &b);
    let window = Interval::new(case["t0"].as_f64().unwrap(), case["t1"].as_f64().unwrap());
    let options = PaperOptions::DEFAULT;
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
            let sphere =
                |s: &str| Sphere { center: vector(&case[s]["c"]), radius: case[s]["r"].as_f64().unwrap() };
            sphere_sphere(&relative, &sphere("A"), &sphere("B"), window, &options)
        }
        other => panic!("{id}: unknown kind {other:?}"),
    };
    match (case["toc"].as_str().unwrap(), found) {
        ("ambiguous", _) | ("none", RootSearch::None) => {}
        ("none", RootSearch::Bracket(_)) => {
            let clearance = case["clearance"].as_f64().unwrap_or(0.0);
            assert!(clearance < 1e-8, "{id}: a contact where the clearance is {clearance:e}");
        }
        (toc, RootSearch::Bracket(b)) => {
            assert!(Fix::new(b.lo()) <= decimal(toc), "{id}: late, {b:?} for {toc}");
            assert!(window.lo() <= b.lo() && b.hi() <= window.hi(), "{id}: outside the window");
        }
        (toc, other) => panic!("{id}: {other:?} for {toc}"),
    }
}
