//! One box of one body against the eight boxes of a wide node of the other: how far apart are they at least?

use crate::lanes::Lanes;
use crate::tree::margin::{UNIT_F32, round_up};
use crate::tree::node::{OrientedBox, WideNode};
use glam::DVec3;

/// Factor of the error bound of a gap along a box axis; docs/theory/static-queries.md counts at most 29.
pub(super) const GAP_ERROR: f64 = 32.0 * UNIT_F32;
/// Covers the axes' deviation from orthonormal and the roundings of squares, sums and root: at most 9u.
const NORM_FACTOR: f32 = 1.0 - 16.0 * UNIT_F32 as f32;

/// The single body seen from the wide body, whose node is opened. Lengths are in units of the wide body's tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Columns of the rotation into the wide body's frame.
    pub(super) rotation: [DVec3; 3],
    /// Centre of the single body's tree from that of the wide one.
    pub(super) offset: DVec3,
    /// Unit of the single body over that of the wide one.
    pub(super) ratio: f64,
    /// Added to every margin: the errors of places.
    pub(super) floor: f64,
    /// Unit of the wide body over the working unit.
    pub(super) to_work: f32,
}

/// A single box in the frame of a wide node, rounded once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    center: [f32; 3],
    axes: [[f32; 3]; 3],
    half: [f32; 3],
    radius: f32,
    margin: f32,
    /// One more direction to look along, wide body's axes, of length at most one; what the box reaches along it.
    along: [f32; 3],
    /// Middle of what it covers along that direction, from the node's origin.
    at_along: f32,
    reach_along: f32,
}

impl Placed {
    #[inline(always)]
    pub(super) fn new(side: &Side, boxed: &OrientedBox, origin: [f32; 3], wide: &WideNode) -> Self {
        let center = arm(side, origin, boxed.center) + side.offset - vector(wide.origin);
        let radius = f64::from(boxed.radius) * side.ratio;
        let (ratio, half) = (side.ratio as f32, &boxed.half_extent);
        let norm = center.x.abs() + center.y.abs() + center.z.abs();
        Self {
            center: narrow(center),
            axes: [turned(side, boxed.axes[0]), turned(side, boxed.axes[1]), turned(side, boxed.axes[2])],
            half: [half[0] * ratio, half[1] * ratio, half[2] * ratio],
            radius: round_up(radius),
            margin: round_up(GAP_ERROR * (norm + f64::from(wide.extent) + radius) + side.floor),
            along: [0.0; 3],
            at_along: 0.0,
            reach_along: 0.0,
        }
    }

    /// With a direction of length at most one, wide body's axes.
    #[inline(always)]
    pub(super) fn looking_along(mut self, n: [f32; 3]) -> Self {
        let (b, k) = (&self.axes, &self.half);
        self.reach_along = size(n, b[0]) * k[0] + size(n, b[1]) * k[1] + size(n, b[2]) * k[2];
        let c = &self.center;
        self.at_along = n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
        self.along = n;
        self
    }

    /// With a direction, for a box around one triangle: what the triangle itself covers, which may be much less than its
    /// box does. Corners from the node's origin, wide body's axes and unit.
    #[inline(always)]
    pub(super) fn looking_at_triangle_along(mut self, n: [f32; 3], corners: &[DVec3; 3]) -> Self {
        let direction = vector(n);
        let [p, q, r] = [direction.dot(corners[0]), direction.dot(corners[1]), direction.dot(corners[2])];
        let (low, high) = (p.min(q).min(r), p.max(q).max(r));
        self.at_along = (0.5 * (low + high)) as f32;
        // From the middle as it is rounded.
        let middle = f64::from(self.at_along);
        self.reach_along = round_up((high - middle).max(middle - low));
        self.along = n;
        self
    }
}

/// |n·a|.
#[inline(always)]
fn size(n: [f32; 3], a: [f32; 3]) -> f32 {
    (n[0] * a[0] + n[1] * a[1] + n[2] * a[2]).abs()
}

#[inline(always)]
fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))
}

#[inline(always)]
fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// The centre of a box from the centre of its tree, wide body's axes and unit.
#[inline(always)]
fn arm(side: &Side, origin: [f32; 3], center: [f32; 3]) -> DVec3 {
    let p = (vector(origin) + vector(center)) * side.ratio;
    side.rotation[0] * p.x + side.rotation[1] * p.y + side.rotation[2] * p.z
}

/// A stored axis in the wide body's frame.
#[inline(always)]
fn turned(side: &Side, axis: [f32; 3]) -> [f32; 3] {
    let a = vector(axis);
    narrow(side.rotation[0] * a.x + side.rotation[1] * a.y + side.rotation[2] * a.z)
}

