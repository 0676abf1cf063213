//! Why a body has no usable mass properties.

use glam::{DMat3, DVec3};

/// Why a body has no usable mass properties.
///
/// ```
/// use d2m_mesh::{MassError, MassProperties, TriMesh};
/// let sheet = TriMesh::try_new(vec![glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y], vec![[0, 1, 2]])?;
/// let error = MassProperties::try_from_density(&sheet, 1.0).unwrap_err();
/// assert!(matches!(error, MassError::Open { .. }) && error.to_string().contains("give mass"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MassError {
    /// The mass is not finite and positive.
    #[error("mass {value:?} must be finite and positive")]
    Mass {
        /// The refused value.
        value: f64,
    },
    /// The density is not finite and positive.
    #[error("density {value:?} must be finite and positive")]
    Density {
        /// The refused value.
        value: f64,
    },
    /// The center of mass is not finite.
    #[error("center {:?} must be finite", value.to_array())]
    Center {
        /// The refused value.
        value: DVec3,
    },
    /// The inertia is not symmetric and positive definite.
    #[error("inertia {:?} must be finite, symmetric and positive definite", value.transpose().to_cols_array_2d())]
    Inertia {
        /// The refused value; messages have its rows, as files do.
        value: DMat3,
    },
    /// No body has such an inertia: it is ∫ (|x|² 1 − x xᵀ) dm of a mass that is nowhere negative only if no principal moment exceeds
    /// the sum of the other two.
    #[error(
        "inertia: the principal moments {:?} are those of no body, since the largest exceeds the sum of the others",
        moments.to_array()
    )]
    NoSuchBody {
        /// The principal moments, ascending, to rounding.
        moments: DVec3,
    },
    /// The surface has an edge that not as many triangles run through one way as the other.
    #[error(
        "the mesh is open or not consistently oriented at the edge from {:?} to {:?}: give mass, center and inertia",
        from.to_array(),
        to.to_array()
    )]
    Open {
        /// One end of the edge, mesh frame.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// Two parts of the surface overlap, so the integrals would count points twice.
    #[error(
        "the parts of triangle {first} and triangle {second} overlap: give mass, center and inertia, or join them"
    )]
    PartsOverlap {
        /// A triangle of one part.
        first: usize,
        /// A triangle of the other part.
        second: usize,
    },
    /// A density or a mass with which the inertia of the mesh, or its inverse, is no number.
    #[error(
        "{name} {value:?}: with the volume of {volume:?} that the mesh encloses no inertia of it is a number"
    )]
    BeyondNumbers {
        /// Which of the two was given.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// The volume, rounded.
        volume: f64,
    },
    /// The mesh encloses no volume, up to rounding.
    #[error("the mesh encloses a volume of {value:?}, so it has no mass: give mass, center and inertia")]
    NoVolume {
        /// The volume, rounded.
        value: f64,
    },
}
