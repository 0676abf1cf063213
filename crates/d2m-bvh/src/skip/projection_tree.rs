//! A binary tree over the projection of a body.

use super::projection::{Piece, Projection};
use d2m_mesh::{Exhausted, Meter};

/// As many parts are divided at their median in less than a millisecond.
const MOST_SELECTED: usize = 1 << 14;
/// Of more parts, so many have their median taken; each half gets at least one part in [`LEAST_HALF`] of them.
const SAMPLE: usize = 63;
const LEAST_HALF: usize = 16;

/// Divides parts by their middles; the number of those in the first half, which are not beyond the others.
fn divide(parts: &mut [u32], middle: impl Fn(u32) -> f64, clock: &mut Meter) -> Result<usize, Exhausted> {
    if parts.len() > MOST_SELECTED {
        let mut sample: [f64; SAMPLE] =
            std::array::from_fn(|k| middle(parts[(2 * k + 1) * parts.len() / (2 * SAMPLE)]));
        sample.sort_unstable_by(f64::total_cmp);
        let mut below = 0;
        for k in 0..parts.len() {
            clock.step()?;
            if middle(parts[k]) < sample[SAMPLE / 2] {
                parts.swap(below, k);
                below += 1;
            }
        }
        if below.min(parts.len() - below) > parts.len() / LEAST_HALF {
            return Ok(below);
        }
    }
    let half = parts.len() / 2;
    parts.select_nth_unstable_by(half, |&p, &q| middle(p).total_cmp(&middle(q)));
    Ok(half)
}

/// A part of a body: several triangles, one, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) projection: Projection,
    /// The number of the piece that it is.
    piece: Option<u32>,
    /// The first of the cells that it is made of; of several pieces not yet divided, the place of the first one in their order.
    first_below: u32,
    /// How many cells they are; none: not yet divided.
    below: u32,
    /// How many pieces it is made of.
    count: u32,
}

/// Of two cells the larger one is expanded: one of several pieces before one that is a piece.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct CellSize {
    several: bool,
    extent: f64,
}

/// A tree of projections, which grows where its cells are divided.
#[derive(Debug)]
pub(super) struct ProjectionTree {
    pub(super) cells: Vec<Cell>,
    pieces: Vec<Piece>,
    /// Those that come after them in number: parts of pieces, which grow without a copy of what there was at first.
    parts: Vec<Piece>,
    /// Of the pieces that there were at first, and their order: those of a cell stand side by side.
    projections: Vec<Projection>,
    order: Vec<u32>,
    h: f64,
}

impl ProjectionTree {
    /// Of some pieces, on a screw with φ = z − hθ.
    pub(super) fn try_new(pieces: Vec<Piece>, h: f64, clock: &mut Meter) -> Result<Self, Exhausted> {
        let projections: Vec<Projection> = pieces.iter().map(Piece::projection).collect();
        let order: Vec<u32> = (0..).take(pieces.len()).collect();
        let mut tree = Self { cells: Vec::new(), pieces, parts: Vec::new(), projections, order, h };
        if !tree.order.is_empty() {
            let root = tree.cell(0..tree.order.len(), clock)?;
            tree.cells.push(root);
        }
        Ok(tree)
    }

    /// Of the pieces that stand there in their order.
    fn cell(&self, places: std::ops::Range<usize>, clock: &mut Meter) -> Result<Cell, Exhausted> {
        let (first_below, count) = (places.start as u32, places.len() as u32);
        let parts = &self.order[places];
        let mut projection = self.projections[parts[0] as usize];
        for &part in parts {
            clock.step()?;
            projection = projection.with(&self.projections[part as usize]);
        }
        let piece = (count == 1).then_some(parts[0]);
        Ok(Cell { projection, piece, first_below, below: 0, count })
    }

    /// Divides a cell of several pieces in two.
    fn split(&mut self, cell: usize, clock: &mut Meter) -> Result<(), Exhausted> {
        let Cell { projection, first_below, count, .. } = self.cells[cell];
        let (start, end) = (first_below as usize, (first_below + count) as usize);
        let extents = projection.extents();
        let dimension = (0..3).max_by(|&i, &j| extents[i].total_cmp(&extents[j])).unwrap_or(0);
        let projections = &self.projections;
        let middle = |part: u32| projections[part as usize].middle(dimension);
        let half = start + divide(&mut self.order[start..end], middle, clock)?;
        let halves = [self.cell(start..half, clock)?, self.cell(half..end, clock)?];
        (self.cells[cell].first_below, self.cells[cell].below) = (self.cells.len() as u32, 2);
        self.cells.extend(halves);
        Ok(())
    }

    /// The piece that a cell is.
    pub(super) fn piece(&self, cell: usize) -> Option<&Piece> {
        let number = self.cells[cell].piece? as usize;
        Some(self.pieces.get(number).unwrap_or_else(|| &self.parts[number - self.pieces.len()]))
    }

    /// What decides which of two cells is expanded.
    pub(super) fn size(&self, cell: usize) -> CellSize {
        let several = self.cells[cell].piece.is_none();
        let extents = self.cells[cell].projection.extents();
        CellSize { several, extent: extents[0] + extents[1] + if several { extents[2] } else { 0.0 } }
    }

    /// What a cell is made of; nothing when it is as small as cells get.
    pub(super) fn open(
        &mut self,
        cell: usize,
        clock: &mut Meter,
    ) -> Result<std::ops::Range<usize>, Exhausted> {
        if self.cells[cell].below == 0 && self.cells[cell].count > 1 {
            self.split(cell, clock)?;
        }
        let Cell { first_below: first, below: count, .. } = self.cells[cell];
        if count > 0 {
            return Ok(first as usize..(first + count) as usize);
        }
        let Some(piece) = self.piece(cell).copied() else { return Ok(0..0) };
        if !piece.is_divisible() {
            return Ok(0..0);
        }
        let first = self.cells.len();
        (self.cells[cell].first_below, self.cells[cell].below) = (first as u32, 4);
        for part in piece.divided(self.h) {
            let number = (self.pieces.len() + self.parts.len()) as u32;
            self.cells.push(Cell {
                projection: part.projection(),
                piece: Some(number),
                first_below: 0,
                below: 0,
                count: 1,
            });
            self.parts.push(part);
        }
        Ok(first..first + 4)
    }
}
