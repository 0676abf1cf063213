//! Motions as the command line takes them.

use crate::failure::{Failure, parse_json};
use crate::load::read;
use d2m::bvh::Window;
use d2m::motion::{AnyMotion, ConstantTwist, CoveredMotion};
use std::path::Path;

/// Reads `x=…;q=…;v=…;w=…` or `@file.json`; `option` names the place in messages.
pub(crate) fn parse_motion(option: &str, text: &str) -> Result<AnyMotion, Failure> {
    let Some(file) = text.strip_prefix('@') else {
        let motion: ConstantTwist = text.parse().map_err(|error| Failure::at(option, error))?;
        return Ok(motion.into());
    };
    if file.is_empty() {
        return Err(Failure::at(option, "@ needs the name of a file"));
    }
    parse_json(file, &read(Path::new(file))?)
}

/// The window must lie within the times that the motion covers.
pub(crate) fn require_window(place: &str, motion: &AnyMotion, window: Window) -> Result<(), Failure> {
    let covered = CoveredMotion::try_new(motion, window.start(), window.end());
    covered.map(|_| ()).map_err(|outside| Failure::at(place, outside))
}

/// Reads `t0,t1`; an empty or reversed window is refused.
pub(crate) fn parse_window(text: &str) -> Result<Window, Failure> {
    let fault = |reason: String| Failure::at("--window", reason);
    let Some((start, end)) = text.split_once(',') else {
        return Err(fault(format!(
            "{text:?} should be T0,T1: two times with a comma between them, such as 0,1"
        )));
    };
    let number = |word: &str| word.trim().parse().map_err(|_| fault(format!("{word:?} is not a number")));
    let (start, end) = (number(start)?, number(end)?);
    let window = Window::try_new(start, end).map_err(|error| fault(error.to_string()))?;
    if window.length() <= 0.0 {
        return Err(fault(format!("the window from {start:?} to {end:?} is empty")));
    }
    Ok(window)
}
