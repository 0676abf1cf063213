//! Two bodies are further apart than a distance at every time of a span: the recursion.
use crate::directions::{Direction, between, between_hulls, faces_and_sides};
use crate::instant::{Instant, Part, Separation};
use crate::mesh::{Below, Node};
use crate::rates::{Rates, lowest};
use crate::{Body, Reason, TimeSpan, Verdict};
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// Steps at least that are looked for a counterexample in, after something could not be proven.
const LATER: u64 = 4096;
/// So few triangles are taken together, as what is between their corners.
const FEW: u32 = 8;
/// So many directions that separated others are tried.
const KNOWN: usize = 4;

/// Proves the meshes further apart than `distance` at every time of the span, one smooth piece of both motions after the other, in as
/// many steps as are `left`. What contradicts it or is left open is the error.
pub(crate) fn clear(
    bodies: &[Body<'_>; 2],
    distance: f64,
    span: TimeSpan,
    left: &mut u64,
) -> Result<(), Verdict> {
    let mut now = span.from;
    loop {
        let mut end = span.to;
        for until in bodies.map(|body| body.motion.smooth_until(now)).into_iter().flatten() {
            // A piece that does not advance, or an end that is no number.
            if now < span.to && (until <= now || until.is_nan()) {
                return Err(Verdict::Unproven { clear_until: now, reason: Reason::Pieces, pair: None });
            }
            end = end.min(until.max(now));
        }
        Prover::new(*bodies, distance, TimeSpan { from: now, to: end }).run(left)?;
        if end >= span.to {
            return Ok(());
        }
        now = end;
    }
}

/// A span with its ends; all pairs share it.
struct Span {
    time: TimeSpan,
    ends: [Option<Instant>; 2],
    rates: Option<Rates>,
    /// This span and the next are its halves.
    halves: Option<usize>,
}

impl Span {
    fn new(bodies: &[Body<'_>; 2], time: TimeSpan, ends: &[Option<Instant>; 2]) -> Self {
        Self { time, ends: *ends, rates: Rates::new(bodies, time), halves: None }
    }

    /// Is the direction proven to separate the parts all the time? In intervals, from both ends and K L²/2.
    fn is_proven(&self, separation: &Separation, parts: [Part<'_>; 2]) -> bool {
        let [Some(start), Some(end)] = &self.ends else { return false };
        let length = Interval::point(self.time.to) - Interval::point(self.time.from);
        let bend = match &self.rates {
            _ if self.time.from == self.time.to => 0.0,
            Some(rates) => (length.sqr() * 0.5 * rates.curvature(separation, parts)).hi(),
            None => return false,
        };
        lowest([start, end].map(|now| now.above(separation, parts)), bend) > 0.0
    }
}

/// A part of the base and a part of the other body, over a span.
#[derive(Clone, Copy)]
struct Task {
    nodes: [u32; 2],
    span: usize,
}

struct Prover<'q> {
    /// The base first: the body from which the other one accelerates less.
    bodies: [Body<'q>; 2],
    swapped: bool,
    distance: f64,
    spans: Vec<Span>,
    tasks: Vec<Task>,
    /// Directions that separated others, the last one first.
    known: Vec<Direction>,
    /// Since when something could not be proven, and what.
    open: Option<(f64, Verdict)>,
}

impl<'q> Prover<'q> {
    fn new([a, b]: [Body<'q>; 2], distance: f64, time: TimeSpan) -> Self {
        let rates = [[a, b], [b, a]].map(|bodies| Rates::new(&bodies, time));
        let bends = [(&rates[0], b), (&rates[1], a)].map(|(rates, other)| {
            let Node { low, high, .. } = other.mesh.nodes[0];
            rates.as_ref().map_or(f64::INFINITY, |rates| rates.guess_acceleration((high - low).length()))
        });
        let swapped = bends[1] < bends[0];
        let bodies = if swapped { [b, a] } else { [a, b] };
        let start = Instant::new(&bodies, time.from);
        let end = if time.to == time.from { start } else { Instant::new(&bodies, time.to) };
        let whole = Span { time, ends: [start, end], rates: rates[usize::from(swapped)], halves: None };
        let tasks = vec![Task { nodes: [0, 0], span: 0 }];
        Self { bodies, swapped, distance, spans: vec![whole], tasks, known: Vec::new(), open: None }
    }

    fn run(mut self, left: &mut u64) -> Result<(), Verdict> {
        let (all, mut later) = (*left, None);
        while let Some(task) = self.tasks.pop() {
            let from = self.spans[task.span].time.from;
            let open = self.open.map(|(since, _)| since);
            if *left == 0 {
                let tasks = self.tasks.iter().map(|task| self.spans[task.span].time.from);
                let clear_until = tasks.fold(open.map_or(from, |since| from.min(since)), f64::min);
                return Err(Verdict::Unproven { clear_until, reason: Reason::Steps, pair: None });
            }
            *left -= 1;
            if let Some(since) = open {
                // What cannot be proven may be refuted by what comes later, for as much work again.
                let least = *later.get_or_insert(left.saturating_sub(LATER + (all - *left)));
                if from >= since && *left < least {
                    continue;
                }
            }
            self.step(task)?;
        }
        self.open.map_or(Ok(()), |(_, verdict)| Err(verdict))
    }

    /// Proves the task, or replaces it by others; an error is a counterexample.
    fn step(&mut self, task: Task) -> Result<(), Verdict> {
        let nodes = [0, 1].map(|k| self.bodies[k].mesh.nodes[task.nodes[k] as usize]);
        let half = nodes.map(|node| (node.high - node.low) * 0.5);
        let span = &self.spans[task.span];
        if self.boxes_apart(span, &nodes, &half) {
            return Ok(());
        }
        if nodes.iter().all(|node| node.leaves[1] <= FEW) {
            if let Some(direction) = self.hulls_apart(span, &nodes) {
                self.known.retain(|known| *known != direction);
                self.known.insert(0, direction);
                self.known.truncate(KNOWN);
                return Ok(());
            }
            if let [Below::Triangle(s), Below::Triangle(t)] = nodes.map(|node| node.below) {
                return self.triangles(task, [s, t]);
            }
        }
        let [size, size_other] = half.map(|half| 2.0 * half.length());
        let length = span.time.to - span.time.from;
        let moves = span.rates.as_ref().map_or(f64::INFINITY, |rates| rates.guess_speed(size_other) * length);
        // Where points move further than the boxes are large, shorter spans say more than smaller boxes.
        if moves <= size.max(size_other) || !self.halve(task) {
            let [of_base, of_other] = task.nodes;
            let halves = match nodes.map(|node| node.below) {
                [Below::Nodes(first), other] if size >= size_other || matches!(other, Below::Triangle(_)) => {
                    [[first, of_other], [first + 1, of_other]]
                }
                [_, Below::Nodes(first)] => [[of_base, first], [of_base, first + 1]],
                _ => unreachable!("two triangles are judged before"),
            };
            self.tasks.extend(halves.map(|nodes| Task { nodes, ..task }));
        }
        Ok(())
    }

    /// Tries the best of the fifteen directions of two boxes, as it seems in plain numbers.
    fn boxes_apart(&self, span: &Span, nodes: &[Node; 2], half: &[DVec3; 2]) -> bool {
        let [Some(start), Some(end)] = &span.ends else { return false };
        let middle = [0, 1].map(|k| (nodes[k].low + nodes[k].high) * 0.5 - self.bodies[k].mesh.center);
        let [between, between_end] = [start, end].map(|now| now.guess(middle[1]) - middle[0]);
        let (mut widest, mut best) = (0.0, None);
        for (axis, axis_end) in start.axes.iter().zip(&end.axes) {
            let gaps = axis.gaps(between, half);
            let way = usize::from(gaps[1] > gaps[0]);
            let gap = gaps[way] - self.distance * axis.length;
            if gap > widest {
                let gap = gap.min(axis_end.gaps(between_end, half)[way] - self.distance * axis_end.length);
                if gap > widest {
                    let direction = if way == 0 { axis.direction } else { axis.direction.reversed() };
                    let about = 0.5 * (axis.length + axis_end.length);
                    (widest, best) = (gap, Some(Separation { direction, distance: self.distance, about }));
                }
            }
        }
        let bounds = |k: usize| [self.bodies[k].mesh.bounds(&nodes[k])];
        best.is_some_and(|best| span.is_proven(&best, [&bounds(0), &bounds(1)]))
    }

    /// A direction that is proven to separate what is between the corners of few triangles: those that separated others are tried first.
    fn hulls_apart(&self, span: &Span, nodes: &[Node; 2]) -> Option<Direction> {
        let [Some(start), Some(end)] = &span.ends else { return None };
        let points = |k: usize| self.bodies[k].mesh.points(&nodes[k]).collect::<Vec<_>>();
        let parts = [points(0), points(1)];
        let [a, b] = parts.each_ref().map(|part| part.iter().map(|p| p.mid()).collect::<Vec<_>>());
        let proves = |direction: &Direction| self.separates(span, *direction, &parts, [&a, &b]);
        if let Some(direction) = self.known.iter().find(|&direction| proves(direction)) {
            return Some(*direction);
        }
        let ([p, q, r], [s, t, u]) = (&a[..], &b[..]) else {
            let seen: Vec<DVec3> = b.iter().map(|q| end.guess(*q)).collect();
            return Some(between_hulls(&a, &seen)).filter(proves);
        };
        let corners = [[*p, *q, *r], [*s, *t, *u]];
        let near = [start, end].into_iter();
        let mut near = near.flat_map(|now| between(&corners, &now.turn_guess, now.offset_guess));
        faces_and_sides(&corners).into_iter().find(proves).or_else(|| near.find(proves))
    }

    /// Does a direction, or its opposite, separate the parts? In plain numbers first.
    fn separates(
        &self,
        span: &Span,
        direction: Direction,
        parts: &[Vec<IntervalVec3>; 2],
        [a, b]: [&[DVec3]; 2],
    ) -> bool {
        let [Some(start), Some(end)] = &span.ends else { return false };
        let points_to_b = direction.guess(&start.turn_guess).dot(start.guess(b[0]) - a[0]) > 0.0;
        let direction = if points_to_b { direction } else { direction.reversed() };
        let mut about = 0.0;
        let is_apart = [start, end].into_iter().all(|now| {
            let n = direction.guess(&now.turn_guess);
            let back = now.turn_guess.transpose() * n;
            let low = b.iter().map(|q| back.dot(*q)).fold(f64::INFINITY, f64::min);
            let high = a.iter().map(|p| n.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
            about += 0.5 * n.length();
            n.dot(now.offset_guess) + low - high > self.distance * n.length()
        });
        let separation = Separation { direction, distance: self.distance, about };
        is_apart && span.is_proven(&separation, [&parts[0], &parts[1]])
    }

    /// Two triangles that are not apart over a span are, if they are at its ends, tried over shorter ones. Proven close at one, they are
    /// the counterexample; neither close nor clear, no shorter span decides it.
    fn triangles(&mut self, task: Task, [s, t]: [u32; 2]) -> Result<(), Verdict> {
        let span = &self.spans[task.span];
        let corners = [(0, s), (1, t)].map(|(k, triangle)| self.bodies[k].mesh.corners(triangle));
        let triangles = if self.swapped { [t, s] } else { [s, t] };
        let mut reason = Reason::TimeResolution;
        for now in &span.ends {
            let distance = now.as_ref().map_or(Interval::ENTIRE, |now| now.distance(&corners));
            match now {
                Some(now) if distance.hi() <= self.distance => {
                    return Err(Verdict::Refuted { time: now.time, triangles, distance });
                }
                None => reason = Reason::Enclosure,
                Some(_) if distance.lo() <= self.distance => reason = Reason::TooClose,
                Some(_) => {}
            }
        }
        let from = span.time.from;
        let is_decided = reason == Reason::TimeResolution && self.halve(task);
        if !is_decided && self.open.is_none_or(|(since, _)| from < since) {
            self.open = Some((from, Verdict::Unproven { clear_until: from, reason, pair: Some(triangles) }));
        }
        Ok(())
    }

    /// Replaces the task by those of the two halves of its span; false where no time is between its ends.
    fn halve(&mut self, task: Task) -> bool {
        let Span { time: TimeSpan { from, to }, ends, halves, .. } = self.spans[task.span];
        let middle = from + 0.5 * (to - from);
        if !(from < middle && middle < to) {
            return false;
        }
        let first = halves.unwrap_or(self.spans.len());
        if halves.is_none() {
            self.spans[task.span].halves = Some(first);
            let now = Instant::new(&self.bodies, middle);
            for (from, to, ends) in [(from, middle, [ends[0], now]), (middle, to, [now, ends[1]])] {
                self.spans.push(Span::new(&self.bodies, TimeSpan { from, to }, &ends));
            }
        }
        // The earlier half is proven first.
        self.tasks.extend([first + 1, first].map(|span| Task { span, ..task }));
        true
    }
}
