//! Laws, against exact rational arithmetic: every result holds the exact one, larger arguments give larger results, and
//! widths are what `docs/interval-conformance.md` says; for doubles of every size, infinite ends and the empty set.
use d2m_interval::Interval;
use dashu_ratio::RBig;
use proptest::prelude::*;

fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

/// Ordinary, special and any doubles.
fn number() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        3.0,
        0.1,
        5e-324,
        1e-323,
        1.5e-323,
        f64::MIN_POSITIVE,
        1e-300,
        1e-160,
        1.0 + f64::EPSILON,
        1e150,
        1e299,
        1e300,
        1.1e300,
        0.5 * f64::MAX,
        0.6 * f64::MAX,
        f64::MAX.next_down(),
        f64::MAX,
    ]);
    let signed = (special, any::<bool>()).prop_map(|(x, negative)| if negative { -x } else { x });
    prop_oneof![
        3 => signed,
        3 => -4.0..4.0f64,
        2 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite()),
        1 => (-20..20i32).prop_map(|k| f64::from(k) * 5e-324),
    ]
}

fn interval() -> impl Strategy<Value = Interval> {
    let bounded = (number(), number()).prop_map(|(a, b)| Interval::new(a.min(b), a.max(b)));
    let near = (number(), 0..4u32).prop_map(|(a, steps)| {
        let b = (0..steps).fold(a, |x, _| x.next_up());
        if b.is_finite() { Interval::new(a, b) } else { Interval::point(a) }
    });
    prop_oneof![
        8 => bounded,
        4 => near,
        1 => number().prop_map(|a| Interval::new(a, f64::INFINITY)),
        1 => number().prop_map(|a| Interval::new(f64::NEG_INFINITY, a)),
        1 => prop_oneof![Just(Interval::EMPTY), Just(Interval::ENTIRE), Just(Interval::ZERO)],
    ]
}

/// Finite elements: the ends that are numbers, and some between.
fn elements(x: Interval) -> Vec<f64> {
    if x.is_empty() {
        return vec![];
    }
    let inside = [0.0, 1.0, -1.0, 5e-324, x.mid()];
    let ends = [x.lo().max(-f64::MAX), x.hi().min(f64::MAX)];
    inside.into_iter().chain(ends).filter(|e| x.contains(*e)).collect()
}

fn holds(x: Interval, value: &RBig) -> bool {
    !x.is_empty()
        && (x.lo() == f64::NEG_INFINITY || exact(x.lo()) <= *value)
        && (x.hi() == f64::INFINITY || *value <= exact(x.hi()))
}

/// The least double that is not below a number.
fn rounded_up(value: &RBig) -> f64 {
    let mut x = value.to_f64().value();
    while x > -f64::MAX && (x == f64::INFINITY || exact(x.next_down()) >= *value) {
        x = x.next_down();
    }
    if x == f64::NEG_INFINITY {
        return -f64::MAX;
    }
    while x < f64::INFINITY && exact(x) < *value {
        x = x.next_up();
    }
    x
}

/// At most two neighbours, or 2⁻⁵⁰⁰, above the least possible.
fn is_tight_above(hi: f64, value: &RBig) -> bool {
    let tightest = rounded_up(value);
    hi <= tightest.next_up().next_up() || (hi.is_finite() && exact(hi) - value <= exact(2.0_f64.powi(-500)))
}

