//! One box of one body against the eight boxes of a wide node of the other: until when are they apart?

use super::frame::Side;
use super::lanes::Lanes;
use crate::tree::margin::{UNIT_F32, round_up};
use crate::tree::node::{OrientedBox, WideNode};
use glam::DVec3;

/// Constants of one search for one choice of the wide body. Lengths are in units of that body's tree, times in
/// units of the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeScale {
    /// Unit of the single body over that of the wide one, a power of two.
    pub(crate) ratio: f64,
    /// One over the unit of the wide body.
    pub(crate) inverse_unit: f64,
    /// Unit of time over the unit of length of the wide body.
    pub(crate) speed_scale: f64,
    /// Unit of time.
    pub(crate) time_unit: f64,
    /// What is added to every margin: the level that counts as contact and the errors of the frame.
    pub(crate) floor: f64,
    /// The same for speeds.
    pub(crate) speed_floor: f64,
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f32,
    /// κ of the choice of the axis: half the acceleration times the window.
    pub(crate) choice: f32,
}

/// Factor of the gap's error bound; see docs/theory/engine.md.
pub(crate) const GAP_ERROR: f64 = 24.0 * UNIT_F32;
/// Factor of the speed's error bound.
pub(crate) const SPEED_ERROR: f64 = 24.0 * UNIT_F32;
/// What covers the roundings of the entry time and of unit axes.
pub(crate) const ENTRY_FACTOR: f32 = 1.0 - 32.0 * UNIT_F32 as f32;

/// A single box in the frame of the wide body, rounded once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    center: [f32; 3],
    axes: [[f32; 3]; 3],
    half: [f32; 3],
    /// Velocity of the centre against the origin of the wide node as a point of the wide body.
    velocity: [f32; 3],
    omega_wide: [f32; 3],
    /// ω of the single body along its box's axes.
    spin: [f32; 3],
    gap_margin: f32,
    speed_margin: f32,
}

impl Placed {
    /// Moves a box (its centre relative to `origin`, local coordinates of the single body) into the wide frame.
    #[inline(always)]
    pub(crate) fn new(
        side: &Side,
        scale: &NodeScale,
        single: (&OrientedBox, [f32; 3]),
        wide: &WideNode,
    ) -> Self {
        let (boxed, origin) = single;
        let r = &side.rotation;
        let arm = r[0] * ((f64::from(origin[0]) + f64::from(boxed.center[0])) * scale.ratio)
            + r[1] * ((f64::from(origin[1]) + f64::from(boxed.center[1])) * scale.ratio)
            + r[2] * ((f64::from(origin[2]) + f64::from(boxed.center[2])) * scale.ratio);
        let wide_origin =
            DVec3::new(f64::from(wide.origin[0]), f64::from(wide.origin[1]), f64::from(wide.origin[2]));
        let center = arm + side.offset * scale.inverse_unit - wide_origin;
        let axes64 = [turned(r, &boxed.axes[0]), turned(r, &boxed.axes[1]), turned(r, &boxed.axes[2])];
        let omega_wide = side.omega_wide * scale.time_unit;
        let omega_single = side.omega_single * scale.time_unit;
        let velocity =
            side.velocity * scale.speed_scale + (omega_single.cross(arm) - omega_wide.cross(wide_origin));
        let ratio = scale.ratio as f32;
        let radius = f64::from(boxed.radius) * scale.ratio;
        let extent = f64::from(wide.extent);
        let (spin_wide, spin_single) = (norm(omega_wide), norm(omega_single));
        Self {
            center: narrow(center),
            axes: [narrow(axes64[0]), narrow(axes64[1]), narrow(axes64[2])],
            half: [boxed.half_extent[0] * ratio, boxed.half_extent[1] * ratio, boxed.half_extent[2] * ratio],
            velocity: narrow(velocity),
            omega_wide: narrow(omega_wide),
            spin: narrow(DVec3::new(
                axes64[0].dot(omega_single),
                axes64[1].dot(omega_single),
                axes64[2].dot(omega_single),
            )),
            gap_margin: round_up(GAP_ERROR * (norm(center) + extent + radius) + scale.floor),
            speed_margin: round_up(
                SPEED_ERROR * (norm(velocity) + spin_wide * extent + spin_single * radius)
                    + scale.speed_floor,
            ),
        }
    }
}

#[inline(always)]
fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

