//! A binary tree over the projection of a body.

use super::projection::{Piece, Projection};
use crate::meter::{Exhausted, Meter};

/// Times that a triangle may be divided by four.
const MOST_DIVISIONS: u8 = 7;

/// As many parts are divided at their median in less than a millisecond.
const MOST_SELECTED: usize = 1 << 14;
/// Of more parts, so many have their median taken; each half gets at least one part in [`LEAST_HALF`] of them.
const SAMPLE: usize = 63;
const LEAST_HALF: usize = 16;

/// Divides parts by their middles along a dimension; the number of those in the first half, which are not beyond the others.
fn divide(parts: &mut [(Projection, u32)], dimension: usize, clock: &mut Meter) -> Result<usize, Exhausted> {
    let middle = |part: &(Projection, u32)| part.0.middle(dimension);
    if parts.len() > MOST_SELECTED {
        let mut sample: [f64; SAMPLE] =
            std::array::from_fn(|k| middle(&parts[(2 * k + 1) * parts.len() / (2 * SAMPLE)]));
        sample.sort_unstable_by(f64::total_cmp);
        let mut below = 0;
        for k in 0..parts.len() {
            clock.step()?;
            if middle(&parts[k]) < sample[SAMPLE / 2] {
                parts.swap(below, k);
                below += 1;
            }
        }
        if below.min(parts.len() - below) > parts.len() / LEAST_HALF {
            return Ok(below);
        }
    }
    let half = parts.len() / 2;
    parts.select_nth_unstable_by(half, |p, q| middle(p).total_cmp(&middle(q)));
    Ok(half)
}

/// A part of a body: several triangles, one, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) projection: Projection,
    /// The number of the piece that it is.
    piece: Option<u32>,
    /// The first of the cells that it is made of.
    first_below: u32,
    /// How many they are; none: not yet divided.
    below: u32,
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
    h: f64,
}

impl ProjectionTree {
    /// Of some pieces, on a screw with φ = z − hθ.
    pub(super) fn try_new(pieces: Vec<Piece>, h: f64, clock: &mut Meter) -> Result<Self, Exhausted> {
        let mut parts: Vec<(Projection, u32)> = pieces.iter().map(Piece::projection).zip(0..).collect();
        let mut tree = Self { cells: Vec::with_capacity(4 * parts.len()), pieces, h };
        if let Some(&(projection, piece)) = parts.first() {
            tree.cells.push(Cell { projection, piece: Some(piece), first_below: 0, below: 0 });
            tree.split(0, &mut parts, clock)?;
        }
        Ok(tree)
    }

    fn split(
        &mut self,
        cell: usize,
        parts: &mut [(Projection, u32)],
        clock: &mut Meter,
    ) -> Result<(), Exhausted> {
        let mut projection = parts[0].0;
        for part in parts.iter() {
            clock.step()?;
            projection = projection.with(&part.0);
        }
        if parts.len() == 1 {
            self.cells[cell] = Cell { projection, piece: Some(parts[0].1), first_below: 0, below: 0 };
            return Ok(());
        }
        let extents = projection.extents();
        let dimension = (0..3).max_by(|&i, &j| extents[i].total_cmp(&extents[j])).unwrap_or(0);
        let half = divide(parts, dimension, clock)?;
        let first = self.cells.len();
        self.cells[cell] = Cell { projection, piece: None, first_below: first as u32, below: 2 };
        self.cells.extend([self.cells[cell]; 2]);
        let (left, right) = parts.split_at_mut(half);
        self.split(first, left, clock)?;
        self.split(first + 1, right, clock)
    }

    /// The piece that a cell is.
    pub(super) fn piece(&self, cell: usize) -> Option<&Piece> {
        self.cells[cell].piece.map(|piece| &self.pieces[piece as usize])
    }

    /// What decides which of two cells is expanded.
    pub(super) fn size(&self, cell: usize) -> CellSize {
        let several = self.cells[cell].piece.is_none();
        let extents = self.cells[cell].projection.extents();
        CellSize { several, extent: extents[0] + extents[1] + if several { extents[2] } else { 0.0 } }
    }

    /// What a cell is made of; nothing when it is as small as cells get.
    pub(super) fn open(&mut self, cell: usize) -> std::ops::Range<usize> {
        let Cell { first_below: first, below: count, .. } = self.cells[cell];
        if count > 0 {
            return first as usize..(first + count) as usize;
        }
        let Some(piece) = self.piece(cell).copied() else { return 0..0 };
        if piece.divisions == MOST_DIVISIONS {
            return 0..0;
        }
        let first = self.cells.len();
        (self.cells[cell].first_below, self.cells[cell].below) = (first as u32, 4);
        for part in piece.divided(self.h) {
            let number = self.pieces.len() as u32;
            self.cells.push(Cell {
                projection: part.projection(),
                piece: Some(number),
                first_below: 0,
                below: 0,
            });
            self.pieces.push(part);
        }
        first..first + 4
    }
}
