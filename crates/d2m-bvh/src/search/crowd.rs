//! A crowd, very many node pairs that may meet at the same time: one plane that separates all of them.
//!
//! Where n triangles of one body and m of the other come together at a point – two fans, stars, copies of one face –
//! all n·m pairs have the same time of impact, and best first has to test each. So when many pairs wait, one of them is
//! advanced to its contact, out of turn; then all vertices below the pairs that wait are taken, and a direction is sought
//! along which all of A's are below all of B's from the time proven so far until that contact. Along a fixed direction the
//! gap of the two sets of points that move at constant rates is concave in time, and the rest of the motion takes at
//! most M s²/2 from it, which is concave as well: positive at both ends, it is positive between. One such plane proves
//! all pairs apart; if there is none, the directions that were tried first still part many pairs one by one. Without a
//! contact the same is tried until the end of the window.
//!
//! See docs/theory/engine.md, "Crowds".

use super::motion::frame::Frame;
use super::nearest_point::Simplex;
use super::queue::{Bucket, Item};
use super::scene::SceneBody;
use super::state::{BATCH, Search, State};
use super::triangle_pair::separating_axis::place_a;
use crate::allowance::Allowance;
use crate::tree::node::{Below, WIDTH};
use d2m_lanes::{Lanes, Quad};
use glam::DVec3;

/// As many pairs that wait are a crowd, and as many batches in one window make one: several times as many as in
/// ordinary queries of a million triangles.
const CROWD: usize = 1 << 12;
const CROWD_OF_BATCHES: u32 = 1 << 10;
/// Most vertices of each body that are compared, for each pair of boxes that waits or was expanded: so it takes no more than
/// the search itself.
const VERTICES_A_PAIR: usize = 2;
/// Most vertices that are compared for one plane, all directions together: less than a millisecond of work.
const MOST_COMPARED: u64 = 1 << 18;
/// Directions that are tried for one plane, from each of the two that it begins with: at least, and at most.
const LEAST_DIRECTIONS: u64 = 8;
const MOST_DIRECTIONS: u64 = 32;
/// Vertices that are compared along one direction in the time of one node test.
const VERTICES_A_TEST: u64 = 16;
/// Part of the tolerance above the wanted separation that a plane leaves at least.
const PLANE_ROOM: f64 = 0.25;

/// How far the search of a sub-window has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// No live key is below this one.
    pub(super) least: u32,
    /// Batches that were handed out.
    pub(super) batches: u32,
}

/// When a search examines its crowd next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    pairs: usize,
    batches: u32,
}

impl Patience {
    pub(super) const fn new() -> Self {
        Self { pairs: CROWD, batches: CROWD_OF_BATCHES }
    }
}

