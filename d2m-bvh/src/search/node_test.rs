//! One box of one body against the eight boxes of a wide node of the other: until when are they apart?

use super::frame::Frame;
use super::lanes::Lanes;
use super::quad::{Doubles, Matrix, Quad};
use crate::tree::margin::UNIT_F32;
use crate::tree::node::WideNode;
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
    /// |ω|·(unit of time) of the wide and of the single body, rounded up.
    pub(crate) spin: [f32; 2],
    /// What is added to every margin: the level that counts as contact and the errors of the frame.
    pub(crate) floor: f32,
    /// The same for speeds.
    pub(crate) speed_floor: f32,
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f32,
}

/// Factor of the gap's error bound; see docs/theory/engine.md.
pub(crate) const GAP_ERROR: f32 = 48.0 * UNIT_F32 as f32;
/// Factor of the speed's error bound.
pub(crate) const SPEED_ERROR: f32 = 48.0 * UNIT_F32 as f32;
/// Part of the acceleration times the time left that closing speeds are raised to: keeps axes along which the boxes
/// part from being taken for the best ones.
const HINT: f32 = 0.0625;
/// What covers the roundings of the entry time and of unit axes.
pub(crate) const ENTRY_FACTOR: f32 = 1.0 - 32.0 * UNIT_F32 as f32;

/// The single body in the frame of the wide body at one time, in the units of [`NodeScale`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeFrame {
    rotation: Matrix,
    /// The same rounded to `f32`.
    narrow: [[f32; 4]; 3],
    apart: Quad,
    velocity: Quad,
    /// ω_single × each column of the rotation.
    swing: Matrix,
    /// ω_wide × each axis.
    turn: Matrix,
    omega_wide: [f32; 4],
    /// Least closing speed that is reckoned with.
    least: f32,
    /// The error of speeds that does not depend on the boxes.
    speed_floor: f32,
}

impl NodeFrame {
    /// `left`: no later time matters, counted from the frame (a hint). `wide_is_b`: nodes of B are opened against boxes of A; else the other way round.
    #[inline(always)]
    pub(crate) fn new<D: Doubles>(frame: &Frame, scale: &NodeScale, wide_is_b: bool, left: f32) -> Self {
        let (length, speed, time) =
            (D::splat(scale.inverse_unit), D::splat(scale.speed_scale), D::splat(scale.time_unit));
        let (rotation, apart, velocity, omega_single, omega_wide): (Matrix, D, D, D, D) = if wide_is_b {
            (
                frame.rotation,
                D::load(&frame.apart),
                D::load(&frame.velocity),
                D::load(&frame.omega_a),
                D::load(&frame.omega_b),
            )
        } else {
            let to_a = frame.rotation.transposed();
            let zero = D::splat(0.0);
            (
                to_a,
                zero - to_a.times_quad::<D>(&frame.apart),
                zero - to_a.times_quad::<D>(&frame.velocity),
                to_a.times_quad(&frame.omega_b),
                to_a.times_quad(&frame.omega_a),
            )
        };
        let (omega_single, omega_wide) = (omega_single * time, omega_wide * time);
        let r = &rotation.0;
        Self {
            rotation,
            narrow: [D::load(&r[0]).narrow(), D::load(&r[1]).narrow(), D::load(&r[2]).narrow()],
            apart: (apart * length).store(),
            velocity: (velocity * speed).store(),
            swing: Matrix::cross(&omega_single.store()).times_matrix::<D>(&rotation),
            turn: Matrix::cross(&omega_wide.store()),
            omega_wide: omega_wide.narrow(),
            least: scale.acceleration * left * HINT + scale.speed_floor,
            speed_floor: scale.speed_floor,
        }
    }
}

/// A single box in the frame of the wide body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    center: [f32; 4],
    axes: [[f32; 4]; 3],
    half: [f32; 3],
    /// Velocity of the centre against the origin of the wide node as a point of the wide body.
    velocity: [f32; 4],
    omega_wide: [f32; 4],
    /// Bound on |ω × e| over the single box.
    swing: f32,
    gap_margin: f32,
    /// Error of speeds.
    speed_margin: f32,
    /// Least closing speed that is reckoned with.
    least: f32,
}

impl Placed {
    #[cfg(test)]
    pub(crate) fn gap_margin(&self) -> f32 {
        self.gap_margin
    }

    /// Moves box `lane` of node `single` into the frame of the wide body.
    #[inline(always)]
    pub(crate) fn new<L: Lanes>(
        frame: &NodeFrame,
        scale: &NodeScale,
        (single, lane): (&WideNode, usize),
        wide: &WideNode,
    ) -> Self {
        let at = |k: usize| (f64::from(single.origin[k]) + f64::from(single.center[k][lane])) * scale.ratio;
        let from = DVec3::new(at(0), at(1), at(2));
        let origin =
            DVec3::new(f64::from(wide.origin[0]), f64::from(wide.origin[1]), f64::from(wide.origin[2]));
        let apart = <L::Doubles as Doubles>::load(&frame.apart);
        let velocity = <L::Doubles as Doubles>::load(&frame.velocity);
        let here = <L::Doubles as Doubles>::load(&Quad::from_vec(origin));
        let center = (apart + frame.rotation.times(from) - here).narrow();
        let velocity = (velocity + frame.swing.times(from) - frame.turn.times(origin)).narrow();
        let ratio = scale.ratio as f32;
        let radius = single.radius[lane] * ratio;
        let half = &single.half_extent;
        let norm = |v: &[f32; 4]| v[0].abs() + v[1].abs() + v[2].abs();
        let swing = scale.spin[1] * radius;
        Self {
            axes: [
                turned::<L>(frame, &single.axes[0], lane),
                turned::<L>(frame, &single.axes[1], lane),
                turned::<L>(frame, &single.axes[2], lane),
            ],
            half: [half[0][lane] * ratio, half[1][lane] * ratio, half[2][lane] * ratio],
            omega_wide: frame.omega_wide,
            swing,
            gap_margin: GAP_ERROR * (norm(&center) + wide.extent + radius) + scale.floor,
            speed_margin: SPEED_ERROR * (norm(&velocity) + scale.spin[0] * wide.extent + swing)
                + frame.speed_floor,
            least: frame.least,
            center,
            velocity,
        }
    }
}

