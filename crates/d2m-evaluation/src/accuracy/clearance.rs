//! Least distances over a window, and the spans of contact, against the judge's distances at many times.
//!
//! Boxes, coarse knots, splines and chains in turn; a quarter of the bodies are solids. Placements of constant twists and of chains
//! are computed anew with the platform's sine; those of splines are the motion's own, which is the definition of it.
use super::{Outcome, Task};
use crate::judge::{BoxTree, Hint, Placement, place, separation};
use crate::trials::Movement;
use d2m::bvh::{
    Clearance, ClearanceOptions, ClearanceStatus, ContactSpan, MeshTree, Moving, QueryOptions, Solid,
    SpanStatus, TriMesh, Window, clearance, contact_spans,
};
use d2m::motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Pose, RigidMotion, Spline, SplineDegree,
};
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::{DQuat, DVec3};
use rayon::prelude::*;

/// Times at which the judge measures, evenly over the window.
const SAMPLES: usize = 128;
/// Times on either side of the answered one, each half as far from it as the one before.
const NEAR: i32 = 16;
/// The resolution of the spans: eight samples.
const RESOLUTION: f64 = 8.0 / SAMPLES as f64;
/// In sizes of the scene: where the spheres around the bodies are further apart their gap stands for the distance, unless that matters.
const FAR: f64 = 0.25;
/// Of the scene's size: what the judge's own rounding explains.
const ROUNDING: f64 = 1e-12;
/// R of the clearances.
const ACCURACY: f64 = 1e-6;
/// Of the speeds that are seen at the samples, what none between them exceeds.
const FASTER: f64 = 1.5;

/// A motion, as the engine knows it and as the judge places it.
enum Motion {
    Twist(Movement, ConstantTwist),
    Spline(Spline),
    Chain(Vec<Turn>, Chain),
}

/// A joint of a chain: a shift by a fixed vector, then a turn about an axis by a polynomial of time.
#[derive(Clone)]
struct Turn {
    shift: DVec3,
    axis: DVec3,
    angle: Vec<f64>,
}

impl Motion {
    fn rigid(&self) -> &dyn RigidMotion {
        match self {
            Self::Twist(_, motion) => motion,
            Self::Spline(motion) => motion,
            Self::Chain(_, motion) => motion,
        }
    }

    fn place(&self, time: f64) -> Placement {
        match self {
            Self::Twist(movement, _) => place(movement, time),
            Self::Spline(motion) => {
                let (pose, _) = motion.pose_and_twist(time);
                Placement::new(pose.rotation, pose.transform_point(DVec3::ZERO))
            }
            Self::Chain(turns, _) => {
                let (mut rotation, mut position) = (DQuat::IDENTITY, DVec3::ZERO);
                for Turn { shift, axis, angle } in turns {
                    position += rotation * *shift;
                    let angle = angle.iter().rev().fold(0.0, |sum, c| sum * time + c);
                    rotation = (rotation * DQuat::from_axis_angle(*axis, angle)).normalize();
                }
                Placement::new(rotation, position)
            }
        }
    }

    /// How fast points within a radius of the body's origin move at a time.
    fn speed(&self, time: f64, radius: f64) -> f64 {
        let (pose, twist) = self.rigid().pose_and_twist(time);
        let arm = pose.transform_point(DVec3::ZERO) - pose.translation;
        twist.velocity_of(arm).length() + twist.angular.length() * radius
    }
}

struct Case {
    name: &'static str,
    surfaces: [Surface; 2],
    motions: [Motion; 2],
    solid: Solid,
}

fn cuboid(random: &mut Random) -> Surface {
    let half = DVec3::new(random.range(0.2, 1.0), random.range(0.2, 1.0), random.range(0.2, 1.0));
    Surface::cuboid(-half, half)
}

