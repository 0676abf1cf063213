//! Which pairs may meet along a path, and when: boxes of all bodies over spans of time, halved where that helps.

use crate::RobotError;
use crate::body_box::BodyBox;
use crate::part::{MovingPair, Owner};
use crate::scene::RobotScene;
use crate::swept_box::{Sweep, SweptBox};
use d2m_bvh::Window;
use d2m_motion::{Arm, ArmSpan, CoveredMotion};
use d2m_world::Candidate;

/// A span is halved so many times at most.
const DEPTH: usize = 6;
/// A span is halved for a pair whose motion takes less than so many times the room between its boxes: each half takes half
/// of it. What is further from a proof is left to the search of the pair, whose boxes are smaller.
const WORTH: f64 = 8.0;

/// No number of a box: not made so far.
const UNMADE: u32 = u32::MAX;

/// One path on its way through the broad phase.
pub(crate) struct BroadPhase<'a> {
    scene: &'a RobotScene,
    span: ArmSpan<'a>,
    /// Places in `boxes` by the link that they are seen from (the world first) and the part.
    places: Vec<u32>,
    boxes: Vec<Option<SweptBox>>,
    /// Of each pair: from when to when it may meet.
    meetings: Vec<Option<[f64; 2]>>,
    /// Lists of pairs, one for each depth.
    open: Vec<Vec<u32>>,
}

impl<'a> BroadPhase<'a> {
    /// For paths of this arm, which is the scene's with values of its joints.
    pub(crate) fn new(scene: &'a RobotScene, arm: &'a Arm) -> Self {
        Self {
            scene,
            span: ArmSpan::new(arm),
            places: vec![UNMADE; (arm.len() + 1) * scene.parts.len()],
            boxes: Vec::new(),
            meetings: vec![None; scene.moving_pairs.len()],
            open: vec![Vec::new(); DEPTH + 2],
        }
    }

    /// The pairs that may come within their separation in the window, each with when. All others are proven not to.
    ///
    /// # Errors
    /// An obstacle whose motion does not cover the window.
    pub(crate) fn candidates(mut self, window: Window) -> Result<Vec<Candidate>, RobotError> {
        for (part, of) in self.scene.parts.iter().enumerate() {
            if matches!(of.owner, Owner::Obstacle { is_at_rest: false }) {
                let motion = self.scene.world.body(of.id).motion();
                let _covered =
                    CoveredMotion::try_new(motion, window.start(), window.end()).map_err(|outside| {
                        RobotError::Body {
                            name: self.scene.parts[part].name.clone(),
                            reason: outside.to_string(),
                        }
                    })?;
            }
        }
        self.open[0] = (0..self.scene.moving_pairs.len() as u32).collect();
        self.examine([window.start(), window.end()], 0);
        let pairs = self.scene.moving_pairs.iter().zip(&self.meetings);
        let candidate = |(pair, meeting): (&MovingPair, &Option<[f64; 2]>)| {
            let [from, until] = (*meeting)?;
            let [a, b] = pair.parts.map(|part| self.scene.parts[part].id);
            Some(Candidate { a, b, from, until })
        };
        Ok(pairs.filter_map(candidate).collect())
    }

    /// The open pairs of a depth over a span: those that are not proven apart are examined in both halves, or left.
    fn examine(&mut self, [from, to]: [f64; 2], depth: usize) {
        self.span.move_to(from, to);
        self.places.fill(UNMADE);
        self.boxes.clear();
        let open = core::mem::take(&mut self.open[depth]);
        let mut rest = core::mem::take(&mut self.open[depth + 1]);
        rest.clear();
        let mut is_worth = false;
        for &pair in &open {
            match self.sweep(pair as usize, [from, to]) {
                Sweep::Apart => continue,
                Sweep::Near { taken } => is_worth |= taken < WORTH,
                Sweep::Meeting => {}
            }
            rest.push(pair);
        }
        self.open[depth] = open;
        self.open[depth + 1] = rest;
        let middle = self.span.middle();
        let is_halved = is_worth && depth < DEPTH && from < middle && middle < to;
        if is_halved && !self.open[depth + 1].is_empty() {
            self.examine([from, middle], depth + 1);
            self.examine([middle, to], depth + 1);
            return;
        }
        for &pair in &self.open[depth + 1] {
            let meeting = self.meetings[pair as usize].get_or_insert([from, to]);
            meeting[1] = to;
        }
    }

    fn sweep(&mut self, pair: usize, span: [f64; 2]) -> Sweep {
        let MovingPair { parts, separation, seen_from } = self.scene.moving_pairs[pair];
        let [a, b] = parts.map(|part| self.swept(part, seen_from, span));
        match (&self.boxes[a], &self.boxes[b]) {
            (Some(a), Some(b)) => a.against(b, self.span.half(), separation),
            _ => Sweep::Meeting,
        }
    }

    /// The place of the box of a part over the span, seen from a link or the world; none is there where nothing is known of its
    /// motion.
    fn swept(&mut self, part: usize, seen_from: Option<usize>, [from, to]: [f64; 2]) -> usize {
        let at = seen_from.map_or(0, |link| link + 1) * self.scene.parts.len() + part;
        if self.places[at] != UNMADE {
            return self.places[at] as usize;
        }
        let of = &self.scene.parts[part];
        let (body, half): (&BodyBox, f64) = (&of.body_box, self.span.half());
        let swept = match of.owner {
            Owner::Link { link, .. } | Owner::Attached { link, .. } => {
                let link = self.scene.robot.place_in_arm(link);
                Some(SweptBox::carried(body, self.span.link(link, seen_from), half))
            }
            Owner::Obstacle { is_at_rest: true } => {
                Some(SweptBox::carried(body, &d2m_motion::SpanMotion::REST, half))
            }
            Owner::Obstacle { is_at_rest: false } => {
                let motion = self.scene.world.body(of.id).motion();
                let covered = CoveredMotion::try_new(motion, from, to).ok();
                let moved = covered.and_then(|covered| covered.span_motion(self.span.middle()));
                moved.map(|moved| SweptBox::carried(body, &moved, half))
            }
        };
        let place = self.boxes.len();
        self.places[at] = place as u32;
        self.boxes.push(swept);
        place
    }
}
