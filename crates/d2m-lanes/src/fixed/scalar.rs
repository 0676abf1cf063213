//! The twin in plain Rust: what the vector back ends must equal, bit for bit.

/// Two doubles. Comparisons with NaN are false; `max(a, b)` is `if a > b { a } else { b }`.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub struct F64x2([f64; 2]);

operators!(F64x2:
    Add add |a, b| a.zip(b, |a, b| a + b),
    Sub sub |a, b| a.zip(b, |a, b| a - b),
    Mul mul |a, b| a.zip(b, |a, b| a * b),
    Div div |a, b| a.zip(b, |a, b| a / b);
    |a| Self(a.0.map(|a| -a)));

const SIGN: u64 = 1 << 63;

#[inline(always)]
fn mask(yes: bool) -> f64 {
    f64::from_bits(if yes { u64::MAX } else { 0 })
}

#[allow(dead_code)] // as a twin in tests, some methods have no other caller
impl F64x2 {
    #[inline(always)]
    pub const fn new(first: f64, second: f64) -> Self {
        Self([first, second])
    }
    /// As [`Self::new`], for values known at run time only.
    #[inline(always)]
    pub fn pack(first: f64, second: f64) -> Self {
        Self([first, second])
    }
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x, x])
    }
    #[inline(always)]
    pub const fn to_array(self) -> [f64; 2] {
        self.0
    }
    #[inline(always)]
    pub fn first(self) -> f64 {
        self.0[0]
    }
    #[inline(always)]
    pub fn second(self) -> f64 {
        self.0[1]
    }
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self([f(self.0[0], o.0[0]), f(self.0[1], o.0[1])])
    }
    #[inline(always)]
    fn zip_bits(self, o: Self, f: impl Fn(u64, u64) -> u64) -> Self {
        self.zip(o, |a, b| f64::from_bits(f(a.to_bits(), b.to_bits())))
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        #[cfg(feature = "std")]
        return Self(self.0.map(f64::sqrt));
        #[cfg(not(feature = "std"))]
        return Self(self.0.map(super::soft_sqrt::sqrt));
    }
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        self.zip(o, |a, b| if a > b { a } else { b })
    }
    /// `if a < b { a } else { b }`.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        self.zip(o, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    /// Negates the first number.
    #[inline(always)]
    pub fn neg_first(self) -> Self {
        Self([-self.0[0], self.0[1]])
    }
    #[inline(always)]
    pub fn swap(self) -> Self {
        Self([self.0[1], self.0[0]])
    }
    #[inline(always)]
    pub fn both_first(self) -> Self {
        Self([self.0[0]; 2])
    }
    #[inline(always)]
    pub fn both_second(self) -> Self {
        Self([self.0[1]; 2])
    }
    /// The first number of `self` and the second of `o`.
    #[inline(always)]
    pub fn first_and_second(self, o: Self) -> Self {
        Self([self.0[0], o.0[1]])
    }
    /// Mask: all bits where `self < o`.
    #[inline(always)]
    pub fn lt(self, o: Self) -> Self {
        self.zip(o, |a, b| mask(a < b))
    }
    /// Mask: all bits where `self <= o`.
    #[inline(always)]
    pub fn le(self, o: Self) -> Self {
        self.zip(o, |a, b| mask(a <= b))
    }
    #[inline(always)]
    pub fn and(self, o: Self) -> Self {
        self.zip_bits(o, |a, b| a & b)
    }
    #[inline(always)]
    pub fn xor(self, o: Self) -> Self {
        self.zip_bits(o, |a, b| a ^ b)
    }
    /// `yes` where the mask `self` is set, else `no`.
    #[inline(always)]
    pub fn select(self, yes: Self, no: Self) -> Self {
        let pick = |i: usize| {
            let m = self.0[i].to_bits();
            f64::from_bits(m & yes.0[i].to_bits() | !m & no.0[i].to_bits())
        };
        Self([pick(0), pick(1)])
    }
    /// Mask: all bits where bit 0 of the number's representation is set.
    #[inline(always)]
    pub fn lowest_bit(self) -> Self {
        Self(self.0.map(|x| mask(x.to_bits() & 1 == 1)))
    }
    /// The sign bit where bit 1 of the number's representation is set, else 0.
    #[inline(always)]
    pub fn second_bit_as_sign(self) -> Self {
        Self(self.0.map(|x| f64::from_bits(x.to_bits() << 62 & SIGN)))
    }
    /// The sign bits, first number in bit 0; of a mask, whether it is set.
    #[inline(always)]
    pub fn sign_bits(self) -> u32 {
        (self.0[0].to_bits() >> 63) as u32 | ((self.0[1].to_bits() >> 63) as u32) << 1
    }
}
