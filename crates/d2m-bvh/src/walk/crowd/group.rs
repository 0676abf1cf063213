//! The vertices below some boxes of a body.

use super::places::Places;
use crate::pair::scene::SceneBody;
use d2m_mesh::Meter;
use d2m_mesh::node::{Below, WIDTH};
use glam::DVec3;

/// The vertices below some boxes of a body.
pub(super) struct Group<'a> {
    body: &'a SceneBody<'a>,
    /// The boxes that were added, and how many.
    seen: Places,
    count: usize,
    pub(super) vertices: Vertices,
}

/// Vertices of a body.
pub(super) struct Vertices {
    /// Relative to the tree's center.
    pub(super) points: Vec<DVec3>,
    /// Which of the points each vertex of the mesh is; none that was not added.
    pub(super) places: Places,
}

impl<'a> Group<'a> {
    pub(super) fn new(body: &'a SceneBody<'a>) -> Self {
        let vertices = Vertices { points: Vec::new(), places: Places::none() };
        Self { body, seen: Places::none(), count: 0, vertices }
    }

    /// `None`: too many, or the time is over.
    pub(super) fn add(&mut self, index: u32, most: usize, clock: &mut Meter) -> Option<()> {
        let Vertices { points, places } = &mut self.vertices;
        let mut stack = vec![index];
        while let Some(index) = stack.pop() {
            if !self.seen.insert_last(index, self.count + 1) {
                continue;
            }
            self.count += 1;
            clock.step().ok()?;
            match self.body.tree.nodes()[index as usize / WIDTH].below(index as usize % WIDTH) {
                Below::Triangle(triangle) => {
                    for vertex in self.body.tree.mesh().triangles()[triangle as usize] {
                        if places.insert_last(vertex, points.len() + 1) {
                            points.push(self.body.place(self.body.tree.mesh().vertices()[vertex as usize]));
                        }
                    }
                }
                Below::Node(node) => {
                    let used = self.body.tree.nodes()[node as usize].used.min(WIDTH as u32);
                    stack.extend((0..used).map(|lane| node * WIDTH as u32 + lane));
                }
            }
            if points.len() > most {
                return None;
            }
        }
        Some(())
    }
}
