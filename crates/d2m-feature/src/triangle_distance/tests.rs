//! Distance and intersection against one exact oracle in rational arithmetic.

use crate::{triangle_distance, triangles_intersect};
use dashu_ratio::RBig;
use glam::DVec3;
use proptest::prelude::*;

type Exact = [RBig; 3];

fn exact(point: DVec3) -> Exact {
    point.to_array().map(|x| RBig::try_from(x).unwrap())
}

fn sub(a: &Exact, b: &Exact) -> Exact {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn dot(a: &Exact, b: &Exact) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Exact, b: &Exact) -> Exact {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn along(origin: &Exact, direction: &Exact, t: &RBig) -> Exact {
    [&origin[0] + &direction[0] * t, &origin[1] + &direction[1] * t, &origin[2] + &direction[2] * t]
}

fn norm(a: &Exact) -> RBig {
    dot(a, a)
}

/// Squared distance of a point from a segment.
fn point_segment(p: &Exact, [a, b]: [&Exact; 2]) -> RBig {
    let direction = sub(b, a);
    let length = norm(&direction);
    if length == RBig::ZERO {
        return norm(&sub(p, a));
    }
    let t = (dot(&sub(p, a), &direction) / length).clamp(RBig::ZERO, RBig::ONE);
    norm(&sub(p, &along(a, &direction, &t)))
}

fn inside(p: &Exact, t: &[Exact; 3], normal: &Exact) -> bool {
    (0..3).all(|k| dot(&cross(&sub(&t[(k + 1) % 3], &t[k]), &sub(p, &t[k])), normal) >= RBig::ZERO)
}

/// Exact squared distance: sides against sides (interior critical point and ends), vertices against faces, sides through
/// faces. The minimum over a pair of convex polygons is one of these.
fn squared_distance(a: &[DVec3; 3], b: &[DVec3; 3]) -> RBig {
    let (a, b) = (a.map(exact), b.map(exact));
    let mut best: Option<RBig> = None;
    let mut consider = |value: RBig| {
        if best.as_ref().is_none_or(|best| value < *best) {
            best = Some(value);
        }
    };
    for (s, t) in [(&a, &b), (&b, &a)] {
        let normal = cross(&sub(&t[1], &t[0]), &sub(&t[2], &t[0]));
        let squared = norm(&normal);
        for k in 0..3 {
            for l in 0..3 {
                consider(point_segment(&s[k], [&t[l], &t[(l + 1) % 3]]));
            }
            if squared == RBig::ZERO {
                continue;
            }
            if inside(&s[k], t, &normal) {
                let height = dot(&sub(&s[k], &t[0]), &normal);
                consider(&height * &height / &squared);
            }
            let direction = sub(&s[(k + 1) % 3], &s[k]);
            let speed = dot(&direction, &normal);
            if speed != RBig::ZERO {
                let time = dot(&sub(&t[0], &s[k]), &normal) / speed;
                if time >= RBig::ZERO
                    && time <= RBig::ONE
                    && inside(&along(&s[k], &direction, &time), t, &normal)
                {
                    consider(RBig::ZERO);
                }
            }
        }
    }
    for k in 0..3 {
        for l in 0..3 {
            let (p, q) = (&a[k], &b[l]);
            let (d, e) = (sub(&a[(k + 1) % 3], p), sub(&b[(l + 1) % 3], q));
            let normal = cross(&d, &e);
            let squared = norm(&normal);
            if squared == RBig::ZERO {
                continue;
            }
            let offset = sub(q, p);
            let s = dot(&cross(&offset, &e), &normal) / &squared;
            let t = dot(&cross(&offset, &d), &normal) / &squared;
            if [&s, &t].iter().all(|x| **x >= RBig::ZERO && **x <= RBig::ONE) {
                consider(norm(&sub(&along(p, &d, &s), &along(q, &e, &t))));
            }
        }
    }
    best.unwrap()
}

/// The enclosure holds, the verdict is exact; returns the width relative to the extent.
fn check(a: [DVec3; 3], b: [DVec3; 3]) -> f64 {
    let distance = triangle_distance(&a, &b);
    let squared = squared_distance(&a, &b);
    let square = |x: f64| RBig::try_from(x).unwrap() * RBig::try_from(x).unwrap();
    assert!(square(distance.lower) <= squared, "lower too large: {a:?} {b:?} {distance:?}");
    assert!(square(distance.upper) >= squared, "upper too small: {a:?} {b:?} {distance:?}");
    let meet = squared == RBig::ZERO;
    assert_eq!(triangles_intersect(&a, &b), meet, "{a:?} {b:?}");
    assert_eq!(triangles_intersect(&b, &a), meet, "{a:?} {b:?}");
    assert_eq!(distance.upper == 0.0, meet, "{a:?} {b:?} {distance:?}");
    for weights in [distance.barycentric_a, distance.barycentric_b] {
        assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)));
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
    let extent = a.iter().chain(&b).map(|p| (p - a[0]).abs().max_element()).fold(0.0, f64::max);
    (distance.upper - distance.lower) / extent.max(f64::MIN_POSITIVE)
}

