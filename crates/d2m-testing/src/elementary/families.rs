//! Random differential families: each operation against the exact reference, end points always among the
//! samples. Called by the tests of `d2m-interval` and by `cargo xtask accuracy interval`.
use crate::Random;
use d2m_interval::{Interval, IntervalVec3};
use dashu_int::{IBig, ops::Abs};
use glam::DVec3;

use super::{Fixed, atan, atan2, div, exp, fixed, ln, ln_2, mul, one, quadrant, sin_cos, sqrt, to_double};

/// What the families draw besides numbers of the unit interval.
impl Random {
    /// A double whose magnitude has an exponent in `exponents`, either sign.
    pub(crate) fn double(&mut self, exponents: (i32, i32)) -> f64 {
        let span = (exponents.1 - exponents.0 + 1) as u64;
        let field = 1023 + exponents.0 + self.below(span) as i32;
        // Few mantissa bits now and then: ties and exact results.
        let mask = if self.below(4) == 0 { !0 << 44 } else { !0 };
        let bits = (self.bits() >> 12 & mask) | (field as u64) << 52;
        let x = f64::from_bits(bits);
        if self.below(2) == 0 { x } else { -x }
    }

    /// An interval: a point, a few last places wide, relatively narrow, or anything.
    pub(crate) fn interval(&mut self, domain: Domain) -> Interval {
        let mut end = || loop {
            let x = self.double(domain.exponents);
            if x >= domain.lo && x <= domain.hi {
                return x;
            }
        };
        let (x, other) = (end(), end());
        let y = match self.below(4) {
            0 => x,
            1 => f64::from_bits(x.to_bits() + self.below(9)),
            2 => x * (1.0 + (0.5_f64).powi(self.below(50) as i32)),
            _ => other,
        }
        .clamp(domain.lo, domain.hi);
        Interval::new(x.min(y), x.max(y))
    }

    fn inside(&mut self, x: Interval) -> f64 {
        let share = self.below(1 << 20) as f64 / f64::from(1 << 20);
        (x.lo() + share * (x.hi() - x.lo())).clamp(x.lo(), x.hi())
    }
}

/// Where arguments are drawn from.
#[derive(Clone, Copy)]
pub struct Domain {
    /// Least argument.
    pub lo: f64,
    /// Greatest argument.
    pub hi: f64,
    /// Least and greatest exponent of their magnitudes.
    pub exponents: (i32, i32),
}

const fn domain(lo: f64, hi: f64, from: i32, to: i32) -> Domain {
    Domain { lo, hi, exponents: (from, to) }
}

/// What a family found.
#[derive(Debug)]
pub struct Outcome {
    /// Of the operation.
    pub name: &'static str,
    /// Tuples tried.
    pub checked: u64,
    /// Tuples whose exact result is not inside: must be 0.
    pub lost: u64,
    /// The most last places (of the tightest end) that an end was too far out, where it was more than `2⁻⁵⁰⁰`.
    pub worst: u64,
    /// Promised bound of `worst`.
    pub allowed: u64,
    /// The first loss, or the worst case.
    pub example: String,
}

impl Outcome {
    /// Nothing lost, and nowhere wider than promised.
    pub fn passed(&self) -> bool {
        self.lost == 0 && self.worst <= self.allowed
    }
}

/// Ordered so that neighbours differ by one.
fn rank(x: f64) -> i128 {
    let bits = x.to_bits();
    let size = i128::from(bits & !(1 << 63));
    if bits >> 63 == 1 { -size } else { size }
}

fn excess(end: f64, tightest: f64) -> u64 {
    if end == tightest || (end - tightest).abs() <= 3.1e-151 {
        return 0; // 2⁻⁵⁰⁰ = 3.05e−151
    }
    u64::try_from((rank(end) - rank(tightest)).unsigned_abs()).unwrap_or(u64::MAX)
}

type Values = Vec<Fixed>;

