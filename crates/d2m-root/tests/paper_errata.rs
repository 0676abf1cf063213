//! The paper's root searches against their literal text: where the text loses a root, these functions may not.
//!
//! Source of the text: "Accurate and Efficient Continuous Collision Detection" (D2M), Algorithms 1, 2 and 3.

use d2m_interval::Interval;
use d2m_root::{
    Gamma, InclusionFunction, IntervalFunction, RootSearch, SearchLimits, SecondOrder, Settled, bboi, hrfoi,
};

/// f(t) = c0 + c1 t + c2 t² + c3 t³ with Γ true on closed spans of time.
struct Cubic {
    c: [f64; 4],
    gamma: Vec<(f64, f64)>,
    evaluations: usize,
}

impl Cubic {
    fn new(c: [f64; 4], gamma: &[(f64, f64)]) -> Self {
        Self { c, gamma: gamma.to_vec(), evaluations: 0 }
    }

    fn at(&self, t: Interval) -> Interval {
        ((t * self.c[3] + self.c[2]) * t + self.c[1]) * t + self.c[0]
    }
}

impl IntervalFunction for Cubic {
    fn enclose(&mut self, t: Interval) -> Interval {
        self.at(t)
    }
}

impl SecondOrder for Cubic {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        self.evaluations += 1;
        let s = Interval::point(t.lo());
        let slope = (s * (3.0 * self.c[3]) + 2.0 * self.c[2]) * s + self.c[1];
        InclusionFunction::new(self.at(s), slope, t * (6.0 * self.c[3]) + 2.0 * self.c[2], t)
    }
}

impl Gamma for Cubic {
    fn may_touch(&mut self, t: Interval) -> bool {
        self.gamma.iter().any(|&(a, b)| a <= t.hi() && t.lo() <= b)
    }
}

/// Algorithm 2 as printed, in plain doubles: ½ applied by line 5 *and* by θ, and nothing searched behind h1.
fn literal_hrfoi(f: &mut Cubic, t0: f64, t1: f64, time_tolerance: f64, halves: f64) -> Option<(f64, f64)> {
    let t = Interval::new(t0, t1);
    if !f.may_touch(t) || !f.at(t).contains_zero() {
        return None;
    }
    let theta = f.inclusion_function(t);
    let (mut lower, mut upper) = (theta.lower(), theta.upper());
    lower.curvature *= halves;
    upper.curvature *= halves;
    if lower.value < 0.0 {
        (lower, upper) = (upper.negated(), lower.negated());
    }
    let first = |p: d2m_root::Parabola| p.first_nonpositive().map(|x| t0 + x.mid()).filter(|x| *x <= t1);
    let h0 = first(lower)?;
    let h1 = first(upper).unwrap_or(t1);
    if h1 - h0 <= time_tolerance {
        return f.may_touch(Interval::new(h0.min(h1), h1)).then_some((h0, h1));
    }
    let middle = 0.5 * (h0 + h1);
    literal_hrfoi(f, h0, middle, time_tolerance, halves)
        .or_else(|| literal_hrfoi(f, middle, h1, time_tolerance, halves))
}

fn bracket(found: RootSearch) -> Interval {
    match found {
        RootSearch::Bracket(b) => b,
        other => panic!("expected a bracket, got {other:?}"),
    }
}

const EVERYWHERE: &[(f64, f64)] = &[(f64::NEG_INFINITY, f64::INFINITY)];

/// Erratum 1: with ½ twice, the lower parabola cuts the graph and the root is reported too late.
#[test]
fn half_twice_is_late() {
    // 1 − t²: root 1; halved twice the lower parabola is 1 − t²/2 with "root" √2.
    let c = [1.0, 0.0, -1.0, 0.0];
    let late = literal_hrfoi(&mut Cubic::new(c, EVERYWHERE), 0.0, 3.0, 1e-9, 0.5);
    assert!(late.is_none_or(|(h0, _)| h0 > 1.0 + 1e-6), "the literal text would have been right: {late:?}");
    let found =
        bracket(hrfoi(&mut Cubic::new(c, EVERYWHERE), Interval::new(0.0, 3.0), SearchLimits::new(1e-9)));
    assert!(found.contains(1.0) && found.width() <= 1e-9);
}