/// A tube around a knot of 16 to 32 rings of three to five corners: closed, not convex.
fn knot(random: &mut Random) -> Surface {
    let (rings, corners) = (16 + random.bits() % 17, 3 + random.bits() % 3);
    let (p, tube) = (1.0 + (random.bits() % 3) as f64, random.range(0.05, 0.15));
    let mut vertices = Vec::new();
    for ring in 0..rings {
        let at = |part: f64| {
            let turn = std::f64::consts::TAU * part;
            let out = 0.7 + 0.25 * (p * turn).cos();
            DVec3::new(out * turn.cos(), out * turn.sin(), 0.25 * (p * turn).sin())
        };
        let part = ring as f64 / rings as f64;
        let along = (at(part + 1e-3) - at(part - 1e-3)).normalize();
        let outwards = (at(part) - along * along.dot(at(part))).normalize();
        for corner in 0..corners {
            let turn = DQuat::from_axis_angle(along, std::f64::consts::TAU * corner as f64 / corners as f64);
            vertices.push(at(part) + turn * outwards * tube);
        }
    }
    let index = |ring: u64, corner: u64| (ring % rings * corners + corner % corners) as u32;
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for corner in 0..corners {
            let (a, b) = (index(ring, corner), index(ring, corner + 1));
            let (c, d) = (index(ring + 1, corner), index(ring + 1, corner + 1));
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    Surface { name: "knot", vertices, triangles }
}

fn twist(random: &mut Random, toward: DVec3, fastest: f64) -> Motion {
    let speed = toward.length() * random.range(0.5, 1.5) * 10f64.powf(random.range(0.0, fastest));
    let velocity = (toward.normalize() + random.direction() * random.range(0.0, 0.5)) * speed;
    let movement = Movement {
        rotation: random.rotation(),
        // About every other pair passes.
        position: toward * -0.5 - velocity * 0.3 + random.direction() * random.range(0.0, 2.5),
        velocity,
        angular_velocity: random.direction() * random.range(0.0, 4.0),
    };
    let motion = ConstantTwist::try_new(
        movement.position,
        movement.rotation,
        movement.velocity,
        movement.angular_velocity,
    );
    Motion::Twist(movement, motion.expect("finite"))
}

fn spline(random: &mut Random, away: DVec3) -> Motion {
    let count = 3 + random.bits() % 2;
    let mut turn = random.rotation();
    let poses: Vec<(f64, Pose)> = (0..count)
        .map(|k| {
            turn *= DQuat::from_axis_angle(random.direction(), random.range(0.0, 1.0));
            let translation = away + random.direction() * random.range(0.0, 1.5);
            (k as f64 / (count - 1) as f64, Pose { translation, rotation: turn, at: DVec3::ZERO })
        })
        .collect();
    let degree = if random.unit() < 0.5 { SplineDegree::Cubic } else { SplineDegree::Quintic };
    Motion::Spline(Spline::try_through(&poses, degree).expect("poses less than half a turn apart"))
}

fn chain(random: &mut Random, base: DVec3) -> Motion {
    let count = 1 + random.bits() % 3;
    let turns: Vec<Turn> = (0..count)
        .map(|k| {
            let shift = if k == 0 { base } else { random.direction() * random.range(0.3, 1.0) };
            let angle = (0..4).map(|power| random.range(-2.0, 2.0) / (1.0 + f64::from(power))).collect();
            Turn { shift, axis: random.direction(), angle }
        })
        .collect();
    let joint = |turn: &Turn| {
        let value = JointValue::try_polynomial(turn.angle.clone()).expect("finite");
        Joint::try_new(turn.shift, DQuat::IDENTITY, JointKind::Revolute { axis: turn.axis, value })
    };
    let joints = turns.iter().map(joint).collect::<Result<_, _>>().expect("axes are not zero");
    Motion::Chain(turns, Chain::try_new(joints).expect("one joint at least"))
}

fn draw(random: &mut Random, index: usize) -> Case {
    let apart = random.direction() * random.range(0.5, 3.5);
    let (name, surfaces, motions) = match index % 4 {
        0 => {
            let motions = [twist(random, apart, 2.0), twist(random, -apart, 1.0)];
            ("boxes", [cuboid(random), cuboid(random)], motions)
        }
        1 => {
            let motions = [twist(random, apart, 2.0), twist(random, -apart, 1.0)];
            ("knots", [knot(random), knot(random)], motions)
        }
        2 => {
            let motions = [spline(random, apart * 0.5), spline(random, apart * -0.5)];
            ("splines", [cuboid(random), cuboid(random)], motions)
        }
        _ => {
            let motions = [chain(random, apart), chain(random, DVec3::ZERO)];
            ("chains", [cuboid(random), cuboid(random)], motions)
        }
    };
    let solid = if random.unit() < 0.25 { Solid::Filled } else { Solid::Surface };
    Case { name, surfaces, motions, solid }
}

/// The judge's view of a case.
struct Sampled<'c> {
    case: &'c Case,
    boxes: [BoxTree; 2],
    /// Of the scene.
    size: f64,
}

