//! Rows that compare motions of every kind with constant twists: what each costs, and whether its answers are right.

use d2m::bvh::{Posed, distance};
use d2m::glam::{DQuat, DVec3};
use d2m::motion::{Chain, Joint, JointKind, JointValue, Keyframes, Pose, Span};
use d2m::{
    ConstantTwist, MeshTree, Moving, QueryOptions, RigidMotion, Solid, TimeOfContact, Window, time_of_contact,
};
use d2m_testing::{Draw, KnuthRandom, Opaque, OpaqueWithState};
use std::f64::consts::TAU;
use std::time::Instant;

/// Times of a query that are checked before an answer counts.
const SAMPLES: u32 = 48;
/// What may be left of the tolerance at the time of contact, in tolerances: the engine's promise.
const MOST_LEFT: f64 = 3.3;

/// One question.
pub struct Question<'a> {
    /// The bodies.
    pub bodies: [&'a MeshTree; 2],
    /// Their motions.
    pub motions: [Box<dyn RigidMotion + Send>; 2],
    /// When.
    pub window: Window,
    /// How.
    pub options: QueryOptions,
}

impl Question<'_> {
    /// Asks the default engine.
    ///
    /// # Panics
    /// If the question is not valid: those of this module are.
    pub fn ask(&self) -> TimeOfContact {
        let [a, b] = [0, 1].map(|k| Moving::new(self.bodies[k], &*self.motions[k]));
        time_of_contact(a, b, self.window, &self.options).expect("valid input")
    }

    /// What is wrong with an answer: distances at rest at many times before its end, and what is left at its time.
    ///
    /// # Errors
    /// The fault.
    pub fn check(&self, answer: &TimeOfContact) -> Result<(), String> {
        let end = match answer {
            TimeOfContact::Contact(contact) => contact.time_lo,
            TimeOfContact::Separated => self.window.end(),
            TimeOfContact::Undecided { clear_until } => {
                return Err(format!("undecided from {clear_until} on"));
            }
        };
        let at = |t: f64| {
            let posed = [0, 1].map(|k| Posed::new(self.bodies[k], self.motions[k].pose_and_twist(t).0));
            distance(posed[0], posed[1], self.options.solid).map_err(|error| error.to_string())
        };
        let start = self.window.start();
        for k in 0..=SAMPLES {
            let t = (start + (end - start) * f64::from(k) / f64::from(SAMPLES)).min(end);
            if at(t)?.upper <= 0.0 {
                return Err(format!("touching at {t}, before {end}"));
            }
        }
        let Some(contact) = answer.contact() else { return Ok(()) };
        let left = at(end)?.lower;
        if left > MOST_LEFT * contact.tolerance { Err(format!("{left:e} left at {end}")) } else { Ok(()) }
    }
}

/// Questions that are asked together.
pub struct Row<'a> {
    /// What it shows.
    pub name: String,
    /// The questions.
    pub questions: Vec<Question<'a>>,
    /// What the median is compared with: the number of an earlier row of the group, and the largest wanted ratio.
    pub against: Option<(usize, f64)>,
    /// The largest wanted time of the slowest query, in microseconds.
    pub most: Option<f64>,
}

/// Times of a row.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// Of the least times of the questions, in microseconds.
    pub median: f64,
    /// The largest of them.
    pub worst: f64,
}

