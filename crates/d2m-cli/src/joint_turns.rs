//! How far the joints of a robot turn on a path.

use crate::output::digits;
use crate::travel::Travel;
use d2m::motion::JointValue;
use d2m_robot::{JointType, Robot, RobotError, Trajectory};
use std::f64::consts::TAU;

/// Joints that turn more than once on the path: those that it names, and those that follow them.
pub(crate) fn far_turns(path: &Trajectory, robot: &Robot) -> Result<Vec<String>, RobotError> {
    let values = robot.joint_values(path)?;
    let turning = values
        .iter()
        .enumerate()
        .filter(|&(joint, _)| matches!(robot.joint_type(joint), JointType::Revolute | JointType::Continuous));
    let texts = turning.filter_map(|(joint, value)| {
        let turn = way(value);
        let (name, turns) = (robot.joint_name(joint), digits(turn / TAU));
        let is_far = Travel { way: 0.0, turn }.turns_more_than_once();
        is_far.then(|| format!("joint {name:?} turns {turns} times on the path; angles are radians"))
    });
    Ok(texts.collect())
}

/// The way of a value to and fro, from sums over parts of its pieces. It is an estimate: nothing else depends on it.
fn way(value: &JointValue) -> f64 {
    const PARTS: u32 = 64;
    let pieces = value.times().windows(2).zip(value.pieces());
    let ways = pieces.map(|(ends, coefficients)| {
        // Straight pieces go one way only.
        let parts = if coefficients.len() > 2 { PARTS } else { 1 };
        let at = |part: u32| {
            let share = f64::from(part) / f64::from(parts);
            value.value(ends[0] * (1.0 - share) + ends[1] * share)
        };
        let mut before = at(0);
        let steps = (1..=parts).map(|part| {
            let after = at(part);
            (after - core::mem::replace(&mut before, after)).abs()
        });
        steps.sum::<f64>()
    });
    ways.sum()
}
