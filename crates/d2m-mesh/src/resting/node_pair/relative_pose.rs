//! One body in the frame of the other, with a proven bound on its error.

use crate::margin::UNIT_F64;
use crate::{Posed, QueryError};
use d2m_interval::{IntervalMat3, IntervalVec3};
use glam::{DQuat, DVec3};

/// See there.
const LONGEST: f64 = QueryError::LONGEST_AT_REST;

/// Body A in the frame of B's tree: a point p of A (from the center of A's tree, body axes) is at R·p + T from the
/// center of B's tree, in B's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativePose {
    /// Columns of R as computed.
    pub(crate) rotation: [DVec3; 3],
    /// T as computed, body units.
    pub(crate) offset: DVec3,
    /// ‖R as computed − R‖·(ρA + ρB + |T|) + |T as computed − T|: no point of A in B's frame, and none of B in A's
    /// frame, is further than this from its true place (before the roundings of placing it).
    pub(crate) error: f64,
    /// Bound on every length that enters a position: ρA + ρB + |T|.
    pub(crate) size: f64,
}

/// The rotation of q/|q|; exactly the identity when the vector part is zero.
fn enclose_rotation(q: DQuat) -> IntervalMat3 {
    if q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w != 0.0 {
        IntervalMat3::IDENTITY
    } else {
        IntervalMat3::from_quat_normalized(q)
    }
}

/// How B stands in A's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InversePose {
    /// Columns of Rᵀ.
    pub(crate) rotation: [DVec3; 3],
    /// The center of B's tree from A's.
    pub(crate) offset: DVec3,
}

impl RelativePose {
    /// From the poses in the world.
    ///
    /// # Errors
    /// [`QueryError::BadPose`] for a pose that is not finite, a zero quaternion, or lengths beyond [`QueryError::LONGEST_AT_REST`].
    pub(crate) fn try_new(a: Posed<'_>, b: Posed<'_>) -> Result<Self, QueryError> {
        for (body, posed) in [a, b].into_iter().enumerate() {
            let pose = posed.pose;
            let quaternion = pose.rotation.to_array();
            let lengths = pose.translation.abs().max_element().max(pose.at.abs().max_element());
            let good = pose.translation.is_finite()
                && pose.at.is_finite()
                && lengths <= LONGEST
                && posed.body.radius() <= LONGEST
                && quaternion.iter().all(|c| c.is_finite())
                && quaternion.iter().any(|&c| c != 0.0);
            if !good {
                return Err(QueryError::BadPose { body });
            }
        }
        let same_rotation = a.pose.rotation == b.pose.rotation;
        let to_b = enclose_rotation(b.pose.rotation).transpose();
        let rotation = if same_rotation {
            IntervalMat3::IDENTITY
        } else {
            to_b.mul_mat(enclose_rotation(a.pose.rotation))
        };
        let arm = |posed: Posed<'_>| IntervalVec3::point(posed.body.center()) - posed.pose.at;
        let between = IntervalVec3::point(a.pose.translation) - b.pose.translation;
        let offset = rotation.mul_vec(arm(a)) - arm(b) + to_b.mul_vec(between);
        let columns = rotation.cols();
        // The middle is within the width of every member, and the width is rounded once.
        let spread = |v: IntervalVec3| DVec3::new(v.x.width(), v.y.width(), v.z.width()).length();
        let turn = DVec3::from_array(columns.map(spread)).length();
        let middle = offset.mid();
        let size = (a.body.radius() + b.body.radius() + middle.length()) * (1.0 + 16.0 * UNIT_F64);
        let error = (turn * size + spread(offset)) * (1.0 + 32.0 * UNIT_F64);
        if !(size <= 10.0 * LONGEST && error.is_finite()) {
            return Err(QueryError::BadPose { body: 0 });
        }
        Ok(Self { rotation: columns.map(IntervalVec3::mid), offset: middle, error, size })
    }

    /// How B stands as A sees it.
    pub(crate) fn inverse(&self) -> InversePose {
        let [x, y, z] = self.rotation;
        let offset = DVec3::new(x.dot(self.offset), y.dot(self.offset), z.dot(self.offset));
        let rotation = [DVec3::new(x.x, y.x, z.x), DVec3::new(x.y, y.y, z.y), DVec3::new(x.z, y.z, z.z)];
        InversePose { rotation, offset: -offset }
    }
}
