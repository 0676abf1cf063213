//! Until when are two bodies apart, whatever the angle that each has turned by?
//!
//! A body that spins stays in what its points sweep out about the axis of its spin: circles. Along a unit direction n
//! the circle of a point e (from the followed point, axis k) reaches n·k k·e + |n × k| ρ, ρ its distance from the axis,
//! at most. The followed points move on straight lines, so the time until which a direction keeps two such sweeps apart
//! is a quotient, for all the rest of the query at once. Parts that cannot be told apart so are opened, down to
//! triangles; the earliest time at which two triangles' sweeps may come within the level is the answer.
//!
//! See docs/theory/engine.md, "Sweeps".

use crate::search::scene::{Scene, SceneBody};
use crate::tree::margin::{DOWN, UNIT_F32, UNIT_F64, UP};
use crate::tree::node::{Below, WIDTH};
use glam::{DVec2, DVec3};

/// Factor of the scene's size that covers all roundings here. Lengths below the size come out of fewer than a hundred
/// operations each: placing a point errs by 64·2⁻⁵³, an axis by 4·2⁻⁵³ of itself, turning a point into the axis' frame, its
/// distance from the axis, a reach and the gap by less than 200·2⁻⁵³ more.
pub(super) const SWEEP_ERROR: f64 = 4096.0 * UNIT_F64;
/// Axes of boxes are rounded to `f32` and orthonormal up to 5.2·2⁻²⁴ (docs/theory/engine.md): a box reaches no further
/// than its half extents say and this part of its radius.
const AXES_ERROR: f64 = 6.0 * UNIT_F32;
/// How much less the size of a part of a spinning body counts. Its parts are much like each other: they come last.
const SPINNING_SIZE: f64 = 1.0 / 1024.0;
/// A body that turns by less than this, in radians, is taken as at rest with an additional speed.
const STILL_ANGLE: f64 = 0.5;

/// Where a part of a body lies about its axis: heights and distances, bounds of what the points have.
#[derive(Clone, Copy, Debug)]
struct Ring {
    low: f64,
    high: f64,
    near: f64,
    far: f64,
}

impl Ring {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, near: f64::INFINITY, far: 0.0 };

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            near: self.near.min(other.near),
            far: self.far.max(other.far),
        }
    }

    /// Of a triangle, corners from a point of the axis, which is the third coordinate. The least distance from the axis
    /// counts for bodies that spin only.
    fn of(corners: &[DVec3; 3], spins: bool) -> Self {
        let [low, high] = [f64::min, f64::max].map(|f| f(f(corners[0].z, corners[1].z), corners[2].z));
        let flat = corners.map(DVec3::truncate);
        let squares = flat.map(DVec2::length_squared);
        let far = squares[0].max(squares[1]).max(squares[2]).sqrt();
        let near = if spins { nearest_square(&flat, &squares).sqrt() } else { 0.0 };
        Self { low, high, near, far }
    }
}

/// Square of the distance of the origin from a triangle in the plane, and the squares of the corners' distances.
fn nearest_square(flat: &[DVec2; 3], squares: &[f64; 3]) -> f64 {
    // With the edge, not with its end: a short edge does not magnify the rounding.
    let edges = [0, 1, 2].map(|k| flat[(k + 1) % 3] - flat[k]);
    let sides = [0, 1, 2].map(|k| flat[k].perp_dot(edges[k]));
    if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
        return 0.0;
    }
    let mut least = squares[0].min(squares[1]).min(squares[2]);
    for k in 0..3 {
        let (along, length) = (-flat[k].dot(edges[k]), edges[k].length_squared());
        if along > 0.0 && along < length {
            least = least.min(sides[k] * sides[k] / length);
        }
    }
    least
}

/// Distance of the origin from a triangle in a plane through it with normal `axis`.
pub(super) fn nearest(flat: &[DVec3; 3], axis: DVec3) -> f64 {
    let sides = [0, 1, 2].map(|k| flat[k].cross(flat[(k + 1) % 3]).dot(axis));
    if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
        return 0.0;
    }
    let mut least = f64::INFINITY;
    for k in 0..3 {
        let (p, e) = (flat[k], flat[(k + 1) % 3] - flat[k]);
        let along = (-p.dot(e) / e.length_squared()).clamp(0.0, 1.0);
        // An edge of one point gives 0/0.
        let foot = if along.is_nan() { p } else { p + e * along };
        least = least.min(foot.length());
    }
    least
}

