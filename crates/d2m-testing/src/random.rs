//! Small generators of random numbers for tests, each a line of arithmetic.
use glam::{DQuat, DVec3};

/// What is drawn from any generator.
pub trait Draw {
    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    fn unit(&mut self) -> f64;

    /// Uniform in [−1, 1), a multiple of 2⁻⁵².
    fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Uniform in [lo, hi).
    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Its logarithm is uniform, lo > 0.
    fn log_between(&mut self, lo: f64, hi: f64) -> f64 {
        self.between(lo.ln(), hi.ln()).exp()
    }

    /// Uniform in 0 .. count.
    fn index(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Uniform in the cube [−1, 1)³.
    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// Uniform in the unit ball.
    fn ball(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if v.length_squared() <= 1.0 {
                return v;
            }
        }
    }

    /// Uniform on the unit sphere.
    fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.ball();
            if v.length_squared() > 1e-4 {
                return v.normalize();
            }
        }
    }

    /// One of the six directions along the axes, so that many are parallel or orthogonal.
    fn axis(&mut self) -> DVec3 {
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][self.index(3)];
        if self.unit() < 0.5 { axis } else { -axis }
    }

    /// A quaternion of any length up to 2.
    fn quaternion(&mut self) -> DQuat {
        DQuat::from_xyzw(self.signed(), self.signed(), self.signed(), self.signed())
    }

    /// A turn by less than 150°, not normalised: the scalar part is in [0.5, 2.5).
    fn moderate_turn(&mut self) -> DQuat {
        let q = self.quaternion();
        DQuat::from_xyzw(q.x, q.y, q.z, q.w + 1.5)
    }

    /// A turn about a random axis by an angle in [−3.1, 3.1).
    fn turn(&mut self) -> DQuat {
        let axis = self.direction();
        DQuat::from_axis_angle(axis, self.between(-3.1, 3.1))
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014, doi:10.1145/2660193.2660195); the field is its state.
///
/// ```
/// use d2m_testing::{Draw, Random};
/// assert_eq!(Random(1_234_567).bits(), 6_457_827_717_110_365_317);
/// assert!((0.0..1.0).contains(&Random(1).unit()));
/// ```
#[derive(Debug, Clone)]
pub struct Random(pub u64);

impl Random {
    /// A state far from those of neighbouring seeds.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x9e37_79b9_7f4a_7c15)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// One of 0 .. count (nearly uniform for counts far below 2⁶⁴).
    pub fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }
}

impl Draw for Random {
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (0.5_f64).powi(53)
    }
}

/// A linear congruential generator with Knuth's multiplier; the field is its state.
///
/// ```
/// use d2m_testing::{Draw, KnuthRandom};
/// let (mut first, mut again) = (KnuthRandom(7), KnuthRandom(7));
/// assert_eq!(first.vector(), again.vector());
/// ```
#[derive(Debug, Clone)]
pub struct KnuthRandom(pub u64);

impl Draw for KnuthRandom {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 * (0.5_f64).powi(53)
    }
}
