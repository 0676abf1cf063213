//! Interval arithmetic on one kernel: rotate a point by Rodrigues' formula with interval sine and cosine, then one
//! triple product and one squared norm. Rows: this crate, its 4-wide batch, plain pairs of doubles without any
//! rounding, and std's `next_up`/`next_down` after every operation. Each row is judged before it is timed.
//!
//! `--features interval-peers` adds maryada.
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use d2m_interval::{Interval, IntervalVec3, IntervalVec3X4, IntervalX4};
use glam::DVec3;

/// What a row needs of its number type.
trait Number: Copy {
    fn new(lo: f64, hi: f64) -> Self;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn sqr(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn ends(self) -> (f64, f64);
}

type Vec3<N> = [N; 3];

/// Axis, angle, point, two further vectors of the kernel.
type KernelInput = (IntervalVec3, Interval, IntervalVec3, [IntervalVec3; 2]);

fn dot<N: Number>(a: Vec3<N>, b: Vec3<N>) -> N {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

fn cross<N: Number>(a: Vec3<N>, b: Vec3<N>) -> Vec3<N> {
    [
        a[1].mul(b[2]).sub(a[2].mul(b[1])),
        a[2].mul(b[0]).sub(a[0].mul(b[2])),
        a[0].mul(b[1]).sub(a[1].mul(b[0])),
    ]
}

fn scale<N: Number>(a: Vec3<N>, s: N) -> Vec3<N> {
    a.map(|x| s.mul(x))
}

fn sum<N: Number>(a: Vec3<N>, b: Vec3<N>) -> Vec3<N> {
    [a[0].add(b[0]), a[1].add(b[1]), a[2].add(b[2])]
}

/// The kernel, operation by operation.
#[inline(always)]
fn kernel<N: Number>(axis: Vec3<N>, angle: N, p: Vec3<N>, edges: [Vec3<N>; 2]) -> (N, N) {
    let (sin, cos) = angle.sin_cos();
    let versine = N::new(1.0, 1.0).sub(cos);
    let along = scale(axis, dot(axis, p).mul(versine));
    let q = sum(sum(scale(p, cos), scale(cross(axis, p), sin)), along);
    let norm = q[0].sqr().add(q[1].sqr()).add(q[2].sqr());
    (dot(q, cross(edges[0], edges[1])), norm)
}

/// The kernel with this crate's vectors.
#[inline(always)]
fn fused(
    axis: IntervalVec3,
    angle: Interval,
    p: IntervalVec3,
    edges: [IntervalVec3; 2],
) -> (Interval, Interval) {
    let q = p.rotated(axis, angle);
    (q.triple_product(edges[0], edges[1]), q.norm_squared())
}

/// Four kernels at once.
#[inline(always)]
fn batch(
    axis: IntervalVec3X4,
    angle: IntervalX4,
    p: IntervalVec3X4,
    edges: [IntervalVec3X4; 2],
) -> (IntervalX4, IntervalX4) {
    let q = p.rotated(axis, angle);
    (q.dot(edges[0].cross(edges[1])), q.norm_squared())
}

/// Two doubles and no rounding: what the hardware could do without any care.
#[derive(Clone, Copy)]
struct Pair(f64, f64);

fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

fn product_ends(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (p, q, r, s) = (a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1);
    (less(less(p, q), less(r, s)), more(more(p, q), more(r, s)))
}

fn square_ends(a: (f64, f64)) -> (f64, f64) {
    let greatest = more(-a.0, a.1);
    let least = more(more(a.0, -a.1), 0.0);
    (least * least, greatest * greatest)
}

/// Sine and cosine between 0 and π, from the platform's functions.
fn sine_ends(a: (f64, f64)) -> ((f64, f64), (f64, f64)) {
    let ((s0, c0), (s1, c1)) = (a.0.sin_cos(), a.1.sin_cos());
    let quarter = std::f64::consts::FRAC_PI_2;
    let top = if a.0 <= quarter && quarter <= a.1 { 1.0 } else { more(s0, s1) };
    ((less(s0, s1), top), (less(c0, c1), more(c0, c1)))
}

impl Number for Pair {
    #[inline(always)]
    fn new(lo: f64, hi: f64) -> Self {
        Self(lo, hi)
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.1, self.1 - o.0)
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (a, b) = product_ends((self.0, self.1), (o.0, o.1));
        Self(a, b)
    }
    #[inline(always)]
    fn sqr(self) -> Self {
        let (a, b) = square_ends((self.0, self.1));
        Self(a, b)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = sine_ends((self.0, self.1));
        (Self(s.0, s.1), Self(c.0, c.1))
    }
    fn ends(self) -> (f64, f64) {
        (self.0, self.1)
    }
}

/// std's `next_down` and `next_up` after every operation.
#[derive(Clone, Copy)]
struct Stepped(f64, f64);

impl Stepped {
    #[inline(always)]
    fn out((lo, hi): (f64, f64)) -> Self {
        Self(lo.next_down(), hi.next_up())
    }
}

impl Number for Stepped {
    #[inline(always)]
    fn new(lo: f64, hi: f64) -> Self {
        Self(lo, hi)
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::out((self.0 + o.0, self.1 + o.1))
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::out((self.0 - o.1, self.1 - o.0))
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::out(product_ends((self.0, self.1), (o.0, o.1)))
    }
    #[inline(always)]
    fn sqr(self) -> Self {
        Self::out(square_ends((self.0, self.1)))
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = sine_ends((self.0, self.1));
        (Self::out(s), Self::out(c))
    }
    fn ends(self) -> (f64, f64) {
        (self.0, self.1)
    }
}

#[cfg(feature = "interval-peers")]
#[path = "interval_peers/mod.rs"]
mod peers;

struct Case {
    axis: DVec3,
    angle: (f64, f64),
    p: [DVec3; 2],
    edges: [DVec3; 2],
}

fn cases() -> Vec<Case> {
    (0..64)
        .map(|i| {
            let f = f64::from(i);
            let p = DVec3::new(0.3 + 0.01 * f, 1.0 - 0.02 * f, 0.5);
            Case {
                axis: DVec3::new(1.0, 0.1 * f, -0.5).normalize(),
                angle: (0.04 * f, 0.04 * f + 0.01),
                p: [p, p + DVec3::splat(1e-3)],
                edges: [DVec3::new(1.0, 0.2, 0.03 * f), DVec3::new(-0.3, 1.0, 0.2)],
            }
        })
        .collect()
}

type Input<N> = (Vec3<N>, N, Vec3<N>, [Vec3<N>; 2]);

fn inputs<N: Number>() -> Vec<Input<N>> {
    let point = |v: DVec3| v.to_array().map(|x| N::new(x, x));
    cases()
        .iter()
        .map(|c| {
            let [a, b] = c.p.map(|v| v.to_array());
            let p = [N::new(a[0], b[0]), N::new(a[1], b[1]), N::new(a[2], b[2])];
            (point(c.axis), N::new(c.angle.0, c.angle.1), p, c.edges.map(point))
        })
        .collect()
}

/// The row must enclose the value at a corner of the input, up to the roundings of a row that has none.
fn judge<N: Number>(name: &str, rigorous: bool) {
    for (input, case) in inputs::<N>().into_iter().zip(cases()) {
        let (triple, norm) = kernel(input.0, input.1, input.2, input.3);
        check(name, rigorous, triple.ends(), norm.ends(), &case);
    }
}

fn check(name: &str, rigorous: bool, triple: (f64, f64), norm: (f64, f64), case: &Case) {
    let q = glam::DQuat::from_axis_angle(case.axis, case.angle.1) * case.p[1];
    let slack = if rigorous { 0.0 } else { 1e-12 };
    let value = q.dot(case.edges[0].cross(case.edges[1]));
    assert!(triple.0 - slack <= value && value <= triple.1 + slack, "{name}: {triple:?} without {value}");
    let value = q.length_squared();
    assert!(norm.0 - slack <= value && value <= norm.1 + slack, "{name}: {norm:?} without {value}");
    assert!(norm.1 - norm.0 < 0.2, "{name}: too wide");
}

fn row<N: Number>(criterion: &mut Criterion, name: &str, rigorous: bool) {
    judge::<N>(name, rigorous);
    let inputs = inputs::<N>();
    let mut i = 0;
    criterion.bench_function(name, |b| {
        b.iter(|| {
            i = (i + 1) % inputs.len();
            let input = black_box(inputs[i]);
            let (x, y) = kernel(input.0, input.1, input.2, input.3);
            (x.ends(), y.ends())
        });
    });
}

fn ours(criterion: &mut Criterion) {
    let vector = |p: [DVec3; 2]| IntervalVec3::between(p[0], p[1]);
    let cases = cases();
    let inputs: Vec<_> = cases
        .iter()
        .map(|c| {
            (
                IntervalVec3::point(c.axis),
                Interval::new(c.angle.0, c.angle.1),
                vector(c.p),
                c.edges.map(IntervalVec3::point),
            )
        })
        .collect();
    for (input, case) in inputs.iter().zip(&cases) {
        let (triple, norm) = fused(input.0, input.1, input.2, input.3);
        check("d2m", true, (triple.lo(), triple.hi()), (norm.lo(), norm.hi()), case);
    }
    let mut i = 0;
    criterion.bench_function("kernel/d2m-interval", |b| {
        b.iter(|| {
            i = (i + 1) % inputs.len();
            let input = black_box(inputs[i]);
            fused(input.0, input.1, input.2, input.3)
        });
    });
    let fours: Vec<_> = inputs
        .chunks_exact(4)
        .map(|c| {
            let four = |f: fn(&KernelInput) -> IntervalVec3| {
                IntervalVec3X4::from_lanes([f(&c[0]), f(&c[1]), f(&c[2]), f(&c[3])])
            };
            let angle = IntervalX4::new([c[0].1, c[1].1, c[2].1, c[3].1]);
            (four(|x| x.0), angle, four(|x| x.2), [four(|x| x.3[0]), four(|x| x.3[1])])
        })
        .collect();
    for (j, input) in fours.iter().enumerate() {
        let (triple, norm) = batch(input.0, input.1, input.2, input.3);
        for lane in 0..4 {
            let (x, y) = (triple.lane(lane), norm.lane(lane));
            check("d2m ×4", true, (x.lo(), x.hi()), (y.lo(), y.hi()), &cases[4 * j + lane]);
        }
    }
    criterion.bench_function("kernel/d2m-interval, four at once", |b| {
        b.iter(|| {
            i = (i + 1) % fours.len();
            let input = black_box(fours[i]);
            batch(input.0, input.1, input.2, input.3)
        });
    });
    criterion.bench_function("sin_cos/d2m-interval", |b| {
        b.iter(|| {
            i = (i + 1) % inputs.len();
            black_box(inputs[i].1).sin_cos()
        });
    });
}

fn operations(criterion: &mut Criterion) {
    let (x, y) = (Interval::new(0.3, 0.4), Interval::new(0.7, 0.9));
    macro_rules! time {
        ($($name:literal $f:expr),* $(,)?) => {$(
            criterion.bench_function(concat!("operation/", $name), |b| b.iter(|| {
                let f: fn(Interval, Interval) -> Interval = $f;
                f(black_box(x), black_box(y))
            }));
        )*};
    }
    time!(
        "add" | a,
        b | a + b,
        "mul" | a,
        b | a * b,
        "div" | a,
        b | a / b,
        "sqr" | a,
        _ | a.sqr(),
        "sqrt" | a,
        _ | a.sqrt(),
        "exp" | a,
        _ | a.exp(),
        "ln" | a,
        _ | a.ln(),
        "tan" | a,
        _ | a.tan(),
        "atan" | a,
        _ | a.atan(),
        "asin" | a,
        _ | a.asin(),
        "sinc" | a,
        _ | a.sinc(),
        "powi 7" | a,
        _ | a.powi(7),
        "pow" | a,
        b | a.pow(b),
        "atan2" | a,
        b | a.atan2(b),
        "sinh" | a,
        _ | a.sinh(),
    );
}

fn rows(criterion: &mut Criterion) {
    ours(criterion);
    row::<Pair>(criterion, "kernel/pairs without rounding", false);
    row::<Stepped>(criterion, "kernel/next_up and next_down", true);
    #[cfg(feature = "interval-peers")]
    peers::rows(criterion);
    operations(criterion);
}

criterion_group!(benches, rows);
criterion_main!(benches);
