//! Proofs that two bodies stay apart in their flights, which cost less than a query.
//!
//! **From spheres** about their centers, which move with constant velocities, however the bodies turn.
//!
//! **From a distance.** Let the bodies be at least d apart in poses (x, q). In other poses (x', q') a point
//! is displaced by no more than |x' − x| + ρ 2 |q' − q|, with the radius ρ about the center x, and with that
//! of the quaternions ±q which is nearer to q': the chord to an angle θ between rotations is 2 sin(θ/2) ≤ 4
//! sin(θ/4) = 2 |q' − q|. Of the displacements of the centers only the difference counts. From there on,
//! flights of length τ with the velocities v and ω bring points closer by
//! v_b − v_a| τ + (ρ_a |ω_a| + ρ_b |ω_b|) τ at most.
//!
//! **From a direction.** Take axes that turn with w about the center of a. A body with the angular velocity
//! ω, whose center is D away and moves with V, has a point r whose coordinate along a direction n of these
//! axes is
//!
//! ```text
//! n·(D + r) + n·(V − w × D + Ω × r) t + remainder,    Ω = ω − w
//! |remainder| ≤ ½ t² ((|Ω| + |w|) |Ω| ρ + |w|² (|D| + |V| t) + 2 |w| |V|)
//! ```
//!
//! because the point's acceleration there is Ω × (Ω × r) + (Ω × w) × r + w × (w × D(t)) − 2 w × V. The
//! minimum of the linear parts over the vertices of b less the maximum over those of a is a concave function
//! of t, so its minimum is at an end of the flight. Bodies are in the convex hulls of their vertices, or
//! within their radius of these.

use crate::body::rigid_body::RigidBody;
use crate::pairs::part_of_flight::proven_until;
use d2m_bvh::Window;
use d2m_feature::MovingSphere;
use d2m_motion::Pose;
use glam::{DMat3, DQuat, DVec3};

/// The rounding of a bound, relative to the sizes of the numbers from which it is computed: position (a
/// product and a sum) and turn of a flight, a placed vertex (norm of the quaternion, nine products of three,
/// two sums), its velocity, lengths, products and sums, fewer than 128 operations of relative error 2⁻⁵³
/// each, doubled.
pub(crate) const ROUNDING: f64 = 128.0 * f64::EPSILON;

/// The error where one flight joins the next, relative to the same sizes, 2⁻⁴⁸: of relative size 2⁻⁵³ each,
/// the rounding of the time since the flight began, of its displacement and its position, and fewer than 24
/// of its turn. Bodies that stay further apart in their flights are so where the next ones begin, too.
pub(crate) const JOIN: f64 = 16.0 * f64::EPSILON;

/// The most vertices of both bodies together that are placed: so many cost a tenth of a query.
const FEW: usize = 64;

impl RigidBody {
    /// Encloses the body in its flight, for times since the reference time of the flight.
    pub(crate) fn sphere(&self) -> MovingSphere {
        let (center, velocity) = (self.flight.position(), self.flight.linear_velocity());
        MovingSphere { center, velocity, radius: self.radius }
    }

    /// A bound on the distance of its points from the origin, from `now` on for a time `tau`, in any flight
    /// of its speed.
    pub(crate) fn extent(&self, now: f64, tau: f64) -> f64 {
        let way = (now - self.flight.reference_time()).abs() + tau;
        self.flight.position().length() + self.surface_speed() * way + self.radius
    }

    /// The same, for times since this one.
    pub(crate) fn sphere_at(&self, time: f64) -> MovingSphere {
        self.sphere().after(time - self.flight.reference_time())
    }
}

/// Are two bodies proven further apart than `gap` in their present flights, from `time` to `end`, by the spheres about their
/// centers alone? No when a number is not finite.
pub(crate) fn are_spheres_apart(a: &RigidBody, b: &RigidBody, time: f64, end: f64, gap: f64) -> bool {
    let least = gap.max(JOIN * sizes([a, b], time, end - time));
    a.sphere_at(time).stays_apart(&b.sphere_at(time), least, end - time)
}

/// Two bodies at their poses of a time of their flights.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'s> {
    pub(crate) bodies: [&'s RigidBody; 2],
    pub(crate) poses: [Pose; 2],
    pub(crate) now: f64,
}

