//! Proofs that a body stays apart from one inside of which it lies, as a pin in its hole, however fast they
//! turn. A turn moves the surface of a bore along itself, but a query sees all of it move, and divides the
//! flight into very many parts.
//!
//! **From a center.** In its flight a body turns about its center, and all of its points keep their distances
//! from that. No point of a shell is nearer to its center than c (its cavity), and no point of the inner body
//! is further from its own center than ρ. The distance |D| of the centers is a convex function of time, so it
//! is largest at the start or the end:
//!
//! ```text
//! distance ≥ c − ρ − max |D|
//! ```
//!
//! **From an axis.** Let an axis n through the center of the outer body be fixed in it, near to that of its
//! spin ω: no point of the body is nearer to it than c, and along it the body lies between z₀ and z₁. In a
//! flight of length τ the axis turns by no more than α = |ω × n| τ/2 from its direction in the middle. For an
//! inner body that does not turn, the distance |p| of a point from the outer center, and its distance from
//! the axis in the middle of the flight, are convex functions of time and place. So they are largest at the
//! start or the end of the flight, and at an end of the part of an edge that comes nearer than m to the
//! places between z₀ and z₁. With the largest value r of their sum
//!
//! ```text
//! distance ≥ min(m, c − r),      r = max (|p × n| + α |p|)
//! ```
//!
//! In a part of the flight the axis turns by that part of α. So where nothing follows for the whole flight,
//! halves, quarters and eighths are tried, from its start on; a query takes the rest.
//!
//! An inner body that turns, too, lies within some distance of a segment of its own axis. A line with that
//! radius, and with what that axis turns, takes its place. Where the outer body does not turn, a bound is the
//! distance of that segment from it at the start, less the displacements of both.

use crate::body::rigid_body::{AXES_REACH, RigidBody};
use crate::pairs::clearance::{Placed, ROUNDING, sizes};
use crate::pairs::part_of_flight::proven_until;
use d2m_bvh::Window;
use d2m_motion::Pose;
use glam::DVec3;

/// A turn that moves no point of a body by more than this part of the distance that is to be proven counts as
/// a loss only.
const STILL: f64 = 1.0 / 16.0;
/// The spin axis is replaced by an axis of the mesh if the cosine of the angle between them is above this: a
/// fifth of a radian.
const NEAR_AXIS: f64 = 0.98;

/// A lower bound of the distance of two bodies in their flights from their present poses on, for a time
/// `tau`, from their centers.
pub(crate) fn bound_from_centers(placed: &Placed<'_>, tau: f64) -> f64 {
    let Placed { bodies: [a, b], poses, now } = *placed;
    let room = |outer: &RigidBody, inner: &RigidBody| outer.cavity - outer.rounding - inner.radius;
    let most = room(a, b).max(room(b, a));
    if most <= 0.0 {
        return most;
    }
    let offset = poses[1].translation - poses[0].translation;
    let way = (b.flight.linear_velocity() - a.flight.linear_velocity()) * tau;
    let apart = offset.length().max((offset + way).length());
    most - apart - ROUNDING * sizes([a, b], now, tau)
}

/// Are two bodies proven further apart than `needed` in their flights from `now` on, for a time `tau`, from
/// the axis about which one of them turns?
pub(crate) fn is_apart_along_axis([a, b]: [&RigidBody; 2], now: f64, tau: f64, needed: f64) -> bool {
    // The ends of axes are in the meshes' frames, whose origins may be far from their centers.
    let lost = ROUNDING * (sizes([a, b], now, tau) + a.center.length() + b.center.length());
    [[a, b], [b, a]]
        .into_iter()
        .any(|pair| Nested::new(pair, now, tau, needed).is_some_and(|nested| nested.bound() > needed + lost))
}

/// Until when that is proven in a window of their flights, no earlier than its start. In a part of the window
/// the axis of a body turns by so much less.
pub(crate) fn apart_along_axis_until(bodies: [&RigidBody; 2], window: Window, needed: f64) -> f64 {
    proven_until(window, |from, to| is_apart_along_axis(bodies, from, to - from, needed))
}

