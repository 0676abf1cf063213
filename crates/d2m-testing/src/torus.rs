//! Bodies with a hole: nowhere convex, and with waves nowhere symmetric.
use crate::Surface;
use core::f64::consts::TAU;
use glam::DVec3;

impl Surface {
    /// A closed torus about z of radius 1 with `rings` of radius `tube`, each of `sides` vertices.
    ///
    /// ```
    /// let torus = d2m_testing::Surface::torus(6, 4, 0.3);
    /// assert_eq!((torus.vertices.len(), torus.triangles.len()), (24, 48));
    /// ```
    pub fn torus(rings: u32, sides: u32, tube: f64) -> Self {
        Self { name: "torus", ..rings_about_z([rings, sides], |_| tube) }
    }

    /// As [`Surface::torus`], with rings whose radii vary by a fifth, in three waves.
    ///
    /// ```
    /// let torus = d2m_testing::Surface::wavy_torus(6, 4, 0.3);
    /// assert_eq!((torus.vertices.len(), torus.triangles.len()), (24, 48));
    /// ```
    pub fn wavy_torus(rings: u32, sides: u32, tube: f64) -> Self {
        let wavy = |u: f64| tube * (1.0 + 0.2 * (3.0 * u).sin());
        Self { name: "wavy torus", ..rings_about_z([rings, sides], wavy) }
    }
}

/// Rings of a radius that depends on the angle about z.
fn rings_about_z([rings, sides]: [u32; 2], radius: impl Fn(f64) -> f64) -> Surface {
    let point = |k: u32| {
        let (i, j) = (f64::from(k / sides) / f64::from(rings), f64::from(k % sides) / f64::from(sides));
        let (u, v) = (i * TAU, j * TAU);
        let r = radius(u);
        DVec3::new((1.0 + r * v.cos()) * u.cos(), (1.0 + r * v.cos()) * u.sin(), r * v.sin())
    };
    let at = |i: u32, j: u32| (i % rings) * sides + j % sides;
    let quads = (0..rings * sides).map(|k| (k / sides, k % sides));
    let triangles = quads.flat_map(|(i, j)| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Surface {
        name: "rings",
        vertices: (0..rings * sides).map(point).collect(),
        triangles: triangles.collect(),
    }
}
