//! What a body looks like in the plane of what a screw motion leaves alone: the distance ρ from the axis, and
//! φ = z − hθ, told up to multiples of the lead 2πh.
//!
//! Triangles that the screw carries into each other have one picture, so one of each class is kept: with the bound
//! `slack` on how far corners of the others end beside its own. Triangles are divided where they are looked at closely.
//!
//! See docs/theory/engine.md, "Screws".

use super::helix::Screw;
use super::swept::nearest;
use crate::tree::margin::UP;
use d2m_interval::Interval;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Directions (α, β) of F = αρ + βφ; any would do, in steps of about an eighth of half a turn.
pub(super) const DIRECTIONS: [(f64, f64); 8] = [
    (1.0, 0.0),
    (0.92, 0.39),
    (0.71, 0.71),
    (0.39, 0.92),
    (0.0, 1.0),
    (-0.39, 0.92),
    (-0.71, 0.71),
    (-0.92, 0.39),
];
/// How much less differences of heights count than those of ρ and φ in the shape of cells.
const HEIGHT_WEIGHT: f64 = 0.1;
/// Times that a triangle may be divided by four.
const MOST_DIVISIONS: u8 = 7;
/// Part of the greatest distance from the axis by which triangles of one class may differ.
const CLASS_STEP: f64 = 1e-8;

/// Triangles that come nearer to the axis than this part of their greatest distance and |h| have no angles.
pub(super) const BESIDE: f64 = 0.01;
/// Where the steps of φ and those of classes begin: not at zero or at whole leads, where a thread or a plane through the
/// origin would be divided. Any numbers do.
const FIRST_LEAD: f64 = 0.123_456;
const FIRST_STEP: f64 = 0.387_654;

/// Bounds of what a part of a body covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Picture {
    /// Range of each F.
    pub(super) slabs: [(f64, f64); 8],
    pub(super) height: (f64, f64),
    /// Least distance from the axis.
    pub(super) near: f64,
    /// How far beside the picture points may be.
    pub(super) slack: f64,
}

impl Picture {
    fn with(&self, other: &Self) -> Self {
        Self {
            slabs: std::array::from_fn(|j| union(self.slabs[j], other.slabs[j])),
            height: union(self.height, other.height),
            near: self.near.min(other.near),
            slack: self.slack.max(other.slack),
        }
    }

    fn extents(&self) -> [f64; 3] {
        // Cells whose angles are not known differ by the rest only.
        let length = |(low, high): (f64, f64)| if high < f64::INFINITY { high - low } else { 0.0 };
        [length(self.slabs[0]), length(self.slabs[4]), HEIGHT_WEIGHT * length(self.height)]
    }

    fn middle(&self, dimension: usize) -> f64 {
        let (low, high) = [self.slabs[0], self.slabs[4], self.height][dimension];
        low + high
    }
}

fn union(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// A corner of a triangle, or of a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// From the axis, which is the third coordinate.
    at: DVec3,
    pub(super) rho: f64,
    pub(super) phi: f64,
}

impl Corner {
    /// Corners of triangles get their φ together.
    fn new(at: DVec3) -> Self {
        Self { at, rho: at.truncate().length(), phi: at.z }
    }

    /// Half way to another corner. φ is taken from this one, so the branch of θ stays that of the whole triangle.
    fn middle(&self, other: &Self, h: f64) -> Self {
        let at = (self.at + other.at) * 0.5;
        let mut middle = Self::new(at);
        if h != 0.0 {
            let (from, to) = (self.at.truncate(), at.truncate());
            middle.phi = self.phi + (at.z - self.at.z) - h * angle(from.perp_dot(to), from.dot(to));
        }
        middle
    }
}

/// arctan(y/x) in its quadrant; wrong by less than 8·2⁻⁵³ of π.
fn angle(y: f64, x: f64) -> f64 {
    Interval::point(y).atan2(Interval::point(x)).mid()
}

/// A triangle, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) corners: [Corner; 3],
    /// What ρ may be below, and φ beside, the interpolation between the corners.
    pub(super) bend_rho: f64,
    pub(super) bend_phi: f64,
    /// Heights of all triangles of the class, if there are more than one.
    shared: Option<(f64, f64)>,
    slack: f64,
    divisions: u8,
    /// No angles are known.
    wide: bool,
}

impl Piece {
    fn picture(&self) -> Picture {
        let c = &self.corners;
        let heights = range(c.map(|corner| corner.at.z));
        let mut slabs = [(f64::NEG_INFINITY, f64::INFINITY); 8];
        let near = self.near();
        slabs[0] = (near, c[0].rho.max(c[1].rho).max(c[2].rho));
        if !self.wide {
            for (slab, (alpha, beta)) in slabs.iter_mut().zip(DIRECTIONS).skip(1) {
                *slab = self.reach(alpha, beta);
            }
        }
        Picture { slabs, height: self.shared.unwrap_or(heights), near, slack: self.slack }
    }

