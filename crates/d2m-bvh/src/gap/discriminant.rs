//! The direction along which two boxes are the furthest apart against their spreads.
//!
//! With the spreads S = Σ hᵢ² aᵢaᵢᵀ of two boxes (aᵢ unit axes, hᵢ half extents) and c from the center of the one to that of the
//! other, n·c is largest against √(n·S_A n + n·S_B n) for n = (S_A + S_B)⁻¹ c: Fisher's linear discriminant (Fisher 1936, DOI
//! 10.1111/j.1469-1809.1936.tb02137.x), with boxes for classes. Any direction may be tried, so nothing rests on its accuracy but
//! that it is no longer than a unit vector.

use core::ops::{Add, Mul, Sub};
use d2m_lanes::Lanes;
use d2m_lanes::three::{dot, times};
use d2m_mesh::margin::UNIT_F32;

/// Part of the sum of all squared half extents that is added to each of the spreads' principal values: boxes without
/// thickness have an inverse then, and flat ones count for a little more than their normals, which saves tests
/// (docs/experiments.md).
const BLUNT: f32 = 1.0 / 64.0;
/// The square of a unit vector's length is computed as at most this, unless numbers underflow.
const LONGEST_SQUARE: f32 = 1.0 + 16.0 * UNIT_F32 as f32;

/// The spread of a box, or of each lane's: the entries xx, yy, zz, xy, xz, yz of a symmetric matrix.
#[derive(Clone, Copy)]
pub(crate) struct Spread<T>([T; 6]);

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Spread<T> {
    /// Of a box with these axes and half extents. With Σ aᵢaᵢᵀ = 1 two of the axes are enough.
    #[inline(always)]
    pub(crate) fn new(axes: [&[T; 3]; 2], half: &[T; 3]) -> Self {
        let least = half[2] * half[2];
        let weights = [half[0] * half[0] - least, half[1] * half[1] - least];
        let [[x, y, z], [u, v, w]] = axes;
        let first = [*x * weights[0], *y * weights[0], *z * weights[0]];
        let second = [*u * weights[1], *v * weights[1], *w * weights[1]];
        Self([
            first[0] * *x + second[0] * *u + least,
            first[1] * *y + second[1] * *v + least,
            first[2] * *z + second[2] * *w + least,
            first[0] * *y + second[0] * *v,
            first[0] * *z + second[0] * *w,
            first[1] * *z + second[1] * *w,
        ])
    }
}

impl Spread<f32> {
    /// The same for all lanes.
    #[inline(always)]
    pub(crate) fn splat<L: Lanes>(&self) -> Spread<L> {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        Spread([L::splat(xx), L::splat(yy), L::splat(zz), L::splat(xy), L::splat(xz), L::splat(yz)])
    }
}

/// The vectors made unit vectors, no longer than 1 + 10u; zero or not a number, along which nothing is proven apart, where that
/// fails.
///
/// The inverse of the length, from a sum of three squares, errs by 3.5u and the product by u: a computed square is within 12u of one
/// unless numbers underflow, and one of at most 1 + 16u, itself 3u off, means a length of less than 1 + 10u.
#[inline(always)]
pub(crate) fn unit<L: Lanes>(v: &[L; 3]) -> [L; 3] {
    let inverse = L::splat(1.0) / dot(v, v).sqrt();
    let n = times(v, inverse);
    let square = dot(&n, &n);
    // The vector itself where its square is not a number: neither is a gap along it.
    let keep = |x: L| L::if_greater(square, L::splat(LONGEST_SQUARE), L::splat(0.0), x);
    [keep(n[0]), keep(n[1]), keep(n[2])]
}

/// The direction (S_A + S_B + λ·1)⁻¹ c as [`unit`] gives it; `line`: c, or any multiple.
#[inline(always)]
pub(crate) fn discriminant<L: Lanes>(Spread(a): &Spread<L>, Spread(b): &Spread<L>, line: &[L; 3]) -> [L; 3] {
    let [mut xx, mut yy, mut zz] = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [mut xy, mut xz, mut yz] = [a[3] + b[3], a[4] + b[4], a[5] + b[5]];
    // By their sum, so that the products below are about one whatever the boxes' size.
    let scale = L::splat(1.0) / (xx + yy + zz);
    let blunt = L::splat(BLUNT);
    (xx, yy, zz) = (xx * scale + blunt, yy * scale + blunt, zz * scale + blunt);
    (xy, xz, yz) = (xy * scale, xz * scale, yz * scale);
    // The inverse times the determinant.
    let inverse = [
        [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy],
        [xz * yz - xy * zz, xx * zz - xz * xz, xy * xz - xx * yz],
        [xy * yz - xz * yy, xy * xz - xx * yz, xx * yy - xy * xy],
    ];
    unit(&[dot(&inverse[0], line), dot(&inverse[1], line), dot(&inverse[2], line)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_lanes::{Elementwise, Portable};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::{DMat3, DQuat, DVec3};

    fn lanes(v: DVec3) -> [Portable; 3] {
        v.to_array().map(|x| Portable::splat(x as f32))
    }

    fn vector(v: &[Portable; 3]) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| f64::from(v[k].store()[0])))
    }

    /// From lengths whose squares underflow to those whose squares overflow: never longer than one.
    #[test]
    fn unit_vectors_are_no_longer_than_one() {
        let mut random = KnuthRandom(31);
        for power in -450_i32..380 {
            for _ in 0..40 {
                let v = random.vector() * 10f64.powf(0.1 * f64::from(power));
                let length = vector(&unit(&lanes(v))).length();
                let long = length > 1.0 + 10.0 * UNIT_F32;
                assert!(!long, "{v} becomes longer than one by {:e}", length - 1.0);
                let middling = power.abs() < 150 && v.length() > 1e-3 * v.abs().max_element();
                assert!(!middling || length > 1.0 - 10.0 * UNIT_F32, "{v} becomes {length}");
            }
        }
    }

    /// What the direction solves, in twice the digits; boxes without thickness and of every size.
    #[test]
    fn the_discriminant_solves_its_equation() {
        let mut random = KnuthRandom(32);
        for round in 0..2000 {
            let size = 10f64.powi(round % 13 - 6);
            let mut sum = DMat3::ZERO;
            let spreads = [0, 1].map(|_| {
                let turn =
                    DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.2).normalize();
                let axes = DMat3::from_quat(turn);
                let flat = if round % 3 == 0 { 0.0 } else { random.signed().abs() };
                let half = DVec3::new(1.0, random.signed().abs(), flat) * size;
                sum += axes * DMat3::from_diagonal(half * half) * axes.transpose();
                Spread::new([&lanes(axes.x_axis), &lanes(axes.y_axis)], &lanes(half))
            });
            let line = random.vector().normalize();
            let n = vector(&discriminant(&spreads[0], &spreads[1], &lanes(line)));
            let trace = sum.x_axis.x + sum.y_axis.y + sum.z_axis.z;
            let solved = (sum + DMat3::from_diagonal(DVec3::splat(trace * f64::from(BLUNT)))) * n;
            let off = solved.normalize().cross(line).length();
            assert!(off < 1e-4 && solved.dot(line) > 0.0, "{round}: {off:e}");
        }
    }
}
