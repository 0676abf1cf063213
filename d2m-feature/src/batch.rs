//! Four feature pairs at once: whether the middle frame of the window alone rules out any contact.
use crate::pair_motion::{PairMotion, PlacedTriangle};
use crate::path::FramedMotion;
use d2m_motion::Frame;
use glam::DVec3;

const UP: f64 = 1.0 + 1e-14;

/// Four numbers side by side; plain loops that compilers turn into vector instructions.
type Four = [f64; 4];

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> Four {
    [f(0), f(1), f(2), f(3)]
}

/// Four vectors, component by component.
#[derive(Clone, Copy)]
struct Four3 {
    x: Four,
    y: Four,
    z: Four,
}

impl Four3 {
    #[inline(always)]
    fn gather(f: impl Fn(usize) -> DVec3) -> Self {
        let v = [f(0), f(1), f(2), f(3)];
        Self { x: v.map(|v| v.x), y: v.map(|v| v.y), z: v.map(|v| v.z) }
    }

    #[inline(always)]
    fn dot(&self, o: &Self) -> Four {
        each(|i| self.x[i] * o.x[i] + self.y[i] * o.y[i] + self.z[i] * o.z[i])
    }

    #[inline(always)]
    fn minus(&self, o: &Self) -> Self {
        Self {
            x: each(|i| self.x[i] - o.x[i]),
            y: each(|i| self.y[i] - o.y[i]),
            z: each(|i| self.z[i] - o.z[i]),
        }
    }

    /// Position, velocity or acceleration of the points `self` in a frame.
    #[inline(always)]
    fn moved(&self, frame: &Frame, order: usize) -> Self {
        let (c, m) = frame.affine(order);
        Self {
            x: each(|i| c.x + (m.x_axis.x * self.x[i] + m.y_axis.x * self.y[i] + m.z_axis.x * self.z[i])),
            y: each(|i| c.y + (m.x_axis.y * self.x[i] + m.y_axis.y * self.y[i] + m.z_axis.y * self.z[i])),
            z: each(|i| c.z + (m.x_axis.z * self.x[i] + m.y_axis.z * self.y[i] + m.z_axis.z * self.z[i])),
        }
    }
}

impl PairMotion {
    /// For four points of A against four prepared triangles of B: true where a look at the middle of the window
    /// proves that there is no contact in all of it. False says nothing: ask [`PairMotion::point_placed`].
    ///
    /// Tested along the line from the triangle's centre, along the face normal and along the three side normals,
    /// with the jets and remainders of the single test.
    ///
    /// ```
    /// use d2m_feature::PairMotion;
    /// use d2m_motion::LinearMotion;
    /// use glam::DVec3;
    /// let pair = PairMotion::new(&LinearMotion::REST, &LinearMotion::REST, 0.0, 1.0);
    /// let triangle = pair.place_triangle(&[DVec3::X, DVec3::Y, DVec3::ZERO]);
    /// let points = [DVec3::Z, -DVec3::Z, DVec3::ZERO, DVec3::splat(0.6)];
    /// assert_eq!(pair.reject_points(&points, [&triangle; 4], 0.0), [true, true, false, true]);
    /// ```
    pub fn reject_points(
        &self,
        points: &[DVec3; 4],
        triangles: [&PlacedTriangle; 4],
        min_separation: f64,
    ) -> [bool; 4] {
        reject(self.forward(), points, triangles, min_separation.max(0.0))
    }
}

fn reject(
    framed: &FramedMotion,
    points: &[DVec3; 4],
    triangles: [&PlacedTriangle; 4],
    separation: f64,
) -> [bool; 4] {
    let motion = &framed.motion;
    let planes = triangles.map(PlacedTriangle::planes);
    let r = Four3::gather(|i| motion.place_a(points[i]));
    let radius = r.dot(&r).iter().fold(0.0, |m: f64, &s| if s > m || s.is_nan() { s } else { m }).sqrt() * UP;
    let extent =
        planes.iter().fold(0.0, |m: f64, p| if p.extent > m || p.extent.is_nan() { p.extent } else { m });
    let h = 0.5 * motion.duration() * UP;
    // One remainder for the four: the largest.
    let margin = motion.point_remainder(radius, extent).bound(h) + separation;
    let frame = framed.middle_frame();
    let (p, v, a) = (r.moved(frame, 0), r.moved(frame, 1), r.moved(frame, 2));
    let swing = |d: &Four3| {
        let (slope, curvature) = (d.dot(&v), d.dot(&a));
        each(|i| h * (slope[i].abs() + 0.5 * h * curvature[i].abs()))
    };
    let mut rejected = [false; 4];
    // Beyond the sphere about the triangle, along the line of centres.
    let centre = Four3::gather(|i| planes[i].centre);
    let away = p.minus(&centre);
    let (square, moves) = (away.dot(&away), swing(&away));
    for i in 0..4 {
        let length = square[i].sqrt();
        rejected[i] = square[i] - moves[i] > length * (planes[i].radius + margin) * UP;
    }
    let mut slab = |d: Four3, support: [(f64, f64); 4]| {
        let (value, moves) = (d.dot(&p), swing(&d));
        for i in 0..4 {
            let (lo, hi) = support[i];
            let reach = (moves[i] + margin) * UP;
            rejected[i] |= value[i] - reach > hi || value[i] + reach < lo;
        }
    };
    slab(Four3::gather(|i| planes[i].normal), [0, 1, 2, 3].map(|i| planes[i].slab));
    for k in 0..3 {
        slab(Four3::gather(|i| planes[i].sides[k]), [0, 1, 2, 3].map(|i| planes[i].side_support[k]));
    }
    rejected
}