impl Search<'_> {
    /// Drops the pairs that are proven apart, of those that wait and of the batch, until the contact that is known, or
    /// until the end of the window. Searches for a contact first.
    #[cold]
    #[inline(never)]
    pub(super) fn thin_out<L: Lanes>(
        &mut self,
        state: &mut State<'_>,
        Progress { least, batches }: Progress,
        batch: &mut Bucket,
        patience: &mut Patience,
    ) {
        let waiting = self.scratch.queue.len();
        let crowded = waiting >= patience.pairs || batches >= patience.batches;
        if !crowded {
            return;
        }
        *patience = Patience {
            pairs: if waiting >= patience.pairs { 2 * waiting } else { patience.pairs },
            batches: if batches >= patience.batches { 2 * batches } else { patience.batches },
        };
        let known = f64::from(least) * state.step;
        if state.found.is_none() {
            self.dive::<L>(state, batch.items()[0]);
            // Nothing that waits can be earlier than what was found, or matters any more.
            if least >= state.limit {
                return;
            }
        }
        let most = VERTICES_A_PAIR * waiting.max(BATCH * batches as usize);
        let mut clock = Allowance::until(self.limits.deadline);
        let Some(group) = self.group(state, batch.items(), most, &mut clock) else { return };
        let frame = match state.found {
            Some(_) => state.behind.reversed,
            None => state.motion.frame::<L::Doubles>(known),
        };
        let vertices = group.iter().map(Vec::len).sum::<usize>() as u64;
        let directions = (MOST_COMPARED / (2 * vertices).max(1)).clamp(LEAST_DIRECTIONS, MOST_DIRECTIONS);
        self.scratch.counts.swept_pairs += vertices * directions / VERTICES_A_TEST;
        let span = (state.limit_offset - known).next_up();
        let (scale, room) = (&self.scene.pair, PLANE_ROOM * self.scene.tolerance);
        // Places and rates err by less than half of the error, and what is bent by less than the rest.
        let level = (scale.level - self.scene.tolerance) + room + 2.0 * scale.error;
        let need = needs(level, scale.acceleration, span);
        let moving = Moving::new(&group, &frame, span);
        let starts = [state.behind.direction, moving.between()].map(DVec3::normalize_or_zero);
        let mut tried = starts.to_vec();
        for first in starts {
            match moving.separation(first, need, directions, &mut clock) {
                Separation::Proven => {
                    self.scratch.queue.clear();
                    batch.retain(|_| false);
                    return;
                }
                Separation::Unknown { last } => tried.push(last),
            }
        }
        for n in tried.into_iter().filter(|&n| n != DVec3::ZERO) {
            let [mut a, mut b] = [(&self.scene.a, Side::A), (&self.scene.b, Side::B)]
                .map(|(body, side)| Reaches::new(body, side, &frame, span, n));
            for item in self.scratch.queue.items().chain(batch.items()) {
                if clock.step().is_err() {
                    return;
                }
                a.measure(item.boxes[0]);
                b.measure(item.boxes[1]);
            }
            let length = n.length();
            let meet = |item: &Item| {
                let (high, low) = (a.of(item.boxes[0]), b.of(item.boxes[1]));
                // Also when something is not a number.
                !((0..2).all(|end| -low[end] - high[end] > need[end] * length))
            };
            self.scratch.queue.retain(meet);
            batch.retain(meet);
        }
    }

    /// Follows a pair of triangles below an item to its contact, if it has one.
    fn dive<L: Lanes>(&mut self, state: &mut State<'_>, mut item: Item) {
        while item.next & Item::TRIANGLES == 0 {
            self.scratch.counts.node_tests += 1;
            let expanded = state.expander.expand::<L>(&item, &state.node_frames, state.keys());
            let mut list = [[0; 4]; WIDTH];
            let count = L::pack(&expanded, &mut list);
            match list[..count].iter().map(|row| Item::from_row(*row)).min_by_key(|next| next.key) {
                Some(next) => item = next,
                None => return,
            }
        }
        self.advance::<L>(state, item, true);
    }

    /// The vertices below all pairs that wait, relative to the trees' centers; none if they are too many, or the time is
    /// over.
    fn group(
        &self,
        state: &State<'_>,
        batch: &[Item],
        most: usize,
        clock: &mut Allowance,
    ) -> Option<[Vec<DVec3>; 2]> {
        let mut bodies = [&self.scene.a, &self.scene.b].map(Group::new);
        for item in self.scratch.queue.items().chain(batch) {
            if item.key < state.limit {
                for (body, &index) in bodies.iter_mut().zip(&item.boxes) {
                    body.add(index, most, clock)?;
                }
            }
        }
        Some(bodies.map(|body| body.points))
    }
}

/// The gaps at both ends of a span that leave `level` all along it when accelerations take their part.
fn needs(level: f64, acceleration: f64, span: f64) -> [f64; 2] {
    [level, level + 0.5 * acceleration * span * span]
}

/// The vertices below some boxes of a body.
struct Group<'a> {
    body: &'a SceneBody<'a>,
    /// Which boxes and which vertices were added.
    seen: Vec<bool>,
    seen_vertices: Vec<bool>,
    points: Vec<DVec3>,
}

