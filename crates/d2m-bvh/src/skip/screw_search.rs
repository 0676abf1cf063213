//! Until when are two bodies apart that turn and slide along a common axis, as a screw in its nut does?
//!
//! Seen from B, a point of A with distance ρ from the axis, angle θ and height z moves by θ + wτ and z + vτ. So ρ and
//! φ = z − hθ, h = v/w, never change: in the plane of (ρ, φ) both bodies are at rest. Where their projections to that plane
//! are apart, they never meet; heights keep the rest apart for a time. φ is known up to multiples of the lead 2πh.
//!
//! See docs/theory/engine.md, "Screws".

use super::orbits::{BodyProjections, PlacedVertices, SeenTriangle};
use super::projection::{DIRECTIONS, Directions, Piece, Range, Slabs, WidestGap};
use super::projection_tree::ProjectionTree;
use super::screw::Screw;
use super::swept_body::AnnularBound;
use super::{Skip, SkipLimits, later_offset};
use crate::pair::scene::{MovingScene, SceneBody};
use d2m_lanes::{Lanes, Task, run};
use d2m_mesh::margin::{UNIT_F64, UP};
use d2m_mesh::{Exhausted, Meter};
use glam::DVec3;

/// Larger pairs of meshes are not projected: a projection takes about 500 bytes a triangle.
const MOST_TRIANGLES: usize = 1 << 18;
/// Factor of the scene's size that covers all roundings here. An angle errs by 64·2⁻⁵³ of the size over the distance from the
/// axis and 8·2⁻⁵³ of its own, and as much again with each division of a triangle; φ is h times as far off, and is
/// divided by a steepness of at least h over the distance. Triangles have distances within a factor of 100
/// ([`BESIDE`](super::orbits::BESIDE)).
const PROJECTION_ERROR: f64 = 16_384.0 * UNIT_F64;
/// Bends that are smaller than the gap by this factor gain little time if they are divided.
const LITTLE: f64 = 64.0;
/// Most leads that two projections may be shifted by.
const MOST_LEADS: f64 = 64.0;

/// How fast what leaves the common screw takes a gap.
#[derive(Clone, Copy, Debug)]
struct Closing {
    /// The part of what moves across the axis that counts.
    across: f64,
    /// Another rate.
    rate: f64,
}

impl Closing {
    /// As fast as it moves.
    const ANY_DIRECTION: Self = Self { across: 1.0, rate: 0.0 };
}

/// What is done with two cells that may come near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Division {
    OfA,
    OfB,
    /// The gap between two pieces is so many times as wide as their bends that dividing them would widen it by little.
    GainsLittle,
}

/// The search through two trees of projections.
struct Walk<'s> {
    screw: &'s Screw,
    /// What is added to φ of A.
    shift: f64,
    /// Whether both bodies' angles are known: else only ρ counts.
    angles: bool,
    level: f64,
    length: f64,
    /// The earliest time at which parts may meet; at most `gain` ends the walk.
    clear: f64,
    gain: f64,
    left: u64,
    clock: Meter,
}

/// Until when the projections of the bodies stay further apart than the level, from `start` on.
pub(crate) fn screw_clear_until(scene: &MovingScene<'_>, start: f64, limits: &SkipLimits) -> Skip {
    let nothing = Skip { clear_until: None, work: 0 };
    if triangle_count(scene) > MOST_TRIANGLES {
        return nothing;
    }
    let Some(screw) = Screw::new(scene, start) else { return nothing };
    let mut seen = None;
    let skip = clear_along(&screw, (scene, start), limits, &mut seen);
    if skip.clear_until.is_some() || screw.h == 0.0 {
        return skip;
    }
    let limits = SkipLimits { budget: limits.budget.saturating_sub(skip.work), ..*limits };
    let in_place = clear_along(&screw.turn_in_place(), (scene, start), &limits, &mut seen);
    Skip { work: skip.work + in_place.work, ..in_place }
}

fn triangle_count(scene: &MovingScene<'_>) -> usize {
    scene.a.tree.mesh().triangle_count() + scene.b.tree.mesh().triangle_count()
}

/// A body as it is seen from the axis at the start.
struct Seen {
    vertices: PlacedVertices,
    /// Where each triangle lies.
    annuli: Vec<AnnularBound>,
}

impl Seen {
    fn try_new(
        body: &SceneBody<'_>,
        place: impl Fn(DVec3) -> DVec3,
        clock: &mut Meter,
    ) -> Result<Self, Exhausted> {
        let mesh = body.tree.mesh();
        let vertices = PlacedVertices::new(mesh.vertices().iter().map(|&p| place(body.place(p))));
        let mut annuli = Vec::with_capacity(mesh.triangle_count());
        for &triangle in mesh.triangles() {
            clock.step()?;
            annuli.push(AnnularBound::of(&vertices.corners(triangle)));
        }
        Ok(Self { vertices, annuli })
    }
}

