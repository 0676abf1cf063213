//! Files of motions.

use crate::{IoError, Place, parse_json, read_bytes};
use d2m_bvh::TriMesh;
use d2m_motion::{AnyMotion, MotionError, Pose};
use glam::DVec3;
use std::path::Path;

/// The motion of a JSON file: a constant twist, keyframes or a chain of joints, in the forms of [`AnyMotion`].
///
/// ```
/// use d2m_motion::RigidMotion;
/// let path = std::env::temp_dir().join(format!("d2m-io-motion-{}.json", std::process::id()));
/// std::fs::write(&path, r#"{"times": [0, 2], "poses": [{}, {"x": [1, 0, 0]}]}"#)?;
/// let motion = d2m_io::read_motion(&path)?;
/// assert_eq!(motion.domain().hi(), 2.0);
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError`] with the name of the file, line and column or index, and the value found.
pub fn read_motion(path: impl AsRef<Path>) -> Result<AnyMotion, IoError> {
    let path = path.as_ref();
    parse_json(&read_bytes(path)?).map_err(|error| error.in_file(path.display().to_string()))
}

/// Do the spans of a motion's keyframes meet, for a body of the size of this mesh? Other motions have no gaps.
///
/// ```
/// use d2m_bvh::TriMesh;
/// use d2m_motion::{AnyMotion, ConstantTwist, Keyframes};
/// use glam::DVec3;
/// let mesh = TriMesh::from_arrays(&[[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]], &[[0, 1, 2]])?;
/// let at = |x: f64| ConstantTwist::REST.with_position(DVec3::X * x);
/// let path = |gap: f64| Keyframes::try_from_spans(vec![0.0, 1.0, 2.0], vec![at(100.0), at(100.0 + gap)]).map(AnyMotion::from);
/// assert!(d2m_io::check_keyframes(&path(4e-9)?, &mesh).is_ok());
/// let error = d2m_io::check_keyframes(&path(6e-9)?, &mesh).unwrap_err();
/// assert!(error.to_string().contains("keyframe 1"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`MotionError`] of [`AnyMotion::check_size`]: the joint with the widest gap.
pub fn check_keyframes(motion: &AnyMotion, mesh: &TriMesh) -> Result<(), MotionError> {
    match motion {
        AnyMotion::Keyframes(keyframes) => keyframes.check_size(mesh.size()),
        _ => Ok(()),
    }
}

/// The pose of a body at rest, which texts state as a motion without velocities.
///
/// ```
/// use d2m_motion::{AnyMotion, ConstantTwist};
/// let stated = |text: &str| text.parse::<ConstantTwist>().map(AnyMotion::from);
/// assert_eq!(d2m_io::pose_at_rest(&stated("x=1,2,3")?)?.translation.z, 3.0);
/// let fault = d2m_io::pose_at_rest(&stated("v=1,0,0")?).unwrap_err().to_string();
/// assert_eq!(fault, "v is [1.0, 0.0, 0.0]: a pose has x, q and at, but no velocity");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError::Content`] for a motion with velocities, or of another kind than a constant twist.
pub fn pose_at_rest(motion: &AnyMotion) -> Result<Pose, IoError> {
    let fault = |reason| Err(IoError::Content { place: Place::default(), reason });
    let AnyMotion::ConstantTwist(motion) = motion else {
        return fault("a pose has x, q and at, and no course over time".to_owned());
    };
    for (key, velocity) in [("v", motion.linear_velocity()), ("w", motion.angular_velocity())] {
        if velocity != DVec3::ZERO {
            let value = velocity.to_array();
            return fault(format!("{key} is {value:?}: a pose has x, q and at, but no velocity"));
        }
    }
    Ok(Pose { rotation: motion.orientation(), translation: motion.position(), at: motion.at() })
}
