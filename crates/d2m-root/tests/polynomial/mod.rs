//! Polynomials with rational coefficients, and proofs of their sign.
use d2m_root::{Cubic, Piece};
use dashu_ratio::RBig;

pub(crate) fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

/// c₀ + c₁x + c₂x² + c₃x³.
#[derive(Clone, Debug)]
pub(crate) struct Polynomial([RBig; 4]);

impl Polynomial {
    /// value + slope·x + (half·curvature)·x², the last two factors given apart.
    pub(crate) fn new(&[value, slope, half, curvature]: &[f64; 4]) -> Self {
        Self([exact(value), exact(slope), exact(half) * exact(curvature), RBig::ZERO])
    }

    pub(crate) fn of_cubic(c: &Cubic) -> Self {
        let second = exact(c.curvature) / RBig::from(2);
        Self([exact(c.value), exact(c.slope), second, exact(c.jerk) / RBig::from(6)])
    }

    pub(crate) fn minus_constant(&self, x: f64) -> Self {
        let mut result = self.clone();
        result.0[0] = &result.0[0] - exact(x);
        result
    }

    pub(crate) fn negated(&self) -> Self {
        Self(self.0.clone().map(|c| -c))
    }

    fn at(&self, x: &RBig) -> RBig {
        let [a, b, c, d] = &self.0;
        ((d * x + c) * x + b) * x + a
    }

    /// Positive on all of the piece: at its start, and without a zero (Sturm's theorem).
    pub(crate) fn is_positive(&self, on: Piece) -> bool {
        let (lo, hi) = (exact(on.lo), exact(on.hi));
        self.at(&lo) > RBig::ZERO && self.zeros_behind(&lo, &hi) == 0
    }

    /// Not negative on all of the piece, for a polynomial of degree 2.
    pub(crate) fn is_not_negative(&self, on: Piece) -> bool {
        let (lo, hi) = (exact(on.lo), exact(on.hi));
        let [_, b, c, _] = &self.0;
        let arch = *c > RBig::ZERO && {
            let vertex = -b / (c * RBig::from(2));
            lo < vertex && vertex < hi && self.at(&vertex) < RBig::ZERO
        };
        self.at(&lo) >= RBig::ZERO && self.at(&hi) >= RBig::ZERO && !arch
    }

    /// Distinct zeros in (lo, hi].
    fn zeros_behind(&self, lo: &RBig, hi: &RBig) -> usize {
        let mut chain = vec![trimmed(self.0.to_vec())];
        chain.push(trimmed((1..4).map(|k| &self.0[k] * RBig::from(k)).collect()));
        while chain[chain.len() - 1].len() > 1 {
            let rest = remainder(&chain[chain.len() - 2], &chain[chain.len() - 1]);
            chain.push(rest.into_iter().map(|c| -c).collect());
        }
        let changes = |x: &RBig| {
            let values = chain.iter().map(|p| p.iter().rev().fold(RBig::ZERO, |sum, c| sum * x + c));
            let signs: Vec<bool> = values.filter(|v| *v != RBig::ZERO).map(|v| v > RBig::ZERO).collect();
            signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
        };
        changes(lo) - changes(hi)
    }

    /// Positive on [0, end], or for all x ≥ 0, for a polynomial of degree 2.
    pub(crate) fn is_positive_from_zero(&self, end: Option<f64>) -> bool {
        if let Some(end) = end {
            return self.is_positive(Piece { lo: 0.0, hi: end });
        }
        let [a, b, c, _] = &self.0;
        if *a <= RBig::ZERO || *c < RBig::ZERO {
            return false;
        }
        *b >= RBig::ZERO || (*c > RBig::ZERO && b * b < a * c * RBig::from(4))
    }
}

/// Without leading zeros; the lowest coefficient first.
fn trimmed(mut p: Vec<RBig>) -> Vec<RBig> {
    while p.last() == Some(&RBig::ZERO) {
        p.pop();
    }
    p
}

/// What is left of `p` after division by `q`, which has at least two coefficients.
fn remainder(p: &[RBig], q: &[RBig]) -> Vec<RBig> {
    let mut rest = p.to_vec();
    while rest.len() >= q.len() {
        let shift = rest.len() - q.len();
        let factor = &rest[rest.len() - 1] / &q[q.len() - 1];
        for (k, c) in q.iter().enumerate() {
            rest[shift + k] = &rest[shift + k] - &factor * c;
        }
        rest.pop();
        rest = trimmed(rest);
    }
    rest
}
