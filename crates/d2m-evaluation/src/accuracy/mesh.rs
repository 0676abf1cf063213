//! The engine on random scenes of a few triangles, against the judge's brute force.
//!
//! The law of the scenes: half of them are two closed solids, half triangle soups; sizes over three decades, aspect
//! ratios up to 1e4 (needles, plates); the bodies are aimed at each other; speeds over ten decades, spins up to 300;
//! one in eight stands still relative to the other, one in eight begins in overlap or inside.
use super::{Outcome, Task};
use crate::judge::{BoxTree, Claim, Fault, Judge, cross, place};
use crate::trials::{Movement, Trial};
use d2m::bvh::{MeshTree, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact};
use d2m::motion::ConstantTwist;
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::DVec3;
use rayon::prelude::*;

/// A surface, and whether it is closed.
pub(super) struct Shape {
    pub(super) surface: Surface,
    pub(super) is_closed: bool,
}

pub(super) fn shape(random: &mut Random) -> Shape {
    // Stretched along each axis by up to 100 either way, one time in four.
    let thin = random.unit() < 0.25;
    let stretch =
        DVec3::from_array([(); 3].map(|()| if thin { 10f64.powf(random.range(-2.0, 2.0)) } else { 1.0 }));
    let size = 10f64.powf(random.range(-1.0, 1.0)) / stretch.max_element();
    let (surface, is_closed) = match random.bits() % 4 {
        0 => {
            let corners = [(); 4].map(|()| random.direction() * random.range(0.3, 1.0));
            (Surface::tetrahedron(corners), true)
        }
        1 => (Surface::cube(0.5), true),
        _ => {
            let count = 1 + random.bits() as u32 % 6;
            (Surface::soup((0..3 * count).map(|_| random.direction() * random.range(0.1, 1.0))), false)
        }
    };
    Shape { surface: surface.map(|p| p * stretch * size), is_closed }
}

/// Two shapes and how they move.
struct Scene {
    shapes: [Shape; 2],
    trial: Trial,
    solid: Solid,
}

fn scene(random: &mut Random) -> Scene {
    let shapes = [shape(random), shape(random)];
    let radius = |s: &Shape| s.surface.vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
    let reach = radius(&shapes[0]) + radius(&shapes[1]);
    let along = random.direction();
    let aside = random.direction() * reach * random.unit();
    // Contact, if any, is likely near the middle of the window.
    let speed = if random.unit() < 0.125 { 0.0 } else { reach * 10f64.powf(random.range(-3.0, 4.0)) };
    let lead = if random.unit() < 0.125 { 0.0 } else { reach * random.range(0.3, 1.0) + 0.5 * speed };
    let spins = [(); 2].map(|()| if random.unit() < 0.3 { 0.0 } else { 10f64.powf(random.range(-2.0, 2.5)) });
    let mut movement = |sign: f64, spin: f64| Movement {
        rotation: random.rotation(),
        position: (along * lead + aside) * (-0.5 * sign),
        velocity: along * (0.5 * sign * speed),
        angular_velocity: random.direction() * spin,
    };
    let trial = Trial { a: movement(1.0, spins[0]), b: movement(-1.0, spins[1]) };
    let solid = if shapes.iter().all(|s| s.is_closed) && random.unit() < 0.8 {
        Solid::Filled
    } else {
        Solid::Surface
    };
    Scene { shapes, trial, solid }
}

impl Scene {
    fn ask(&self) -> Claim {
        let tree = |s: &Shape| MeshTree::new(s.surface.clone().into_mesh(TriMesh::try_new));
        let motion = |m: &Movement| {
            ConstantTwist::try_new(m.position, m.rotation, m.velocity, m.angular_velocity).expect("finite")
        };
        let (trees, motions) =
            (self.shapes.each_ref().map(tree), [motion(&self.trial.a), motion(&self.trial.b)]);
        let options = QueryOptions::default().with_solid(self.solid);
        let (a, b) = (Moving::new(&trees[0], &motions[0]), Moving::new(&trees[1], &motions[1]));
        match time_of_contact(a, b, Window::UNIT, &options).expect("valid input") {
            TimeOfContact::Separated => Claim::Separated,
            TimeOfContact::Contact(c) => {
                Claim::Contact { lo: c.time_lo, hi: c.time_hi, tolerance: c.tolerance }
            }
            TimeOfContact::Undecided { clear_until } => Claim::Undecided { clear_until },
        }
    }
}

pub(super) fn run(task: &Task) -> Outcome {
    let judged: Vec<Judged> = (0..task.count).into_par_iter().map(|index| case(task, index)).collect();
    let mut outcome = Outcome { cases: judged.len(), ..Outcome::default() };
    for Judged { claim, complaint } in judged {
        outcome.contacts += usize::from(matches!(claim, Claim::Contact { .. }));
        outcome.undecided += usize::from(matches!(claim, Claim::Undecided { .. }));
        match complaint {
            Some(Complaint::FalseNegative(line)) => outcome.false_negatives.push(line),
            Some(Complaint::FalseAlarm(line)) => outcome.false_alarms.push(line),
            None => {}
        }
    }
    outcome
}

/// A claim, and what is wrong with it.
struct Judged {
    claim: Claim,
    complaint: Option<Complaint>,
}

/// A line that names the case.
enum Complaint {
    FalseNegative(String),
    FalseAlarm(String),
}

fn case(task: &Task, index: usize) -> Judged {
    let mut random = Random::new(task.seed.wrapping_mul(0x9e37_79b9).wrapping_add(index as u64));
    let scene = scene(&mut random);
    let claim = scene.ask();
    let claim = task.sabotage.map_or(claim, |fault| fault.spoil(claim));
    let trees = scene.shapes.each_ref().map(|s| BoxTree::build(&s.surface.vertices, &s.surface.triangles));
    let judge = Judge { a: &trees[0], b: &trees[1], trial: &scene.trial };
    let line =
        |words: String| format!("seed {} case {index} ({:?}): {claim:?}: {words}", task.seed, scene.solid);
    if scene.solid == Solid::Filled && begins_inside(&scene, &trees) {
        let right = matches!(claim, Claim::Contact { lo: 0.0, .. } | Claim::Undecided { clear_until: 0.0 });
        let words = || line("one body is inside the other at the start".into());
        return Judged { claim, complaint: (!right).then(|| Complaint::FalseNegative(words())) };
    }
    let complaint = judge.check(&claim, true).err().map(|fault| match fault {
        Fault::Far { .. } => Complaint::FalseAlarm(line(fault.to_string())),
        _ => Complaint::FalseNegative(line(fault.to_string())),
    });
    Judged { claim, complaint }
}

/// Surfaces apart and a vertex of one inside the other, by the parity of a ray's crossings.
fn begins_inside(scene: &Scene, trees: &[BoxTree; 2]) -> bool {
    let at = [place(&scene.trial.a, 0.0), place(&scene.trial.b, 0.0)];
    if cross(&trees[0], &trees[1], &at[0], &at[1]) {
        return false;
    }
    let inside = |outer: usize, inner: usize| {
        let point = at[outer].relative(&at[inner]).apply(scene.shapes[inner].surface.vertices[0]);
        let far = DVec3::new(0.363_821, 0.581_297, 0.727_941) * 1e4;
        let shape = &scene.shapes[outer].surface;
        let hits = shape.triangles.iter().filter(|t| {
            let corners = t.map(|i| shape.vertices[i as usize]);
            crate::judge::pierces(point, point + far, &corners)
        });
        hits.count() % 2 == 1
    };
    inside(0, 1) || inside(1, 0)
}
