//! Errors of queries, with the numbers that they come from.

use d2m_bvh::{QueryError, Window};
use d2m_motion::RigidMotion;
use glam::DVec3;

/// An error of a query of two bodies; that of a motion names the body and the motion's numbers at the start of the window.
///
/// ```
/// use d2m_bvh::{QueryError, Window};
/// use d2m_motion::ConstantTwist;
/// let rest = ConstantTwist::REST;
/// let fault = d2m_io::query_fault(&QueryError::BadMotion { body: 1 }, [&rest, &rest], Window::UNIT);
/// assert!(fault.starts_with("motion of B: x = [0.0, 0.0, 0.0]"), "{fault}");
/// ```
pub fn query_fault(error: &QueryError, motions: [&dyn RigidMotion; 2], window: Window) -> String {
    match error {
        QueryError::BadMotion { body } => {
            let [a, b] = motions;
            let (place, motion) = if *body == 0 { ("motion of A", a) } else { ("motion of B", b) };
            let (pose, twist) = motion.pose_and_twist(window.start());
            let triple = |vector: DVec3| format!("{:?}", vector.to_array());
            let [x, v, w] = [pose.translation, twist.linear, twist.angular].map(triple);
            let time = window.start();
            format!(
                "{place}: x = {x}, v = {v}, w = {w} at the time {time:?}: over the window it is not finite, turns by 2^40 radians, goes too far, or spins so slowly that the speed is lost to underflow; or its rounding exceeds the bodies"
            )
        }
        other => other.to_string(),
    }
}
