//! Mass, center of mass and inertia of a solid.

mod compensated;
mod error;
mod principal_axes;

use crate::mesh::Closedness;
use crate::{MeshPart, MeshParts, Topology, TriMesh};
use compensated::Sum;
pub use error::MassError;
use glam::{DMat3, DVec3};
pub use principal_axes::PrincipalAxes;

/// Mass, center of mass and inertia of a body, in the axes of its mesh.
///
/// ```
/// use d2m_mesh::{MassProperties, TriMesh};
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tetrahedron = MassProperties::try_from_density(&mesh, 6.0)?;
/// assert!((tetrahedron.mass - 1.0).abs() < 1e-15); // a sixth of a unit cube at density 6
/// assert!((tetrahedron.center - DVec3::splat(0.25)).length() < 1e-15);
/// assert!((tetrahedron.inertia.x_axis.x - 3.0 / 40.0).abs() < 1e-15); // m (1 + 1) 3 / 80
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MassProperties {
    /// Mass, positive.
    pub mass: f64,
    /// Center of mass, mesh frame.
    pub center: DVec3,
    /// Inertia about the center, mesh axes; symmetric and positive definite.
    pub inertia: DMat3,
}

/// How far an inertia may be from symmetric, relative to its largest entry: what a text of nine digits loses.
const ASYMMETRY: f64 = 1e-8;

impl MassProperties {
    /// Those of bodies that are held together, by Steiner's theorem; all in one frame.
    ///
    /// ```
    /// use d2m_mesh::MassProperties;
    /// use glam::{DMat3, DVec3};
    /// let ball = |x: f64| MassProperties::try_new(2.0, DVec3::X * x, DMat3::IDENTITY * 0.1);
    /// let dumbbell = MassProperties::together(&[ball(-1.0)?, ball(1.0)?]);
    /// assert_eq!((dumbbell.mass, dumbbell.center), (4.0, DVec3::ZERO));
    /// assert_eq!(dumbbell.inertia, DMat3::from_diagonal(DVec3::new(0.2, 4.2, 4.2)));
    /// # Ok::<(), d2m_mesh::MassError>(())
    /// ```
    pub fn together(masses: &[Self]) -> Self {
        let mass: f64 = masses.iter().map(|own| own.mass).sum();
        let center = masses.iter().map(|own| own.center * own.mass).sum::<DVec3>() / mass;
        let about = |own: &Self| {
            let d = own.center - center;
            let outer = DMat3::from_cols(d * d.x, d * d.y, d * d.z);
            own.inertia + (DMat3::from_diagonal(DVec3::splat(d.length_squared())) - outer) * own.mass
        };
        let inertia = masses.iter().map(about).fold(DMat3::ZERO, |sum, own| sum + own);
        Self { mass, center, inertia }
    }

    /// The integrals of [`Self::try_from_density`] with a density of one, whatever the surface encloses: what is enclosed twice counts twice,
    /// and of an open surface they mean nothing. A surface that is oriented inward counts as outward, a triangle that repeats another one not.
    ///
    /// ```
    /// use d2m_mesh::{MassProperties, TriMesh};
    /// use glam::DVec3;
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
    /// assert!((MassProperties::of_enclosed(&mesh).mass - 1.0 / 6.0).abs() < 1e-15);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub fn of_enclosed(mesh: &TriMesh) -> Self {
        let repeated = Closedness::of(mesh).repeated;
        integrate(mesh, |triangle| repeated.binary_search(&(triangle as u32)).is_err())
    }

    /// Given numbers, checked.
    ///
    /// # Errors
    /// [`MassError`]: a mass that is not positive, an inertia that is not symmetric and positive definite or of which one principal
    /// moment exceeds the sum of the others (by more than 1e-8 of it, what a text of nine digits loses), a number that is not finite.
    pub fn try_new(mass: f64, center: DVec3, inertia: DMat3) -> Result<Self, MassError> {
        if !(mass.is_finite() && mass > 0.0) {
            return Err(MassError::Mass { value: mass });
        }
        if !center.is_finite() {
            return Err(MassError::Center { value: center });
        }
        let symmetric = (inertia + inertia.transpose()) * 0.5;
        let difference = inertia - inertia.transpose();
        let size = largest(&inertia);
        let minor = symmetric.x_axis.x * symmetric.y_axis.y - symmetric.x_axis.y * symmetric.x_axis.y;
        let definite = symmetric.x_axis.x > 0.0 && minor > 0.0 && symmetric.determinant() > 0.0;
        if !inertia.is_finite() || largest(&difference) > ASYMMETRY * size || !definite {
            return Err(MassError::Inertia { value: inertia });
        }
        if !symmetric.inverse().is_finite() {
            return Err(MassError::Inertia { value: inertia });
        }
        let moments = principal_moments(&symmetric);
        if moments.z > (moments.x + moments.y) * (1.0 + ASYMMETRY) + ASYMMETRY * size {
            return Err(MassError::NoSuchBody { moments });
        }
        Ok(Self { mass, center, inertia: symmetric })
    }

    /// Of a closed mesh of constant density, by the exact integrals of the polyhedron: with the vertices a, b, c of each
    /// triangle relative to a point inside the bounding box, s = a + b + c and the volume d = a·(b × c)/6 of a tetrahedron,
    ///
    /// ```text
    /// V = Σ d    V c = Σ d s/4    ∫ x xᵀ = Σ d (aaᵀ + bbᵀ + ccᵀ + ssᵀ)/20    inertia = tr(M) 1 − M, M about c
    /// ```
    ///
    /// Sums are compensated, so the number of triangles costs no digits. The orientation may be inward. Hollow parts
    /// (a surface inside another one, oriented the other way) are no solid.
    ///
    /// # Errors
    /// [`MassError`]: a density that is not positive or beyond what doubles hold of the inertia, a surface that is not closed or not consistently oriented, parts that
    /// overlap (their integral would count twice), no volume.
    pub fn try_from_density(mesh: &TriMesh, density: f64) -> Result<Self, MassError> {
        if !(density.is_finite() && density > 0.0) {
            return Err(MassError::Density { value: density });
        }
        check(mesh)?;
        let solid = Self::of_enclosed(mesh);
        Self::try_new(solid.mass * density, solid.center, solid.inertia * density)
            .map_err(|_| solid.fault("density", density))
    }

    /// As [`Self::try_from_density`] with the density that gives this mass.
    ///
    /// # Errors
    /// As [`Self::try_from_density`].
    pub fn try_from_mass(mesh: &TriMesh, mass: f64) -> Result<Self, MassError> {
        if !(mass.is_finite() && mass > 0.0) {
            return Err(MassError::Mass { value: mass });
        }
        let unit = Self::try_from_density(mesh, 1.0)?;
        Self::try_new(mass, unit.center, unit.inertia * (mass / unit.mass))
            .map_err(|_| unit.fault("mass", mass))
    }

    /// Why these, of density one, are of no use with a density or a mass that is positive.
    fn fault(&self, name: &'static str, value: f64) -> MassError {
        match Self::try_new(self.mass, self.center, self.inertia) {
            Ok(_) => MassError::BeyondNumbers { name, value, volume: self.mass },
            Err(_) => MassError::NoVolume { value: self.mass },
        }
    }
}