/// One body over the rest of the query.
struct SweptBody<'a> {
    body: &'a SceneBody<'a>,
    /// Axes of the body and the tree's centre from the reference point, world axes, at the start.
    rotation: [DVec3; 3],
    arm: DVec3,
    /// Axis of the spin, or a direction of interest for a body at rest.
    axis: DVec3,
    spins: bool,
    /// Angular velocity that a body at rest has after all.
    turning: DVec3,
    /// Of each box, by number.
    rings: Vec<Ring>,
}

impl<'a> SweptBody<'a> {
    fn new(body: &'a SceneBody<'a>, spins: bool, start: f64, interest: DVec3) -> Self {
        let motion = &body.motion;
        let rotation = motion.rotation(start);
        let turn = |p: DVec3| rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z;
        Self {
            body,
            rotation,
            arm: turn(motion.arm()),
            axis: if spins { motion.turning().axis() } else { interest },
            spins,
            turning: if spins { DVec3::ZERO } else { motion.angular_velocity() },
            rings: Vec::new(),
        }
    }

    fn turn(&self, p: DVec3) -> DVec3 {
        let r = &self.rotation;
        r[0] * p.x + r[1] * p.y + r[2] * p.z
    }

    /// Corners of a triangle from the followed point.
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.body.corners(triangle).map(|p| self.turn(p) + self.arm)
    }

    /// Points (from the followed point) as seen along the axis, which becomes the third coordinate.
    fn seen_along_axis(&self) -> impl Fn(DVec3) -> DVec3 + use<> {
        let across = self.axis.any_orthonormal_vector();
        let rows = [across, self.axis.cross(across), self.axis];
        move |p| DVec3::from_array(rows.map(|row| row.dot(p)))
    }

    /// Fills in the rings of all boxes.
    fn measure(&mut self) {
        let (see, tree) = (self.seen_along_axis(), self.body.tree);
        let vertices = tree.mesh.vertices();
        let places: Vec<DVec3> =
            vertices.iter().map(|&p| see(self.turn(self.body.place(p)) + self.arm)).collect();
        self.rings = vec![Ring::NONE; tree.nodes.len() * WIDTH];
        self.measure_node(0, &places);
    }

    fn measure_node(&mut self, node: usize, places: &[DVec3]) -> Ring {
        let mut all = Ring::NONE;
        let tree = self.body.tree;
        for lane in 0..tree.nodes[node].used as usize {
            let ring = match tree.nodes[node].below(lane) {
                Below::Triangle(triangle) => {
                    let corners = tree.mesh.triangles()[triangle as usize];
                    Ring::of(&corners.map(|vertex| places[vertex as usize]), self.spins)
                }
                Below::Node(below) => self.measure_node(below as usize, places),
            };
            self.rings[node * WIDTH + lane] = ring;
            all = all.with(ring);
        }
        all
    }

    /// A triangle whatever box holds it.
    fn triangle(&self, triangle: u32) -> Part<'_> {
        let corners = self.corners(triangle);
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        Part {
            body: self,
            ring: Ring::of(&corners.map(self.seen_along_axis()), self.spins),
            center,
            axes: [DVec3::ZERO; 3],
            half: [0.0; 3],
            radius: corners.iter().map(|p| (*p - center).length()).fold(0.0, f64::max),
            corners: Some(corners),
            below: Below::Triangle(triangle),
            reach: self.reach_from_spin(&corners),
        }
    }

    fn part(&self, index: u32) -> Part<'_> {
        let (node, lane) = (&self.body.tree.nodes[index as usize / WIDTH], index as usize % WIDTH);
        let boxed = node.oriented_box(lane);
        let unit = self.body.box_unit();
        let local =
            DVec3::from_array([0, 1, 2].map(|k| f64::from(node.origin[k]) + f64::from(boxed.center[k])));
        let center = self.turn(local * unit) + self.arm;
        let below = node.below(lane);
        let corners = match below {
            Below::Triangle(triangle) => Some(self.corners(triangle)),
            Below::Node(_) => None,
        };
        let axes = boxed.axes.map(|axis| self.turn(DVec3::from_array(axis.map(f64::from))));
        let half = boxed.half_extent.map(|h| f64::from(h) * unit);
        let radius = f64::from(boxed.radius) * unit;
        let ring = self.rings[index as usize];
        let reach =
            corners.map_or_else(|| self.reach_from_spin(&[center]) + radius, |c| self.reach_from_spin(&c));
        Part { body: self, ring, center, axes, half, radius, corners, below, reach }
    }

    /// The largest distance of points from the axis about which a body at rest turns after all. It stays what it is.
    fn reach_from_spin(&self, points: &[DVec3]) -> f64 {
        let axis = self.body.motion.turning().axis();
        let across = |p: &DVec3| (*p - axis * axis.dot(*p)).length_squared();
        points.iter().map(across).fold(0.0, f64::max).sqrt()
    }
}

