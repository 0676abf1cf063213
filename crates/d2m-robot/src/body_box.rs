//! A box about a body, oriented as the body is long and wide.

use d2m_mesh::PrincipalAxes;
use d2m_motion::CertifiedState;
use glam::{DMat3, DVec3};

/// More than the roundings of a point's coordinates along an axis add up to, in parts of what is added: three products, two
/// sums, the rotation and translation of the point before (as many again), each half a unit in the last place.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// Every point of a body is center + Σ xᵢ·axisᵢ with |xᵢ| ≤ halfᵢ, up to `blur`, in the frame of what carries it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyBox {
    pub(crate) center: DVec3,
    /// Of length one and at right angles, up to rounding, which `blur` holds.
    pub(crate) axes: DMat3,
    pub(crate) half: DVec3,
    /// Bound of the distance of the body's points from the center.
    pub(crate) radius: f64,
    pub(crate) blur: f64,
}

impl BodyBox {
    /// About points that are seen from a frame that stands so.
    pub(crate) fn around(points: &[DVec3], place: &CertifiedState) -> Self {
        let seen: Vec<DVec3> =
            points.iter().map(|&p| place.rotation * (p - place.at) + place.position).collect();
        let along = |axes: DMat3| Self::with_axes(&seen, axes);
        let [own, principal] = [along(place.rotation), along(principal_axes(&seen))];
        let size = |of: &Self| of.half.x * of.half.y + of.half.y * of.half.z + of.half.z * of.half.x;
        let found = if size(&principal) < size(&own) { principal } else { own };
        let reach = points.iter().map(|p| (*p - place.at).length()).fold(0.0, f64::max);
        let lengths = reach + place.position.length() + found.center.length() + found.radius;
        let placed = place.position_radius + place.rotation_radius * reach;
        let blur = (placed + ROUNDINGS * lengths) * (1.0 + ROUNDINGS) + f64::MIN_POSITIVE;
        Self { blur, ..found }
    }

    /// The smallest one along these axes.
    fn with_axes(points: &[DVec3], axes: DMat3) -> Self {
        let (x, z) = (axes.x_axis.normalize(), axes.x_axis.cross(axes.y_axis).normalize());
        let axes = DMat3::from_cols(x, z.cross(x), z);
        let turned = axes.transpose();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &point in points {
            let along = turned * point;
            (low, high) = (low.min(along), high.max(along));
        }
        let center = axes * (0.5 * low + 0.5 * high);
        let mut half = DVec3::ZERO;
        let mut radius = 0.0_f64;
        for &point in points {
            let off = point - center;
            half = half.max((turned * off).abs());
            radius = radius.max(off.length());
        }
        Self { center, axes, half, radius, blur: 0.0 }
    }
}

/// The axes along which the points are spread most and least, at right angles: those of their covariance.
fn principal_axes(points: &[DVec3]) -> DMat3 {
    let count = points.len().max(1) as f64;
    let mean = points.iter().copied().sum::<DVec3>() / count;
    let size = points.iter().map(|&p| (p - mean).length()).fold(0.0, f64::max);
    let mut spread = DMat3::ZERO;
    if size > 0.0 {
        for &point in points {
            let off = (point - mean) / size;
            spread += DMat3::from_cols(off * off.x, off * off.y, off * off.z);
        }
    }
    let axes = PrincipalAxes::of(spread).axes;
    if axes.is_finite() { axes } else { DMat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, Random};
    use glam::DQuat;

    /// Points of a slanted brick, near and far from the origin: each in the box, and the box about as small as the brick.
    #[test]
    fn the_box_holds_the_points_and_finds_the_brick() {
        let mut random = Random(5);
        for round in 0..200 {
            let half = DVec3::new(0.5, 0.2, 0.1) * if round % 2 == 0 { 1.0 } else { 1e-7 };
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(random.vector() * 2.0));
            let corner = |k: usize| {
                let side = |axis: usize| if k >> axis & 1 == 1 { half[axis] } else { -half[axis] };
                turn * DVec3::new(side(0), side(1), side(2))
            };
            let points: Vec<DVec3> = (0..8).map(corner).collect();
            let offset = random.vector() * [0.0, 1.0, 1e3][round % 3];
            let place = ConstantTwist::REST
                .with_position(offset)
                .with_orientation(DQuat::from_scaled_axis(random.vector()));
            let found = BodyBox::around(&points, &place.enclose_state(0.0));
            let pose = place.pose_and_twist(0.0).0;
            for &point in &points {
                let off = pose.transform_point(point) - found.center;
                let along = (found.axes.transpose() * off).abs();
                assert!((along - found.half).max_element() <= found.blur, "{along} {found:?}");
                assert!(off.length() <= found.radius + found.blur);
            }
            let volume = found.half.element_product();
            let brick = (half + 8.0 * found.blur).element_product();
            assert!(volume < brick * (1.0 + 1e-6), "round {round}: {volume:e} {brick:e}");
            assert!(found.blur < 1e-13 * (1.0 + offset.length()));
        }
        let point = BodyBox::around(&[DVec3::X], &ConstantTwist::REST.enclose_state(0.0));
        assert_eq!((point.half, point.radius), (DVec3::ZERO, 0.0));
    }
}