/// A body inside another one, for a flight.
struct Nested<'s> {
    inner: &'s RigidBody,
    outer: &'s RigidBody,
    /// At the start of the flight.
    poses: [Pose; 2],
    /// None: the body hardly turns; its displacement by that is part of `lost`.
    turning: [Option<Turning>; 2],
    lost: f64,
    /// The displacement of the inner body relative to the outer one.
    way: DVec3,
    needed: f64,
}

/// A body that turns about almost this axis through its center.
#[derive(Clone, Copy, PartialEq)]
struct Turning {
    /// The axis in the mesh frame, in which it is fixed; and its number, if it is an axis of that frame.
    own: DVec3,
    of_mesh: Option<usize>,
    /// Its direction in the middle of the flight.
    axis: DVec3,
    /// The largest angle between that and its direction at other times.
    off: f64,
}

impl Turning {
    /// With an axis of the mesh frame that is near to that of the spin, or with that of the spin.
    fn new(body: &RigidBody, now: f64, tau: f64) -> Option<Self> {
        let spin = body.flight.angular_velocity();
        let rotation = body.pose_at(now + 0.5 * tau).rotation;
        let turns = rotation.conjugate() * spin.try_normalize()?;
        let of_mesh = DVec3::AXES.iter().position(|axis| axis.dot(turns).abs() > NEAR_AXIS);
        let own = of_mesh.map_or(turns, |k| DVec3::AXES[k]);
        let axis = rotation * own;
        Some(Self { own, of_mesh, axis, off: spin.cross(axis).length() * (0.5 * tau) })
    }
}

/// A segment from one point to another, relative to the center of the outer body.
type Edge = [DVec3; 2];

/// Segments within whose radius the inner body lies; along an axis it reaches no further than `reach` beyond
/// them.
struct Inner {
    edges: Vec<Edge>,
    radius: f64,
    reach: f64,
}

/// The segment of a body's axis along which it lies, from its center, and its distance from that.
struct Shaft {
    ends: [f64; 2],
    radius: f64,
}

impl<'s> Nested<'s> {
    /// None: the bodies do not lie so that anything could be proven.
    fn new([inner, outer]: [&'s RigidBody; 2], now: f64, tau: f64, needed: f64) -> Option<Self> {
        let bodies = [inner, outer];
        let mut lost = 0.0;
        let turning = bodies.map(|body| {
            let moves = body.flight.angular_velocity().length() * body.radius * tau;
            if moves <= STILL * needed {
                lost += moves;
                return None;
            }
            Turning::new(body, now, tau)
        });
        let way = (inner.flight.linear_velocity() - outer.flight.linear_velocity()) * tau;
        let poses = bodies.map(|body| body.pose_at(now));
        let is_inside = (poses[0].translation - poses[1].translation).length() < outer.radius;
        (is_inside && turning != [None; 2]).then_some(Self {
            inner,
            outer,
            poses,
            turning,
            lost,
            way,
            needed,
        })
    }

    /// A lower bound of the distance, without the rounding.
    fn bound(&self) -> f64 {
        let [turns, Some(about)] = self.turning else { return self.bound_at_rest() };
        let along = || {
            let (center, way) = (self.outer.center, about.own * (AXES_REACH * self.outer.radius));
            self.outer.tree.bound_distance_from_segment([center - way, center + way])
        };
        let free = about.of_mesh.map_or_else(along, |k| self.outer.bores[k]) - self.outer.rounding;
        if free <= self.needed {
            return 0.0;
        }
        let inner = self.inner_about(turns, about);
        (free - self.farthest(&inner, about) - inner.radius).min(2.0 * self.needed) - self.lost
    }

    /// The bound where the outer body does not turn: its distance from the segment of the inner one's axis.
    fn bound_at_rest(&self) -> f64 {
        let [Some(turns), _] = self.turning else { return 0.0 };
        let shaft = self.shaft(turns);
        let rest = self.poses[1].rotation.conjugate();
        let center = self.outer.center + rest * (self.poses[0].translation - self.poses[1].translation);
        let free = self
            .outer
            .tree
            .bound_distance_from_segment(shaft.ends.map(|end| center + rest * turns.axis * end));
        free - self.outer.rounding - shaft.radius - shaft.off(turns) - self.way.length() - self.lost
    }

    fn shaft(&self, turns: Turning) -> Shaft {
        let (mut ends, mut radius) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0f64);
        for &vertex in self.inner.tree.mesh().vertices() {
            let arm = vertex - self.inner.center;
            let place = arm.dot(turns.own);
            ends = [ends[0].min(place), ends[1].max(place)];
            radius = radius.max((arm - turns.own * place).length());
        }
        Shaft { ends, radius: radius + self.inner.rounding }
    }