fn point() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn grid() -> impl Strategy<Value = DVec3> {
    (-2_i32..3, -2_i32..3, -2_i32..3).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn random_triangles(a in prop::array::uniform3(point()), b in prop::array::uniform3(point()), apart in 0.0..2.0) {
        let width = check(a, b.map(|p| p + DVec3::X * apart));
        prop_assert!(width < 3e-14, "{}", width);
    }

    /// Small integers: every coincidence happens (shared vertices and edges, coplanar, collinear, points).
    #[test]
    fn coincidences(a in prop::array::uniform3(grid()), b in prop::array::uniform3(grid()), scale in prop::sample::select(vec![1.0, 0.1, 1e-200, 1e50])) {
        let width = check(a.map(|p| p * scale), b.map(|p| p * scale));
        prop_assert!(width < 3e-14, "{}", width);
    }

    /// A planted feature pair at a tiny distance: B starts as a point, a segment or a face on A, moved along a normal.
    #[test]
    fn nearly_touching(a in prop::array::uniform3(point()), b in prop::array::uniform3(point()), weights in prop::array::uniform3(0.0..1.0_f64), gap in -14_i32..-3, vertex in 0..3_usize) {
        let total: f64 = weights.iter().sum();
        prop_assume!(total > 0.1);
        let foot = (a[0] * weights[0] + a[1] * weights[1] + a[2] * weights[2]) / total;
        let shift = foot - b[vertex] + DVec3::new(0.3, -0.5, 0.8) * 10_f64.powi(gap);
        let width = check(a, b.map(|p| p + shift));
        prop_assert!(width < 3e-14, "{}", width);
    }

    /// Slivers: vertices squeezed along random axes.
    #[test]
    fn slivers(a in prop::array::uniform3(point()), b in prop::array::uniform3(point()), thin in -15_i32..1, thinner in -15_i32..1, gap in -14_i32..1) {
        let squeeze = |vertices: [DVec3; 3], axis: DVec3, factor: f64| {
            let axis = axis.normalize();
            vertices.map(|p| p - axis * (axis.dot(p - vertices[0]) * (1.0 - factor)))
        };
        let a = squeeze(a, a[1].cross(a[2]) + a[0], 10_f64.powi(thin));
        let b = squeeze(b, b[0] + DVec3::Z, 10_f64.powi(thinner));
        let shift = (a[0] + a[1]) * 0.5 - (b[1] + b[2]) * 0.5 + DVec3::new(0.6, 0.0, 0.8) * 10_f64.powi(gap);
        let width = check(a, b.map(|p| p + shift));
        prop_assert!(width < 3e-14, "{}", width);
    }

    /// Edges that cross at an angle of 1e-15 to 0.1: their common normal is mostly rounding.
    #[test]
    fn edges_that_cross_at_small_angles(ends in prop::array::uniform4(0.3..1.0_f64), tops in prop::array::uniform4(-1.0..1.0_f64), angle in -15.0..-1.0_f64, gap in -14.0..0.0_f64, turn in prop::array::uniform4(-1.0..1.0_f64)) {
        let turn = glam::DQuat::from_array(turn).normalize();
        prop_assume!(turn.is_finite());
        let (angle, gap) = (10_f64.powf(angle), 10_f64.powf(gap));
        let along = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let a = [-ends[0] * DVec3::X, ends[1] * DVec3::X, DVec3::new(tops[0], tops[1], -1.0)];
        let b = [-ends[2] * along, ends[3] * along, DVec3::new(tops[2], tops[3], 1.0)].map(|p| p + DVec3::Z * gap);
        let width = check(a.map(|p| turn * p), b.map(|p| turn * p));
        prop_assert!(width < 1e-13, "{}", width);
    }

    /// Triangles whose planes meet at an angle of 1e-15 to 0.1, side by side or one above the other.
    #[test]
    fn nearly_coplanar_triangles(a in prop::array::uniform3(point()), b in prop::array::uniform3(point()), angle in -15.0..-1.0_f64, gap in -14.0..0.0_f64, beside in -1.0..2.0_f64, turn in prop::array::uniform4(-1.0..1.0_f64)) {
        let turn = glam::DQuat::from_array(turn).normalize();
        prop_assume!(turn.is_finite());
        let (angle, gap) = (10_f64.powf(angle), 10_f64.powf(gap));
        let flat = |p: DVec3, slope: f64, height: f64| turn * DVec3::new(p.x, p.y, p.x * slope + height);
        let width = check(a.map(|p| flat(p, 0.0, 0.0)), b.map(|p| flat(p + DVec3::X * beside, angle, gap)));
        prop_assert!(width < 1e-13, "{}", width);
    }

    /// Sides of two slivers, nearly parallel, their long sides facing each other.
    #[test]
    fn slivers_that_cross_at_small_angles(heights in prop::array::uniform2(-15.0..0.0_f64), feet in prop::array::uniform2(0.0..1.0_f64), angle in -15.0..-1.0_f64, gap in -14.0..0.0_f64, turn in prop::array::uniform4(-1.0..1.0_f64)) {
        let turn = glam::DQuat::from_array(turn).normalize();
        prop_assume!(turn.is_finite());
        let (angle, gap) = (10_f64.powf(angle), 10_f64.powf(gap));
        let heights = heights.map(|height| 10_f64.powf(height));
        let along = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let across = DVec3::new(-angle.sin(), angle.cos(), 0.0);
        let a = [-DVec3::X, DVec3::X, DVec3::X * (2.0 * feet[0] - 1.0) + DVec3::new(0.0, 0.6, -0.8) * heights[0]];
        let b = [-along, along, along * (2.0 * feet[1] - 1.0) + (across * 0.8 + DVec3::Z * 0.6) * heights[1]];
        let width = check(a.map(|p| turn * p), b.map(|p| turn * (p + DVec3::Z * gap)));
        prop_assert!(width < 1e-13, "{}", width);
    }

    /// Multiplied by a power of two, up to where the numbers end.
    #[test]
    fn exact_scalings_change_nothing(a in prop::array::uniform3(point()), b in prop::array::uniform3(point()), apart in 0.0..2.0, exponent in -900_i32..1020) {
        let b = b.map(|p| p + DVec3::X * apart);
        let factor = f64::from_bits(((1023 + exponent) as u64) << 52);
        let (plain, twin) = (triangle_distance(&a, &b), triangle_distance(&a.map(|p| p * factor), &b.map(|p| p * factor)));
        prop_assert_eq!((twin.barycentric_a, twin.barycentric_b), (plain.barycentric_a, plain.barycentric_b));
        prop_assert_eq!(twin.direction, plain.direction);
        prop_assert_eq!((twin.lower, twin.upper), (plain.lower * factor, plain.upper * factor));
        prop_assert_eq!((twin.point_a, twin.point_b), (plain.point_a * factor, plain.point_b * factor));
    }
}
