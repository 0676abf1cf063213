//! The vertices below some boxes of a body.

use super::places::Places;
use crate::pair::scene::SceneBody;
use d2m_mesh::Meter;
use d2m_mesh::node::{Below, WIDTH};
use glam::DVec3;

/// The vertices below some boxes of a body.
pub(super) struct Group<'a> {
    body: &'a SceneBody<'a>,
    /// Which boxes were added.
    seen: Vec<bool>,
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
        let seen = vec![false; WIDTH * body.tree.nodes().len()];
        let places = Places::none_of(body.tree.mesh().vertices().len());
        Self { body, seen, vertices: Vertices { points: Vec::new(), places } }
    }

    /// `None`: too many, or the time is over.
    pub(super) fn add(&mut self, index: u32, most: usize, clock: &mut Meter) -> Option<()> {
        let Vertices { points, places } = &mut self.vertices;
        let mut stack = vec![index as usize];
        while let Some(index) = stack.pop() {
            if core::mem::replace(&mut self.seen[index], true) {
                continue;
            }
            clock.step().ok()?;
            match self.body.tree.nodes()[index / WIDTH].below(index % WIDTH) {
                Below::Triangle(triangle) => {
                    for vertex in self.body.tree.mesh().triangles()[triangle as usize] {
                        let vertex = vertex as usize;
                        if places.get(vertex).is_none() {
                            points.push(self.body.place(self.body.tree.mesh().vertices()[vertex]));
                            places.set_last(vertex, points.len());
                        }
                    }
                }
                Below::Node(node) => {
                    let used = self.body.tree.nodes()[node as usize].used as usize;
                    stack.extend((0..used.min(WIDTH)).map(|lane| node as usize * WIDTH + lane));
                }
            }
            if points.len() > most {
                return None;
            }
        }
        Some(())
    }
}
