//! Which of the eight boxes of a node stay apart from a box of the other body over a whole span of time?
//!
//! Along a direction n that is fixed in an inertial frame the gap of two points is f(s) = n·(b(s) − a(s)), and f″ ≤ M with
//! M the bound on the relative acceleration. So f is nowhere in a span of length S more than M S²/8 below the line through
//! its values at the ends: boxes that are further apart than that along n at both ends are so all the time, however
//! they turn in between. No speed takes part, so a span may be longer than a sub-window of the search.
//!
//! docs/theory/engine.md, "Time, divided", has the margins.

use super::discriminant::{Spread, discriminant, unit};
use super::node_scale::NodeScale;
use crate::search::motion::frame::{PlacedFrame, RelativeMotion};
use crate::tree::box_pair::{both, dot, load, opposite, splat};
use crate::tree::margin::{NARROW_UP, UNIT_F32, UP, error_of, round_up};
use crate::tree::node::{NodeBox, WideNode};
use crate::tree::slabs::reach;
use d2m_lanes::{Bytes, Doubles, Elementwise, Lanes, Matrix, Quad, Two};
use glam::DVec3;

/// Factor of the error of gaps: 20u as in the search's own tests, and 12u since the direction at the two ends of a span
/// differs by that from one and the same; see docs/theory/engine.md. The rest is room.
const SPAN_ERROR: f32 = 64.0 * UNIT_F32 as f32;

/// The relative pose at one time, as the node tests of one wide body need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPose {
    /// Axes of the single body in those of the wide one, and rounded to `f32`.
    rotation: Matrix,
    narrow: [[f32; 4]; 3],
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
        let PlacedFrame { frame, axes_b } = motion.placed_frame::<D>(offset);
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
        Self { rotation, narrow: narrow::<D>(&rotation), apart, axes }
    }

    /// A point of the single body from another one, both in the unit of the wide body.
    #[inline(always)]
    fn place<D: Doubles>(&self, point: DVec3, origin: DVec3) -> [f32; 4] {
        (D::load(&self.apart) + self.rotation.times(point) - D::load(&Quad::from_vec(origin))).narrow()
    }

    /// A stored axis of the single body.
    #[inline(always)]
    fn turned<L: Lanes>(&self, axis: &[[f32; 8]; 3], lane: usize) -> [f32; 4] {
        L::combine(&self.narrow, axis[0][lane], axis[1][lane], axis[2][lane])
    }
}

/// The columns rounded to `f32`.
#[inline(always)]
fn narrow<D: Doubles>(matrix: &Matrix) -> [[f32; 4]; 3] {
    let c = &matrix.0;
    [D::load(&c[0]).narrow(), D::load(&c[1]).narrow(), D::load(&c[2]).narrow()]
}

/// The poses of one wide body at the ends and in the middle of a span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpanFrame<'p> {
    ends: [&'p PlacedPose; 2],
    middle: &'p PlacedPose,
    /// What a direction that is fixed in the world and known by the wide body's axes in the middle is by those at the ends:
    /// columns.
    carried: [[[f32; 4]; 3]; 2],
    /// The gap that boxes need at the ends.
    need: f32,
}