/// Compares a result with the least and greatest exact value; `slack` counts units of 2⁻¹⁴⁰⁰ that the reference
/// may be off by (a loss must be certain).
fn judge(
    outcome: &mut Outcome,
    result: Interval,
    values: &Values,
    slack: &IBig,
    describe: impl Fn() -> String,
) {
    let (least, greatest) = (values.iter().min().expect("values"), values.iter().max().expect("values"));
    // Relative part: the reference cuts off digits of intermediate values, which are as large as the result.
    let largest = least.clone().abs().max(greatest.clone().abs());
    let slack = &(slack + (largest >> 1300usize));
    let lost = result.is_empty()
        || (result.lo().is_finite() && fixed(result.lo()) > least + slack)
        || (result.hi().is_finite() && fixed(result.hi()) < greatest - slack);
    outcome.checked += 1;
    if lost {
        if outcome.lost == 0 {
            outcome.example = format!("lost: {} -> {result:?}", describe());
        }
        outcome.lost += 1;
    }
    let far =
        excess(result.lo(), to_double(least, false)).max(excess(result.hi(), to_double(greatest, true)));
    if far > outcome.worst {
        outcome.worst = far;
        if outcome.lost == 0 {
            outcome.example = format!("{} -> {result:?}", describe());
        }
    }
}

/// An operation of one argument.
pub type UnaryOperation = fn(Interval) -> Interval;
/// An operation of two arguments.
pub type BinaryOperation = fn(Interval, Interval) -> Interval;

/// An operation of one argument, and what it is held against.
pub struct Unary {
    /// Its name.
    pub name: &'static str,
    /// The operation that is judged.
    pub operation: UnaryOperation,
    /// Its exact value at a number.
    pub exact: fn(f64) -> Fixed,
    /// Values at interior extrema.
    pub extrema: fn(Interval) -> Values,
    /// Where arguments are drawn from.
    pub domain: Domain,
    /// Last places that an end may be too far out.
    pub allowed: u64,
}

/// An operation of two arguments, and what it is held against.
pub struct Binary {
    /// Its name.
    pub name: &'static str,
    /// The operation that is judged.
    pub operation: BinaryOperation,
    /// Its exact value at two numbers.
    pub exact: fn(f64, f64) -> Fixed,
    /// Where arguments are drawn from.
    pub domains: [Domain; 2],
    /// Last places that an end may be too far out.
    pub allowed: u64,
}

fn none(_: Interval) -> Values {
    Vec::new()
}

fn zero_inside(x: Interval) -> Values {
    if x.contains_zero() { vec![IBig::from(0)] } else { Vec::new() }
}

fn one_if_zero_inside(x: Interval) -> Values {
    if x.contains_zero() { vec![one()] } else { Vec::new() }
}

/// ±1 where a multiple of π/2 with that value is inside; `offset` 0 for sine, 1 for cosine.
fn circle_extrema(x: Interval, offset: i64) -> Values {
    let first: i128 = quadrant(&fixed(x.lo())).0.try_into().unwrap_or(0);
    let last: i128 = quadrant(&fixed(x.hi())).0.try_into().unwrap_or(8);
    ((first + 1)..=last.min(first + 4))
        .chain((x.lo() == 0.0).then_some(0))
        .filter_map(|k| match (k + i128::from(offset)).rem_euclid(4) {
            1 => Some(one()),
            3 => Some(-one()),
            _ => None,
        })
        .collect()
}

fn power(x: &Fixed, n: u32) -> Fixed {
    (0..n).fold(one(), |product, _| mul(&product, x))
}

const WIDE: Domain = domain(f64::NEG_INFINITY, f64::INFINITY, -300, 300);
const SMALL: Domain = domain(f64::NEG_INFINITY, f64::INFINITY, -60, 60);

