//! The projection of a body to the plane of what a screw motion leaves unchanged: the distance ρ from the axis, and
//! φ = z − hθ up to multiples of the lead 2πh.
//!
//! Triangles that the screw carries into each other, its orbit classes, have one projection, so one of each class is kept,
//! with the bound `slack` on how far corners of the others end beside its own. Triangles are divided where that decides.
//!
//! See docs/theory/engine.md, "Screws".

use super::axis_distance::distance_in_plane;
use d2m_mesh::margin::UP;
use d2m_motion::angle;
use glam::DVec3;
use std::f64::consts::PI;

/// Some directions in the plane: F = αρ + βφ. Loops over them have no branches: several are done at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directions<const N: usize> {
    pub(super) alpha: [f64; N],
    pub(super) beta: [f64; N],
}

/// Any directions would do: these are in steps of about an eighth of half a turn.
pub(super) const DIRECTIONS: Directions<8> = Directions {
    alpha: [1.0, 0.92, 0.71, 0.39, 0.0, -0.39, -0.71, -0.92],
    beta: [0.0, 0.39, 0.71, 0.92, 1.0, 0.92, 0.71, 0.39],
};
/// The directions of ρ and of φ.
const RHO: usize = 0;
const PHI: usize = 4;
/// How much less differences of heights count than those of ρ and φ in the shape of cells.
const HEIGHT_WEIGHT: f64 = 0.1;

/// Times that a triangle may be divided by four.
const MOST_DIVISIONS: u8 = 7;

/// From the lowest to the highest of some numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Range {
    pub(super) fn of(v: [f64; 3]) -> Self {
        Self { low: v[0].min(v[1]).min(v[2]), high: v[0].max(v[1]).max(v[2]) }
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Zero where nothing is known: cells whose angles are not known differ by the rest only.
    fn length(self) -> f64 {
        if self.high < f64::INFINITY { self.high - self.low } else { 0.0 }
    }
}

/// From the lowest to the highest F along some directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs<const N: usize> {
    low: [f64; N],
    high: [f64; N],
}

impl<const N: usize> Slabs<N> {
    const ALL: Self = Self { low: [f64::NEG_INFINITY; N], high: [f64::INFINITY; N] };

    fn get(&self, direction: usize) -> Range {
        Range { low: self.low[direction], high: self.high[direction] }
    }

    fn union(&self, other: &Self) -> Self {
        let mut all = *self;
        for j in 0..N {
            all.low[j] = if other.low[j] < all.low[j] { other.low[j] } else { all.low[j] };
            all.high[j] = if other.high[j] > all.high[j] { other.high[j] } else { all.high[j] };
        }
        all
    }
}

impl<const N: usize> Directions<N> {
    /// How far apart two parts are along each direction, as distances, with the first one's φ raised by `shift`; and how much F may change a
    /// unit of distance. Points that are within ℓ of each other differ in F by at most |∇F| ℓ, with |∇F|² = α² + β² `steep`².
    #[inline(always)]
    pub(super) fn distances(&self, [a, b]: [&Slabs<N>; 2], shift: f64, steep: f64) -> ([f64; N], [f64; N]) {
        let (mut distances, mut lengths) = ([0.0; N], [0.0; N]);
        for j in 0..N {
            let (alpha, beta) = (self.alpha[j], self.beta[j]);
            let moved = beta * shift;
            let (above, below) = (b.low[j] - (a.high[j] + moved), (a.low[j] + moved) - b.high[j]);
            lengths[j] = (alpha * alpha + beta * beta * steep * steep).sqrt() * UP;
            distances[j] = if above > below { above } else { below } / lengths[j];
        }
        (distances, lengths)
    }

    /// The direction along which two parts are furthest apart: see [`distances`](Self::distances).
    #[inline(always)]
    pub(super) fn widest(&self, [a, b]: [&Slabs<N>; 2], shift: f64, steep: f64) -> WidestGap {
        let (distances, _) = self.distances([a, b], shift, steep);
        // A side of no length has no direction, and its distance is no number.
        let (mut k, mut widest) = (0, f64::NEG_INFINITY);
        for (j, distance) in distances.into_iter().enumerate() {
            if distance > widest {
                (k, widest) = (j, distance);
            }
        }
        let moved = self.beta[k] * shift;
        let (above, below) = (b.low[k] - (a.high[k] + moved), (a.low[k] + moved) - b.high[k]);
        WidestGap { direction: k, gap: above.max(below), first_is_below: above > below }
    }
}

/// Along which direction two parts are furthest apart, their gap in F, and which of them has the lower F.
#[derive(Clone, Copy, Debug)]
pub(super) struct WidestGap {
    pub(super) direction: usize,
    pub(super) gap: f64,
    pub(super) first_is_below: bool,
}

/// Bounds of what a part of a body covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    /// The range of F in each direction.
    pub(super) slabs: Slabs<8>,
    pub(super) height: Range,
    /// Least distance from the axis.
    pub(super) near: f64,
    /// How far beside the projection points may be.
    pub(super) slack: f64,
}

impl Projection {
    /// The range of φ.
    pub(super) fn phi(&self) -> Range {
        self.slabs.get(PHI)
    }

    pub(super) fn with(&self, other: &Self) -> Self {
        Self {
            slabs: self.slabs.union(&other.slabs),
            height: self.height.union(other.height),
            near: self.near.min(other.near),
            slack: self.slack.max(other.slack),
        }
    }

    pub(super) fn extents(&self) -> [f64; 3] {
        [self.slabs.get(RHO).length(), self.slabs.get(PHI).length(), HEIGHT_WEIGHT * self.height.length()]
    }

    pub(super) fn middle(&self, dimension: usize) -> f64 {
        let Range { low, high } = [self.slabs.get(RHO), self.slabs.get(PHI), self.height][dimension];
        low + high
    }
}

