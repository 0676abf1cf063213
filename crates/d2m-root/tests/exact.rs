//! Quadratics and cubics of the isolator against exact rational arithmetic, over the whole range of doubles: nothing that
//! is cut off holds a time in the band, and no bound is late or too high.
mod polynomial;

use d2m_root::{Band, Cubic, Piece, Quadratic};
use dashu_ratio::RBig;
use polynomial::{Polynomial, exact};
use proptest::prelude::*;

/// Doubles of one family: every sign, and exponents around 0, near both ends of the range, or anywhere.
fn number() -> impl Strategy<Value = f64> {
    let exponent = prop_oneof![
        6 => -4..4i32,
        2 => -60..60i32,
        1 => -1074..-1000i32,
        1 => 990..1024i32,
        1 => -520..-500i32,
        1 => 500..520i32,
        1 => -1074..1024i32,
    ];
    let mantissa = prop_oneof![
        3 => (1u64 << 52..1 << 53).boxed(),
        1 => Just(1u64 << 52).boxed(),
        1 => ((1u64 << 53) - 4..1 << 53).boxed(),
    ];
    let size = (mantissa, exponent).prop_map(|(m, e)| {
        // In two steps: the product of powers below 2⁻¹⁰⁷⁴ would vanish.
        let (half, rest) = ((e - 52).div_euclid(2), (e - 52) - (e - 52).div_euclid(2));
        m as f64 * 2.0_f64.powi(half) * 2.0_f64.powi(rest)
    });
    let signed = (size, any::<bool>()).prop_map(|(x, negative)| if negative { -x } else { x });
    prop_oneof![9 => signed, 1 => Just(0.0)].prop_filter("overflow", |x| x.is_finite())
}

fn positive() -> impl Strategy<Value = f64> {
    number().prop_map(f64::abs).prop_filter("zero", |x| *x > 0.0)
}

/// Pieces around zero, beside it, and of one time.
fn piece() -> impl Strategy<Value = Piece> {
    let of = |a: f64, b: f64| Piece { lo: a.min(b), hi: a.max(b) };
    prop_oneof![
        3 => (0.0..1.0f64, 0.0..1.0f64).prop_map(|(a, b)| Piece { lo: -a, hi: b }),
        2 => (-2.0..2.0f64, -2.0..2.0f64).prop_map(move |(a, b)| of(a, b)),
        2 => (number(), number()).prop_map(move |(a, b)| of(a, b)),
        1 => number().prop_map(|a| Piece { lo: a, hi: a }),
        1 => (number(), 1..9u32).prop_map(move |(a, ulps)| of(a, (0..ulps).fold(a, |x, _| x.next_up())))
    ]
    .prop_filter("overflow", |p| p.lo.is_finite() && p.hi.is_finite())
}

/// Within the reach of the functions that take the caller's whole error bound, 2²⁰.
fn bounded_piece() -> impl Strategy<Value = Piece> {
    piece().prop_filter("far", |p| h_of(*p) <= 1_048_576.0)
}

/// The largest |s| of a piece.
fn h_of(piece: Piece) -> f64 {
    piece.lo.abs().max(piece.hi.abs())
}

fn quadratic() -> impl Strategy<Value = Quadratic> {
    (number(), number(), number()).prop_map(|(value, slope, curvature)| Quadratic { value, slope, curvature })
}

/// With a zero at or near a time of the piece, up to the rounding of its value.
fn planted(piece: Piece, part: f64, slope: f64, curvature: f64, jerk: f64) -> Cubic {
    let s = (piece.lo + part * (piece.hi - piece.lo)).clamp(piece.lo, piece.hi);
    Cubic { value: -Cubic { value: 0.0, slope, curvature, jerk }.at(s), slope, curvature, jerk }
}

fn band() -> impl Strategy<Value = Band> {
    prop_oneof![
        3 => Just(Band { lo: 0.0, hi: 0.0 }),
        1 => (number(), number()).prop_map(|(a, b)| Band { lo: a.min(b), hi: a.max(b) }),
        1 => number().prop_map(|hi| Band { lo: f64::NEG_INFINITY, hi })
    ]
}

