//! The matrix, its factor and its solutions.

// Rows and columns are counted alike in all of it.
#![allow(clippy::needless_range_loop)]

use crate::elimination::eliminate;
use d2m_lanes::{InstructionSet, Lanes, Task, run_on};

/// Six rows of six numbers: of one body, or with the rows of one body and the columns of another one.
///
/// ```
/// let mass: d2m_cholesky::Square = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 2.0 } else { 0.0 }));
/// assert_eq!(mass[3][3], 2.0);
/// ```
pub type Square = [[f64; 6]; 6];

/// A symmetric matrix of six rows a body, which pairs of bodies share, and its Cholesky factorization. The order of elimination and the places of
/// what is not zero serve as long as the pairs are the same.
///
/// ```
/// # use d2m_cholesky::Factor;
/// let mut factor = Factor::try_new(1, Vec::new()).expect("one body, and no pair");
/// let twice = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 2.0 } else { 0.0 }));
/// factor.add(0, &twice);
/// let mut right = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0];
/// assert!(factor.solve(&mut right));
/// assert!(right.iter().zip(1..).all(|(x, k)| (x - f64::from(k)).abs() < 1e-14));
/// ```
#[derive(Debug)]
pub struct Factor {
    /// (i, j) with i < j, ascending.
    pairs: Vec<[usize; 2]>,
    /// Of each body, when it is eliminated.
    places: Vec<usize>,
    /// Where the squares of each column begin, and where the last ones end.
    starts: Vec<usize>,
    /// Of each square its row of squares: in a column that of the diagonal, then ascending.
    rows: Vec<usize>,
    /// The lower triangle of the matrix, and then its factor: column after column of each square.
    squares: Vec<Square>,
}

impl Factor {
    /// The matrix zero of so many bodies, of which these pairs share rows: (i, j) with i < j, below the number of bodies, ascending. None: they
    /// are not so, or there is no memory for them.
    pub fn try_new(bodies: usize, pairs: Vec<[usize; 2]>) -> Option<Self> {
        let is_pair = |&[i, j]: &[usize; 2]| i < j && j < bodies;
        if !pairs.iter().all(is_pair) || !pairs.is_sorted_by(|x, y| x < y) {
            return None;
        }
        let columns = eliminate(bodies, &pairs);
        let mut places = vec![0; bodies];
        for (place, (body, _)) in columns.iter().enumerate() {
            places[*body] = place;
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (place, (_, below)) in columns.iter().enumerate() {
            let first = rows.len() + 1;
            rows.push(place);
            rows.extend(below.iter().map(|&body| places[body]));
            rows[first..].sort_unstable();
            starts.push(rows.len());
        }
        let mut squares = Vec::new();
        squares.try_reserve_exact(rows.len()).ok()?;
        squares.resize(rows.len(), [[0.0; 6]; 6]);
        Some(Self { pairs, places, starts, rows, squares })
    }

    /// Was it made for so many bodies and these pairs?
    pub fn is_for(&self, bodies: usize, pairs: &[[usize; 2]]) -> bool {
        self.places.len() == bodies && self.pairs == pairs
    }

    /// Makes the matrix zero, as it must be before it is filled again: a solution leaves the factor in its place.
    pub fn clear(&mut self) {
        self.squares.fill([[0.0; 6]; 6]);
    }

    /// Adds a symmetric square to the rows and columns of one body.
    ///
    /// # Panics
    /// There is no such body.
    pub fn add(&mut self, body: usize, square: &Square) {
        add(&mut self.squares[self.starts[self.places[body]]], |column, row| square[column][row]);
    }

    /// Adds a square with the rows of one body and the columns of another one, and its transpose to the other triangle. False: they are none of the
    /// pairs that it was made for, and nothing is added.
    ///
    /// # Panics
    /// There is no such body.
    pub fn add_between(&mut self, rows: usize, columns: usize, square: &Square) -> bool {
        let (row, column) = (self.places[rows], self.places[columns]);
        let [first, second] = [row.min(column), row.max(column)];
        let start = self.starts[first] + 1;
        let Ok(at) = self.rows[start..self.starts[first + 1]].binary_search(&second) else { return false };
        let own = &mut self.squares[start + at];
        if column == first {
            add(own, |column, row| square[row][column]);
        } else {
            add(own, |column, row| square[column][row]);
        }
        true
    }

    /// Replaces the right side, six numbers a body, by the solution, and the matrix by its factor. False: the matrix is not positive definite to
    /// rounding, or holds what is no finite number; the right side is as it was.
    ///
    /// # Panics
    /// The right side is shorter than six numbers a body.
    #[must_use]
    pub fn solve(&mut self, right: &mut [f64]) -> bool {
        self.solve_on(InstructionSet::in_use(), right)
    }

    fn solve_on(&mut self, set: InstructionSet, right: &mut [f64]) -> bool {
        let Self { places, starts, rows, squares, .. } = self;
        let mut sides = vec![[0.0; 6]; places.len()];
        for (body, &place) in places.iter().enumerate() {
            sides[place].copy_from_slice(&right[6 * body..6 * body + 6]);
        }
        if !run_on(set, Solve { starts, rows, squares, sides: &mut sides }) {
            return false;
        }
        for (body, &place) in places.iter().enumerate() {
            right[6 * body..6 * body + 6].copy_from_slice(&sides[place]);
        }
        true
    }
}

fn add(own: &mut Square, of: impl Fn(usize, usize) -> f64) {
    for (column, values) in own.iter_mut().enumerate() {
        for (row, value) in values.iter_mut().enumerate() {
            *value += of(column, row);
        }
    }
}

struct Solve<'f> {
    starts: &'f [usize],
    rows: &'f [usize],
    squares: &'f mut [Square],
    /// The right sides by place, then the solution.
    sides: &'f mut [[f64; 6]],
}

