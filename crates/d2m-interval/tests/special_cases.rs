//! This project's own vectors for the special cases: empty, unbounded, zero ends, signed zeros, subnormals, the
//! largest double, extrema inside, huge arguments, domains. Each row: operation, argument, tightest result.
use d2m_interval::{Interval, Overlap};

const INF: f64 = f64::INFINITY;
const MAX: f64 = f64::MAX;
const SUB: f64 = 5e-324;
const EMPTY: Interval = Interval::EMPTY;
const ENTIRE: Interval = Interval::ENTIRE;

fn i(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi)
}

fn rank(x: f64) -> i128 {
    let bits = x.to_bits();
    let size = i128::from(bits & !(1 << 63));
    if bits >> 63 == 1 { -size } else { size }
}

/// The result holds the tightest one and is wider by `ulps` last places, or 2⁻⁵⁰⁰, at most.
#[track_caller]
fn near(result: Interval, tightest: Interval, ulps: i128) {
    assert_eq!(result.is_empty(), tightest.is_empty(), "{result:?}, tightest {tightest:?}");
    assert!(tightest.is_subset(result), "{result:?} loses {tightest:?}");
    for (a, b) in [(result.lo(), tightest.lo()), (result.hi(), tightest.hi())] {
        let far = (rank(a) - rank(b)).abs() > ulps && (a - b).abs() > 3.054_936_363_499_605e-151;
        assert!(a == b || !far, "{result:?}, tightest {tightest:?}");
    }
}

#[test]
fn empty_in_empty_out() {
    let x = i(1.0, 2.0);
    for y in [
        EMPTY + x,
        x - EMPTY,
        EMPTY * ENTIRE,
        x / EMPTY,
        EMPTY / x,
        EMPTY.sqr(),
        EMPTY.sqrt(),
        EMPTY.recip(),
        EMPTY.abs(),
        -EMPTY,
        EMPTY.min(x),
        x.max(EMPTY),
        EMPTY.powi(3),
        EMPTY.powi(0),
        EMPTY.pow(x),
        x.pow(EMPTY),
        EMPTY.exp(),
        EMPTY.ln(),
        EMPTY.sin(),
        EMPTY.cos(),
        EMPTY.tan(),
        EMPTY.asin(),
        EMPTY.acos(),
        EMPTY.atan(),
        EMPTY.atan2(x),
        x.atan2(EMPTY),
        EMPTY.sinh(),
        EMPTY.cosh(),
        EMPTY.tanh(),
        EMPTY.asinh(),
        EMPTY.acosh(),
        EMPTY.atanh(),
        EMPTY.cbrt(),
        EMPTY.sinc(),
        EMPTY.versine_ratio(),
        EMPTY.mul_add(x, x),
        x.mul_add(x, EMPTY),
        EMPTY.floor(),
        EMPTY.sign(),
        EMPTY.intersection(x),
        EMPTY * 2.0,
        EMPTY + 1.0,
        EMPTY.log2(),
        EMPTY.log10(),
        EMPTY.exp2(),
        EMPTY.exp10(),
    ] {
        assert!(y.is_empty(), "{y:?}");
    }
    assert_eq!(EMPTY.hull(x), x);
    assert!(EMPTY.mid().is_nan() && EMPTY.rad().is_nan() && EMPTY.width().is_nan());
    assert!(EMPTY.mag().is_nan() && EMPTY.mig().is_nan());
    assert_eq!((EMPTY.lo(), EMPTY.hi()), (INF, -INF));
}

