//! `d2m features`: first contact of single feature pairs, JSON lines in, JSON lines out.

use crate::arguments::FeaturesArguments;
use crate::engine::{MIN_SEPARATION, TOLERANCE, number};
use crate::failure::{Failure, json_fault};
use crate::load::{named, read};
use crate::output::Output;
use crate::report::microseconds;
use d2m::feature::{self, ContactOptions, FirstContact, PairMotion, StraightPaths};
use d2m::motion::ConstantTwist;
use d2m::motion::serde_object::one;
use d2m::root::Evidence;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::time::{Duration, Instant};

#[derive(Deserialize)]
struct Case {
    id: String,
    #[serde(flatten)]
    question: Question,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Question {
    PointTriangle {
        #[serde(rename = "A", deserialize_with = "one")]
        a: Point,
        #[serde(rename = "B", deserialize_with = "one")]
        b: Triangle,
        #[serde(flatten)]
        moving: Moving,
    },
    EdgeEdge {
        #[serde(rename = "A", deserialize_with = "one")]
        a: Edge,
        #[serde(rename = "B", deserialize_with = "one")]
        b: Edge,
        #[serde(flatten)]
        moving: Moving,
    },
    SphereSphere {
        #[serde(rename = "A", deserialize_with = "one")]
        a: Sphere,
        #[serde(rename = "B", deserialize_with = "one")]
        b: Sphere,
        #[serde(flatten)]
        moving: Moving,
    },
    PointTriangleLinear(Straight),
    EdgeEdgeLinear(Straight),
}

#[derive(Deserialize)]
struct Moving {
    #[serde(rename = "motionA")]
    motion_a: ConstantTwist,
    #[serde(rename = "motionB")]
    motion_b: ConstantTwist,
    t0: f64,
    t1: f64,
}

impl Moving {
    fn pair(&self) -> PairMotion<'_> {
        PairMotion::new(&self.motion_a, &self.motion_b, self.t0, self.t1)
    }
}

#[derive(Deserialize)]
struct Straight {
    t0_points: [DVec3; 4],
    t1_points: [DVec3; 4],
}

#[derive(Deserialize)]
struct Point {
    p: DVec3,
}

#[derive(Deserialize)]
struct Triangle {
    tri: [DVec3; 3],
}

#[derive(Deserialize)]
struct Edge {
    edge: [DVec3; 2],
}

#[derive(Deserialize)]
struct Sphere {
    c: DVec3,
    r: f64,
}

#[derive(Serialize)]
struct Answer<'a> {
    id: &'a str,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_lo: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_hi: Option<f64>,
    /// Of a hit: `crossing` (the features are proven to meet within the bracket) or `near` (within the tolerance beyond
    /// the minimum separation at a time of the bracket).
    #[serde(skip_serializing_if = "Option::is_none")]
    evidence: Option<&'static str>,
    /// Of a hit: the distance that was used as tolerance. It is larger than the one given where rounding or the
    /// resolution of time requires it.
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    microseconds: f64,
}

/// Answers every case of a file. Nothing is written unless every line is a case.
pub(crate) fn run(arguments: &FeaturesArguments) -> Result<(), Failure> {
    let options = options(arguments)?;
    let out = Output::new(&arguments.out)?.spare([arguments.cases.as_path()])?;
    let cases = read_cases(&arguments.cases)?;
    let mut text = String::new();
    for case in &cases {
        let (answer, took) = case.question.answer(&options);
        let mut line = Answer {
            id: &case.id,
            status: "miss",
            t_lo: None,
            t_hi: None,
            evidence: None,
            tolerance: None,
            microseconds: microseconds(took),
        };
        match answer {
            FirstContact::Clear => {}
            FirstContact::Undecided { clear_until } => {
                (line.status, line.t_lo) = ("undecided", Some(clear_until));
            }
            FirstContact::Contact(contact) => {
                (line.status, line.t_lo, line.t_hi) = ("hit", Some(contact.lo), Some(contact.hi));
                let crosses = contact.evidence == Evidence::Crossing;
                line.evidence = Some(if crosses { "crossing" } else { "near" });
                line.tolerance = Some(contact.tolerance);
            }
        }
        text.push_str(&serde_json::to_string(&line).expect("numbers and strings serialize"));
        text.push('\n');
    }
    out.write(&text)
}

