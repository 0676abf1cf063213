//! Unsigned integers of any size, for exact decimal input: only what parsing needs.
//!
//! To the base 10⁹, so that reading decimal digits and multiplying by powers of ten are linear in the digits; a power of
//! two takes one pass for every 32 bits.
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::{Add, Mul, Sub};

/// One word holds nine decimal digits.
const BASE: u64 = 1_000_000_000;
const DIGITS_PER_WORD: usize = 9;

/// Little-endian words below [`BASE`], without leading zeros.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Big(Vec<u32>);

impl Big {
    pub(super) fn from_u64(mut x: u64) -> Self {
        let mut words = Vec::new();
        while x > 0 {
            words.push((x % BASE) as u32);
            x /= BASE;
        }
        Self(words)
    }

    /// From decimal digits (ASCII), the first one first.
    pub(super) fn from_decimal(digits: &[u8]) -> Self {
        let word = |chunk: &[u8]| chunk.iter().fold(0, |n, b| n * 10 + u32::from(b - b'0'));
        Self(digits.rchunks(DIGITS_PER_WORD).map(word).collect()).trimmed()
    }

    fn trimmed(mut self) -> Self {
        while self.0.last() == Some(&0) {
            self.0.pop();
        }
        self
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Words: what an operation costs.
    pub(super) fn words(&self) -> usize {
        self.0.len()
    }

    /// `self·factor + term`, for a factor and a term up to 2³².
    pub(super) fn multiply_add(&mut self, factor: u64, term: u64) {
        let mut carry = term;
        for word in &mut self.0 {
            carry += u64::from(*word) * factor;
            *word = (carry % BASE) as u32;
            carry /= BASE;
        }
        while carry != 0 {
            self.0.push((carry % BASE) as u32);
            carry /= BASE;
        }
    }

    /// `self·10^exponent`.
    pub(super) fn times_power_of_ten(mut self, exponent: usize) -> Self {
        if self.is_zero() {
            return self;
        }
        self.multiply_add(10_u64.pow((exponent % DIGITS_PER_WORD) as u32), 0);
        let mut words = alloc::vec![0; exponent / DIGITS_PER_WORD];
        words.append(&mut self.0);
        Self(words)
    }

    /// `self·2^exponent`.
    pub(super) fn times_power_of_two(mut self, mut exponent: usize) -> Self {
        while exponent > 0 {
            let bits = exponent.min(32);
            self.multiply_add(1 << bits, 0);
            exponent -= bits;
        }
        self
    }

    /// Number of decimal digits; 0 for zero.
    pub(super) fn digits(&self) -> usize {
        let top = self.0.last().map_or(0, |top| top.ilog10() as usize + 1);
        self.0.len().saturating_sub(1) * DIGITS_PER_WORD + top
    }

    /// The first 18 decimal digits, the rest cut off; filled up with zeros when there are fewer.
    pub(super) fn leading(&self) -> u64 {
        // Three words hold at least 19 digits, if there are that many.
        let top = self.0.iter().rev().take(3).fold(0u128, |n, w| n * u128::from(BASE) + u128::from(*w));
        let digits = top.checked_ilog10().map_or(0, |log| log + 1);
        (if digits > 18 { top / 10_u128.pow(digits - 18) } else { top * 10_u128.pow(18 - digits) }) as u64
    }
}

impl Mul for &Big {
    type Output = Big;

    fn mul(self, o: Self) -> Big {
        let mut words = alloc::vec![0u32; self.0.len() + o.0.len()];
        for (i, &a) in self.0.iter().enumerate() {
            let mut carry = 0u64;
            for (j, &b) in o.0.iter().enumerate() {
                carry += u64::from(words[i + j]) + u64::from(a) * u64::from(b);
                words[i + j] = (carry % BASE) as u32;
                carry /= BASE;
            }
            words[i + o.0.len()] = carry as u32;
        }
        Big(words).trimmed()
    }
}

impl Add for &Big {
    type Output = Big;

    fn add(self, o: Self) -> Big {
        let (long, short) = if self.0.len() >= o.0.len() { (self, o) } else { (o, self) };
        let (mut words, mut carry) = (Vec::with_capacity(long.0.len() + 1), 0u64);
        for (i, &a) in long.0.iter().enumerate() {
            carry += u64::from(a) + u64::from(short.0.get(i).copied().unwrap_or(0));
            words.push((carry % BASE) as u32);
            carry /= BASE;
        }
        words.push(carry as u32);
        Big(words).trimmed()
    }
}

/// For a first number that is not less than the second.
impl Sub for &Big {
    type Output = Big;

    fn sub(self, o: Self) -> Big {
        let (mut words, mut borrow) = (Vec::with_capacity(self.0.len()), 0i64);
        for (i, &a) in self.0.iter().enumerate() {
            let d = i64::from(a) - i64::from(o.0.get(i).copied().unwrap_or(0)) - borrow;
            borrow = i64::from(d < 0);
            words.push((d + borrow * BASE as i64) as u32);
        }
        Big(words).trimmed()
    }
}

impl Ord for Big {
    fn cmp(&self, o: &Self) -> Ordering {
        self.0.len().cmp(&o.0.len()).then_with(|| self.0.iter().rev().cmp(o.0.iter().rev()))
    }
}

impl PartialOrd for Big {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        Some(self.cmp(o))
    }
}
