//! Numbers as messages show them.

use glam::DQuat;

/// Shows numbers, several in brackets: in powers of ten where zeros would fill the line.
pub(crate) fn shown<const N: usize>(numbers: [f64; N]) -> String {
    match &numbers[..] {
        [number] => format!("{number:?}"),
        _ => format!("{numbers:?}"),
    }
}

/// Shows a quaternion in the order of files: w, x, y, z.
pub(crate) fn shown_turn(q: DQuat) -> String {
    shown([q.w, q.x, q.y, q.z])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_are_short() {
        assert_eq!(shown([1e300]), "1e300");
        assert_eq!(shown([0.25, -1e-300, f64::NAN]), "[0.25, -1e-300, NaN]");
        assert_eq!(shown_turn(DQuat::from_xyzw(1.0, 2.0, 3.0, 1e200)), "[1e200, 1.0, 2.0, 3.0]");
    }
}
