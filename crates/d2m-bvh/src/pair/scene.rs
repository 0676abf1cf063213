//! Constants of one query.

use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::motion::frame::RelativeMotion;
use crate::pair::motion::local_motion::LocalMotion;
use crate::pair::motion::track::Track;
use crate::pair::motion::units::Units;
use crate::pair::triangles::pair_scale::PairScale;
use crate::{MeshTree, QueryError, QueryOptions, Solid, Window};
use d2m_lanes::power_of_two;
use d2m_mesh::margin::{DOWN, NARROW_UP, UNIT_F64, UP, round_up};
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// Factor of the error of a projected gap of two triangles; see docs/theory/engine.md.
const TRIANGLE_ERROR: f64 = 128.0 * UNIT_F64;
/// Factor of the error of frames, for node tests.
const FRAME_ERROR: f64 = 256.0 * UNIT_F64;
/// Far frames err by at most so many times as much.
const FAR_FRAMES: f64 = 4.0;
/// Where the fastest points are below this in the unit of a node test, no sum of products of speeds and coordinates overflows in
/// `f32`. Centers of boxes, also of those from files, are at most 16 times as far from a point of their body as what they
/// enclose, so the velocity between two centers is below 2⁶ times the fastest point's: 2⁶² here. The line of the centers is shorter
/// than 2⁶⁴ (else its square is infinite, and the gap along it is not a number). So no partial sum of their scalar product is above 2¹²⁶.
///
/// What moves by 2⁵⁶ of a body's sizes in a sub-window is known to 2⁻⁴⁵ of that, so boxes of that body prove nothing anyway.
const MOST_SPEED: f64 = power_of_two(56);
/// Factor of the error of the distance of two spheres: positions err by less than 64·2⁻⁵³ of the size, and the few
/// operations after that by less.
const SPHERE_ERROR: f64 = 128.0 * UNIT_F64;
/// Relative positions are sums of pairs: they err by less than 2⁻¹⁰⁰ of their terms. That is below 2⁻⁵² of a size which
/// is at least this part of the terms.
const PAIR_ERROR: f64 = 1.0 / 281_474_976_710_656.0; // 2⁻⁴⁸
/// Least size: of bodies that are points at one place.
const LEAST_SIZE: f64 = 1.0 / 18_446_744_073_709_551_616.0; // 2⁻⁶⁴
/// δ is at least so many errors of a gap: one on either side of it.
const LEAST_TOLERANCE_ERRORS: f64 = 2.0;
/// Part of δ that pairs are advanced to above the level. Large against roundings, small against δ.
const SLACK: f64 = 1.0 / 64.0;
/// Most rotation, both bodies together, inside one sub-window: frames hold for 0.35 radians.
pub(crate) const WINDOW_ANGLE: f64 = 0.3;
/// A spin below this (radians in a unit of time) loses part of its speed to underflow if it acts for long: it is refused
/// unless the angle is below all roundings.
const LEAST_SPIN: f64 = power_of_two(-900);
/// See [`LEAST_SPIN`]: below 2⁻⁶⁴ radians.
const UNSEEN_ANGLE: f64 = 1.0 / 18_446_744_073_709_551_616.0;
/// Longest length of a scene, in the unit of the meshes: what is computed from it stays below the largest number.
const MOST_LENGTH: f64 = power_of_two(1000);

/// A tree and how it moves, as the caller gives them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingTree<'a> {
    pub(crate) tree: &'a MeshTree,
    pub(crate) twist: ConstantTwist,
}

/// A body and its motion, in the units of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneBody<'a> {
    pub(crate) tree: &'a MeshTree,
    pub(crate) motion: LocalMotion,
    /// The motion as it was given.
    #[cfg(feature = "audit")]
    pub(crate) given: ConstantTwist,
    /// One over the unit of length.
    per_length: f64,
}

impl<'a> SceneBody<'a> {
    #[inline(always)]
    fn new(tree: &'a MeshTree, given: &ConstantTwist, units: &Units, start: f64) -> Self {
        let motion = LocalMotion::new(given, tree.center(), start, units);
        Self {
            tree,
            motion,
            #[cfg(feature = "audit")]
            given: *given,
            per_length: 1.0 / units.length(),
        }
    }

