//! Errors of queries, with the numbers that they come from.

use super::words::short_number;
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
/// let spinning: ConstantTwist = "w=0,0,2e12".parse()?;
/// let fault = d2m_io::query_fault(&QueryError::BadMotion { body: 0 }, [&spinning, &rest], Window::UNIT);
/// assert!(fault.ends_with("over the window it turns by 2000000000000 radians: 2^40 and more are refused"), "{fault}");
/// let fast: ConstantTwist = "v=1e300,0,0".parse()?;
/// let fault = d2m_io::query_fault(&QueryError::BadMotion { body: 0 }, [&fast, &rest], Window::UNIT);
/// assert!(fault.contains("over the window it goes 1e300: doubles cannot place it so far away"), "{fault}");
/// # Ok::<(), d2m_motion::MotionError>(())
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
            format!("{place}: x = {x}, v = {v}, w = {w} at the time {time:?}: {}", reason(motion, window))
        }
        other => other.to_string(),
    }
}

/// Why a query cannot bound the rounding of a motion: of a constant twist as far as its numbers say it.
fn reason(motion: &dyn RigidMotion, window: Window) -> String {
    let Some(twist) = motion.constant_twist() else {
        return "over the window it is not finite, turns by 2^40 radians, goes too far, or spins so slowly that the speed is lost to underflow; or its rounding exceeds the bodies".to_owned();
    };
    let over_window = |rate: DVec3| {
        let most = rate.abs().max_element();
        // Divided first, so that no square exceeds all numbers.
        if most > 0.0 { (rate / most).length() * most * window.length() } else { 0.0 }
    };
    let [way, turn] = [twist.linear_velocity(), twist.angular_velocity()].map(over_window);
    let (way, turn_text) = (short_number(way), short_number(turn));
    let far = "doubles cannot place it so far away, beside bodies of these sizes";
    if turn >= QueryError::MOST_ANGLE {
        format!("over the window it turns by {turn_text} radians: 2^40 and more are refused")
    } else if turn == 0.0 {
        format!("over the window it goes {way}: {far}")
    } else {
        format!(
            "over the window it goes {way} and turns by {turn_text} radians: {far}, or its spin is so slow that it is lost to underflow"
        )
    }
}
