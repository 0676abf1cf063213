//! Which of the eight boxes of a node stay apart from a box of the other body over a whole span of time?
//!
//! Along a direction n that is fixed in an inertial frame the gap of two points is f(s) = n·(b(s) − a(s)), and f″ ≤ M with
//! M the bound on the relative acceleration. So f is nowhere in a span of length S more than M S²/8 below the line through
//! its values at the ends: boxes that are further apart than that along n at both ends are so all the time, however
//! they turn in between. No speed takes part, so a span may be longer than a sub-window of the search.
//!
//! docs/theory/engine.md, "Time, divided", has the margins.

use super::node_scale::NodeScale;
use crate::gap::discriminant::{Spread, discriminant};
use crate::pair::motion::frame::{PlacedFrame, RelativeMotion};
use d2m_lanes::three::{both, dot, load, minus, splat};
use d2m_lanes::{Bytes, Doubles, Elementwise, F64x4, Lanes, Matrix, Quad, Two};
use d2m_mesh::margin::{NARROW_UP, UNIT_F32, UP, error_of, round_up};
use d2m_mesh::node::{LEAF, NodeBox, WideNode, opposite, reach};
use glam::DVec3;

/// Factor of the error of gaps: 20u as in the search's own tests, and 12u since the direction at the two ends of a span
/// and by the axes of either body differs by that from one and the same; see docs/theory/engine.md. The rest is room.
const SPAN_ERROR: f32 = 64.0 * UNIT_F32 as f32;

/// The relative pose at one time, as the node tests of one wide body need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPose {
    /// Axes of the single body in those of the wide one.
    rotation: Matrix,
    /// Center of the single body's tree from that of the wide one's, in the unit of the wide body.
    apart: Quad,
    /// Axes of the wide body in the world.
    axes: Matrix,
}

impl PlacedPose {
    /// For nodes of A and of B that are expanded, at an offset of the motion.
    #[inline(always)]
    pub(crate) fn both<D: Doubles>(
        motion: &RelativeMotion,
        offset: f64,
        scales: &[NodeScale; 2],
    ) -> [Self; 2] {
        let PlacedFrame { frame, axes_b } = motion.far_frame::<D>(offset);
        let back = frame.rotation.transposed::<D>();
        let apart_in_a = (D::splat(0.0) - back.times_quad::<D>(&frame.apart)).store();
        let axes_a = axes_b.times_matrix::<D>(&frame.rotation);
        [
            Self::new::<D>(back, &apart_in_a, axes_a, &scales[0]),
            Self::new::<D>(frame.rotation, &frame.apart, axes_b, &scales[1]),
        ]
    }

    #[inline(always)]
    fn new<D: Doubles>(rotation: Matrix, apart: &Quad, axes: Matrix, scale: &NodeScale) -> Self {
        let apart = (D::load(apart) * D::splat(scale.inverse_unit)).store();
        Self { rotation, apart, axes }
    }

    /// A point of the single body from another one, both in the unit of the wide body.
    #[inline(always)]
    fn place<D: Doubles>(&self, point: DVec3, origin: DVec3) -> [f32; 4] {
        (D::load(&self.apart) + self.rotation.times(point) - D::load(&Quad::from_vec(origin))).narrow()
    }
}

/// The columns rounded to `f32`.
#[inline(always)]
fn narrow<D: Doubles>(matrix: &Matrix) -> [[f32; 4]; 3] {
    let c = &matrix.0;
    [D::load(&c[0]).narrow(), D::load(&c[1]).narrow(), D::load(&c[2]).narrow()]
}

/// What a direction that is fixed in the world is by the axes of a body at the start (first half) and at the end of a span: columns.
struct Carried<T>([[T; 3]; 3]);

impl<T: Elementwise> Carried<T> {
    /// The direction of these coordinates in the middle of the span.
    #[inline(always)]
    fn direction(&self, middle: &[T; 3]) -> [T; 3] {
        let [x, y, z] = &self.0;
        [
            x[0] * middle[0] + y[0] * middle[1] + z[0] * middle[2],
            x[1] * middle[0] + y[1] * middle[1] + z[1] * middle[2],
            x[2] * middle[0] + y[2] * middle[1] + z[2] * middle[2],
        ]
    }
}

