//! Principal axes of a symmetric matrix.

use glam::{DMat3, DVec3};

/// Sweeps of Jacobi's method: each squares what is off the diagonal, so three are enough for a matrix of three rows.
const SWEEPS: usize = 6;

/// Eigenvectors and eigenvalues of a symmetric matrix, to rounding, by Jacobi's rotations.
///
/// Entries are to be of about the size of one: squares of them must not overflow.
///
/// ```
/// use d2m_mesh::PrincipalAxes;
/// use glam::{DMat3, DVec3};
/// let m = DMat3::from_cols(DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 2.0, 0.0), DVec3::Z * 5.0);
/// let PrincipalAxes { axes, moments } = PrincipalAxes::of(m);
/// assert!((moments - DVec3::new(1.0, 3.0, 5.0)).length() < 1e-15);
/// assert!((m * axes.y_axis - axes.y_axis * 3.0).length() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAxes {
    /// In the columns, at right angles to each other.
    pub axes: DMat3,
    /// The eigenvalue of each of them, in no order.
    pub moments: DVec3,
}

impl PrincipalAxes {
    /// Those of a symmetric matrix.
    pub fn of(mut symmetric: DMat3) -> Self {
        let mut axes = DMat3::IDENTITY;
        for (i, j) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * SWEEPS) {
            let (aii, ajj, aij) = (symmetric.col(i)[i], symmetric.col(j)[j], symmetric.col(j)[i]);
            if aij == 0.0 {
                continue;
            }
            let ratio = (ajj - aii) / (2.0 * aij);
            let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
            let cos = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sin = tangent * cos;
            let mut turn = DMat3::IDENTITY;
            (turn.col_mut(i)[i], turn.col_mut(j)[j]) = (cos, cos);
            (turn.col_mut(j)[i], turn.col_mut(i)[j]) = (sin, -sin);
            symmetric = turn.transpose() * symmetric * turn;
            axes *= turn;
        }
        Self { axes, moments: DVec3::new(symmetric.x_axis.x, symmetric.y_axis.y, symmetric.z_axis.z) }
    }
}
