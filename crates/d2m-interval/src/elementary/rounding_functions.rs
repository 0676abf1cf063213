//! Step functions: sign, and rounding to integers. All exact.
use crate::Interval;

/// Every double of at least this size is an integer: 2⁵².
const INTEGERS: f64 = 4_503_599_627_370_496.0;

fn trunc(x: f64) -> f64 {
    if x.abs() < INTEGERS { x as i64 as f64 } else { x }
}

fn floor(x: f64) -> f64 {
    let t = trunc(x);
    if t > x { t - 1.0 } else { t }
}

fn ceil(x: f64) -> f64 {
    -floor(-x)
}

fn ties_to_even(x: f64) -> f64 {
    if x.abs() < INTEGERS {
        // The sum rounds to an integer, ties to even.
        if x < 0.0 { (x - INTEGERS) + INTEGERS } else { (x + INTEGERS) - INTEGERS }
    } else {
        x
    }
}

fn ties_to_away(x: f64) -> f64 {
    let t = trunc(x);
    // |x − t| is exact.
    if (x - t).abs() >= 0.5 { t + if x < 0.0 { -1.0 } else { 1.0 } } else { t }
}

impl Interval {
    fn step(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_empty() { self } else { Self::raw(f(self.lo()), f(self.hi())) }
    }

    /// `⌊x⌋`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert_eq!(Interval::new(-0.5, 2.5).floor(), Interval::new(-1.0, 2.0));
    /// ```
    pub fn floor(self) -> Self {
        self.step(floor)
    }

    /// `⌈x⌉`.
    pub fn ceil(self) -> Self {
        self.step(ceil)
    }

    /// The integer part, towards zero.
    pub fn trunc(self) -> Self {
        self.step(trunc)
    }

    /// The nearest integer, ties to even.
    pub fn round_ties_even(self) -> Self {
        self.step(ties_to_even)
    }

    /// The nearest integer, ties away from zero.
    pub fn round_ties_away(self) -> Self {
        self.step(ties_to_away)
    }

    /// The sign: −1, 0 or 1.
    pub fn sign(self) -> Self {
        self.step(|x| f64::from(i8::from(x > 0.0) - i8::from(x < 0.0)))
    }
}
