//! The engine on random scenes of a few triangles; each answer is proven again by the verifier, which shares nothing with it.
//!
//! The law of the scenes: half of them are two closed solids, half triangle soups; sizes over three decades, aspect
//! ratios up to 1e4 (needles, plates); the bodies are aimed at each other; speeds over ten decades, spins up to 300;
//! one in eight stands still relative to the other, one in eight begins in overlap or inside.
use super::proofs::{Judgement, STEPS, judgement};
use super::{Outcome, Task};
use crate::trials::{Movement, Trial};
use d2m::bvh::{MeshTree, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact};
use d2m::motion::ConstantTwist;
use d2m::verify::Verifier;
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
struct RandomScene {
    shapes: [Shape; 2],
    trial: Trial,
    solid: Solid,
}

fn scene(random: &mut Random) -> RandomScene {
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
    RandomScene { shapes, trial, solid }
}

pub(super) fn run(task: &Task) -> Outcome {
    let judged: Vec<Judged> = (0..task.count).into_par_iter().map(|index| case(task, index)).collect();
    let mut outcome = Outcome { cases: judged.len(), ..Outcome::default() };
    for Judged { answer, line, judgement } in judged {
        outcome.contacts += usize::from(answer.contact().is_some());
        outcome.undecided += usize::from(matches!(answer, TimeOfContact::Undecided { .. }));
        match judgement {
            Judgement::Proven => {}
            Judgement::Refuted(why) => outcome.false_negatives.push(format!("{line}: {why}")),
            Judgement::Contradicts(why) => outcome.false_alarms.push(format!("{line}: {why}")),
            Judgement::Open(reason) => *outcome.unproven.entry(reason).or_default() += 1,
        }
    }
    outcome
}

/// An answer, and what became of its proof.
struct Judged {
    answer: TimeOfContact,
    /// A line that names the case.
    line: String,
    judgement: Judgement,
}

fn case(task: &Task, index: usize) -> Judged {
    let mut random = Random::new(task.seed.wrapping_mul(0x9e37_79b9).wrapping_add(index as u64));
    let scene = scene(&mut random);
    let tree = |s: &Shape| MeshTree::new(s.surface.clone().into_mesh(TriMesh::try_new));
    let motion = |m: &Movement| {
        ConstantTwist::try_new(m.position, m.rotation, m.velocity, m.angular_velocity).expect("finite")
    };
    let (trees, motions) =
        (scene.shapes.each_ref().map(tree), [motion(&scene.trial.a), motion(&scene.trial.b)]);
    let options = QueryOptions::default().with_solid(scene.solid);
    let bodies = [0, 1].map(|k| Moving::new(&trees[k], &motions[k]));
    let answer = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options).expect("valid input");
    let answer = task.sabotage.map_or(answer, |fault| fault.spoil_answer(answer, Window::UNIT));
    let verifier = Verifier::try_new(trees[0].mesh(), trees[1].mesh()).expect("triangles");
    let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &answer, STEPS);
    let line = format!("seed {} case {index} ({:?}): {answer:?}", task.seed, scene.solid);
    Judged { answer, line, judgement: judgement(verdict) }
}