fn config() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        max_global_rejects: 1 << 20,
        ..ProptestConfig::with_cases(4000)
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn results_hold_the_exact_values(x in interval(), y in interval(), z in interval()) {
        for a in elements(x) {
            prop_assert!(holds(x.sqr(), &(exact(a) * exact(a))));
            prop_assert!(holds(x.abs(), &exact(a.abs())) && holds(-x, &exact(-a)));
            for b in elements(y) {
                let (p, q) = (exact(a), exact(b));
                prop_assert!(holds(x + y, &(&p + &q)), "{:?} + {:?}", x, y);
                prop_assert!(holds(x - y, &(&p - &q)), "{:?} - {:?}", x, y);
                prop_assert!(holds(x * y, &(&p * &q)), "{:?} * {:?}", x, y);
                prop_assert!(holds(x + b, &(&p + &q)) && holds(x * b, &(&p * &q)), "{:?} {:e}", x, b);
                prop_assert!(holds(x.min(y), &exact(a.min(b))) && holds(x.max(y), &exact(a.max(b))));
                prop_assert!(x.hull(y).contains(a) && x.hull(y).contains(b));
                prop_assert_eq!(x.contains(b), x.intersection(y).contains(b));
                if b != 0.0 {
                    let quotient = &p / &q;
                    prop_assert!(holds(x / y, &quotient), "{:?} / {:?}", x, y);
                    let (below, above) = x.div_pair(y);
                    prop_assert!(holds(below, &quotient) || holds(above, &quotient), "{:?} / {:?}", x, y);
                    let (below, above) = y.mul_rev_pair(x);
                    prop_assert!(holds(below, &quotient) || holds(above, &quotient), "{:?} / {:?}", x, y);
                } else if a == 0.0 {
                    prop_assert!(y.mul_rev_pair(x).0.is_entire());
                }
                for c in elements(z) {
                    prop_assert!(holds(x.mul_add(y, z), &(&p * &q + exact(c))), "{:?} {:?} {:?}", x, y, z);
                }
            }
        }
    }

    /// `docs/interval-conformance.md`: `mul_add` within 2 last places or 2⁻⁵⁰⁰, at every magnitude.
    #[test]
    fn fused_products_are_tight(x in interval(), y in interval(), z in interval(), cancel in any::<bool>()) {
        let z = if cancel && (x * y).is_bounded() && !x.is_empty() && !y.is_empty() {
            Interval::point(-(x.lo() * y.lo()).clamp(-f64::MAX, f64::MAX))
        } else {
            z
        };
        let finite = [x, y, z].iter().all(|i| i.is_bounded() && !i.is_empty());
        prop_assume!(finite);
        let products: Vec<RBig> = [x.lo(), x.hi()]
            .iter()
            .flat_map(|a| [y.lo(), y.hi()].map(|b| exact(*a) * exact(b)))
            .collect();
        let (least, greatest) = (products.iter().min().unwrap(), products.iter().max().unwrap());
        let result = x.mul_add(y, z);
        prop_assert!(is_tight_above(result.hi(), &(greatest + exact(z.hi()))), "{:?} {:?} {:?}: {:?}", x, y, z, result);
        prop_assert!(is_tight_above(-result.lo(), &-(least + exact(z.lo()))), "{:?} {:?} {:?}: {:?}", x, y, z, result);
    }

    /// Entire exactly when the first is narrower than the second, tightest otherwise.
    #[test]
    fn cancellation_is_tightest(x in interval(), y in interval()) {
        for (result, y) in [(x.cancel_minus(y), y), (x.cancel_plus(-y), y)] {
            if x.is_empty() && y.is_bounded() {
                prop_assert!(result.is_empty());
            } else if x.is_empty() || y.is_empty() || !x.is_bounded() || !y.is_bounded() {
                prop_assert!(result.is_entire());
            } else if exact(x.hi()) - exact(x.lo()) < exact(y.hi()) - exact(y.lo()) {
                prop_assert!(result.is_entire(), "{:?} {:?}", x, y);
            } else {
                let hi = rounded_up(&(exact(x.hi()) - exact(y.hi())));
                let lo = -rounded_up(&(exact(y.lo()) - exact(x.lo())));
                prop_assert_eq!((result.lo(), result.hi()), (lo, hi), "{:?} {:?}", x, y);
            }
        }
    }

    #[test]
    fn numbers_of_an_interval_are_right(x in interval(), at in number()) {
        let (mid, rad) = (x.mid(), x.rad());
        if x.is_empty() {
            prop_assert!(mid.is_nan() && rad.is_nan() && x.width().is_nan() && x.mag().is_nan() && x.mig().is_nan());
            prop_assert!(x.split(at).0.is_empty() && x.split(at).1.is_empty());
            return Ok(());
        }
        prop_assert!(x.contains(mid));
        let (left, right) = x.split(at);
        prop_assert!(left.lo() == x.lo() && right.hi() == x.hi() && left.hi() == right.lo());
        prop_assert!(left.is_subset(x) && right.is_subset(x));
        prop_assert_eq!(x.split(f64::NAN), x.bisect());
        for a in elements(x) {
            prop_assert!(x.mig() <= a.abs() && a.abs() <= x.mag());
        }
        if x.is_bounded() {
            prop_assert_eq!(x.width(), rounded_up(&(exact(x.hi()) - exact(x.lo()))));
            let farther = (exact(mid) - exact(x.lo())).max(exact(x.hi()) - exact(mid));
            prop_assert_eq!(rad, rounded_up(&farther));
        } else {
            prop_assert!(rad == f64::INFINITY && x.width() == f64::INFINITY && x.mag() == f64::INFINITY);
        }
    }

    /// A part of the argument has a part of the result, up to the slack that each operation needs.
    #[test]
    fn larger_arguments_give_larger_results(x in interval(), y in interval(), more in interval(), other in interval()) {
        let (wide, wider) = (x.hull(more), y.hull(other));
        for (slack, name, part, whole) in [
            (Slack::None, "+", x + y, wide + wider),
            (Slack::None, "-", x - y, wide - wider),
            (Slack::Tiny, "*", x * y, wide * wider),
            (Slack::None, "sqr", x.sqr(), wide.sqr()),
            (Slack::Tiny, "sqrt", x.sqrt(), wide.sqrt()),
            (Slack::None, "abs", x.abs(), wide.abs()),
            (Slack::None, "min", x.min(y), wide.min(wider)),
            (Slack::None, "max", x.max(y), wide.max(wider)),
            (Slack::None, "hull", x.hull(y), wide.hull(wider)),
            (Slack::None, "intersection", x.intersection(y), wide.intersection(wider)),
            (Slack::Tiny, "/", x / y, wide / wider),
            (Slack::Tiny, "mul_add", x.mul_add(y, more), wide.mul_add(wider, more.hull(other))),
            (Slack::Place, "exp", x.exp(), wide.exp()),
            (Slack::Place, "ln", x.ln(), wide.ln()),
            (Slack::Place, "atan", x.atan(), wide.atan()),
            (Slack::Place, "sinh", x.sinh(), wide.sinh()),
            (Slack::None, "floor", x.floor(), wide.floor()),
        ] {
            let whole = slack.around(whole);
            prop_assert!(part.is_subset(whole), "{}: {:?} of {:?} {:?}, {:?} of {:?} {:?}", name, part, x, y, whole, wide, wider);
        }
    }
}