/// Least times of the rows' questions over rounds in which the rows take turns; every answer is checked first.
///
/// # Errors
/// An answer that is wrong.
pub fn measure(rows: &[Row<'_>], rounds: u32) -> Result<Vec<Times>, String> {
    for row in rows {
        for (index, question) in row.questions.iter().enumerate() {
            question.check(&question.ask()).map_err(|fault| format!("{}, {index}: {fault}", row.name))?;
        }
    }
    let mut least: Vec<Vec<f64>> = rows.iter().map(|row| vec![f64::INFINITY; row.questions.len()]).collect();
    for _ in 0..rounds {
        for (row, least) in rows.iter().zip(&mut least) {
            for (question, least) in row.questions.iter().zip(least) {
                let start = Instant::now();
                let _ = std::hint::black_box(question.ask());
                *least = least.min(start.elapsed().as_secs_f64() * 1e6);
            }
        }
    }
    Ok(least
        .into_iter()
        .map(|mut times| {
            times.sort_by(f64::total_cmp);
            Times { median: times[times.len() / 2], worst: times[times.len() - 1] }
        })
        .collect())
}

/// The bodies of the rows.
pub struct Bodies {
    pebbles: [MeshTree; 2],
    knot: MeshTree,
    gear: MeshTree,
    bearings: Vec<(f64, [MeshTree; 2])>,
}

impl Bodies {
    /// Builds them; `size` times the triangles of the table.
    pub fn new(size: f64) -> Self {
        let count = |triangles: f64| ((triangles * size) as usize).max(64);
        let bearing = |clearance: f64| {
            let triangles = count(2560.0);
            let of = |text: String| shape(&text);
            let shaft = of(format!("shaft?triangles={triangles}"));
            (clearance, [shaft, of(format!("bearing?triangles={triangles}&clearance={clearance}"))])
        };
        Self {
            pebbles: [
                unit(&format!("pebble?triangles={}", count(5856.0))),
                unit(&format!("pebble?triangles={}&seed=2", count(5804.0))),
            ],
            knot: unit(&format!("torus-knot?triangles={}", count(70_000.0))),
            gear: unit("gear"),
            bearings: [1e-2, 1e-3, 1e-6].map(bearing).into(),
        }
    }

    /// The groups of rows; within each the ratios count.
    pub fn groups(&self, flights: usize) -> Vec<Vec<Row<'_>>> {
        vec![
            hidden("gears", [&self.gear, &self.gear], flights),
            hidden("knots of 70 000 triangles", [&self.knot, &self.knot], flights),
            arm([&self.gear, &self.knot], flights),
            keyframes([&self.pebbles[0], &self.pebbles[1]]),
            together([&self.pebbles[0], &self.pebbles[1]], flights),
            self.shafts(),
            spins([&self.pebbles[0], &self.pebbles[1]], flights),
        ]
    }

    /// A shaft that turns once and becomes faster by 0.1 rad/s², in its bearing.
    fn shafts(&self) -> Vec<Row<'_>> {
        self.bearings
            .iter()
            .map(|(clearance, [shaft, bearing])| {
                let turn = revolute(DVec3::ZERO, DVec3::Z, &[0.0, TAU, 0.05]);
                let turn = Chain::try_new(vec![turn]).expect("an axis");
                Row {
                    name: format!("shaft in bearing, 0.1 rad/s², clearance {clearance:e}"),
                    questions: vec![Question {
                        bodies: [shaft, bearing],
                        motions: [Box::new(turn), Box::new(ConstantTwist::REST)],
                        window: Window::UNIT,
                        options: QueryOptions::default().with_solid(Solid::Surface),
                    }],
                    against: None,
                    most: Some(20_000.0),
                }
            })
            .collect()
    }
}

fn shape(text: &str) -> MeshTree {
    MeshTree::new(d2m::shapes::mesh(text).expect("a shape of the project"))
}

/// Scaled about the origin so that the farthest vertex is at distance 1.
fn unit(text: &str) -> MeshTree {
    let mesh = d2m::shapes::mesh(text).expect("a shape of the project");
    let radius = mesh.vertices().iter().map(|v| v.length()).fold(0.0, f64::max);
    let vertices = mesh.vertices().iter().map(|&v| v / radius).collect();
    MeshTree::new(d2m::TriMesh::try_new(vertices, mesh.triangles().to_vec()).expect("the same mesh"))
}

fn joint(position: DVec3, kind: JointKind) -> Joint {
    Joint::try_new(position, DQuat::IDENTITY, kind).expect("a joint")
}

fn polynomial(coefficients: &[f64]) -> JointValue {
    JointValue::try_polynomial(coefficients.to_vec()).expect("finite coefficients")
}

fn revolute(position: DVec3, axis: DVec3, coefficients: &[f64]) -> Joint {
    joint(position, JointKind::Revolute { axis, value: polynomial(coefficients) })
}

fn prismatic(axis: DVec3, coefficients: &[f64]) -> Joint {
    joint(DVec3::ZERO, JointKind::Prismatic { axis, value: polynomial(coefficients) })
}

fn direction(random: &mut KnuthRandom) -> DVec3 {
    random.vector().normalize_or(DVec3::X)
}

/// Two bodies of radius 1 that fly at each other at a relative speed of 4, with this spin each.
fn flight(random: &mut KnuthRandom, spin: f64) -> [ConstantTwist; 2] {
    let along = direction(random);
    let across = along.any_orthonormal_vector() * random.signed();
    let half = (along * (2.05 + 4.0 * (0.425 + 0.375 * random.signed())) + across) * 0.5;
    [1.0, -1.0].map(|sign| {
        let (turn, spin) = (random.moderate_turn().normalize(), direction(random) * spin);
        ConstantTwist::try_new(half * -sign, turn, along * (2.0 * sign), spin).expect("finite numbers")
    })
}

fn question(
    bodies: [&MeshTree; 2],
    a: impl RigidMotion + Send + 'static,
    b: impl RigidMotion + Send + 'static,
) -> Question<'_> {
    let options = QueryOptions::default();
    Question { bodies, motions: [Box::new(a), Box::new(b)], window: Window::UNIT, options }
}

fn row<'a>(name: &str, questions: Vec<Question<'a>>, against: Option<(usize, f64)>) -> Row<'a> {
    Row { name: name.into(), questions, against, most: None }
}

/// Constant twists, as they are and hidden.
fn hidden<'a>(name: &str, bodies: [&'a MeshTree; 2], flights: usize) -> Vec<Row<'a>> {
    let mut random = KnuthRandom(5);
    let motions: Vec<_> = (0..flights).map(|_| flight(&mut random, 2.0)).collect();
    let exact = motions.iter().map(|&[a, b]| question(bodies, a, b)).collect();
    let states =
        motions.iter().map(|&[a, b]| question(bodies, OpaqueWithState(a), OpaqueWithState(b))).collect();
    let enclosures = motions.iter().map(|&[a, b]| question(bodies, Opaque(a), Opaque(b))).collect();
    vec![
        row(&format!("{name}: constant twists"), exact, None),
        row(&format!("{name}: the same behind `enclose_state`"), states, Some((0, 1.5))),
        row(&format!("{name}: the same behind enclosures"), enclosures, Some((0, 4.0))),
    ]
}

