//! Products of two jets that lie side by side: two at a time.
use crate::rounding::PRODUCT_UNDERFLOW;
use d2m_lanes::F64x2;
use d2m_motion::{TwoJets, TwoVec3};
use d2m_root::{Cubic, Piece, Quadratic};
use glam::DVec3;

/// `w·(e × d)` of a path w and a turning direction e: Taylor polynomials multiplied out to third order, and bounds of
/// the coefficients of s⁴, s⁵ and s⁶.
pub(super) struct TripleProduct {
    pub(super) cubic: Cubic,
    pub(super) fourth: f64,
    pub(super) fifth: f64,
    pub(super) sixth: f64,
}

impl TripleProduct {
    /// With kᵢ = eᵢ × d the products wᵢ·kⱼ are what is needed, all sixteen of them: two at a time, i and j of the first
    /// number in the name, then of the second.
    #[inline(always)]
    pub(super) fn new(jets: &TwoJets, d: DVec3) -> Self {
        let d = TwoVec3::splat(d);
        let (w_01, w_23) = (jets.p.firsts(jets.v), jets.a.firsts(jets.j));
        let (k_01, k_23) = (jets.p.seconds(jets.v).cross(d), jets.a.seconds(jets.j).cross(d));
        let (k_10, k_32) = (k_01.swap(), k_23.swap());
        let (p00_11, p01_10) = (w_01.dot(k_01), w_01.dot(k_10));
        let (p02_13, p03_12) = (w_01.dot(k_23), w_01.dot(k_32));
        let (p20_31, p21_30) = (w_23.dot(k_01), w_23.dot(k_10));
        let (p22_33, p23_32) = (w_23.dot(k_23), w_23.dot(k_32));
        let second = p02_13 + p20_31;
        let third = p03_12 + p21_30.swap();
        Self {
            cubic: Cubic {
                value: p00_11.first(),
                slope: p01_10.first() + p01_10.second(),
                curvature: second.first() + 2.0 * p00_11.second(),
                jerk: third.first() + 3.0 * third.second(),
            },
            fourth: ((1.0 / 6.0) * second.second() + 0.25 * p22_33.first()).abs(),
            fifth: ((1.0 / 12.0) * (p23_32.first() + p23_32.second())).abs(),
            sixth: ((1.0 / 36.0) * p22_33.second()).abs(),
        }
    }
}

/// Two quadratics in time, coefficient by coefficient.
pub(super) struct TwoQuadratics {
    pub(super) value: F64x2,
    pub(super) slope: F64x2,
    pub(super) curvature: F64x2,
}

impl TwoQuadratics {
    /// Two jets along a direction. (The third derivatives are left to the remainders.)
    #[inline(always)]
    pub(super) fn along(jets: &TwoJets, d: DVec3) -> Self {
        let d = TwoVec3::splat(d);
        Self { value: jets.p.dot(d), slope: jets.v.dot(d), curvature: jets.a.dot(d) }
    }

    #[inline(always)]
    pub(super) fn first(&self) -> Quadratic {
        let Self { value, slope, curvature } = *self;
        Quadratic { value: value.first(), slope: slope.first(), curvature: curvature.first() }
    }

    #[inline(always)]
    pub(super) fn second(&self) -> Quadratic {
        let Self { value, slope, curvature } = *self;
        Quadratic { value: value.second(), slope: slope.second(), curvature: curvature.second() }
    }

    /// Their sum and the first minus the second (in the other order).
    #[inline(always)]
    pub(super) fn sum_and_difference(&self) -> Self {
        let both = |x: F64x2| x.both_first() + x.both_second().neg_first();
        Self { value: both(self.value), slope: both(self.slope), curvature: both(self.curvature) }
    }

