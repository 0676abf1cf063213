//! Bodies of several meshes.

use crate::numbers::{UNUSABLE, turn};
use crate::shown::{shown, shown_turn};
use crate::{Body, Mass, MassProperties, SimulationError};
use d2m_bvh::{MeshTree, TriMesh};
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// A mesh of a body of several ones: its place in the body, and its density.
///
/// ```
/// use d2m_dynamics::Part;
/// use glam::DVec3;
/// let brick = d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05")?;
/// let heavy = Part { position: DVec3::X, density: 7800.0, ..Part::new(&brick) };
/// assert_eq!((Part::new(&brick).density, heavy.position), (1000.0, DVec3::X));
/// # Ok::<(), d2m_shapes::ShapeError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Part<'m> {
    /// The mesh; other parts may share it.
    pub mesh: &'m TriMesh,
    /// Position of the mesh frame in the frame of the body.
    pub position: DVec3,
    /// Orientation of the mesh frame in the frame of the body; normalised, zero is refused.
    pub orientation: DQuat,
    /// Density of the closed mesh.
    pub density: f64,
}

impl<'m> Part<'m> {
    /// A part whose frame is that of the body, with a density of 1000.
    pub const fn new(mesh: &'m TriMesh) -> Self {
        Self { mesh, position: DVec3::ZERO, orientation: DQuat::IDENTITY, density: 1000.0 }
    }
}

impl Body {
    /// A body of several closed meshes that are held together, with the mass of them all. Parts may overlap;
    /// each has its whole mass nevertheless.
    ///
    /// The body is one mesh with the vertices of all parts, placed; certificates are about that mesh.
    ///
    /// ```
    /// use d2m_dynamics::{Body, Part, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let (rod, head) = (d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05")?, d2m_shapes::mesh("box?x=0.1&y=0.2&z=0.1")?);
    /// let parts = [Part::new(&rod), Part { position: DVec3::X * 0.6, density: 7800.0, ..Part::new(&head) }];
    /// let hammer = Body::of_parts("hammer", &parts)?;
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let hammer = simulation.add(&hammer)?;
    /// let mass = simulation.mass_properties(hammer).expect("it is dynamic");
    /// assert!((mass.mass - (10.0 + 124.8)).abs() < 1e-9);
    /// assert!((mass.center.x - 124.8 * 0.6 / 134.8).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// No part; a part without mass properties of its own (give the body [`Mass::Given`] and its merged mesh
    /// instead), or with a place that cannot be used.
    pub fn of_parts(name: impl Into<String>, parts: &[Part<'_>]) -> Result<Self, SimulationError> {
        let name = name.into();
        let bad = |name: &'static str, value: String| SimulationError::BadBody {
            body: "of several parts".to_owned(),
            name,
            value,
            reason: UNUSABLE,
        };
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let mut masses = Vec::new();
        for (k, part) in parts.iter().enumerate() {
            let Some(turn) = turn(part.orientation).filter(|_| part.position.is_finite()) else {
                return Err(bad(
                    "place of part",
                    format!("{k}: {}, {}", shown(part.position.to_array()), shown_turn(part.orientation)),
                ));
            };
            let placed: Vec<DVec3> = part.mesh.vertices().iter().map(|v| turn * *v + part.position).collect();
            let own = TriMesh::try_new(placed.clone(), part.mesh.triangles().to_vec());
            let own = own.map_err(|error| bad("mesh of part", format!("{k}: {error}")))?;
            let mass = MassProperties::try_from_density(&own, part.density);
            masses.push(mass.map_err(|error| SimulationError::Mass { body: name.clone(), error })?);
            let first = vertices.len() as u32;
            triangles.extend(part.mesh.triangles().iter().map(|triangle| triangle.map(|v| v + first)));
            vertices.extend(placed);
        }
        let mesh = TriMesh::try_new(vertices, triangles).map_err(|error| bad("mesh", error.to_string()))?;
        Ok(Self::new(name, Arc::new(MeshTree::new(mesh)))
            .with_mass(Mass::Given(MassProperties::together(&masses))))
    }
}