#[test]
fn unbounded_arguments() {
    let up = i(1.0, INF);
    near(up + i(-INF, 2.0), ENTIRE, 2);
    near(up + i(1.0, 2.0), i(2.0, INF), 2);
    near(up - up, ENTIRE, 2);
    near(up * i(-2.0, 3.0), ENTIRE, 2);
    near(up * i(0.0, 3.0), i(0.0, INF), 2);
    near(ENTIRE * i(0.0, 0.0), i(0.0, 0.0), 2);
    near(i(0.0, INF) * i(-INF, 0.0), i(-INF, 0.0), 2);
    near(up.recip(), i(0.0, 1.0), 2);
    near(up / up, i(0.0, INF), 2);
    near(i(-INF, -1.0).sqr(), up, 2);
    near(up.sqrt(), up, 2);
    near(ENTIRE.abs(), i(0.0, INF), 0);
    near(ENTIRE.exp(), i(0.0, INF), 4);
    near(i(-INF, 0.0).exp(), i(0.0, 1.0), 4);
    near(up.ln(), i(0.0, INF), 4);
    near(ENTIRE.sin(), i(-1.0, 1.0), 4);
    near(up.cos(), i(-1.0, 1.0), 4);
    near(up.tan(), ENTIRE, 4);
    near(ENTIRE.atan(), -Interval::FRAC_PI_2.hull(-Interval::FRAC_PI_2), 4);
    near(ENTIRE.tanh(), i(-1.0, 1.0), 4);
    near(up.sinc().intersection(i(0.5, 1.0)), i(0.5, 0.841_470_984_807_896_5), 1 << 52);
    near(ENTIRE.powi(-2), i(0.0, INF), 2);
    near(i(-INF, -2.0).powi(3), i(-INF, -8.0), 2);
    near(up.pow(ENTIRE), i(0.0, INF), 4);
    near(ENTIRE.cbrt(), ENTIRE, 4);
    near(i(-INF, 2.0).mul_add(i(1.0, 1.0), i(1.0, 1.0)), i(-INF, 3.0), 2);
}

#[test]
fn division_around_zero() {
    near(i(1.0, 2.0) / i(-1.0, 1.0), ENTIRE, 2);
    near(i(1.0, 2.0) / i(0.0, 4.0), i(0.25, INF), 2);
    near(i(1.0, 2.0) / i(-4.0, -0.0), i(-INF, -0.25), 2);
    near(i(-2.0, 1.0) / i(0.0, 4.0), ENTIRE, 2);
    near(i(0.0, 1.0) / i(0.0, 4.0), i(0.0, INF), 2);
    near(i(1.0, 2.0) / i(0.0, 0.0), EMPTY, 2);
    near(i(0.0, 0.0) / i(-1.0, 1.0), i(0.0, 0.0), 2);
    near(i(0.0, 0.0) / i(0.0, 0.0), EMPTY, 2);
    near(i(0.0, 0.0).recip(), EMPTY, 2);
    let (a, b) = i(1.0, 2.0).div_pair(i(-2.0, 4.0));
    near(a, i(-INF, -0.5), 2);
    near(b, i(0.25, INF), 2);
    let (a, b) = i(-2.0, -1.0).div_pair(i(-2.0, 4.0));
    near(a, i(-INF, -0.25), 2);
    near(b, i(0.5, INF), 2);
    assert_eq!(i(-1.0, 1.0).div_pair(i(-2.0, 4.0)), (ENTIRE, EMPTY));
    assert_eq!(i(-1.0, 1.0).mul_rev_pair(i(-2.0, 4.0)), (ENTIRE, EMPTY));
    assert_eq!(i(0.0, 0.0).mul_rev_pair(i(1.0, 2.0)).0, EMPTY);
}

#[test]
fn overflow_and_underflow() {
    near(i(MAX, MAX) + i(MAX, MAX), i(MAX, INF), 2);
    near(i(-MAX, -MAX) * i(2.0, 2.0), i(-INF, -MAX), 2);
    near(i(MAX, MAX) * i(-MAX, MAX), ENTIRE, 2);
    near(i(MAX, MAX).sqr(), i(MAX, INF), 2);
    near(i(SUB, SUB) * i(0.5, 0.5), i(0.0, SUB), 2);
    near(i(SUB, SUB) + i(-SUB, -SUB), i(0.0, 0.0), 2);
    near(i(SUB, SUB).sqr(), i(0.0, SUB), 2);
    assert!(i(SUB, SUB).sqr().lo() >= 0.0);
    near(i(SUB, SUB).recip(), i(MAX, INF), 2);
    near(i(SUB, SUB).sqrt(), i(2.222_758_749_485_077_4e-162, 2.222_758_749_485_077_5e-162), 2);
    near(i(710.0, 710.0).exp(), i(MAX, INF), 4);
    near(i(-800.0, -800.0).exp(), i(0.0, SUB), 4);
    near(i(1024.0, 1024.0).exp2(), i(MAX, INF), 4);
    near(i(-1074.0, -1074.0).exp2(), i(SUB, SUB), 4);
    near(i(SUB, SUB).log2(), i(-1074.0, -1074.0), 4);
    near(i(1e200, 1e200).powi(2), i(MAX, INF), 2);
    near(i(2.0, 2.0).powi(-1074), i(SUB, SUB), 2);
    near(i(711.0, 711.0).sinh(), i(MAX, INF), 4);
    near(i(MAX, MAX).cosh(), i(MAX, INF), 4);
    near(i(MAX, MAX).sqrt(), i(1.340_780_792_994_259_6e154, 1.340_780_792_994_259_7e154), 2);
    near(i(MAX, MAX).cbrt(), i(5.643_803_094_122_361e102, 5.643_803_094_122_362e102), 4);
}

