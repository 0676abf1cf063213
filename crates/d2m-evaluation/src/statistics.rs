//! What is said of a list of numbers: quantiles and fitted exponents.

/// Five numbers and the mean, as a box plot shows them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Summary {
    pub(crate) count: usize,
    pub(crate) least: f64,
    pub(crate) lower: f64,
    pub(crate) median: f64,
    pub(crate) upper: f64,
    pub(crate) worst: f64,
    pub(crate) mean: f64,
}

impl Summary {
    /// Of the finite numbers in the list; `None` when there is none.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (&least, &worst) = (sorted.first()?, sorted.last()?);
        let mean = sorted.iter().sum::<f64>() / sorted.len() as f64;
        let at = |q: f64| quantile(&sorted, q);
        Some(Self {
            count: sorted.len(),
            least,
            lower: at(0.25),
            median: at(0.5),
            upper: at(0.75),
            worst,
            mean,
        })
    }
}

/// Linear between neighbours of a sorted, non-empty list.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let place = q * (sorted.len() - 1) as f64;
    let (below, rest) = (place as usize, place.fract());
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (sorted[above] - sorted[below]) * rest
}

/// The exponent e of the power law y = c·xᵉ that fits best in the logarithms (least squares): their covariance over the variance of ln x.
pub(crate) fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let positive = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0);
    let logs: Vec<[f64; 2]> = positive.map(|(x, y)| [x.ln(), y.ln()]).collect();
    if logs.iter().all(|p| p[0] == logs[0][0]) {
        return None;
    }
    let mean = |k: usize| logs.iter().map(|p| p[k]).sum::<f64>() / logs.len() as f64;
    let [x, y] = [0, 1].map(mean);
    let [together, alone] = logs.iter().fold([0.0; 2], |[together, alone], p| {
        [together + (p[0] - x) * (p[1] - y), alone + (p[0] - x) * (p[0] - x)]
    });
    Some(together / alone)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_of_a_known_list() {
        let s = Summary::of([4.0, 1.0, 3.0, f64::INFINITY, 2.0, 5.0]).unwrap();
        assert_eq!(
            (s.count, s.least, s.lower, s.median, s.upper, s.worst, s.mean),
            (5, 1.0, 2.0, 3.0, 4.0, 5.0, 3.0)
        );
        assert_eq!(Summary::of([]), None);
        assert_eq!(Summary::of([7.0]).unwrap().median, 7.0);
        assert_eq!(Summary::of([1.0, 2.0]).unwrap().median, 1.5);
    }

    #[test]
    fn exponent_of_an_exact_law() {
        let law = |x: f64| (x, 7.0 * x.powf(-1.75));
        let e = exponent(&[law(1.0), law(10.0), law(350.0), law(1e6)]).unwrap();
        assert!((e + 1.75).abs() < 1e-12, "{e}");
        assert_eq!(exponent(&[]), None);
        assert_eq!(exponent(&[(1.0, 2.0)]), None);
    }
}