/// A box of a body, or a triangle.
struct Part<'b> {
    body: &'b SweptBody<'b>,
    ring: Ring,
    /// From the followed point, world axes at the start.
    center: DVec3,
    axes: [DVec3; 3],
    half: [f64; 3],
    radius: f64,
    corners: Option<[DVec3; 3]>,
    below: Below,
    /// The largest distance of its points from the axis of the spin, for a body at rest.
    reach: f64,
}

impl Part<'_> {
    /// The farthest that the part's sweep reaches along a unit direction, from the followed point.
    fn reach(&self, n: DVec3) -> f64 {
        // Each point is at most `far` from the axis at a height of the range.
        let along = n.dot(self.body.axis);
        let height = if along > 0.0 { along * self.ring.high } else { along * self.ring.low };
        let ring = height + (n - self.body.axis * along).length() * self.ring.far;
        if self.body.spins {
            return ring;
        }
        if let Some(corners) = &self.corners {
            return n.dot(corners[0]).max(n.dot(corners[1])).max(n.dot(corners[2]));
        }
        let boxed: f64 = (0..3).map(|i| self.half[i] * n.dot(self.axes[i]).abs()).sum();
        // Boxes are rounded to f32, the range of heights is not.
        (n.dot(self.center) + boxed + AXES_ERROR * self.radius).min(ring)
    }

    /// How far the part's points are from the axis of the other body, which goes through `from` (from the followed
    /// point) along `axis`; bounds over all the angles.
    fn distances(&self, from: DVec3, axis: DVec3) -> (f64, f64) {
        let across = |p: DVec3| p - axis * axis.dot(p);
        let apart = across(from);
        if self.body.spins {
            // Projections across two axes differ by the sine of the angle between them.
            let farthest = self.ring.far + self.ring.low.abs().max(self.ring.high.abs());
            let shift = apart.length() + self.body.axis.cross(axis).length() * farthest;
            return ((self.ring.near - shift).max(0.0), self.ring.far + shift);
        }
        if let Some(corners) = &self.corners {
            let flat = corners.map(|p| across(p - from));
            return (nearest(&flat, axis), flat.iter().map(|p| p.length()).fold(0.0, f64::max));
        }
        let middle = across(self.center - from).length();
        ((middle - self.radius).max(0.0), middle + self.radius)
    }

    /// What decides which part is opened.
    fn size(&self) -> f64 {
        if self.body.spins {
            SPINNING_SIZE * ((self.ring.high - self.ring.low) + (self.ring.far - self.ring.near))
        } else {
            self.radius
        }
    }
}

/// Two bodies over the rest of the query.
struct Sweep<'a> {
    bodies: [SweptBody<'a>; 2],
    /// Followed point of B from that of A at the start, and its velocity.
    apart: DVec3,
    velocity: DVec3,
    level: f64,
    length: f64,
}

