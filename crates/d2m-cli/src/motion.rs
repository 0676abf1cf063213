//! Motions as the command line takes them.

use crate::failure::Failure;
use crate::load::read;
use d2m::bvh::Window;
use d2m::motion::{ConstantTwist, Keyframes};
use std::path::Path;

/// A motion that the command line can name.
#[derive(Debug)]
pub(crate) enum Motion {
    Linear(ConstantTwist),
    Keyframes(Keyframes),
}

impl Motion {
    /// Reads `x=…;q=…;v=…;w=…` or `@file.json`; `option` names the place in messages.
    pub(crate) fn parse(option: &str, text: &str) -> Result<Self, Failure> {
        let Some(file) = text.strip_prefix('@') else {
            let motion = text.parse().map_err(|error| Failure::at(option, error))?;
            return Ok(Self::Linear(motion));
        };
        if file.is_empty() {
            return Err(Failure::at(option, "@ needs the name of a file"));
        }
        let bytes = read(Path::new(file))?;
        let value: serde_json::Value =
            serde_json::from_slice(&bytes).map_err(|error| Failure::at(file, error))?;
        let motion = if value.get("times").is_some() || value.get("spans").is_some() {
            serde_json::from_value(value).map(Self::Keyframes)
        } else {
            serde_json::from_value(value).map(Self::Linear)
        };
        motion.map_err(|error| Failure::at(file, error))
    }

    /// The linear motion from `time` on, and when it ends.
    pub(crate) fn piece_at(&self, time: f64) -> Option<(&ConstantTwist, f64)> {
        match self {
            Self::Linear(motion) => Some((motion, f64::INFINITY)),
            Self::Keyframes(keyframes) => {
                let (_, end, motion) =
                    keyframes.spans().find(|&(start, end, _)| start <= time && time < end)?;
                Some((motion, end))
            }
        }
    }

    /// The linear motion in force at the last instant before or at `time`.
    pub(crate) fn piece_until(&self, time: f64) -> Option<&ConstantTwist> {
        match self {
            Self::Linear(motion) => Some(motion),
            Self::Keyframes(keyframes) => keyframes.span_at(time).map(|(_, _, motion)| motion),
        }
    }

    /// Keyframes must cover the window.
    pub(crate) fn require_window(&self, option: &str, window: Window) -> Result<(), Failure> {
        let Self::Keyframes(keyframes) = self else { return Ok(()) };
        let (first, last) = (keyframes.times()[0], keyframes.times()[keyframes.times().len() - 1]);
        if window.start() < first || window.end() > last {
            let reason = format!(
                "keyframes from {first} to {last} do not cover the window from {} to {}",
                window.start(),
                window.end()
            );
            return Err(Failure::at(option, reason));
        }
        Ok(())
    }
}

/// Reads `t0,t1`; an empty or reversed window is refused.
pub(crate) fn parse_window(text: &str) -> Result<Window, Failure> {
    let fault = |reason: String| Failure::at("--window", reason);
    let Some((start, end)) = text.split_once(',') else {
        return Err(fault(format!("{text:?} should be T0,T1")));
    };
    let number = |word: &str| word.trim().parse().map_err(|_| fault(format!("{word:?} is not a number")));
    let (start, end) = (number(start)?, number(end)?);
    let window = Window::try_new(start, end).map_err(|error| fault(error.to_string()))?;
    if window.length() <= 0.0 {
        return Err(fault(format!("the window from {start:?} to {end:?} is empty")));
    }
    Ok(window)
}
