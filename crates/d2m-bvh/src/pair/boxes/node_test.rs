//! One box of one body, placed in the frame of a wide node of the other.

use super::node_scale::NodeScale;
use crate::pair::motion::frame::Frame;
use d2m_lanes::{Doubles, Lanes, Matrix, Quad};
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::{GAP_ERROR, PlacedBox, opposite};
use d2m_mesh::node::{NodeBox, WideNode};
use glam::DVec3;

/// Factor of the speed's error bound.
pub(crate) const SPEED_ERROR: f32 = 48.0 * UNIT_F32 as f32;
/// Part of the acceleration times the time left that closing speeds are raised to: keeps axes along which the boxes
/// part from being taken for the best ones.
const HINT: f32 = 0.0625;

/// The single body in the frame of the wide body at one time, in the units of [`NodeScale`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeFrame {
    rotation: Matrix,
    /// The same rounded to `f32`.
    narrow: [[f32; 4]; 3],
    apart: Quad,
    velocity: Quad,
    /// ω_single × each column of the rotation.
    spin_single: Matrix,
    /// ω_wide × each axis.
    spin_wide: Matrix,
    omega_wide: [f32; 4],
    /// Least closing speed that is reckoned with.
    least: f32,
    /// The error of speeds that does not depend on the boxes.
    speed_floor: f32,
    /// Pairs are also tested for passing each other: no time after this one matters then, counted from the frame.
    pub(crate) passing: Option<f32>,
}

/// The body whose nodes are expanded against boxes of the other one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Expanded {
    A,
    B,
}

impl NodeFrame {
    /// `left`: no later time matters, counted from the frame (a hint).
    #[inline(always)]
    pub(crate) fn new<D: Doubles>(frame: &Frame, scale: &NodeScale, expanded: Expanded, left: f32) -> Self {
        let (length, speed, time) =
            (D::splat(scale.inverse_unit), D::splat(scale.speed_scale), D::splat(scale.time_unit));
        let (rotation, apart, velocity, omega_single, omega_wide): (Matrix, D, D, D, D) = match expanded {
            Expanded::B => (
                frame.rotation,
                D::load(&frame.apart),
                D::load(&frame.velocity),
                D::load(&frame.omega_a),
                D::load(&frame.omega_b),
            ),
            Expanded::A => {
                let to_a = frame.rotation.transposed::<D>();
                let zero = D::splat(0.0);
                (
                    to_a,
                    zero - to_a.times_quad::<D>(&frame.apart),
                    zero - to_a.times_quad::<D>(&frame.velocity),
                    to_a.times_quad(&frame.omega_b),
                    to_a.times_quad(&frame.omega_a),
                )
            }
        };
        let (omega_single, omega_wide) = (omega_single * time, omega_wide * time);
        let r = &rotation.0;
        Self {
            rotation,
            narrow: [D::load(&r[0]).narrow(), D::load(&r[1]).narrow(), D::load(&r[2]).narrow()],
            apart: (apart * length).store(),
            velocity: (velocity * speed).store(),
            spin_single: Matrix::cross(&omega_single.store()).times_matrix::<D>(&rotation),
            spin_wide: Matrix::cross(&omega_wide.store()),
            omega_wide: omega_wide.narrow(),
            least: scale.acceleration * left * HINT + scale.speed_floor,
            speed_floor: scale.speed_floor,
            passing: None,
        }
    }
}

/// A single box in the frame of the wide body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) boxed: PlacedBox,
    /// Velocity of the center against the origin of the wide node as a point of the wide body.
    pub(super) velocity: [f32; 4],
    pub(super) omega_wide: [f32; 4],
    /// Bound on |ω × e| over the single box.
    pub(super) spin_speed: f32,
    /// Error of speeds.
    pub(super) speed_margin: f32,
    /// Least closing speed that is reckoned with.
    pub(super) least: f32,
    /// Of a sphere about its center that holds it.
    pub(super) radius: f32,
    /// What it is tested by besides the boxes' own directions.
    pub(super) passing: Option<f32>,
}

impl Placed {
    /// Moves box `lane` of node `single` into the frame of the wide body.
    #[inline(always)]
    pub(crate) fn new<L: Lanes>(
        frame: &NodeFrame,
        scale: &NodeScale,
        single: NodeBox<'_>,
        wide: &WideNode,
    ) -> Self {
        let NodeBox { node: single, lane } = single;
        let at = |k: usize| (f64::from(single.origin[k]) + f64::from(single.center[k][lane])) * scale.ratio;
        let from = DVec3::new(at(0), at(1), at(2));
        let origin =
            DVec3::new(f64::from(wide.origin[0]), f64::from(wide.origin[1]), f64::from(wide.origin[2]));
        let apart = <L::Doubles as Doubles>::load(&frame.apart);
        let velocity = <L::Doubles as Doubles>::load(&frame.velocity);
        let here = <L::Doubles as Doubles>::load(&Quad::from_vec(origin));
        let center = (apart + frame.rotation.times(from) - here).narrow();
        let velocity = (velocity + frame.spin_single.times(from) - frame.spin_wide.times(origin)).narrow();
        let ratio = scale.ratio as f32;
        let radius = single.radius[lane] * ratio;
        let (half, slabs) = (&single.half_extent, &single.slabs);
        let [first, second, third] = &single.axes_of(lane);
        let norm = |v: &[f32; 4]| v[0].abs() + v[1].abs() + v[2].abs();
        let spin_speed = scale.spin[1] * radius;
        let boxed = PlacedBox {
            axes: [turned::<L>(frame, first), turned::<L>(frame, second), turned::<L>(frame, third)],
            half: [half[0][lane] * ratio, half[1][lane] * ratio, half[2][lane] * ratio],
            slabs: [opposite(slabs[0][lane]), opposite(slabs[1][lane]), opposite(slabs[2][lane])],
            margin: GAP_ERROR * (norm(&center) + wide.extent + radius) + scale.floor,
            center,
        };
        Self {
            boxed,
            omega_wide: frame.omega_wide,
            spin_speed,
            speed_margin: SPEED_ERROR * (norm(&velocity) + scale.spin[0] * wide.extent + spin_speed)
                + frame.speed_floor,
            least: frame.least,
            radius,
            passing: frame.passing,
            velocity,
        }
    }
}

/// An axis of a box in the wide body's frame.
#[inline(always)]
fn turned<L: Lanes>(frame: &NodeFrame, axis: &[f32; 3]) -> [f32; 4] {
    L::combine(&frame.narrow, axis[0], axis[1], axis[2])
}
