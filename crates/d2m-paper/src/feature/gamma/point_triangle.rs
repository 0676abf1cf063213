//! Γ point/triangle, Algorithm 4 of the paper.

use crate::feature::{Face, PointJet};
use d2m_interval::Interval;

/// `false` promises that the point is off the face at all times of the offsets `x`.
///
/// ```text
///            ╲  out  ╱          the paper: barycentrics x_x < 0, x_y < 0 or x_x + x_y > 1,
///         ────╲─────╱────       one strip for each side; here each side is a direction with
///         out  ╲ in╱  out       the extent of the face along it, which keeps its meaning
///               ╲ ╱             for slivers and collapsed triangles and needs no inverse
/// ```
///
/// Every strip is judged on d·q(t), second order in time, instead of on a box around the path: a box wraps, and in B's
/// frame the sides stand still.
pub(crate) fn gamma_point_face(face: &Face<'_>, jet: &PointJet, x: Interval) -> bool {
    face.sides.iter().all(|side| !side.certainly_apart(jet.range_along(side.vector, x)))
}
