//! First zeros of polynomials with planted roots (exact: small multiples of a power of two), and of what cannot be decided.
use d2m_interval::Interval;
use d2m_root::{
    Differentiable, FirstZero, Gamma, InclusionFunction, IntervalFunction, RootSearch, SearchLimits,
    SecondOrder, ZeroEvidence, bboi, first_zero, hrfoi,
};
use d2m_testing::{Draw, Random};
use proptest::prelude::*;

/// A multiple of 2⁻¹⁰ in [−1, 1].
fn root(random: &mut Random) -> f64 {
    (random.unit() * 2048.0 - 1024.0).round() / 1024.0
}

/// scale·Π(t − rᵢ) + lift, as a product: its zeros are exactly the rᵢ when lift = 0.
struct Polynomial {
    roots: Vec<f64>,
    scale: f64,
    lift: f64,
}

impl IntervalFunction for Polynomial {
    fn enclose(&mut self, t: Interval) -> Interval {
        self.roots.iter().map(|r| t - *r).product::<Interval>() * self.scale + self.lift
    }
}

impl Differentiable for Polynomial {
    fn enclose_derivative(&mut self, t: Interval) -> Interval {
        let without = |i: usize| -> Interval {
            let others = self.roots.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, r)| t - *r).product()
        };
        (0..self.roots.len()).map(without).sum::<Interval>() * self.scale
    }
}

#[test]
fn planted_zeros_are_found_first_and_proven() {
    let mut random = Random(1);
    let (mut unique, mut none) = (0, 0);
    for i in 0..20_000 {
        let mut roots: Vec<f64> = (0..=i % 6).map(|_| root(&mut random)).collect();
        roots.sort_by(f64::total_cmp);
        roots.dedup();
        let scale = [1.0, -3.0, 1e-8, 1e8][i % 4];
        let (lo, hi) = (root(&mut random) - 0.1, root(&mut random) + 0.1);
        let domain = Interval::new(lo.min(hi), lo.max(hi));
        let first = roots.iter().copied().find(|r| domain.contains(*r));
        let mut f = Polynomial { roots: roots.clone(), scale, lift: 0.0 };
        match first_zero(&mut f, domain, SearchLimits::new(1e-12)) {
            FirstZero::None => {
                assert_eq!(first, None, "{roots:?} {domain:?}");
                none += 1;
            }
            FirstZero::Found { bracket, evidence } => {
                let first = first.unwrap_or_else(|| panic!("{bracket:?} {roots:?} {domain:?}"));
                assert!(bracket.contains(first), "{bracket:?} {evidence:?} {roots:?} {domain:?}");
                assert!(bracket.is_subset(domain) && bracket.width() < 1e-10, "{bracket:?} {roots:?}");
                unique += usize::from(evidence == ZeroEvidence::Unique);
                if evidence == ZeroEvidence::Unique {
                    assert_eq!(roots.iter().filter(|r| bracket.contains(**r)).count(), 1);
                }
            }
            FirstZero::Undecided { .. } => panic!("{roots:?} {domain:?}"),
        }
    }
    assert!(none > 3000 && unique + none > 19_800, "{unique} unique, {none} without");
}

#[test]
fn double_zeros_and_near_misses_are_not_called_proven() {
    let mut random = Random(2);
    let mut early = 0;
    for i in 0..2000 {
        let double = root(&mut random);
        // Simple roots behind it, so that what is found first matters.
        let later = double + 0.25 + random.unit().round() * 0.5;
        let lift = [0.0, 1e-300, 0.0][i % 3];
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let mut f = Polynomial { roots: vec![double, double, later], scale: -sign, lift: sign * lift };
        let domain = Interval::new(double - 0.5, double + 2.0);
        let found = first_zero(&mut f, domain, SearchLimits::new(1e-9));
        let FirstZero::Found { bracket, evidence } = found else { panic!("{found:?}") };
        assert!(bracket.lo() <= double, "{bracket:?} {double}");
        assert_eq!(evidence, ZeroEvidence::Undecided, "{bracket:?} {double}");
        early += usize::from(bracket.lo() < double - 1e-6);
    }
    assert_eq!(early, 0);
}

