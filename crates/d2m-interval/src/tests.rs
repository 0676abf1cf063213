//! Special cases of the representation: infinite ends against the definition, lanes against single intervals.
use glam::{DQuat, DVec3};

use crate::{Interval, IntervalMat3, IntervalVec3, IntervalVec3X4, IntervalX4};

const ENDS: [f64; 9] =
    [f64::NEG_INFINITY, -f64::MAX, -2.0, -1e-320, 0.0, 1e-320, 3.0, f64::MAX, f64::INFINITY];

/// Every interval with ends from the list, and the empty one.
fn all() -> std::vec::Vec<Interval> {
    let mut out = std::vec![Interval::EMPTY];
    let ends = if cfg!(miri) { &ENDS[3..6] } else { &ENDS[..] };
    for &lo in ends {
        out.extend(ends.iter().filter_map(|&hi| Interval::try_new(lo, hi).ok()));
    }
    out
}

/// Least and greatest product, with 0·∞ = 0, by cases: the definition.
fn product(x: Interval, y: Interval) -> Option<(f64, f64)> {
    if x.is_empty() || y.is_empty() {
        return None;
    }
    let times = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
    let p = [times(x.lo(), y.lo()), times(x.lo(), y.hi()), times(x.hi(), y.lo()), times(x.hi(), y.hi())];
    Some((p.into_iter().fold(f64::MAX, f64::min), p.into_iter().fold(-f64::MAX, f64::max)))
}

fn close(result: Interval, expected: Option<(f64, f64)>) -> bool {
    let Some((lo, hi)) = expected else { return result.is_empty() };
    let near = |a: f64, b: f64| a == b || (a - b).abs() <= 3.1e-151 || a.next_up() == b || a.next_down() == b;
    result.lo() <= lo && hi <= result.hi() && near(result.lo(), lo) && near(result.hi(), hi)
}

#[test]
fn products_with_infinite_ends_follow_the_definition() {
    for x in all() {
        for y in all() {
            let expected = product(x, y);
            assert!(close(x * y, expected), "{x:?} * {y:?} = {:?}, not {expected:?}", x * y);
            if y.is_singleton() {
                let z = x * y.lo();
                assert!(close(z, expected), "{x:?} * {} = {z:?}, not {expected:?}", y.lo());
            }
            if x.is_empty() || y.is_empty() {
                assert!((x / y).is_empty() && (x - y).is_empty() && x.sqr().is_empty() == x.is_empty());
            }
            let sum = if expected.is_none() {
                None
            } else {
                Some(((x.lo() + y.lo()).min(f64::MAX), (x.hi() + y.hi()).max(-f64::MAX)))
            };
            assert!(close(x + y, sum), "{x:?} + {y:?} = {:?}, not {sum:?}", x + y);
            let v = IntervalVec3::new(x, Interval::ZERO, Interval::ZERO);
            let w = IntervalVec3::new(y, Interval::ONE, Interval::ONE);
            let wide = v.dot(w);
            let near = |a: f64, b: f64| a == b || (a - b).abs() <= 2e-150 + 4.0 * f64::EPSILON * b.abs();
            match expected {
                None => assert!(wide.is_empty()),
                Some((lo, hi)) => {
                    assert!(wide.lo() <= lo && hi <= wide.hi(), "{v:?} · {w:?} = {wide:?}");
                    assert!(near(wide.lo(), lo) && near(wide.hi(), hi) || wide.mag() > f64::MAX);
                }
            }
            let c = v.cross(w);
            if expected.is_some() {
                assert!(c.x.contains_zero() && (-x).is_subset(c.y) && x.is_subset(c.z));
            } else {
                assert!(v.is_empty() || w.is_empty());
            }
        }
    }
}

fn same(a: Interval, b: Interval) -> bool {
    a.lo().to_bits() == b.lo().to_bits() && a.hi().to_bits() == b.hi().to_bits() || (a == b && a.lo() == 0.0)
}