/// By how much the result for a part may stand out of that for the whole.
enum Slack {
    None,
    /// 2⁻⁵⁰⁰: an end that is exactly 0 in special cases.
    Tiny,
    /// One neighbour: an elementary function is one place wider than the tightest for one argument in 250.
    Place,
}

impl Slack {
    fn around(self, x: Interval) -> Interval {
        let tiny = 2.0_f64.powi(-500);
        let (lo, hi) = match self {
            Self::None => return x,
            _ if x.is_empty() => return x,
            Self::Tiny => (x.lo() - tiny, x.hi() + tiny),
            Self::Place => (x.lo().next_down(), x.hi().next_up()),
        };
        Interval::new(lo.min(f64::MAX), hi.max(-f64::MAX))
    }
}

#[test]
fn a_point_is_narrower_than_the_narrowest_interval() {
    let tiny = Interval::new(0.0, 5e-324);
    for x in [1.0, 0.0, 5e-324, 1e300, f64::MAX, -1.0] {
        assert!(Interval::point(x).cancel_minus(tiny).is_entire(), "{x:e}");
        assert!(Interval::point(x).cancel_plus(tiny).is_entire(), "{x:e}");
    }
    let (wide, wider) = (Interval::new(-f64::MAX, 1e300), Interval::new(-f64::MAX, 1e300_f64.next_up()));
    assert!(wide.cancel_minus(wider).is_entire() && !wider.cancel_minus(wide).is_entire());
    let (wide, wider) = (Interval::new(5e-324, f64::MAX), Interval::new(0.0, f64::MAX));
    assert!(wide.cancel_minus(wider).is_entire() && !wider.cancel_minus(wide).is_entire());
}

#[test]
fn fused_products_beyond_1e299() {
    let i = Interval::point;
    // Exactly 2¹⁰⁰⁰ − 2¹⁰⁰⁰ = 0, and 2¹⁰⁰⁰ + 2⁹⁴⁷: two places, not one rounding after another.
    let (a, b) = (2.0_f64.powi(600), 2.0_f64.powi(400));
    let zero = i(a).mul_add(i(b), i(-a * b));
    assert!(zero.contains(0.0) && zero.width() <= 2.0_f64.powi(-499), "{zero:?}");
    let one_more = i(a * (1.0 + f64::EPSILON)).mul_add(i(b * (1.0 + f64::EPSILON)), i(-a * b));
    assert!(one_more.lo() > 0.0 && one_more.width() <= 4.0 * f64::EPSILON * one_more.hi(), "{one_more:?}");
    let far = i(f64::MAX).mul_add(i(5e-324), i(1.0));
    assert!(far.lo() >= 1.0 + 2.0 * f64::EPSILON && far.hi() <= 1.0 + 6.0 * f64::EPSILON, "{far:?}");
    let past = i(f64::MAX).mul_add(i(2.0), i(-f64::MAX));
    assert!(past.hi() >= f64::MAX && past.lo() >= f64::MAX.next_down().next_down(), "{past:?}");
}
