//! Motions as the command line takes them.

use crate::failure::{Failure, parse_json};
use crate::load::read;
use crate::orientation::{warn_of_json, warn_of_text};
use d2m::bvh::Window;
use d2m::motion::{AnyMotion, ConstantTwist, CoveredMotion};
use std::path::Path;

/// Reads `x=…;q=…;v=…;w=…` or `@file.json`; `option` names the place in messages.
pub(crate) fn parse_motion(option: &str, text: &str) -> Result<AnyMotion, Failure> {
    let Some(file) = text.strip_prefix('@') else {
        if let Some(hint) = file_hint(text) {
            return Err(Failure::at(option, hint));
        }
        let motion: ConstantTwist = text.parse().map_err(|error| Failure::at(option, error))?;
        warn_of_text(option, text);
        return Ok(motion.into());
    };
    if file.is_empty() {
        return Err(Failure::at(option, "@ needs the name of a file"));
    }
    let bytes = read(Path::new(file))?;
    let motion = parse_json(file, &bytes)?;
    if let Ok(value) = serde_json::from_slice(&bytes) {
        warn_of_json(file, &value);
    }
    Ok(motion)
}

/// The window and the motions of two bodies, A and B, each of which covers it.
pub(crate) fn parse_motions(window: &str, motions: [&str; 2]) -> Result<(Window, [AnyMotion; 2]), Failure> {
    let window = parse_window(window)?;
    let options = ["--motion-a", "--motion-b"];
    let motions = [parse_motion(options[0], motions[0])?, parse_motion(options[1], motions[1])?];
    for (option, motion) in options.into_iter().zip(&motions) {
        require_window(option, motion, window)?;
    }
    Ok((window, motions))
}

/// What someone means who gives the name of a file without an @.
fn file_hint(text: &str) -> Option<String> {
    let path = Path::new(text);
    let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let is_file = !text.contains('=') && (is_json || path.is_file());
    is_file.then(|| format!("{text:?} is no motion; a file is given with an @ in front: @{text}"))
}

/// The window must lie within the times that the motion covers.
pub(crate) fn require_window(place: &str, motion: &AnyMotion, window: Window) -> Result<(), Failure> {
    let covered = CoveredMotion::try_new(motion, window.start(), window.end());
    covered.map(|_| ()).map_err(|outside| Failure::at(place, outside))
}

/// Reads `t0,t1`; a reversed window is refused, one of no length is a single time.
fn parse_window(text: &str) -> Result<Window, Failure> {
    let fault = |reason: String| Failure::at("--window", reason);
    let Some((start, end)) = text.split_once(',') else {
        return Err(fault(format!(
            "{text:?} should be T0,T1: two times with a comma between them, such as 0,1"
        )));
    };
    let number = |word: &str| word.trim().parse().map_err(|_| fault(format!("{word:?} is not a number")));
    let (start, end) = (number(start)?, number(end)?);
    Window::try_new(start, end).map_err(|error| fault(error.to_string()))
}