impl<'a> Group<'a> {
    fn new(body: &'a SceneBody<'a>) -> Self {
        let seen = vec![false; WIDTH * body.tree.nodes.len()];
        let seen_vertices = vec![false; body.tree.mesh.vertices().len()];
        Self { body, seen, seen_vertices, points: Vec::new() }
    }

    /// `None`: too many, or the time is over.
    fn add(&mut self, index: u32, most: usize, clock: &mut Allowance) -> Option<()> {
        let mut stack = vec![index as usize];
        while let Some(index) = stack.pop() {
            if core::mem::replace(&mut self.seen[index], true) {
                continue;
            }
            clock.step().ok()?;
            match self.body.tree.nodes[index / WIDTH].below(index % WIDTH) {
                Below::Triangle(triangle) => {
                    for vertex in self.body.tree.mesh.triangles()[triangle as usize] {
                        if !core::mem::replace(&mut self.seen_vertices[vertex as usize], true) {
                            self.points
                                .push(self.body.place(self.body.tree.mesh.vertices()[vertex as usize]));
                        }
                    }
                }
                Below::Node(node) => {
                    let used = self.body.tree.nodes[node as usize].used as usize;
                    stack.extend((0..used.min(WIDTH)).map(|lane| node as usize * WIDTH + lane));
                }
            }
            if self.points.len() > most {
                return None;
            }
        }
        Some(())
    }
}

/// One of the two bodies.
#[derive(Clone, Copy, Debug)]
enum Side {
    A,
    B,
}

/// How far boxes reach along a direction at both ends of a span: A's along `n`, B's against it.
struct Reaches<'a> {
    body: &'a SceneBody<'a>,
    frame: &'a Frame,
    side: Side,
    span: f64,
    along: DVec3,
    /// Of each box; not a number where it is not known.
    known: Vec<[f64; 2]>,
}

impl<'a> Reaches<'a> {
    fn new(body: &'a SceneBody<'a>, side: Side, frame: &'a Frame, span: f64, n: DVec3) -> Self {
        let known = vec![[f64::NAN; 2]; WIDTH * body.tree.nodes.len()];
        let along = match side {
            Side::A => n,
            Side::B => -n,
        };
        Self { body, frame, side, span, along, known }
    }

    fn of(&self, index: u32) -> [f64; 2] {
        self.known[index as usize]
    }

    fn measure(&mut self, index: u32) -> [f64; 2] {
        let known = self.known[index as usize];
        if !known[0].is_nan() {
            return known;
        }
        let reach = match self.body.tree.nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
            Below::Triangle(triangle) => {
                let t = self.body.corners(triangle);
                let t = match self.side {
                    Side::A => place_a::<Quad>(self.frame, &t),
                    Side::B => t,
                };
                let later = t.map(|p| p + rate(self.frame, self.side, p) * self.span);
                [t, later].map(|t| t.map(|p| self.along.dot(p)).into_iter().fold(f64::NEG_INFINITY, larger))
            }
            Below::Node(node) => {
                let used = self.body.tree.nodes[node as usize].used.min(WIDTH as u32);
                (0..used).fold([f64::NEG_INFINITY; 2], |most, lane| {
                    let [now, later] = self.measure(node * WIDTH as u32 + lane);
                    [larger(most[0], now), larger(most[1], later)]
                })
            }
        };
        self.known[index as usize] = reach;
        reach
    }
}

/// The larger one; what is not a number wins.
fn larger(x: f64, y: f64) -> f64 {
    if y > x || y.is_nan() { y } else { x }
}

/// Velocity of a point of A or of B at the time of the frame.
fn rate(frame: &Frame, side: Side, p: DVec3) -> DVec3 {
    match side {
        Side::A => frame.velocity.to_vec() + frame.omega_a.to_vec().cross(p - frame.apart.to_vec()),
        Side::B => frame.omega_b.to_vec().cross(p),
    }
}