/// All functions of one argument.
pub fn unary() -> Vec<Unary> {
    macro_rules! unary {
        ($name:literal, $op:expr, $exact:expr, $extrema:expr, $domain:expr, $allowed:expr) => {
            Unary {
                name: $name,
                operation: $op,
                exact: $exact,
                extrema: $extrema,
                domain: $domain,
                allowed: $allowed,
            }
        };
    }
    let log_exact: fn(f64) -> Fixed = |x| ln(&fixed(x));
    vec![
        unary!("sqr", Interval::sqr, |x| mul(&fixed(x), &fixed(x)), zero_inside, WIDE, 2),
        unary!("sqrt", Interval::sqrt, |x| sqrt(&fixed(x)), none, domain(0.0, f64::MAX, -300, 300), 2),
        unary!(
            "recip",
            Interval::recip,
            |x| div(&one(), &fixed(x)),
            none,
            domain(0.0, f64::MAX, -300, 300),
            2
        ),
        unary!("abs", Interval::abs, |x| fixed(x).abs(), zero_inside, WIDE, 0),
        unary!("powi 3", |x| x.powi(3), |x| power(&fixed(x), 3), none, WIDE, 2),
        unary!("powi 8", |x| x.powi(8), |x| power(&fixed(x), 8), zero_inside, SMALL, 2),
        unary!(
            "powi -3",
            |x| x.powi(-3),
            |x| div(&one(), &power(&fixed(x), 3)),
            none,
            domain(0.0, f64::MAX, -60, 60),
            2
        ),
        unary!(
            "cbrt",
            Interval::cbrt,
            |x| {
                let root = exp(&(ln(&fixed(x.abs())) / IBig::from(3)));
                if x < 0.0 { -root } else { root }
            },
            none,
            WIDE,
            4
        ),
        unary!("sin", Interval::sin, |x| sin_cos(&fixed(x)).0, |x| circle_extrema(x, 0), SMALL, 4),
        unary!("cos", Interval::cos, |x| sin_cos(&fixed(x)).1, |x| circle_extrema(x, 1), SMALL, 4),
        unary!(
            "sin of moderate",
            Interval::sin,
            |x| sin_cos(&fixed(x)).0,
            |x| circle_extrema(x, 0),
            domain(-1e6, 1e6, -4, 19),
            4
        ),
        unary!(
            "cos of moderate",
            Interval::cos,
            |x| sin_cos(&fixed(x)).1,
            |x| circle_extrema(x, 1),
            domain(-1e6, 1e6, -4, 19),
            4
        ),
        unary!(
            "tan",
            Interval::tan,
            |x| {
                let (s, c) = sin_cos(&fixed(x));
                div(&s, &c)
            },
            none,
            domain(-1.57, 1.57, -60, 0),
            4
        ),
        unary!("atan", Interval::atan, |x| atan(&fixed(x)), none, SMALL, 4),
        unary!(
            "asin",
            Interval::asin,
            |x| {
                let x = fixed(x);
                atan2(&x, &sqrt(&(one() - mul(&x, &x))))
            },
            none,
            domain(-1.0, 1.0, -60, 0),
            4
        ),
        unary!(
            "acos",
            Interval::acos,
            |x| {
                let x = fixed(x);
                atan2(&sqrt(&(one() - mul(&x, &x))), &x)
            },
            none,
            domain(-1.0, 1.0, -60, 0),
            4
        ),
        unary!("exp", Interval::exp, |x| exp(&fixed(x)), none, domain(-740.0, 709.0, -60, 9), 4),
        unary!(
            "exp2",
            Interval::exp2,
            |x| exp(&mul(&fixed(x), ln_2())),
            none,
            domain(-1070.0, 1023.0, -60, 10),
            4
        ),
        unary!(
            "exp10",
            Interval::exp10,
            |x| exp(&mul(&fixed(x), &ln(&fixed(10.0)))),
            none,
            domain(-320.0, 308.0, -60, 8),
            4
        ),
        unary!("ln", Interval::ln, log_exact, none, domain(0.0, f64::MAX, -900, 900), 4),
        unary!("ln near 1", Interval::ln, log_exact, none, domain(0.5, 2.0, -1, 0), 4),
        unary!(
            "log2",
            Interval::log2,
            |x| div(&ln(&fixed(x)), ln_2()),
            none,
            domain(0.0, f64::MAX, -9, 9),
            4
        ),
        unary!(
            "log10",
            Interval::log10,
            |x| div(&ln(&fixed(x)), &ln(&fixed(10.0))),
            none,
            domain(0.0, f64::MAX, -9, 9),
            4
        ),
        unary!(
            "sinh",
            Interval::sinh,
            |x| (exp(&fixed(x)) - exp(&-fixed(x))) >> 1usize,
            none,
            domain(-700.0, 700.0, -60, 9),
            4
        ),
        unary!(
            "cosh",
            Interval::cosh,
            |x| (exp(&fixed(x)) + exp(&-fixed(x))) >> 1usize,
            one_if_zero_inside,
            domain(-700.0, 700.0, -60, 9),
            4
        ),
        unary!(
            "tanh",
            Interval::tanh,
            |x| {
                let (a, b) = (exp(&fixed(x)), exp(&-fixed(x)));
                div(&(&a - &b), &(&a + &b))
            },
            none,
            domain(-50.0, 50.0, -60, 5),
            4
        ),
        unary!(
            "asinh",
            Interval::asinh,
            |x| {
                let x = fixed(x);
                let size: Fixed = x.clone().abs();
                let y = ln(&(&size + sqrt(&(mul(&x, &x) + one()))));
                if x < IBig::from(0) { -y } else { y }
            },
            none,
            SMALL,
            4
        ),
        unary!(
            "acosh",
            Interval::acosh,
            |x| {
                let x = fixed(x);
                ln(&(&x + sqrt(&(mul(&x, &x) - one()))))
            },
            none,
            domain(1.0, f64::MAX, 0, 100),
            4
        ),
        unary!(
            "atanh",
            Interval::atanh,
            |x| {
                let x = fixed(x);
                ln(&div(&(one() + &x), &(one() - &x))) >> 1usize
            },
            none,
            domain(-0.999_999_999, 0.999_999_999, -60, -1),
            4
        ),
        unary!(
            "sinc",
            Interval::sinc,
            |x| div(&sin_cos(&fixed(x)).0, &fixed(x)),
            one_if_zero_inside,
            domain(-4.4, 4.4, -40, 2),
            4
        ),
        unary!(
            "versine_ratio",
            Interval::versine_ratio,
            |x| {
                let half_sine = sin_cos(&(fixed(x) >> 1usize)).0;
                let ratio = div(&half_sine, &fixed(x));
                mul(&ratio, &ratio) << 1usize
            },
            |x| if x.contains_zero() { vec![one() >> 1usize] } else { Vec::new() },
            domain(-6.2, 6.2, -40, 2),
            4
        ),
    ]
}

