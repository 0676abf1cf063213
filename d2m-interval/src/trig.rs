use crate::{Interval, round::TINY};

// π/2 in three parts: 33 bits, 33 bits, the rest.
const P1: f64 = f64::from_bits(0x3FF9_21FB_5440_0000);
const P2: f64 = f64::from_bits(0x3DD0_B461_1A60_0000);
const P3: f64 = f64::from_bits(0x3BA3_198A_2E03_7073);
const MAGIC: f64 = 6_755_399_441_055_744.0;
const LIMIT: f64 = 524_288.0;
const PAD: f64 = 1.0 / 2_251_799_813_685_248.0; // 2⁻⁵¹

struct Point {
    /// Quadrant of the reduction, `x = n π/2 + r`.
    n: i64,
    r: f64,
    sin: (f64, f64),
    cos: (f64, f64),
}

fn enclose(y: f64, by: f64) -> (f64, f64) {
    let e = y.abs() * PAD + by;
    let (lo, hi) = (y - e, y + e);
    (if lo < -1.0 { -1.0 } else { lo }, if hi > 1.0 { 1.0 } else { hi })
}

/// `|x| < LIMIT`.
fn point(x: f64) -> Point {
    let n = (x * core::f64::consts::FRAC_2_PI + MAGIC) - MAGIC;
    let w = x - n * P1;
    let t = n * P2;
    let r1 = w - t;
    let b = r1 - w;
    let e = (w - (r1 - b)) - (t + b);
    let lo = e - n * P3;
    let r = r1 + lo;
    let r_lo = lo - (r - r1);
    let z = r * r;
    let mut p = 1.0 / 355_687_428_096_000.0;
    for c in [1_307_674_368_000.0, 6_227_020_800.0, 39_916_800.0, 362_880.0, 5040.0, 120.0, 6.0] {
        p = 1.0 / c - z * p;
    }
    let s = r + (r_lo * (1.0 - 0.5 * z) - r * z * p);
    let mut q = 1.0 / 6_402_373_705_728_000.0;
    for c in [20_922_789_888_000.0, 87_178_291_200.0, 479_001_600.0, 3_628_800.0, 40_320.0, 720.0, 24.0] {
        q = 1.0 / c - z * q;
    }
    let hz = 0.5 * z;
    let c0 = 1.0 - hz;
    let c = c0 + (((1.0 - c0) - hz) + (z * z * q - r * r_lo));
    // The reduction is off by at most 2⁻⁹⁷.
    let by = if n == 0.0 { TINY } else { f64::from_bits((1023 - 96) << 52) };
    let (sin, cos) = (enclose(s, by), enclose(c, by));
    let flip = |(lo, hi): (f64, f64)| (-hi, -lo);
    let n = n as i64;
    let (sin, cos) = match n & 3 {
        0 => (sin, cos),
        1 => (cos, flip(sin)),
        2 => (flip(sin), flip(cos)),
        _ => (flip(cos), sin),
    };
    Point { n, r, sin, cos }
}

impl Interval {
    /// `(sin x, cos x)`.
    pub fn sin_cos(self) -> (Self, Self) {
        if self.is_empty() {
            return (self, self);
        }
        let all = Self::raw(-1.0, 1.0);
        if !(self.lo() > -LIMIT && self.hi() < LIMIT) {
            return (all, all);
        }
        let a = point(self.lo());
        let b = point(self.hi());
        // Multiples j of π/2 inside: first..=last, a little generous.
        let near = 1.0 / 1_073_741_824.0;
        let first = if a.r <= near { a.n } else { a.n + 1 };
        let last = if b.r >= -near { b.n } else { b.n - 1 };
        let mut inside = 0u32;
        if last - first >= 3 {
            inside = 15;
        } else {
            let mut j = first;
            while j <= last {
                inside |= 1 << (j & 3);
                j += 1;
            }
        }
        let pick = |u: (f64, f64), v: (f64, f64), max_at: u32, min_at: u32| {
            let hi = if u.1 > v.1 { u.1 } else { v.1 };
            let lo = if u.0 < v.0 { u.0 } else { v.0 };
            Self::raw(
                if inside >> min_at & 1 == 1 { -1.0 } else { lo },
                if inside >> max_at & 1 == 1 { 1.0 } else { hi },
            )
        };
        (pick(a.sin, b.sin, 1, 3), pick(a.cos, b.cos, 0, 2))
    }

    /// `sin x`.
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// `cos x`.
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// `sin x / x`, continued by 1 at 0.
    pub fn sinc(self) -> Self {
        if self.is_empty() {
            return self;
        }
        // Even. On [0, 3.125] it falls; beyond, |sinc x| ≤ 1/x.
        let x = self.abs();
        let at = |x: f64| {
            if x < 1e-4 {
                // 1 − x²/6 ≤ sinc x ≤ 1 − x²/6 + x⁴/120
                let z = Self::point(x).sqr();
                let low = 1.0 - z / Self::point(6.0);
                Self::raw(low.lo(), (low + z.sqr() / 120.0).hi().min(1.0))
            } else if x == f64::INFINITY {
                Self::ZERO
            } else {
                Self::point(x).sin() / Self::point(x)
            }
        };
        if x.hi() <= 3.125 {
            return Self::raw(at(x.hi()).lo(), at(x.lo()).hi());
        }
        // Least value of sinc on the line is −0.21723362…
        let lo = Self::raw(-0.217_233_63, 1.0);
        if x.lo() <= 3.125 {
            return Self::raw(lo.lo(), at(x.lo()).hi());
        }
        (x.sin() / x).intersection(lo)
    }
}