/// A corner of a triangle, or of a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProjectedVertex {
    /// From the axis, which is the third coordinate.
    pub(super) at: DVec3,
    pub(super) rho: f64,
    pub(super) phi: f64,
}

impl ProjectedVertex {
    /// Corners of triangles get their φ together.
    pub(super) fn new(at: DVec3) -> Self {
        Self { at, rho: at.truncate().length(), phi: at.z }
    }

    /// Half way to another corner. φ is taken from this one, so the branch of θ stays that of the whole triangle.
    fn middle(&self, other: &Self, h: f64) -> Self {
        let at = (self.at + other.at) * 0.5;
        let mut middle = Self::new(at);
        if h != 0.0 {
            let (from, to) = (self.at.truncate(), at.truncate());
            middle.phi = self.phi + (at.z - self.at.z) - h * angle(from.perp_dot(to), from.dot(to));
        }
        middle
    }
}

fn distance_from_axis(corners: &[ProjectedVertex; 3]) -> f64 {
    distance_in_plane(&corners.map(|corner| corner.at.with_z(0.0)), DVec3::Z)
}

/// What is beside the range of F between the corners of a piece: see [`Piece::bends`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Bends {
    pub(super) below: f64,
    pub(super) above: f64,
}

/// A triangle, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) corners: [ProjectedVertex; 3],
    /// Least distance from the axis.
    pub(super) near: f64,
    /// What ρ may be below, and φ beside, the interpolation between the corners.
    pub(super) bend_rho: f64,
    pub(super) bend_phi: f64,
    /// Heights of all triangles of the class, if there are more than one.
    pub(super) shared: Option<Range>,
    pub(super) slack: f64,
    pub(super) divisions: u8,
    /// No angles are known.
    pub(super) wide: bool,
}

impl Piece {
    /// A triangle at this distance from the axis of which no angles are known yet, on a screw with φ = z − hθ.
    pub(super) fn of(corners: [ProjectedVertex; 3], near: f64, h: f64) -> Self {
        let far = corners.iter().map(|vertex| vertex.rho).fold(0.0, f64::max);
        Self {
            corners,
            near,
            bend_rho: far,
            bend_phi: 0.0,
            shared: None,
            slack: 0.0,
            divisions: 0,
            wide: h != 0.0,
        }
    }

    pub(super) fn projection(&self) -> Projection {
        let c = &self.corners;
        let heights = Range::of(c.map(|corner| corner.at.z));
        let mut slabs = if self.wide { Slabs::ALL } else { self.reach(&DIRECTIONS) };
        (slabs.low[RHO], slabs.high[RHO]) = (self.near, c[0].rho.max(c[1].rho).max(c[2].rho));
        Projection { slabs, height: self.shared.unwrap_or(heights), near: self.near, slack: self.slack }
    }

    /// The range of F along directions.
    #[inline(always)]
    pub(super) fn reach<const N: usize>(&self, along: &Directions<N>) -> Slabs<N> {
        let mut slabs = Slabs { low: [0.0; N], high: [0.0; N] };
        let c = &self.corners;
        for j in 0..N {
            let (alpha, beta) = (along.alpha[j], along.beta[j]);
            let [p, q, r] = [0, 1, 2].map(|k: usize| alpha * c[k].rho + beta * c[k].phi);
            let (low, high) = if p < q { (p, q) } else { (q, p) };
            let (low, high) = (if r < low { r } else { low }, if r > high { r } else { high });
            let bends = self.bends(alpha, beta);
            (slabs.low[j], slabs.high[j]) = (low - bends.below, high + bends.above);
        }
        slabs
    }

    /// How far F = αρ + βφ may be below and above what it is at the corners.
    #[inline(always)]
    pub(super) fn bends(&self, alpha: f64, beta: f64) -> Bends {
        let either = beta.abs() * self.bend_phi;
        let (below, above) = if alpha > 0.0 { (alpha, 0.0) } else { (0.0, -alpha) };
        Bends { below: (below * self.bend_rho + either) * UP, above: (above * self.bend_rho + either) * UP }
    }

    /// Fills in the bends: half of the bound on the second derivative, 1/ρ and 1/ρ², times the square of a radius that
    /// holds the corners. ρ is convex: never above. And θ, as its interpolation, is between those of the corners, which are less than half
    /// a turn apart: what is long and comes near the axis would have no φ of use otherwise.
    pub(super) fn bent(mut self, h: f64) -> Self {
        let corners = self.corners.map(|corner| corner.at);
        let radius = [0, 1, 2]
            .map(|i| {
                let middle = (corners[i] + corners[(i + 1) % 3]) * 0.5;
                corners.iter().map(|p| (*p - middle).length_squared()).fold(0.0, f64::max)
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let near = self.near;
        let far = self.corners.iter().map(|corner| corner.rho).fold(0.0, f64::max);
        self.bend_rho = if near > 0.0 { (0.5 * radius / near).min(far) } else { far };
        let bend_theta = (0.5 * radius / (near * near)).min(PI);
        self.bend_phi = if h == 0.0 { 0.0 } else { h.abs() * bend_theta * UP };
        self
    }

    pub(super) fn is_divisible(&self) -> bool {
        self.divisions < MOST_DIVISIONS
    }

    pub(super) fn divided(&self, h: f64) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let (p, q, r) = (a.middle(&b, h), b.middle(&c, h), c.middle(&a, h));
        [[a, p, r], [p, b, q], [r, q, c], [p, q, r]].map(|corners| {
            let near = distance_from_axis(&corners);
            let part = Self { corners, near, divisions: self.divisions + 1, ..*self };
            if self.wide { part } else { part.bent(h) }
        })
    }
}
