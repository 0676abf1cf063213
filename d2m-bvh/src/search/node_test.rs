//! One box of one body against the eight boxes of a wide node of the other: until when are they apart?

use super::frame::Frame;
use super::lanes::Lanes;
use super::quad::{Doubles, Matrix, Quad};
use super::two::{Elementwise, Two};
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
    /// What is there before the first one.
    pub(crate) const NONE: Self = Self {
        rotation: Matrix([Quad([0.0; 4]); 3]),
        narrow: [[0.0; 4]; 3],
        apart: Quad([0.0; 4]),
        velocity: Quad([0.0; 4]),
        swing: Matrix([Quad([0.0; 4]); 3]),
        turn: Matrix([Quad([0.0; 4]); 3]),
        omega_wide: [0.0; 4],
        least: 0.0,
        speed_floor: 0.0,
    };

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
            let to_a = frame.rotation.transposed::<D>();
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
fn dot<T: Elementwise>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The same three values in each lane.
#[inline(always)]
fn splat<T: Elementwise<Scalar = f32>>(values: &[f32; 4]) -> [T; 3] {
    [T::splat(values[0]), T::splat(values[1]), T::splat(values[2])]
}

#[inline(always)]
fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// One vector in the first eight lanes, another in the second.
#[inline(always)]
fn beside<L: Lanes>(first: &[L; 3], second: &[L; 3]) -> [L::Two; 3] {
    [L::Two::of(first[0], second[0]), L::Two::of(first[1], second[1]), L::Two::of(first[2], second[2])]
}

#[inline(always)]
fn both<L: Lanes>(half: &[L; 3]) -> [L::Two; 3] {
    [L::Two::both(half[0]), L::Two::both(half[1]), L::Two::both(half[2])]
}

/// Along one axis: the gap, and the speed at which it closes at most, never less than a positive least one.
#[derive(Clone, Copy)]
struct Course<T> {
    gap: T,
    closing: T,
}

impl<T: Elementwise> Course<T> {
    /// The centres are `along` apart on the axis and part at `parting` (in the sense of the axis), the boxes and the
    /// margin reach `reach`; speeds differ by at most `spread` from those of the centres.
    #[inline(always)]
    fn new(along: T, reach: T, parting: T, (spread, least): (T, T)) -> Self {
        Self { gap: along.abs() - reach, closing: (spread - T::flip_sign(parting, along)).max(least) }
    }

    /// The one whose gap lasts longer without acceleration.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        let (left, right) = (self.gap * other.closing, other.gap * self.closing);
        Self {
            gap: T::if_greater(left, right, self.gap, other.gap),
            closing: T::if_greater(left, right, self.closing, other.closing),
        }
    }
}

/// Lower bounds on the times, counted from the frame, until which each lane's box stays apart from the single one;
/// not positive, or not a number, where nothing is known. In units of the window, not yet clipped.
///
/// The six axes are looked at in pairs: the first two of the lane's box, the first two of the single one, and the last
/// of each.
#[inline(always)]
pub(crate) fn entry_times<L: Lanes>(wide: &WideNode, placed: &Placed, scale: &NodeScale) -> L {
    // Twice, for the two axes of a pair: from the lane's centre to the single one's, and the velocity there.
    let center = both::<L>(&load(&wide.center));
    let at = splat::<L::Two>(&placed.center);
    let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
    let w = splat::<L::Two>(&placed.omega_wide);
    let base = splat::<L::Two>(&placed.velocity);
    let v = [
        base[0] - (w[1] * center[2] - w[2] * center[1]),
        base[1] - (w[2] * center[0] - w[0] * center[2]),
        base[2] - (w[0] * center[1] - w[1] * center[0]),
    ];
    let half = load::<L>(&wide.half_extent);
    let a = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
    let b = [splat::<L>(&placed.axes[0]), splat::<L>(&placed.axes[1]), splat::<L>(&placed.axes[2])];
    let k = [L::splat(placed.half[0]), L::splat(placed.half[1]), L::splat(placed.half[2])];
    let margin = L::Two::splat(placed.gap_margin);
    // |ω|·radius of both boxes, whatever the axis, and the error of speeds.
    let spread =
        L::splat(scale.spin[0]) * L::load(&wide.radius) + L::splat(placed.swing + placed.speed_margin);
    let speeds = (L::Two::both(spread), L::Two::splat(placed.least));
    let [own, foreign, last] = [beside(&a[0], &a[1]), beside(&b[0], &b[1]), beside(&a[2], &b[2])];
    // |cosine| of axis i of the lane and axis j of the single box: for i = 0, 1 and each j; for i = 2 and j = 0, 1.
    let s = [
        dot(&own, &splat(&placed.axes[0])).abs(),
        dot(&own, &splat(&placed.axes[1])).abs(),
        dot(&own, &splat(&placed.axes[2])).abs(),
    ];
    let s2 = dot(&both(&a[2]), &foreign).abs();
    let s22 = dot(&a[2], &b[2]).abs();
    let reach_own = dot(
        &[L::Two::splat(placed.half[0]), L::Two::splat(placed.half[1]), L::Two::splat(placed.half[2])],
        &s,
    );
    let t = [L::Two::of(s[0].first(), s[1].first()), L::Two::of(s[0].second(), s[1].second()), s2];
    let reach_foreign = dot(&both(&half), &t);
    let reach_last =
        L::Two::of(dot(&k, &[s2.first(), s2.second(), s22]), dot(&half, &[s[2].first(), s[2].second(), s22]));
    let best =
        Course::new(dot(&to, &own), L::Two::of(half[0], half[1]) + margin + reach_own, dot(&v, &own), speeds)
            .or(Course::new(
                dot(&to, &foreign),
                L::Two::of(k[0], k[1]) + margin + reach_foreign,
                dot(&v, &foreign),
                speeds,
            ))
            .or(Course::new(
                dot(&to, &last),
                L::Two::of(half[2], k[2]) + margin + reach_last,
                dot(&v, &last),
                speeds,
            ));
    let best = Course { gap: best.gap.first(), closing: best.closing.first() }
        .or(Course { gap: best.gap.second(), closing: best.closing.second() });
    // Root of gap − closing·s − acceleration·s²/2: no cancellation.
    let twice = best.gap + best.gap;
    let root = (best.closing * best.closing + L::splat(scale.acceleration) * twice).sqrt();
    twice / (best.closing + root) * L::splat(ENTRY_FACTOR)
}