#[test]
fn ends_budgets_and_odd_functions() {
    // A zero at the very start, at the very end, and a domain of one moment.
    for (domain, at) in [((0.0, 1.0), 0.0), ((-1.0, 0.0), 0.0), ((0.0, 0.0), 0.0)] {
        let mut f = Polynomial { roots: vec![at], scale: 1.0, lift: 0.0 };
        let found = first_zero(&mut f, Interval::new(domain.0, domain.1), SearchLimits::new(1e-12));
        assert!(matches!(found, FirstZero::Found { bracket, .. } if bracket.contains(at)), "{found:?}");
    }
    // A near miss within a budget of ten evaluations: what is clear is reported.
    let mut f = Polynomial { roots: vec![0.5, 0.5], scale: 1.0, lift: 1e-13 };
    let limits = SearchLimits::new(0.0).with_evaluations(10);
    let FirstZero::Undecided { clear_until } = first_zero(&mut f, Interval::new(0.0, 1.0), limits) else {
        panic!("ten evaluations do not decide this")
    };
    assert!((0.2..0.5).contains(&clear_until), "{clear_until}");
    // With enough of them the miss is proven.
    let limits = SearchLimits::new(0.0);
    assert_eq!(first_zero(&mut f, Interval::new(0.0, 1.0), limits), FirstZero::None);

    /// Knows nothing of itself.
    struct Blind;
    impl IntervalFunction for Blind {
        fn enclose(&mut self, _: Interval) -> Interval {
            Interval::ENTIRE
        }
    }
    impl Differentiable for Blind {
        fn enclose_derivative(&mut self, _: Interval) -> Interval {
            Interval::ENTIRE
        }
    }
    let found = first_zero(&mut Blind, Interval::new(0.0, 1.0), SearchLimits::new(1e-3));
    let FirstZero::Found { bracket, evidence } = found else { panic!("{found:?}") };
    assert_eq!((bracket.lo(), evidence), (0.0, ZeroEvidence::Undecided));
}

/// √t + c, known only where t ≥ 0.
struct Root(f64);

impl IntervalFunction for Root {
    fn enclose(&mut self, t: Interval) -> Interval {
        t.sqrt() + self.0
    }
}

impl Differentiable for Root {
    fn enclose_derivative(&mut self, t: Interval) -> Interval {
        0.5 / t.sqrt()
    }
}

impl Gamma for Root {
    fn may_touch(&mut self, _: Interval) -> bool {
        true
    }
}

