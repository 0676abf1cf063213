//! How far what is below boxes reaches along a direction.

use super::paths::{BodyPaths, Side};
use crate::pair::motion::frame::Frame;
use crate::pair::scene::{MovingScene, SceneBody};
use d2m_mesh::Meter;
use d2m_mesh::node::{Below, WIDTH};
use glam::DVec3;

/// How far boxes reach along a direction at both ends of a span: A's along `n`, B's against it.
pub(super) struct Reaches<'a> {
    body: &'a SceneBody<'a>,
    paths: BodyPaths<'a>,
    along: DVec3,
    turn: f64,
    /// Of each box that was measured.
    known: Vec<Option<[f64; 2]>>,
}

impl<'a> Reaches<'a> {
    pub(super) fn new(scene: &'a MovingScene<'a>, side: Side, frame: &'a Frame, span: f64, n: DVec3) -> Self {
        let (body, along) = match side {
            Side::A => (&scene.a, n),
            Side::B => (&scene.b, -n),
        };
        let known = vec![None; WIDTH * body.tree.nodes().len()];
        let paths = BodyPaths::new(scene, frame, side, span);
        Self { body, paths, along, turn: paths.turn(n), known }
    }

    /// What [`Self::measure`] found.
    pub(super) fn of(&self, index: u32) -> Option<[f64; 2]> {
        self.known[index as usize]
    }

    /// Measures what is below a box, and below all of its boxes; none: the time is over.
    pub(super) fn measure(&mut self, index: u32, clock: &mut Meter) -> Option<[f64; 2]> {
        if let known @ Some(_) = self.known[index as usize] {
            return known;
        }
        clock.step().ok()?;
        let most = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [larger(a, c), larger(b, d)];
        let reach = match self.body.tree.nodes()[index as usize / WIDTH].below(index as usize % WIDTH) {
            Below::Triangle(triangle) => {
                let corners =
                    self.body.corners(triangle).map(|p| self.paths.of(p).along(self.along, self.turn));
                corners.into_iter().fold([f64::NEG_INFINITY; 2], most)
            }
            Below::Node(node) => {
                let used = self.body.tree.nodes()[node as usize].used.min(WIDTH as u32);
                (0..used).try_fold([f64::NEG_INFINITY; 2], |so_far, lane| {
                    Some(most(so_far, self.measure(node * WIDTH as u32 + lane, clock)?))
                })?
            }
        };
        self.known[index as usize] = Some(reach);
        Some(reach)
    }
}

/// The larger one; what is not a number wins.
fn larger(x: f64, y: f64) -> f64 {
    if y > x || y.is_nan() { y } else { x }
}