/// Erratum 2: the first root is refused by Γ, the second is the contact.
#[test]
fn a_refused_root_does_not_end_the_search() {
    // (1 − t)(3 − t)
    let c = [3.0, -4.0, 1.0, 0.0];
    let second_only = &[(2.0, 4.0)];
    let literal = literal_hrfoi(&mut Cubic::new(c, second_only), 0.0, 4.0, 1e-9, 1.0);
    assert!(literal.is_none(), "the literal text would have been right: {literal:?}");
    let found =
        bracket(hrfoi(&mut Cubic::new(c, second_only), Interval::new(0.0, 4.0), SearchLimits::new(1e-9)));
    assert!(found.contains(3.0) && found.width() <= 1e-9);
}

/// Erratum 3: the value at the start holds zero.
#[test]
fn a_root_at_the_start_is_found() {
    // t (t − 2): roots 0 and 2.
    let c = [0.0, -2.0, 1.0, 0.0];
    let found =
        bracket(hrfoi(&mut Cubic::new(c, EVERYWHERE), Interval::new(0.0, 3.0), SearchLimits::new(1e-9)));
    assert_eq!(found.lo(), 0.0);
    assert!(found.hi() <= 1e-9);
    // And when Γ refuses the start, the other root is found.
    let later = &[(1.0, 3.0)];
    let found = bracket(hrfoi(&mut Cubic::new(c, later), Interval::new(0.0, 3.0), SearchLimits::new(1e-9)));
    assert!(found.contains(2.0));
    // One ulp-sized interval around zero at a start that is not zero exactly.
    let c = [0.1 + 0.2 - 0.3, -1.0, 0.0, 0.0];
    let found =
        bracket(hrfoi(&mut Cubic::new(c, EVERYWHERE), Interval::new(0.0, 1.0), SearchLimits::new(1e-9)));
    assert!(found.lo() <= 5.6e-17);
}

/// Erratum 4: f ≡ 0, the contact is where Γ begins to hold.
#[test]
fn a_horizontal_function_is_decided_by_gamma() {
    let zero = [0.0; 4];
    let found = bracket(hrfoi(
        &mut Cubic::new(zero, &[(0.625, 0.75)]),
        Interval::new(0.0, 1.0),
        SearchLimits::new(1e-9),
    ));
    assert!(found.lo() <= 0.625 && found.hi() >= 0.625 && found.width() <= 1e-9);
    let none = hrfoi(&mut Cubic::new(zero, &[]), Interval::new(0.0, 1.0), SearchLimits::new(1e-9));
    assert_eq!(none, RootSearch::None);
}

/// Erratum 5: a tolerance below the spacing of doubles ends all the same.
#[test]
fn no_representable_progress_ends_the_search() {
    let c = [-1.0e8, 1.0, 0.0, 0.0];
    let domain = Interval::new(99_999_999.0, 1.000_000_01e8);
    for found in [
        bboi(&mut Cubic::new(c, EVERYWHERE), domain, SearchLimits::new(0.0)),
        hrfoi(&mut Cubic::new(c, EVERYWHERE), domain, SearchLimits::new(0.0)),
    ] {
        let b = bracket(found);
        assert!(b.lo() <= 1e8 && b.lo() > 1e8 - 1e-6 && b.width() <= 1e-6, "{b:?}");
    }
    let zero = [0.0; 4];
    let b =
        bracket(hrfoi(&mut Cubic::new(zero, EVERYWHERE), Interval::new(1.0, 2.0), SearchLimits::new(0.0)));
    assert_eq!(b.lo(), 1.0);
}

/// Double roots, one-sided touches and near misses: found where they are, refused where they are not.
#[test]
fn double_roots_and_near_misses() {
    for shift in [0.0, 1e-13, 1e-9, 1e-3] {
        // (t − 1)² + shift
        let c = [1.0 + shift, -2.0, 1.0, 0.0];
        let found = hrfoi(&mut Cubic::new(c, EVERYWHERE), Interval::new(0.0, 3.0), SearchLimits::new(1e-9));
        if shift == 0.0 {
            assert!(bracket(found).lo() <= 1.0 && bracket(found).lo() > 1.0 - 1e-6);
        } else if shift >= 1e-9 {
            assert_eq!(found, RootSearch::None);
        }
    }
}