/// An empty enclosure is positive and negative at once, and used to exclude a piece.
#[test]
fn where_a_function_is_not_defined_nothing_is_excluded() {
    let limits = SearchLimits::new(1e-9);
    for domain in [Interval::new(-1.0, 4.0), Interval::new(f64::NEG_INFINITY, 4.0), Interval::ENTIRE] {
        let found = first_zero(&mut Root(-1.0), domain, limits);
        let FirstZero::Found { bracket, evidence } = found else { panic!("{found:?}") };
        assert!(bracket.lo() <= 1.0 && (evidence == ZeroEvidence::Undecided || bracket.contains(1.0)));
        let RootSearch::Bracket(bracket) = bboi(&mut Root(-1.0), domain, limits) else {
            panic!("no bracket")
        };
        assert!(bracket.lo() <= 1.0);
    }
    let found = first_zero(&mut Root(-1.0), Interval::new(0.0, 4.0), limits);
    let FirstZero::Found { bracket, evidence: ZeroEvidence::Unique } = found else { panic!("{found:?}") };
    assert!(bracket.contains(1.0) && bracket.width() < 1e-9);
    // √t + 1/16 has no zero: the start of its domain of definition is never called one.
    for lo in [-1.0, -100.0, -1e300, f64::NEG_INFINITY] {
        match first_zero(&mut Root(0.0625), Interval::new(lo, 4.0), limits) {
            FirstZero::Found { evidence, .. } => assert_eq!(evidence, ZeroEvidence::Undecided),
            other => assert_eq!(other, FirstZero::None),
        }
    }
    /// The same, too wide to exclude a zero: monotone where it is defined, and Newton's step stays in the domain.
    struct Wide;
    impl IntervalFunction for Wide {
        fn enclose(&mut self, t: Interval) -> Interval {
            t.sqrt() + 0.0625 + (t - t)
        }
    }
    impl Differentiable for Wide {
        fn enclose_derivative(&mut self, t: Interval) -> Interval {
            0.5 / t.sqrt()
        }
    }
    for domain in [Interval::new(-30.0, 40.0), Interval::new(f64::NEG_INFINITY, 1e300)] {
        match first_zero(&mut Wide, domain, limits) {
            FirstZero::Found { evidence, .. } => assert_eq!(evidence, ZeroEvidence::Undecided),
            other => assert_eq!(other, FirstZero::None),
        }
    }
    /// Defined nowhere.
    struct Nowhere;
    impl IntervalFunction for Nowhere {
        fn enclose(&mut self, _: Interval) -> Interval {
            Interval::EMPTY
        }
    }
    impl Differentiable for Nowhere {
        fn enclose_derivative(&mut self, _: Interval) -> Interval {
            Interval::EMPTY
        }
    }
    impl SecondOrder for Nowhere {
        fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
            InclusionFunction::new(Interval::EMPTY, Interval::EMPTY, Interval::EMPTY, t)
        }
    }
    impl Gamma for Nowhere {
        fn may_touch(&mut self, _: Interval) -> bool {
            true
        }
    }
    for domain in [Interval::UNIT, Interval::ENTIRE] {
        let found = first_zero(&mut Nowhere, domain, limits);
        assert!(matches!(found, FirstZero::Found { evidence: ZeroEvidence::Undecided, .. }), "{found:?}");
        for found in [bboi(&mut Nowhere, domain, limits), hrfoi(&mut Nowhere, domain, limits)] {
            assert!(matches!(found, RootSearch::Bracket(b) if b.lo() == domain.lo()), "{found:?}");
        }
    }
    assert_eq!(first_zero(&mut Nowhere, Interval::EMPTY, limits), FirstZero::None);
    assert_eq!(bboi(&mut Nowhere, Interval::EMPTY, limits), RootSearch::None);
    assert_eq!(hrfoi(&mut Nowhere, Interval::EMPTY, limits), RootSearch::None);
}

impl Gamma for Polynomial {
    fn may_touch(&mut self, _: Interval) -> bool {
        true
    }
}

impl SecondOrder for Polynomial {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        let start = Interval::point(t.lo());
        let n = self.roots.len();
        let without = |i: usize, k: usize| -> Interval {
            let others = self.roots.iter().enumerate().filter(|(j, _)| *j != i && *j != k);
            others.map(|(_, r)| t - *r).product()
        };
        let pairs = (0..n).flat_map(|i| (0..n).filter(move |k| *k != i).map(move |k| (i, k)));
        let bend = pairs.map(|(i, k)| without(i, k)).sum::<Interval>() * self.scale;
        InclusionFunction::new(self.enclose(start), self.enclose_derivative(start), bend, t)
    }
}