    /// Corners relative to the tree's center, body axes.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [i, j, k] = self.tree.mesh().triangles()[triangle as usize];
        let vertices = self.tree.mesh().vertices();
        // Written out: a closure mapped over the array is not inlined into code for other instruction sets.
        [self.place(vertices[i as usize]), self.place(vertices[j as usize]), self.place(vertices[k as usize])]
    }

    /// A point of the body, relative to the tree's center.
    #[inline(always)]
    pub(crate) fn place(&self, point: DVec3) -> DVec3 {
        (point - self.tree.center()) * self.per_length
    }

    /// The unit of the tree's boxes.
    pub(crate) fn box_unit(&self) -> f64 {
        self.tree.unit() * self.per_length
    }

    /// Bound on the distance of the body's points from the reference point in use, and so from the axis of the spin.
    pub(crate) fn reach(&self) -> f64 {
        self.tree.radius() * self.per_length + self.motion.arm().length()
    }

    /// The same for the reference point that was given.
    pub(crate) fn given_reach(&self) -> f64 {
        self.tree.radius() * self.per_length + self.motion.given_arm().length()
    }

    /// The angle that it turns by in a time.
    pub(crate) fn turns_by(&self, time: f64) -> f64 {
        self.spin() * time
    }

    pub(crate) fn spin(&self) -> f64 {
        self.motion.turning().speed()
    }
}

/// Two bodies, their motions, and the bounds that hold over the whole query. All in the units of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingScene<'a> {
    pub(crate) a: SceneBody<'a>,
    pub(crate) b: SceneBody<'a>,
    /// Reference point of A from that of B.
    pub(crate) track: Track,
    pub(crate) window: Window,
    /// What counts as contact with each body.
    pub(crate) solids: [Solid; 2],
    pub(crate) units: Units,
    /// The offset of the end of the window, not early.
    pub(crate) end: f64,
    pub(crate) pair: PairScale,
    /// Bound on every length that enters a position.
    pub(crate) size: f64,
    /// δ that is used.
    pub(crate) tolerance: f64,
    /// Longest sub-window of the search.
    pub(crate) longest: f64,
    /// Reach of both bodies from their reference points, together.
    reach: f64,
    /// |ω|·ρ of both bodies, ρ the largest distance from the reference point.
    pub(crate) spin_speed: f64,
}

impl<'a> MovingScene<'a> {
    /// The scene of a query with options that were checked.
    ///
    /// # Errors
    /// [`QueryError::BadMotion`] where rounding cannot be bounded.
    #[inline]
    pub(crate) fn try_new(
        a: MovingTree<'a>,
        b: MovingTree<'a>,
        window: Window,
        options: &QueryOptions,
    ) -> Result<Self, QueryError> {
        let units = units_of([&a, &b], window).ok_or_else(|| {
            let far = |m: &ConstantTwist| m.linear_velocity().length() + m.position().length();
            QueryError::BadMotion { body: usize::from(far(&b.twist) > far(&a.twist)) }
        })?;
        Self::in_units([a, b], window, options, units)
    }

