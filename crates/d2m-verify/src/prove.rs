//! Two bodies are further apart than a distance at every time of a span: the recursion.
use crate::directions::{Axis, Direction, between, between_hulls, faces_and_sides};
use crate::instant::{Instant, Part, Separation};
use crate::mesh::Node;
use crate::rates::{Rates, lowest};
use crate::{Body, Reason, TimeSpan};
use d2m_interval::Interval;
use glam::DVec3;
use std::cell::OnceCell;

/// Steps at least that are looked for a counterexample in, after something could not be proven.
const LATER: u64 = 4096;
/// So few triangles are taken together, as what is between their corners.
const FEW: usize = 8;
/// So many directions that separated others are tried.
const KNOWN: usize = 4;

/// What keeps bodies from being proven apart.
#[derive(Clone, Copy)]
pub(crate) enum Obstacle {
    /// The meshes are that near at this time: two triangles are, or where none are named, one solid holds a part of the other.
    Met { time: f64, triangles: Option<[u32; 2]>, distance: Interval },
    /// No proof was found: the fields are those of [`Verdict::Unproven`](crate::Verdict::Unproven).
    Open { clear_until: f64, reason: Reason, pair: Option<[u32; 2]> },
}

pub(crate) type Proof<T = ()> = Result<T, Obstacle>;

