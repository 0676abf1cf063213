//! `d2m features`: first contact of single feature pairs, JSON lines in, JSON lines out.
use crate::failure::Failure;
use crate::output::Output;
use d2m::feature::{ContactOptions, FirstContact, PairMotion, StraightPaths};
use d2m::motion::LinearMotion;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::PathBuf;
use std::time::Instant;

/// First contact of feature pairs (JSON lines).
#[derive(Debug, clap::Args)]
pub(crate) struct FeaturesArgs {
    /// Cases, one JSON object a line: point_triangle, edge_edge, sphere_sphere (two motions), point_triangle_linear,
    /// edge_edge_linear (t0_points, t1_points).
    pub(crate) cases: PathBuf,
    /// Results, one JSON object a line: id, status (hit, miss, undecided), t_lo, t_hi, microseconds. `-`: stdout.
    #[arg(long)]
    pub(crate) out: String,
    /// Distance up to which features may be reported as touching [default: 1e-10 times their size].
    #[arg(long, value_name = "DISTANCE")]
    pub(crate) tolerance: Option<f64>,
    /// Distance at which features count as touching.
    #[arg(long, value_name = "DISTANCE", default_value_t = 0.0)]
    pub(crate) min_separation: f64,
    /// Evaluations after which a case is left undecided.
    #[arg(long, value_name = "COUNT", default_value_t = 1 << 20)]
    pub(crate) budget: u32,
}

/// Bad input: the message names file, line and value.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FeaturesError {
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: String,
        /// Why not.
        source: io::Error,
    },
    /// A line is not a case.
    #[error("{path}:{line}: {reason}")]
    Line {
        /// Which file.
        path: String,
        /// Which line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// An option is not a number that makes sense, or a file has no case.
    #[error("{0}")]
    Option(String),
    /// The results cannot be written.
    #[error(transparent)]
    Output(#[from] Failure),
}

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
        #[serde(rename = "A")]
        a: Point,
        #[serde(rename = "B")]
        b: Triangle,
        #[serde(flatten)]
        moving: Moving,
    },
    EdgeEdge {
        #[serde(rename = "A")]
        a: Edge,
        #[serde(rename = "B")]
        b: Edge,
        #[serde(flatten)]
        moving: Moving,
    },
    SphereSphere {
        #[serde(rename = "A")]
        a: Sphere,
        #[serde(rename = "B")]
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
    motion_a: LinearMotion,
    #[serde(rename = "motionB")]
    motion_b: LinearMotion,
    t0: f64,
    t1: f64,
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
    microseconds: f64,
}

/// Answers every case of a file. Nothing is written unless every line is a case.
pub(crate) fn run(args: &FeaturesArgs) -> Result<(), FeaturesError> {
    let options = options(args)?;
    let out = Output::new(&args.out)?.spare([args.cases.as_path()])?;
    let name = args.cases.display().to_string();
    let file =
        File::open(&args.cases).map_err(|source| FeaturesError::File { path: name.clone(), source })?;
    let mut cases = Vec::new();
    for (index, line) in BufReader::new(file).lines().enumerate() {
        let fail = |reason: String| FeaturesError::Line { path: name.clone(), line: index + 1, reason };
        let line = line.map_err(|error| fail(error.to_string()))?;
        if line.trim().is_empty() {
            continue;
        }
        let case: Case = serde_json::from_str(&line).map_err(|error| fail(error.to_string()))?;
        case.question.check().map_err(|reason| fail(format!("case {:?}: {reason}", case.id)))?;
        cases.push(case);
    }
    if cases.is_empty() {
        return Err(FeaturesError::Option(format!("{name}: there are no cases")));
    }
    let mut text = Vec::new();
    for case in &cases {
        let (answer, microseconds) = case.question.answer(&options);
        let (status, t_lo, t_hi) = match answer {
            FirstContact::Contact(contact) => ("hit", Some(contact.lo), Some(contact.hi)),
            FirstContact::Undecided { clear_until } => ("undecided", Some(clear_until), None),
            FirstContact::Clear => ("miss", None, None),
        };
        let line = Answer { id: &case.id, status, t_lo, t_hi, microseconds };
        serde_json::to_writer(&mut text, &line).expect("numbers and strings serialize");
        text.push(b'\n');
    }
    Ok(out.write(&String::from_utf8_lossy(&text))?)
}

fn options(args: &FeaturesArgs) -> Result<ContactOptions, FeaturesError> {
    let mut options = ContactOptions::new().with_max_evaluations(args.budget);
    if let Some(tolerance) = args.tolerance {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            let message = format!("--tolerance {tolerance}: a positive finite distance is needed");
            return Err(FeaturesError::Option(message));
        }
        options = options.with_tolerance(tolerance);
    }
    if !(args.min_separation >= 0.0 && args.min_separation.is_finite()) {
        let message = format!("--min-separation {}: a finite distance ≥ 0 is needed", args.min_separation);
        return Err(FeaturesError::Option(message));
    }
    Ok(options.with_min_separation(args.min_separation))
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
                Err(format!("window [{}, {}]: finite times in order are needed", moving.t0, moving.t1))
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
                    return Err(format!("radius {r}: a finite number ≥ 0 is needed"));
                }
                window(moving)
            }
            Self::PointTriangleLinear(paths) | Self::EdgeEdgeLinear(paths) => {
                points("t0_points", &paths.t0_points)?;
                points("t1_points", &paths.t1_points)
            }
        }
    }

    /// The answer and the microseconds that the query alone took.
    fn answer(&self, options: &ContactOptions) -> (FirstContact, f64) {
        let pair =
            |moving: &Moving| PairMotion::new(&moving.motion_a, &moving.motion_b, moving.t0, moving.t1);
        match self {
            Self::PointTriangle { a, b, moving } => {
                let pair = pair(moving);
                let triangle = pair.place_triangle(&b.tri);
                timed(|| pair.point_placed(a.p, &triangle, options))
            }
            Self::EdgeEdge { a, b, moving } => {
                let pair = pair(moving);
                timed(|| pair.edge_edge(a.edge, b.edge, options))
            }
            Self::SphereSphere { a, b, moving } => {
                let pair = pair(moving);
                timed(|| pair.sphere_sphere((a.c, a.r), (b.c, b.r), options))
            }
            Self::PointTriangleLinear(paths) => {
                let paths = StraightPaths::new(paths.t0_points, paths.t1_points);
                timed(|| paths.point_triangle(options))
            }
            Self::EdgeEdgeLinear(paths) => {
                let paths = StraightPaths::new(paths.t0_points, paths.t1_points);
                timed(|| paths.edge_edge(options))
            }
        }
    }
}

fn timed(query: impl FnOnce() -> FirstContact) -> (FirstContact, f64) {
    let start = Instant::now();
    let answer = query();
    (answer, start.elapsed().as_secs_f64() * 1e6)
}
