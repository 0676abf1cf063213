//! Sums of two doubles, for positions and times that must not lose digits.

/// An unevaluated sum of two doubles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair(pub(crate) f64, pub(crate) f64);

pub(crate) fn two_sum(a: f64, b: f64) -> Pair {
    let s = a + b;
    let t = s - a;
    Pair(s, (a - (s - t)) + (b - t))
}

fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a; // 2²⁷ + 1
    let high = t - (t - a);
    (high, a - high)
}

pub(crate) fn two_product(a: f64, b: f64) -> Pair {
    let p = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Pair(p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Pair {
    /// The nearest double.
    pub(crate) const fn rounded(self) -> f64 {
        self.0
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let s = two_sum(self.0, other.0);
        two_sum(s.0, s.1 + (self.1 + other.1))
    }
    pub(crate) fn times(self, x: f64) -> Self {
        let p = two_product(self.0, x);
        two_sum(p.0, p.1 + self.1 * x)
    }
    pub(crate) fn mul(self, other: Self) -> Self {
        let p = two_product(self.0, other.0);
        two_sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }
}