/// One case a line; blank lines are skipped.
fn read_cases(path: &Path) -> Result<Vec<Case>, Failure> {
    let bytes = read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let cases: Vec<Case> = lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(index, line)| {
            read_case(line)
                .map_err(|reason| Failure::Input(format!("{}, line {}: {reason}", named(path), index + 1)))
        })
        .collect::<Result<_, _>>()?;
    if cases.is_empty() { Err(Failure::at(named(path), "there are no cases")) } else { Ok(cases) }
}

fn read_case(line: &str) -> Result<Case, String> {
    let case: Case = serde_json::from_str(line).map_err(|error| json_fault(&error, line))?;
    case.question.check().map_err(|reason| format!("case {:?}: {reason}", case.id))?;
    Ok(case)
}

fn options(arguments: &FeaturesArguments) -> Result<ContactOptions, Failure> {
    let mut options = ContactOptions::new().with_max_evaluations(arguments.budget);
    if let Some(text) = &arguments.tolerance {
        options = options.with_tolerance(number("--tolerance", text, TOLERANCE, |t| t > 0.0)?);
    }
    if let Some(text) = &arguments.min_separation {
        let distance = number("--min-separation", text, MIN_SEPARATION, |d| d >= 0.0)?;
        options = options.with_min_separation(distance);
    }
    Ok(options)
}

impl Question {
    /// Everything finite, the window in order, radii not negative.
    fn check(&self) -> Result<(), String> {
        let points = |name: &str, points: &[DVec3]| match points.iter().position(|p| !p.is_finite()) {
            Some(i) => Err(format!("{name}[{i}] is {}: coordinates must be finite", points[i])),
            None => Ok(()),
        };
        let window = |moving: &Moving| {
            if moving.t0.is_finite() && moving.t1.is_finite() && moving.t0 <= moving.t1 {
                Ok(())
            } else {
                Err(format!("window [{:?}, {:?}]: finite times in order are needed", moving.t0, moving.t1))
            }
        };
        match self {
            Self::PointTriangle { a, b, moving } => {
                points("A.p", &[a.p])?;
                points("B.tri", &b.tri)?;
                window(moving)
            }
            Self::EdgeEdge { a, b, moving } => {
                points("A.edge", &a.edge)?;
                points("B.edge", &b.edge)?;
                window(moving)
            }
            Self::SphereSphere { a, b, moving } => {
                points("A.c, B.c", &[a.c, b.c])?;
                if let Some(r) = [a.r, b.r].into_iter().find(|r| !(*r >= 0.0 && r.is_finite())) {
                    return Err(format!("radius {r:?}: a finite number ≥ 0 is needed"));
                }
                window(moving)
            }
            Self::PointTriangleLinear(paths) | Self::EdgeEdgeLinear(paths) => {
                points("t0_points", &paths.t0_points)?;
                points("t1_points", &paths.t1_points)
            }
        }
    }

    /// The answer and the time from the numbers of the case to it.
    fn answer(&self, options: &ContactOptions) -> (FirstContact, Duration) {
        let sphere = |s: &Sphere| feature::Sphere { center: s.c, radius: s.r };
        let start = Instant::now();
        let answer = match self {
            Self::PointTriangle { a, b, moving } => moving.pair().point_triangle(a.p, &b.tri, options),
            Self::EdgeEdge { a, b, moving } => moving.pair().edge_edge(a.edge, b.edge, options),
            Self::SphereSphere { a, b, moving } => moving.pair().sphere_sphere(sphere(a), sphere(b), options),
            Self::PointTriangleLinear(paths) => {
                StraightPaths::new(paths.t0_points, paths.t1_points).point_triangle(options)
            }
            Self::EdgeEdgeLinear(paths) => {
                StraightPaths::new(paths.t0_points, paths.t1_points).edge_edge(options)
            }
        };
        (answer, start.elapsed())
    }
}
