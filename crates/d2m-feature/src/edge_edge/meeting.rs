//! Where do the lines of two edges meet: inside both edges, certainly outside of one, or may it be either?
use super::products::{TripleProduct, TwoQuadratics};
use crate::rounding::{UNDERFLOW, UP, length_up};
use d2m_motion::{Remainder, TwoJets, TwoVec3};
use d2m_root::{Piece, Quadratic};
use glam::DVec3;

/// The times at which the lines may meet within both edges.
#[derive(Clone, Copy)]
pub(super) struct Within {
    pub(super) part: Piece,
    /// Do they certainly, at all times of the part at which they meet at all, without being parallel?
    pub(super) certain: bool,
}

/// Bounds of what two edges do in a piece.
pub(super) struct Bounds {
    /// Speeds of the difference of the midpoints, and of A's half edge.
    pub(super) speeds: [f64; 2],
    /// Half lengths of A and B.
    pub(super) half_lengths: (f64, f64),
    /// The distance of the midpoints at a contact: both half lengths and the separation.
    pub(super) touching: f64,
}

/// The edges in a part of a piece, along directions that stay what they are at its middle: k = e × d and u = d × k.
///
/// With the difference w of the midpoints, the lines meet inside A's edge where w·u + e·u and w·u − e·u differ in sign, and inside
/// B's where w·(e × k) ± e·u do (features.md, section 5).
pub(super) struct Meeting<'a> {
    bounds: &'a Bounds,
    /// The part, and its middle.
    part: Piece,
    middle: f64,
    /// The part as times from its middle; the same padded, so that it holds every time at which the lines meet.
    centered: Piece,
    padded: Piece,
    /// Its reach, rounded up.
    reach: f64,
    /// The difference of the midpoints and A's half edge, at the middle.
    w: DVec3,
    e: DVec3,
    k: DVec3,
    u: DVec3,
    /// Bounds of the lengths of k and u.
    k_length: f64,
    u_length: f64,
    /// Bounds of what the jets of w and e leave out.
    left_out: [f64; 2],
}

impl<'a> Meeting<'a> {
    /// `part` and `padded` are times from the center of the jets.
    #[inline(always)]
    pub(super) fn new(
        jets: &TwoJets,
        d: DVec3,
        remainders: &[Remainder; 2],
        [part, padded]: [Piece; 2],
        bounds: &'a Bounds,
    ) -> Self {
        let middle = part.mid();
        let s = padded.reach();
        let from_middle = |piece: Piece| Piece { lo: piece.lo - middle, hi: piece.hi - middle };
        let padded = from_middle(padded);
        let there = jets.at(middle);
        let (w, e) = (there.first(), there.second());
        let k = e.cross(d);
        let k_length = length_up(k);
        Self {
            bounds,
            part,
            middle,
            centered: from_middle(part),
            padded,
            reach: padded.reach() * UP,
            w,
            e,
            k,
            u: d.cross(k),
            k_length,
            // At least |u|, and of the size of its rounding when k is all rounding.
            u_length: bounds.half_lengths.1 * k_length * UP,
            left_out: [remainders[0].bound(s), remainders[1].bound(s)],
        }
    }

    /// When the lines may meet within both edges; none: at no time.
    #[inline(always)]
    pub(super) fn within_edges(&self, jets: &TwoJets) -> Option<Within> {
        if self.by_speeds()? { Some(Within { part: self.part, certain: true }) } else { self.by_jets(jets) }
    }

    /// By what the speeds admit: true if the lines certainly meet inside both edges, none if outside of one.
    #[inline(always)]
    fn by_speeds(&self) -> Option<bool> {
        let Self { w, e, k, u, k_length, u_length, reach: r, .. } = *self;
        let [of_w, of_e] = self.left_out;
        let [speed_w, speed_e] = self.bounds.speeds;
        let along_u = TwoVec3::new(w, e).dot(TwoVec3::splat(u));
        let (w_u, e_u, w_j) = (along_u.first(), along_u.second(), w.dot(e.cross(k)));
        let (displacement_w, displacement_e) = (speed_w * r + of_w, speed_e * r + of_e);
        let margin_a = u_length * (displacement_w + displacement_e) * UP;
        let product =
            displacement_w * self.bounds.half_lengths.0 + (length_up(w) + displacement_w) * displacement_e;
        let margin_b = (k_length * product + u_length * displacement_e) * UP;
        let (a, b) = ([w_u + e_u, w_u - e_u], [w_j + e_u, w_j - e_u]);
        let shared =
            |[f, g]: [f64; 2], margin: f64| (f > margin && g > margin) || (f < -margin && g < -margin);
        if shared(a, margin_a) || shared(b, margin_b) {
            return None;
        }
        // The lines are certainly not parallel, and meet certainly inside both edges, for good.
        Some(
            e_u > u_length * displacement_e * UP
                && a[0] > margin_a
                && a[1] < -margin_a
                && b[0] > margin_b
                && b[1] < -margin_b,
        )
    }

    /// The same with jets.
    #[inline(always)]
    fn by_jets(&self, jets: &TwoJets) -> Option<Within> {
        let Self { k, u, k_length, u_length, reach: r, middle, centered, padded, .. } = *self;
        let [of_w, of_e] = self.left_out;
        let cube = (1.0 / 6.0) * (r * r * r);
        let bent = jets.j.dot(jets.j).sqrt();
        let margin_w = (of_w + cube * bent.first() + UNDERFLOW) * UP;
        let margin_e = (of_e + cube * bent.second() + UNDERFLOW) * UP;
        let moved = jets.moved(middle);
        let along_u = TwoQuadratics::along(&moved, u);
        let e_u = along_u.second();
        let first_a = along_u.first() + e_u;
        let second_a = along_u.first() - e_u;
        let margin_a = u_length * (margin_w + margin_e) * UP;
        // The evaluation is covered: of values 122u of the 128u in margin_e and 121u in margin_w, of slopes 182u of 256u
        // (features.md, section 5, "Γ"), each with all 12u of `Quadratic::bound_evaluation` that concern it.
        let beside = first_a.clip_shared_sign_beyond(&second_a, margin_a, centered)?;
        let TripleProduct { cubic: w_j, fourth: quartic_j, .. } = TripleProduct::new(&moved, k);
        let cubic_j = (1.0 / 6.0) * w_j.jerk.abs();
        let w_j = Quadratic { value: w_j.value, slope: w_j.slope, curvature: w_j.curvature };
        let (first_b, second_b) = (w_j + e_u, w_j - e_u);
        // |w| there, up to what its jet admits.
        let length =
            length_up(self.w) + r * (length_up(moved.v.first()) + 0.5 * r * length_up(moved.a.first()));
        let product = margin_w * self.bounds.half_lengths.0 + length * margin_e;
        let margin_b =
            ((cubic_j + quartic_j * r) * (r * r * r) + k_length * product + u_length * margin_e) * UP;
        // Covered: w_j rounds by 117u of the 128u in margin_w (there), e_u as above.
        let inside = first_b.clip_shared_sign_beyond(&second_b, margin_b, beside)?;
        if inside != centered {
            let part = Piece { lo: middle + inside.lo, hi: middle + inside.hi };
            return Some(Within { part, certain: false });
        }
        // Only f has cut: they may be inside for good.
        let certain = e_u.exceeds(u_length * margin_e * UP, padded)
            && first_a.exceeds(margin_a, padded)
            && (-second_a).exceeds(margin_a, padded)
            && first_b.exceeds(margin_b, padded)
            && (-second_b).exceeds(margin_b, padded);
        Some(Within { part: self.part, certain })
    }
}