impl<'s> Placed<'s> {
    pub(crate) fn at(bodies: [&'s RigidBody; 2], now: f64) -> Self {
        Self { bodies, poses: bodies.map(|body| body.pose_at(now)), now }
    }
}

/// Two bodies are at least `distance` apart in these poses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clearance {
    pub(crate) poses: [Pose; 2],
    pub(crate) distance: f64,
}

impl Clearance {
    /// A lower bound of the distance of the bodies in their flights from their present poses on, for a time
    /// `tau`.
    pub(crate) fn bound(&self, placed: &Placed<'_>, tau: f64) -> f64 {
        let Placed { bodies, poses, now } = *placed;
        let (mut offset, mut turned) = (DVec3::ZERO, 0.0);
        for (k, body) in bodies.into_iter().enumerate() {
            let (old, new) = (&self.poses[k], &poses[k]);
            offset += (new.translation - old.translation) * [-1.0, 1.0][k];
            turned += 2.0 * between(new.rotation, old.rotation) * body.radius;
        }
        let placed: f64 = self.poses.iter().map(|pose| pose.translation.length()).sum();
        let lost = ROUNDING * (placed + self.distance + sizes(bodies, now, tau));
        self.distance - offset.length() - turned - approach(bodies) * tau - lost
    }
}

/// The smaller one of |q − r| and |q + r|.
fn between(q: DQuat, r: DQuat) -> f64 {
    (q - r).length().min((q + r).length())
}

/// A bound on the speed at which points of two bodies approach each other.
pub(crate) fn approach([a, b]: [&RigidBody; 2]) -> f64 {
    let spin = |body: &RigidBody| body.flight.angular_velocity().length() * body.radius;
    (b.flight.linear_velocity() - a.flight.linear_velocity()).length() + spin(a) + spin(b)
}

/// The sum of the lengths that enter a bound.
pub(crate) fn sizes(bodies: [&RigidBody; 2], now: f64, tau: f64) -> f64 {
    bodies.into_iter().map(|body| body.extent(now, tau)).sum()
}

/// Are their vertices few enough to be placed?
pub(crate) fn have_few_vertices(bodies: [&RigidBody; 2]) -> bool {
    bodies.iter().map(|body| body.tree.mesh().vertex_count()).sum::<usize>() <= FEW
}

/// Until when two bodies are proven further apart than `needed` in a window of their flights, along a
/// direction from a to b. It is about the unit vector `normal` at first, and turns with one of them or
/// halfway between. The time is no earlier than the start of the window.
///
/// What the bound loses by turning grows with the square of the time, so where the window is too long parts
/// of it are tried.
pub(crate) fn apart_along_until(normal: DVec3, bodies: [&RigidBody; 2], window: Window, needed: f64) -> f64 {
    let [a, b] = bodies.map(|body| body.flight.angular_velocity());
    let begun = Placed::at(bodies, window.start());
    let is_apart = |spin: DVec3, from: f64, to: f64| {
        let turned = (normal + spin.cross(normal) * (from - window.start())).normalize();
        let placed = if from == begun.now { begun } else { Placed::at(bodies, from) };
        bound_along(turned, spin, &placed, to - from).is_some_and(|bound| bound > needed)
    };
    let mut until = window.start();
    for spin in [a, b, (a + b) * 0.5] {
        if until < window.end() {
            until = until.max(proven_until(window, |from, to| is_apart(spin, from, to)));
        }
    }
    until
}

