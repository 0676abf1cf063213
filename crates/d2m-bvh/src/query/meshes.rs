//! The query of two meshes, without radii.

use super::constant_twist::{ask, scene_of};
use super::general_motion::general_motion;
use crate::covered_pair::CoveredPair;
use crate::{Answered, Moving, QueryError, QueryOptions, TimeOfContact, Window};

/// The first contact, whatever the motions.
pub(super) fn of_meshes(
    bodies: [Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
) -> Result<Answered<TimeOfContact>, QueryError> {
    let pair = CoveredPair::try_new(bodies, window)?;
    let answered = match scene_of(&pair, options)? {
        Some(scene) => ask(&scene, options),
        None => general_motion(pair, options)?,
    };
    #[cfg(feature = "audit")]
    super::concluded::conclude_answer(&bodies, window, options, &answered.answer);
    Ok(answered)
}