impl Sampled<'_> {
    /// The distance at a time, or less where that is [`FAR`] at least.
    fn at_least(&self, time: f64, hint: &mut Hint) -> f64 {
        let [a, b] = [0, 1].map(|k| self.case.motions[k].place(time).position);
        let gap = (a - b).length() - self.size;
        if gap >= FAR * self.size { gap } else { self.distance(time, hint) }
    }

    /// The distance at a time; zero where a solid holds the other one.
    fn distance(&self, time: f64, hint: &mut Hint) -> f64 {
        let [a, b] = [0, 1].map(|k| self.case.motions[k].place(time));
        let least = separation(&self.boxes[0], &self.boxes[1], &a, &b, hint);
        let holds = |k: usize, at: &Placement, other: &Placement| {
            let seen = at.relative(other).apply(self.case.surfaces[1 - k].vertices[0]);
            winding(&self.case.surfaces[k], seen).abs() > 0.5
        };
        let is_held = self.case.solid == Solid::Filled && (holds(0, &a, &b) || holds(1, &b, &a));
        if is_held { 0.0 } else { least }
    }
}

/// How often a closed surface goes around a point: the sum of solid angles (Van Oosterom and Strackee 1983).
fn winding(surface: &Surface, point: DVec3) -> f64 {
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| surface.vertices[i as usize] - point);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    surface.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// What became of one case.
struct Judged {
    name: &'static str,
    /// Below a true distance, or no contact where there is one.
    negatives: Vec<String>,
    /// Above what is attained, or wider than promised, or contact where there is none.
    alarms: Vec<String>,
    is_contact: bool,
    is_undecided: bool,
    spans: [usize; 3],
}

fn judge(task: &Task, index: usize) -> Judged {
    let mut random = Random::new(task.seed.wrapping_mul(0x2545_f491).wrapping_add(index as u64));
    let case = draw(&mut random, index);
    let trees = case.surfaces.each_ref().map(|s| MeshTree::new(s.clone().into_mesh(TriMesh::try_new)));
    let boxes = case.surfaces.each_ref().map(|s| BoxTree::build(&s.vertices, &s.triangles));
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], case.motions[k].rigid()));
    let size = boxes[0].radius + boxes[1].radius;
    let sampled = Sampled { case: &case, boxes, size };
    let mut judged = Judged {
        name: case.name,
        negatives: Vec::new(),
        alarms: Vec::new(),
        is_contact: false,
        is_undecided: false,
        spans: [0; 3],
    };
    let mut hint = Hint::default();
    let times: Vec<f64> = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64).collect();
    let distances: Vec<f64> = times.iter().map(|&time| sampled.at_least(time, &mut hint)).collect();
    let line =
        |words: &str| format!("seed {} case {index} ({}, {:?}): {words}", task.seed, case.name, case.solid);

    let options = ClearanceOptions::default().with_accuracy(ACCURACY).with_solid(case.solid);
    let mut found = clearance(bodies[0], bodies[1], Window::UNIT, &options).expect("valid input");
    if task.sabotage.is_some() {
        found.lower += 1e-5 * sampled.size;
    }
    judged.is_contact = found.status == ClearanceStatus::Contact;
    judged.is_undecided = found.status == ClearanceStatus::Undecided;
    let around = (0..NEAR).flat_map(|k| [-1.0, 1.0].map(|side| found.time + side * 0.5_f64.powi(k + 8)));
    let around: Vec<f64> = around.filter(|time| (0.0..=1.0).contains(time)).collect();
    let near: Vec<f64> = around.iter().map(|&time| sampled.at_least(time, &mut hint)).collect();
    let all = times.iter().chain(&around).zip(distances.iter().chain(&near));
    // Only where spheres stand for bodies that may come nearest the distance itself has to be known.
    let is_open = |bound: f64| bound >= FAR * size && bound < found.upper;
    let exact =
        all.map(|(&time, &bound)| if is_open(bound) { sampled.distance(time, &mut hint) } else { bound });
    let least = exact.fold(f64::INFINITY, f64::min);
    judge_clearance(&sampled, &found, least, &mut hint, &mut judged, &line);

    let options = QueryOptions::default().with_solid(case.solid);
    let spans = contact_spans(bodies[0], bodies[1], Window::UNIT, &options, Some(RESOLUTION));
    let spans = spans.expect("valid input");
    judge_spans(&sampled, &spans, &distances, &mut judged, &line);
    judged
}