/// The poses of one wide body at the ends and in the middle of a span.
pub(crate) struct SpanFrame<'p, L: Lanes> {
    ends: [&'p PlacedPose; 2],
    middle: &'p PlacedPose,
    /// Axes of the single body in those of the wide one in the middle.
    narrow: [[f32; 4]; 3],
    /// Directions, known by the wide body's axes in the middle, by the axes of the wide and of the single body.
    wide: Carried<L::Two>,
    single: Carried<L::Two>,
    /// The gap that boxes need at the ends.
    need: f32,
}

impl<'p, L: Lanes> SpanFrame<'p, L> {
    /// `bend`: M S²/8 with the bound M on the acceleration and the length S of the span, and the error of far frames, in the unit of
    /// the scene.
    #[inline(always)]
    pub(crate) fn new([start, middle, end]: [&'p PlacedPose; 3], scale: &NodeScale, bend: f64) -> Self {
        let to_start = start.axes.transposed::<L::Doubles>().times_matrix::<L::Doubles>(&middle.axes);
        let to_end = end.axes.transposed::<L::Doubles>().times_matrix::<L::Doubles>(&middle.axes);
        let single_start = start.rotation.transposed::<L::Doubles>().times_matrix::<L::Doubles>(&to_start);
        let single_end = end.rotation.transposed::<L::Doubles>().times_matrix::<L::Doubles>(&to_end);
        // Directions are longer than one by a few roundings at most.
        let need = (f64::from(scale.floor) + bend * scale.inverse_unit * UP) * NARROW_UP;
        Self {
            ends: [start, end],
            middle,
            narrow: narrow::<L::Doubles>(&middle.rotation),
            wide: carried::<L>(&to_start, &to_end),
            single: carried::<L>(&single_start, &single_end),
            need: round_up(need),
        }
    }

    /// An axis of a box of the single body by the wide body's axes in the middle.
    #[inline(always)]
    fn turned(&self, axis: &[f32; 3]) -> [f32; 3] {
        let [x, y, z, _] = L::combine(&self.narrow, axis[0], axis[1], axis[2]);
        [x, y, z]
    }
}

#[inline(always)]
fn carried<L: Lanes>(start: &Matrix, end: &Matrix) -> Carried<L::Two> {
    let (c, d) = (narrow::<L::Doubles>(start), narrow::<L::Doubles>(end));
    Carried([ends::<L>(&c[0], &d[0]), ends::<L>(&c[1], &d[1]), ends::<L>(&c[2], &d[2])])
}

/// A box, or the boxes of a node, by the axes of their body: they are the same at all times.
struct Boxes<T> {
    half: [T; 3],
    slabs: [T; 3],
    axes: [[T; 3]; 3],
}

impl<T: Bytes> Boxes<T> {
    /// How far they reach along a direction, or along the opposite one where `sense` is negative.
    #[inline(always)]
    pub(super) fn reach(&self, n: &[T; 3], sense: T) -> T {
        let cosines = [dot(&self.axes[0], n), dot(&self.axes[1], n), dot(&self.axes[2], n)];
        reach::<_, 3>(&self.half, &self.slabs, &cosines, sense)
    }
}

/// The boxes of a node and a single one.
struct Boxed<'f, L: Lanes> {
    /// From the lanes' centers to the single one's.
    to: [L::Two; 3],
    wide: Boxes<L::Two>,
    single: Boxes<L::Two>,
    frame: &'f SpanFrame<'f, L>,
    margin: L,
}

