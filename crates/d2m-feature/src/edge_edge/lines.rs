//! When do the lines of two edges meet? A function of time that is zero then, with proven errors.
use super::meeting::Bounds;
use super::products::TripleProduct;
use crate::rounding::{UP, length_up};
use d2m_motion::{Remainder, TwoJets};
use d2m_root::{Cubic, Piece};
use glam::DVec3;

/// `f = w·(e × d)` of the difference w of the midpoints and the half edges e of A and d of B: zero when the lines meet.
pub(super) struct LinesMeet {
    pub(super) f: Cubic,
    /// Bounds of what its coefficients leave out: of the terms up to s³, of the sum of all in s⁴, and of the products in s⁴ to s⁶.
    low: [f64; 4],
    fourth_sum: f64,
    fourth: f64,
    fifth: f64,
    sixth: f64,
    /// A bound on |w| by what its speed admits.
    farthest: f64,
    /// Remainders of w (with the separation) and of e.
    remainders: [Remainder; 2],
    half_lengths: (f64, f64),
}

impl LinesMeet {
    /// `h`: the reach of the piece; `remainders` those of the jets, the first with the separation.
    #[inline(always)]
    pub(super) fn new(jets: &TwoJets, d: DVec3, remainders: [Remainder; 2], h: f64, bounds: &Bounds) -> Self {
        let TripleProduct { cubic: f, fourth, fifth, sixth } = TripleProduct::new(jets, d);
        let [of_path, of_edge] = &remainders;
        let (half_a, half_b) = bounds.half_lengths;
        // |w| is at most what its speed admits, and at a contact both half edges and the separation; its jet adds its
        // remainder.
        let farthest = length_up(jets.p.first()) + h * bounds.speeds[0];
        let nearer = if farthest < bounds.touching { farthest } else { bounds.touching };
        let apart = nearer + of_path.bound(h);
        let (of_w, of_e) = (half_b * half_a * UP, half_b * apart * UP);
        let both = |w: f64, e: f64| w * of_w + e * of_e;
        Self {
            f,
            low: [
                both(of_path.e0, of_edge.e0),
                both(of_path.e1, of_edge.e1),
                both(of_path.e2, of_edge.e2),
                (1.0 / 6.0) * both(of_path.m3, of_edge.m3),
            ],
            fourth_sum: (1.0 / 24.0) * both(of_path.m4, of_edge.m4) + fourth,
            fourth,
            fifth,
            sixth,
            farthest,
            remainders,
            half_lengths: bounds.half_lengths,
        }
    }

    /// A bound on the error of `f` within `s` of the middle, at every time at which the edges touch.
    #[inline(always)]
    pub(super) fn margin(&self, s: f64) -> f64 {
        let [e0, e1, e2, third] = self.low;
        (e0 + s * (e1 + s * (e2 + s * (third + s * (self.fourth_sum + s * (self.fifth + s * self.sixth))))))
            * UP
    }

    /// True if the function certainly changes its sign between two times: the lines cross.
    #[inline(always)]
    pub(super) fn change_sign(&self, between: Piece) -> bool {
        let s = between.reach();
        let (half_a, half_b) = self.half_lengths;
        let [of_w, of_e] = [self.remainders[0].bound(s), self.remainders[1].bound(s)];
        let product = half_b * (of_w * half_a + (self.farthest + of_w) * of_e);
        let higher = s * s * s * s * (self.fourth + s * (self.fifth + s * self.sixth));
        let margin = (product + higher) * UP;
        let (first, last) = (self.f.at(between.lo), self.f.at(between.hi));
        (first > margin && last < -margin) || (first < -margin && last > margin)
    }
}