fn judge_clearance(
    sampled: &Sampled<'_>,
    found: &Clearance,
    least: f64,
    hint: &mut Hint,
    judged: &mut Judged,
    line: &impl Fn(&str) -> String,
) {
    let rounding = ROUNDING * sampled.size;
    if found.lower > least + rounding {
        judged.negatives.push(line(&format!("{least:e} at a sampled time: {found:?}")));
    }
    let attained = sampled.distance(found.time, hint);
    // Of bodies that meet the time is that of the contact: within L, and they share a point in the window.
    let met = if found.upper == 0.0 { 2.0 * found.tolerance } else { 0.0 };
    if attained > found.upper + met + rounding {
        judged.alarms.push(line(&format!("{attained:e} at that time: {found:?}")));
    }
    let between = (found.point_a - found.point_b).length();
    if between > found.upper + met + rounding && attained > 0.0 {
        judged.alarms.push(line(&format!("the points are {between:e} apart: {found:?}")));
    }
    let wide = (ACCURACY * found.upper).max(4.0 * found.tolerance) + rounding;
    if found.status != ClearanceStatus::Undecided && found.upper - found.lower > wide {
        judged.alarms.push(line(&format!("wider than promised: {found:?}")));
    }
}

fn judge_spans(
    sampled: &Sampled<'_>,
    spans: &[ContactSpan],
    distances: &[f64],
    judged: &mut Judged,
    line: &impl Fn(&str) -> String,
) {
    let joined = spans.windows(2).all(|pair| pair[0].to == pair[1].from && pair[0].from < pair[0].to);
    let ends = (spans.first().map(|span| span.from), spans.last().map(|span| span.to));
    if !joined || ends != (Some(0.0), Some(1.0)) {
        judged.negatives.push(line(&format!("the spans do not cover the window: {spans:?}")));
    }
    let motions = &sampled.case.motions;
    let speed =
        |time: f64| (0..2).map(|k| motions[k].speed(time, sampled.boxes[k].radius)).sum::<f64>() * FASTER;
    let step = 1.0 / SAMPLES as f64;
    for span in spans {
        judged.spans[span.status as usize] += 1;
        let mut clear_since = None;
        for (k, &distance) in distances.iter().enumerate() {
            let time = k as f64 * step;
            if !(span.from..=span.to).contains(&time) {
                continue;
            }
            if span.status == SpanStatus::Clear && distance == 0.0 {
                judged.negatives.push(line(&format!("they share a point at {time}: {span:?}")));
                break;
            }
            // Further apart than L until the next sample, whatever they do between.
            let is_clear = distance > 0.5 * step * speed(time) + 1e-8 * sampled.size;
            let since = *clear_since.get_or_insert(time);
            if !is_clear {
                clear_since = None;
            } else if span.status == SpanStatus::Contact && time - since > RESOLUTION {
                judged.alarms.push(line(&format!("they are apart from {since} to {time}: {span:?}")));
                break;
            }
        }
    }
}

