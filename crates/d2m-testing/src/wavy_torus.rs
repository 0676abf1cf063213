//! A body that is nowhere convex and nowhere symmetric.
use crate::Surface;
use core::f64::consts::TAU;
use glam::DVec3;

impl Surface {
    /// A closed torus about z of radius 1 whose rings of radius `tube` are wavy.
    ///
    /// ```
    /// let torus = d2m_testing::Surface::wavy_torus(6, 4, 0.3);
    /// assert_eq!((torus.vertices.len(), torus.triangles.len()), (24, 48));
    /// ```
    pub fn wavy_torus(rings: u32, sides: u32, tube: f64) -> Self {
        let point = |k: u32| {
            let (i, j) = (f64::from(k / sides) / f64::from(rings), f64::from(k % sides) / f64::from(sides));
            let (u, v) = (i * TAU, j * TAU);
            let r = tube * (1.0 + 0.2 * (3.0 * u).sin());
            DVec3::new((1.0 + r * v.cos()) * u.cos(), (1.0 + r * v.cos()) * u.sin(), r * v.sin())
        };
        let at = |i: u32, j: u32| (i % rings) * sides + j % sides;
        let quads = (0..rings * sides).map(|k| (k / sides, k % sides));
        let triangles = quads.flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        });
        Self {
            name: "wavy torus",
            vertices: (0..rings * sides).map(point).collect(),
            triangles: triangles.collect(),
        }
    }
}