    /// Both are certainly above a margin throughout a piece: [`Quadratic::exceeds`], two at a time, under its hypothesis, which
    /// debug builds check: the margin includes [`Quadratic::bound_evaluation`] of either.
    #[inline(always)]
    pub(super) fn exceed(&self, margin: f64, part: Piece) -> bool {
        debug_assert!([self.first(), self.second()].iter().all(|q| {
            let error = q.bound_evaluation(part.reach());
            !error.is_finite() || margin + PRODUCT_UNDERFLOW >= error || margin.is_nan()
        }));
        let at = |s: f64| {
            let bend = F64x2::splat(0.5) * self.curvature;
            let s = F64x2::splat(s);
            self.value + (self.slope + bend * s) * s
        };
        // The chord minus the sagitta, which errs by 5 roundings; NaN is above nothing.
        let width = part.hi - part.lo;
        let sagitta = self.curvature.max(F64x2::splat(0.0))
            * F64x2::splat(width * width * (0.125 * (1.0 + 4.0 * f64::EPSILON)));
        let margin = F64x2::splat(margin) + sagitta;
        let above = margin.lt(at(part.lo)).and(margin.lt(at(part.hi)));
        above.sign_bits() == 0b11
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::{PathJet, Remainder};
    use d2m_testing::{Draw, Random};
    use dashu_ratio::RBig;

    /// Small integers: every product below is exact, so any order of adding up gives the same bits.
    fn jet(seed: i32) -> PathJet {
        let vector = |k: i32| {
            let component = |i: i32| f64::from((seed * 7 + k * 5 + i * 3 + seed * k * i) % 11 - 5);
            DVec3::new(component(1), component(2), component(3))
        };
        PathJet { p: vector(1), v: vector(2), a: vector(3), j: vector(4), remainder: Remainder::default() }
    }

    #[test]
    fn the_triple_product_is_that_of_the_polynomials() {
        for seed in 1..50 {
            // Divisible by 6, so that a/2 and j/6 are integers too.
            let [mut w, mut e] = [jet(seed), jet(seed + 50)];
            for jet in [&mut w, &mut e] {
                (jet.a, jet.j) = (jet.a * 2.0, jet.j * 6.0);
            }
            let d = jet(seed + 100).p;
            let f = TripleProduct::new(&TwoJets::new(&w, &e), d);
            let coefficients = |jet: &PathJet| [jet.p, jet.v, jet.a * 0.5, jet.j / 6.0];
            let mut expected = [0.0; 7];
            for (i, w) in coefficients(&w).into_iter().enumerate() {
                for (k, e) in coefficients(&e).into_iter().enumerate() {
                    expected[i + k] += w.dot(e.cross(d));
                }
            }
            let Cubic { value, slope, curvature, jerk } = f.cubic;
            assert_eq!([value, slope, 0.5 * curvature, jerk / 6.0], expected[..4]);
            let higher = [f.fourth, f.fifth, f.sixth];
            for (have, want) in higher.into_iter().zip(&expected[4..]) {
                assert!((have - want.abs()).abs() <= 1e-15 * (1.0 + want.abs()), "{have} {want}");
            }
        }
    }

    /// The least of an exact quadratic over a piece, times 4·curvature where that is a vertex: its sign is what counts.
    fn is_positive(q: Quadratic, part: Piece) -> bool {
        let exact = |x: f64| RBig::try_from(x).expect("finite");
        let [c, b, k, lo, hi] = [q.value, q.slope, q.curvature, part.lo, part.hi].map(exact);
        let at = |s: &RBig| &c + (&b + &k * s / RBig::from(2)) * s;
        let vertex = if k > RBig::ZERO { -&b / &k } else { lo.clone() };
        let inside = lo < vertex && vertex < hi;
        at(&lo) > RBig::ZERO && at(&hi) > RBig::ZERO && (!inside || at(&vertex) > RBig::ZERO)
    }

    /// Quadratics that touch zero up to rounding, on pieces of every width: the bound of the evaluation alone is enough.
    #[test]
    fn two_quadratics_that_exceed_are_positive() {
        let mut random = Random::new(3);
        let mut exceeding = 0;
        for _ in 0..20_000 {
            let width = random.log_between(1e-16, 2.0);
            let lo = random.signed() * random.log_between(1e-3, 1.0);
            let part = Piece { lo, hi: lo + width };
            let curvature =
                F64x2::pack(random.signed(), random.unit()) * F64x2::splat(random.log_between(1e-6, 1e6));
            let middle = lo + 0.5 * width;
            // Arches with their vertex in the middle, where the sagitta is sharp, and others.
            let bent = curvature * F64x2::splat(-middle);
            let steep =
                F64x2::pack(random.signed(), random.signed()) * F64x2::splat(random.log_between(1e-6, 1e6));
            let slope = if random.unit() < 0.5 { bent } else { steep };
            let level = TwoQuadratics { value: F64x2::splat(0.0), slope, curvature };
            let least = [level.first(), level.second()].map(|q| q.bound_below(part));
            let larger = Quadratic { value: least[0], ..level.first() }.bound_evaluation(part.reach());
            let larger =
                larger + Quadratic { value: least[1], ..level.second() }.bound_evaluation(part.reach());
            let raised = random.signed() * random.log_between(1.0, 1e3) * larger;
            let value = F64x2::pack(raised - least[0], raised - least[1]);
            let both = TwoQuadratics { value, ..level };
            let quadratics = [both.first(), both.second()];
            let errors = quadratics.map(|q| q.bound_evaluation(part.reach()));
            if both.exceed(errors[0].max(errors[1]), part) {
                exceeding += 1;
                assert!(quadratics.iter().all(|&q| is_positive(q, part)), "{quadratics:?} {part:?}");
            }
        }
        assert!(exceeding > 500, "{exceeding}");
    }

    #[test]
    fn two_quadratics_are_above_what_both_stay_above() {
        let part = Piece { lo: -1.0, hi: 0.5 };
        for seed in 1..50 {
            let jets = TwoJets::new(&jet(seed), &jet(seed + 50));
            let pair = TwoQuadratics::along(&jets, DVec3::new(1.0, -2.0, 1.0));
            let (sum, difference) = (pair.first() + pair.second(), pair.first() - pair.second());
            let both = pair.sum_and_difference();
            let least = [sum, difference].map(|q| q.bound_below(part));
            let least = least[0].min(least[1]);
            // Raised until the least value is above all that is rounded.
            let raised = F64x2::splat(1.0 - least);
            let both = TwoQuadratics { value: both.value + raised, ..both };
            assert!(both.exceed(1.0 - 1e-12 * (1.0 + least.abs()), part));
            assert!(!both.exceed(1.0 + 1e-12 * (1.0 + least.abs()), part));
            // Nothing is above what is not a number, and what is not a number is above nothing.
            assert!(!both.exceed(f64::NAN, part));
            for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let slope = F64x2::pack(broken, 0.0);
                let bent = TwoQuadratics { slope, curvature: slope, ..both };
                assert!(!bent.exceed(1.0, part));
            }
        }
    }
}