impl<'f, L: Lanes> Boxed<'f, L> {
    #[inline(always)]
    fn new(
        frame: &'f SpanFrame<'f, L>,
        scale: &NodeScale,
        NodeBox { node: single, lane }: NodeBox<'_>,
        wide: &WideNode,
    ) -> Self {
        let ratio = scale.ratio;
        let (from, origin) = (center_of(single, lane, ratio), origin_of(wide));
        let [start, end] = &frame.ends;
        let first = start.place::<L::Doubles>(from, origin);
        let last = end.place::<L::Doubles>(from, origin);
        let ratio = ratio as f32;
        let radius = single.radius[lane] * ratio;
        let size = norm(&first).max(norm(&last)) + wide.extent + radius;
        let (centers, at) = (both::<L>(&load::<L>(&wide.center)), ends::<L>(&first, &last));
        let (half, slabs, axes) = (&single.half_extent, &single.slabs, single.axes_of(lane));
        let of_lanes = wide.wide_axes::<L>();
        Self {
            to: minus(&at, &centers),
            wide: Boxes {
                half: both::<L>(&load::<L>(&wide.half_extent)),
                slabs: both::<L>(&load::<L>(&wide.slabs)),
                axes: [both::<L>(&of_lanes[0]), both::<L>(&of_lanes[1]), both::<L>(&of_lanes[2])],
            },
            single: Boxes {
                half: [
                    L::Two::splat(half[0][lane] * ratio),
                    L::Two::splat(half[1][lane] * ratio),
                    L::Two::splat(half[2][lane] * ratio),
                ],
                slabs: [
                    L::Two::splat(opposite(slabs[0][lane])),
                    L::Two::splat(opposite(slabs[1][lane])),
                    L::Two::splat(opposite(slabs[2][lane])),
                ],
                axes: [splat(&axes[0]), splat(&axes[1]), splat(&axes[2])],
            },
            frame,
            margin: L::splat(error_of(SPAN_ERROR, size) + frame.need),
        }
    }

    /// The gaps at both ends along a direction, by the wide body's axes in the middle of the span.
    #[inline(always)]
    fn gaps(&self, middle: &[L::Two; 3]) -> L::Two {
        let n = self.frame.wide.direction(middle);
        let along = dot(&self.to, &n);
        // One sense at both ends: else boxes that change sides would count as apart.
        let sense = L::Two::both(along.first() + along.second());
        let reach =
            self.wide.reach(&n, sense) + self.single.reach(&self.frame.single.direction(middle), sense);
        L::Two::flip_sign(along, sense) - reach
    }

    /// Bit i is set when along a direction, by the wide body's axes in the middle of the span, the gap of lane i exceeds the
    /// margin at both ends.
    #[inline(always)]
    fn apart_along(&self, middle: &[L::Two; 3]) -> u32 {
        let gaps = self.gaps(middle);
        self.margin.less_bits(gaps.first()) & self.margin.less_bits(gaps.second())
    }
}

/// The center of a box by the axes of its body, in the unit of the other one.
#[inline(always)]
fn center_of(single: &WideNode, lane: usize, ratio: f64) -> DVec3 {
    let (o, c) = (&single.origin, &single.center);
    DVec3::new(
        (f64::from(o[0]) + f64::from(c[0][lane])) * ratio,
        (f64::from(o[1]) + f64::from(c[1][lane])) * ratio,
        (f64::from(o[2]) + f64::from(c[2][lane])) * ratio,
    )
}

#[inline(always)]
fn origin_of(wide: &WideNode) -> DVec3 {
    let o = &wide.origin;
    DVec3::new(f64::from(o[0]), f64::from(o[1]), f64::from(o[2]))
}

/// The same vector in all lanes of the start, another one in those of the end.
#[inline(always)]
fn ends<L: Lanes>(start: &[f32; 4], end: &[f32; 4]) -> [L::Two; 3] {
    [
        L::Two::of(L::splat(start[0]), L::splat(end[0])),
        L::Two::of(L::splat(start[1]), L::splat(end[1])),
        L::Two::of(L::splat(start[2]), L::splat(end[2])),
    ]
}

fn norm(v: &[f32; 4]) -> f32 {
    v[0].abs() + v[1].abs() + v[2].abs()
}