    // Bodies and scenes are large: written out and inlined, they are built in place.
    #[inline(always)]
    fn in_units(
        [a, b]: [MovingTree<'a>; 2],
        window: Window,
        options: &QueryOptions,
        units: Units,
    ) -> Result<Self, QueryError> {
        let start = window.start();
        let (a, b) = (
            SceneBody::new(a.tree, &a.twist, &units, start),
            SceneBody::new(b.tree, &b.twist, &units, start),
        );
        let end = units.end_up();
        for (body, it) in [&a, &b].into_iter().enumerate() {
            // Also what is not a number is refused.
            let bounded = it.motion.angle(end) < QueryError::MOST_ANGLE && it.motion.terms() < f64::INFINITY;
            let slow = it.spin() >= LEAST_SPIN || it.motion.angle(end) <= UNSEEN_ANGLE;
            if !(bounded && slow) {
                return Err(QueryError::BadMotion { body });
            }
        }
        let track = Track::new(&a.motion, &b.motion);
        let apart = track.at(0.0).length().max(track.at(end).length());
        let (reach_a, reach_b) = (a.reach(), b.reach());
        let spin_speed = a.spin() * reach_a + b.spin() * reach_b;
        let angle = a.spin() + b.spin();
        let longest = if angle * end > WINDOW_ANGLE { WINDOW_ANGLE / angle } else { end };
        let velocity = (a.motion.linear_velocity() - b.motion.linear_velocity()).length();
        let moved = a.motion.shift().length() + b.motion.shift().length();
        let size = reach_a + reach_b + moved + apart + (velocity + spin_speed) * longest;
        let size = size.max(PAIR_ERROR * (a.motion.terms() + b.motion.terms())).max(LEAST_SIZE);
        let mut scene = Self {
            a,
            b,
            track,
            window,
            solids: [options.solid; 2],
            units,
            end,
            pair: PairScale::default(),
            size,
            tolerance: 0.0,
            longest,
            reach: reach_a + reach_b,
            spin_speed,
        };
        scene.set_options(options);
        if scene.rounding_hides_the_bodies(options) {
            let body = usize::from(scene.b.motion.terms() > scene.a.motion.terms());
            return Err(QueryError::BadMotion { body });
        }
        Ok(scene)
    }

    /// Is the least tolerance that rounding allows larger than the bodies, than what is between them at the start, and than
    /// the tolerance of the options? Then the bodies are within it from the start, whatever they do.
    fn rounding_hides_the_bodies(&self, options: &QueryOptions) -> bool {
        let per_length = 1.0 / self.units.length();
        let bodies = self.a.tree.radius().max(self.b.tree.radius()) * per_length;
        let tolerance = options.tolerance.unwrap_or(0.0) * per_length;
        let known = bodies.max(tolerance).max(self.track.at(0.0).length());
        known > 0.0 && LEAST_TOLERANCE_ERRORS * self.pair.error > known
    }

    /// The same scene with other options.
    pub(crate) fn with_options(&self, options: &QueryOptions) -> Self {
        let mut scene = *self;
        scene.set_options(options);
        scene
    }

    fn set_options(&mut self, options: &QueryOptions) {
        let (a, b) = (&self.a, &self.b);
        let error = TRIANGLE_ERROR * self.size;
        let to_length = |length: f64| length * (1.0 / self.units.length());
        // Of the radius in its own unit: a part of one that is tiny in the scene's unit would be rounded.
        let radius = to_length(a.tree.radius().max(b.tree.radius()));
        let wanted = options.tolerance.map_or_else(|| options.tolerance_of(radius), to_length);
        self.tolerance = wanted.max(LEAST_TOLERANCE_ERRORS * error);
        let level = to_length(options.min_separation) + self.tolerance;
        let centripetal = [a, b].map(|body| body.spin() * body.spin() * body.reach() * UP);
        self.pair = PairScale {
            level,
            error,
            stop: level + self.tolerance + error,
            slack: SLACK * self.tolerance,
            acceleration: (centripetal[0] + centripetal[1]) * UP,
            arms: [a.motion.arm(), b.motion.arm()],
            centripetal,
        };
    }

    /// Are the spheres about the reference points that hold the bodies apart at the start?
    pub(crate) fn spheres_are_apart_at_start(&self) -> bool {
        self.track.at(0.0).length() > self.reach + SPHERE_ERROR * self.size
    }

    /// The motion over the sub-window of a search that begins at `start`.
    pub(crate) fn relative_motion(&self, start: f64) -> RelativeMotion {
        RelativeMotion::new([&self.a.motion, &self.b.motion], &self.track, start)
    }

    /// What far frames err by more than others, which the floor of [`NodeScale`] covers.
    pub(crate) fn far_frame_error(&self) -> f64 {
        (FAR_FRAMES - 1.0) * FRAME_ERROR * self.size
    }

    /// The speed of the reference points against each other.
    pub(crate) fn closing_speed(&self) -> f64 {
        (self.a.motion.linear_velocity() - self.b.motion.linear_velocity()).length()
    }

    /// In the units of the caller, for tests.
    #[cfg(test)]
    pub(crate) fn new(
        a: (&'a MeshTree, ConstantTwist),
        b: (&'a MeshTree, ConstantTwist),
        window: Window,
        options: &QueryOptions,
    ) -> Self {
        let units = Units::new(window, 1.0, 1.0);
        let [a, b] = [a, b].map(|(tree, twist)| MovingTree { tree, twist });
        Self::in_units([a, b], window, options, units).expect("a motion with bounded rounding")
    }

    /// Axis of the body that spins faster, world; none if neither does.
    pub(crate) fn spin_axis(&self) -> Option<DVec3> {
        let faster = if self.a.spin() >= self.b.spin() { &self.a } else { &self.b };
        let axis = faster.motion.turning().axis();
        (axis != DVec3::ZERO).then_some(axis)
    }

    /// An offset, not before `start`, up to which the spheres about the reference points (whatever the rotation) stay
    /// further apart than the level.
    pub(crate) fn spheres_clear_until(&self, start: f64) -> f64 {
        let apart = self.track.at(start).length();
        let room = apart - self.reach - self.pair.level - SPHERE_ERROR * self.size;
        let speed = (self.a.motion.linear_velocity() - self.b.motion.linear_velocity()).length() * UP;
        if room.is_nan() || room <= 0.0 {
            start
        } else if speed * (self.end - start) < room {
            self.end
        } else {
            (start + room / speed * DOWN).next_down().clamp(start, self.end)
        }
    }

    /// Constants of the node tests of a sub-window, with the first body's nodes expanded, then the second's.
    pub(crate) fn node_scales(&self, time_unit: f64) -> [NodeScale; 2] {
        let spins = [&self.a, &self.b].map(|body| round_up(body.spin() * time_unit * NARROW_UP));
        let one = |wide: &SceneBody<'_>, single: &SceneBody<'_>, spin: [f32; 2]| {
            let inverse_unit = 1.0 / wide.box_unit();
            let speed_scale = time_unit * inverse_unit;
            let acceleration = self.pair.acceleration * time_unit * speed_scale * NARROW_UP;
            let fastest = (self.spin_speed + self.size / time_unit) * speed_scale;
            let speed_floor = if fastest < MOST_SPEED { FRAME_ERROR * fastest } else { f64::INFINITY };
            NodeScale {
                ratio: single.box_unit() * inverse_unit,
                inverse_unit,
                speed_scale,
                time_unit,
                spin,
                floor: round_up((self.pair.level * NARROW_UP + FRAME_ERROR * self.size) * inverse_unit),
                speed_floor: round_up(speed_floor),
                acceleration: round_up(acceleration),
            }
        };
        [one(&self.a, &self.b, spins), one(&self.b, &self.a, [spins[1], spins[0]])]
    }
}

/// Units in which the lengths of a scene are about one: lengths are measured by their largest coordinates, so nothing
/// over- or underflows on the way. `None` when the scene has lengths that are not numbers, or larger than the largest
/// unit.
fn units_of(bodies: [&MovingTree<'_>; 2], window: Window) -> Option<Units> {
    let largest = |v: DVec3| v.abs().max_element();
    let [MovingTree { tree: tree_a, twist: a }, MovingTree { tree: tree_b, twist: b }] = bodies;
    let [arm_a, arm_b] = bodies.map(|body| largest(body.tree.center() - body.twist.at()));
    let since = |motion: &ConstantTwist| window.start() - motion.reference_time();
    // At rest the time means nothing.
    let travelled = |motion: &ConstantTwist| {
        let velocity = motion.linear_velocity();
        if velocity == DVec3::ZERO { DVec3::ZERO } else { velocity * since(motion) }
    };
    let apart = largest((a.position() - b.position()) + (travelled(a) - travelled(b)));
    let speed = largest(a.linear_velocity() - b.linear_velocity());
    let resting = tree_a.radius().max(tree_b.radius()).max(arm_a).max(arm_b).max(apart);
    let spin = largest(a.angular_velocity()).max(largest(b.angular_velocity()));
    // A window of no length gets the time in which the bodies move by about their size.
    let time = if window.length() > 0.0 { window.length() } else { 1.0 / (speed / resting).max(spin) };
    let time = if time.is_finite() && time > 0.0 { time } else { 1.0 };
    let length = resting.max(speed * window.length());
    let all = [resting, length, apart, arm_a, arm_b];
    all.iter().all(|x| *x <= MOST_LENGTH).then(|| Units::new(window, time, length))
}