    fn near(&self) -> f64 {
        nearest(&self.corners.map(|corner| corner.at.with_z(0.0)), DVec3::Z)
    }

    /// Range of F = αρ + βφ.
    pub(super) fn reach(&self, alpha: f64, beta: f64) -> (f64, f64) {
        let (low, high) = range(self.corners.map(|corner| alpha * corner.rho + beta * corner.phi));
        let either = beta.abs() * self.bend_phi;
        let (below, above) =
            if alpha > 0.0 { (alpha * self.bend_rho, 0.0) } else { (0.0, -alpha * self.bend_rho) };
        (low - (below + either) * UP, high + (above + either) * UP)
    }

    /// Fills in the bends: half of the bound on the second derivative, 1/ρ and 1/ρ², times the square of a radius that
    /// holds the corners. ρ is convex: never above.
    fn bent(mut self, h: f64) -> Self {
        let corners = self.corners.map(|corner| corner.at);
        let radius = [0, 1, 2]
            .map(|i| {
                let middle = (corners[i] + corners[(i + 1) % 3]) * 0.5;
                corners.iter().map(|p| (*p - middle).length_squared()).fold(0.0, f64::max)
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let near = self.near();
        let far = self.corners.iter().map(|corner| corner.rho).fold(0.0, f64::max);
        self.bend_rho = if near > 0.0 { (0.5 * radius / near).min(far) } else { far };
        self.bend_phi = if h == 0.0 { 0.0 } else { 0.5 * h.abs() * radius / (near * near) };
        self
    }

    fn divided(&self, h: f64) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let (p, q, r) = (a.middle(&b, h), b.middle(&c, h), c.middle(&a, h));
        [[a, p, r], [p, b, q], [r, q, c], [p, q, r]].map(|corners| {
            let part = Self { corners, divisions: self.divisions + 1, ..*self };
            if self.wide { part } else { part.bent(h) }
        })
    }
}

fn range(v: [f64; 3]) -> (f64, f64) {
    (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]))
}

/// A part of a body: several triangles, one, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) picture: Picture,
    /// The number of the piece that it is.
    piece: Option<u32>,
    /// The first of the cells that it is made of, and their number; none: not yet divided.
    below: (u32, u32),
}

/// A tree of pictures. Grows where it is looked at.
#[derive(Debug)]
pub(super) struct Pictures {
    pub(super) cells: Vec<Cell>,
    pieces: Vec<Piece>,
    h: f64,
}

