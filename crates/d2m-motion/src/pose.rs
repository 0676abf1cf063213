//! Where a body is: a rotation and a translation, as numbers and as enclosures.
use d2m_interval::{IntervalMat3, IntervalVec3};
use glam::{DQuat, DVec3};

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

/// A set of poses that contains the true pose at every time of some interval.
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
    /// Encloses the world position of a body point (body frame, exact).
    pub fn enclose_point(&self, point: DVec3) -> IntervalVec3 {
        self.rotation.mul_vec(IntervalVec3::point(point) - self.at) + self.translation
    }

    /// Encloses the world direction of a body direction (body frame, exact).
    pub fn enclose_vector(&self, vector: DVec3) -> IntervalVec3 {
        self.rotation.mul_vec(IntervalVec3::point(vector))
    }
}