/// All functions of two arguments.
pub fn binary() -> Vec<Binary> {
    let positive = domain(0.0, f64::MAX, -300, 300);
    vec![
        Binary {
            name: "add",
            operation: |x, y| x + y,
            exact: |x, y| fixed(x) + fixed(y),
            domains: [SMALL; 2],
            allowed: 2,
        },
        Binary {
            name: "sub",
            operation: |x, y| x - y,
            exact: |x, y| fixed(x) - fixed(y),
            domains: [SMALL; 2],
            allowed: 2,
        },
        Binary {
            name: "mul",
            operation: |x, y| x * y,
            exact: |x, y| mul(&fixed(x), &fixed(y)),
            domains: [WIDE; 2],
            allowed: 2,
        },
        Binary {
            name: "div",
            operation: |x, y| x / y,
            exact: |x, y| div(&fixed(x), &fixed(y)),
            domains: [WIDE, positive],
            allowed: 2,
        },
        Binary {
            name: "mul f64",
            operation: |x, y| (x * y.lo()).hull(x * y.hi()),
            exact: |x, y| mul(&fixed(x), &fixed(y)),
            domains: [WIDE; 2],
            allowed: 2,
        },
        Binary {
            name: "min",
            operation: Interval::min,
            exact: |x, y| fixed(x.min(y)),
            domains: [SMALL; 2],
            allowed: 0,
        },
        Binary {
            name: "max",
            operation: Interval::max,
            exact: |x, y| fixed(x.max(y)),
            domains: [SMALL; 2],
            allowed: 0,
        },
        Binary {
            name: "mul_add",
            operation: |x, y| x.mul_add(y, Interval::point(-1.0)),
            exact: |x, y| mul(&fixed(x), &fixed(y)) - one(),
            domains: [domain(-4.0, 4.0, -2, 1); 2],
            allowed: 2,
        },
        Binary {
            name: "atan2",
            operation: Interval::atan2,
            exact: |y, x| atan2(&fixed(y), &fixed(x)),
            domains: [domain(0.0, f64::MAX, -60, 60), domain(0.0, f64::MAX, -60, 60)],
            allowed: 4,
        },
        Binary {
            name: "pow",
            operation: Interval::pow,
            exact: |x, y| exp(&mul(&ln(&fixed(x)), &fixed(y))),
            domains: [domain(0.0, f64::MAX, -9, 9), domain(-60.0, 60.0, -30, 5)],
            allowed: 4,
        },
    ]
}

