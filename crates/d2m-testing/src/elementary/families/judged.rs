//! Families run against the exact reference.

use super::super::{Fixed, fixed, mul, to_doubles};
use super::drawn::domain;
use super::table::{Binary, Unary, Values};
use crate::Random;
use d2m_interval::{Interval, IntervalVec3};
use dashu_int::{IBig, ops::Abs};
use glam::DVec3;

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
    let ([tightest_lo, _], [_, tightest_hi]) = (to_doubles(least), to_doubles(greatest));
    let far = excess(result.lo(), tightest_lo).max(excess(result.hi(), tightest_hi));
    if far > outcome.worst {
        outcome.worst = far;
        if outcome.lost == 0 {
            outcome.example = format!("{} -> {result:?}", describe());
        }
    }
}

fn start(name: &'static str, allowed: u64) -> Outcome {
    Outcome { name, checked: 0, lost: 0, worst: 0, allowed, example: String::new() }
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