/// The parts of `whole` that `kept` has cut off, closed.
fn cut_off(whole: Piece, kept: Option<Piece>) -> Vec<Piece> {
    let Some(kept) = kept else { return vec![whole] };
    assert!(whole.lo <= kept.lo && kept.lo <= kept.hi && kept.hi <= whole.hi, "{kept:?} of {whole:?}");
    let mut parts = vec![];
    if kept.lo > whole.lo {
        parts.push(Piece { lo: whole.lo, hi: kept.lo.next_down() });
    }
    if kept.hi < whole.hi {
        parts.push(Piece { lo: kept.hi.next_up(), hi: whole.hi });
    }
    parts
}

/// The band in parts of a polynomial's size, and never less than the isolator distinguishes.
fn assert_outside(p: &Polynomial, band: Band, cut: &[Piece], what: &dyn std::fmt::Debug) {
    for part in cut {
        let above = band.hi < f64::INFINITY && p.minus_constant(band.hi).is_positive(*part);
        let below = band.lo > f64::NEG_INFINITY && p.minus_constant(band.lo).negated().is_positive(*part);
        assert!(above || below, "{what:?}: a time in the band may be in {part:?}");
    }
}

fn config() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        max_global_rejects: 1 << 20,
        ..ProptestConfig::with_cases(10_000)
    }
}

