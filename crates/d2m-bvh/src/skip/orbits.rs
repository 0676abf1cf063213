//! The triangles of a body, one of each orbit class: those that the screw carries into each other have one projection.

use super::projection::{Piece, ProjectedVertex, Range};
use super::projection_tree::ProjectionTree;
use super::screw::Screw;
use d2m_mesh::margin::UP;
use d2m_mesh::{Exhausted, Meter};
use d2m_motion::angle;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::hash::{BuildHasherDefault, Hasher};

/// Part of the greatest distance from the axis by which triangles of one orbit class may differ.
const ORBIT_STEP: f64 = 1e-8;
/// Triangles that come nearer to the axis than this part of their greatest distance and |h| have no angles.
pub(super) const BESIDE: f64 = 0.01;
/// Triangles near the axis are cut so often, as the end of a shaft is, whose faces meet in the axis: the parts that are not near it have
/// angles. What is left is 256 times smaller.
const MOST_CUTS: usize = 8;
/// Pieces that this may give, besides two for each triangle.
const MORE_PIECES: usize = 1 << 12;
/// An odd number near 2⁶⁴ over the golden section: its products differ in their high bits where factors differ in low ones.
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;
/// Where the steps of φ and those of classes begin: not at zero or at whole leads, where a thread or a plane through the
/// origin would be divided. Any numbers do.
const FIRST_LEAD: f64 = 0.123_456;
const FIRST_STEP: f64 = 0.387_654;

/// The vertices of a body, seen from the axis.
pub(super) struct PlacedVertices {
    places: Vec<ProjectedVertex>,
    /// Their angles, where they were needed.
    angles: Vec<Option<f64>>,
}

impl PlacedVertices {
    pub(super) fn new(places: impl Iterator<Item = DVec3>) -> Self {
        let places: Vec<_> = places.map(ProjectedVertex::new).collect();
        Self { angles: vec![None; places.len()], places }
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.places[v as usize].at)
    }
}

/// A triangle of a body: the numbers of its vertices, and its least distance from the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenTriangle {
    pub(super) vertices: [u32; 3],
    pub(super) near: f64,
}

/// The projections of a body: of the triangles whose angles are known, and of the others.
pub(super) struct BodyProjections {
    pub(super) with_angles: ProjectionTree,
    pub(super) without_angles: ProjectionTree,
}

impl BodyProjections {
    /// Of some triangles.
    pub(super) fn try_new(
        screw: &Screw,
        vertices: &mut PlacedVertices,
        triangles: &[SeenTriangle],
        clock: &mut Meter,
    ) -> Result<Self, Exhausted> {
        let PlacedVertices { places, angles } = vertices;
        let farthest = places.iter().map(|vertex| vertex.rho).fold(0.0, f64::max);
        let mut angle_of = |v: u32| {
            let at = places[v as usize].at;
            *angles[v as usize].get_or_insert_with(|| angle(at.y, at.x))
        };
        let mut orbits = Orbits {
            screw,
            farthest,
            per_step: 1.0 / (ORBIT_STEP * (farthest + screw.lead)),
            classes: HashMap::default(),
            pieces: Vec::new(),
            turns: Vec::new(),
        };
        let mut near_axis = Vec::new();
        for &SeenTriangle { vertices, near } in triangles {
            clock.step()?;
            let piece = Piece::of(vertices.map(|v| places[v as usize]), near, screw.h);
            // Near the axis the angle means nothing.
            if is_beside(&piece, screw.h) {
                orbits.add(piece, vertices.map(&mut angle_of));
            } else if piece.wide {
                near_axis.push(piece);
            } else {
                orbits.push(piece, [0.0; 2]);
            }
        }
        let most = MORE_PIECES + 2 * triangles.len();
        for _ in 0..MOST_CUTS {
            if near_axis.is_empty() || orbits.pieces.len() + 4 * near_axis.len() > most {
                break;
            }
            let mut still_near = Vec::new();
            for part in near_axis.iter().flat_map(|piece| piece.divided(screw.h)) {
                clock.step()?;
                let part =
                    Piece::of(part.corners.map(|corner| ProjectedVertex::new(corner.at)), part.near, screw.h);
                if is_beside(&part, screw.h) {
                    orbits.add(part, part.corners.map(|corner| angle(corner.at.y, corner.at.x)));
                } else {
                    still_near.push(part);
                }
            }
            near_axis = still_near;
        }
        Ok(Self {
            with_angles: ProjectionTree::try_new(orbits.pieces, screw.h, clock)?,
            without_angles: ProjectionTree::try_new(near_axis, screw.h, clock)?,
        })
    }
}

/// Is a piece so far from the axis that it has angles?
fn is_beside(piece: &Piece, h: f64) -> bool {
    let far = piece.corners.iter().map(|vertex| vertex.rho).fold(0.0, f64::max);
    piece.near >= BESIDE * (far + h.abs())
}

/// One triangle of each orbit class.
struct Orbits<'s> {
    screw: &'s Screw,
    /// The greatest distance of a vertex from the axis.
    farthest: f64,
    /// One over the step in which the numbers of a class may differ.
    per_step: f64,
    classes: HashMap<u64, u32, BuildHasherDefault<Mixed>>,
    pieces: Vec<Piece>,
    /// By how much the second and the third vertex of each piece are turned from the first.
    turns: Vec<[f64; 2]>,
}