/// Points of both bodies at the two ends of a span, in the frame of B at its first end, moving at their rates there.
struct Moving {
    /// First the points of A, then those of B, at either end.
    ends: [[Vec<DVec3>; 2]; 2],
}

/// The closest points of both bodies along a direction: from A to B, and the gap.
#[derive(Clone, Copy)]
struct Gap {
    along: f64,
    line: DVec3,
}

/// Whether a plane parts two sets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Separation {
    Proven,
    /// None was found; the normal that was tried last, zero if there is none.
    Unknown {
        last: DVec3,
    },
}

impl Moving {
    fn new([a, b]: &[Vec<DVec3>; 2], frame: &Frame, span: f64) -> Self {
        let place = |p: &DVec3| place_a::<Quad>(frame, &[*p; 3])[0];
        let a: Vec<DVec3> = a.iter().map(place).collect();
        let later_a = a.iter().map(|&p| p + rate(frame, Side::A, p) * span).collect();
        let later_b = b.iter().map(|&p| p + rate(frame, Side::B, p) * span).collect();
        Self { ends: [[a, b.clone()], [later_a, later_b]] }
    }

    /// From the mean of A's points to that of B's, both ends together.
    fn between(&self) -> DVec3 {
        let mean = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len() as f64;
        self.ends.iter().map(|[a, b]| mean(b) - mean(a)).sum()
    }

    /// Is there a direction along which the points of A are below those of B by more than `need` at both ends? Begins with
    /// the direction `n` and goes on to the nearest point of the hull of all differences of B's points and A's, those at
    /// the second end less what is needed there in addition: that is the direction of the widest gap.
    fn separation(&self, mut n: DVec3, need: [f64; 2], directions: u64, clock: &mut Allowance) -> Separation {
        let mut simplex: Option<Simplex> = None;
        for _ in 0..directions {
            if clock.read_clock().is_err() {
                break;
            }
            let length = n.length();
            // Also when something is not a number.
            let enough = |gap: Gap, need: f64| length > 0.0 && gap.along > need * length;
            let [now, later] = [0, 1].map(|end| self.gap(end, n));
            if enough(now, need[0]) && enough(later, need[1]) {
                return Separation::Proven;
            }
            let later = later.line - n * (need[1] - need[0]);
            let worse = if n.dot(later) < n.dot(now.line) { later } else { now.line };
            let Some(next) = simplex.map_or(Some(Simplex::new(worse)), |simplex| simplex.with(worse)) else {
                break;
            };
            simplex = Some(next);
            n = next.nearest().normalize_or_zero();
            if n == DVec3::ZERO {
                break;
            }
        }
        Separation::Unknown { last: n }
    }

    fn gap(&self, end: usize, n: DVec3) -> Gap {
        let farthest = |points: &[DVec3], n: DVec3| {
            let mut best = (points[0], n.dot(points[0]));
            for &p in points {
                let along = n.dot(p);
                if along > best.1 || along.is_nan() {
                    best = (p, along);
                }
            }
            best
        };
        let [a, b] = &self.ends[end];
        let ((p, high), (q, low)) = (farthest(a, n), farthest(b, -n));
        Gap { along: -low - high, line: q - p }
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::Scene;
    use super::*;
    use crate::random::Random;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_motion::ConstantTwist;
    use glam::DQuat;

    fn soup(random: &mut Random) -> MeshTree {
        let vertices = (0..9).map(|_| random.vec()).collect();
        MeshTree::new(TriMesh::try_new(vertices, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]).unwrap())
    }

