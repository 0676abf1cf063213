//! Each operation with its exact value, where its arguments are drawn from, and what is promised of it.

use super::super::{Fixed, atan, atan2, div, exp, fixed, ln, ln_2, mul, one, quadrant, sin_cos, sqrt};
use super::drawn::{Domain, domain};
use d2m_interval::Interval;
use dashu_int::{IBig, ops::Abs};

pub(super) type Values = Vec<Fixed>;

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