proptest! {
    #![proptest_config(config())]

    /// The bound is not behind the first zero.
    #[test]
    fn first_zeros_are_never_late(gap in positive(), slope in number(), curvature in number()) {
        let bound = Quadratic::bound_first_zero(gap, slope, curvature);
        prop_assert!(bound >= 0.0);
        let p = Polynomial::new(&[gap, slope, 0.5, curvature]);
        let end = if bound == f64::INFINITY { None } else { Some(bound) };
        prop_assert!(p.is_positive_from_zero(end), "{bound:e} for {gap:e} {slope:e} {curvature:e}");
    }

    /// And close to it, whatever the magnitudes, unless the start levels out.
    #[test]
    fn first_zeros_are_close(gap in positive(), slope in number(), curvature in number()) {
        let bound = Quadratic::bound_first_zero(gap, slope, curvature);
        let levels_out = slope < 0.0 && curvature > 0.0;
        if bound.is_finite() && bound < f64::MAX && !levels_out {
            let p = Polynomial::new(&[gap, slope, 0.5, curvature]);
            let later = bound * (1.0 + 1e-14) + 1e-323;
            prop_assert!(
                later.is_infinite() || !p.is_positive_from_zero(Some(later)),
                "{bound:e} for {gap:e} {slope:e} {curvature:e}"
            );
        }
    }

    #[test]
    fn quadratics_lose_no_time_in_the_band(q in quadratic(), band in band(), piece in piece()) {
        let p = Polynomial::new(&[q.value, q.slope, 0.5, q.curvature]);
        assert_outside(&p, band, &cut_off(piece, q.clip(band, piece)), &(q, band, piece));
    }

    #[test]
    fn planted_quadratics_keep_their_zero(
        piece in piece(), part in 0.0..=1.0f64, slope in number(), curvature in number()
    ) {
        let Cubic { value, slope, curvature, .. } = planted(piece, part, slope, curvature, 0.0);
        prop_assume!(value.is_finite());
        let (q, band) = (Quadratic { value, slope, curvature }, Band { lo: 0.0, hi: 0.0 });
        let p = Polynomial::new(&[value, slope, 0.5, curvature]);
        assert_outside(&p, band, &cut_off(piece, q.clip(band, piece)), &(q, piece));
    }

    #[test]
    fn shared_signs_are_shared(
        f in quadratic(), g in quadratic(), margin in prop_oneof![Just(0.0), positive()], piece in piece()
    ) {
        let polynomials = [f, g].map(|q| Polynomial::new(&[q.value, q.slope, 0.5, q.curvature]));
        for part in cut_off(piece, f.clip_shared_sign(&g, margin, piece)) {
            let all = |negative: bool| polynomials.iter().all(|p| {
                let p = if negative { p.negated() } else { p.clone() };
                p.minus_constant(margin).is_positive(part)
            });
            prop_assert!(all(false) || all(true), "{f:?} {g:?} {margin:e} {piece:?}: {part:?}");
        }
    }

    #[test]
    fn lower_bounds_are_not_above(q in quadratic(), piece in piece()) {
        let bound = q.bound_below(piece);
        if bound > f64::NEG_INFINITY {
            prop_assert!(bound < f64::INFINITY);
            let p = Polynomial::new(&[q.value, q.slope, 0.5, q.curvature]);
            prop_assert!(p.minus_constant(bound).is_not_negative(piece), "{bound:e} of {q:?} on {piece:?}");
        }
    }

    #[test]
    fn cubics_lose_no_time_in_the_band(
        piece in piece(), part in 0.0..=1.0f64, slope in number(), curvature in number(), jerk in number(),
        value in prop_oneof![2 => Just(None), 1 => number().prop_map(Some)], band in band()
    ) {
        let near = planted(piece, part, slope, curvature, jerk);
        let cubic = Cubic { value: value.unwrap_or(near.value), ..near };
        prop_assume!(cubic.value.is_finite());
        let kept = cubic.clip(band, |_| 0.0, piece);
        let p = Polynomial::of_cubic(&cubic);
        assert_outside(&p, band, &cut_off(piece, kept), &(cubic, band, piece));
    }

    /// The least error bound that callers may give: that of the evaluation alone, which shrinks with what is left.
    #[test]
    fn the_least_bound_that_covers_is_enough(
        piece in bounded_piece(), part in 0.0..=1.0f64, slope in number(), curvature in number(), jerk in number(),
        value in prop_oneof![3 => Just(None), 1 => number().prop_map(Some)], band in band()
    ) {
        let near = planted(piece, part, slope, curvature, jerk);
        let cubic = Cubic { value: value.unwrap_or(near.value), ..near };
        prop_assume!(cubic.value.is_finite());
        let kept = cubic.clip_beyond(band, |h| cubic.bound_evaluation(h), piece);
        assert_outside(&Polynomial::of_cubic(&cubic), band, &cut_off(piece, kept), &(cubic, band, piece));
        let Cubic { value, slope, curvature, .. } = planted(piece, part, slope, curvature, 0.0);
        let q = Quadratic { value, slope, curvature };
        let least = q.bound_evaluation(h_of(piece));
        prop_assume!(value.is_finite() && least.is_finite());
        let p = Polynomial::new(&[value, slope, 0.5, curvature]);
        assert_outside(&p, band, &cut_off(piece, q.clip_beyond(band, least, piece)), &(q, band, piece));
        prop_assert!(!q.exceeds(least, piece), "{q:?} has a zero in {piece:?} up to rounding");
    }

    /// Quadratics whose zero is in the piece share no sign with themselves there; whose minimum is below the margin do not
    /// exceed it.
    #[test]
    fn quadratics_that_exceed_are_positive(
        q in quadratic(), other in quadratic(), raised in 0.0..1.0f64, piece in bounded_piece()
    ) {
        // Raised to where it is decided by rounding.
        let bound = q.bound_evaluation(h_of(piece));
        let least = q.bound_below(piece);
        prop_assume!(least.is_finite() && bound.is_finite());
        let q = Quadratic { value: q.value - least + (6.0 * raised - 3.0) * bound, ..q };
        prop_assume!(q.value.is_finite());
        let bound = q.bound_evaluation(h_of(piece));
        prop_assume!(bound.is_finite());
        let p = Polynomial::new(&[q.value, q.slope, 0.5, q.curvature]);
        if q.exceeds(bound, piece) {
            prop_assert!(p.is_positive(piece), "{q:?} on {piece:?}");
        }
        let others = other.bound_evaluation(h_of(piece));
        prop_assume!(others.is_finite());
        let least = if others > bound { others } else { bound };
        let polynomials = [p, Polynomial::new(&[other.value, other.slope, 0.5, other.curvature])];
        for part in cut_off(piece, q.clip_shared_sign_beyond(&other, least, piece)) {
            let all = |negative: bool| polynomials.iter().all(|p| {
                if negative { p.negated().is_positive(part) } else { p.is_positive(part) }
            });
            prop_assert!(all(false) || all(true), "{q:?} {other:?} {piece:?}: {part:?}");
        }
    }

    /// Ordinary magnitudes, and zeros at the very ends of pieces that are long on one side.
    #[test]
    fn zeros_at_the_ends_are_kept(
        near in 1e-6..1.0f64, far in 1.0..1e5f64, at_end in any::<bool>(), inside in 0.0..1e-9f64,
        curvature in -1e-3..1e-3f64, jerk in -1e-6..1e-6f64, mirrored in any::<bool>()
    ) {
        let zero = if at_end { near } else { near * (1.0 + inside) };
        let cubic = planted(Piece { lo: zero, hi: zero }, 0.0, 1.0, curvature, jerk);
        let piece = Piece { lo: near, hi: far };
        let (cubic, piece) = if mirrored {
            (Cubic { slope: -cubic.slope, jerk: -cubic.jerk, ..cubic }, Piece { lo: -far, hi: -near })
        } else {
            (cubic, piece)
        };
        let kept = cubic.clip(Band { lo: 0.0, hi: 0.0 }, |_| 0.0, piece);
        let p = Polynomial::of_cubic(&cubic);
        assert_outside(&p, Band { lo: 0.0, hi: 0.0 }, &cut_off(piece, kept), &(cubic, piece));
    }
}

