//! Where a body is: a rotation and a translation, as numbers and as enclosures.
use crate::rotation::quat_of;
use d2m_interval::{IntervalMat3, IntervalVec3};
use glam::{DAffine3, DMat4, DQuat, DVec3};

/// A pose: body point `p` is at `rotation·(p − at) + translation` in the world.
///
/// Plain floating point: it promises nothing about rounding ([`IntervalPose`] does).
///
/// ```
/// use d2m_motion::Pose;
/// use glam::{DQuat, DVec3};
/// let pose = Pose { rotation: DQuat::IDENTITY, translation: DVec3::X, at: DVec3::Y };
/// assert_eq!(pose.transform_point(DVec3::new(1.0, 1.0, 0.0)), DVec3::new(2.0, 0.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Unit quaternion, body frame to world frame.
    pub rotation: DQuat,
    /// World position of the body point [`Pose::at`].
    pub translation: DVec3,
    /// The body point (body frame) that the translation follows.
    pub at: DVec3,
}

impl Pose {
    /// The body frame is the world frame.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO, at: DVec3::ZERO };

    /// The body origin at `position`, the body turned by a unit quaternion.
    ///
    /// ```
    /// use d2m_motion::Pose;
    /// use glam::{DQuat, DVec3};
    /// assert_eq!(Pose::new(DVec3::X, DQuat::IDENTITY).transform_point(DVec3::Y), DVec3::new(1.0, 1.0, 0.0));
    /// ```
    pub const fn new(position: DVec3, rotation: DQuat) -> Self {
        Self { rotation, translation: position, at: DVec3::ZERO }
    }

    /// The body origin at `position`, the body turned by the rotation vector: about its direction, by its length in radians.
    ///
    /// ```
    /// use d2m_motion::Pose;
    /// use glam::DVec3;
    /// let pose = Pose::from_rotation_vector(DVec3::X, DVec3::Z * std::f64::consts::FRAC_PI_2);
    /// assert!((pose.transform_point(DVec3::X) - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
    /// ```
    pub fn from_rotation_vector(position: DVec3, rotation_vector: DVec3) -> Self {
        Self { rotation: quat_of(rotation_vector, 1.0), translation: position, at: DVec3::ZERO }
    }

    /// The body origin at `position`, the body turned about an axis (of any length but zero) by an angle in radians.
    ///
    /// ```
    /// use d2m_motion::Pose;
    /// use glam::DVec3;
    /// let pose = Pose::from_axis_angle(DVec3::ZERO, DVec3::Z * 5.0, std::f64::consts::FRAC_PI_2);
    /// assert!((pose.transform_point(DVec3::X) - DVec3::Y).length() < 1e-15);
    /// ```
    pub fn from_axis_angle(position: DVec3, axis: DVec3, angle: f64) -> Self {
        Self::from_rotation_vector(position, axis.normalize_or_zero() * angle)
    }

    /// The body origin at `position`, the body turned by roll about x, then pitch about y, then yaw about z, all fixed axes
    /// (the convention of URDF): R = R_z(yaw)·R_y(pitch)·R_x(roll), radians.
    ///
    /// ```
    /// use d2m_motion::Pose;
    /// use glam::DVec3;
    /// let quarter = std::f64::consts::FRAC_PI_2;
    /// let pose = Pose::from_rpy(DVec3::ZERO, [quarter, 0.0, quarter]);
    /// assert!((pose.transform_vector(DVec3::Y) - DVec3::Z).length() < 1e-15);
    /// assert!((pose.transform_vector(DVec3::X) - DVec3::Y).length() < 1e-15);
    /// ```
    pub fn from_rpy(position: DVec3, [roll, pitch, yaw]: [f64; 3]) -> Self {
        let about = |axis: DVec3, angle: f64| quat_of(axis, angle);
        let rotation = about(DVec3::Z, yaw) * about(DVec3::Y, pitch) * about(DVec3::X, roll);
        Self { rotation, translation: position, at: DVec3::ZERO }
    }

    /// The pose as an affine map from body to world coordinates.
    ///
    /// ```
    /// use d2m_motion::Pose;
    /// use glam::DVec3;
    /// let pose = Pose::from_rpy(DVec3::X, [0.1, 0.2, 0.3]);
    /// let affine = pose.to_affine();
    /// assert!((affine.transform_point3(DVec3::Y) - pose.transform_point(DVec3::Y)).length() < 1e-15);
    /// assert!((Pose::from(affine).transform_point(DVec3::Y) - pose.transform_point(DVec3::Y)).length() < 1e-15);
    /// ```
    pub fn to_affine(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.rotation, self.transform_point(DVec3::ZERO))
    }

    /// World position of a body point.
    pub fn transform_point(&self, point: DVec3) -> DVec3 {
        self.rotation * (point - self.at) + self.translation
    }

    /// World direction of a body direction.
    pub fn transform_vector(&self, vector: DVec3) -> DVec3 {
        self.rotation * vector
    }

    /// Body coordinates of a world point.
    pub fn inverse_transform_point(&self, point: DVec3) -> DVec3 {
        self.rotation.conjugate() * (point - self.translation) + self.at
    }
}

/// The rotation and translation of an isometry; a scale or shear is lost.
impl From<DAffine3> for Pose {
    fn from(map: DAffine3) -> Self {
        let (_, rotation, translation) = map.to_scale_rotation_translation();
        Self { rotation, translation, at: DVec3::ZERO }
    }
}

/// The rotation and translation of an isometry; a scale or shear is lost.
impl From<DMat4> for Pose {
    fn from(map: DMat4) -> Self {
        DAffine3::from_mat4(map).into()
    }
}

/// A set of poses that contains the true pose at every time of some interval.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let spin = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// // Where the body point (1, 0, 0) is between the times 0 and 1.
/// let way = spin.enclose_pose(Interval::UNIT).enclose_point(DVec3::X);
/// assert!(way.x.contains(0.5f64.cos()) && way.y.contains(0.5f64.sin()));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalPose {
    /// Encloses the rotation matrix, body frame to world frame.
    pub rotation: IntervalMat3,
    /// Encloses the world position of the body point [`IntervalPose::at`].
    pub translation: IntervalVec3,
    /// The body point (body frame, exact) that the translation follows.
    pub at: DVec3,
}

impl IntervalPose {
    /// The body frame is the world frame, exactly.
    pub const IDENTITY: Self =
        Self { rotation: IntervalMat3::IDENTITY, translation: IntervalVec3::ZERO, at: DVec3::ZERO };

    /// Encloses the world position of a body point (body frame, exact).
    pub fn enclose_point(&self, point: DVec3) -> IntervalVec3 {
        self.rotation.mul_vec(IntervalVec3::point(point) - self.at) + self.translation
    }

    /// Encloses the world direction of a body direction (body frame, exact).
    pub fn enclose_vector(&self, vector: DVec3) -> IntervalVec3 {
        self.rotation.mul_vec(IntervalVec3::point(vector))
    }

    /// A set that contains this one and another (of the same reference point).
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self {
            rotation: self.rotation.hull(other.rotation),
            translation: self.translation.hull(other.translation),
            at: self.at,
        }
    }
}
