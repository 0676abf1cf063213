//! First zeros of polynomials with planted roots (exact: small multiples of a power of two), and of what cannot be decided.
use d2m_interval::Interval;
use d2m_root::{Differentiable, FirstZero, IntervalFunction, SearchLimits, ZeroEvidence, first_zero};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (0.5_f64).powi(53)
    }
    /// A multiple of 2⁻¹⁰ in [−1, 1].
    fn root(&mut self) -> f64 {
        (self.unit() * 2048.0 - 1024.0).round() / 1024.0
    }
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
        let mut roots: Vec<f64> = (0..=i % 6).map(|_| random.root()).collect();
        roots.sort_by(f64::total_cmp);
        roots.dedup();
        let scale = [1.0, -3.0, 1e-8, 1e8][i % 4];
        let (lo, hi) = (random.root() - 0.1, random.root() + 0.1);
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
        let double = random.root();
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
    // A near miss within a budget of ten looks: what is clear is told.
    let mut f = Polynomial { roots: vec![0.5, 0.5], scale: 1.0, lift: 1e-13 };
    let limits = SearchLimits::new(0.0).with_evaluations(10);
    let FirstZero::Undecided { clear_until } = first_zero(&mut f, Interval::new(0.0, 1.0), limits) else {
        panic!("ten looks do not decide this")
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