/// The margin that the caller gives counts at every time, also after the piece has shrunk.
#[test]
fn a_linear_function_keeps_its_zero_at_an_end() {
    for i in 0..1000 {
        let (near, far) = (1e-3 * (1.0 + f64::from(i) * 0.00731), 1000.0 + f64::from(i) * 0.317);
        for (zero, lo, hi) in [(near, near, far), (-near, -far, -near)] {
            let linear = Cubic { value: -zero, slope: 1.0, curvature: 0.0, jerk: 0.0 };
            for margin in [0.0, 64.0 * f64::EPSILON] {
                let margin = |h: f64| margin * (near + h);
                let kept = linear.clip(Band { lo: 0.0, hi: 0.0 }, margin, Piece { lo, hi });
                assert!(kept.is_some_and(|k| k.lo <= zero && zero <= k.hi), "{zero} {lo} {hi} {kept:?}");
            }
        }
    }
}

#[test]
fn products_beyond_the_range_of_doubles_are_not_late() {
    let zero = Quadratic::bound_first_zero;
    for (gap, slope, curvature, at) in [
        (1e120, 1.0, -1e200, 1.4142135623730951e-40),
        (1.0, 1e160, -1e200, 2e-40),
        (1e-160, 0.0, -1e-160, std::f64::consts::SQRT_2),
        (1e-161, 0.0, -1.3e-162, 3.9223227027636813),
        (3e-162, 0.0, -1e-162, 2.449489742783178),
        // The product is rounded up by a third, or to zero.
        (0.75, 0.0, -5e-324, 1.224744871391589 * 2.0_f64.powi(537)),
        (0.25, -2.0_f64.powi(-600), -5e-324, std::f64::consts::SQRT_2 * 2.0_f64.powi(536)),
        (5e-324, -5e-324, 0.0, 1.0),
        (f64::MAX, -f64::MAX, 0.0, 1.0),
        (f64::MAX, 0.0, -f64::MAX, std::f64::consts::SQRT_2),
        (1e300, -1e300, -1e300, 0.7320508075688772),
    ] {
        let bound = zero(gap, slope, curvature);
        assert!(bound <= at && bound >= at * (1.0 - 1e-14), "{gap:e} {slope:e} {curvature:e}: {bound:e}");
    }
    // Beyond the largest double: not never.
    assert_eq!(zero(f64::MAX, -5e-324, 0.0), f64::MAX);
    assert_eq!(zero(f64::MAX, 0.0, -5e-324), f64::MAX);
    // Below the smallest.
    assert_eq!(zero(5e-324, -f64::MAX, 0.0), 0.0);
    // Not a gap.
    for gap in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        assert_eq!(zero(gap, 1.0, -1.0), 0.0);
        assert_eq!(zero(gap, 1.0, 1.0), 0.0);
    }
    let q = Quadratic { value: 1e155, slope: 0.0, curvature: -4e155 };
    let kept = q.clip(Band { lo: -1e142, hi: 1e142 }, Piece { lo: 0.0, hi: 1.0 }).expect("a zero");
    let root = std::f64::consts::FRAC_1_SQRT_2;
    assert!(kept.lo <= root && root <= kept.hi, "{kept:?}");
    // s + s²/2 + jerk·s³/6 vanishes at 0, and the cube of the piece's length alone would underflow.
    let cubic = Cubic { value: 0.0, slope: 1.0, curvature: 1.0, jerk: 1e300 };
    let kept = cubic.clip(Band { lo: 0.0, hi: 0.0 }, |_| 0.0, Piece { lo: 0.0, hi: 1e-150 });
    assert!(kept.is_some_and(|k| k.lo == 0.0), "{kept:?}");
}

