//! The rotation of a constant-twist motion at one time, accurate however far that time is from the reference time.

use core::ops::Mul;
use d2m_lanes::{DoubleDouble, power_of_two_below};
use glam::DVec3;

/// Columns of a 3×3 matrix.
pub(crate) type Columns = [DVec3; 3];

/// What the rotation of a motion is at all times: a turn about a fixed axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FixedAxisRotation {
    /// The orientation at the reference time.
    start: Columns,
    /// Unit vector; zero for a motion without rotation.
    axis: DVec3,
    /// |ω|.
    speed: DoubleDouble,
}

/// Sine and 1 − cosine of the angle that a motion has turned by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinVersine {
    pub(crate) sin: f64,
    pub(crate) versine: f64,
}

/// A vector p that turns about a unit axis k: p, k × p and k × (k × p) at the reference time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RodriguesTerms {
    pub(crate) p: DVec3,
    pub(crate) across: DVec3,
    pub(crate) inward: DVec3,
}

impl RodriguesTerms {
    pub(crate) fn at(&self, turn: &SinVersine) -> DVec3 {
        self.p + self.across * turn.sin + self.inward * turn.versine
    }
}

impl FixedAxisRotation {
    /// From the orientation [x, y, z, w] at the reference time and the angular velocity.
    pub(crate) fn new(orientation: [f64; 4], omega: DVec3) -> Self {
        let (mut axis, mut speed) = (DVec3::ZERO, DoubleDouble::new(0.0, 0.0));
        let largest = omega.abs().max_element();
        if largest > 0.0 {
            // Divided by a power of two, so that no square over- or underflows.
            let unit = power_of_two_below(largest);
            let w = omega / unit;
            let square = DoubleDouble::from_product(w.x, w.x)
                .add_sloppily(DoubleDouble::from_product(w.y, w.y))
                .add_sloppily(DoubleDouble::from_product(w.z, w.z));
            let root = square.hi.sqrt();
            let rest = square.add_sloppily({
                let p = DoubleDouble::from_product(root, root);
                DoubleDouble::new(-p.hi, -p.lo)
            });
            let length = DoubleDouble::from_sum(root, rest.hi / (2.0 * root));
            axis = w / length.hi;
            speed = DoubleDouble::new(length.hi * unit, length.lo * unit);
        }
        Self { start: from_quaternion(orientation), axis, speed }
    }

    /// The columns of the orientation at the reference time.
    pub(crate) const fn start(&self) -> Columns {
        self.start
    }

    /// |ω|.
    pub(crate) const fn speed(&self) -> f64 {
        self.speed.hi
    }

    /// ω/|ω|; zero for a motion without rotation.
    pub(crate) const fn axis(&self) -> DVec3 {
        self.axis
    }

    /// How a vector that is `p` at the reference time turns.
    pub(crate) fn terms_of(&self, p: DVec3) -> RodriguesTerms {
        let across = self.axis.cross(p);
        RodriguesTerms { p, across, inward: self.axis.cross(across) }
    }

    /// After a time, counted from the reference time.
    pub(crate) fn after(&self, elapsed: DoubleDouble) -> SinVersine {
        if elapsed.hi == 0.0 || self.speed.hi == 0.0 {
            return SinVersine { sin: 0.0, versine: 0.0 };
        }
        let (sin, versine) = sin_versine(self.speed.mul(elapsed));
        SinVersine { sin, versine }
    }
}

/// The rotation of q/|q|, q = [x, y, z, w], scaled first so that no square overflows.
fn from_quaternion(q: [f64; 4]) -> Columns {
    let largest = q.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    let [x, y, z, w] = q.map(|c| c / largest);
    let two = 2.0 / (x * x + y * y + z * z + w * w);
    let (xx, yy, zz) = (x * x * two, y * y * two, z * z * two);
    let (xy, xz, yz) = (x * y * two, x * z * two, y * z * two);
    let (wx, wy, wz) = (w * x * two, w * y * two, w * z * two);
    [
        DVec3::new(1.0 - (yy + zz), xy + wz, xz - wy),
        DVec3::new(xy - wz, 1.0 - (xx + zz), yz + wx),
        DVec3::new(xz + wy, yz - wx, 1.0 - (xx + yy)),
    ]
}

/// Sine and 1 − cosine of an angle given as a pair: reduced by multiples of π/2 with 2⁻¹⁶⁰ left out, then
/// Taylor polynomials whose remainders on |r| ≤ π/4 are below 2⁻⁵⁷.
fn sin_versine(angle: DoubleDouble) -> (f64, f64) {
    use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²: adding it rounds to an integer
    // π/2 less its double, and less that: the second and the third double of π/2.
    const HALF_PI_MIDDLE: f64 = 6.123_233_995_736_766e-17;
    const HALF_PI_LOW: f64 = -1.497_384_904_859_17e-33;
    let shifted = angle.hi * FRAC_2_PI + ROUND;
    let turns = shifted - ROUND;
    let reduced = angle
        .add_sloppily(DoubleDouble::from_product(-turns, FRAC_PI_2))
        .add_sloppily(DoubleDouble::from_product(-turns, HALF_PI_MIDDLE))
        .add_sloppily(DoubleDouble::from_product(-turns, HALF_PI_LOW));
    let (x, y) = (reduced.hi, reduced.lo);
    let z = x * x;
    let mut odd = 1.0;
    for k in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        odd = 1.0 - odd * (z * (1.0 / (k * (k - 1.0))));
    }
    let mut even = 1.0;
    for k in [18.0, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0] {
        even = 1.0 - even * (z * (1.0 / (k * (k - 1.0))));
    }
    let versine = even * z * 0.5;
    let (sin, cos) = (x * odd + y * (1.0 - versine), 1.0 - (versine + x * y));
    match shifted.to_bits() & 3 {
        0 => (sin, versine + x * y),
        1 => (cos, 1.0 + sin),
        2 => (-sin, 1.0 + cos),
        _ => (-cos, 1.0 - sin),
    }
}