    /// Bodies that a plane parts are further apart than the level at all times of the span; not if the gap is measured
    /// at one end only, nor without what accelerations take.
    #[test]
    fn what_a_plane_parts_stays_apart() {
        let mut random = Random(23);
        let (mut parted, mut wrong) = ([0; 3], [0; 3]);
        for round in 0..3000 {
            let (a, b) = (soup(&mut random), soup(&mut random));
            let spin = [0.5, 4.0, 12.0][round % 3];
            let [motion_a, motion_b] = [2.5, 0.0].map(|apart| {
                let q = DQuat::from_xyzw(random.next(), random.next(), random.next(), 1.5);
                ConstantTwist::try_new(random.vec() * apart, q, random.vec(), random.vec() * spin).unwrap()
            });
            let options = QueryOptions::default().with_tolerance(1e-3);
            let scene = Scene::try_new((&a, motion_a), (&b, motion_b), Window::UNIT, &options).unwrap();
            let motion = scene.relative_motion(0.0);
            let frame = motion.frame::<Quad>(0.0);
            let span = scene.longest * (0.6 + 0.4 * random.next());
            let group = [&scene.a, &scene.b].map(|body| {
                let mut group = Group::new(body);
                group.add(0, 100, &mut Allowance::unlimited()).unwrap();
                group.points
            });
            let moving = Moving::new(&group, &frame, span);
            let n = moving.between().normalize();
            let gaps = [0, 1].map(|end| moving.gap(end, n).along);
            let world = motion.rotation_b(0.0).times::<Quad>(n).to_vec();
            let gap_at = |time: f64| {
                let frame = motion.frame::<Quad>(time);
                let n = motion.rotation_b(time).transposed::<Quad>().times::<Quad>(world).to_vec();
                Moving::new(&group, &frame, 0.0).gap(0, n).along
            };
            let least = (0..=8).map(|k| gap_at(span * f64::from(k) / 8.0)).fold(f64::INFINITY, f64::min);
            // The largest levels that the plane may prove: parts of the gaps at both ends.
            for level in gaps.into_iter().flat_map(|gap| [0.999, 0.9, 0.7].map(|part| part * gap)) {
                let need = needs(level, scene.pair.acceleration, span);
                for (k, need) in [need, [need[0], f64::NEG_INFINITY], [level; 2]].into_iter().enumerate() {
                    if level > 0.0
                        && moving.separation(n, need, 1, &mut Allowance::unlimited()) == Separation::Proven
                    {
                        parted[k] += 1;
                        wrong[k] += u32::from(least < level - 2.0 * scene.pair.error);
                    }
                }
            }
        }
        assert!(wrong[0] == 0 && parted[0] > 200, "{wrong:?} of {parted:?}");
        assert!(wrong[1] > 0 && wrong[2] > 0, "{wrong:?} of {parted:?}");
    }

    #[test]
    fn boxes_reach_as_far_as_their_vertices() {
        let mut random = Random(29);
        let (a, b) = (soup(&mut random), soup(&mut random));
        let twist = ConstantTwist::try_new(random.vec(), random.turn(), random.vec(), random.vec()).unwrap();
        let options = QueryOptions::default();
        let scene = Scene::try_new((&a, twist), (&b, ConstantTwist::REST), Window::UNIT, &options).unwrap();
        let frame = scene.relative_motion(0.0).frame::<Quad>(0.0);
        for n in [DVec3::X, random.vec().normalize(), random.vec().normalize()] {
            let points = [&scene.a, &scene.b].map(|body| {
                let mut group = Group::new(body);
                group.add(0, 100, &mut Allowance::unlimited()).unwrap();
                group.points
            });
            let moving = Moving::new(&points, &frame, 0.25);
            let mut reach_a = Reaches::new(&scene.a, Side::A, &frame, 0.25, n);
            let mut reach_b = Reaches::new(&scene.b, Side::B, &frame, 0.25, n);
            let (high, low) = (reach_a.measure(0), reach_b.measure(0));
            for end in 0..2 {
                assert_eq!(moving.gap(end, n).along, -low[end] - high[end]);
            }
        }
    }
}