/// What is not finite cuts nothing.
#[test]
fn odd_coefficients_and_pieces_lose_nothing() {
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -f64::MAX, 0.0, 1.0];
    let pieces = [
        Piece { lo: -1.0, hi: 1.0 },
        Piece { lo: f64::NEG_INFINITY, hi: f64::INFINITY },
        Piece { lo: 0.0, hi: f64::INFINITY },
        Piece { lo: f64::NAN, hi: 1.0 },
        Piece { lo: 0.0, hi: f64::NAN },
    ];
    for value in odd {
        for slope in odd {
            for curvature in odd {
                if [value, slope, curvature].iter().all(|x| x.is_finite()) {
                    continue;
                }
                for piece in pieces {
                    let q = Quadratic { value, slope, curvature };
                    let same = |kept: Option<Piece>| {
                        kept.is_some_and(|k| {
                            k.lo.to_bits() == piece.lo.to_bits() && k.hi.to_bits() == piece.hi.to_bits()
                        })
                    };
                    let zero = Band { lo: 0.0, hi: 0.0 };
                    assert!(same(q.clip(zero, piece)), "{q:?} {piece:?}");
                    assert!(same(q.clip_shared_sign(&q, 0.0, piece)), "{q:?} {piece:?}");
                    let least = q.bound_below(piece);
                    assert!(least.is_nan() || least == f64::NEG_INFINITY, "{q:?} {piece:?} {least}");
                    let cubic = Cubic { value, slope, curvature, jerk: 1.0 };
                    assert!(same(cubic.clip(zero, |_| 0.0, piece)), "{cubic:?} {piece:?}");
                    let finite = Cubic { value: 1.0, slope: 0.0, curvature: 0.0, jerk: 0.0 };
                    assert!(same(finite.clip(zero, |_| f64::NAN, piece)), "{piece:?}");
                }
            }
        }
    }
}

#[test]
fn the_reference_knows_signs() {
    // (x − 1)(x − 2) = 2 − 3x + x².
    let p = Polynomial::new(&[2.0, -3.0, 1.0, 1.0]);
    let on = |lo: f64, hi: f64| p.is_positive(Piece { lo, hi });
    assert!(on(-5.0, 0.999) && on(2.001, 9.0) && !on(0.0, 1.0) && !on(0.0, 3.0) && !on(1.2, 1.3));
    assert_eq!(exact(0.5), RBig::ONE / RBig::from(2));
}

/// Half the smallest number is zero: the piece's end would be evaluated at its start.
#[test]
fn half_of_the_shortest_piece_is_not_exact() {
    let (value, end) = (2.0_f64.powi(-60), f64::from_bits(1));
    let cubic = Cubic { value, slope: -2.0_f64.powi(1014), curvature: 0.0, jerk: 0.0 };
    let (zero, piece) = (Band { lo: 0.0, hi: 0.0 }, Piece { lo: 0.0, hi: end });
    assert_eq!(cubic.at(end), 0.0);
    let kept = cubic.clip(zero, |_| 0.0, piece).expect("the end is a zero");
    assert_eq!(kept.hi, end);
}

/// Callers that bound all errors themselves must cover the rounding of the evaluation: debug builds check it.
#[test]
#[cfg(debug_assertions)]
fn an_error_bound_that_leaves_out_rounding_is_noticed() {
    let quadratic = Quadratic { value: 1.0, slope: -1.0, curvature: 0.0 };
    let (zero, piece) = (Band { lo: 0.0, hi: 0.0 }, Piece { lo: 0.0, hi: 2.0 });
    let enough = quadratic.bound_evaluation(2.0);
    assert!(quadratic.clip_beyond(zero, enough, piece).is_some());
    assert!(std::panic::catch_unwind(|| quadratic.clip_beyond(zero, 0.5 * enough, piece)).is_err());
    let cubic = Cubic { value: 1.0, slope: -1.0, curvature: 0.0, jerk: 0.0 };
    let enough = cubic.bound_evaluation(2.0);
    assert!(cubic.clip_beyond(zero, |_| enough, piece).is_some());
    assert!(std::panic::catch_unwind(|| cubic.clip_beyond(zero, |_| 0.5 * enough, piece)).is_err());
}
