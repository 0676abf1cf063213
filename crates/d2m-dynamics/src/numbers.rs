//! Which numbers of bodies can be used, whether they are given or read.

use crate::shown::{shown, shown_turn};
use crate::{SimulationError, SimulationOptions};
use glam::{DQuat, DVec3, DVec4};

/// No momentum, angular momentum or velocity of a body may exceed this: their products are still finite.
pub(crate) const LARGEST: f64 = 1e100;
/// How far the square of a unit vector's length may be off one. A root, four products and three sums make it
/// a unit vector, and a rotation turns it: fewer than 32 operations of relative error 2⁻⁵³ each. Half of that
/// in its length is less than bounds of flights allow for.
const UNIT: f64 = 32.0 * f64::EPSILON;

/// 2⁻⁴⁰⁰: squares of numbers between this and its inverse are far from the ends of doubles, which are 2⁻¹⁰²² (with
/// all digits) and 2¹⁰²⁴.
const SHORT: f64 = f64::from_bits((1023 - 400) << 52);
/// 2⁶⁰⁰, an exact factor: the least double, 2⁻¹⁰⁷⁴, times this is 2⁻⁴⁷⁴, whose square has all digits, and the largest
/// one divided by it is below 2⁴²⁴.
const SCALE: f64 = f64::from_bits((1023 + 600) << 52);

/// The part of the gap by which a contact may close in the rest of the step before its body is solved with the
/// others.
pub(crate) const LEEWAY: f64 = 1.0 / 16.0;

/// 2⁻²⁰: in this part of a step what turns by a radian in all of it changes its velocity by a millionth.
const INSTANT: f64 = 1.0 / (1u64 << 20) as f64;

/// Reasons for which numbers are refused.
pub(crate) const UNUSABLE: &str = "cannot be used";
pub(crate) const FINITE: &str = "must be finite";
pub(crate) const NOT_NEGATIVE: &str = "must be finite and not negative";

pub(crate) const UNRESOLVED: &str =
    "is so fast that its rounding closes contacts: take a wider gap, or shorter steps";

/// The error that refuses a number of a body, without a further reason.
pub(crate) fn unusable_of(body: &str, name: &'static str, value: String) -> SimulationError {
    SimulationError::BadBody { body: body.to_owned(), name, value, reason: UNUSABLE }
}

/// Checks the velocity of a running surface. The rate of a contact is a sum of products with it, so it is known to the
/// rounding of it, 2⁻⁵² of its length or less. Where that closes a contact by more than [`LEEWAY`] of the gap in a
/// step, rows of contacts cannot be met: friction vanishes, and bodies sink in the gap and are thrown back.
pub(crate) fn check_surface(
    body: &str,
    velocity: DVec3,
    options: &SimulationOptions,
) -> Result<(), SimulationError> {
    let value = || shown(velocity.to_array());
    let bad = |reason: &'static str| {
        let (body, name) = (body.to_owned(), "surface velocity");
        Err(SimulationError::BadBody { body, name, value: value(), reason })
    };
    let rounding = velocity.length() * f64::EPSILON;
    if !velocity.is_finite() {
        bad(FINITE)
    } else if rounding > LEEWAY * (options.gap / options.step) || !is_small(velocity) {
        bad(UNRESOLVED)
    } else {
        Ok(())
    }
}

/// Numbers of a body.
pub(crate) struct Numbers<'n> {
    /// The body's name.
    pub(crate) body: &'n str,
    pub(crate) vectors: &'n [(&'static str, DVec3)],
    /// Any norm but zero.
    pub(crate) orientation: DQuat,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) not_negative: &'n [(&'static str, f64)],
}

impl Numbers<'_> {
    pub(crate) fn check(&self) -> Result<(), SimulationError> {
        let bad = |name: &'static str, value: String, reason: &'static str| {
            Err(SimulationError::BadBody { body: self.body.to_owned(), name, value, reason })
        };
        if let Some((name, value)) = self.vectors.iter().find(|(_, v)| !v.is_finite()) {
            return bad(name, shown(value.to_array()), FINITE);
        }
        if turn(self.orientation).is_none() {
            return bad("orientation", shown_turn(self.orientation), "has no direction");
        }
        if let Some(Fault { name, value, reason, .. }) = material_fault(self.restitution, self.friction) {
            return bad(name, shown([value]), reason);
        }
        for (name, value) in self.not_negative {
            if !(value.is_finite() && *value >= 0.0) {
                return bad(name, shown([*value]), NOT_NEGATIVE);
            }
        }
        Ok(())
    }
}