#[test]
fn lanes_equal_single_intervals() {
    let xs = all();
    for i in 0..xs.len() {
        for j in 0..xs.len() {
            let pick = |k: usize| core::array::from_fn(|l| xs[(k + l * l * 7) % xs.len()]);
            let (x, y): ([Interval; 4], [Interval; 4]) = (pick(i), pick(j));
            let (a, b) = (IntervalX4::new(x), IntervalX4::new(y));
            for l in 0..4 {
                assert!(same((a + b).lane(l), x[l] + y[l]), "{:?} + {:?}", x[l], y[l]);
                assert!(same((a - b).lane(l), x[l] - y[l]));
                assert!((a * b).lane(l) == x[l] * y[l], "{:?} * {:?}", x[l], y[l]);
                assert!(same(a.sqr().lane(l), x[l].sqr()));
                assert!(same(a.sqrt().lane(l), x[l].sqrt()));
                assert!(same(a.hull(b).lane(l), x[l].hull(y[l])));
                let ((s, c), (t, d)) = (a.sin_cos(), x[l].sin_cos());
                assert!(same(s.lane(l), t) && same(c.lane(l), d), "{:?}", x[l]);
                assert_eq!(a.contains_zero() >> l & 1 == 1, x[l].contains_zero());
            }
        }
    }
    let v = [1.0, 0.3, -7.5, 1e10].map(|s| IntervalVec3::point(DVec3::new(s, 0.1 * s, 3.0 - s)));
    let w = [2.0, -0.7, 0.1, 3.0].map(|s| IntervalVec3::between(DVec3::splat(s), DVec3::new(s, 1.0, 2.0)));
    let (a, b) = (IntervalVec3X4::from_lanes(v), IntervalVec3X4::from_lanes(w));
    for l in 0..4 {
        assert!(same(a.dot(b).lane(l), v[l].dot(w[l])));
        assert_eq!(a.cross(b).lane(l), v[l].cross(w[l]));
        assert!(same(b.norm_squared().lane(l), w[l].norm_squared()));
        assert_eq!((a + b).lane(l), v[l] + w[l]);
        assert_eq!(a.scaled(b.x).lane(l), v[l] * w[l].x);
        assert_eq!(a.rotated(b, b.x).lane(l), v[l].rotated(w[l], w[l].x));
    }
    for i in 0..if cfg!(miri) { 20 } else { 2000 } {
        let f = 0.01 * f64::from(i) - 7.0;
        let x = [0.0, 0.3, 1.7, 4.0].map(|w| Interval::new(f * (1.0 + w), f * (1.0 + w) + w));
        let (s, c) = IntervalX4::new(x).sin_cos();
        for (l, x) in x.into_iter().enumerate() {
            let (t, d) = x.sin_cos();
            assert!(same(s.lane(l), t) && same(c.lane(l), d), "{x:?} {:?}", s.lane(l));
        }
    }
}

#[test]
fn rotations_agree() {
    let omega = DVec3::new(0.3, -2.0, 1.1);
    let t = 0.77;
    let m = IntervalMat3::rotation(omega, Interval::point(t));
    let q = DQuat::from_scaled_axis(omega * t);
    let n = IntervalMat3::from_quat_normalized(q * 3.0);
    let p = DVec3::new(1.0, 2.0, -3.0);
    for v in [m * p, n * p] {
        assert!((v.mid() - q * p).length() < 1e-14);
        assert!(v.x.width() < 1e-13);
    }
    assert!(m.mul_mat(n.transpose()).rows()[0].x.contains(1.0 - 1e-16));
    // Over a whole interval of time, each instant is inside.
    let swept = IntervalMat3::rotation(omega, Interval::new(-0.5, 1.5)) * p;
    for i in 0..=20 {
        let t = -0.5 + 0.1 * f64::from(i);
        assert!(swept.contains((IntervalMat3::rotation(omega, Interval::point(t)) * p).mid()));
    }
}

#[test]
fn rotations_of_extreme_vectors() {
    for scale in [1e-300, 1e-150, 1e-20, 1e150, 1e300] {
        let q = IntervalMat3::from_quat_normalized(DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5) * scale);
        let v = q * DVec3::X;
        assert!(v.contains(DVec3::Y) && v.y.width() < 1e-14, "{scale:e} {v:?}");
        let r =
            IntervalMat3::rotation(DVec3::Z * scale, Interval::point(core::f64::consts::FRAC_PI_2 / scale));
        let v = r * DVec3::X;
        assert!((v.mid() - DVec3::Y).length() < 1e-14 && v.y.width() < 1e-12, "{scale:e} {v:?}");
    }
    let any = IntervalMat3::from_quat_normalized(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)) * DVec3::X;
    assert!(any.x.contains(1.0) && any.x.contains(-1.0));
    let any = IntervalMat3::from_quat_normalized(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)) * DVec3::Y;
    assert!(any.y.contains(1.0) && any.y.contains(-1.0));
    assert_eq!(IntervalMat3::rotation(DVec3::ZERO, Interval::ENTIRE), IntervalMat3::IDENTITY);
}
