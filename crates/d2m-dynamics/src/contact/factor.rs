//! Symmetric positive definite systems of six rows a body, sparse by pairs of bodies.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Six rows of six columns.
pub(super) type Square = [[f64; 6]; 6];

/// A sparse Cholesky factorization whose symbolic part serves as long as the pairs are the same. One thread: the same bits at any number.
pub(super) struct Factor {
    bodies: usize,
    /// (i, j) with i < j, ascending.
    pairs: Vec<[usize; 2]>,
    /// Where the pairs of each first body begin, and where the last ones end.
    starts: Vec<usize>,
    /// The lower triangle, column after column.
    columns: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    symbolic: SymbolicCholesky<usize>,
    lower: Vec<f64>,
    memory: MemBuffer,
}

impl core::fmt::Debug for Factor {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Factor")
            .field("bodies", &self.bodies)
            .field("pairs", &self.pairs.len())
            .finish_non_exhaustive()
    }
}

impl Factor {
    /// For so many bodies, of which these pairs (i < j, ascending) share rows. None: it cannot be stored.
    pub(super) fn try_new(bodies: usize, pairs: Vec<[usize; 2]>) -> Option<Self> {
        let mut starts = vec![0; bodies + 1];
        for pair in &pairs {
            starts[pair[0] + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let (mut columns, mut rows) = (vec![0], Vec::new());
        for i in 0..bodies {
            for column in 0..6 {
                rows.extend((column..6).map(|row| 6 * i + row));
                for pair in &pairs[starts[i]..starts[i + 1]] {
                    rows.extend((0..6).map(|row| 6 * pair[1] + row));
                }
                columns.push(rows.len());
            }
        }
        let size = 6 * bodies;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &columns, None, &rows);
        // Dense kernels of supernodes would round as the processor's vectors are wide.
        let one_by_one = SupernodalThreshold::FORCE_SIMPLICIAL;
        let params =
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: one_by_one, ..Default::default() };
        let order = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, order, params).ok()?;
        let needed = symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::prelude::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let memory = MemBuffer::try_new(needed).ok()?;
        let lower = vec![0.0; symbolic.len_val()];
        let values = vec![0.0; rows.len()];
        Some(Self { bodies, pairs, starts, columns, rows, values, symbolic, lower, memory })
    }

    /// Does it serve for these?
    pub(super) fn is_for(&self, bodies: usize, pairs: &[[usize; 2]]) -> bool {
        self.bodies == bodies && self.pairs == pairs
    }

    /// Sets all values to zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a symmetric square of one body.
    pub(super) fn add(&mut self, body: usize, square: &Square) {
        for (column, symmetric) in square.iter().enumerate() {
            let place = self.columns[6 * body + column];
            for (own, value) in self.values[place..].iter_mut().zip(&symmetric[column..]) {
                *own += value;
            }
        }
    }

    /// Adds a square with the rows of one body and the columns of another one; the other triangle has its transpose.
    pub(super) fn add_between(&mut self, rows: usize, columns: usize, square: &Square) {
        let (first, second) = (rows.min(columns), rows.max(columns));
        let pairs = &self.pairs[self.starts[first]..self.starts[first + 1]];
        let Ok(place) = pairs.binary_search(&[first, second]) else { return };
        for (row, values) in square.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                let (row, column) = if columns == first { (row, column) } else { (column, row) };
                let start = self.columns[6 * first + column] + 6 - column + 6 * place;
                self.values[start + row] += value;
            }
        }
    }

    /// Replaces the right side by the solution. False: the matrix is not positive definite to rounding.
    pub(super) fn solve(&mut self, right: &mut [f64]) -> bool {
        let size = 6 * self.bodies;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &self.columns, None, &self.rows);
        let matrix = SparseColMatRef::new(pattern, &self.values);
        let stack = MemStack::new(&mut self.memory);
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.lower,
            matrix,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            stack,
            faer::prelude::default(),
        );
        if done.is_err() {
            return false;
        }
        let factor = LltRef::new(&self.symbolic, &self.lower);
        let right = MatMut::from_column_major_slice_mut(right, size, 1);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, MemStack::new(&mut self.memory));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All bodies share rows with all others: supernodes would be faster there, and round otherwise on each kind of processor.
    #[test]
    fn sums_are_added_one_by_one() {
        use faer::sparse::linalg::cholesky::SymbolicCholeskyRaw;
        let pairs = (0..40).flat_map(|i| (i + 1..40).map(move |j| [i, j])).collect();
        let factor = Factor::try_new(40, pairs).unwrap();
        assert!(matches!(factor.symbolic.raw(), SymbolicCholeskyRaw::Simplicial(_)));
    }

    /// Three bodies in a row and one apart: what is solved gives the right side back.
    #[test]
    fn solutions_give_the_right_side_back() {
        let mut factor = Factor::try_new(4, vec![[0, 1], [1, 2]]).unwrap();
        let mut dense = vec![[0.0; 24]; 24];
        factor.clear();
        for body in 0..4 {
            let mut square = [[0.25; 6]; 6];
            (0..6).for_each(|i| square[i][i] = 8.0 + (body + i) as f64);
            factor.add(body, &square);
            for (row, values) in square.iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    dense[6 * body + row][6 * body + column] += value;
                }
            }
        }
        for (rows, columns) in [(0, 1), (2, 1)] {
            let mut square = [[0.0; 6]; 6];
            for (row, values) in square.iter_mut().enumerate() {
                for (column, value) in values.iter_mut().enumerate() {
                    *value = 0.1 * (row as f64 - 2.0 * column as f64);
                    dense[6 * rows + row][6 * columns + column] += *value;
                    dense[6 * columns + column][6 * rows + row] += *value;
                }
            }
            factor.add_between(rows, columns, &square);
        }
        let wanted: Vec<f64> = (0..24).map(|i| f64::from(i) - 7.5).collect();
        let mut right: Vec<f64> =
            dense.iter().map(|row| row.iter().zip(&wanted).map(|(a, x)| a * x).sum()).collect();
        assert!(factor.solve(&mut right));
        for (found, wanted) in right.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}
