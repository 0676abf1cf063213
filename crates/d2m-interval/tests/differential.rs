//! Every operation against the exact reference; mutants must be caught by the same families.
use d2m_interval::Interval;

use d2m_testing::elementary as oracle;
use d2m_testing::elementary::families::{Binary, Unary, binary, jobs, run_binary, run_unary, unary};

#[test]
fn no_loss_and_tight() {
    let mut bad = Vec::new();
    for job in jobs(10_000, 1) {
        let outcome = job();
        println!(
            "{:16} {:7} worst {} of {}  {}",
            outcome.name, outcome.checked, outcome.worst, outcome.allowed, outcome.example
        );
        if !outcome.passed() {
            bad.push(format!("{outcome:?}"));
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

fn named_binary(name: &str) -> Binary {
    binary().into_iter().find(|family| family.name == name).expect("known")
}

fn named_unary(name: &str) -> Unary {
    unary().into_iter().find(|family| family.name == name).expect("known")
}

fn caught(name: &str, mutant: fn(Interval, Interval) -> Interval) {
    let mut family = named_binary(name);
    family.operation = mutant;
    assert!(run_binary(&family, 2000, 7).lost > 0, "a mutant of {name} survives");
}

fn caught_unary(name: &str, mutant: fn(Interval) -> Interval) {
    let mut family = named_unary(name);
    family.operation = mutant;
    assert!(run_unary(&family, 1000, 7).lost > 0, "a mutant of {name} survives");
}

#[test]
fn mutants_without_outward_rounding_die() {
    caught("add", |x, y| Interval::new(x.lo() + y.lo(), x.hi() + y.hi()));
    caught("add", |x, y| Interval::new((x + y).lo(), x.hi() + y.hi()));
    caught("add", |x, y| Interval::new(x.lo() + y.lo(), (x + y).hi()));
    caught("mul", |x, y| {
        let p = [x.lo() * y.lo(), x.lo() * y.hi(), x.hi() * y.lo(), x.hi() * y.hi()];
        Interval::new(
            p.into_iter().fold(f64::INFINITY, f64::min),
            p.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    });
    caught("div", |x, y| {
        let p = [x.lo() / y.lo(), x.lo() / y.hi(), x.hi() / y.lo(), x.hi() / y.hi()];
        Interval::new(
            p.into_iter().fold(f64::INFINITY, f64::min),
            p.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    });
    caught_unary("sqrt", |x| Interval::new(x.lo().sqrt(), x.sqrt().hi()));
    caught_unary("exp", |x| Interval::new(x.lo().exp(), x.hi().exp()));
    // One last place inwards at one end.
    caught_unary("exp", |x| Interval::new(x.exp().lo().next_up(), x.exp().hi()));
    caught_unary("atan", |x| Interval::new(x.atan().lo(), x.atan().hi().next_down()));
}

#[test]
fn mutants_of_the_quadrant_die() {
    caught_unary("sin of moderate", |x| {
        // The extremum inside is forgotten.
        let (a, b) = (Interval::point(x.lo()).sin(), Interval::point(x.hi()).sin());
        a.hull(b)
    });
    caught_unary("sin of moderate", Interval::cos);
    caught_unary("cos of moderate", |x| -x.cos());
    caught_unary("sin of moderate", |x| {
        // The nearest rounded multiple of π decides.
        let k = (x.lo() / std::f64::consts::PI).round();
        let s = (x - k * std::f64::consts::PI).sin();
        if k as i64 % 2 == 0 { s } else { -s }
    });
}

/// Where the reduced argument cancels, where the fast path ends, and at any size.
#[test]
fn sine_and_cosine_near_multiples_of_half_pi_and_at_any_size() {
    let mut arguments = vec![
        524_287.999_999_999_9,
        524_288.0,
        524_288.000_000_000_1,
        f64::MAX,
        6_381_956_970_095_103.0 * 2.0_f64.powi(797),
    ];
    for k in (1..334_000).step_by(1499) {
        let x = f64::from(k) * std::f64::consts::FRAC_PI_2;
        arguments.extend([x, x.next_up(), x.next_down(), x * (1.0 + 1e-9)]);
    }
    for exponent in (20..1023).step_by(7) {
        arguments.push(1.234_567_890_123 * 2.0_f64.powi(exponent));
    }
    let fits = |result: Interval, exact: &oracle::Fixed| {
        let [lo, hi] = oracle::to_doubles(exact);
        let tightest = Interval::new(lo, hi);
        let ulp = tightest.mag().next_up() - tightest.mag();
        tightest.is_subset(result) && result.is_subset(tightest + Interval::new(-4.0 * ulp, 4.0 * ulp))
    };
    for x in arguments {
        for x in [x, -x] {
            let (sin, cos) = Interval::point(x).sin_cos();
            let (s, c) = oracle::sin_cos(&oracle::fixed(x));
            assert!(fits(sin, &s) && fits(cos, &c), "{x:e}: {sin:?} {cos:?}");
            let tan = Interval::point(x).tan();
            assert!(fits(tan, &oracle::div(&s, &c)), "{x:e}: {tan:?}");
        }
    }
}
