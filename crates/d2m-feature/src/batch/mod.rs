//! Four feature pairs at once: whether a look at the middle of the window alone rules out any contact.
//!
//! All features of two bodies share the frame in the middle of the window: nine matrix products give the jets of four
//! points. The rejects are the first exclusions of the single tests with the same remainders; see
//! docs/theory/features.md, "Batches".
mod lanes;
mod quads;

#[cfg(test)]
mod tests;

pub use quads::{EdgeQuad, PointQuad, TriangleQuad};

use crate::pair_motion::PairMotion;
use d2m_motion::Frame;
use glam::DVec3;
use lanes::{Lanes, Portable};
use quads::{Four, Four3};

const UP: f64 = 1.0 + 1e-14;
/// All four.
const ALL: u32 = 15;

/// Three lanes of coordinates.
#[derive(Clone, Copy)]
struct Vectors<L> {
    x: L,
    y: L,
    z: L,
}

impl<L: Lanes> Vectors<L> {
    #[inline(always)]
    fn load(v: &Four3) -> Self {
        Self { x: L::load(&v[0]), y: L::load(&v[1]), z: L::load(&v[2]) }
    }
    #[inline(always)]
    fn splat(v: DVec3) -> Self {
        Self { x: L::splat(v.x), y: L::splat(v.y), z: L::splat(v.z) }
    }
    #[inline(always)]
    fn dot(&self, o: &Self) -> L {
        self.x * o.x + self.y * o.y + self.z * o.z
    }
    #[inline(always)]
    fn plus(&self, o: &Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
    #[inline(always)]
    fn minus(&self, o: &Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
    #[inline(always)]
    fn cross(&self, o: &Self) -> Self {
        Self {
            x: self.y * o.z - self.z * o.y,
            y: self.z * o.x - self.x * o.z,
            z: self.x * o.y - self.y * o.x,
        }
    }
    /// The vectors times the matrix of a derivative of the frame.
    #[inline(always)]
    fn turned(&self, frame: &Frame, order: usize) -> Self {
        let (_, m) = frame.affine(order);
        let (x, y, z) = (Self::splat(m.x_axis), Self::splat(m.y_axis), Self::splat(m.z_axis));
        Self {
            x: x.x * self.x + y.x * self.y + z.x * self.z,
            y: x.y * self.x + y.y * self.y + z.y * self.z,
            z: x.z * self.x + y.z * self.y + z.z * self.z,
        }
    }
    /// Position, velocity or acceleration of the points.
    #[inline(always)]
    fn moved(&self, frame: &Frame, order: usize) -> Self {
        Self::splat(frame.affine(order).0).plus(&self.turned(frame, order))
    }
}

/// Velocity and acceleration of four points in the middle of the window.
struct Jets<L> {
    v: Vectors<L>,
    a: Vectors<L>,
    h: L,
    half_square: L,
}

impl<L: Lanes> Jets<L> {
    #[inline(always)]
    fn new(frame: &Frame, r: &Vectors<L>, h: f64) -> Self {
        let (v, a) = (r.moved(frame, 1), r.moved(frame, 2));
        Self { v, a, h: L::splat(h), half_square: L::splat(0.5 * h * h * UP) }
    }

    /// How far the polynomials move along the directions over the window: `h|d·v| + h²|d·a|/2`.
    #[inline(always)]
    fn swing(&self, d: &Vectors<L>) -> L {
        self.h * d.dot(&self.v).abs() + self.half_square * d.dot(&self.a).abs()
    }
}

impl PairMotion {
    /// For four points of A against four triangles of B, lane by lane: true where a look at the middle of the window
    /// proves that there is no contact in all of it. False says nothing: ask [`PairMotion::point_triangle`].
    ///
    /// Tested along the line from the triangle's centre, along the face normal and along the three side normals. A
    /// few ns a feature; the same bits on every machine.
    ///
    /// ```
    /// use d2m_feature::PairMotion;
    /// use d2m_motion::ConstantTwist;
    /// use glam::DVec3;
    /// let pair = PairMotion::new(&ConstantTwist::REST, &ConstantTwist::REST, 0.0, 1.0);
    /// let triangles = pair.place_triangles(&[[DVec3::X, DVec3::Y, DVec3::ZERO]; 4]);
    /// let points = pair.place_points(&[DVec3::Z, -DVec3::Z, DVec3::ZERO, DVec3::splat(0.6)]);
    /// assert_eq!(pair.reject_points(&points, &triangles, 0.0), [true, true, false, true]);
    /// ```
    pub fn reject_points(
        &self,
        points: &PointQuad,
        triangles: &TriangleQuad,
        min_separation: f64,
    ) -> [bool; 4] {
        self.reject(&Pairs(points, triangles), min_separation)
    }

    /// For four edges of A against four edges of B, lane by lane: true where a look at the middle of the window
    /// proves that there is no contact in all of it. False says nothing: ask [`PairMotion::edge_edge`].
    ///
    /// Tested along the line of the midpoints and along the common normal.
    ///
    /// ```
    /// use d2m_feature::PairMotion;
    /// use d2m_motion::ConstantTwist;
    /// use glam::DVec3;
    /// let pair = PairMotion::new(&ConstantTwist::REST, &ConstantTwist::REST, 0.0, 1.0);
    /// let over = |height: f64| [DVec3::new(-9.0, 0.5, height), DVec3::new(9.0, -0.5, height)];
    /// let (a, b) = ([over(0.1), over(0.0), over(-0.1), over(1e-9)], [[-DVec3::Y, DVec3::Y]; 4]);
    /// let (a, b) = (pair.place_edges_a(&a), pair.place_edges_b(&b));
    /// assert_eq!(pair.reject_edges(&a, &b, 0.0), [true, false, true, true]);
    /// ```
    pub fn reject_edges(&self, edges_a: &EdgeQuad, edges_b: &EdgeQuad, min_separation: f64) -> [bool; 4] {
        self.reject(&Pairs(edges_a, edges_b), min_separation)
    }

    /// [`PairMotion::reject_points`] without vector registers of 256 bits, for measurements.
    #[doc(hidden)]
    pub fn reject_points_portable(&self, points: &PointQuad, triangles: &TriangleQuad) -> [bool; 4] {
        self.reject_portable(&Pairs(points, triangles), 0.0)
    }

    /// [`PairMotion::reject_edges`] without vector registers of 256 bits, for measurements.
    #[doc(hidden)]
    pub fn reject_edges_portable(&self, edges_a: &EdgeQuad, edges_b: &EdgeQuad) -> [bool; 4] {
        self.reject_portable(&Pairs(edges_a, edges_b), 0.0)
    }

    fn reject(&self, pairs: &impl FourPairs, min_separation: f64) -> [bool; 4] {
        let separation = min_separation.max(0.0);
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            let (frame, h) = (self.forward().middle_frame(), self.half_window());
            // SAFETY: the processor has AVX2.
            #[allow(unsafe_code)]
            return each(unsafe { rejected_avx(pairs, frame, h, separation) });
        }
        self.reject_portable(pairs, separation)
    }

    fn reject_portable(&self, pairs: &impl FourPairs, separation: f64) -> [bool; 4] {
        each(pairs.rejected::<Portable>(self.forward().middle_frame(), self.half_window(), separation))
    }
}

fn each(bits: u32) -> [bool; 4] {
    [0, 1, 2, 3].map(|i| bits >> i & 1 == 1)
}

/// Four features of A and four of B.
struct Pairs<'a, A, B>(&'a A, &'a B);

trait FourPairs {
    /// Bits of the pairs that a look at the middle of a window of half-width `h` rules out.
    fn rejected<L: Lanes>(&self, frame: &Frame, h: f64, separation: f64) -> u32;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn rejected_avx(pairs: &impl FourPairs, frame: &Frame, h: f64, separation: f64) -> u32 {
    pairs.rejected::<lanes::Avx>(frame, h, separation)
}

/// The remainder of both sides, rounded up, plus the separation.
#[inline(always)]
fn margins<L: Lanes>(a: &Four, b: &Four, separation: f64) -> L {
    (L::load(a) + L::load(b) + L::splat(separation)) * L::splat(UP)
}

impl FourPairs for Pairs<'_, PointQuad, TriangleQuad> {
    #[inline(always)]
    fn rejected<L: Lanes>(&self, frame: &Frame, h: f64, separation: f64) -> u32 {
        let Self(points, triangles) = self;
        let r = Vectors::<L>::load(&points.arm);
        let p = r.moved(frame, 0);
        let up = L::splat(UP);
        // The sphere about all places of the point and the one about the triangle: two of three far lanes end here.
        let away = p.minus(&Vectors::load(&triangles.centre));
        let square = away.dot(&away);
        let radius = L::load(&triangles.radius);
        let near = (radius + margins::<L>(&points.stray, &triangles.margin, separation)) * up;
        let mut rejected = square.greater_bits(near * near * up);
        if rejected == ALL {
            return rejected;
        }
        // Beyond the sphere about the triangle, along the line of centres.
        let jets = Jets::new(frame, &r, h);
        let margin: L = margins(&points.margin, &triangles.margin, separation);
        let needed = square.sqrt() * (radius + margin) * up;
        rejected |= (square - jets.swing(&away)).greater_bits(needed);
        for (normal, least, greatest) in &triangles.planes {
            if rejected == ALL {
                break;
            }
            let normal = Vectors::load(normal);
            let value = normal.dot(&p);
            let reach = (jets.swing(&normal) + margin) * up;
            rejected |= (value - reach).greater_bits(L::load(greatest));
            rejected |= L::load(least).greater_bits(value + reach);
        }
        rejected
    }
}

impl FourPairs for Pairs<'_, EdgeQuad, EdgeQuad> {
    #[inline(always)]
    fn rejected<L: Lanes>(&self, frame: &Frame, h: f64, separation: f64) -> u32 {
        let Self(a, b) = self;
        let r = Vectors::<L>::load(&a.middle);
        let w = r.moved(frame, 0).minus(&Vectors::load(&b.middle));
        let up = L::splat(UP);
        let (length_a, length_b) = (L::load(&a.length), L::load(&b.length));
        // Spheres about both edges.
        let square = w.dot(&w);
        let near = (length_a + length_b + margins::<L>(&a.stray, &b.margin, separation)) * up;
        let mut rejected = square.greater_bits(near * near * up);
        if rejected == ALL {
            return rejected;
        }
        // The edges themselves along the line of the midpoints.
        let jets = Jets::new(frame, &r, h);
        let margin: L = margins(&a.margin, &b.margin, separation);
        let distance = square.sqrt();
        let least = square - jets.swing(&w);
        let (half_a, d) = (Vectors::load(&a.half), Vectors::load(&b.half));
        let e = half_a.turned(frame, 0);
        let along = w.dot(&e).abs() + w.dot(&d).abs();
        rejected |= least.greater_bits((along + distance * (L::load(&a.turn) + margin)) * up);
        if rejected == ALL {
            return rejected;
        }
        // Along the common normal k = e × d: contact needs |k·w| ≤ |k·e(t)|, which starts at 0 and grows by its
        // derivative. What rounding leaves of k·e and k·d goes with the lengths, not with |k|.
        let k = e.cross(&d);
        let e1 = half_a.turned(frame, 1);
        let value = k.dot(&w).abs() - jets.swing(&k);
        let turning = jets.h * k.dot(&e1).abs() + k.dot(&k).sqrt() * (L::load(&a.bend) + margin);
        let rounding = L::splat(8.0 * f64::EPSILON) * length_a * length_b * (length_a + length_b);
        rejected | value.greater_bits((turning + rounding) * up)
    }
}