/// Runs one function of one argument.
pub fn run_unary(family: &Unary, count: u64, seed: u64) -> Outcome {
    let mut random = Random(seed);
    let mut outcome = start(family.name, family.allowed);
    let slack = IBig::from(1) << 50usize;
    for _ in 0..count {
        let x = random.interval(family.domain);
        let mut values = vec![(family.exact)(x.lo())];
        if !x.is_singleton() {
            values.push((family.exact)(x.hi()));
        }
        values.extend((family.extrema)(x));
        judge(&mut outcome, (family.operation)(x), &values, &slack, || format!("{x:?}"));
    }
    outcome
}

/// Runs one function of two arguments.
pub fn run_binary(family: &Binary, count: u64, seed: u64) -> Outcome {
    let mut random = Random(seed);
    let mut outcome = start(family.name, family.allowed);
    let slack = IBig::from(1) << 50usize;
    for _ in 0..count {
        let (x, y) = (random.interval(family.domains[0]), random.interval(family.domains[1]));
        let mut values = Vec::with_capacity(5);
        for a in [x.lo(), x.hi()] {
            for b in [y.lo(), y.hi()] {
                values.push((family.exact)(a, b));
            }
        }
        values.push((family.exact)(random.inside(x), random.inside(y)));
        judge(&mut outcome, (family.operation)(x, y), &values, &slack, || format!("{x:?}, {y:?}"));
    }
    outcome
}

/// Fused vector operations: containment only (their promise is relative to the sum of the terms).
pub fn run_vectors(count: u64, seed: u64) -> Outcome {
    let mut random = Random(seed);
    let mut outcome = start("dot, cross, norm²", 0);
    for _ in 0..count {
        let spread = domain(f64::NEG_INFINITY, f64::INFINITY, -20, 20);
        let mut vector =
            || IntervalVec3::new(random.interval(spread), random.interval(spread), random.interval(spread));
        let (a, b) = (vector(), vector());
        let corner = |v: IntervalVec3, bits: u64| {
            let end = |x: Interval, bit: u64| if bits >> bit & 1 == 1 { x.hi() } else { x.lo() };
            DVec3::new(end(v.x, 0), end(v.y, 1), end(v.z, 2))
        };
        let (p, q) = (corner(a, random.bits()), corner(b, random.bits()));
        let product = |x: f64, y: f64| mul(&fixed(x), &fixed(y));
        let dot = product(p.x, q.x) + product(p.y, q.y) + product(p.z, q.z);
        let norm = product(p.x, p.x) + product(p.y, p.y) + product(p.z, p.z);
        let cross = [
            product(p.y, q.z) - product(p.z, q.y),
            product(p.z, q.x) - product(p.x, q.z),
            product(p.x, q.y) - product(p.y, q.x),
        ];
        let inside = |x: Interval, value: &Fixed| fixed(x.lo()) <= *value && *value <= fixed(x.hi());
        let same =
            |c: IntervalVec3| inside(c.x, &cross[0]) && inside(c.y, &cross[1]) && inside(c.z, &cross[2]);
        let kept = inside(a.dot(b), &dot)
            && inside(a.dot_point(q), &dot)
            && inside(a.norm_squared(), &norm)
            && same(a.cross(b))
            && same(a.cross_point(q));
        outcome.checked += 1;
        if !kept {
            outcome.lost += 1;
            outcome.example = format!("{a:?} {b:?} at {p:?} {q:?}");
        }
    }
    outcome
}

fn start(name: &'static str, allowed: u64) -> Outcome {
    Outcome { name, checked: 0, lost: 0, worst: 0, allowed, example: String::new() }
}

/// One family, ready to run.
pub type Job = Box<dyn Fn() -> Outcome + Send + Sync>;

/// Every family with `count` tuples (a fiftieth of it where the reference is slow), independent of each other.
pub fn jobs(count: u64, seed: u64) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    for family in binary() {
        let count = share_of(count, !["atan2", "pow"].contains(&family.name));
        jobs.push(Box::new(move || run_binary(&family, count, seed)));
    }
    for family in unary() {
        let fast = ["sqr", "sqrt", "recip", "abs", "powi 3", "powi 8", "powi -3"].contains(&family.name);
        jobs.push(Box::new(move || run_unary(&family, share_of(count, fast), seed)));
    }
    jobs.push(Box::new(move || run_vectors(count, seed)));
    jobs
}

fn share_of(count: u64, fast: bool) -> u64 {
    if fast { count } else { count.div_ceil(50) }
}
