//! Sweeps of blocks side by side against those of one block after the other.

use super::super::block::Block;
use super::super::law::Law;
use super::super::solver_body::SolverBody;
use super::super::system::System;
use super::{Descent, Ends, Round, Wide};
use crate::point::{JointPart, JointRow, Material, upright};
use crate::velocity::Velocity;
use crate::{ContactPoint, tangents};
use d2m_lanes::{InstructionSet, run_on};
use d2m_testing::{Draw, KnuthRandom};
use glam::DMat3;

/// Some bodies and a ground, with up to five contacts or rows between two of them.
fn drawn(state: &mut KnuthRandom, count: usize) -> (System, Vec<f64>) {
    let mut bodies = Vec::new();
    for _ in 0..count {
        let [x, y, z] = [state.vector(), state.vector(), state.vector()];
        let root = DMat3::from_cols(x, y, z);
        bodies.push(SolverBody {
            inverse_mass: 0.5 + state.signed().abs(),
            inverse_inertia: root * root.transpose() + DMat3::IDENTITY,
            velocity: Velocity { linear: state.vector(), angular: state.vector() },
        });
    }
    let none = SolverBody { inverse_mass: 0.0, inverse_inertia: DMat3::ZERO, velocity: Velocity::default() };
    bodies.push(none);
    let mut contacts = Vec::new();
    for a in 0..count {
        for b in a + 1..=count {
            if state.signed().abs() > 0.4 {
                continue;
            }
            for _ in 0..=(state.signed().abs() * 5.0) as usize {
                let normal = state.vector().normalize();
                let law = Law::Range { lo: -0.5, hi: 0.5, softness: 0.1 };
                let row = JointRow {
                    is_angular: state.signed() > 0.0,
                    law,
                    pushing: 0.0,
                    target: 0.0,
                    part: JointPart::Rate,
                    is_motor: false,
                };
                contacts.push(ContactPoint {
                    normal,
                    tangents: tangents(normal),
                    arm_a: state.vector(),
                    arm_b: state.vector(),
                    running: [state.signed(), 0.0],
                    row: (state.signed() > 0.8).then_some(row),
                    material: Material { friction: (2.0 * state.signed()).max(0.0), restitution: 0.0 },
                    ..upright([a, b])
                });
            }
        }
    }
    let targets = contacts.iter().map(|_| 0.1 * state.signed()).collect();
    (System::new(bodies, &contacts, |body| body), targets)
}

/// One block after the other: its own law with the velocities that there are.
fn relax(block: &Block, bodies: &mut [SolverBody], own: &mut [f64; 3], target: f64) {
    let rates = block.rates(|i| bodies[i].velocity);
    let wanted = match block.law {
        Law::Cone { friction } => {
            let along = (own[0] - (rates[0] - target) * block.mass).max(0.0);
            let [t, u] = [0, 1].map(|k| rates[k + 1] + block.coupling[k] * (along - own[0]));
            let limit = friction * along;
            let square = |x: [f64; 2]| x[0] * x[0] + x[1] * x[1];
            let stopped = block
                .stopping
                .map(|[tt, tu, uu]| [own[1] - (tt * t + tu * u), own[2] - (tu * t + uu * u)])
                .filter(|stopped| square(*stopped) <= limit * limit);
            let braked = stopped.unwrap_or_else(|| {
                let wanted = [own[1] - t * block.step, own[2] - u * block.step];
                wanted.map(|x| x * (limit / square(wanted).sqrt()).min(1.0))
            });
            [along, braked[0], braked[1]]
        }
        Law::Range { lo, hi, softness } => {
            let above = rates[0] - target + softness * own[0];
            let mass = 1.0 / (1.0 / block.mass + softness);
            [(own[0] - above * mass).max(lo).min(hi), 0.0, 0.0]
        }
    };
    block.push(bodies, [0, 1, 2].map(|k| wanted[k] - own[k]));
    *own = wanted;
}

/// Sweeps are those of one block after the other in their order, those with friction first, with each set of instructions, to the last bit.
#[test]
fn sweeps_are_those_of_one_block_after_the_other() {
    let state = &mut KnuthRandom(7);
    let mut kinds = [0; 2];
    for count in [1, 2, 3, 5, 12, 12, 40] {
        let (mut system, targets) = drawn(state, count);
        let mut begun = Wide::new(&system.bodies, &system.blocks);
        begun.fill(system.numbers(&targets));
        let is_line = |&k: &usize| matches!(system.blocks[k].law, Law::Range { .. });
        let mut order: Vec<usize> = (0..system.blocks.len()).collect();
        order.sort_by_key(is_line);
        let mut wide = begun.clone();
        wide.sweep(2, None);
        for set in [InstructionSet::Portable, InstructionSet::Avx2, InstructionSet::Avx512] {
            let mut other = begun.clone();
            let off = run_on(set, Round { wide: &mut other, descent: None, twice: 2 });
            assert_eq!(format!("{other:?}"), format!("{wide:?}"));
            let mut at = System { bodies: system.bodies.clone(), ..drawn(&mut KnuthRandom(0), 0).0 };
            (at.blocks, at.impulses) = (system.blocks.clone(), system.impulses.clone());
            other.move_bodies(&mut at.bodies);
            other.write(&mut at.impulses);
            let residual = at.residual(&targets);
            assert!((off.most - residual).abs() <= 1e-14 * residual.max(1.0), "{} {residual}", off.most);
        }
        for _ in 0..2 {
            for &k in order.iter().chain(order.iter().rev()) {
                relax(&system.blocks[k], &mut system.bodies, &mut system.impulses[k], targets[k]);
                kinds[system.blocks[k].law.rows() / 2] += 1;
            }
        }
        let (bodies, impulses) = (system.velocities(), system.impulses.clone());
        wide.move_bodies(&mut system.bodies);
        wide.write(&mut system.impulses);
        assert_eq!((system.velocities(), system.impulses), (bodies, impulses));
    }
    assert!(kinds.iter().all(|&count| count > 100), "{kinds:?}");
}

/// What sweeps go on along changes the velocities by what it changes the impulses, and keeps these within their laws.
#[test]
fn velocities_follow_from_impulses() {
    let state = &mut KnuthRandom(11);
    let (mut system, targets) = drawn(state, 30);
    let free = system.velocities();
    let mut wide = Wide::new(&system.bodies, &system.blocks);
    wide.fill(system.numbers(&targets));
    let mut descent = Descent::new(Ends::Back);
    let mut ways = 0;
    for _ in 0..8 {
        wide.sweep(1, Some(&mut descent));
        ways += u32::from(descent.has_way);
        wide.move_bodies(&mut system.bodies);
        wide.write(&mut system.impulses);
        for (block, own) in system.blocks.iter().zip(&system.impulses) {
            let nearest = block.law.project(*own);
            assert!((0..3).all(|i| (own[i] - nearest[i]).abs() <= 1e-12), "{own:?} {nearest:?}");
        }
    }
    assert!(ways > 3, "{ways}");
    let (velocities, impulses) = (system.velocities(), system.impulses.clone());
    system.set(&free, &impulses);
    for (one, other) in velocities.iter().zip(system.velocities()) {
        assert!((*one - other).surface_speed(1.0) < 1e-10, "{one:?} {other:?}");
    }
}
