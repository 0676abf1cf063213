//! Motions and poses, as texts.

use d2m::bvh::{MeshTree, Window};
use d2m::motion::{AnyMotion, ConstantTwist, CoveredMotion, Pose};
use d2m_io::{check_keyframes, parse_json, pose_at_rest};

/// Reads JSON in the forms of the formats, or `x=…;q=…;v=…;w=…` as the command takes it. `place` stands in messages.
fn read(place: &str, text: &str) -> Result<AnyMotion, String> {
    if text.trim_start().starts_with(['{', '[']) || text.contains('"') {
        return parse_json(text.as_bytes()).map_err(|error| format!("{place}: {error}"));
    }
    let motion: ConstantTwist = text.parse().map_err(|error| format!("{place}: {error}"))?;
    Ok(motion.into())
}

/// A motion that covers the window and, where it has keyframes, fits the size of its body.
pub(crate) fn read_motion(
    place: &str,
    text: &str,
    window: Window,
    tree: &MeshTree,
) -> Result<AnyMotion, String> {
    let motion = read(place, text)?;
    if let Err(outside) = CoveredMotion::try_new(&motion, window.start(), window.end()) {
        return Err(format!("{place}: {outside}"));
    }
    check_keyframes(&motion, tree.mesh()).map_err(|error| format!("{place}: {error}"))?;
    Ok(motion)
}

/// The pose of a body at rest: x, q and at.
pub(crate) fn read_pose(place: &str, text: &str) -> Result<Pose, String> {
    pose_at_rest(&read(place, text)?).map_err(|error| format!("{place}: {error}"))
}
