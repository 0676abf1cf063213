//! Projected Gauss–Seidel: block after block, each with the velocities that the ones before left.

use super::accuracy::Accuracy;
use super::law::Law;
use super::solver_body::SolverBody;
use super::system::{Block, System};

/// Sweeps go forth and back by turns: what one carries to the top of a pile the next one carries to its ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Forth,
    Back,
}

impl System {
    /// Sweeps over all blocks until the residual is no more than what may be left, so many at most; the residual.
    pub(super) fn sweep_until(&mut self, targets: &[f64], accuracy: Accuracy, most: u32) -> f64 {
        let mut residual = self.residual(targets);
        let mut done = 0;
        while residual > self.enough(accuracy) && done < most {
            for k in 0..BETWEEN {
                self.sweep(targets, if k % 2 == 0 { Order::Forth } else { Order::Back });
            }
            done += BETWEEN;
            residual = self.residual(targets);
        }
        residual
    }

    fn sweep(&mut self, targets: &[f64], order: Order) {
        let Self { bodies, blocks, impulses, .. } = self;
        for k in 0..blocks.len() {
            let k = if order == Order::Forth { k } else { blocks.len() - 1 - k };
            let (block, own, target) = (&blocks[k], &mut impulses[k], &targets[k]);
            if block.scale == 0.0 {
                continue;
            }
            let line = &block.lines[0];
            let rate = line.rate(&bodies[block.a].velocity, &bodies[block.b].velocity);
            let impulse = match block.law {
                Law::Cone { .. } => (own[0] - (rate - target) * line.mass).max(0.0),
                Law::Range { lo, hi, softness } => {
                    let yields = 1.0 / (1.0 / line.mass + softness);
                    (own[0] - (rate - target + softness * own[0]) * yields).max(lo).min(hi)
                }
            };
            let added = impulse - own[0];
            if added != 0.0 {
                own[0] = impulse;
                line.push(bodies, [block.a, block.b], added);
            }
            if let Law::Cone { friction } = block.law {
                slide(bodies, block, friction, own);
            }
        }
    }
}

/// Sweeps after which the residual is judged, which costs about as much as one.
const BETWEEN: u32 = 6;
/// Least part of the product of its diagonal that the determinant of the two tangents has: 2⁻²⁶. The difference of two products
/// as large as that is rounded by 2⁻⁵² of them, so half of its digits are left.
const LEAST_DETERMINANT: f64 = 1.0 / 67_108_864.0;

/// The impulse along the tangents that stops sliding, or the one of Coulomb's length nearest to it.
#[inline]
fn slide(bodies: &mut [SolverBody], block: &Block, friction: f64, own: &mut [f64; 3]) {
    let (a, b) = (&bodies[block.a].velocity, &bodies[block.b].velocity);
    let rates = [0, 1].map(|k| block.lines[k + 1].rate(a, b) + block.running[k]);
    let limit = friction * own[0];
    let length = |x: [f64; 2]| (x[0] * x[0] + x[1] * x[1]).sqrt();
    let stopped = stopping(block, rates).map(|less| [0, 1].map(|k| own[k + 1] - less[k]));
    let wanted = if let Some(stopped) = stopped.filter(|x| length(*x) <= limit) {
        stopped
    } else {
        let wanted = [0, 1].map(|k| own[k + 1] - rates[k] * block.step);
        let shorten = (limit / length(wanted)).min(1.0);
        if limit > 0.0 { wanted.map(|x| x * shorten) } else { [0.0; 2] }
    };
    for (k, wanted) in wanted.into_iter().enumerate() {
        let added = wanted - own[k + 1];
        if added != 0.0 {
            own[k + 1] = wanted;
            block.lines[k + 1].push(bodies, [block.a, block.b], added);
        }
    }
}

/// The impulses along the tangents that stop rates at once; none where a direction cannot be moved.
fn stopping(block: &Block, rates: [f64; 2]) -> Option<[f64; 2]> {
    let [tt, tu, uu] = block.sliding;
    let determinant = tt * uu - tu * tu;
    (determinant > LEAST_DETERMINANT * tt * uu).then(|| {
        [(uu * rates[0] - tu * rates[1]) / determinant, (tt * rates[1] - tu * rates[0]) / determinant]
    })
}
