//! Hard cases with high-precision truth (`testdata/cases.jsonl`) and cases at the ends of the range of doubles
//! (`testdata/extreme_cases.jsonl`, with the times of contact times 2^exponent): none missed, none late, all decided.

use d2m_feature::{ContactOptions, FirstContact, PairMotion, Sphere, StraightPaths};
use d2m_motion::ConstantTwist;
use d2m_root::Evidence;
use d2m_testing::OpaqueWithState;
use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::time::Instant;

const CASES: &str = include_str!("../testdata/cases.jsonl");
const EXTREME: &str = include_str!("../testdata/extreme_cases.jsonl");

fn vector(v: &Value) -> DVec3 {
    let c = |i: usize| v[i].as_f64().expect("a number");
    DVec3::new(c(0), c(1), c(2))
}

fn motion(m: &Value) -> ConstantTwist {
    let q = |i: usize| m["q"][i].as_f64().expect("a number");
    let orientation = DQuat::from_xyzw(q(1), q(2), q(3), q(0));
    ConstantTwist::try_new(vector(&m["x"]), orientation, vector(&m["v"]), vector(&m["w"])).expect("a motion")
}

fn vectors<const N: usize>(v: &Value) -> [DVec3; N] {
    core::array::from_fn(|i| vector(&v[i]))
}

/// The answer, as a pair of constant twists or of motions that enclose themselves.
fn answer(case: &Value, enclosed: bool) -> FirstContact {
    let options = ContactOptions::new();
    let kind = case["kind"].as_str().expect("a kind");
    if kind.ends_with("_linear") {
        let paths = StraightPaths::new(vectors(&case["t0_points"]), vectors(&case["t1_points"]));
        return if kind == "point_triangle_linear" {
            paths.point_triangle(&options)
        } else {
            paths.edge_edge(&options)
        };
    }
    let (a, b) = (motion(&case["motionA"]), motion(&case["motionB"]));
    let (t0, t1) = (case["t0"].as_f64().unwrap(), case["t1"].as_f64().unwrap());
    let sphere = |s: &str| Sphere { center: vector(&case[s]["c"]), radius: case[s]["r"].as_f64().unwrap() };
    let hidden = [OpaqueWithState(a), OpaqueWithState(b)];
    let pair = if enclosed {
        PairMotion::new(&hidden[0], &hidden[1], t0, t1)
    } else {
        PairMotion::new(&a, &b, t0, t1)
    };
    match kind {
        "point_triangle" => {
            pair.point_triangle(vector(&case["A"]["p"]), &vectors(&case["B"]["tri"]), &options)
        }
        "edge_edge" => pair.edge_edge(vectors(&case["A"]["edge"]), vectors(&case["B"]["edge"]), &options),
        _ => pair.sphere_sphere(sphere("A"), sphere("B"), &options),
    }
}

/// A plain decimal times a power of two.
fn decimal(text: &str, exponent: i64) -> RBig {
    let (digits, sign) = text.strip_prefix('-').map_or((text, 1), |d| (d, -1));
    let (whole, rest) = digits.split_once('.').unwrap_or((digits, ""));
    let n: IBig = format!("{whole}{rest}").parse().expect("digits");
    let value = RBig::from_parts(n * sign, IBig::from(10).pow(rest.len()).try_into().unwrap());
    let power = RBig::from(IBig::from(1) << exponent.unsigned_abs() as usize);
    if exponent < 0 { value / power } else { value * power }
}

/// What the truth of a family with `digits` digits may be off by, relative to 1.
fn check(case: &Value, answer: FirstContact, slack: &RBig) {
    let id = &case["id"];
    let (toc, exponent) = (case["toc"].as_str().expect("a time"), case["exponent"].as_i64().unwrap_or(0));
    match (toc, answer) {
        (_, FirstContact::Undecided { .. }) => panic!("{id}: {answer:?} for {toc}"),
        ("none", FirstContact::Clear) => {}
        ("none", FirstContact::Contact(contact)) => {
            let clearance = case["clearance"].as_f64().unwrap_or(0.0);
            // (The clearance of random families is only a flag.)
            assert!(clearance < 1e-8 || clearance == 1.0, "{id}: {contact:?}, clearance {clearance:e}");
            assert!(contact.evidence == Evidence::WithinTolerance, "{id}: {contact:?}");
        }
        (toc, FirstContact::Contact(contact)) => {
            let unit = decimal("1", exponent);
            let late = RBig::try_from(contact.lo).unwrap() - decimal(toc, exponent);
            assert!(late <= slack * &unit, "{id}: late, {contact:?} for {toc}");
            assert!(contact.lo <= contact.hi && contact.distance <= contact.tolerance, "{id}: {contact:?}");
            if let Some(t0) = case["t0"].as_f64() {
                let t1 = case["t1"].as_f64().unwrap();
                assert!(t0 <= contact.lo && contact.hi <= t1, "{id}: outside of the window, {contact:?}");
            }
        }
        (toc, FirstContact::Clear) => panic!("{id}: clear for {toc}"),
    }
}

#[test]
fn no_contact_missed_and_none_late() {
    let mut count = 0;
    for line in CASES.lines() {
        let case: Value = serde_json::from_str(line).unwrap();
        // Truth of the random families is good to 1e-15, of the others to their last digit.
        let digits = if case["toc"].as_str().unwrap().len() < 24 { 15 } else { 36 };
        let slack = RBig::from_parts(2.into(), dashu_int::UBig::from(10_u8).pow(digits));
        check(&case, answer(&case, false), &slack);
        check(&case, answer(&case, true), &slack);
        count += 1;
    }
    assert_eq!(count, 173);
}

#[test]
fn extreme_units_and_spins_are_decided_within_a_second() {
    let mut count = 0;
    for line in EXTREME.lines() {
        let case: Value = serde_json::from_str(line).unwrap();
        let start = Instant::now();
        let answer = answer(&case, false);
        assert!(start.elapsed().as_secs_f64() < 1.0, "{}: {:?}", case["id"], start.elapsed());
        let digits = if case["toc"].as_str().unwrap().len() < 24 { 11 } else { 36 };
        let slack = RBig::from_parts(1.into(), dashu_int::UBig::from(10_u8).pow(digits));
        check(&case, answer, &slack);
        count += 1;
    }
    assert_eq!(count, 16);
}