#[test]
fn zero_ends_and_signed_zeros() {
    for zero in [i(0.0, 0.0), i(-0.0, -0.0), i(-0.0, 0.0), i(0.0, -0.0)] {
        assert_eq!(zero, Interval::ZERO);
        assert!(zero.contains(0.0) && zero.contains(-0.0) && zero.contains_zero());
        assert!(!zero.certainly_positive() && !zero.certainly_negative());
        near(zero.sqrt(), zero, 2);
        assert_eq!(zero.sqrt().lo(), 0.0);
        assert_eq!(zero.sin(), zero);
        near(zero.cos(), Interval::ONE, 4);
        assert_eq!(zero.exp(), Interval::ONE);
        assert_eq!(zero.atan(), zero);
        assert_eq!(zero.tan(), zero);
        assert_eq!(zero.sinc(), Interval::ONE);
        assert_eq!(zero.cbrt(), zero);
        assert_eq!(zero.sign(), zero);
        assert_eq!(zero.powi(0), Interval::ONE);
        near(zero.ln(), EMPTY, 4);
        near(zero.powi(-1), EMPTY, 4);
        near(zero.pow(i(0.0, 0.0)), EMPTY, 4);
        near(zero.pow(i(-1.0, 1.0)), zero, 4);
        near(zero.atan2(zero), EMPTY, 4);
    }
    assert_eq!(i(0.0, 1.0).sin().lo(), 0.0);
    near(i(0.0, 1.0).ln(), i(-INF, 0.0), 4);
    near(i(-1.0, 0.0).sqrt(), i(0.0, 0.0), 2);
    near(i(-2.0, -1.0).sqrt(), EMPTY, 2);
}

#[test]
fn extrema_straddled() {
    let quarter = core::f64::consts::FRAC_PI_2;
    // The double below π/2 and the one above: the extremum is between them.
    near(i(quarter, quarter.next_up()).sin(), i(1.0_f64.next_down(), 1.0), 4);
    assert_eq!(i(quarter, quarter.next_up()).sin().hi(), 1.0);
    assert!(i(quarter, quarter).tan().lo() > 1e16);
    assert!(i(quarter, quarter.next_up()).tan().is_entire());
    assert!(i(quarter.next_up(), quarter.next_up()).tan().hi() < -1e15);
    let pi = core::f64::consts::PI;
    near(i(pi, pi).sin(), i(1.224_646_799_147_353e-16, 1.224_646_799_147_353_2e-16), 4);
    near(i(-pi, -pi).sin(), i(-1.224_646_799_147_353_2e-16, -1.224_646_799_147_353e-16), 4);
    assert_eq!(i(3.0, 3.2).cos().lo(), -1.0);
    assert_eq!(i(-0.1, 0.1).cos().hi(), 1.0);
    assert_eq!(i(1.0, 8.0).sin(), i(-1.0, 1.0));
    assert_eq!(i(4.0, 8.0).sin(), i(-1.0, 1.0));
    assert!(i(4.0, 5.0).sin().hi() < -0.75 && i(4.0, 5.0).sin().lo() == -1.0);
    assert_eq!(i(-2.0, 3.0).sqr().lo(), 0.0);
    assert_eq!(i(-2.0, 3.0).cosh().lo(), 1.0);
    assert_eq!(i(-2.0, 3.0).abs(), i(0.0, 3.0));
    assert_eq!(i(-1.0, 1.0).atan2(i(-1.0, 1.0)), i(-Interval::PI.hi(), Interval::PI.hi()));
    // One point: on the branch cut, and elsewhere as a corner of what is wider.
    for zero in [0.0, -0.0] {
        assert_eq!(i(zero, zero).atan2(i(-1.0, -1.0)), Interval::PI);
    }
    for (y, x) in
        [(0.3, 0.7), (2.0, -0.5), (-0.1, 4.0), (-3.0, -1e-9), (1e-300, 1e200), (5.0, 0.0), (-5.0, 0.0)]
    {
        let (point, wider) = (i(y, y).atan2(i(x, x)), i(y, y).atan2(i(x, x.next_up())));
        assert!(point.is_subset(wider) && (point.lo() == wider.lo() || point.hi() == wider.hi()), "{y} {x}");
    }
}

