//! Eigenvectors of symmetric matrices, one matrix to a lane.
//!
//! Only a heuristic: axes of boxes may be any. No trigonometric function is called, so trees have the same bits on every
//! platform.

use d2m_lanes::Lanes;
use d2m_lanes::three::{dot, times};

/// Keeps a quotient of two zeros from being no number. Matrices have traces of about one.
const TINY: f32 = 1e-30;
/// Squarings of a matrix until its largest eigenvalue stands out: the 32nd power.
const SQUARINGS: usize = 5;

/// About the unit eigenvectors of the matrices with the entries xx, yy, zz, xy, xz, yz, in units of their traces; the largest
/// eigenvalue first.
///
/// A column of a high power of the matrix is about the first eigenvector, and what the matrix does across it has two more. Where
/// the first two eigenvalues are alike that is some direction between theirs, as good as they are. Rotations by Jacobi's method
/// take four times as long: each waits for the roots of the one before.
#[inline(always)]
pub(super) fn principal_axes<L: Lanes>(m: [L; 6]) -> [[L; 3]; 3] {
    let first = first_axis(m);
    let [u, w] = across(first);
    // The matrix across the first axis, in two dimensions, and its larger eigenvector (cosine, sine).
    let (mu, mw) = (applied(&m, &u), applied(&m, &w));
    let (uu, uw, ww) = (dot(&u, &mu), dot(&u, &mw), dot(&w, &mw));
    let (zero, difference, twice) = (L::splat(0.0), uu - ww, uw + uw);
    let root = (difference * difference + twice * twice).sqrt();
    // Along u as far as that is the larger one; else along w.
    let longer = root + difference.abs() + L::splat(TINY);
    let cosine = L::if_greater(zero, difference, twice, longer);
    let sine = L::if_greater(zero, difference, longer, twice);
    let inverse = L::splat(1.0) / (cosine * cosine + sine * sine + L::splat(f32::MIN_POSITIVE)).sqrt();
    let (cosine, sine) = (cosine * inverse, sine * inverse);
    let (mut second, mut third) = (u, w);
    for k in 0..3 {
        second[k] = cosine * u[k] + sine * w[k];
        third[k] = cosine * w[k] - sine * u[k];
    }
    [first, second, third]
}

#[inline(always)]
fn first_axis<L: Lanes>(m: [L; 6]) -> [L; 3] {
    let mut power = m;
    for _ in 0..SQUARINGS {
        let [xx, yy, zz, xy, xz, yz] = power;
        let square = [
            xx * xx + xy * xy + xz * xz,
            xy * xy + yy * yy + yz * yz,
            xz * xz + yz * yz + zz * zz,
            xx * xy + xy * yy + xz * yz,
            xx * xz + xy * yz + xz * zz,
            xy * xz + yy * yz + yz * zz,
        ];
        let scale = L::splat(1.0) / (square[0] + square[1] + square[2] + L::splat(TINY));
        for k in 0..6 {
            power[k] = square[k] * scale;
        }
    }
    // The column with the largest entry of the diagonal.
    let [xx, yy, zz, xy, xz, yz] = power;
    let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut first = columns[0];
    for k in 0..3 {
        first[k] = L::if_greater(yy, xx.max(zz), columns[1][k], first[k]);
        first[k] = L::if_greater(zz, xx.max(yy), columns[2][k], first[k]);
    }
    unit(first)
}

/// Two more of an orthonormal frame; not longer than one where `v` is shorter.
#[inline(always)]
fn across<L: Lanes>(v: [L; 3]) -> [[L; 3]; 2] {
    let [a, b, c] = v;
    // Beside the coordinate axis that is farthest from it.
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let is_x = L::if_greater(a.abs(), b.abs().min(c.abs()), zero, one);
    let is_y = L::if_greater(b.abs(), c.abs(), zero, one - is_x);
    let is_z = one - is_x - is_y;
    let u = unit([b * is_z - c * is_y, c * is_x - a * is_z, a * is_y - b * is_x]);
    [u, [b * u[2] - c * u[1], c * u[0] - a * u[2], a * u[1] - b * u[0]]]
}

#[inline(always)]
fn applied<L: Lanes>(m: &[L; 6], v: &[L; 3]) -> [L; 3] {
    let [xx, yy, zz, xy, xz, yz] = *m;
    [dot(&[xx, xy, xz], v), dot(&[xy, yy, yz], v), dot(&[xz, yz, zz], v)]
}

/// Not longer than one; zero stays zero.
#[inline(always)]
fn unit<L: Lanes>(v: [L; 3]) -> [L; 3] {
    let inverse = L::splat(1.0) / (dot(&v, &v) + L::splat(TINY)).sqrt();
    times(&v, inverse)
}