/// Proves the meshes further apart than `distance` at every time of the span, one smooth piece of both motions after the other, in as
/// many steps as are `left`.
pub(crate) fn surfaces_clear(bodies: &[Body<'_>; 2], span: TimeSpan, distance: f64, left: &mut u64) -> Proof {
    let mut now = span.from;
    loop {
        // A piece that does not advance, or whose end is no number, ends now.
        let ends = bodies.iter().filter_map(|body| body.motion.smooth_until(now)).map(|end| end.max(now));
        let end = ends.fold(span.to, f64::min);
        if end <= now && now < span.to {
            return Err(Obstacle::Open { clear_until: now, reason: Reason::Pieces, pair: None });
        }
        smooth_clear(*bodies, TimeSpan { from: now, to: end }, distance, left)?;
        if end >= span.to {
            return Ok(());
        }
        now = end;
    }
}

/// The same of a span in which both motions are smooth.
fn smooth_clear([a, b]: [Body<'_>; 2], time: TimeSpan, distance: f64, left: &mut u64) -> Proof {
    let seen = [[a, b], [b, a]].map(|bodies| {
        let (rates, root) = (Rates::new(&bodies, time), bodies[1].mesh.nodes[0]);
        (bodies, rates, rates.guess_acceleration((root.high - root.low).length()))
    });
    // The base is the body from which the other one accelerates less.
    let is_swapped = seen[1].2 < seen[0].2;
    let (bodies, rates, _) = seen[usize::from(is_swapped)];
    let start = Instant::new(&bodies, time.from);
    let end = if time.from < time.to { Instant::new(&bodies, time.to) } else { start };
    let whole = Span { time, ends: [start, end], rates, halves: OnceCell::new() };
    let mut prover = Prover { bodies, is_swapped, distance, known: Vec::new(), open: None };
    let (all, mut tasks, mut least) = (*left, vec![Task { pair: [0, 0], span: &whole }], None);
    while let Some(task) = tasks.pop() {
        let (from, since) = (task.span.time.from, prover.open.map(|(since, _)| since));
        if *left == 0 {
            let others = tasks.iter().map(|task| task.span.time.from).chain(since);
            let clear_until = others.fold(from, f64::min);
            return Err(Obstacle::Open { clear_until, reason: Reason::Steps, pair: None });
        }
        *left -= 1;
        // What cannot be proven may be refuted by what comes later, for as much work again.
        let mut least = || *least.get_or_insert(left.saturating_sub(LATER + (all - *left)));
        if since.is_none_or(|since| *left >= least() || from < since) {
            tasks.extend(prover.step(task)?.into_iter().flatten());
        }
    }
    prover.open.map_or(Ok(()), |(_, open)| Err(open))
}

/// A span with its ends; all pairs share it, and its halves.
struct Span {
    time: TimeSpan,
    ends: [Instant; 2],
    rates: Rates,
    halves: OnceCell<Box<[Span; 2]>>,
}

impl Span {
    /// `None` where no number for a time is between its ends.
    fn halves(&self, bodies: &[Body<'_>; 2]) -> Option<&[Self; 2]> {
        let TimeSpan { from, to } = self.time;
        let middle = from + 0.5 * (to - from);
        let halves = || {
            let now = Instant::new(bodies, middle);
            let times = [TimeSpan { from, to: middle }, TimeSpan { from: middle, to }];
            let ends = [[self.ends[0], now], [now, self.ends[1]]];
            let rates = times.map(|time| Rates::new(bodies, time));
            let half =
                |k: usize| Self { time: times[k], ends: ends[k], rates: rates[k], halves: OnceCell::new() };
            Box::new([half(0), half(1)])
        };
        (from < middle && middle < to).then(|| &**self.halves.get_or_init(halves))
    }

    /// Are the parts proven to be apart all the time? In intervals, from both ends and K/2.
    fn is_proven(&self, separation: &Separation, parts: [Part<'_>; 2]) -> bool {
        let bend = || 0.5 * self.rates.curvature(separation, parts);
        let bend = if self.time.from < self.time.to { bend() } else { 0.0 };
        lowest(self.ends.each_ref().map(|now| now.above(separation, parts)), bend) > 0.0
    }
}

/// Parts of the base and of the other body, over a span.
#[derive(Clone, Copy)]
struct Task<'s> {
    pair: [u32; 2],
    span: &'s Span,
}

struct Prover<'q> {
    /// The base first.
    bodies: [Body<'q>; 2],
    is_swapped: bool,
    distance: f64,
    /// Directions that separated others, the last one first.
    known: Vec<Direction>,
    /// Since when something could not be proven, and what.
    open: Option<(f64, Obstacle)>,
}

impl Prover<'_> {
    /// Proves the task, or divides it, the part that is to be proven first last; an error is a counterexample.
    fn step<'s>(&mut self, task: Task<'s>) -> Proof<Option<[Task<'s>; 2]>> {
        let Task { pair, span } = task;
        let nodes = [0, 1].map(|k| &self.bodies[k].mesh.nodes[pair[k] as usize]);
        let half = nodes.map(|node| (node.high - node.low) * 0.5);
        if self.boxes_apart(span, nodes, half) {
            return Ok(None);
        }
        let triangles = [0, 1].map(|k| self.bodies[k].mesh.triangles_of(nodes[k]));
        if triangles.iter().all(|triangles| triangles.len() <= FEW) && self.hulls_apart(span, triangles) {
            return Ok(None);
        }
        if let [&[s], &[t]] = triangles {
            return self.triangles(task, [s, t]);
        }
        let size = half.map(|half| 2.0 * half.length());
        // Where points move further than the boxes are large, shorter spans say more than smaller boxes.
        let moves = span.rates.guess_speed(size[1]);
        if moves > size[0].max(size[1])
            && let Some(halves) = self.halves(task)
        {
            return Ok(Some(halves));
        }
        let larger = usize::from(size[1] > size[0]);
        let divided = if triangles[larger].len() > 1 { larger } else { 1 - larger };
        Ok(Some(self.bodies[divided].mesh.below(pair[divided]).map(|node| {
            let mut pair = pair;
            pair[divided] = node;
            Task { pair, span }
        })))
    }

    /// The later half of its span first.
    fn halves<'s>(&self, task: Task<'s>) -> Option<[Task<'s>; 2]> {
        task.span.halves(&self.bodies).map(|[early, late]| [late, early].map(|span| Task { span, ..task }))
    }

    /// About how far parts are apart at both ends along an axis or its opposite, and this separation, if it is further than `least`. From a
    /// point of the one to a point of the other it is `between` at the ends, and `reach` is how far a part goes from there.
    fn guess(
        &self,
        axes: [&Axis; 2],
        between: [DVec3; 2],
        reach: impl Fn(usize, DVec3) -> f64,
        least: f64,
    ) -> Option<(f64, Separation)> {
        let sign = axes[0].n[0].dot(between[0]).signum();
        let gap = |k: usize| {
            let [n, n_other] = axes[k].n.map(|n| n * sign);
            n.dot(between[k]) - reach(0, n) - reach(1, -n_other) - self.distance * axes[k].length
        };
        let more = |lesser: f64, k: usize| Some(gap(k)).filter(|&gap| gap > least).map(|gap| gap.min(lesser));
        let gap = [0, 1].into_iter().try_fold(f64::INFINITY, more)?;
        let (direction, about) = (axes[0].direction, 0.5 * (axes[0].length + axes[1].length));
        Some((gap, Separation { direction, sign, distance: self.distance, about }))
    }

    /// Tries the best of the fifteen directions of two boxes, as it seems in plain numbers.
    fn boxes_apart(&self, span: &Span, nodes: [&Node; 2], half: [DVec3; 2]) -> bool {
        let middle = [0, 1].map(|k| nodes[k].low + half[k] - self.bodies[k].mesh.center);
        let between = span.ends.each_ref().map(|now| now.guess(middle[1]) - middle[0]);
        let (mut widest, mut best) = (0.0, None);
        for (axis, axis_end) in span.ends[0].axes.iter().zip(&span.ends[1].axes) {
            let reach = |k: usize, n: DVec3| n.abs().dot(half[k]);
            if let Some((gap, separation)) = self.guess([axis, axis_end], between, reach, widest) {
                (widest, best) = (gap, Some(separation));
            }
        }
        let bounds = [0, 1].map(|k| [self.bodies[k].mesh.bounds(nodes[k])]);
        best.is_some_and(|best| span.is_proven(&best, [&bounds[0], &bounds[1]]))
    }

    /// Tries directions between what is between the corners of few triangles: those that separated others first.
    fn hulls_apart(&mut self, span: &Span, triangles: [&[u32]; 2]) -> bool {
        let exact = [0, 1].map(|k| {
            let mesh = self.bodies[k].mesh;
            triangles[k].iter().flat_map(|&triangle| mesh.corners(triangle)).collect::<Vec<_>>()
        });
        let points = exact.each_ref().map(|part| part.iter().map(|p| p.mid()).collect::<Vec<_>>());
        let between_first = span.ends.each_ref().map(|now| now.guess(points[1][0]) - points[0][0]);
        let reach = |k: usize, n: DVec3| {
            let along = points[k].iter().map(|p| n.dot(*p));
            along.fold(f64::NEG_INFINITY, f64::max) - n.dot(points[k][0])
        };
        let proves = |direction: &Direction| {
            let axes = span.ends.each_ref().map(|now| Axis::new(*direction, &now.turn_guess));
            let guess = self.guess(axes.each_ref(), between_first, reach, 0.0);
            guess.is_some_and(|(_, separation)| span.is_proven(&separation, [&exact[0], &exact[1]]))
        };
        let known = self.known.iter().copied().find(proves);
        let found = known.or_else(|| match (&points[0][..], &points[1][..]) {
            (&[p, q, r], &[s, t, u]) => {
                let corners = [[p, q, r], [s, t, u]];
                let near = |now: &Instant| between(&corners, &now.turn_guess, now.offset_guess);
                faces_and_sides(&corners).into_iter().chain(span.ends.iter().flat_map(near)).find(proves)
            }
            (a, b) => {
                let seen: Vec<DVec3> = b.iter().map(|q| span.ends[1].guess(*q)).collect();
                Some(between_hulls(a, &seen)).filter(proves)
            }
        });
        self.known.retain(|known| Some(*known) != found);
        self.known.splice(0..0, found);
        self.known.truncate(KNOWN);
        found.is_some()
    }

    /// Two triangles that are not apart over a span are, if they are at its ends, tried over shorter ones. Proven close at one, they are
    /// the counterexample; neither close nor clear, no shorter span decides it.
    fn triangles<'s>(&mut self, task: Task<'s>, mut pair: [u32; 2]) -> Proof<Option<[Task<'s>; 2]>> {
        let corners = [0, 1].map(|k| self.bodies[k].mesh.corners(pair[k]));
        if self.is_swapped {
            pair.reverse();
        }
        let (mut reason, clear_until) = (Reason::TimeResolution, task.span.time.from);
        for now in &task.span.ends {
            let distance = now.distance(&corners);
            if distance.hi() <= self.distance {
                return Err(Obstacle::Met { time: now.time, triangles: Some(pair), distance });
            }
            if distance.lo() <= self.distance {
                reason = if distance.hi() < f64::INFINITY { Reason::TooClose } else { Reason::Enclosure };
            }
        }
        let halves = if reason == Reason::TimeResolution { self.halves(task) } else { None };
        if halves.is_none() && self.open.is_none_or(|(since, _)| clear_until < since) {
            self.open = Some((clear_until, Obstacle::Open { clear_until, reason, pair: Some(pair) }));
        }
        Ok(halves)
    }
}