#[inline(always)]
fn norm(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// A stored axis in the wide body's frame.
#[inline(always)]
fn turned(r: &[DVec3; 3], axis: &[f32; 3]) -> DVec3 {
    r[0] * f64::from(axis[0]) + r[1] * f64::from(axis[1]) + r[2] * f64::from(axis[2])
}

/// Scalar product of lanes.
#[inline(always)]
fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn row<L: Lanes>(axis: &[L; 3], others: &[[L; 3]; 3]) -> [L; 3] {
    [dot(axis, &others[0]), dot(axis, &others[1]), dot(axis, &others[2])]
}

/// The same three values in each lane.
#[inline(always)]
fn splat<L: Lanes>(values: &[f32; 3]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

#[inline(always)]
fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

#[inline(always)]
fn scaled<L: Lanes>(factor: L, values: [L; 2]) -> [L; 2] {
    [factor * values[0], factor * values[1]]
}

/// The best separating axis so far.
struct Best<L> {
    gap: L,
    rate: L,
    gap_margin: L,
    speed_margin: L,
    choice: L,
}

impl<L: Lanes> Best<L> {
    /// Takes an axis along which the centres are `along` apart, the boxes reach `reach`, the centres' relative
    /// speed is `closing` (along the axis) and the boxes' points differ from it by at most `spread`.
    #[inline(always)]
    fn consider(&mut self, along: L, reach: L, closing: L, spread: L) {
        let gap = along.abs() - reach - self.gap_margin;
        let rate = (spread + self.speed_margin - L::flip_sign(closing, along)).max(L::splat(0.0));
        // gap/(rate + κ) against the best one so far; both denominators are positive.
        let (left, right) = (self.gap * (rate + self.choice), gap * (self.rate + self.choice));
        self.gap = L::if_less(left, right, gap, self.gap);
        self.rate = L::if_less(left, right, rate, self.rate);
    }
}

/// Lower bounds on the times, counted from the frame, until which each lane's box stays apart from the single one;
/// 0 where nothing is known. In units of the window, not yet clipped.
#[inline(always)]
pub(crate) fn entry_times<L: Lanes>(wide: &WideNode, placed: &Placed, scale: &NodeScale) -> L {
    let center = load::<L>(&wide.center);
    let at = splat::<L>(&placed.center);
    let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
    let half = load::<L>(&wide.half_extent);
    let axes = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
    let w = splat::<L>(&placed.omega_wide);
    let base = splat::<L>(&placed.velocity);
    // Relative velocity at the centres.
    let v = [
        base[0] - (w[1] * center[2] - w[2] * center[1]),
        base[1] - (w[2] * center[0] - w[0] * center[2]),
        base[2] - (w[0] * center[1] - w[1] * center[0]),
    ];
    let single = [splat::<L>(&placed.axes[0]), splat::<L>(&placed.axes[1]), splat::<L>(&placed.axes[2])];
    let single_half = splat::<L>(&placed.half);
    // cosine[i][j] = axis i of the lane · axis j of the single box.
    let cosine = [row(&axes[0], &single), row(&axes[1], &single), row(&axes[2], &single)];
    let mut best = Best {
        gap: L::splat(0.0),
        rate: L::splat(1.0),
        gap_margin: L::splat(placed.gap_margin),
        speed_margin: L::splat(placed.speed_margin),
        choice: L::splat(scale.choice),
    };
    let turn = [dot(&axes[0], &w), dot(&axes[1], &w), dot(&axes[2], &w)];
    // half_i·(ω·axis_k) for k = i + 1, i + 2.
    let own = [
        scaled(half[0], [turn[1], turn[2]]),
        scaled(half[1], [turn[2], turn[0]]),
        scaled(half[2], [turn[0], turn[1]]),
    ];
    let (h, spin) = (&placed.half, &placed.spin);
    let foreign = [
        [L::splat(h[0] * spin[1]), L::splat(h[0] * spin[2])],
        [L::splat(h[1] * spin[2]), L::splat(h[1] * spin[0])],
        [L::splat(h[2] * spin[0]), L::splat(h[2] * spin[1])],
    ];
    for i in 0..3 {
        let (next, last) = ((i + 1) % 3, (i + 2) % 3);
        let along = dot(&to, &axes[i]);
        let mut reach = half[i];
        let closing = dot(&v, &axes[i]);
        // The lane's box: |n × ω · e| with e along the two other axes.
        let mut spread = own[next][0].abs() + own[last][1].abs();
        for j in 0..3 {
            let (a, b) = ((j + 1) % 3, (j + 2) % 3);
            reach = reach + single_half[j] * cosine[i][j].abs();
            // h_j n·(ω × b_j), with ω × b_j = (ω·b_b) b_a − (ω·b_a) b_b.
            spread = spread + (foreign[j][1] * cosine[i][a] - foreign[j][0] * cosine[i][b]).abs();
        }
        best.consider(along, reach, closing, spread);
    }
    for j in 0..3 {
        let (a, b) = ((j + 1) % 3, (j + 2) % 3);
        let along = dot(&to, &single[j]);
        let mut reach = single_half[j];
        let closing = dot(&v, &single[j]);
        let mut spread = foreign[a][0].abs() + foreign[b][1].abs();
        for i in 0..3 {
            let (c, d) = ((i + 1) % 3, (i + 2) % 3);
            reach = reach + half[i] * cosine[i][j].abs();
            spread = spread + (own[i][1] * cosine[c][j] - own[i][0] * cosine[d][j]).abs();
        }
        best.consider(along, reach, closing, spread);
    }
    let m = L::splat(scale.acceleration);
    let two = L::splat(2.0);
    let root = (best.rate * best.rate + two * m * best.gap).sqrt();
    two * best.gap / (best.rate + root + L::splat(f32::MIN_POSITIVE)) * L::splat(ENTRY_FACTOR)
}
