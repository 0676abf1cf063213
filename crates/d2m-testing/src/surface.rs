//! Triangle meshes as plain arrays, which every layer's own tests can take.
use core::fmt::Debug;
use glam::DVec3;

/// A triangle mesh as plain arrays; by default, nothing.
#[derive(Debug, Clone, Default)]
pub struct Surface {
    /// What it is.
    pub name: &'static str,
    /// Vertices in the body frame.
    pub vertices: Vec<DVec3>,
    /// Triples of vertex indices.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// The closed box from `low` to `high`, oriented outward. The bits of a vertex's index say which of its coordinates are
    /// those of `high`; two triangles a face, faces in the order −z, +z, −y, +y, −x, +x.
    ///
    /// ```
    /// use glam::DVec3;
    /// let cuboid = d2m_testing::Surface::cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
    /// assert_eq!((cuboid.vertices.len(), cuboid.triangles.len()), (8, 12));
    /// assert_eq!(cuboid.vertices[6], DVec3::new(0.0, 2.0, 3.0));
    /// assert_eq!(cuboid.signed_volume(), 6.0);
    /// ```
    pub fn cuboid(low: DVec3, high: DVec3) -> Self {
        const FACES: [[u32; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let pick = |i: u32, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        Self {
            name: "box",
            vertices: (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2))).collect(),
            triangles: FACES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        }
    }

    /// The cube about the origin with this half side, as [`Surface::cuboid`].
    ///
    /// ```
    /// assert_eq!(d2m_testing::Surface::cube(0.5).signed_volume(), 1.0);
    /// ```
    pub fn cube(half: f64) -> Self {
        Self { name: "cube", ..Self::cuboid(DVec3::splat(-half), DVec3::splat(half)) }
    }

    /// The tetrahedron of four vertices, oriented outward if the last one is on the side to which the first three turn
    /// counter-clockwise.
    ///
    /// ```
    /// use glam::DVec3;
    /// let corner = d2m_testing::Surface::tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    /// assert_eq!(corner.signed_volume(), 1.0 / 6.0);
    /// ```
    pub fn tetrahedron(vertices: [DVec3; 4]) -> Self {
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        Self { name: "tetrahedron", vertices: vertices.to_vec(), triangles }
    }

    /// A closed cone of this many sides with its apex at the origin and a base of this radius at z = `height`, which may be below
    /// zero; oriented outward.
    ///
    /// ```
    /// for height in [0.5, -0.5] {
    ///     let cone = d2m_testing::Surface::cone(4, 3.0, height);
    ///     assert!((cone.signed_volume() - 3.0).abs() < 1e-14);
    /// }
    /// ```
    pub fn cone(sides: u32, radius: f64, height: f64) -> Self {
        let mut vertices = vec![DVec3::ZERO, DVec3::Z * height];
        for k in 0..sides {
            let (sin, cos) = (core::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            vertices.push(DVec3::new(radius * cos, radius * sin, height));
        }
        let around = (0..sides).map(|k| (2 + k, 2 + (k + 1) % sides));
        let downward = around.flat_map(|(i, j)| [[0, i, j], [1, j, i]]);
        let cone = Self { name: "cone", vertices, triangles: downward.collect() };
        if height > 0.0 { cone.inverted() } else { cone }
    }

    /// Triangles that share no vertex, each of three successive vertices.
    ///
    /// ```
    /// use glam::DVec3;
    /// let soup = d2m_testing::Surface::soup([DVec3::ZERO, DVec3::X, DVec3::Y].repeat(2));
    /// assert_eq!(soup.triangles, [[0, 1, 2], [3, 4, 5]]);
    /// ```
    pub fn soup(vertices: impl IntoIterator<Item = DVec3>) -> Self {
        let vertices: Vec<_> = vertices.into_iter().collect();
        let triangles = (0..vertices.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        Self { name: "soup", vertices, triangles }
    }

    /// Every vertex mapped, every triangle as it is.
    ///
    /// ```
    /// let twice = d2m_testing::Surface::cube(0.5).map(|vertex| vertex * 2.0);
    /// assert_eq!(twice.signed_volume(), 8.0);
    /// ```
    pub fn map(mut self, map: impl FnMut(DVec3) -> DVec3) -> Self {
        self.vertices = self.vertices.into_iter().map(map).collect();
        self
    }

    /// Inside out.
    ///
    /// ```
    /// assert_eq!(d2m_testing::Surface::cube(0.5).inverted().signed_volume(), -1.0);
    /// ```
    pub fn inverted(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        self
    }

    /// This surface, and another one after it, in one mesh.
    ///
    /// ```
    /// use d2m_testing::Surface;
    /// let hollow = Surface::cube(1.0).with(&Surface::cube(0.5).inverted());
    /// assert_eq!((hollow.vertices.len(), hollow.signed_volume()), (16, 7.0));
    /// ```
    pub fn with(mut self, other: &Self) -> Self {
        let first = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|i| i + first)));
        self
    }

    /// The volume of a closed surface, positive if it is oriented outward, up to rounding.
    ///
    /// ```
    /// assert_eq!(d2m_testing::Surface::cube(1.0).signed_volume(), 8.0);
    /// ```
    pub fn signed_volume(&self) -> f64 {
        let sixfold = self.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| self.vertices[i as usize]);
            a.dot(b.cross(c))
        });
        sixfold.sum::<f64>() / 6.0
    }

    /// What a constructor of checked meshes makes of the arrays.
    ///
    /// # Panics
    /// Where it refuses them.
    ///
    /// ```
    /// let count = d2m_testing::Surface::cube(1.0).into_mesh(|vertices, _| Ok::<_, String>(vertices.len()));
    /// assert_eq!(count, 8);
    /// ```
    #[track_caller]
    pub fn into_mesh<M, E: Debug>(
        self,
        try_new: impl FnOnce(Vec<DVec3>, Vec<[u32; 3]>) -> Result<M, E>,
    ) -> M {
        try_new(self.vertices, self.triangles).expect("a surface that is accepted")
    }
}