/// Unbounded domains are searched to the requested width, and nothing unbounded is called unique.
#[test]
fn unbounded_domains_are_searched_to_the_end() {
    let inf = f64::INFINITY;
    let cases: [(Interval, Vec<f64>); 7] = [
        (Interval::new(-1.0, inf), vec![3.0, 4.0]),
        (Interval::ENTIRE, vec![3.0]),
        (Interval::ENTIRE, vec![-1e300]),
        (Interval::ENTIRE, vec![5e-324]),
        (Interval::new(0.0, inf), vec![1e200, 2e200]),
        (Interval::new(-inf, 1.0), vec![-5.0, 0.5]),
        (Interval::new(-f64::MAX, f64::MAX), vec![-5.0, 7.0]),
    ];
    for (domain, roots) in cases {
        let scale = roots.iter().fold(1.0, |s: f64, r: &f64| s.max(r.abs()));
        let mut f = Polynomial { roots: roots.clone(), scale: 1.0, lift: 0.0 };
        let limits = SearchLimits::new(1e-9 * scale);
        let found = first_zero(&mut f, domain, limits);
        let FirstZero::Found { bracket, evidence } = found else { panic!("{found:?} {roots:?}") };
        assert!(
            bracket.contains(roots[0]) && bracket.width() <= limits.time_tolerance,
            "{bracket:?} {roots:?}"
        );
        assert_eq!(evidence, ZeroEvidence::Unique, "{bracket:?} {roots:?}");
        let by_halves = bboi(&mut f, domain, limits);
        // Beyond 1e150 a discriminant overflows, and no parabola excludes anything.
        let near = scale < 1e150 && domain.lo() > -1e150;
        let by_parabolas = if near { hrfoi(&mut f, domain, limits) } else { by_halves };
        for found in [by_halves, by_parabolas] {
            let RootSearch::Bracket(bracket) = found else { panic!("{found:?} {roots:?}") };
            // A neighbour of the zero may be reported for it: f is too small there.
            let tolerance = limits.time_tolerance;
            let near = bracket.lo() <= roots[0] && bracket.hi() >= roots[0] - tolerance;
            assert!(near && bracket.width() <= tolerance, "{bracket:?}");
        }
    }
    let mut none = Polynomial { roots: vec![], scale: 1.0, lift: 0.0 };
    assert_eq!(first_zero(&mut none, Interval::ENTIRE, SearchLimits::new(1e-9)), FirstZero::None);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    /// Zeros planted at exact places in domains of any kind: the first is in the bracket, and unique is one.
    #[test]
    fn planted_zeros_in_any_domain(
        roots in prop::collection::vec(-1024..1024i32, 0..5), ends in (-1100..1100i32, -1100..1100i32),
        unbounded in (prop::bool::weighted(0.2), prop::bool::weighted(0.2)), exponent in -30..30i32
    ) {
        let unit = 2.0_f64.powi(exponent - 10);
        let mut roots: Vec<f64> = roots.into_iter().map(|k| f64::from(k) * unit).collect();
        roots.sort_by(f64::total_cmp);
        roots.dedup();
        let lo = if unbounded.0 { f64::NEG_INFINITY } else { f64::from(ends.0.min(ends.1)) * unit };
        let hi = if unbounded.1 { f64::INFINITY } else { f64::from(ends.0.max(ends.1)) * unit };
        let domain = Interval::new(lo, hi);
        let tolerance = unit * 1e-6;
        let first = roots.iter().copied().find(|r| domain.contains(*r));
        let mut f = Polynomial { roots: roots.clone(), scale: 1.0, lift: 0.0 };
        match first_zero(&mut f, domain, SearchLimits::new(tolerance)) {
            FirstZero::None => prop_assert_eq!(first, None),
            FirstZero::Found { bracket, evidence } => {
                let inside = roots.iter().filter(|r| bracket.contains(**r)).count();
                // Within 2⁻⁵⁰⁰ of zero, where intervals end, a neighbor may be reported for it, and is called undecided: nothing is before it.
                let is_found = |r: f64| match evidence {
                    ZeroEvidence::Undecided => bracket.lo() <= r && r <= bracket.hi() + tolerance,
                    _ => bracket.contains(r),
                };
                prop_assert!(first.is_some_and(is_found), "{:?} {:?} {:?}", bracket, first, evidence);
                prop_assert!(bracket.width() <= tolerance && bracket.is_subset(domain), "{:?}", bracket);
                prop_assert!(evidence != ZeroEvidence::Unique || inside == 1);
            }
            FirstZero::Undecided { clear_until } => prop_assert!(first.is_none_or(|r| clear_until <= r)),
        }
    }
}