impl Task for Solve<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { starts, rows, squares, sides } = self;
        if !factorize(starts, rows, squares) {
            return false;
        }
        for (place, all) in starts.windows(2).enumerate() {
            let (own, below) = (&squares[all[0]], all[0] + 1..all[1]);
            let mut side = sides[place];
            for column in 0..6 {
                side[column] /= own[column][column];
                for row in column + 1..6 {
                    side[row] -= own[column][row] * side[column];
                }
            }
            sides[place] = side;
            for (square, row) in squares[below.clone()].iter().zip(&rows[below]) {
                let other = &mut sides[*row];
                for column in 0..6 {
                    for row in 0..6 {
                        other[row] -= square[column][row] * side[column];
                    }
                }
            }
        }
        for (place, all) in starts.windows(2).enumerate().rev() {
            let (own, below) = (&squares[all[0]], all[0] + 1..all[1]);
            let mut side = sides[place];
            for (square, row) in squares[below.clone()].iter().zip(&rows[below]) {
                for column in 0..6 {
                    for row_of in 0..6 {
                        side[column] -= square[column][row_of] * sides[*row][row_of];
                    }
                }
            }
            for column in (0..6).rev() {
                for row in column + 1..6 {
                    side[column] -= own[column][row] * side[row];
                }
                side[column] /= own[column][column];
            }
            sides[place] = side;
        }
        true
    }
}

/// Replaces the lower triangle by the factor. What is above the diagonal of a square on the diagonal is not read.
#[inline(always)]
fn factorize(starts: &[usize], rows: &[usize], squares: &mut [Square]) -> bool {
    for all in starts.windows(2) {
        let (begun, later) = squares.split_at_mut(all[1]);
        let Some((own, below)) = begun[all[0]..].split_first_mut() else { return false };
        if !root(own) {
            return false;
        }
        for square in &mut *below {
            divide(square, own);
        }
        let below_rows = &rows[all[0] + 1..all[1]];
        for (k, column) in below_rows.iter().enumerate() {
            // What a column holds is in that of each of its rows: both ascend.
            let mut at = starts[*column];
            for (square, row) in below[k..].iter().zip(&below_rows[k..]) {
                while rows[at] < *row {
                    at += 1;
                }
                subtract(&mut later[at - all[1]], square, &below[k]);
            }
        }
    }
    true
}

