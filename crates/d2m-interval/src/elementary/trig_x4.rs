//! Sine and cosine of four intervals: the kernel of `trig`, on all lower ends and all upper ends.
use super::trig::{CANCELLED, FAST_LIMIT, NEAR, PAD, PAD_TINY, SineCosine, Turned, kernel, reduce, residues};
use crate::IntervalX4;
use d2m_lanes::F64x4;

/// Four numbers, each as an unevaluated sum.
#[derive(Clone, Copy)]
struct Sums {
    high: F64x4,
    low: F64x4,
}

/// Sine and cosine of four numbers, with the quadrants.
struct Point {
    turns: [f64; 4],
    r: [f64; 4],
    sin: Sums,
    cos: Sums,
}

/// None when a number needs the slow path.
#[inline(always)]
fn point(x: F64x4) -> Option<Point> {
    let Turned { turns, r, r_low } = reduce(x);
    let size = x.abs();
    let in_range = size.lt_bits(F64x4::splat(FAST_LIMIT));
    let kept = (size * F64x4::splat(CANCELLED)).le_bits(r.abs());
    if in_range & kept != 15 {
        return None;
    }
    let SineCosine { sin: [s, s_low], cos: [c, c_low] } = kernel(r, r_low);
    let odd = turns.lowest_bit();
    let sign = turns.second_bit_as_sign();
    let sin = Sums { high: odd.select(c, s).xor(sign), low: odd.select(c_low, s_low).xor(sign) };
    let sign = sign.xor(odd.and(F64x4::splat(-0.0)));
    let cos = Sums { high: odd.select(s, c).xor(sign), low: odd.select(s_low, c_low).xor(sign) };
    Some(Point { turns: turns.to_array(), r: r.to_array(), sin, cos })
}

/// Upper bounds of a number and of its negative.
#[inline(always)]
fn bounds(Sums { high, low }: Sums) -> [F64x4; 2] {
    let size = high.abs();
    let pad = size * F64x4::splat(PAD);
    let pad = pad + F64x4::splat(0.0).lt(size).and(F64x4::splat(PAD_TINY));
    [high + (low + pad), -high + (-low + pad)]
}

/// The hull of both, with the extrema (1 where inside, else −2), as (−lo, hi).
#[inline(always)]
fn hull(a: Sums, b: Sums, least: F64x4, greatest: F64x4) -> IntervalX4 {
    let ([a, minus_a], [b, minus_b]) = (bounds(a), bounds(b));
    let one = F64x4::splat(1.0);
    IntervalX4 { neg_lo: minus_a.max(minus_b).min(one).max(least), hi: a.max(b).min(one).max(greatest) }
}

/// Greatest cosine and sine, least cosine and sine: 1 where a multiple of π/2 that has it is between the first and the last one,
/// else −2.
#[cold]
fn extrema(first: [i32; 4], last: [i32; 4]) -> [F64x4; 4] {
    let inside: [u32; 4] = core::array::from_fn(|i| residues(first[i], last[i]));
    let end = |j: u32| F64x4::new(inside.map(|inside| if inside >> j & 1 == 1 { 1.0 } else { -2.0 }));
    [end(0), end(1), end(2), end(3)]
}

impl IntervalX4 {
    /// `(sin x, cos x)`, four at once.
    ///
    /// ```
    /// # use d2m_interval::{Interval, IntervalX4};
    /// let (sin, cos) = IntervalX4::points([0.0, 1.0, 2.0, 3.0]).sin_cos();
    /// assert!(sin.lane(1).contains(1.0_f64.sin()) && cos.lane(3).contains(3.0_f64.cos()));
    /// ```
    #[inline]
    pub fn sin_cos(self) -> (Self, Self) {
        let (Some(a), Some(b)) = (point(-self.neg_lo), point(self.hi)) else {
            return self.sin_cos_slow();
        };
        let quadrant = |turns: f64| turns.to_bits() as i32;
        let first: [i32; 4] = core::array::from_fn(|i| quadrant(a.turns[i]) + i32::from(a.r[i] > NEAR));
        let last: [i32; 4] = core::array::from_fn(|i| quadrant(b.turns[i]) - i32::from(b.r[i] < -NEAR));
        let mut ends = [F64x4::splat(-2.0); 4];
        // No multiple of π/2 is in most narrow intervals.
        if (0..4).any(|i| first[i] <= last[i]) {
            ends = extrema(first, last);
        }
        let [cos_max, sin_max, cos_min, sin_min] = ends;
        (hull(a.sin, b.sin, sin_min, sin_max), hull(a.cos, b.cos, cos_min, cos_max))
    }

    #[cold]
    #[inline(never)]
    fn sin_cos_slow(self) -> (Self, Self) {
        let pairs = self.lanes().map(crate::Interval::sin_cos);
        (Self::new(pairs.map(|p| p.0)), Self::new(pairs.map(|p| p.1)))
    }
}