/// Eigenvalues of a symmetric matrix, ascending, to rounding.
fn principal_moments(symmetric: &DMat3) -> DVec3 {
    // Relative to the largest entry: no product overflows.
    let size = largest(symmetric);
    let mut moments = PrincipalAxes::of(*symmetric * (1.0 / size)).moments.to_array();
    moments.sort_by(f64::total_cmp);
    DVec3::from_array(moments) * size
}

fn largest(m: &DMat3) -> f64 {
    m.to_cols_array().into_iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Closed, consistently oriented, parts that do not overlap: then the integral counts every point of the solid once.
fn check(mesh: &TriMesh) -> Result<(), MassError> {
    let Closedness { watertight, oriented, .. } = Closedness::of(mesh);
    if !(watertight && oriented) {
        let topology = Topology::new(mesh);
        let open = topology.edges().iter().find(|edge| !edge.is_consistently_oriented());
        let ends = open.map_or([0; 2], |edge| edge.vertices);
        let [from, to] = ends.map(|vertex| mesh.vertices()[vertex as usize]);
        return Err(MassError::Open { from, to });
    }
    let MeshParts { parts, crossing, .. } = MeshParts::new(mesh);
    let overlap = |[i, j]: [usize; 2]| {
        let [first, second] = [i.min(j), i.max(j)].map(|part| parts[part].first_triangle as usize);
        MassError::PartsOverlap { first, second }
    };
    if let Some(&pair) = crossing.first() {
        return Err(overlap(pair));
    }
    // Inside a cavity the winding number is zero, inside the solid one (or minus one, for a surface that faces inward).
    let is_twice = |part: &MeshPart| {
        let own = if part.signed_volume < 0.0 { -1 } else { 1 };
        part.winding_outside.is_none_or(|outside| (outside + own).abs() > 1)
    };
    match parts.iter().position(is_twice) {
        Some(part) => Err(overlap([part, usize::from(part == 0)])),
        None => Ok(()),
    }
}

/// Integrals of density one over what these triangles enclose; a mesh that is oriented inward counts as outward.
fn integrate(mesh: &TriMesh, counts: impl Fn(usize) -> bool) -> MassProperties {
    let [low, high] = mesh.extent();
    let origin = 0.5 * (low + high);
    let mut volume = Sum::default();
    let mut first = [Sum::default(); 3];
    let mut second = [Sum::default(); 6];
    for triangle in (0..mesh.triangle_count()).filter(|&triangle| counts(triangle)) {
        let [a, b, c] = mesh.corners(triangle).map(|p| p - origin);
        let d = a.dot(b.cross(c)) / 6.0;
        let s = a + b + c;
        volume.add(d);
        for k in 0..3 {
            first[k].add(d * s[k] / 4.0);
        }
        for (entry, (j, k)) in second.iter_mut().zip(ENTRIES) {
            entry.add(d * (a[j] * a[k] + b[j] * b[k] + c[j] * c[k] + s[j] * s[k]) / 20.0);
        }
    }
    let sign = if volume.value() < 0.0 { -1.0 } else { 1.0 };
    let volume = sign * volume.value();
    let middle = DVec3::from_array(first.map(|sum| sign * sum.value())) / volume;
    let mut moment = DMat3::ZERO;
    for (entry, (j, k)) in second.iter().zip(ENTRIES) {
        let value = sign * entry.value() - volume * middle[j] * middle[k];
        moment.col_mut(j)[k] = value;
        moment.col_mut(k)[j] = value;
    }
    let trace = moment.x_axis.x + moment.y_axis.y + moment.z_axis.z;
    let inertia = DMat3::from_diagonal(DVec3::splat(trace)) - moment;
    MassProperties { mass: volume, center: origin + middle, inertia }
}

/// The entries of a symmetric matrix.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

#[cfg(test)]
mod tests;
