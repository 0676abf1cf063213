//! The cubic of four points on straight paths: zero when they lie in a plane.
use super::linear::{Lengths, Line};
use crate::rounding::{PRODUCT_UNDERFLOW, UNIT, UP};
use d2m_root::{Band, Cubic, Piece, Quadratic};
use glam::DVec3;

/// Rounding of the triple product in units of 2⁻⁵³·|a||b||c|: 158 are counted in docs/theory/features.md.
const ROUNDING: f64 = 176.0;
/// Rounding of x·(y × n) in units of 2⁻⁵³·|x||y||n|: 46 are counted there.
const ROUNDING_OF_TWO: f64 = 56.0;

/// What bounds of three lines' products allow for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    /// Bound on the error of each line's points.
    pub(super) error: f64,
    /// The distance at which contact begins.
    pub(super) separation: f64,
}

/// `a·(b × c)` of three lines over |s| ≤ h, all four coefficients, and what a contact may have there.
pub(super) struct TripleProduct {
    cubic: Cubic,
    /// `b × c` at s = 0.
    pub(super) normal: DVec3,
    /// What the computed cubic may be at a contact: the wanted separation along `b × c`, and roundings.
    far: f64,
}

impl TripleProduct {
    /// `lengths` are those of the lines.
    #[inline(always)]
    pub(super) fn new([a, b, c]: &[Line; 3], lengths: &[Lengths; 3], h: f64, allowed: Allowed) -> Self {
        let Allowed { error, separation } = allowed;
        let n0 = b.p.cross(c.p);
        let n1 = b.p.cross(c.v) + b.v.cross(c.p);
        let n2 = b.v.cross(c.v);
        let cubic = Cubic {
            value: a.p.dot(n0),
            slope: a.p.dot(n1) + a.v.dot(n0),
            curvature: 2.0 * (a.p.dot(n2) + a.v.dot(n1)),
            jerk: 6.0 * a.v.dot(n2),
        };
        let (la, lb, lc) = (lengths[0].within(h), lengths[1].within(h), lengths[2].within(h));
        let rounding = ROUNDING * UNIT * la * lb * lc + error * (lb * lc + la * lc + la * lb);
        Self { cubic, normal: n0, far: (separation * lb * lc + rounding) * UP + PRODUCT_UNDERFLOW }
    }

    /// Cuts off both ends of a part of |s| ≤ h where a contact is impossible; `None` if that is all of it.
    #[inline(always)]
    pub(super) fn clip(&self, part: Piece) -> Option<Piece> {
        // `far` covers the evaluation: `Cubic::bound_evaluation` takes 11u, 28u, 68u and 144u of the four coefficients' terms, which
        // together are at most the product of the lengths: with 14u before it 158u of 176u (features.md, "Straight paths").
        self.cubic.clip_beyond(Band { lo: 0.0, hi: 0.0 }, |_| self.far, part)
    }

    /// True if the cubic certainly has opposite signs at two times.
    #[inline(always)]
    pub(super) fn changes_sign(&self, between: Piece) -> bool {
        let (first, last) = (self.cubic.at(between.lo), self.cubic.at(between.hi));
        (first > self.far && last < -self.far) || (first < -self.far && last > self.far)
    }
}

/// Scalar products of two lines with a vector, as quadratics with their errors: `x·(y × n)`, `n` fixed.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) quadratic: Quadratic,
    /// What the value may be off, and what a separation changes it by.
    pub(super) margin: f64,
}

impl Seen {
    /// `x·(y × n)` with `across` = y × n, `length` ≥ |n|, and lengths of at least |x| and |y|; a separation moves x by its length.
    #[inline(always)]
    pub(super) fn new(x: &Line, across: &Line, length: f64, [lx, ly]: [f64; 2], allowed: Allowed) -> Self {
        let Allowed { error, separation } = allowed;
        let quadratic = Quadratic {
            value: x.p.dot(across.p),
            slope: x.p.dot(across.v) + x.v.dot(across.p),
            curvature: 2.0 * x.v.dot(across.v),
        };
        let off = ROUNDING_OF_TWO * UNIT * lx * ly + error * (lx + ly + error) + separation * ly;
        Self { quadratic, margin: length * off * UP + PRODUCT_UNDERFLOW }
    }

    /// Certainly positive throughout a piece.
    #[inline(always)]
    pub(super) fn is_positive(&self, piece: Piece) -> bool {
        self.quadratic.exceeds(self.margin, piece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coordinates are integers of 34 bits over 2³⁴, times 64ths: the exact value fits 128 bits.
    #[test]
    fn the_cubic_is_within_its_rounding() {
        let mut state = 5_u64;
        let mut next = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            i128::from(state >> 30) - (1 << 33)
        };
        let scale = (0.5_f64).powi(33);
        let mut worst = 0.0_f64;
        for _ in 0..20_000 {
            let points: [[i128; 6]; 3] = [(); 3].map(|()| [(); 6].map(|()| next()));
            let real = |x: i128| x as f64 * scale;
            let lines = points.map(|q| Line {
                p: DVec3::new(real(q[0]), real(q[1]), real(q[2])),
                v: DVec3::new(real(q[3]), real(q[4]), real(q[5])),
            });
            let volume = TripleProduct::new(
                &lines,
                &[lines[0].lengths(), lines[1].lengths(), lines[2].lengths()],
                0.5,
                Allowed { error: 0.0, separation: 0.0 },
            );
            for j in [-32_i128, -17, 0, 5, 32] {
                let at = |q: &[i128; 6]| [0, 1, 2].map(|i| 64 * q[i] + j * q[i + 3]);
                let [a, b, c] = [at(&points[0]), at(&points[1]), at(&points[2])];
                let product = |i: usize, j: usize, k: usize| a[i] * (b[j] * c[k] - b[k] * c[j]);
                let exact = product(0, 1, 2) + product(1, 2, 0) + product(2, 0, 1);
                let unit = (scale / 64.0).powi(3);
                let value = volume.cubic.at(j as f64 / 64.0);
                // Both to the nearest double: the difference is exact up to some 2⁻⁵³ of the value.
                let error = (value - exact as f64 * unit).abs();
                assert!(error <= volume.far, "{error:e} {:e}", volume.far);
                worst = worst.max(error / volume.far);
            }
        }
        assert!(worst > 0.003, "{worst}");
    }
}
