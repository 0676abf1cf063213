//! Functions with poles: no zero is lost behind one, none is claimed at one.
use d2m_interval::Interval;
use d2m_root::{
    Differentiable, FirstZero, Gamma, InclusionFunction, IntervalFunction, RootSearch, SearchLimits,
    SecondOrder, ZeroEvidence, bboi, first_zero, hrfoi,
};
use d2m_testing::{Draw, Random};

/// With x = t − pole: level − 1/x, level − 1/x², or tan(x + π/2) + level.
#[derive(Clone, Copy)]
enum Kind {
    Simple,
    Double,
    Tangent,
}

#[derive(Clone, Copy)]
struct Pole {
    kind: Kind,
    place: f64,
    level: f64,
}

const HALF_TURN: f64 = core::f64::consts::FRAC_PI_2;

impl Pole {
    /// Zeros within 1.5 of the pole, ascending.
    fn zeros(&self) -> Vec<f64> {
        let x = match self.kind {
            Kind::Simple => vec![1.0 / self.level],
            Kind::Double if self.level > 0.0 => vec![-1.0 / self.level.sqrt(), 1.0 / self.level.sqrt()],
            Kind::Double => vec![],
            // tan(x + π/2) = −1/tan x.
            Kind::Tangent => vec![(1.0 / self.level).atan()],
        };
        x.into_iter().map(|x| self.place + x).collect()
    }
    fn at(&self, t: Interval) -> Interval {
        t - self.place
    }
}

impl IntervalFunction for Pole {
    fn enclose(&mut self, t: Interval) -> Interval {
        let x = self.at(t);
        match self.kind {
            Kind::Simple => self.level - Interval::point(1.0) / x,
            Kind::Double => self.level - Interval::point(1.0) / x.sqr(),
            Kind::Tangent => (x + HALF_TURN).tan() + self.level,
        }
    }
}

impl Differentiable for Pole {
    fn enclose_derivative(&mut self, t: Interval) -> Interval {
        let x = self.at(t);
        match self.kind {
            Kind::Simple => Interval::point(1.0) / x.sqr(),
            Kind::Double => Interval::point(2.0) / (x.sqr() * x),
            Kind::Tangent => (x + HALF_TURN).tan().sqr() + 1.0,
        }
    }
}

impl SecondOrder for Pole {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        let (start, x) = (Interval::point(t.lo()), self.at(t));
        let second = match self.kind {
            Kind::Simple => Interval::point(-2.0) / (x.sqr() * x),
            Kind::Double => Interval::point(-6.0) / x.sqr().sqr(),
            Kind::Tangent => {
                let tangent = (x + HALF_TURN).tan();
                tangent * (tangent.sqr() + 1.0) * 2.0
            }
        };
        InclusionFunction::new(self.enclose(start), self.enclose_derivative(start), second, t)
    }
}

impl Gamma for Pole {
    fn may_touch(&mut self, _: Interval) -> bool {
        true
    }
}

const WIDTH: f64 = 1e-9;

#[test]
fn no_zero_is_lost_behind_a_pole_and_none_is_claimed_at_one() {
    let mut random = Random(9);
    let (mut behind, mut none) = (0, 0);
    for round in 0..6000 {
        let kind = [Kind::Simple, Kind::Double, Kind::Tangent][round % 3];
        let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
        let pole = if round % 5 == 0 { 0.0 } else { 4.0 * random.unit() - 2.0 };
        let mut f = Pole { kind, place: pole, level: sign * (0.7 + 3.0 * random.unit()) };
        let domain = Interval::new(pole - 1.5 * random.unit(), pole + 1.5 * random.unit());
        let near_an_end = |zero: &f64| (zero - domain.lo()).abs().min((zero - domain.hi()).abs()) < 1e-6;
        if f.zeros().iter().any(near_an_end) {
            continue;
        }
        let first = f.zeros().into_iter().find(|&zero| domain.contains(zero));
        let limits = SearchLimits::new(WIDTH);
        let reaches = |bracket: Interval, zero: f64| bracket.lo() <= zero + 1e-12;
        // What cannot be decided is the pole; the search goes on behind it.
        let mut rest = domain;
        let found = loop {
            let found = first_zero(&mut f, rest, limits);
            let FirstZero::Found { bracket, evidence: ZeroEvidence::Undecided } = found else { break found };
            assert!((bracket.mid() - pole).abs() < 2.0 * WIDTH, "{round}: {bracket:?}");
            assert!(first.is_none_or(|zero| reaches(bracket, zero)), "{round}: {bracket:?}");
            rest = Interval::new(bracket.hi(), rest.hi());
        };
        match (first, found) {
            (Some(zero), FirstZero::Found { bracket, .. }) => {
                assert!(reaches(bracket, zero), "{round}: {bracket:?} after {zero}");
                assert!((bracket.mid() - zero).abs() < 2.0 * WIDTH, "{round}: {bracket:?}, {zero}");
                behind += u32::from(zero > pole);
            }
            (None, FirstZero::None) => none += 1,
            (zero, found) => panic!("{round}: {zero:?}, {found:?}"),
        }
        for found in [bboi(&mut f, domain, limits), hrfoi(&mut f, domain, limits)] {
            match (first, found) {
                (Some(zero), RootSearch::Bracket(bracket)) => {
                    assert!(reaches(bracket, zero), "{round}: {bracket:?} after {zero}");
                }
                (None, RootSearch::Bracket(bracket)) => {
                    assert!((bracket.mid() - pole).abs() < 2.0 * WIDTH, "{round}: {bracket:?}");
                }
                (None, RootSearch::None) => {}
                (zero, found) => panic!("{round}: {zero:?}, {found:?}"),
            }
        }
    }
    assert!(behind > 300 && none > 300, "{behind} {none}");
}
