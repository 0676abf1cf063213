//! One box of one body in the frame of a wide node of the other.

use crate::margin::round_up;
use crate::tree::box_pair::{GAP_ERROR, PlacedBox, opposite};
use crate::tree::node::{OrientedBox, WideNode};
use crate::tree::slabs::reach_both_ways;
use glam::DVec3;

/// The single body seen from the wide body, whose node is expanded. Lengths are in units of the wide body's tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Columns of the rotation into the wide body's frame.
    pub(super) rotation: [DVec3; 3],
    /// Center of the single body's tree from that of the wide one.
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
    pub(super) boxed: PlacedBox,
    pub(super) radius: f32,
    /// One more direction, wide body's axes, of length at most one.
    pub(super) along: [f32; 3],
    /// A point of what it covers, from the node's origin, projected onto that direction.
    pub(super) at_along: f32,
    /// How far it reaches from there along that direction, and along the opposite one.
    pub(super) reach_along: [f32; 2],
    /// The triangle itself, from the node's origin, for a box around one.
    pub(super) corners: Option<[[f32; 3]; 3]>,
    /// The longest edge of that triangle, where directions across it are wanted.
    pub(super) edge: Option<[f32; 3]>,
}

impl Placed {
    #[inline(always)]
    pub(super) fn new(side: &Side, boxed: &OrientedBox, origin: [f32; 3], wide: &WideNode) -> Self {
        let center = arm(side, origin, boxed.center) + side.offset - vector(wide.origin);
        let radius = f64::from(boxed.radius) * side.ratio;
        let (ratio, half) = (side.ratio as f32, &boxed.half_extent);
        let norm = center.x.abs() + center.y.abs() + center.z.abs();
        let slabs = |pair: usize| opposite(lane_of(boxed.slabs[pair]));
        Self {
            boxed: PlacedBox {
                center: padded(center),
                axes: [turned(side, boxed.axes[0]), turned(side, boxed.axes[1]), turned(side, boxed.axes[2])],
                half: [half[0] * ratio, half[1] * ratio, half[2] * ratio],
                slabs: [slabs(0), slabs(1), slabs(2)],
                margin: round_up(
                    f64::from(GAP_ERROR) * (norm + f64::from(wide.extent) + radius) + side.floor,
                ),
            },
            radius: round_up(radius),
            along: [0.0; 3],
            at_along: 0.0,
            reach_along: [0.0; 2],
            corners: None,
            edge: None,
        }
    }

    /// With a direction of length at most one, wide body's axes.
    #[inline(always)]
    pub(super) fn with_box_along(mut self, n: [f32; 3], boxed: &OrientedBox) -> Self {
        let direction = vector(n);
        let vector_of = |[x, y, z, _]: [f32; 4]| vector([x, y, z]);
        let [x, y, z] = &self.boxed.axes;
        let cosines = [x, y, z].map(|axis| direction.dot(vector_of(*axis)));
        let [forth, back] = reach_both_ways(&self.boxed.half, &boxed.slabs, cosines);
        let least = |reach: f64| {
            let reach = round_up(reach);
            if reach < self.radius { reach } else { self.radius }
        };
        self.reach_along = [least(forth), least(back)];
        self.at_along = direction.dot(vector_of(self.boxed.center)) as f32;
        self.along = n;
        self
    }

    /// With a direction, for a box around one triangle: what the triangle itself covers, which may be much less than its
    /// box does. Corners from the node's origin, wide body's axes and unit.
    #[inline(always)]
    pub(super) fn with_triangle_along(mut self, n: [f32; 3], corners: &[DVec3; 3]) -> Self {
        let direction = vector(n);
        let [p, q, r] = [direction.dot(corners[0]), direction.dot(corners[1]), direction.dot(corners[2])];
        let (low, high) = (p.min(q).min(r), p.max(q).max(r));
        self.at_along = (0.5 * (low + high)) as f32;
        // From the middle as it is rounded.
        let middle = f64::from(self.at_along);
        self.reach_along = [round_up((high - middle).max(middle - low)); 2];
        self.along = n;
        self.corners = Some([narrow(corners[0]), narrow(corners[1]), narrow(corners[2])]);
        self
    }

    /// With the longest edge of the triangle, corners as above.
    pub(super) fn with_longest_edge(mut self, [p, q, r]: &[DVec3; 3]) -> Self {
        let longer = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
        self.edge = Some(narrow(longer(longer(*q - *p, *r - *q), *p - *r)));
        self
    }
}

/// Four bytes as the bits of a lane.
#[inline(always)]
fn lane_of(cuts: [u8; 4]) -> f32 {
    f32::from_bits(u32::from_le_bytes(cuts))
}

#[inline(always)]
fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))
}

#[inline(always)]
fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// The same with a zero behind.
#[inline(always)]
fn padded(v: DVec3) -> [f32; 4] {
    let [x, y, z] = narrow(v);
    [x, y, z, 0.0]
}

/// The center of a box from the center of its tree, wide body's axes and unit.
#[inline(always)]
fn arm(side: &Side, origin: [f32; 3], center: [f32; 3]) -> DVec3 {
    let p = (vector(origin) + vector(center)) * side.ratio;
    side.rotation[0] * p.x + side.rotation[1] * p.y + side.rotation[2] * p.z
}

/// A stored axis in the wide body's frame.
#[inline(always)]
fn turned(side: &Side, axis: [f32; 3]) -> [f32; 4] {
    let a = vector(axis);
    padded(side.rotation[0] * a.x + side.rotation[1] * a.y + side.rotation[2] * a.z)
}

#[cfg(test)]
impl Placed {
    /// What the margin is `GAP_ERROR` times of, when the floor is zero.
    pub(super) fn margin_scale(&self) -> f64 {
        f64::from(self.boxed.margin) / f64::from(GAP_ERROR)
    }

    pub(super) fn axis(&self, index: usize) -> [f32; 3] {
        let [x, y, z, _] = self.boxed.axes[index];
        [x, y, z]
    }
}
