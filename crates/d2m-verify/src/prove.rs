//! Two bodies are further apart than a distance at every time of a span: the recursion.
use crate::attempt::Attempt;
use crate::instant::{Instant, Part};
use crate::mesh::Below;
use crate::span::{Bounds, Turning};
use crate::{Body, Reason, TimeSpan, Verdict, meeting};
use d2m_interval::Interval;

/// Steps that were taken and that may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    pub(crate) taken: u64,
    pub(crate) most: u64,
}

impl Steps {
    /// Takes one; false: there is none left.
    pub(crate) fn take(&mut self) -> bool {
        let is_left = self.taken < self.most;
        self.taken += u64::from(is_left);
        is_left
    }
}

/// Proves the meshes further apart than `distance` at every time of the span, one smooth piece of both motions after the other. What
/// contradicts it or is left open is the error.
pub(crate) fn clear(
    bodies: &[Body<'_>; 2],
    distance: f64,
    span: TimeSpan,
    steps: &mut Steps,
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
        Prover::new(*bodies, distance, TimeSpan { from: now, to: end }).run(steps)?;
        if end >= span.to {
            return Ok(());
        }
        now = end;
    }
}

/// Steps at least that are looked for a counterexample in, after something could not be proven.
const LATER: u64 = 4096;

/// A part of the base and a part of the other body, over a span.
#[derive(Clone, Copy)]
struct Task {
    nodes: [u32; 2],
    span: usize,
}

/// A span with its ends; all pairs share it.
pub(crate) struct Span {
    pub(crate) time: TimeSpan,
    pub(crate) ends: [Option<Instant>; 2],
    pub(crate) bounds: Bounds,
    /// This span and the next are its halves.
    halves: Option<usize>,
}

struct Prover<'q> {
    /// The base first: the body from which the other one accelerates less.
    bodies: [Body<'q>; 2],
    swapped: bool,
    distance: f64,
    spans: Vec<Span>,
    tasks: Vec<Task>,
    /// The earliest that could not be proven.
    open: Option<Open>,
}

#[derive(Clone, Copy)]
struct Open {
    from: f64,
    reason: Reason,
    pair: [u32; 2],
}

impl<'q> Prover<'q> {
    fn new([a, b]: [Body<'q>; 2], distance: f64, time: TimeSpan) -> Self {
        let seen = [[a, b], [b, a]].map(|bodies| {
            let bounds = Turning::new(&bodies, time).map_or(Bounds::NONE, |turning| turning.bounds());
            (bounds, bounds.curvatures(bodies[1].mesh.nodes[0].part.reach(), Interval::ZERO)[0].hi())
        });
        let swapped = seen[1].1 < seen[0].1;
        let bodies = if swapped { [b, a] } else { [a, b] };
        let ends = [time.from, time.to].map(|t| Instant::new(&bodies, t));
        let whole = Span { time, ends, bounds: seen[usize::from(swapped)].0, halves: None };
        let tasks = vec![Task { nodes: [0, 0], span: 0 }];
        Self { bodies, swapped, distance, spans: vec![whole], tasks, open: None }
    }

    fn run(mut self, steps: &mut Steps) -> Result<(), Verdict> {
        let mut most = u64::MAX;
        while let Some(task) = self.tasks.pop() {
            let from = self.spans[task.span].time.from;
            if !steps.take() {
                let left = self.tasks.iter().map(|task| self.spans[task.span].time.from);
                let clear_until = left.fold(self.open.map_or(from, |open| open.from.min(from)), f64::min);
                return Err(Verdict::Unproven { clear_until, reason: Reason::Steps, pair: None });
            }
            if let Some(open) = self.open {
                // What cannot be proven may be refuted by what comes later, for as much work again.
                most = most.min(2 * steps.taken + LATER);
                if from >= open.from && steps.taken > most {
                    continue;
                }
            }
            self.step(task)?;
        }
        let in_order = |pair| Some(self.in_order(pair));
        self.open.map_or(Ok(()), |Open { from, reason, pair }| {
            Err(Verdict::Unproven { clear_until: from, reason, pair: in_order(pair) })
        })
    }

    /// Proves the task, or replaces it by others; an error is a counterexample.
    fn step(&mut self, task: Task) -> Result<(), Verdict> {
        let nodes = [0, 1].map(|k| &self.bodies[k].mesh.nodes[task.nodes[k] as usize]);
        let span = &self.spans[task.span];
        if let [Below::Triangle(s), Below::Triangle(t)] = nodes.map(|node| node.below) {
            let (pair, from) = ([s, t], span.time.from);
            let [s, t] = meeting::triangles(&self.bodies, pair);
            let mut attempt = Attempt::new(&self.bodies, span, [&s, &t], self.distance);
            if attempt.separates_triangles() || attempt.second_try() {
                return Ok(());
            }
            let [first, last] = attempt.clear_ends();
            let reason = if first && last {
                if self.halve(task) {
                    return Ok(());
                }
                Reason::TimeResolution
            } else {
                self.close_at_an_end(task.span, [&s, &t], pair)?
            };
            if self.open.is_none_or(|open| from < open.from) {
                self.open = Some(Open { from, reason, pair });
            }
            return Ok(());
        }
        let parts = nodes.map(|node| &node.part);
        let mut attempt = Attempt::new(&self.bodies, span, parts, self.distance);
        let fast = attempt.moves() > nodes[0].size.max(nodes[1].size);
        if !(attempt.separates_boxes() || (fast && (attempt.second_try() || self.halve(task)))) {
            self.split(nodes.map(|node| (node.size, node.below)), task);
        }
        Ok(())
    }

    /// At a time at which nothing separates two triangles they may be proven close: that is the error. Where they are proven neither
    /// close nor clear, no shorter span decides it.
    fn close_at_an_end(&self, span: usize, parts: [&Part; 2], pair: [u32; 2]) -> Result<Reason, Verdict> {
        let ends = self.spans[span].ends;
        for now in ends.iter().flatten() {
            let distance = meeting::distance(now, parts);
            if distance.hi() <= self.distance {
                return Err(Verdict::Refuted { time: now.time, triangles: self.in_order(pair), distance });
            }
        }
        let is_known = ends.iter().all(Option::is_some);
        Ok(if is_known { Reason::TooClose } else { Reason::Enclosure })
    }

    fn in_order(&self, [s, t]: [u32; 2]) -> [u32; 2] {
        if self.swapped { [t, s] } else { [s, t] }
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
            for ([from, to], ends) in [([from, middle], [ends[0], now]), ([middle, to], [now, ends[1]])] {
                let time = TimeSpan { from, to };
                let bounds = Turning::new(&self.bodies, time).map_or(Bounds::NONE, |t| t.bounds());
                self.spans.push(Span { time, ends, bounds, halves: None });
            }
        }
        // The earlier half is proven first.
        self.tasks.extend([first + 1, first].map(|span| Task { span, ..task }));
        true
    }

    /// Splits the larger box, or the one that is none of a triangle.
    fn split(&mut self, [(size, below), (size_other, below_other)]: [(f64, Below); 2], task: Task) {
        let [of_base, of_other] = task.nodes;
        let halves = match (below, below_other) {
            (Below::Nodes(first), Below::Triangle(_)) => [[first, of_other], [first + 1, of_other]],
            (Below::Nodes(first), _) if size >= size_other => [[first, of_other], [first + 1, of_other]],
            (_, Below::Nodes(first)) => [[of_base, first], [of_base, first + 1]],
            _ => return,
        };
        self.tasks.extend(halves.map(|nodes| Task { nodes, ..task }));
    }
}
