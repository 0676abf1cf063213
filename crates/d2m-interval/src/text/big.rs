//! Unsigned integers of any size, for exact decimal input: only what parsing needs.
use alloc::vec::Vec;
use core::cmp::Ordering;

/// Little-endian words, without leading zeros.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Big(Vec<u32>);

impl Big {
    pub(super) fn from_u64(x: u64) -> Self {
        let mut big = Self(alloc::vec![x as u32, (x >> 32) as u32]);
        big.trim();
        big
    }

    fn trim(&mut self) {
        while self.0.last() == Some(&0) {
            self.0.pop();
        }
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// `self·factor + term`.
    pub(super) fn push_digit(&mut self, factor: u32, term: u32) {
        let mut carry = u64::from(term);
        for word in &mut self.0 {
            carry += u64::from(*word) * u64::from(factor);
            *word = carry as u32;
            carry >>= 32;
        }
        if carry != 0 {
            self.0.push(carry as u32);
        }
    }

    pub(super) fn times_power(mut self, base: u32, exponent: u32) -> Self {
        for _ in 0..exponent {
            self.push_digit(base, 0);
        }
        self.trim();
        self
    }

    pub(super) fn shifted(&self, bits: u32) -> Self {
        let mut words = alloc::vec![0; (bits / 32) as usize];
        words.extend(&self.0);
        let mut big = Self(words);
        big.push_digit(1 << (bits % 32), 0);
        big.trim();
        big
    }

    pub(super) fn times(&self, o: &Self) -> Self {
        let mut words = alloc::vec![0u32; self.0.len() + o.0.len()];
        for (i, &a) in self.0.iter().enumerate() {
            let mut carry = 0u64;
            for (j, &b) in o.0.iter().enumerate() {
                carry += u64::from(words[i + j]) + u64::from(a) * u64::from(b);
                words[i + j] = carry as u32;
                carry >>= 32;
            }
            words[i + o.0.len()] = carry as u32;
        }
        let mut big = Self(words);
        big.trim();
        big
    }

    pub(super) fn plus(&self, o: &Self) -> Self {
        let (long, short) = if self.0.len() >= o.0.len() { (self, o) } else { (o, self) };
        let (mut words, mut carry) = (Vec::with_capacity(long.0.len() + 1), 0u64);
        for (i, &a) in long.0.iter().enumerate() {
            carry += u64::from(a) + u64::from(short.0.get(i).copied().unwrap_or(0));
            words.push(carry as u32);
            carry >>= 32;
        }
        words.push(carry as u32);
        let mut big = Self(words);
        big.trim();
        big
    }

    /// `self − o` for `self ≥ o`.
    pub(super) fn minus(&self, o: &Self) -> Self {
        let (mut words, mut borrow) = (Vec::with_capacity(self.0.len()), 0i64);
        for (i, &a) in self.0.iter().enumerate() {
            let d = i64::from(a) - i64::from(o.0.get(i).copied().unwrap_or(0)) - borrow;
            borrow = i64::from(d < 0);
            words.push(d as u32);
        }
        let mut big = Self(words);
        big.trim();
        big
    }

    /// Number of binary digits.
    pub(super) fn bits(&self) -> i64 {
        self.0.last().map_or(0, |top| 32 * self.0.len() as i64 - i64::from(top.leading_zeros()))
    }

    /// The first 64 binary digits (fewer when there are fewer), the rest cut off.
    pub(super) fn leading(&self) -> u64 {
        let bits = self.bits();
        let from = (bits - 64).max(0);
        let mut value = 0u64;
        for i in 0..bits.min(64) {
            let at = from + i;
            let bit = self.0[(at / 32) as usize] >> (at % 32) & 1;
            value |= u64::from(bit) << i;
        }
        value
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