/// The last link of an arm of six joints sweeps towards a body of 70 000 triangles.
fn arm(bodies: [&MeshTree; 2], flights: usize) -> Vec<Row<'_>> {
    let mut random = KnuthRandom(6);
    let twists = (0..flights)
        .map(|_| {
            let [a, b] = flight(&mut random, 2.0);
            question(bodies, a, b)
        })
        .collect();
    let links = (0..flights)
        .map(|_| {
            let mut joints = Vec::new();
            for k in 0..6 {
                let value: Vec<f64> = [1.5, 1.0, 0.7, 0.3].iter().map(|c| c * random.signed()).collect();
                joints.push(revolute(
                    if k == 0 { DVec3::ZERO } else { DVec3::X * 0.8 },
                    direction(&mut random),
                    &value,
                ));
            }
            joints.push(joint(DVec3::X * 0.8, JointKind::Fixed));
            let link = Chain::try_new(joints).expect("an arm");
            // Where the link is at a time of the window, seen from further away.
            let (there, _) = link.pose_and_twist(0.5 + 0.4 * random.signed());
            let (start, _) = link.pose_and_twist(0.0);
            let away = (there.translation - start.translation).normalize_or(DVec3::X) * 2.2;
            let place = start.translation + away;
            let still = ConstantTwist::REST.with_position(place).with_angular_velocity(random.vector());
            question(bodies, link, still)
        })
        .collect();
    vec![
        row("constant twists, gear and knot of 70 000 triangles", twists, None),
        Row { most: Some(200.0), ..row("last link of six joints, the same bodies", links, Some((0, 10.0))) },
    ]
}

/// 200 spans between keyframes, a contact in the last one.
fn keyframes(bodies: [&MeshTree; 2]) -> Vec<Row<'_>> {
    let frames: Vec<(f64, Pose)> = (0..=200)
        .map(|i| {
            let t = f64::from(i);
            let x = if i == 200 { 0.0 } else { 30.0 + (0.1 * t).sin() };
            let rotation = DQuat::from_rotation_z(0.01 * t);
            (t, Pose { translation: DVec3::X * x, rotation, at: DVec3::ZERO })
        })
        .collect();
    let path = Keyframes::try_new(&frames, Span::Linear).expect("poses at increasing times");
    let last = path.motions()[199];
    let of = |start: f64, question: Question<'_>| Question {
        window: Window::try_new(start, 200.0).expect("times in order"),
        bodies,
        motions: question.motions,
        options: question.options,
    };
    let alone = of(199.0, question(bodies, last, ConstantTwist::REST));
    let all = of(0.0, question(bodies, path, ConstantTwist::REST));
    vec![
        row("the last of 200 spans by itself", vec![alone], None),
        Row { most: Some(300.0), ..row("200 spans, contact in the last", vec![all], None) },
    ]
}

/// Bodies that accelerate together, and the same against each other without.
fn together(bodies: [&MeshTree; 2], flights: usize) -> Vec<Row<'_>> {
    let mut random = KnuthRandom(7);
    let (mut rest, mut falling) = (Vec::new(), Vec::new());
    for _ in 0..flights {
        let along = direction(&mut random);
        let place = along * (2.05 + 4.0 * (0.425 + 0.375 * random.signed()));
        let far = ConstantTwist::REST.with_position(place).with_linear_velocity(along * -4.0);
        rest.push(question(bodies, far, ConstantTwist::REST));
        let fall = || prismatic(DVec3::Z, &[0.0, 1.0, -50.0, 7.0]);
        let a = vec![fall(), joint(place, JointKind::Fixed), prismatic(along, &[0.0, -4.0])];
        let (a, b) = (Chain::try_new(a), Chain::try_new(vec![fall()]));
        falling.push(question(bodies, a.expect("a chain"), b.expect("a chain")));
    }
    vec![
        row("one body moves", rest, None),
        row("the same while both accelerate together", falling, Some((0, 1.5))),
    ]
}

/// Both bodies spin at exactly this angular speed.
fn spins(bodies: [&MeshTree; 2], flights: usize) -> Vec<Row<'_>> {
    [(0.0, 0.0), (3.0, 0.0), (10.0, 0.0), (30.0, 3.0), (100.0, 0.0), (300.0, 8.0)]
        .into_iter()
        .map(|(spin, most)| {
            let mut random = KnuthRandom(8);
            let questions = (0..flights)
                .map(|_| {
                    let [a, b] = flight(&mut random, spin);
                    question(bodies, a, b)
                })
                .collect();
            let against = (spin > 0.0).then_some((0, if most > 0.0 { most } else { f64::INFINITY }));
            row(&format!("|w| = {spin}"), questions, against)
        })
        .collect()
}
