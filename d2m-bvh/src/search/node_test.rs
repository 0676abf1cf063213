//! One box of one body against the eight boxes of a wide node of the other: until when are they apart?

use super::frame::Frame;
use super::lanes::Lanes;
use super::quad::{Matrix, Quad};
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
    /// κ = half the acceleration times the time that is left.
    least: f32,
    /// κ plus the error of speeds that does not depend on the boxes.
    speed_floor: f32,
}

impl NodeFrame {
    /// `left`: no later time matters, counted from the frame. `wide_is_b`: nodes of B are opened against boxes of A; else the other way round.
    #[inline(always)]
    pub(crate) fn new(frame: &Frame, scale: &NodeScale, wide_is_b: bool, left: f32) -> Self {
        let least = 0.5 * scale.acceleration * left * (1.0 + 1e-6) + f32::MIN_POSITIVE;
        let (length, speed, time) =
            (Quad::splat(scale.inverse_unit), Quad::splat(scale.speed_scale), Quad::splat(scale.time_unit));
        let (rotation, apart, velocity, omega_single, omega_wide) = if wide_is_b {
            (frame.rotation, frame.apart, frame.velocity, frame.omega_a, frame.omega_b)
        } else {
            let to_a = frame.rotation.transposed();
            let zero = Quad::splat(0.0);
            (
                to_a,
                zero - to_a.times_quad(frame.apart),
                zero - to_a.times_quad(frame.velocity),
                to_a.times_quad(frame.omega_b),
                to_a.times_quad(frame.omega_a),
            )
        };
        let (omega_single, omega_wide) = (omega_single * time, omega_wide * time);
        let [x, y, z, _] = omega_wide.0;
        let r = &rotation.0;
        Self {
            rotation,
            narrow: [r[0].narrow(), r[1].narrow(), r[2].narrow()],
            apart: apart * length,
            velocity: velocity * speed,
            swing: Matrix([omega_single.cross(r[0]), omega_single.cross(r[1]), omega_single.cross(r[2])]),
            turn: Matrix([Quad([0.0, z, -y, 0.0]), Quad([-z, 0.0, x, 0.0]), Quad([y, -x, 0.0, 0.0])]),
            omega_wide: omega_wide.narrow(),
            least,
            speed_floor: scale.speed_floor + least,
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
    /// Error of speeds, and κ.
    speed_margin: f32,
    /// κ: half the acceleration times the time that is left.
    least: f32,
}

impl Placed {
    #[cfg(test)]
    pub(crate) fn gap_margin(&self) -> f32 {
        self.gap_margin
    }

    /// Moves box `lane` of node `single` into the frame of the wide body.
    #[inline(always)]
    pub(crate) fn new(
        frame: &NodeFrame,
        scale: &NodeScale,
        (single, lane): (&WideNode, usize),
        wide: &WideNode,
    ) -> Self {
        let at = |k: usize| (f64::from(single.origin[k]) + f64::from(single.center[k][lane])) * scale.ratio;
        let from = DVec3::new(at(0), at(1), at(2));
        let origin =
            DVec3::new(f64::from(wide.origin[0]), f64::from(wide.origin[1]), f64::from(wide.origin[2]));
        let center = (frame.apart + frame.rotation.times(from) - Quad::from_vec(origin)).narrow();
        let velocity = (frame.velocity + frame.swing.times(from) - frame.turn.times(origin)).narrow();
        let ratio = scale.ratio as f32;
        let radius = single.radius[lane] * ratio;
        let half = &single.half_extent;
        let norm = |v: &[f32; 4]| v[0].abs() + v[1].abs() + v[2].abs();
        let swing = scale.spin[1] * radius;
        Self {
            axes: [
                turned(frame, &single.axes[0], lane),
                turned(frame, &single.axes[1], lane),
                turned(frame, &single.axes[2], lane),
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
fn turned(frame: &NodeFrame, axis: &[[f32; 8]; 3], lane: usize) -> [f32; 4] {
    let (r, x, y, z) = (&frame.narrow, axis[0][lane], axis[1][lane], axis[2][lane]);
    let at = |k: usize| r[0][k] * x + r[1][k] * y + r[2][k] * z;
    [at(0), at(1), at(2), at(3)]
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
fn splat<L: Lanes>(values: &[f32; 4]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

#[inline(always)]
fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// What all axes of one test share.
struct Shared<L> {
    gap_margin: L,
    /// Bound on what speeds differ from those of the centres, plus κ.
    spread: L,
    least: L,
}

impl<L: Lanes> Shared<L> {
    /// Time until an axis may stop separating: the centres are `along` apart on it, the boxes reach `reach`, the
    /// centres' relative speed is `closing`.
    #[inline(always)]
    fn time(&self, along: L, reach: L, closing: L) -> L {
        let gap = along.abs() - (reach + self.gap_margin);
        gap / (self.spread - L::flip_sign(closing, along)).max(self.least)
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
    let radius = L::load(&wide.radius);
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
    let single_half = [L::splat(placed.half[0]), L::splat(placed.half[1]), L::splat(placed.half[2])];
    // cosine[i][j] = axis i of the lane · axis j of the single box.
    let cosine = [row(&axes[0], &single), row(&axes[1], &single), row(&axes[2], &single)];
    // |ω|·radius of both boxes, whatever the axis.
    let spread = L::splat(scale.spin[0]) * radius + L::splat(placed.swing + placed.speed_margin);
    let shared = Shared { gap_margin: L::splat(placed.gap_margin), spread, least: L::splat(placed.least) };
    let reach = |i: usize| {
        half[i]
            + (single_half[0] * cosine[i][0].abs()
                + (single_half[1] * cosine[i][1].abs() + single_half[2] * cosine[i][2].abs()))
    };
    let reach_single = |j: usize| {
        single_half[j]
            + (half[0] * cosine[0][j].abs() + (half[1] * cosine[1][j].abs() + half[2] * cosine[2][j].abs()))
    };
    let t0 = shared.time(dot(&to, &axes[0]), reach(0), dot(&v, &axes[0]));
    let t1 = shared.time(dot(&to, &axes[1]), reach(1), dot(&v, &axes[1]));
    let t2 = shared.time(dot(&to, &axes[2]), reach(2), dot(&v, &axes[2]));
    let t3 = shared.time(dot(&to, &single[0]), reach_single(0), dot(&v, &single[0]));
    let t4 = shared.time(dot(&to, &single[1]), reach_single(1), dot(&v, &single[1]));
    let t5 = shared.time(dot(&to, &single[2]), reach_single(2), dot(&v, &single[2]));
    t0.max(t1).max(t2.max(t3)).max(t4.max(t5)) * L::splat(ENTRY_FACTOR)
}