/// The offset (≥ `start`, ≤ the end) up to which the sweeps stay further apart than the level, and
/// the number of pairs that were tested; none when they are not apart for at least `gain`, or when more than `most`
/// pairs are needed. `interest`: a direction that may separate bodies at rest. `suspects`: triangles that may be the reason for
/// winning nothing, so are looked at first.
pub(crate) fn swept_clear_until(
    scene: &Scene<'_>,
    start: f64,
    (gain, most): (f64, u64),
    interest: DVec3,
    suspects: [u32; 2],
) -> (Option<f64>, u64) {
    let end = scene.end;
    let spins = [&scene.a, &scene.b].map(|body| body.turns_by(end - start) > STILL_ANGLE);
    let interest = if spins[0] || spins[1] { scene.spin_axis().unwrap_or(interest) } else { interest };
    let bodies = [(&scene.a, spins[0]), (&scene.b, spins[1])]
        .map(|(body, spins)| SweptBody::new(body, spins, start, interest));
    let mut sweep = Sweep {
        bodies,
        apart: -scene.track.at(start),
        velocity: scene.b.motion.linear_velocity() - scene.a.motion.linear_velocity(),
        level: scene.pair.level + SWEEP_ERROR * (scene.size + scene.pair.level),
        length: (end - start).next_up(),
    };
    let [a, b] = [0, 1].map(|k| sweep.bodies[k].triangle(suspects[k]));
    if sweep.clear_for(&a, &b).is_none_or(|until| until < gain) {
        return (None, 1);
    }
    sweep.bodies.iter_mut().for_each(SweptBody::measure);
    let (clear, pairs) = sweep.earliest(gain, most);
    (clear.and_then(|clear| after(start, clear, sweep.length, end)), pairs)
}

/// The offset up to which bodies are apart that are so for `clear` from `start` on: the end if that is `length`; none
/// when no time is won.
pub(super) fn after(start: f64, clear: f64, length: f64, end: f64) -> Option<f64> {
    if clear >= length {
        return Some(end);
    }
    let until = (start + clear * DOWN).next_down();
    (until > start).then_some(until.min(end))
}

