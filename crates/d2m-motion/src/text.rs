//! The text form of a motion, as the command line takes it: `x=1,2,3;q=w,x,y,z;v=…;w=…[;at=…][;t=…]`, or `rpy=…`
//! in the place of `q`.
use crate::sin_cos::LARGEST_ANGLE;
use crate::{ConstantTwist, MotionError, Pose};
use core::fmt;
use core::str::FromStr;
use glam::{DQuat, DVec3};

fn text_error(key: &str, reason: impl Into<String>) -> MotionError {
    MotionError::Text { key: key.to_string(), reason: reason.into() }
}

fn numbers<const N: usize>(key: &str, value: &str) -> Result<[f64; N], MotionError> {
    let mut out = [0.0_f64; N];
    let parts: Vec<&str> = value.split(',').collect();
    if parts.len() != N {
        return Err(text_error(
            key,
            format!("expected {N} numbers separated by commas, found {}", parts.len()),
        ));
    }
    for (slot, part) in out.iter_mut().zip(parts) {
        let part = part.trim();
        *slot = part.parse().map_err(|_| text_error(key, format!("{part:?} is not a number")))?;
        if !slot.is_finite() {
            return Err(text_error(key, format!("{part} is not finite")));
        }
    }
    Ok(out)
}

/// As [`numbers`]; one that ends in `deg` is in degrees and becomes radians, rounded.
fn angles(key: &str, value: &str) -> Result<[f64; 3], MotionError> {
    let in_degrees = value.split(',').map(|part| part.trim().ends_with("deg"));
    let mut angles: [f64; 3] = if value.contains("deg") {
        let plain: Vec<&str> =
            value.split(',').map(str::trim).map(|part| part.strip_suffix("deg").unwrap_or(part)).collect();
        numbers(key, &plain.join(","))?
    } else {
        numbers(key, value)?
    };
    for (angle, _) in angles.iter_mut().zip(in_degrees).filter(|(_, in_degrees)| *in_degrees) {
        *angle = angle.to_radians();
    }
    Ok(angles)
}

/// Reads `x=1,2,3;q=w,x,y,z;v=1,2,3;w=1,2,3;at=1,2,3;t=0`: position, orientation, linear velocity, angular velocity,
/// reference point, reference time. Every part may be left out (at rest, at the origin); none may come twice. `rpy=roll,pitch,yaw` may stand
/// in the place of `q`: turns about the fixed axes x, y and z, one after the other, R = R_z(yaw)·R_y(pitch)·R_x(roll) as in URDF. Angles in
/// `w` and `rpy` are radians, or degrees with `deg` behind the number.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// let turned: ConstantTwist = "rpy=0,0,90deg;w=0,0,-360deg".parse()?;
/// assert!((turned.orientation() * glam::DVec3::X - glam::DVec3::Y).length() < 1e-15);
/// assert_eq!(turned.angular_velocity().z, -std::f64::consts::TAU);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
///
/// # Errors
/// [`MotionError::Text`] naming the key.
impl FromStr for ConstantTwist {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let [mut x, mut v, mut w, mut at] = [DVec3::ZERO; 4];
        let (mut q, mut t) = (DQuat::IDENTITY, 0.0);
        let mut seen: Vec<&str> = Vec::new();
        for part in text.split(';').map(str::trim).filter(|part| !part.is_empty()) {
            let Some((key, value)) = part.split_once('=') else {
                return Err(text_error(part, "expected key=value with key one of x, q, rpy, v, w, at, t"));
            };
            let key = key.trim();
            if seen.contains(&key) {
                return Err(text_error(key, "given twice"));
            }
            seen.push(key);
            match key {
                "x" => x = DVec3::from_array(numbers(key, value)?),
                "q" => {
                    let [scalar, i, j, k] = numbers(key, value)?;
                    q = DQuat::from_xyzw(i, j, k, scalar);
                }
                "rpy" => {
                    let angles = angles(key, value)?;
                    if let Some(angle) = angles.iter().find(|angle| angle.abs() > LARGEST_ANGLE) {
                        return Err(text_error(
                            key,
                            format!("{angle:?} is too large for an angle: the limit is {LARGEST_ANGLE:e}"),
                        ));
                    }
                    q = Pose::from_rpy(DVec3::ZERO, angles).rotation;
                }
                "v" => v = DVec3::from_array(numbers(key, value)?),
                "w" => w = DVec3::from_array(angles(key, value)?),
                "at" => at = DVec3::from_array(numbers(key, value)?),
                "t" => [t] = numbers(key, value)?,
                _ => return Err(text_error(key, "unknown key: expected x, q, rpy, v, w, at or t")),
            }
        }
        if seen.contains(&"q") && seen.contains(&"rpy") {
            return Err(text_error("rpy", "the body is turned by q or by rpy, not by both"));
        }
        ConstantTwist::try_new(x, q, v, w)?.try_with_at(at)?.try_with_reference_time(t)
    }
}

/// The text form that [`FromStr`] reads, with all digits.
impl fmt::Display for ConstantTwist {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, key: &str, values: &[f64]| {
            write!(f, "{key}=")?;
            values.iter().enumerate().try_for_each(|(i, x)| {
                if i > 0 {
                    write!(f, ",")?;
                }
                write!(f, "{x:?}")
            })
        };
        let q = self.orientation();
        list(f, "x", &self.position().to_array())?;
        list(f, ";q", &[q.w, q.x, q.y, q.z])?;
        list(f, ";v", &self.linear_velocity().to_array())?;
        list(f, ";w", &self.angular_velocity().to_array())?;
        if self.at() != DVec3::ZERO {
            list(f, ";at", &self.at().to_array())?;
        }
        if self.reference_time() != 0.0 {
            list(f, ";t", &[self.reference_time()])?;
        }
        Ok(())
    }
}