#[test]
fn huge_arguments() {
    // sin(2¹⁰²³·1.999…) and friends: reduced with as many digits of π as it takes.
    near(i(MAX, MAX).sin(), i(0.004_961_954_789_184_061, 0.004_961_954_789_184_062), 4);
    near(i(MAX, MAX).cos(), i(-0.999_987_689_426_56, -0.999_987_689_426_559_9), 8);
    near(i(1e22, 1e22).sin(), i(-0.852_200_849_767_188_9, -0.852_200_849_767_188_8), 4);
    assert_eq!(i(1e22, 1.000_001e22).sin(), i(-1.0, 1.0));
    let x = 524_288.0_f64;
    for x in [x, x.next_down(), x.next_up(), 1e6, 1e300, 2.0_f64.powi(1000)] {
        let (s, c) = i(x, x).sin_cos();
        let one = s.sqr() + c.sqr();
        assert!(one.contains(1.0) && one.width() < 1e-14, "{x}");
    }
}

#[test]
fn domains_are_clipped() {
    near(i(-4.0, 4.0).asin(), -Interval::FRAC_PI_2.hull(-Interval::FRAC_PI_2), 4);
    near(i(2.0, 3.0).asin(), EMPTY, 4);
    near(i(-3.0, 1.0).acos(), i(0.0, Interval::PI.hi()), 4);
    near(i(-3.0, 1.0).ln(), i(-INF, 0.0), 4);
    near(i(0.0, 0.5).acosh(), EMPTY, 4);
    near(i(0.0, 1.0).acosh(), i(0.0, 0.0), 4);
    near(i(-1.0, 1.0).atanh(), ENTIRE, 4);
    near(i(1.0, 2.0).atanh(), EMPTY, 4);
    near(i(-3.0, 4.0).pow(i(0.5, 0.5)), i(0.0, 2.0), 4);
    near(i(0.0, 4.0).pow(i(-0.5, -0.5)), i(0.5, INF), 4);
}

#[test]
fn numbers_of_an_interval() {
    assert_eq!(ENTIRE.mid(), 0.0);
    assert_eq!(i(-INF, 5.0).mid(), -MAX);
    assert_eq!(i(5.0, INF).mid(), MAX);
    assert_eq!(i(MAX, MAX).mid(), MAX);
    assert_eq!(i(0.0, SUB).mid(), 0.0);
    assert_eq!(i(0.0, 3.0 * SUB).mid(), 2.0 * SUB);
    assert_eq!(i(-MAX, MAX).width(), INF);
    assert_eq!(i(-MAX, MAX).rad(), MAX);
    assert_eq!(i(1.0, 1.0 + f64::EPSILON).width(), f64::EPSILON);
    assert_eq!(i(-1.0, 1.0e-20).width(), 1.0_f64.next_up());
    assert_eq!(i(-3.0, 2.0).mag(), 3.0);
    assert_eq!(i(-3.0, 2.0).mig(), 0.0);
    assert_eq!(i(-3.0, -2.0).mig(), 2.0);
    for x in [i(0.1, 0.7), i(-1e300, 1e-300), i(-1.0, 1.0 + f64::EPSILON)] {
        let (m, r) = (x.mid(), x.rad());
        assert!(x.is_subset(Interval::point(m) + i(-r, r)));
    }
}