/// The same with the screw that they make. `seen`: both bodies from the axis, filled in when they are needed.
fn clear_along(
    screw: &Screw,
    (scene, start): (&MovingScene<'_>, f64),
    limits: &SkipLimits,
    seen: &mut Option<[Seen; 2]>,
) -> Skip {
    let bodies = [&scene.a, &scene.b];
    let length = (scene.end - start).next_up();
    // What the projections cost at most, in pairs.
    let triangles = triangle_count(scene) as u64;
    let projected = triangles / 2;
    if projected >= limits.budget {
        return Skip { clear_until: None, work: 0 };
    }
    let most = limits.most_work.min(limits.budget - projected);
    let mut walk = Walk {
        screw,
        shift: 0.0,
        angles: true,
        level: scene.pair.level + PROJECTION_ERROR * (scene.size + scene.pair.level),
        length,
        clear: length,
        gain: limits.least_gain,
        left: most,
        clock: Meter::until(limits.stop),
    };
    let places = screw.places(scene, start);
    let probe = [0, 1].map(|body| {
        let corners = bodies[body].corners(limits.witnesses[body]).map(&places[body]);
        let near = AnnularBound::of(&corners).near;
        let triangle = SeenTriangle { vertices: [0, 1, 2], near };
        let mut vertices = PlacedVertices::new(corners.into_iter());
        BodyProjections::try_new(screw, &mut vertices, &[triangle], &mut walk.clock)
    });
    let [Ok(a), Ok(b)] = probe else { return Skip { clear_until: None, work: 0 } };
    if !walk.compare([a, b]) {
        return Skip { clear_until: None, work: most - walk.left };
    }
    if seen.is_none() {
        let both = [0, 1].map(|body| Seen::try_new(bodies[body], &places[body], &mut walk.clock));
        let [Ok(a), Ok(b)] = both else { return Skip { clear_until: None, work: projected } };
        *seen = Some([a, b]);
    }
    let Some(seen) = seen else { return Skip { clear_until: None, work: projected } };
    let near = walk.near_triangles([&seen[0].annuli, &seen[1].annuli]);
    let near_count = (near[0].len() + near[1].len()) as u64;
    let projected = (triangles + near_count) / 4;
    let more = (limits.most_a_triangle * near_count).min(limits.budget - projected - most);
    let most = most + more;
    walk.left += more;
    let whole = [0, 1].map(|body| {
        let all = bodies[body].tree.mesh().triangles();
        let Seen { vertices, annuli } = &mut seen[body];
        let triangles: Vec<_> =
            near[body].iter().map(|&t| SeenTriangle { vertices: all[t], near: annuli[t].near }).collect();
        BodyProjections::try_new(screw, vertices, &triangles, &mut walk.clock)
    });
    let [Ok(a), Ok(b)] = whole else { return Skip { clear_until: None, work: projected } };
    let apart = walk.compare([a, b]);
    let work = most - walk.left + projected;
    let clear_until = if apart { later_offset(start, walk.clear, walk.length, scene.end) } else { None };
    Skip { clear_until, work }
}

/// The search through two trees with one shift of φ: lowers `clear` to what they allow; false when the walk is to end. Depth first, compiled for
/// each instruction set.
struct WholeShift<'w, 's> {
    walk: &'w mut Walk<'s>,
    a: &'w mut ProjectionTree,
    b: &'w mut ProjectionTree,
}

impl Task for WholeShift<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { walk, a, b } = self;
        let mut waiting = vec![[0, 0]];
        while let Some(cells) = waiting.pop() {
            if walk.left == 0 || walk.clock.step().is_err() {
                return false;
            }
            walk.left -= 1;
            let until = walk.clear_for([&*a, &*b], cells);
            if until >= walk.clear {
                continue;
            }
            let open_a = match walk.division([&*a, &*b], cells) {
                Division::OfA => true,
                Division::OfB => false,
                Division::GainsLittle if until > walk.gain => {
                    walk.clear = until;
                    continue;
                }
                Division::GainsLittle => a.size(cells[0]) > b.size(cells[1]),
            };
            let opened =
                if open_a { a.open(cells[0], &mut walk.clock) } else { b.open(cells[1], &mut walk.clock) };
            let Ok(parts) = opened else { return false };
            if parts.is_empty() {
                walk.clear = until;
                if walk.clear <= walk.gain {
                    return false;
                }
            }
            waiting.extend(parts.rev().map(|part| if open_a { [part, cells[1]] } else { [cells[0], part] }));
        }
        true
    }
}