    /// Represents the inner body by its edges, or by its axis where it turns.
    fn inner_about(&self, turns: Option<Turning>, about: Turning) -> Inner {
        let (pose, center) = (self.poses[0], self.poses[1].translation);
        let offset = pose.translation - center;
        if let Some(turns) = turns {
            let shaft = self.shaft(turns);
            let edges = vec![shaft.ends.map(|end| offset + turns.axis * end)];
            let askew = turns.axis.cross(about.axis).length() + turns.off + about.off;
            let off = shaft.off(turns);
            let reach = shaft.radius * askew + off + self.inner.rounding;
            return Inner { edges, radius: shaft.radius + off, reach };
        }
        let mesh = self.inner.tree.mesh();
        let place = |vertex: &DVec3| offset + pose.rotation * (*vertex - self.inner.center);
        let places: Vec<DVec3> = mesh.vertices().iter().map(place).collect();
        let edge = |[i, j]: [u32; 2]| [places[i as usize], places[j as usize]];
        let edges = mesh.triangles().iter().flat_map(|&[i, j, k]| [[i, j], [j, k], [k, i]].map(edge));
        Inner { edges: edges.collect(), radius: self.inner.rounding, reach: self.inner.rounding }
    }

    /// The largest distance from the axis, at any time of the flight, of those parts of the edges that come
    /// within twice the needed distance of the outer body's places along the axis.
    fn farthest(&self, inner: &Inner, about: Turning) -> f64 {
        let Turning { own, axis, off, .. } = about;
        let places = self.outer.tree.mesh().vertices().iter().map(|&v| (v - self.outer.center).dot(own));
        let (low, high) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
        let offset = (self.poses[0].translation - self.poses[1].translation).length();
        let size = self.inner.radius + offset + self.way.length();
        // The rounding of a place along the axis.
        let placed = self.poses.iter().map(|pose| pose.translation.length()).sum::<f64>();
        let unsure = ROUNDING * (size + self.outer.radius + placed);
        let wide = 2.0 * self.needed + inner.reach + self.outer.rounding + self.lost + off * size;
        let along = self.way.dot(axis);
        let slab = [low - wide - along.max(0.0) - unsure, high + wide - along.min(0.0) + unsure];
        // The axis moves by no more than the distance from the center times the angle.
        let from_axis = |p: DVec3| (p - axis * p.dot(axis)).length() + off * p.length();
        let mut farthest = 0.0f64;
        for edge in &inner.edges {
            let Some(part) = part_within(edge.map(|p| p.dot(axis)), slab, unsure) else { continue };
            for at in part {
                let p = edge[0] + (edge[1] - edge[0]) * at;
                farthest = farthest.max(from_axis(p)).max(from_axis(p + self.way));
            }
        }
        farthest
    }
}

impl Shaft {
    /// How far its ends are at most from where they would be if its axis kept the direction of the middle of
    /// the flight.
    fn off(&self, turns: Turning) -> f64 {
        turns.off * self.ends[0].abs().max(self.ends[1].abs())
    }
}