#[test]
fn comparisons_with_infinite_ends() {
    assert!(
        ENTIRE.is_interior(ENTIRE)
            && i(1.0, INF).is_interior(i(0.0, INF))
            && !i(1.0, 2.0).is_interior(i(1.0, 3.0))
    );
    assert!(EMPTY.is_interior(EMPTY) && EMPTY.is_subset(EMPTY) && !ENTIRE.is_subset(EMPTY));
    assert!(EMPTY.less(EMPTY) && !EMPTY.less(ENTIRE) && ENTIRE.strictly_less(ENTIRE));
    assert!(EMPTY.precedes(ENTIRE) && EMPTY.strictly_precedes(EMPTY) && EMPTY.is_disjoint(EMPTY));
    assert!(i(-INF, 0.0).precedes(i(0.0, INF)) && !i(-INF, 0.0).strictly_precedes(i(0.0, INF)));
    assert!(!ENTIRE.contains(INF) && !ENTIRE.contains(f64::NAN) && !EMPTY.contains(0.0));
    assert!(!i(1.0, 2.0).possibly_less(i(0.0, 1.0)) && i(1.0, 2.0).possibly_less(i(0.0, 1.5)));
}

#[test]
fn every_overlap_state() {
    let x = i(1.0, 4.0);
    for (y, state) in [
        (EMPTY, Overlap::SecondEmpty),
        (i(5.0, 6.0), Overlap::Before),
        (i(4.0, 6.0), Overlap::Meets),
        (i(3.0, 6.0), Overlap::Overlaps),
        (i(1.0, 6.0), Overlap::Starts),
        (i(0.0, 6.0), Overlap::ContainedBy),
        (i(0.0, 4.0), Overlap::Finishes),
        (x, Overlap::Equals),
        (i(2.0, 4.0), Overlap::FinishedBy),
        (i(2.0, 3.0), Overlap::Contains),
        (i(1.0, 3.0), Overlap::StartedBy),
        (i(0.0, 3.0), Overlap::OverlappedBy),
        (i(0.0, 1.0), Overlap::MetBy),
        (i(-1.0, 0.0), Overlap::After),
    ] {
        assert_eq!(x.overlap(y), state, "{y:?}");
    }
    assert_eq!(EMPTY.overlap(x), Overlap::FirstEmpty);
    assert_eq!(EMPTY.overlap(EMPTY), Overlap::BothEmpty);
    assert_eq!(i(1.0, 1.0).overlap(x), Overlap::Starts);
    assert_eq!(i(4.0, 4.0).overlap(x), Overlap::Finishes);
}

#[test]
fn rounding_to_integers() {
    let x = i(-2.5, 2.5);
    assert_eq!(x.round_ties_even(), i(-2.0, 2.0));
    assert_eq!(x.round_ties_away(), i(-3.0, 3.0));
    assert_eq!(x.trunc(), i(-2.0, 2.0));
    assert_eq!(x.floor(), i(-3.0, 2.0));
    assert_eq!(x.ceil(), i(-2.0, 3.0));
    assert_eq!(i(0.49999999999999994, 4503599627370497.5).round_ties_away(), i(0.0, 4503599627370498.0));
    assert_eq!(i(-INF, -0.1).sign(), i(-1.0, -1.0));
    assert_eq!(i(-INF, 1e300).floor(), i(-INF, 1e300));
}

#[test]
fn cancellation_recovers_summands() {
    near(i(1.0, 5.0).cancel_minus(i(0.0, 2.0)), i(1.0, 3.0), 2);
    assert_eq!(i(1.0, 2.0).cancel_minus(i(0.0, 2.0)), ENTIRE);
    assert_eq!(EMPTY.cancel_minus(i(0.0, 2.0)), EMPTY);
    assert_eq!(ENTIRE.cancel_minus(i(0.0, 2.0)), ENTIRE);
    near(i(1.0, 5.0).cancel_plus(i(0.0, 2.0)), i(3.0, 5.0), 2);
    let (x, y) = (i(0.1, 0.2), i(0.3, 0.5));
    assert!(x.is_subset((x + y).cancel_minus(y)));
}