/// A stored axis in the wide body's frame.
#[inline(always)]
fn turned<L: Lanes>(frame: &NodeFrame, axis: &[[f32; 8]; 3], lane: usize) -> [f32; 4] {
    L::combine(&frame.narrow, axis[0][lane], axis[1][lane], axis[2][lane])
}

/// Scalar product of lanes.
#[inline(always)]
fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// |n·aᵢ| for the axes of the other box.
#[inline(always)]
fn sizes<L: Lanes>(n: &[L; 3], axes: &[[L; 3]; 3]) -> [L; 3] {
    [dot(n, &axes[0]).abs(), dot(n, &axes[1]).abs(), dot(n, &axes[2]).abs()]
}

/// The same three values in each lane.
#[inline(always)]
fn splat<L: Lanes>(values: &[f32; 4]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

#[inline(always)]
fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// Along one axis: the gap, and the speed at which it closes at most, never less than a positive least one.
#[derive(Clone, Copy)]
struct Course<L> {
    gap: L,
    closing: L,
}

impl<L: Lanes> Course<L> {
    /// The centres are `along` apart on the axis and part at `parting` (in the sense of the axis), the boxes and the
    /// margin reach `reach`; speeds differ by at most `spread` from those of the centres.
    #[inline(always)]
    fn new(along: L, reach: L, parting: L, (spread, least): (L, L)) -> Self {
        Self { gap: along.abs() - reach, closing: (spread - L::flip_sign(parting, along)).max(least) }
    }

    /// The one whose gap lasts longer without acceleration.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let (left, right) = (self.gap * other.closing, other.gap * self.closing);
        Self {
            gap: L::if_greater(left, right, self.gap, other.gap),
            closing: L::if_greater(left, right, self.closing, other.closing),
        }
    }
}

/// Lower bounds on the times, counted from the frame, until which each lane's box stays apart from the single one;
/// not positive, or not a number, where nothing is known. In units of the window, not yet clipped.
#[inline(always)]
pub(crate) fn entry_times<L: Lanes>(wide: &WideNode, placed: &Placed, scale: &NodeScale) -> L {
    let center = load::<L>(&wide.center);
    let at = splat::<L>(&placed.center);
    let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
    let half = load::<L>(&wide.half_extent);
    let a = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
    let w = splat::<L>(&placed.omega_wide);
    let base = splat::<L>(&placed.velocity);
    // Relative velocity at the centres.
    let v = [
        base[0] - (w[1] * center[2] - w[2] * center[1]),
        base[1] - (w[2] * center[0] - w[0] * center[2]),
        base[2] - (w[0] * center[1] - w[1] * center[0]),
    ];
    let b = [splat::<L>(&placed.axes[0]), splat::<L>(&placed.axes[1]), splat::<L>(&placed.axes[2])];
    let k = [L::splat(placed.half[0]), L::splat(placed.half[1]), L::splat(placed.half[2])];
    let margin = L::splat(placed.gap_margin);
    // |ω|·radius of both boxes, whatever the axis, and the error of speeds.
    let spread =
        L::splat(scale.spin[0]) * L::load(&wide.radius) + L::splat(placed.swing + placed.speed_margin);
    let speeds = (spread, L::splat(placed.least));
    // |cosine| of axis i of the lane and axis j of the single box.
    let s = [sizes(&a[0], &b), sizes(&a[1], &b), sizes(&a[2], &b)];
    let own = [
        Course::new(dot(&to, &a[0]), half[0] + margin + dot(&k, &s[0]), dot(&v, &a[0]), speeds),
        Course::new(dot(&to, &a[1]), half[1] + margin + dot(&k, &s[1]), dot(&v, &a[1]), speeds),
        Course::new(dot(&to, &a[2]), half[2] + margin + dot(&k, &s[2]), dot(&v, &a[2]), speeds),
    ];
    let t = [[s[0][0], s[1][0], s[2][0]], [s[0][1], s[1][1], s[2][1]], [s[0][2], s[1][2], s[2][2]]];
    let foreign = [
        Course::new(dot(&to, &b[0]), k[0] + margin + dot(&half, &t[0]), dot(&v, &b[0]), speeds),
        Course::new(dot(&to, &b[1]), k[1] + margin + dot(&half, &t[1]), dot(&v, &b[1]), speeds),
        Course::new(dot(&to, &b[2]), k[2] + margin + dot(&half, &t[2]), dot(&v, &b[2]), speeds),
    ];
    let best = own[0].or(own[1]).or(own[2].or(foreign[0])).or(foreign[1].or(foreign[2]));
    // Root of gap − closing·s − acceleration·s²/2: no cancellation.
    let twice = best.gap + best.gap;
    let root = (best.closing * best.closing + L::splat(scale.acceleration) * twice).sqrt();
    twice / (best.closing + root) * L::splat(ENTRY_FACTOR)
}