impl Walk<'_> {
    /// The triangles of both bodies that something of the other may come near: whose heights, or distances from the axis, do
    /// not stay apart from those of all the rest. The others lower nothing.
    fn near_triangles(&self, annuli: [&[AnnularBound]; 2]) -> [Vec<usize>; 2] {
        let mut near = annuli.map(|all| (0..all.len()).collect::<Vec<usize>>());
        // The second one's against what is left of the first one's, then the first one's once more.
        for [one, other] in [[0, 1], [1, 0], [0, 1]] {
            let rest = near[other].iter().fold(AnnularBound::NONE, |all, &t| all.with(annuli[other][t]));
            near[one].retain(|&t| {
                let annulus = annuli[one][t];
                let [a, b] = if one == 0 { [annulus, rest] } else { [rest, annulus] };
                let apart = (b.near - a.far).max(a.near - b.far);
                let heights = [a, b].map(|part| Range { low: part.low, high: part.high });
                let clear =
                    self.clear_while(apart, Closing::ANY_DIRECTION).max(self.heights_clear_for(heights));
                clear < self.length
            });
        }
        near
    }

    /// For how long the heights of the parts stay further apart than the level: the gap changes by the climb, and by what a body's axis is
    /// tilted against the other one's.
    #[inline(always)]
    fn heights_clear_for(&self, [a, b]: [Range; 2]) -> f64 {
        let (climb, length) = (self.screw.climb, self.length);
        let mut best: f64 = 0.0;
        for (gap, rate) in [(b.low - a.high, -climb), (a.low - b.high, climb)] {
            let room = gap - self.level - self.screw.tilted;
            if room > 0.0 {
                best = best.max(if -rate * UP * length <= room { length } else { room / (-rate * UP) });
            }
        }
        best
    }

    /// Lowers `clear` to what the bodies' projections (with angles, without) allow; false when the walk is to end.
    fn compare(&mut self, bodies: [BodyProjections; 2]) -> bool {
        let [mut a, mut b] = bodies.map(|body| [body.with_angles, body.without_angles]);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (a, b) = (&mut a[i], &mut b[j]);
            let (Some(first), Some(second)) = (a.cells.first(), b.cells.first()) else { continue };
            let (first, second) = (first.projection, second.projection);
            let angles = i + j == 0;
            self.angles = angles;
            let lead = self.screw.lead;
            let (phi_a, phi_b) = (first.phi(), second.phi());
            let leads = if angles && lead > 0.0 {
                (((phi_b.low - phi_a.high) / lead).floor(), ((phi_b.high - phi_a.low) / lead).ceil())
            } else {
                (0.0, 0.0)
            };
            let count = leads.1 - leads.0;
            if count.is_nan() || count > MOST_LEADS {
                return false;
            }
            if angles && lead > 0.0 {
                // Shifted by more, the whole projections are a lead apart in φ.
                let rho = 0.5 * first.near.max(second.near);
                let slack = first.slack + second.slack;
                let apart = lead / self.screw.steepness(rho);
                self.clear = self.clear.min(self.clear_while(apart.min(rho) - slack, Closing::ANY_DIRECTION));
            }
            for k in leads.0 as i64..=leads.1 as i64 {
                self.shift = k as f64 * lead;
                if !run(WholeShift { walk: self, a, b }) {
                    return false;
                }
            }
        }
        true
    }

    /// Which of two cells that may come near each other is divided: the larger one; of two pieces that their bends alone bring near each other,
    /// along the direction in which they are furthest apart, the one that is bent more. Whatever comes out, every part is compared.
    #[inline(always)]
    fn division(&self, [a, b]: [&ProjectionTree; 2], [i, j]: [usize; 2]) -> Division {
        let of_a = |first: bool| if first { Division::OfA } else { Division::OfB };
        let by_size = of_a(a.size(i) > b.size(j));
        let (Some(p), Some(q)) = (a.piece(i), b.piece(j)) else { return by_size };
        if !(p.is_divisible() && q.is_divisible()) {
            return of_a(p.is_divisible());
        }
        if !self.angles {
            return by_size;
        }
        let steep = self.screw.steepness(0.5 * p.near.max(q.near));
        let along = across_sides([p, q]);
        let WidestGap { direction: k, gap, first_is_below } =
            along.widest([&p.reach(&along), &q.reach(&along)], self.shift, steep);
        let [p, q] = [p, q].map(|piece| piece.bends(along.alpha[k], along.beta[k]));
        let bends = if first_is_below { [p.above, q.below] } else { [p.below, q.above] };
        let both = bends[0] + bends[1];
        if LITTLE * both < gap {
            Division::GainsLittle
        } else if bends[0] == bends[1] || gap + both <= 0.0 {
            by_size
        } else {
            of_a(bends[0] > bends[1])
        }
    }

    /// For how long the parts stay further apart than the level; at most the length of the span.
    #[inline(always)]
    fn clear_for(&self, trees: [&ProjectionTree; 2], cells: [usize; 2]) -> f64 {
        let screw = self.screw;
        let (a, b) = (&trees[0].cells[cells[0]].projection, &trees[1].cells[cells[1]].projection);
        let heights = self.heights_clear_for([a.height, b.height]);
        // Points that are within ℓ of each other, ℓ at most half of ρ there, differ in F by at most |∇F| ℓ, with
        // |∇F|² = α² + β²(1 + h²/(ρ/2)²): ∇ρ and ∇φ are at right angles.
        let rho = 0.5 * a.near.max(b.near);
        if rho <= 0.0 {
            return heights;
        }
        let [steep, slack] = [screw.steepness(rho), a.slack + b.slack];
        // What has no angles has no ends along directions other than ρ.
        let clear = heights.max(self.clear_along(&DIRECTIONS, [&a.slabs, &b.slabs], [rho, steep, slack]));
        let pieces = [0, 1].map(|k| trees[k].piece(cells[k]).filter(|_| self.angles));
        match pieces {
            // What is clear for as long as the earliest pair needs no further direction.
            [Some(p), Some(q)] if clear < self.clear => {
                let along = across_sides([p, q]);
                let slabs = [&p.reach(&along), &q.reach(&along)];
                clear.max(self.clear_along(&along, slabs, [rho, steep, slack]))
            }
            _ => clear,
        }
    }

    /// For how long one of the directions keeps the parts further apart than the level.
    #[inline(always)]
    fn clear_along<const N: usize>(
        &self,
        along: &Directions<N>,
        slabs: [&Slabs<N>; 2],
        [rho, steep, slack]: [f64; 3],
    ) -> f64 {
        let (distances, lengths) = along.distances(slabs, self.shift, steep);
        if self.screw.slide == 0.0 && !self.leaves_screw() {
            let apart = distances.into_iter().fold(0.0, |a: f64, b| if b > a { b } else { a });
            return self.clear_while(apart.min(rho) - slack, Closing::ANY_DIRECTION);
        }
        let per_radius = self.screw.h / rho;
        let mut best: f64 = 0.0;
        let mut clear = [0.0; N];
        // Without branches: several are done at once.
        for j in 0..N {
            // A direction of no length says nothing.
            let distance = if distances[j] > 0.0 { distances[j] } else { 0.0 };
            let (alpha, beta) = (along.alpha[j], along.beta[j]);
            let across =
                (alpha * alpha + beta * beta * per_radius * per_radius).sqrt() * UP / lengths[j] * UP;
            clear[j] =
                self.clear_while(distance - slack, Closing { across, rate: self.rate(beta, lengths[j]) });
        }
        for time in clear {
            best = if time > best { time } else { best };
        }
        let any_direction = self.clear_while(rho - slack, Closing::ANY_DIRECTION);
        if any_direction < best { any_direction } else { best }
    }

    /// Whether the bodies leave the common screw across its axis by more than the level: else no direction is better for it than another one.
    #[inline(always)]
    fn leaves_screw(&self) -> bool {
        self.screw.across_now + self.screw.across_rate * self.length > self.level
    }

    /// How fast the distance along a direction changes when the climb is left out of h.
    #[inline(always)]
    fn rate(&self, beta: f64, length: f64) -> f64 {
        (beta * self.screw.slide).abs() * UP / length
    }

    /// For how long points that the common screw alone would keep `apart` do not come within the level.
    #[inline(always)]
    fn clear_while(&self, apart: f64, closing: Closing) -> f64 {
        let (screw, Closing { across, rate }) = (self.screw, closing);
        let room = apart - self.level - screw.tilted - across * screw.across_now * UP;
        let drift = (screw.drift + across * screw.across_rate * UP + rate) * UP;
        let clear = if drift * self.length <= room { self.length } else { room / drift };
        // As long as nothing at all, also where the room is no number.
        if room > 0.0 { clear } else { 0.0 }
    }
}

/// Across the sides of both projections.
#[inline(always)]
fn across_sides(pieces: [&Piece; 2]) -> Directions<6> {
    let mut along = Directions { alpha: [0.0; 6], beta: [0.0; 6] };
    for (k, piece) in pieces.into_iter().enumerate() {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (&piece.corners[i], &piece.corners[j]);
            (along.alpha[3 * k + i], along.beta[3 * k + i]) = (from.phi - to.phi, to.rho - from.rho);
        }
    }
    along
}

#[cfg(test)]
mod tests;