impl Pictures {
    /// Of the triangles of a body, corners by number of vertex, places from the axis: those whose angles are known, and
    /// the others.
    pub(super) fn of_body(
        screw: &Screw,
        places: &[DVec3],
        triangles: impl Iterator<Item = [u32; 3]>,
    ) -> [Self; 2] {
        let farthest = places.iter().map(|p| p.truncate().length_squared()).fold(0.0, f64::max).sqrt();
        let step = 1.0 / (CLASS_STEP * (farthest + screw.lead));
        let angles: Vec<f64> = places.iter().map(|p| angle(p.y, p.x)).collect();
        let (mut narrow, mut wide) = (Vec::new(), Vec::new());
        let mut classes: HashMap<[i64; 8], u32> = HashMap::new();
        let mut turns: Vec<[f64; 2]> = Vec::new();
        for triangle in triangles {
            let theta = triangle.map(|v| angles[v as usize]);
            let mut corners = triangle.map(|v| Corner::new(places[v as usize]));
            let near = nearest(&corners.map(|corner| corner.at.with_z(0.0)), DVec3::Z);
            let far = corners.iter().map(|corner| corner.rho).fold(0.0, f64::max);
            let beside = near >= BESIDE * (far + screw.h.abs());
            let mut piece = Piece {
                corners,
                bend_rho: far,
                bend_phi: 0.0,
                shared: None,
                slack: 0.0,
                divisions: 0,
                wide: screw.h != 0.0 && !beside,
            };
            // Near the axis the angle means nothing.
            if !beside {
                if piece.wide {
                    wide.push(piece);
                } else {
                    narrow.push(piece.bent(screw.h));
                    turns.push([0.0; 2]);
                }
                continue;
            }
            // A triangle beside the axis turns by less than half a turn.
            let turned = [1, 2].map(|i| {
                let by = theta[i] - theta[0];
                if by > PI {
                    by - 2.0 * PI
                } else if by < -PI {
                    by + 2.0 * PI
                } else {
                    by
                }
            });
            if screw.h != 0.0 {
                let first = corners[0].at.z - screw.h * theta[0];
                let first = first - ((first / screw.lead - FIRST_LEAD).floor() * screw.lead);
                corners[0].phi = first;
                for i in [1, 2] {
                    corners[i].phi = first + (corners[i].at.z - corners[0].at.z) - screw.h * turned[i - 1];
                }
                piece.corners = corners;
            }
            let key = [
                corners[0].rho,
                corners[1].rho,
                corners[2].rho,
                corners[0].phi,
                corners[1].phi,
                corners[2].phi,
                turned[0] * farthest,
                turned[1] * farthest,
            ]
            .map(|x| (x * step + FIRST_STEP).floor() as i64);
            let class = *classes.entry(key).or_insert(narrow.len() as u32) as usize;
            if class == narrow.len() {
                narrow.push(piece.bent(screw.h));
                turns.push(turned);
                continue;
            }
            let (one, by) = (&mut narrow[class], turns[class]);
            // Moved along the screw until the first angles agree, where do the corners end?
            let swings = [0.0, (turned[0] - by[0]).abs(), (turned[1] - by[1]).abs()];
            for (swing, (c, d)) in swings.iter().zip(corners.iter().zip(&one.corners)) {
                let beside = (c.rho - d.rho).abs() + (c.phi - d.phi).abs() + (far + screw.h.abs()) * swing;
                one.slack = one.slack.max(beside * UP);
            }
            let heights = range(corners.map(|corner| corner.at.z));
            let all = one.shared.unwrap_or(range(one.corners.map(|corner| corner.at.z)));
            one.shared = Some(union(all, heights));
        }
        [Self::new(narrow, screw.h), Self::new(wide, screw.h)]
    }

    fn new(pieces: Vec<Piece>, h: f64) -> Self {
        let mut parts: Vec<(Picture, u32)> = pieces.iter().map(Piece::picture).zip(0..).collect();
        let mut tree = Self { cells: Vec::with_capacity(4 * parts.len()), pieces, h };
        if let Some(&(picture, piece)) = parts.first() {
            tree.cells.push(Cell { picture, piece: Some(piece), below: (0, 0) });
            tree.split(0, &mut parts);
        }
        tree
    }

    fn split(&mut self, cell: usize, parts: &mut [(Picture, u32)]) {
        let picture = parts[1..].iter().fold(parts[0].0, |all, part| all.with(&part.0));
        if parts.len() == 1 {
            self.cells[cell] = Cell { picture, piece: Some(parts[0].1), below: (0, 0) };
            return;
        }
        let extents = picture.extents();
        let dimension = (0..3).max_by(|&i, &j| extents[i].total_cmp(&extents[j])).unwrap_or(0);
        let half = parts.len() / 2;
        parts.select_nth_unstable_by(half, |p, q| p.0.middle(dimension).total_cmp(&q.0.middle(dimension)));
        let first = self.cells.len();
        self.cells[cell] = Cell { picture, piece: None, below: (first as u32, 2) };
        self.cells.extend([self.cells[cell]; 2]);
        let (left, right) = parts.split_at_mut(half);
        self.split(first, left);
        self.split(first + 1, right);
    }

    /// The piece that a cell is.
    pub(super) fn piece(&self, cell: usize) -> Option<&Piece> {
        self.cells[cell].piece.map(|piece| &self.pieces[piece as usize])
    }

    /// What decides which of two cells is opened: cells that are not one piece first.
    pub(super) fn size(&self, cell: usize) -> (bool, f64) {
        let several = self.cells[cell].piece.is_none();
        let extents = self.cells[cell].picture.extents();
        (several, extents[0] + extents[1] + if several { extents[2] } else { 0.0 })
    }

    /// What a cell is made of; nothing when it is as small as cells get.
    pub(super) fn open(&mut self, cell: usize) -> std::ops::Range<usize> {
        let (first, count) = self.cells[cell].below;
        if count > 0 {
            return first as usize..(first + count) as usize;
        }
        let Some(piece) = self.piece(cell).copied() else { return 0..0 };
        if piece.divisions == MOST_DIVISIONS {
            return 0..0;
        }
        let first = self.cells.len();
        self.cells[cell].below = (first as u32, 4);
        for part in piece.divided(self.h) {
            let number = self.pieces.len() as u32;
            self.cells.push(Cell { picture: part.picture(), piece: Some(number), below: (0, 0) });
            self.pieces.push(part);
        }
        first..first + 4
    }
}