/// Bit i is set when box i of a node stays apart from a single box over the span.
///
/// One direction is tried, fixed in the world as it is in the middle of the span: that along which the centers are furthest apart
/// against the boxes' spreads. If the single box is a triangle, the last axes of both boxes, too. Otherwise they cost as much
/// as they save (docs/experiments.md, "Time, divided").
#[inline(always)]
pub(crate) fn apart_over_span<L: Lanes>(
    frame: &SpanFrame<'_, L>,
    scale: &NodeScale,
    single: NodeBox<'_>,
    wide: &WideNode,
) -> u32 {
    let NodeBox { node, lane } = single;
    let boxed = Boxed::<L>::new(frame, scale, single, wide);
    let middle = frame.middle.place::<L::Doubles>(center_of(node, lane, scale.ratio), origin_of(wide));
    let ratio = scale.ratio as f32;
    let (single, half, axes) = (node, &node.half_extent, node.axes_of(lane));
    let own_half = [half[0][lane] * ratio, half[1][lane] * ratio, half[2][lane] * ratio];
    let (lanes, wide_half) = (load::<L>(&wide.center), load::<L>(&wide.half_extent));
    let (long, middle_long) = (load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]));

    let at = splat::<L, 4>(&middle);
    let line = minus(&at, &lanes);
    let own = [frame.turned(&axes[0]), frame.turned(&axes[1])];
    let spread = Spread::new([&own[0], &own[1]], &own_half).splat();
    let best = discriminant(&Spread::new([&long, &middle_long], &wide_half), &spread, &line);
    // A triangle may be large against the boxes, then spreads say little of it.
    let used = if single.child[lane] & LEAF == 0 { 0 } else { (1 << wide.used) - 1 };
    let mut apart = 0;
    // A loop, so that the test is compiled once; a direction that is not tried is not turned.
    for which in 0..3 {
        let direction = match which {
            0 => both::<L>(&best),
            1 => splat(&frame.turned(&axes[2])),
            _ => boxed.wide.axes[2],
        };
        apart |= boxed.apart_along(&direction);
        if apart & used == used {
            break;
        }
    }
    apart
}

/// A direction that is tried of all pairs over a span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpanDirection {
    /// By the wide body's axes in the middle of the span; longer than one by a few roundings at most.
    pub(crate) middle: [f32; 3],
    /// M S²/2 in the unit of the wide body, rounded up by some roundings.
    pub(crate) bend: f32,
}

impl SpanDirection {
    /// `direction`: world axes. `bend`: M S²/2 in the unit of the scene.
    pub(crate) fn new(direction: DVec3, middle: &PlacedPose, scale: &NodeScale, bend: f64) -> Self {
        let own = middle.axes.transposed::<F64x4>().transform(direction).normalize_or_zero();
        let bend = round_up(bend * scale.inverse_unit * (UP * NARROW_UP * NARROW_UP));
        Self { middle: own.as_vec3().to_array(), bend }
    }
}

/// Bit i is set when box i of a node stays apart from a single box over the span, along one direction.
///
/// With g and h the gaps above the level at both ends the gap after the part x of the span is at least (1 − x) g + x h − M S²x(1 − x)/2,
/// which is nowhere negative where √g + √h ≥ √(M S²/2): what begins close to the level and parts is apart all the time.
#[inline(always)]
pub(crate) fn apart_along_over_span<L: Lanes>(
    frame: &SpanFrame<'_, L>,
    direction: &SpanDirection,
    scale: &NodeScale,
    single: NodeBox<'_>,
    wide: &WideNode,
) -> u32 {
    let boxed = Boxed::<L>::new(frame, scale, single, wide);
    let gaps = boxed.gaps(&splat(&direction.middle));
    let (g, h) = (gaps.first() - boxed.margin, gaps.second() - boxed.margin);
    // Two roots, so that no product of gaps overflows.
    let (zero, root) = (L::splat(0.0), g.sqrt() * h.sqrt());
    // Not where a gap is not a number either.
    zero.less_bits(g) & zero.less_bits(h) & L::splat(direction.bend).less_bits(g + h + (root + root))
}