/// The budget ends the search with a time that is free indeed.
#[test]
fn the_budget_is_kept_and_honest() {
    let zero = [0.0; 4];
    let mut f = Cubic::new(zero, &[(0.9, 1.0)]);
    let limits = SearchLimits::new(1e-12).with_evaluations(5);
    match hrfoi(&mut f, Interval::new(0.0, 1.0), limits) {
        RootSearch::Undecided { clear_until } => assert!(clear_until <= 0.9),
        other => panic!("{other:?}"),
    }
    assert!(f.evaluations <= 5);
}

/// "Near" drops what lies to the right, and never turns into "no contact" when the left is then excluded.
#[test]
fn near_is_never_lost() {
    struct Hugging;
    impl IntervalFunction for Hugging {
        fn enclose(&mut self, _: Interval) -> Interval {
            Interval::new(-1e-3, 1e-3)
        }
    }
    impl SecondOrder for Hugging {
        fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
            let wide = Interval::new(-1e-3, 1e-3);
            InclusionFunction::new(wide, Interval::point(0.0), Interval::point(0.0), t)
        }
    }
    impl Gamma for Hugging {
        fn may_touch(&mut self, _: Interval) -> bool {
            true
        }
        fn settle(&mut self, t: Interval) -> Settled {
            if t.hi() < 0.7 {
                Settled::Excluded
            } else if t.contains(0.75) {
                Settled::Near(0.75)
            } else {
                Settled::Open
            }
        }
    }
    let b = bracket(hrfoi(&mut Hugging, Interval::new(0.0, 1.0), SearchLimits::new(1e-9)));
    assert!(b.lo() >= 0.69 && b.lo() <= 0.75 && b.hi() <= 0.75 + 1e-9);
}

/// A time within the tolerance is the answer where everything before it is then excluded: what lay behind it was dropped.
#[test]
fn near_is_the_bracket_if_the_rest_is_excluded() {
    struct Once(bool);
    impl IntervalFunction for Once {
        fn enclose(&mut self, _: Interval) -> Interval {
            Interval::new(-1.0, 1.0)
        }
    }
    impl SecondOrder for Once {
        fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
            InclusionFunction::new(Interval::new(-1.0, 1.0), Interval::point(0.0), Interval::point(0.0), t)
        }
    }
    impl Gamma for Once {
        fn may_touch(&mut self, _: Interval) -> bool {
            true
        }
        fn settle(&mut self, _: Interval) -> Settled {
            if core::mem::replace(&mut self.0, false) { Settled::Near(0.75) } else { Settled::Excluded }
        }
    }
    let b = bracket(hrfoi(&mut Once(true), Interval::new(0.0, 1.0), SearchLimits::new(1e-9)));
    assert_eq!((b.lo(), b.hi()), (0.75, 0.75));
}

/// A simple crossing takes a handful of evaluations; bisection would take 43.
#[test]
fn simple_crossings_take_few_evaluations() {
    let mut f = Cubic::new([1.0, -1.5, 0.25, 0.125], EVERYWHERE);
    assert!(bracket(hrfoi(&mut f, Interval::new(0.0, 1.0), SearchLimits::new(1e-13))).width() <= 1e-13);
    assert!(f.evaluations <= 8, "{}", f.evaluations);
}

/// A crossing planted at every position of a fine grid, ends included, with roots of both signs of slope.
#[test]
fn planted_crossings_are_never_late() {
    for k in 0..=256 {
        let r = k as f64 / 256.0;
        for (s, scale) in [(-1.0, 1.0), (1.5, 1.0), (1.5, -3.0), (40.0, 0.125)] {
            // scale (t − r)(t − s): exact coefficients (dyadic)
            let c = [scale * r * s, -scale * (r + s), scale, 0.0];
            let found =
                hrfoi(&mut Cubic::new(c, EVERYWHERE), Interval::new(0.0, 1.0), SearchLimits::new(1e-12));
            let b = bracket(found);
            assert!(b.lo() <= r && b.hi() >= r - 1e-12, "{r} {s} {scale}: {b:?}");
            assert!(b.lo() >= r - 1e-9);
        }
    }
}