/// A number that cannot be used.
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    pub(crate) value: f64,
    /// Behind "must be finite and".
    pub(crate) wanted: &'static str,
    /// The same as a sentence.
    pub(crate) reason: &'static str,
}

/// A restitution outside [0, 1], a friction that is negative or not finite.
pub(crate) fn material_fault(restitution: f64, friction: f64) -> Option<Fault> {
    if !(0.0..=1.0).contains(&restitution) {
        return Some(Fault {
            name: "restitution",
            value: restitution,
            wanted: "in [0, 1]",
            reason: "must be in [0, 1]",
        });
    }
    let is_friction = friction.is_finite() && friction >= 0.0;
    (!is_friction).then_some(Fault {
        name: "friction",
        value: friction,
        wanted: "not negative",
        reason: NOT_NEGATIVE,
    })
}

/// Is it finite, and no component larger than [`LARGEST`]?
pub(crate) fn is_small(v: DVec3) -> bool {
    v.is_finite() && v.abs().max_element() <= LARGEST
}

/// The unit vector along a vector of any length but zero, which may be so short or long that its square is no
/// number. None: it has no direction.
pub(crate) fn direction(v: DVec3) -> Option<DVec3> {
    let scaled = v * squarable(v.abs().max_element());
    Some(scaled.normalize_or_zero()).filter(|way| *way != DVec3::ZERO)
}

/// The turn of a quaternion of any norm but zero, as [`direction`] of a vector. None: it is no turn.
pub(crate) fn turn(q: DQuat) -> Option<DQuat> {
    let scaled = q * squarable(DVec4::from(q).abs().max_element());
    let norm = scaled.length();
    (norm.is_finite() && norm > 0.0).then(|| scaled.normalize())
}

/// A power of two that brings numbers, of which this is the largest, to where their squares have all digits: one if
/// they are there.
fn squarable(largest: f64) -> f64 {
    if largest < SHORT {
        SCALE
    } else if largest > SHORT.recip() {
        SCALE.recip()
    } else {
        1.0
    }
}

/// Do the ends of a flight of this length, this far from the origin, say how fast it is, to a part of a gap a step?
/// Else what they differ by may be their rounding, in flights so short that the velocity at the start says it better.
pub(crate) fn is_resolved(extent: f64, length: f64, off: f64, options: &SimulationOptions) -> bool {
    let rounding = f64::EPSILON * extent;
    length > INSTANT * options.step || rounding <= off * options.gap * (length / options.step)
}

/// Has it the length one, to rounding?
pub(crate) fn is_unit(v: DVec3) -> bool {
    (v.length_squared() - 1.0).abs() <= UNIT
}

/// Is it a quaternion of norm one, to rounding?
pub(crate) fn is_turn(q: DQuat) -> bool {
    (q.length_squared() - 1.0).abs() <= UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of all lengths have their direction, and those whose squares are numbers have it as ever.
    #[test]
    fn all_lengths_but_zero_have_a_direction() {
        let way = DVec3::new(2.0, -3.0, 6.0);
        for k in -1070..1020 {
            // Powers of two in two factors, since the least ones have no inverse.
            let length = 2.0_f64.powi(k / 2) * 2.0_f64.powi(k - k / 2);
            let found = direction(way * length).unwrap();
            assert!((found - way / 7.0).length() < 1e-15, "2^{k}");
            if k.abs() < 500 {
                assert_eq!(Some(found), (way * length).try_normalize(), "2^{k}");
            }
        }
        assert!(
            (direction(DVec3::Y * 5e-324), direction(DVec3::Z * f64::MAX))
                == (Some(DVec3::Y), Some(DVec3::Z))
        );
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::X * f64::INFINITY, DVec3::new(f64::NAN, 1.0, 1.0)] {
            assert_eq!(direction(none), None);
        }
    }
}
