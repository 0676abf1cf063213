//! Where two bodies are nearest to each other.

use crate::arrays::vector;
use d2m::bvh::{Clearance, Distance};
use glam::DVec3;
use numpy::PyArray1;
use pyo3::prelude::*;

/// Where two bodies are nearest to each other: what `Distance` and `Clearance` have in common.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> isinstance(d2m_ccd.distance(box, box, d2m_ccd.Pose(x=[0, 0, 3])), d2m_ccd.Witness)
/// True
#[pyclass(frozen, subclass, module = "d2m_ccd")]
pub(crate) struct Witness {
    points: [DVec3; 2],
    normal: DVec3,
    triangles: [u32; 2],
}

impl From<&Clearance> for Witness {
    fn from(found: &Clearance) -> Self {
        let Clearance { point_a, point_b, normal, triangle_a, triangle_b, .. } = *found;
        Self { points: [point_a, point_b], normal, triangles: [triangle_a, triangle_b] }
    }
}

impl From<&Distance> for Witness {
    fn from(found: &Distance) -> Self {
        let Distance { point_a, point_b, normal, triangle_a, triangle_b, .. } = *found;
        Self { points: [point_a, point_b], normal, triangles: [triangle_a, triangle_b] }
    }
}

#[pymethods]
impl Witness {
    /// The point on the surface of A, world frame, shape (3,).
    #[getter]
    fn point_a<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.points[0].to_array())
    }

    /// The point on the surface of B, world frame, shape (3,).
    #[getter]
    fn point_b<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.points[1].to_array())
    }

    /// Unit direction from A to B, world axes, shape (3,); zero where the bodies are not proven apart.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.normal.to_array())
    }

    /// The triangle of A that holds `point_a`.
    #[getter]
    const fn triangle_a(&self) -> u32 {
        self.triangles[0]
    }

    /// The triangle of B that holds `point_b`.
    #[getter]
    const fn triangle_b(&self) -> u32 {
        self.triangles[1]
    }
}
