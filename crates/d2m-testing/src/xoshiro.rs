//! A small random generator with the same numbers on every machine and in every release.
use crate::Random;
use glam::{DQuat, DVec3};

/// xoshiro256++ (Blackman and Vigna 2021, doi:10.1145/3460772), its state filled by splitmix64.
///
/// No function of the platform's mathematics library is used, so a seed means the same trials everywhere.
#[derive(Debug, Clone)]
pub struct Xoshiro256([u64; 4]);

impl Xoshiro256 {
    /// The generator of this seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        Self(core::array::from_fn(|_| random.bits()))
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        let s = &mut self.0;
        let result = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let shifted = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= shifted;
        s[3] = s[3].rotate_left(45);
        result
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (0.5f64).powi(53)
    }

    /// Uniform in [lo, hi).
    pub fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            let n = v.length_squared();
            if n <= 1.0 && n > 1e-4 {
                return v / n.sqrt();
            }
        }
    }

    /// A rotation uniform over all rotations, unit to rounding.
    pub fn rotation(&mut self) -> DQuat {
        loop {
            let q = [(); 4].map(|()| self.range(-1.0, 1.0));
            let n: f64 = q.iter().map(|c| c * c).sum();
            if n <= 1.0 && n > 1e-4 {
                let s = n.sqrt();
                return DQuat::from_xyzw(q[0] / s, q[1] / s, q[2] / s, q[3] / s);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_numbers() {
        let mut random = Xoshiro256([1, 2, 3, 4]);
        let first = [(); 4].map(|()| random.bits());
        assert_eq!(first, [41_943_041, 58_720_359, 3_588_806_011_781_223, 3_591_011_842_654_386]);
        let state = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!(Xoshiro256::new(1_234_567).0[..3], state);
    }

    #[test]
    fn moments_of_the_unit_interval_and_of_directions() {
        let mut random = Xoshiro256::new(7);
        let n = 100_000;
        let (mut sum, mut squares, mut direction) = (0.0, 0.0, DVec3::ZERO);
        for _ in 0..n {
            let u = random.unit();
            assert!((0.0..1.0).contains(&u));
            sum += u;
            squares += u * u;
            direction += random.direction();
        }
        let n = f64::from(n);
        assert!((sum / n - 0.5).abs() < 4.0 * (1.0 / 12.0 / n).sqrt());
        assert!((squares / n - 1.0 / 3.0).abs() < 4.0 * (4.0 / 45.0 / n).sqrt());
        assert!((direction / n).length() < 5.0 / n.sqrt());
    }
}
