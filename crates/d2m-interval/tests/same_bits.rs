//! The same bits on every platform and back end: a checksum over many results, which each run must reproduce
//! (with the vector unit, with `--features scalar`, on other targets).
#![cfg(feature = "glam")]
use d2m_interval::{Interval, IntervalVec3};

struct Sum(u64);

impl Sum {
    fn add(&mut self, x: Interval) {
        // Zeros may differ in sign, where no result depends on it.
        for end in [x.lo() + 0.0, x.hi() + 0.0] {
            self.0 = (self.0 ^ end.to_bits()).wrapping_mul(0x0000_0100_0000_01B3).rotate_left(5);
        }
    }
}

fn checksum(rounds: u32) -> u64 {
    let mut state = 88_172_645_463_325_252_u64;
    let mut next = |scale: i32| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let field = 1023 + (state >> 20) as i32 % scale;
        f64::from_bits(state >> 12 | (field as u64) << 52) * if state & 1 == 0 { 1.0 } else { -1.0 }
    };
    let mut interval = |scale: i32| {
        let (a, b) = (next(scale), next(scale));
        Interval::new(if a < b { a } else { b }, if a < b { b } else { a })
    };
    let mut sum = Sum(0xCBF2_9CE4_8422_2325);
    for round in 0..rounds {
        let scale = if round % 3 == 0 { 300 } else { 5 };
        let (x, y, z) = (interval(scale), interval(scale), interval(scale));
        let (sin, cos) = x.sin_cos();
        for r in [
            x + y,
            x - y,
            x * y,
            x / y,
            x * y.lo(),
            x + y.hi(),
            x.sqr(),
            x.abs().sqrt(),
            sin,
            cos,
            x.tan(),
            x.atan(),
            x.mul_add(y, z),
            x.atan2(y),
            x.abs().ln(),
            x.cbrt(),
            x.powi(5),
            x.sinc(),
            y.versine_ratio(),
            x.asinh(),
            (x * 1e-3).exp(),
            (x * 1e-3).sinh(),
            (x * 1e-2).tanh(),
            x.abs().pow(y * 1e-2),
            x.min(y),
            x.hull(z),
            x.intersection(y),
            sin.asin(),
            cos.acos(),
        ] {
            sum.add(r);
        }
        let (v, w) = (IntervalVec3::new(x, y, z), IntervalVec3::new(z, x, cos));
        for r in [v.dot(w), v.norm_squared(), v.cross(w).x, v.rotated(w, x).y, (v * sin).z] {
            sum.add(r);
        }
    }
    sum.0
}

#[test]
fn checksum_is_reproduced() {
    assert_eq!(checksum(10), 9_092_997_091_106_003_328);
    if !cfg!(miri) {
        assert_eq!(checksum(20_000), 2462420890298871303);
    }
}