/// Scalar product of lanes. (No closures and no `array::map` here: they are compiled without the vector instructions
/// unless they happen to be inlined.)
#[inline(always)]
fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn splat<L: Lanes>(values: &[f32; 3]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

#[inline(always)]
fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// |n·aᵢ| for the axes of the other box.
#[inline(always)]
fn sizes<L: Lanes>(n: &[L; 3], axes: &[[L; 3]; 3]) -> [L; 3] {
    [dot(n, &axes[0]).abs(), dot(n, &axes[1]).abs(), dot(n, &axes[2]).abs()]
}

/// Gap along one axis: distance of the centres less what both boxes reach and the margin, not below zero.
#[inline(always)]
fn gap<L: Lanes>(to: &[L; 3], n: &[L; 3], own: L, other: &[L; 3], size: [L; 3], margin: L) -> L {
    (dot(to, n).abs() - (own + dot(other, &size)) - margin).max(L::splat(0.0))
}

/// Gaps along the three axes of each lane's box, and along the three of the single box.
type Gaps<L> = ([L; 3], [L; 3]);

/// The gaps, not below zero, and the vectors between the centres.
#[inline(always)]
fn gaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> (Gaps<L>, [L; 3]) {
    let center = load::<L>(&wide.center);
    let at = splat::<L>(&placed.center);
    let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
    let h = load::<L>(&wide.half_extent);
    let a = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
    let b = [splat::<L>(&placed.axes[0]), splat::<L>(&placed.axes[1]), splat::<L>(&placed.axes[2])];
    let k = splat::<L>(&placed.half);
    let m = L::splat(placed.margin);
    let s = [sizes(&a[0], &b), sizes(&a[1], &b), sizes(&a[2], &b)];
    let own = [
        gap(&to, &a[0], h[0], &k, s[0], m),
        gap(&to, &a[1], h[1], &k, s[1], m),
        gap(&to, &a[2], h[2], &k, s[2], m),
    ];
    let foreign = [
        gap(&to, &b[0], k[0], &h, [s[0][0], s[1][0], s[2][0]], m),
        gap(&to, &b[1], k[1], &h, [s[0][1], s[1][1], s[2][1]], m),
        gap(&to, &b[2], k[2], &h, [s[0][2], s[1][2], s[2][2]], m),
    ];
    ((own, foreign), to)
}

/// Lower bounds on the distances from the single box to each lane's box, in the working unit. A lane that holds no
/// box may get any value.
#[inline(always)]
pub(super) fn lower_bounds<L: Lanes>(wide: &WideNode, placed: &Placed, to_work: f32) -> [f32; 8] {
    let ((own, foreign), to) = gaps::<L>(wide, placed);
    // |d|²(1 + 16u) ≥ Σ gap² for either frame: the distance of the box to the other's hull with parallel sides.
    let boxes = dot(&own, &own).max(dot(&foreign, &foreign)).sqrt();
    let margin = L::splat(placed.margin);
    let balls = dot(&to, &to).sqrt() - L::load(&wide.radius) - L::splat(placed.radius) - margin;
    // Along one more direction, as it is rounded: its length is at most one.
    let n = splat::<L>(&placed.along);
    let axes = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
    let half = load::<L>(&wide.half_extent);
    let center = load::<L>(&wide.center);
    let between = (L::splat(placed.at_along) - dot(&center, &n)).abs();
    let reach = L::splat(placed.reach_along) + dot(&half, &sizes(&n, &axes));
    let along = (between - reach - margin).max(L::splat(0.0));
    (boxes.max(balls).max(along) * L::splat(NORM_FACTOR) * L::splat(to_work)).store()
}

/// Bit i is set when lane i is not proven apart from the single box.
#[inline(always)]
pub(super) fn overlaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> u32 {
    let ((own, foreign), _) = gaps::<L>(wide, placed);
    let most = own[0].max(own[1]).max(own[2].max(foreign[0])).max(foreign[1].max(foreign[2]));
    let used = (1u32 << wide.used.min(8)) - 1;
    !L::splat(0.0).less_bits(most) & used
}

#[cfg(test)]
impl Placed {
    /// What the margin is `GAP_ERROR` times of, when the floor is zero.
    pub(super) fn margin_scale(&self) -> f64 {
        f64::from(self.margin) / GAP_ERROR
    }

    pub(super) fn axis(&self, index: usize) -> [f32; 3] {
        self.axes[index]
    }
}

/// The six gaps as computed before anything is taken off; zero where negative.
#[cfg(test)]
pub(super) fn margin_free_gaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> Vec<[f32; 8]> {
    let ((own, foreign), _) = gaps::<L>(wide, &Placed { margin: 0.0, ..*placed });
    own.into_iter().chain(foreign).map(L::store).collect()
}
