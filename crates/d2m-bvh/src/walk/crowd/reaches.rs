//! How far what is below boxes reaches along a direction.

use super::places::Places;
use crate::pair::scene::SceneBody;
use d2m_mesh::Meter;
use d2m_mesh::node::{Below, WIDTH};

/// How far boxes of a body reach along a direction at both ends of a span.
pub(super) struct Reaches<'a> {
    body: &'a SceneBody<'a>,
    /// Which of the points each vertex of the mesh is, and how far they reach.
    places: &'a Places,
    of_points: Vec<[f64; 2]>,
    /// Of the boxes that were measured.
    known: Places,
    of_boxes: Vec<[f64; 2]>,
}

impl<'a> Reaches<'a> {
    pub(super) fn new(body: &'a SceneBody<'a>, places: &'a Places, of_points: Vec<[f64; 2]>) -> Self {
        Self { body, places, of_points, known: Places::none(), of_boxes: Vec::new() }
    }

    /// What [`Self::measure`] found.
    pub(super) fn of(&self, index: u32) -> Option<[f64; 2]> {
        Some(self.of_boxes[self.known.get(index)?])
    }

    /// Measures what is below a box, and below all of its boxes; none: the time is over, or of a vertex nothing is known.
    pub(super) fn measure(&mut self, index: u32, clock: &mut Meter) -> Option<[f64; 2]> {
        if let known @ Some(_) = self.of(index) {
            return known;
        }
        clock.step().ok()?;
        let most = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [larger(a, c), larger(b, d)];
        let reach = match self.body.tree.nodes()[index as usize / WIDTH].below(index as usize % WIDTH) {
            Below::Triangle(triangle) => {
                let corners = self.body.tree.mesh().triangles()[triangle as usize];
                corners.into_iter().try_fold([f64::NEG_INFINITY; 2], |so_far, vertex| {
                    Some(most(so_far, self.of_points[self.places.get(vertex)?]))
                })?
            }
            Below::Node(node) => {
                let used = self.body.tree.nodes()[node as usize].used.min(WIDTH as u32);
                (0..used).try_fold([f64::NEG_INFINITY; 2], |so_far, lane| {
                    Some(most(so_far, self.measure(node * WIDTH as u32 + lane, clock)?))
                })?
            }
        };
        self.of_boxes.push(reach);
        self.known.insert_last(index, self.of_boxes.len());
        Some(reach)
    }
}

/// The larger one; what is not a number wins.
fn larger(x: f64, y: f64) -> f64 {
    if y > x || y.is_nan() { y } else { x }
}