/// The factor of a square on the diagonal. False: it is not positive definite.
#[inline(always)]
fn root(own: &mut Square) -> bool {
    for k in 0..6 {
        let pivot = own[k][k].sqrt();
        if !(pivot > 0.0 && pivot < f64::INFINITY) {
            return false;
        }
        for row in k..6 {
            own[k][row] /= pivot;
        }
        for column in k + 1..6 {
            for row in column..6 {
                own[column][row] -= own[k][row] * own[k][column];
            }
        }
    }
    true
}

/// X with X Lᵀ the square.
#[inline(always)]
fn divide(square: &mut Square, own: &Square) {
    for column in 0..6 {
        let mut values = square[column];
        for k in 0..column {
            for row in 0..6 {
                values[row] -= square[k][row] * own[k][column];
            }
        }
        for row in 0..6 {
            values[row] /= own[column][column];
        }
        square[column] = values;
    }
}

/// Subtracts X Yᵀ.
#[inline(always)]
fn subtract(square: &mut Square, x: &Square, y: &Square) {
    for column in 0..6 {
        let mut values = square[column];
        for k in 0..6 {
            for row in 0..6 {
                values[row] -= x[k][row] * y[k][column];
            }
        }
        square[column] = values;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A system as dense rows: each pair of bodies shares six rows g of random numbers, A = D + Σ gᵀ g.
    fn system(
        bodies: usize,
        pairs: &[[usize; 2]],
        numbers: &mut impl FnMut() -> f64,
    ) -> (Factor, Vec<Vec<f64>>) {
        let mut factor = Factor::try_new(bodies, pairs.to_vec()).unwrap();
        let mut dense = vec![vec![0.0; 6 * bodies]; 6 * bodies];
        let mut add = |dense: &mut Vec<Vec<f64>>, [i, j]: [usize; 2], square: &Square| {
            for (row, values) in square.iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    dense[6 * i + row][6 * j + column] += value;
                    if i != j {
                        dense[6 * j + column][6 * i + row] += value;
                    }
                }
            }
            if i == j { factor.add(i, square) } else { assert!(factor.add_between(i, j, square)) }
        };
        for body in 0..bodies {
            let mass = 1.0 + numbers().abs();
            add(
                &mut dense,
                [body; 2],
                &core::array::from_fn(|i| core::array::from_fn(|j| if i == j { mass } else { 0.0 })),
            );
        }
        for &[i, j] in pairs {
            let [a, b]: [Square; 2] =
                core::array::from_fn(|_| core::array::from_fn(|_| core::array::from_fn(|_| numbers())));
            let product = |x: &Square, y: &Square| -> Square {
                core::array::from_fn(|r| core::array::from_fn(|c| (0..6).map(|k| x[k][r] * y[k][c]).sum()))
            };
            add(&mut dense, [i; 2], &product(&a, &a));
            add(&mut dense, [j; 2], &product(&b, &b));
            // Either way round.
            if numbers() > 0.0 {
                add(&mut dense, [i, j], &product(&a, &b));
            } else {
                add(&mut dense, [j, i], &product(&b, &a));
            }
        }
        (factor, dense)
    }

    proptest! {
        /// What is solved gives the right side back, whatever shares rows with what.
        #[test]
        fn solutions_give_the_right_side_back(bodies in 1usize..24, density in 0.0..1.0, seed in 1u64..1 << 40) {
            let mut state = seed;
            let mut numbers = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
            };
            let mut pairs = Vec::new();
            for i in 0..bodies {
                pairs.extend((i + 1..bodies).map(|j| [i, j]));
            }
            pairs.retain(|_| numbers().abs() < density);
            let (mut factor, dense) = system(bodies, &pairs, &mut numbers);
            let wanted: Vec<f64> = (0..6 * bodies).map(|_| numbers()).collect();
            let mut right: Vec<f64> =
                dense.iter().map(|row| row.iter().zip(&wanted).map(|(a, x)| a * x).sum()).collect();
            prop_assert!(factor.solve(&mut right));
            for (found, wanted) in right.iter().zip(&wanted) {
                // No eigenvalue is below 1, none above 200: rounding of sums of at most 144 products.
                prop_assert!((found - wanted).abs() < 1e-11, "{} {}", found, wanted);
            }
        }
    }

    /// On vectors of every width, that is.
    #[test]
    fn sums_are_added_one_by_one() {
        let mut state = 1.0f64;
        let mut numbers = || {
            state = (state * 1.618 + 0.333) % 1.0;
            2.0 * state - 1.0
        };
        let pairs: Vec<[usize; 2]> = (0..30).flat_map(|i| [[i, i + 1], [i, i + 7]]).collect();
        let (_, dense) = system(37, &pairs, &mut numbers);
        let solved = |set: InstructionSet| {
            let mut factor = Factor::try_new(37, pairs.clone()).unwrap();
            let square = |i: usize, j: usize| -> Square {
                core::array::from_fn(|r| core::array::from_fn(|c| dense[6 * i + r][6 * j + c]))
            };
            for i in 0..37 {
                factor.add(i, &square(i, i));
            }
            for &[i, j] in &pairs {
                assert!(factor.add_between(i, j, &square(i, j)));
            }
            let mut right: Vec<f64> = (0..222).map(|i| f64::from(i) - 100.5).collect();
            assert!(factor.solve_on(set, &mut right));
            right.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        let plain = solved(InstructionSet::Portable);
        assert!([InstructionSet::Avx2, InstructionSet::Avx512].map(solved).iter().all(|bits| *bits == plain));
    }

    /// What no factor is of is said, and leaves the right side alone.
    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let diagonal = |x: f64| -> Square {
            core::array::from_fn(|i| core::array::from_fn(|j| if i == j { x } else { 0.0 }))
        };
        for x in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut factor = Factor::try_new(2, vec![[0, 1]]).unwrap();
            let mut last = diagonal(1.0);
            last[5][5] = x;
            factor.add(0, &diagonal(1.0));
            factor.add(1, &last);
            let mut right = [1.0; 12];
            assert!(!factor.solve(&mut right) && right == [1.0; 12], "{x}");
            factor.clear();
            for body in 0..2 {
                factor.add(body, &diagonal(4.0));
            }
            assert!(factor.solve(&mut right) && right == [0.25; 12]);
        }
    }

    #[test]
    fn pairs_are_ascending_pairs_of_bodies() {
        let is_taken = |pairs: &[[usize; 2]]| Factor::try_new(3, pairs.to_vec()).is_some();
        assert!(is_taken(&[]) && is_taken(&[[0, 1], [0, 2]]) && Factor::try_new(0, Vec::new()).is_some());
        for pairs in
            [[[1, 0], [1, 2]], [[0, 1], [0, 1]], [[0, 2], [0, 1]], [[0, 1], [1, 3]], [[0, 0], [1, 2]]]
        {
            assert!(!is_taken(&pairs), "{pairs:?}");
        }
        let mut factor = Factor::try_new(3, vec![[0, 1]]).unwrap();
        assert!(!factor.add_between(2, 0, &[[1.0; 6]; 6]) && factor.add_between(1, 0, &[[0.0; 6]; 6]));
        assert!(factor.is_for(3, &[[0, 1]]) && !factor.is_for(2, &[[0, 1]]) && !factor.is_for(3, &[]));
    }
}