/// A part of an edge, from 0 to 1, that holds all of its points whose places along an axis lie in a slab.
/// `unsure`: the rounding of a place.
fn part_within([first, last]: [f64; 2], [low, high]: [f64; 2], unsure: f64) -> Option<[f64; 2]> {
    if first.max(last) < low || first.min(last) > high {
        return None;
    }
    let rise = last - first;
    let at = |place: f64, side: f64| {
        let (at, off) = ((place - first) / rise, unsure / rise.abs());
        // An edge that hardly rises counts as a whole.
        let at = at + side * off;
        if at.is_finite() { at.clamp(0.0, 1.0) } else { 0.5 + 0.5 * side }
    };
    Some(if rise >= 0.0 { [at(low, -1.0), at(high, 1.0)] } else { [at(high, -1.0), at(low, 1.0)] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Kind, Mass, MassProperties};
    use d2m_bvh::{MeshTree, Posed, Solid, TriMesh, distance};
    use d2m_contact::Velocity;
    use d2m_mesh::Faces;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::{DMat3, DQuat};
    use std::sync::Arc;

    fn shape(name: &str) -> Arc<MeshTree> {
        Arc::new(MeshTree::new(d2m_shapes::mesh(name).unwrap()))
    }

    /// At time 1.
    fn flying(tree: &Arc<MeshTree>, place: DVec3, turn: DQuat, velocity: Velocity) -> RigidBody {
        let described = Body::new("", Arc::clone(tree)).with_position(place).with_orientation(turn);
        let mut body = RigidBody::try_new(&described, Arc::new(Faces::new(tree.mesh())), 1.0).unwrap();
        body.fly(velocity, f64::INFINITY);
        body
    }

    /// The least distance of the flights at some times, no less than the true one.
    fn least(bodies: [&RigidBody; 2], now: f64, tau: f64) -> f64 {
        (0..=16).map(|k| least_at(bodies, now + tau * f64::from(k) / 16.0)).fold(f64::INFINITY, f64::min)
    }

    fn least_at(bodies: [&RigidBody; 2], time: f64) -> f64 {
        let [a, b] = bodies.map(|body| Posed::new(&body.tree, body.pose_at(time)));
        distance(a, b, Solid::Surface).unwrap().upper
    }

    /// Pins in rings that turn or do not, about their axis or almost so, askew, off the middle, and in
    /// motion. Nothing is proven that is false, and for turns about the axis most of what is true is proven.
    /// Where it is true for a part of the flight, it is proven up to some time.
    #[test]
    fn pins_in_rings_are_as_far_apart_as_is_shown() {
        let state = &mut KnuthRandom(5);
        let (pin, ring) = (shape("shaft?triangles=300"), shape("bearing?triangles=400&clearance=0.05"));
        let (mut shown, mut in_part) = ([[0; 4]; 4], 0);
        for k in 0..160 {
            let askew = 0.02 * state.signed().abs();
            let (mut spins, wobble) = ([0.0; 2], [0.0, 0.1, 0.5][k / 4 % 3]);
            for (bit, spin) in spins.iter_mut().enumerate() {
                if (k % 4) & (1 << bit) != 0 {
                    *spin = 60.0 * state.signed();
                }
            }
            let mut body = |tree: &Arc<MeshTree>, spin: f64| {
                let tilt =
                    DQuat::from_xyzw(askew * state.signed(), askew * state.signed(), state.signed(), 1.5);
                let (place, turn) = (state.vector() * 0.01 + DVec3::X, tilt.normalize());
                let angular = (turn * DVec3::Z + state.vector() * wobble) * spin;
                flying(tree, place, turn, Velocity { linear: state.vector() * 0.2, angular })
            };
            let (a, b) = (body(&pin, spins[0]), body(&ring, spins[1]));
            let tau = 0.02 * state.signed().abs();
            let (bodies, now) = ([&a, &b], 1.0 + 0.01 * state.signed().abs());
            let least = least(bodies, now, tau);
            for (place, part) in [0.3, 0.6, 0.8, 1.0 + 1e-9].into_iter().enumerate() {
                let is_apart = is_apart_along_axis(bodies, now, tau, part * least);
                let turned = is_apart_along_axis([&b, &a], now, tau, part * least);
                assert_eq!(is_apart, turned, "{k}");
                assert!(!is_apart || part < 1.0, "{k}: {least}");
                shown[k % 4][place] += usize::from(is_apart);
            }
            let (window, needed) = (Window::try_new(now, now + tau).unwrap(), 0.9 * least_at(bodies, now));
            let until = apart_along_axis_until(bodies, window, needed);
            assert!(self::least(bodies, now, until - now) >= needed, "{k}: {until}");
            in_part += usize::from(until > now && until < window.end());
        }
        // Neither turns; the pin; the ring; both. 40 of each.
        assert_eq!(shown[0], [0; 4]);
        assert!(shown[1..].iter().all(|shown| shown[0] > 13 && shown[1] > 6), "{shown:?}");
        assert!(in_part > 10, "{in_part}");
    }

    /// A blade that turns about an axis askew in its mesh, which lies far from the origin of its frame, so
    /// that the ends of that axis are rounded. It starts where it is closest to a point.
    #[test]
    fn the_axis_of_a_mesh_that_lies_far_away_is_no_more_exact_than_its_numbers() {
        let state = &mut KnuthRandom(11);
        let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap()));
        let mut shown = 0;
        for k in 0..100 {
            let (far, turn) = (state.vector() * [1e5, 1e8][k % 2], state.vector().normalize());
            let turn = DQuat::from_rotation_arc(DVec3::Z, turn);
            let corners = [DVec3::new(0.6, 0.0, -1.0), DVec3::new(0.6, 0.0, 1.0), DVec3::X * 2.0];
            let blade = TriMesh::try_new(corners.map(|corner| far + turn * corner).to_vec(), vec![[0, 1, 2]]);
            let still =
                Body::new("", Arc::clone(&point)).with_kind(Kind::Static).with_position(DVec3::X * 0.4);
            let still = RigidBody::try_new(&still, Arc::new(Faces::new(point.mesh())), 1.0).unwrap();
            let described = Body::new("", Arc::new(MeshTree::new(blade.unwrap())))
                .with_mass(Mass::Given(MassProperties { mass: 1.0, center: far, inertia: DMat3::IDENTITY }))
                .with_position(turn.conjugate() * -far)
                .with_orientation(turn.conjugate());
            let faces = Arc::new(Faces::new(described.tree.mesh()));
            let mut turning = RigidBody::try_new(&described, faces, 1.0).unwrap();
            turning.fly(Velocity { linear: DVec3::ZERO, angular: DVec3::Z * 9.0 }, f64::INFINITY);
            let bodies = [&still, &turning];
            let least = least_at(bodies, 1.0);
            assert!(!is_apart_along_axis(bodies, 1.0, 1.0, least * (1.0 + 1e-12)), "{k}: {least}");
            shown += usize::from(is_apart_along_axis(bodies, 1.0, 1.0, 0.99 * least));
        }
        // Except for axes near to those of the mesh.
        assert!(shown > 90, "{shown}");
    }

    /// Spheres in shells that turn in any way.
    #[test]
    fn spheres_in_shells_are_as_far_apart_as_is_shown() {
        let state = &mut KnuthRandom(7);
        let (ball, shell) =
            (shape("icosphere?triangles=500&scale=0.8"), shape("hollow-sphere?triangles=2000&wall=0.1"));
        let mut close = 0;
        for k in 0..100 {
            let mut body = |tree: &Arc<MeshTree>| {
                let turn = DQuat::from_xyzw(state.signed(), state.signed(), state.signed(), state.signed())
                    .normalize();
                let velocity = Velocity { linear: state.vector(), angular: state.vector() * 30.0 };
                flying(tree, state.vector() * 0.03, turn, velocity)
            };
            let bodies = [&body(&ball), &body(&shell)];
            let tau = 0.02 * state.signed().abs();
            let (bound, least) = (bound_from_centers(&Placed::at(bodies, 1.0), tau), least(bodies, 1.0, tau));
            assert_eq!(bound, bound_from_centers(&Placed::at([bodies[1], bodies[0]], 1.0), tau));
            assert!(bound <= least, "{k}: {bound} > {least}");
            close += usize::from(bound > 0.6 * least);
        }
        assert!(close > 60, "{close}");
    }

    /// An edge that leaves a slab, one beside it, and one that lies in its face.
    #[test]
    fn parts_of_edges_are_no_shorter_than_what_lies_in_the_slab() {
        let part = |ends: [f64; 2]| part_within(ends, [-1.0, 1.0], 1e-9);
        let [from, to] = part([0.0, 4.0]).unwrap();
        assert!(from == 0.0 && (0.25..0.25 + 1e-8).contains(&to), "{from} {to}");
        let [from, to] = part([3.0, -3.0]).unwrap();
        assert!(from <= 1.0 / 3.0 && to >= 2.0 / 3.0 && to - from < 0.34);
        assert_eq!(part([1.5, 2.0]), None);
        for flat in [[1.0, 1.0], [1.0, 1.0 + 1e-12], [-1.0, -1.0 - 1e-12]] {
            assert_eq!(part(flat), Some([0.0, 1.0]), "{flat:?}");
        }
    }
}
