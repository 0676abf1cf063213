//! A direction that is tried of every pair before its own: the line between two triangles that are about the closest.
//!
//! Where a level is a little below the least distance, and the search begins when the bodies are that close, nearly all pairs that are
//! near the level are apart along the same line as the closest ones: bodies are smooth, or convex, about their closest points. It is
//! a direction like any other, so nothing rests on the choice.

use super::expansion::DirectedSpan;
use super::state::State;
use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::boxes::whole_span::{PlacedPose, SpanDirection, SpanFrame};
use crate::pair::scene::MovingScene;
use crate::pair::witness::Witness;
use d2m_lanes::{F64x4, Lanes};

/// The line at the start of a sub-window, and the poses that it needs to be tried over all of it.
pub(super) struct Parting {
    /// At the start, in the middle and at the end, for nodes of A and of B that are expanded.
    poses: [[PlacedPose; 2]; 3],
    directions: [SpanDirection; 2],
}

impl Parting {
    #[inline(always)]
    pub(super) fn new<L: Lanes>(scene: &MovingScene<'_>, state: &State<'_>, witness: &Witness) -> Self {
        let (span, scales) = (state.limit_offset, &state.expander.scales);
        let at = |offset: f64| PlacedPose::both::<L::Doubles>(&state.motion, offset, scales);
        let poses = [at(0.0), at(0.5 * span), at(span)];
        let by_b = witness.line(&state.motion.frame::<F64x4>(0.0));
        let direction = state.motion.rotation_b(0.0).transform(by_b);
        let bend = 0.5 * scene.pair.acceleration * span * span;
        let directions = [0, 1].map(|k| SpanDirection::new(direction, &poses[1][k], &scales[k], bend));
        Self { poses, directions }
    }

    #[inline(always)]
    pub(super) fn over_span<L: Lanes>(
        &self,
        scene: &MovingScene<'_>,
        scales: &[NodeScale; 2],
    ) -> DirectedSpan<'_, L> {
        let [start, middle, end] = &self.poses;
        let error = scene.far_frame_error();
        let one = |k: usize| SpanFrame::<L>::new([&start[k], &middle[k], &end[k]], &scales[k], error);
        DirectedSpan { frames: [one(0), one(1)], directions: self.directions }
    }
}
