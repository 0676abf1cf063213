//! Anderson's acceleration of a fixed-point iteration.

use std::collections::VecDeque;

/// Iterates that are looked back on.
const WINDOW: usize = 6;
/// A step of which a smaller part is left, without those before, is one of them up to rounding: 2⁻²⁶, the root of what doubles resolve.
const LEAST_REST: f64 = 1.0 / 67_108_864.0;

/// What is known of a map s → G(s) whose fixed point, of numbers that are not negative, is sought (Anderson 1965,
/// [doi:10.1145/321296.321305](https://doi.org/10.1145/321296.321305)): the last six iterates are looked back on.
///
/// ```
/// use d2m_cholesky::Anderson;
/// // Goes away from its fixed point, one half, when it is iterated.
/// let map = |s: f64| 2.0 - 3.0 * s;
/// let (mut anderson, mut s) = (Anderson::default(), vec![0.0]);
/// for _ in 0..3 {
///     let answer = vec![map(s[0])];
///     s = anderson.next(&s, answer);
/// }
/// assert!((s[0] - 0.5).abs() < 1e-12);
/// ```
#[derive(Debug, Default)]
pub struct Anderson {
    /// Differences of consecutive answers, and of what they differ by from their arguments.
    steps: VecDeque<(Vec<f64>, Vec<f64>)>,
    last: Option<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// The next argument, not below zero, after `argument` was answered by `answer`, which is as long.
    pub fn next(&mut self, argument: &[f64], answer: Vec<f64>) -> Vec<f64> {
        let off: Vec<f64> = answer.iter().zip(argument).map(|(g, s)| g - s).collect();
        let minus = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x - y).collect::<Vec<f64>>();
        if let Some((old_answer, old_off)) = self.last.replace((answer.clone(), off.clone())) {
            self.steps.push_back((minus(&answer, &old_answer), minus(&off, &old_off)));
            if self.steps.len() > WINDOW {
                self.steps.pop_front();
            }
        }
        let mut next = answer;
        for (weight, (step, _)) in self.weights(&off).iter().zip(&self.steps) {
            for (next, step) in next.iter_mut().zip(step) {
                *next -= weight * step;
            }
        }
        for s in &mut next {
            *s = s.max(0.0);
        }
        next
    }

    /// The combination of the differences that is nearest to `off`, by Gram–Schmidt; differences that the others make up have no part.
    fn weights(&self, off: &[f64]) -> Vec<f64> {
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let count = self.steps.len();
        let (mut basis, mut triangle): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        for (_, step) in &self.steps {
            let mut rest = step.clone();
            let mut column = Vec::with_capacity(count);
            for direction in &basis {
                let part = dot(direction, &rest);
                rest.iter_mut().zip(direction).for_each(|(r, d)| *r -= part * d);
                column.push(part);
            }
            let length = dot(&rest, &rest).sqrt();
            let counts = length > LEAST_REST * dot(step, step).sqrt();
            column.push(if counts { length } else { 0.0 });
            for r in &mut rest {
                *r = if counts { *r / length } else { 0.0 };
            }
            basis.push(rest);
            triangle.push(column);
        }
        let mut weights: Vec<f64> = basis.iter().map(|direction| dot(direction, off)).collect();
        for k in (0..count).rev() {
            let pivot = triangle[k][k];
            weights[k] = if pivot > 0.0 { weights[k] / pivot } else { 0.0 };
            for (row, part) in triangle[k][..k].iter().enumerate() {
                weights[row] -= part * weights[k];
            }
        }
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fixed point of a linear map of three numbers whose plain iteration goes away from it.
    #[test]
    fn a_linear_map_is_solved_in_as_many_rounds_as_it_has_numbers() {
        let map =
            |s: &[f64]| vec![1.0 + 0.5 * s[1], 2.0 - 1.5 * s[1] + 0.3 * s[2], 0.5 + 0.2 * s[0] - 0.1 * s[2]];
        let (mut anderson, mut s) = (Anderson::default(), vec![0.0; 3]);
        for _ in 0..6 {
            let answer = map(&s);
            s = anderson.next(&s, answer);
        }
        for (s, answer) in s.iter().zip(map(&s)) {
            assert!((s - answer).abs() < 1e-9, "{s} {answer}");
        }
    }
}