impl<'p> SpanFrame<'p> {
    /// `bend`: M S²/8 with the bound M on the acceleration and the length S of the span, in the unit of the scene.
    #[inline(always)]
    pub(crate) fn new<D: Doubles>(
        [start, middle, end]: [&'p PlacedPose; 3],
        scale: &NodeScale,
        bend: f64,
    ) -> Self {
        let to_start = start.axes.transposed::<D>().times_matrix::<D>(&middle.axes);
        let to_end = end.axes.transposed::<D>().times_matrix::<D>(&middle.axes);
        let carried = [narrow::<D>(&to_start), narrow::<D>(&to_end)];
        // Directions are longer than one by a few roundings at most.
        let need = (f64::from(scale.floor) + bend * scale.inverse_unit * UP) * NARROW_UP;
        Self { ends: [start, end], middle, carried, need: round_up(need) }
    }
}

/// The box of a body, or its boxes, at the start (first half) and at the end of a span.
struct Boxes<T> {
    half: [T; 3],
    slabs: [T; 3],
    axes: [[T; 3]; 3],
}

impl<T: Bytes> Boxes<T> {
    /// How far they reach along a direction, or along the opposite one where `sense` is negative.
    #[inline(always)]
    fn reach(&self, n: &[T; 3], sense: T) -> T {
        let cosines = [dot(&self.axes[0], n), dot(&self.axes[1], n), dot(&self.axes[2], n)];
        reach::<_, 3>(&self.half, &self.slabs, &cosines, sense)
    }
}

/// The boxes of a node and a single one.
struct Boxed<L: Lanes> {
    /// From the lanes' centers to the single one's.
    to: [L::Two; 3],
    wide: Boxes<L::Two>,
    single: Boxes<L::Two>,
    /// [`SpanFrame::carried`].
    columns: [[L::Two; 3]; 3],
    margin: L,
}

impl<L: Lanes> Boxed<L> {
    /// Bit i is set when along a direction, by the wide body's axes in the middle of the span, the gap of lane i exceeds the
    /// margin at both ends.
    #[inline(always)]
    fn apart_along(&self, middle: &[L::Two; 3]) -> u32 {
        let [x, y, z] = &self.columns;
        let n = [
            x[0] * middle[0] + y[0] * middle[1] + z[0] * middle[2],
            x[1] * middle[0] + y[1] * middle[1] + z[1] * middle[2],
            x[2] * middle[0] + y[2] * middle[1] + z[2] * middle[2],
        ];
        let along = dot(&self.to, &n);
        // One sense at both ends: else boxes that change sides would count as apart.
        let sense = L::Two::both(along.first() + along.second());
        let reach = self.wide.reach(&n, sense) + self.single.reach(&n, sense);
        let gap = L::Two::flip_sign(along, sense) - reach;
        self.margin.less_bits(gap.first()) & self.margin.less_bits(gap.second())
    }
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
/// Three directions are tried, fixed in the world as they are in the middle of the span: the one along which the centers are
/// furthest apart against the boxes' spreads, and the last axes of both boxes.
#[inline(always)]
pub(crate) fn apart_over_span<L: Lanes>(
    frame: &SpanFrame<'_>,
    scale: &NodeScale,
    single: NodeBox<'_>,
    wide: &WideNode,
) -> u32 {
    let NodeBox { node: single, lane } = single;
    let (o, c, ratio) = (&single.origin, &single.center, scale.ratio);
    let from = DVec3::new(
        (f64::from(o[0]) + f64::from(c[0][lane])) * ratio,
        (f64::from(o[1]) + f64::from(c[1][lane])) * ratio,
        (f64::from(o[2]) + f64::from(c[2][lane])) * ratio,
    );
    let o = &wide.origin;
    let origin = DVec3::new(f64::from(o[0]), f64::from(o[1]), f64::from(o[2]));
    let [start, end] = &frame.ends;
    let first = start.place::<L::Doubles>(from, origin);
    let last = end.place::<L::Doubles>(from, origin);
    let middle = frame.middle.place::<L::Doubles>(from, origin);
    let ratio = ratio as f32;
    let radius = single.radius[lane] * ratio;
    let size = norm(&first).max(norm(&last)) + wide.extent + radius;
    let margin = error_of(SPAN_ERROR, size) + frame.need;

    let lanes = load::<L>(&wide.center);
    let (long, middle_long) = (load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]));
    let wide_last = both::<L>(&load::<L>(&wide.axes[2]));
    let wide_half = load::<L>(&wide.half_extent);
    let (centers, at) = (both::<L>(&lanes), ends::<L>(&first, &last));
    let (half, slabs, axes) = (&single.half_extent, &single.slabs, &single.axes);
    let [c, d] = &frame.carried;
    let boxed = Boxed::<L> {
        to: [at[0] - centers[0], at[1] - centers[1], at[2] - centers[2]],
        wide: Boxes {
            half: both::<L>(&wide_half),
            slabs: both::<L>(&load::<L>(&wide.slabs)),
            axes: [both::<L>(&long), both::<L>(&middle_long), wide_last],
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
            axes: [
                ends::<L>(&start.turned::<L>(&axes[0], lane), &end.turned::<L>(&axes[0], lane)),
                ends::<L>(&start.turned::<L>(&axes[1], lane), &end.turned::<L>(&axes[1], lane)),
                ends::<L>(&start.turned::<L>(&axes[2], lane), &end.turned::<L>(&axes[2], lane)),
            ],
        },
        columns: [ends::<L>(&c[0], &d[0]), ends::<L>(&c[1], &d[1]), ends::<L>(&c[2], &d[2])],
        margin: L::splat(margin),
    };

    let used = (1 << wide.used) - 1;
    let at = splat::<L, 4>(&middle);
    let line = unit(&[at[0] - lanes[0], at[1] - lanes[1], at[2] - lanes[2]]);
    let own = [0, 1, 2].map(|k| {
        let [x, y, z, _] = frame.middle.turned::<L>(&axes[k], lane);
        [x, y, z]
    });
    let own_half = [half[0][lane] * ratio, half[1][lane] * ratio, half[2][lane] * ratio];
    let single = Spread::new([&own[0], &own[1]], &own_half).splat();
    let best = discriminant(&Spread::new([&long, &middle_long], &wide_half), &single, &line);
    let mut apart = boxed.apart_along(&both::<L>(&best));
    if apart & used != used {
        apart |= boxed.apart_along(&wide_last);
    }
    if apart & used != used {
        apart |= boxed.apart_along(&own[2].map(L::Two::splat));
    }
    apart
}