/// The family.
pub(super) fn run(task: &Task) -> Outcome {
    let all: Vec<Judged> = (0..task.count).into_par_iter().map(|index| judge(task, index)).collect();
    let mut outcome = Outcome { cases: all.len(), ..Outcome::default() };
    for name in ["boxes", "knots", "splines", "chains"] {
        let of = || all.iter().filter(|judged| judged.name == name);
        let count = |is: fn(&Judged) -> bool| of().filter(|judged| is(judged)).count();
        let spans = of().fold([0; 3], |sum, judged| [0, 1, 2].map(|k: usize| sum[k] + judged.spans[k]));
        println!(
            "  {name}: {} pairs, {} meet, {} undecided; spans: {} clear, {} in contact, {} undecided",
            of().count(),
            count(|judged| judged.is_contact),
            count(|judged| judged.is_undecided),
            spans[SpanStatus::Clear as usize],
            spans[SpanStatus::Contact as usize],
            spans[SpanStatus::Undecided as usize],
        );
    }
    for judged in all {
        outcome.contacts += usize::from(judged.is_contact);
        outcome.undecided += usize::from(judged.is_undecided);
        outcome.false_negatives.extend(judged.negatives);
        outcome.false_alarms.extend(judged.alarms);
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Sabotage;

    #[test]
    fn right_answers_pass_and_raised_bounds_are_noticed() {
        let task = |sabotage| Task { count: 24, seed: 5, lies: 0, sabotage };
        let right = run(&task(None));
        assert_eq!((right.cases, right.undecided), (24, 0));
        assert!(right.false_negatives.is_empty(), "{:?}", right.false_negatives);
        assert!(right.false_alarms.is_empty(), "{:?}", right.false_alarms);
        let raised = run(&task(Some(Sabotage::Miss)));
        assert_eq!(raised.false_negatives.len(), 24, "{:?}", raised.false_negatives);
    }

    /// Two cubes, one of which flies through the other one between 0.25 and 0.75.
    #[test]
    fn false_spans_are_noticed() {
        let at = |x: f64, speed: f64| {
            let movement = Movement {
                rotation: DQuat::IDENTITY,
                position: DVec3::X * x,
                velocity: DVec3::X * speed,
                angular_velocity: DVec3::ZERO,
            };
            let motion = ConstantTwist::REST.with_position(movement.position);
            Motion::Twist(movement, motion.with_linear_velocity(movement.velocity))
        };
        let case = Case {
            name: "cubes",
            surfaces: [Surface::cube(0.5), Surface::cube(0.5)],
            motions: [at(0.0, 0.0), at(-2.0, 4.0)],
            solid: Solid::Filled,
        };
        let boxes = case.surfaces.each_ref().map(|s| BoxTree::build(&s.vertices, &s.triangles));
        let size = boxes[0].radius + boxes[1].radius;
        let sampled = Sampled { case: &case, boxes, size };
        let mut hint = Hint::default();
        let distances: Vec<f64> =
            (0..=SAMPLES).map(|k| sampled.distance(k as f64 / SAMPLES as f64, &mut hint)).collect();
        let judged = |spans: &[(f64, f64, SpanStatus)]| {
            let spans: Vec<_> = spans.iter().map(|&(from, to, is)| ContactSpan::new(from, to, is)).collect();
            let mut judged = Judged {
                name: case.name,
                negatives: Vec::new(),
                alarms: Vec::new(),
                is_contact: false,
                is_undecided: false,
                spans: [0; 3],
            };
            judge_spans(&sampled, &spans, &distances, &mut judged, &str::to_owned);
            (judged.negatives.len(), judged.alarms.len())
        };
        use SpanStatus::{Clear, Contact};
        let right = [(0.0, 0.249, Clear), (0.249, 0.751, Contact), (0.751, 1.0, Clear)];
        assert_eq!(judged(&right), (0, 0));
        assert_eq!(judged(&[(0.0, 0.3, Clear), (0.3, 0.751, Contact), (0.751, 1.0, Clear)]), (1, 0));
        assert_eq!(judged(&[(0.0, 0.15, Clear), (0.15, 0.751, Contact), (0.751, 1.0, Clear)]), (0, 1));
        // A hole in what is covered.
        assert_eq!(judged(&[(0.0, 0.249, Clear), (0.25, 1.0, Contact)]), (1, 1));
        // Inside of each other the surfaces are apart, and the solids are not.
        assert_eq!(sampled.distance(0.5, &mut hint), 0.0);
    }
}