impl Orbits<'_> {
    fn push(&mut self, piece: Piece, turned: [f64; 2]) {
        self.pieces.push(piece.bent(self.screw.h));
        self.turns.push(turned);
    }

    /// Adds a triangle beside the axis whose vertices have these angles, or counts it to a class that is known.
    fn add(&mut self, mut piece: Piece, angles: [f64; 3]) {
        let screw = self.screw;
        piece.wide = false;
        let turned = [1, 2].map(|i| less_than_half_a_turn(angles[i] - angles[0]));
        let corners = &mut piece.corners;
        if screw.h != 0.0 {
            let first = corners[0].at.z - screw.h * angles[0];
            let first = first - ((first / screw.lead - FIRST_LEAD).floor() * screw.lead);
            corners[0].phi = first;
            for i in [1, 2] {
                corners[i].phi = first + (corners[i].at.z - corners[0].at.z) - screw.h * turned[i - 1];
            }
        }
        let next = self.pieces.len() as u32;
        let class = *self.classes.entry(key(corners, turned, self.farthest, self.per_step)).or_insert(next);
        if class == next {
            self.push(piece, turned);
        } else {
            self.share(class as usize, &piece, turned);
        }
    }

    /// Widens what stands for a class by another triangle of it.
    fn share(&mut self, class: usize, other: &Piece, turned: [f64; 2]) {
        let (one, by, h) = (&mut self.pieces[class], self.turns[class], self.screw.h);
        let far = other.corners.iter().map(|vertex| vertex.rho).fold(0.0, f64::max);
        // Moved along the screw until the first angles agree, where do the vertices end?
        let apart = [0.0, (turned[0] - by[0]).abs(), (turned[1] - by[1]).abs()];
        for (angle, (c, d)) in apart.iter().zip(other.corners.iter().zip(&one.corners)) {
            let beside = (c.rho - d.rho).abs() + (c.phi - d.phi).abs() + (far + h.abs()) * angle;
            one.slack = one.slack.max(beside * UP);
        }
        let heights = |piece: &Piece| Range::of(piece.corners.map(|vertex| vertex.at.z));
        one.shared = Some(one.shared.unwrap_or(heights(one)).union(heights(other)));
    }
}

/// What triangles of one class have in common, in whole steps, mixed to one number. Two classes with one number are one class: its slack
/// is as large as they differ.
fn key(corners: &[ProjectedVertex; 3], turned: [f64; 2], farthest: f64, per_step: f64) -> u64 {
    let [a, b, c] = corners;
    [a.rho, b.rho, c.rho, a.phi, b.phi, c.phi, turned[0] * farthest, turned[1] * farthest].iter().fold(
        0,
        |mixed: u64, x| {
            let mixed = (mixed ^ whole(x * per_step + FIRST_STEP) as u64).wrapping_mul(MIX);
            mixed ^ mixed >> 32
        },
    )
}

/// The hash of a number that is mixed already: itself.
#[derive(Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(MIX);
        }
    }

    fn write_u64(&mut self, mixed: u64) {
        self.0 = mixed;
    }
}

/// The largest whole number that is not above `x`; the nearest that there is for what is beyond all numbers. On every target without a
/// call.
fn whole(x: f64) -> i64 {
    let towards_zero = x as i64;
    towards_zero.wrapping_sub(i64::from(towards_zero as f64 > x))
}

/// An angle between two vertices of a triangle beside the axis, which turns by less than half a turn.
fn less_than_half_a_turn(by: f64) -> f64 {
    if by > PI {
        by - 2.0 * PI
    } else if by < -PI {
        by + 2.0 * PI
    } else {
        by
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::scene::MovingScene;
    use crate::skip::swept_body::AnnularBound;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_motion::ConstantTwist;
    use d2m_testing::{Draw, KnuthRandom};

    /// Whatever has one key is one class, whose slack is at least as large as its triangles differ when they are moved along the screw.
    #[test]
    fn unlike_triangles_of_one_class_are_as_slack_as_they_differ() {
        let tree = MeshTree::new(TriMesh::point(DVec3::X).unwrap());
        let climbing =
            ConstantTwist::REST.with_angular_velocity(DVec3::Z * 4.0).with_linear_velocity(DVec3::Z * 0.8);
        let bodies = [(&tree, climbing), (&tree, ConstantTwist::REST)];
        let scene = MovingScene::new(bodies[0], bodies[1], Window::UNIT, &QueryOptions::default());
        let screw = Screw::new(&scene, 0.0).unwrap();
        let mut random = KnuthRandom(61);
        for round in 0..400 {
            let mut orbits = Orbits {
                screw: &screw,
                farthest: 2.0,
                per_step: 0.0,
                classes: HashMap::default(),
                pieces: Vec::new(),
                turns: Vec::new(),
            };
            let size = [0.3, 1e-3][round % 2];
            let places = [(); 2].map(|()| {
                let around = random.signed() * PI;
                let middle = DVec3::new(around.cos(), around.sin(), 3.0 * random.signed());
                [(); 3].map(|()| middle + random.vector() * size)
            });
            for corners in &places {
                let corners = corners.map(ProjectedVertex::new);
                let near = AnnularBound::of(&corners.map(|p| p.at)).near;
                let piece = Piece::of(corners, near, screw.h);
                orbits.add(piece, corners.map(|p| angle(p.at.y, p.at.x)));
            }
            assert_eq!(orbits.pieces.len(), 1);
            let [one, other] = places;
            let turn = angle(one[0].y, one[0].x) - angle(other[0].y, other[0].x);
            let apart = (-40..=40).map(|leads| {
                let lift = screw.h * turn + f64::from(leads) * screw.lead;
                let moved = other.map(|p| glam::DQuat::from_rotation_z(turn) * p + DVec3::Z * lift);
                one.iter().zip(moved).map(|(p, q)| (*p - q).length()).fold(0.0, f64::max)
            });
            let least = apart.fold(f64::INFINITY, f64::min);
            assert!(
                orbits.pieces[0].slack >= least * (1.0 - 1e-12),
                "{round}: {} {least}",
                orbits.pieces[0].slack
            );
        }
    }
}