/// A lower bound of the distance of two bodies along a direction in their flights from their present poses
/// on, for a time `tau`. The direction from a to b is the unit vector `normal` at first and then turns with
/// `spin`. None: they have too many vertices to place.
pub(crate) fn bound_along(normal: DVec3, spin: DVec3, placed: &Placed<'_>, tau: f64) -> Option<f64> {
    let Placed { bodies, poses, now } = *placed;
    if !have_few_vertices(bodies) {
        return None;
    }
    let offset = poses[1].translation - poses[0].translation;
    let velocity = bodies[1].flight.linear_velocity() - bodies[0].flight.linear_velocity();
    let start = normal.dot(offset);
    // At the start and at the end of the linear motion.
    let mut apart = [start, start + normal.dot(velocity - spin.cross(offset)) * tau];
    let (w, speed) = (spin.length(), velocity.length());
    let mut acceleration = w * w * (offset.length() + speed * tau) + 2.0 * w * speed;
    for ((body, pose), sign) in bodies.into_iter().zip(&poses).zip([-1.0, 1.0]) {
        let direction = normal * sign;
        let turning = body.flight.angular_velocity() - spin;
        // n·(Ω × r) = (n × Ω)·r, in the mesh frame.
        let turn = DMat3::from_quat(pose.rotation.conjugate());
        let (across, lever) = (turn * direction, turn * direction.cross(turning) * tau);
        let mut nearest = [f64::INFINITY; 2];
        for &vertex in body.tree.mesh().vertices() {
            let arm = vertex - body.center;
            let place = across.dot(arm);
            nearest[0] = nearest[0].min(place);
            nearest[1] = nearest[1].min(place + lever.dot(arm));
        }
        apart[0] += nearest[0] - body.rounding;
        apart[1] += nearest[1] - body.rounding;
        acceleration += (turning.length() + w) * turning.length() * body.radius;
    }
    let lost = ROUNDING * sizes(bodies, now, tau) * (1.0 + w * tau);
    Some(apart[0].min(apart[1]) - 0.5 * acceleration * tau * tau - lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use d2m_bvh::{MeshTree, Posed, Solid, distance};
    use d2m_contact::Velocity;
    use d2m_mesh::Faces;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};
    use std::sync::Arc;

    /// A box of these half sides, at time 1.
    fn flying(size: DVec3, place: DVec3, turn: DQuat, velocity: Velocity) -> RigidBody {
        let shape = format!("box?x={}&y={}&z={}", size.x, size.y, size.z);
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh(&shape).unwrap()));
        let described = Body::new("", Arc::clone(&tree)).with_position(place).with_orientation(turn);
        let mut body = RigidBody::try_new(&described, Arc::new(Faces::new(tree.mesh())), 1.0).unwrap();
        body.fly(velocity, f64::INFINITY);
        body
    }

    fn any(place: DVec3, speed: f64, state: &mut KnuthRandom) -> RigidBody {
        let size = state.vector().abs() + DVec3::splat(0.2);
        let turn = DQuat::from_xyzw(state.signed(), state.signed(), state.signed(), state.signed() + 1.5);
        let velocity = Velocity { linear: state.vector() * speed, angular: state.vector() * 5.0 };
        flying(size, place, turn, velocity)
    }

    fn apart(bodies: [&RigidBody; 2], time: f64) -> f64 {
        let [a, b] = bodies.map(|body| Posed::new(&body.tree, body.pose_at(time)));
        distance(a, b, Solid::Filled).unwrap().upper
    }

    /// No bound is larger than the distance at any time of the flights.
    #[test]
    fn bounds_are_no_more_than_the_distance() {
        let state = &mut KnuthRandom(1);
        let (mut held, mut close) = ([0; 2], [0; 2]);
        for k in 0..600 {
            let speed = [1.0, 20.0][k % 2];
            let (a, b) = (any(DVec3::ZERO, speed, state), any(DVec3::X * 3.0, speed, state));
            let bodies = [&a, &b];
            let (now, tau) = (1.0 + 0.1 * state.signed().abs(), 0.1 * state.signed().abs());
            let poses = bodies.map(|body| body.pose_at(now - 0.02));
            let posed = [0, 1].map(|i| Posed::new(&bodies[i].tree, poses[i]));
            let found = distance(posed[0], posed[1], Solid::Filled).unwrap();
            let known = Clearance { poses, distance: found.lower };
            let spins = bodies.map(|body| body.flight.angular_velocity());
            let along = |spin| bound_along(found.normal, spin, &Placed::at(bodies, now), tau).unwrap();
            let bounds = [
                (0, known.bound(&Placed::at(bodies, now), tau)),
                (1, along(spins[0]).max(along(spins[1])).max(along(DVec3::ZERO))),
            ];
            let least = (0..=32).map(|i| apart(bodies, now + tau * f64::from(i) / 32.0)).reduce(f64::min);
            for (i, bound) in bounds {
                assert!(bound <= least.unwrap(), "{k}: {i}: {bound} > {least:?}");
                held[i] += usize::from(bound > 0.0);
                close[i] += usize::from(bound > 0.0 && bound > 0.97 * least.unwrap());
            }
        }
        // They say something, too.
        assert!(held[0] > 200 && held[1] > 250 && close[1] > 50, "{held:?} {close:?}");
    }

    /// How far apart the vertices are along a direction that turns.
    fn gap(normal: DVec3, spin: DVec3, bodies: [&RigidBody; 2], now: f64, time: f64) -> f64 {
        let turned =
            ConstantTwist::REST.with_angular_velocity(spin).pose_and_twist(time - now).0.rotation * normal;
        let place = |k: usize| {
            let pose = bodies[k].pose_at(time);
            let vertices = bodies[k].tree.mesh().vertices().iter();
            vertices.map(move |&vertex| turned.dot(pose.transform_point(vertex)))
        };
        place(1).fold(f64::INFINITY, f64::min) - place(0).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Also along directions that are not those of the distance, and that turn differently from the bodies.
    #[test]
    fn bounds_along_directions_are_no_more_than_the_gap() {
        let state = &mut KnuthRandom(2);
        for k in 0..2000 {
            let speed = [1.0, 50.0][k % 2];
            let (a, b) = (any(DVec3::ZERO, speed, state), any(DVec3::X * 3.0, speed, state));
            let (bodies, normal) = ([&a, &b], state.vector().normalize());
            let spin = [state.vector() * 5.0, a.flight.angular_velocity()][k / 2 % 2];
            let tau = 0.1 * state.signed().abs();
            let bound = bound_along(normal, spin, &Placed::at(bodies, 1.0), tau).unwrap();
            for i in 0..=32 {
                let gap = gap(normal, spin, bodies, 1.0, 1.0 + tau * f64::from(i) / 32.0);
                assert!(bound <= gap, "{k}: {bound} > {gap}");
            }
        }
    }

    /// Where a direction proves nothing for a whole flight it does for parts: until then the bodies are
    /// further apart.
    #[test]
    fn directions_show_more_of_parts_of_flights() {
        let state = &mut KnuthRandom(3);
        let (mut whole, mut all, mut some) = (0, 0, 0);
        for k in 0..600 {
            let (a, b) = (any(DVec3::ZERO, 2.0, state), any(DVec3::X * 3.0, 2.0, state));
            let bodies = [&a, &b];
            let now = 1.0 + 0.1 * state.signed().abs();
            let window = Window::try_new(now, now + 0.3 * state.signed().abs()).unwrap();
            let posed = bodies.map(|body| Posed::new(&body.tree, body.pose_at(now)));
            let found = distance(posed[0], posed[1], Solid::Filled).unwrap();
            let needed = 0.5 * found.lower;
            let until = apart_along_until(found.normal, bodies, window, needed);
            let length = until - now;
            let least = (0..=32).map(|i| apart(bodies, now + length * f64::from(i) / 32.0)).reduce(f64::min);
            assert!(length == 0.0 || least.unwrap() > needed, "{k}: {least:?} {needed}");
            let along = |body: &RigidBody| {
                let spin = body.flight.angular_velocity();
                bound_along(found.normal, spin, &Placed::at(bodies, now), window.length()).unwrap() > needed
            };
            let is_whole = bodies.into_iter().any(along);
            whole += u32::from(is_whole);
            all += u32::from(!is_whole && until == window.end());
            some += u32::from(length > 0.0 && until < window.end());
        }
        assert!(whole > 100 && all > 50 && some > 100, "{whole} {all} {some}");
    }

    /// The end of a bar turns towards a box: all of its speed is closing.
    #[test]
    fn a_bar_that_turns_comes_as_close_as_its_end() {
        let bar = DVec3::new(1.2, 0.05, 0.05);
        let turning = Velocity { linear: DVec3::ZERO, angular: DVec3::Z };
        let a = flying(bar, DVec3::ZERO, DQuat::IDENTITY, turning);
        let b = flying(DVec3::splat(0.3), DVec3::new(1.2, 0.5, 0.0), DQuat::IDENTITY, Velocity::default());
        let bodies = [&a, &b];
        let known = Clearance { poses: bodies.map(|body| body.pose_at(1.0)), distance: 0.15 - 1e-12 };
        let (bound, least) = (known.bound(&Placed::at(bodies, 1.0), 0.08), apart(bodies, 1.08));
        assert!(bound <= least && bound > 0.85 * least, "{bound} {least}");
    }
}