impl Sweep<'_> {
    /// The least of the times for which two triangles are apart, and how many pairs were tested.
    fn earliest(&self, gain: f64, most: u64) -> (Option<f64>, u64) {
        let (mut clear, mut pairs) = (self.length, 0);
        let mut stack = vec![(0u32, 0u32)];
        while let Some((a, b)) = stack.pop() {
            pairs += 1;
            let (part_a, part_b) = (self.bodies[0].part(a), self.bodies[1].part(b));
            let until = self.clear_for(&part_a, &part_b);
            if until.is_some_and(|until| until >= clear) {
                continue;
            }
            let open_a = match (part_a.below, part_b.below) {
                (Below::Triangle(_), Below::Triangle(_)) => {
                    let Some(until) = until.filter(|until| *until >= gain) else { return (None, pairs) };
                    clear = until;
                    continue;
                }
                (Below::Node(_), Below::Triangle(_)) => true,
                (Below::Triangle(_), Below::Node(_)) => false,
                (Below::Node(_), Below::Node(_)) => part_a.size() > part_b.size(),
            };
            if pairs >= most {
                return (None, pairs);
            }
            let below = |part: &Part<'_>| {
                let Below::Node(node) = part.below else { return 0..0 };
                let first = node * WIDTH as u32;
                first..first + part.body.body.tree.nodes[node as usize].used
            };
            if open_a {
                stack.extend(below(&part_a).map(|child| (child, b)));
            } else {
                stack.extend(below(&part_b).map(|child| (a, child)));
            }
        }
        (Some(clear), pairs)
    }

    /// For how long the sweeps of the parts stay further apart than the level, at most the length of the span; none when
    /// nothing tells them apart even now.
    fn clear_for(&self, a: &Part<'_>, b: &Part<'_>) -> Option<f64> {
        let mut best = None;
        // `gap` at the start, which changes at `rate`, less the speed that parts of bodies at rest have along n or at all.
        let mut take = |gap: f64, rate: f64, speed: f64| {
            let room = gap - self.level;
            if room > 0.0 {
                let closing = speed * UP - rate;
                let until = if closing * UP * self.length <= room { self.length } else { room / closing };
                if best.is_none_or(|best| until > best) {
                    best = Some(until);
                }
            }
        };
        // |n·(ω × e)| = |(n × ω)·e|, and what e has along ω does not count.
        let speed_along = |part: &Part<'_>, n: DVec3| n.cross(part.body.turning).length() * part.reach;
        let mut along = |n: DVec3| {
            let forward = n.dot(self.apart);
            let drift = n.dot(self.velocity);
            let speed = speed_along(a, n) + speed_along(b, n);
            take(forward - b.reach(-n) - a.reach(n), drift, speed);
            take(-forward - b.reach(n) - a.reach(-n), -drift, speed);
        };
        let unit = |v: DVec3| v.normalize_or_zero();
        for part in [a, b] {
            along(part.body.axis);
            if !part.body.spins {
                match &part.corners {
                    Some(c) => along(unit((c[1] - c[0]).cross(c[2] - c[0]))),
                    None => part.axes.iter().for_each(|&axis| along(unit(axis))),
                }
            }
        }
        let center = |part: &Part<'_>| {
            if part.body.spins {
                part.body.axis * (0.5 * (part.ring.low + part.ring.high))
            } else {
                part.center
            }
        };
        let line = center(b) + self.apart - center(a);
        along(unit(line));
        for part in [a, b] {
            if part.body.spins {
                along(unit(line - part.body.axis * line.dot(part.body.axis)));
            }
        }
        // One inside the hole of the other: distances from the other's axis.
        for (inner, outer, from) in [(a, b, self.apart), (b, a, -self.apart)] {
            if outer.body.spins {
                let axis = outer.body.axis;
                let (near, far) = inner.distances(from, axis);
                let drift = (self.velocity - axis * axis.dot(self.velocity)).length() * UP;
                let speed = inner.body.turning.length() * inner.reach;
                take(outer.ring.near - far, -drift, speed);
                take(near - outer.ring.far, -drift, speed);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::motion::local_motion::LocalMotion;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_feature::triangle_distance;
    use d2m_motion::ConstantTwist;
    use glam::DQuat;

    /// A closed box.
    fn cuboid(half: DVec3) -> MeshTree {
        let corner = |i: u32| {
            half * (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0)
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        MeshTree::new(TriMesh::try_new((0..8).map(corner).collect(), halves.collect()).unwrap())
    }

    /// The time up to which the sweeps are apart, from 0 in the window [0, 1].
    fn clear(a: (&MeshTree, ConstantTwist), b: (&MeshTree, ConstantTwist), interest: DVec3) -> f64 {
        let options = QueryOptions::default().with_tolerance(1e-10);
        let scene = Scene::new(a, b, Window::UNIT, &options);
        swept_clear_until(&scene, 0.0, (0.0, 1 << 20), interest, [0, 0]).0.unwrap_or(0.0)
    }

    fn at(x: DVec3, v: DVec3, w: DVec3) -> ConstantTwist {
        ConstantTwist::try_new(x, DQuat::IDENTITY, v, w).unwrap()
    }

    /// Each bound of the reach of a sweep, at a millionth on either side of a touch.
    #[test]
    fn sweeps_reach_exactly_as_far_as_the_bodies() {
        let (cube, thin) = (cuboid(DVec3::ONE), cuboid(DVec3::new(0.1, 3.0, 3.0)));
        let (fast, o) = (DVec3::Z * 300.0, DVec3::ZERO);
        let far = 2f64.sqrt() + 0.1;
        for (gap, apart) in [(1e-6, true), (-1e-6, false)] {
            // The corners of a spinning cube along a wall, the cube's top below a plate, and the other body spinning.
            let wall = |x: DVec3| (&thin, at(x, o, o));
            let cases = [
                clear((&cube, at(o, o, fast)), wall(DVec3::X * (far + gap)), DVec3::Y),
                clear(wall(DVec3::X * (far + gap)), (&cube, at(o, o, fast)), DVec3::Y),
                clear((&cube, at(o, o, DVec3::X * 40.0)), wall(DVec3::X * (1.1 + gap)), DVec3::Y),
            ];
            for (case, until) in cases.into_iter().enumerate() {
                assert_eq!(until == 1.0, apart, "case {case}, gap {gap}: {until}");
            }
        }
    }

    /// A post that spins in a square hole, and the frame of the hole that spins about a post.
    #[test]
    fn sweeps_inside_a_hole() {
        let (bar, post) = (cuboid(DVec3::new(1.0, 0.1, 1.0)), cuboid(DVec3::new(0.5, 0.5, 2.0)));
        let (spin, o) = (DVec3::Z * 50.0, DVec3::ZERO);
        for (gap, apart) in [(1e-6, true), (-1e-6, false)] {
            let out = 0.5f64.sqrt() + 0.1 + gap;
            // The bar's inner wall at the post's corner; B's axis is A's.
            let beside = ConstantTwist::try_new(o, DQuat::IDENTITY, o, spin)
                .unwrap()
                .try_with_at(DVec3::Y * -out)
                .unwrap();
            for other in [o, spin * 0.5] {
                let until = clear((&bar, beside), (&post, at(o, o, other)), DVec3::X);
                assert_eq!(until == 1.0, apart, "gap {gap}, the other turns by {other}: {until}");
            }
        }
    }

    /// Drift of a spinning body, and what a slow turn adds, end a sweep's time where they should.
    #[test]
    fn sweeps_end_in_time() {
        let (cube, thin) = (cuboid(DVec3::ONE), cuboid(DVec3::new(0.1, 3.0, 3.0)));
        let o = DVec3::ZERO;
        let wall = DVec3::X * (2f64.sqrt() + 0.1 + 0.25);
        let until =
            clear((&cube, at(o, DVec3::X * 0.5, DVec3::Z * 100.0)), (&thin, at(wall, o, o)), DVec3::Y);
        assert!(until < 0.5 && until > 0.5 - 1e-6, "{until}");
        // The wall turns by 0.1 about its middle: its end, 3 away, comes closer by 0.3.
        let far = wall + DVec3::X * 0.02;
        let until = clear((&cube, at(o, o, DVec3::Z * 100.0)), (&thin, at(far, o, DVec3::Z * 0.1)), DVec3::Y);
        assert!(until < 0.95 && until > 0.5, "{until}");
    }

    #[test]
    fn nothing_meets_while_sweeps_are_apart() {
        let mut seed = 5u64;
        let mut next = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
        };
        let (mut won, mut least) = (0, f64::INFINITY);
        for round in 0..600 {
            let mut vec = || DVec3::new(next(), next(), next());
            let (a, b) = (cuboid(vec().abs() * 0.5 + 0.05), cuboid(vec().abs() * 0.5 + 0.05));
            let spin = [0.2, 3.0, 30.0];
            let mut motion = |place: f64, spin: f64| {
                let q = DQuat::from_xyzw(vec().x, vec().x, vec().y, 1.2);
                ConstantTwist::try_new(vec() * place, q, vec() * 0.5, vec() * spin)
                    .unwrap()
                    .try_with_at(vec() * 0.3)
                    .unwrap()
            };
            let motions = [motion(2.5, spin[round % 3]), motion(0.0, spin[round / 3 % 3])];
            let until = clear((&a, motions[0]), (&b, motions[1]), DVec3::Y);
            won += u32::from(until > 0.0);
            let world = |tree: &MeshTree, motion: &ConstantTwist, t: f64| -> Vec<[DVec3; 3]> {
                let turn = LocalMotion::unscaled(motion).rotation(t);
                let x = motion.position() + motion.linear_velocity() * t;
                let place = |p: DVec3| turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + x;
                (0..12).map(|k| tree.mesh().corners(k).map(|p| place(p - motion.at()))).collect()
            };
            for k in 0..12 {
                let t = until * f64::from(k) / 11.0;
                let (ta, tb) = (world(&a, &motions[0], t), world(&b, &motions[1], t));
                for (s, t) in ta.iter().flat_map(|s| tb.iter().map(move |t| (s, t))) {
                    let found = triangle_distance(s, t).lower;
                    if until > 0.0 {
                        least = least.min(found);
                    }
                }
            }
        }
        assert!(least > 1e-10 - 1e-13 && won > 150, "{least} {won}");
    }
}
