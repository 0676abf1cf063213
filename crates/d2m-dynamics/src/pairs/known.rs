//! Pairs of bodies: what is known of them, and the queries about them.

use crate::body::rigid_body::RigidBody;
use crate::pairs::clearance::{
    Clearance, JOIN, Placed, apart_along_until, approach, bound_along, have_few_vertices, sizes,
};
use crate::pairs::closest_features::Measured;
#[cfg(feature = "audit")]
use crate::pairs::concluded::conclude;
use crate::pairs::inside::{apart_along_axis_until, bound_from_centers};
use crate::pairs::warm_start::inherit;
#[cfg(feature = "audit")]
use d2m_bvh::audit::Place;
use d2m_bvh::{
    Budget, Contact, Distance, DistanceOptions, Moving, PairCache, Posed, QueryError, QueryOptions, Solid,
    StartState, TimeOfContact, Window, distance_within, time_of_contact, time_of_contact_with,
};
use d2m_contact::{ContactPoint, Momenta};
use d2m_motion::{ConstantTwist, Pose};
use glam::DVec3;

/// A flight ends at this part of the gap.
const STOP: f64 = 0.5;
/// For a pair that is closer than that, the next flight ends at this part of its distance.
const HALF: f64 = 0.5;
/// The tolerance of a query, as a part of the separation. A flight then ends between that and 1.21 times it.
const SLACK: f64 = 0.0625;
/// A pair is held below a separation of this part of the smaller body's radius, 2⁻³⁸; the least tolerance is
/// a quarter of it. The rounding of placed points (fewer than 40 operations of 2⁻⁵³ each) shows in the next
/// halvings: some queries of bodies that graze each other take a million node tests then.
const LEAST: f64 = 1.0 / (1u64 << 38) as f64;

/// A pair with more features than this is searched in a smaller part of the way, one with fewer than `FEW` in
/// a larger one.
const MANY: usize = 128;
const FEW: usize = 32;
/// The smallest part of the way.
const LEAST_REACH: f64 = 1.0 / 64.0;

/// The most flights for which a proof that has failed is not tried.
const MOST_WAITING: u32 = 16;

/// A pair of bodies that may come close.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) cache: Box<PairCache>,
    /// The distance that these two bodies keep.
    pub(crate) gap: f64,
    /// The closest features when last measured, with the impulses of the last step.
    pub(crate) contacts: Vec<ContactPoint>,
    /// Their smallest distance; none: further apart than the margin.
    pub(crate) nearest: Option<f64>,
    /// The time of that measurement.
    pub(crate) measured: Option<f64>,
    /// Features are measured within this part of the way by which the bodies may approach in a flight.
    pub(crate) reach: f64,
    /// A proven distance, at two poses.
    pub(crate) clearance: Option<Clearance>,
    /// A direction that may separate them, from a to b.
    pub(crate) normal: Option<DVec3>,
    /// A lower bound, to rounding, of the distance when measured last.
    pub(crate) apart: f64,
    /// The times at which a proof from an axis is tried.
    pub(crate) axes: Attempts,
    /// The average impulse of the contacts on each body, by time; on a sleeping one the average when it fell
    /// asleep.
    pub(crate) borne: [Momenta; 2],
    /// The average of what acts on it besides that while it sleeps.
    pub(crate) owed: [Momenta; 2],
}

/// A proof is tried again after as many flights as it has failed in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Attempts {
    pub(crate) failed: u32,
    pub(crate) wait: u32,
}

impl Attempts {
    /// Are these numbers to which counting leads?
    pub(crate) fn is_counted(self) -> bool {
        self.failed.max(self.wait) <= MOST_WAITING
    }

    fn is_due(&mut self) -> bool {
        let is_due = self.wait == 0;
        self.wait = self.wait.saturating_sub(1);
        is_due
    }

    fn succeeded(&mut self) {
        *self = Self::default();
    }

    fn failed(&mut self) {
        self.failed = (self.failed + 1).min(MOST_WAITING);
        self.wait = self.failed;
    }
}

impl Pair {
    pub(crate) fn new(gap: f64) -> Self {
        Self {
            cache: Box::default(),
            gap,
            contacts: Vec::new(),
            nearest: None,
            measured: None,
            reach: 1.0,
            clearance: None,
            normal: None,
            apart: 0.0,
            axes: Attempts::default(),
            borne: [Momenta::default(); 2],
            owed: [Momenta::default(); 2],
        }
    }

    /// Keeps what was measured: no contacts, if nothing is within the margin. If many features of two bodies
    /// are close, as of a screw in its nut, those further away are left out from the next time on: should one
    /// of them be met, that is an event.
    pub(crate) fn keep(&mut self, measured: Measured, time: f64, gap: f64) {
        let Measured { mut contacts, features, apart, normal } = measured;
        self.apart = apart;
        self.normal = normal.or(self.normal);
        inherit(&mut contacts, &self.contacts);
        self.nearest = contacts.iter().map(|contact| contact.distance).reduce(f64::min);
        if self.nearest.is_none() {
            self.gap = gap;
        }
        if features > MANY {
            self.reach = (0.5 * self.reach).max(LEAST_REACH);
        } else if features < FEW {
            self.reach = (2.0 * self.reach).min(1.0);
        }
        (self.contacts, self.measured) = (contacts, Some(time));
    }

    /// Are the bodies further apart than this at a time, by what is known of them?
    pub(crate) fn is_beyond(&self, margin: f64, bodies: [&RigidBody; 2], time: f64) -> bool {
        let placed = Placed::at(bodies, time);
        let along = |normal| bound_along(normal, DVec3::ZERO, &placed, 0.0);
        self.clearance.is_some_and(|known| known.bound(&placed, 0.0) > margin)
            || self.normal.and_then(along).is_some_and(|apart| apart > margin)
    }

    /// The separation at which a flight of the pair ends.
    pub(crate) fn separation(&self) -> f64 {
        let stop = STOP * self.gap;
        self.nearest.map_or(stop, |nearest| stop.min(HALF * nearest))
    }
}

/// How a flight of two bodies ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    /// Certified free of contact until the end of the window.
    Clear,
    /// Certified free before `lo`; close at some time until `hi`.
    Meets { lo: f64, hi: f64, normal: DVec3, closing: f64 },
    /// The budget of the query is used up; certified free until then.
    ClearUntil(f64),
    /// The bodies are closer than can be certified.
    Stuck,
}

/// The radius of the larger body, or how far from the origin they are.
pub(crate) fn size(bodies: [&RigidBody; 2]) -> f64 {
    bodies.iter().map(|body| body.radius.max(body.position.length())).fold(0.0, f64::max)
}

pub(crate) fn solid_of(a: &RigidBody, b: &RigidBody) -> Solid {
    if a.solid == Solid::Filled && b.solid == Solid::Filled { Solid::Filled } else { Solid::Surface }
}

/// Finds when two bodies come as close in their flights as their pair may.
pub(crate) fn fly(
    a: &RigidBody,
    b: &RigidBody,
    window: Window,
    node_tests: u64,
    pair: &mut Pair,
) -> Result<Outcome, QueryError> {
    let lost = JOIN * sizes([a, b], window.start(), window.length());
    let least = lost.max(LEAST * a.radius.min(b.radius));
    let apart = pair.separation().max(lost);
    let until = proven_clear_until(a, b, window, pair, apart * (1.0 + SLACK))?;
    #[cfg(feature = "audit")]
    if until > window.start() {
        conclude(Place::DynamicsClearance, [a, b], [window.start(), until], apart * (1.0 + SLACK));
    }
    if until >= window.end() {
        return Ok(Outcome::Clear);
    }
    let window = Window::try_new(until, window.end())?;
    let mut separation = apart.max(least);
    while separation >= least {
        match first_meeting([a, b], window, separation, node_tests, &mut pair.cache)? {
            TimeOfContact::Separated => return Ok(Outcome::Clear),
            TimeOfContact::Undecided { clear_until } => return Ok(Outcome::ClearUntil(clear_until)),
            TimeOfContact::Contact(contact) => match contact.start {
                StartState::Apart => {
                    let wider = met_with_room([a, b], window, &contact, node_tests, pair, separation)?;
                    return Ok(met(&wider.unwrap_or(contact)));
                }
                StartState::Touching => separation *= HALF,
                _ => return Ok(Outcome::Stuck),
            },
        }
    }
    Ok(Outcome::Stuck)
}

/// When two bodies come within this separation in their flights.
fn first_meeting(
    bodies: [&RigidBody; 2],
    window: Window,
    separation: f64,
    node_tests: u64,
    cache: &mut PairCache,
) -> Result<TimeOfContact, QueryError> {
    let radius = bodies[0].radius.min(bodies[1].radius);
    let options = QueryOptions::default()
        .with_solid(solid_of(bodies[0], bodies[1]))
        .with_min_separation(separation)
        .with_tolerance((SLACK * separation).max(0.25 * LEAST * radius))
        .with_budget(Budget::UNLIMITED.with_node_tests(node_tests));
    let [one, two] = bodies.map(|body| Moving::new(&*body.tree, &body.flight).with_radius(body.rounding));
    time_of_contact_with(one, two, window, &options, cache)
}

/// Bodies that were closer than the separation at which flights usually end may part before they meet, as a
/// ring that rattles on a pin. Then this is their meeting at the usual separation. `None`: they have not
/// parted so far.
fn met_with_room(
    bodies: [&RigidBody; 2],
    window: Window,
    contact: &Contact,
    node_tests: u64,
    pair: &mut Pair,
    separation: f64,
) -> Result<Option<Contact>, QueryError> {
    let wide = STOP * pair.gap;
    if separation >= wide {
        return Ok(None);
    }
    let rest = Window::try_new(0.5 * (window.start() + contact.time_lo), contact.time_lo)?;
    let found = first_meeting(bodies, rest, wide, node_tests, &mut pair.cache)?;
    Ok(found.contact().filter(|found| found.start == StartState::Apart).copied())
}

/// Until when the bodies are proven further apart than a query would call a meeting: from their distance,
/// along a direction or from an axis. A query would answer so, too. The time is no earlier than the start of
/// the window.
fn proven_clear_until(
    a: &RigidBody,
    b: &RigidBody,
    window: Window,
    pair: &mut Pair,
    needed: f64,
) -> Result<f64, QueryError> {
    let (now, length) = (window.start(), window.length());
    let placed = Placed::at([a, b], now);
    let is_kept = pair.clearance.is_some_and(|known| known.bound(&placed, length) > needed);
    if is_kept || bound_from_centers(&placed, length) > needed {
        return Ok(window.end());
    }
    let spins = [a, b].map(|body| body.flight.angular_velocity());
    let is_apart_along = |normal: DVec3| {
        let bound = |spin| bound_along(normal, spin, &placed, length);
        spins.into_iter().filter_map(bound).any(|bound| bound > needed)
    };
    if pair.normal.is_some_and(is_apart_along) {
        return Ok(window.end());
    }
    if pair.axes.is_due() {
        let until = apart_along_axis_until([a, b], window, needed);
        if until > now {
            pair.axes.succeeded();
            return Ok(until);
        }
        pair.axes.failed();
    }
    // The distance is worth its cost where it is enough; where no direction is known; and where the direction
    // does not come from the present poses of bodies with few vertices.
    let poses = placed.poses;
    let will_do = pair.measured == Some(now) && pair.apart - approach([a, b]) * length > needed;
    let is_old = pair.contacts.is_empty() && have_few_vertices([a, b]);
    let is_known = pair.clearance.is_some_and(|known| known.poses == poses);
    if !is_known
        && (will_do || is_old || pair.normal.is_none())
        && let Some(found) = distance_of([a, b], poses, f64::INFINITY, &mut pair.cache)?
    {
        let known = Clearance { poses, distance: found.lower };
        (pair.clearance, pair.normal) = (Some(known), Some(found.normal));
        if known.bound(&placed, length) > needed {
            return Ok(window.end());
        }
    }
    Ok(pair.normal.map_or(now, |normal| apart_along_until(normal, [a, b], window, needed)))
}

/// The distance of two bodies in these poses; `None`: it is more than the cutoff.
pub(crate) fn distance_of(
    bodies: [&RigidBody; 2],
    poses: [Pose; 2],
    cutoff: f64,
    cache: &mut PairCache,
) -> Result<Option<Distance>, QueryError> {
    let [a, b] = bodies;
    let radii = bodies.map(|body| body.rounding);
    let cutoff = if radii == [0.0; 2] { cutoff } else { cutoff + (radii[0] + radii[1]).next_up().next_up() };
    let options = DistanceOptions::default()
        .with_solid(solid_of(a, b))
        .with_cutoff(cutoff)
        .with_first(cache.triangles());
    let found = distance_within(Posed::new(&a.tree, poses[0]), Posed::new(&b.tree, poses[1]), &options)?;
    if let Some(found) = &found {
        cache.remember([found.triangle_a, found.triangle_b]);
    }
    Ok(found.map(|found| found.with_radii(radii)))
}

/// A point that two bodies share because one of them is solid and holds the other, a mere surface; `None`:
/// there is none. [`distance_of`] takes such bodies for surfaces. The surfaces are at least `apart` from each
/// other, which gives room for a tolerance.
pub(crate) fn held_at(
    bodies: [&RigidBody; 2],
    poses: [Pose; 2],
    apart: f64,
) -> Result<Option<DVec3>, QueryError> {
    if bodies[0].solid == bodies[1].solid {
        return Ok(None);
    }
    let rest = poses.map(|pose| {
        let rest = ConstantTwist::REST.with_at(pose.at);
        rest.with_position(pose.translation).with_orientation(pose.rotation)
    });
    let options = QueryOptions::default();
    let options = if apart > 0.0 { options.with_tolerance(SLACK * apart) } else { options };
    let [a, b] = [0, 1].map(|k| bodies[k].moving_on(&rest[k]));
    Ok(match time_of_contact(a, b, Window::try_new(0.0, 0.0)?, &options)? {
        TimeOfContact::Separated => None,
        TimeOfContact::Undecided { .. } => Some(poses[0].translation),
        TimeOfContact::Contact(contact) => {
            (contact.start == StartState::Contained).then_some(contact.point_a)
        }
    })
}

fn met(contact: &Contact) -> Outcome {
    let (lo, hi) = (contact.time_lo, contact.time_hi);
    Outcome::Meets { lo, hi, normal: contact.normal, closing: contact.closing_speed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use crate::pairs::clearance::are_spheres_apart;
    use d2m_bvh::MeshTree;
    use d2m_contact::Velocity;
    use d2m_mesh::Faces;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DQuat;
    use std::sync::Arc;

    /// A cube of half side 1e-3, in its flight since time 1.
    fn flying(place: DVec3, velocity: Velocity) -> RigidBody {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1e-3&y=1e-3&z=1e-3").unwrap()));
        let described = Body::new("", Arc::clone(&tree)).with_position(place);
        let mut body = RigidBody::try_new(&described, Arc::new(Faces::new(tree.mesh())), 1.0).unwrap();
        body.fly(velocity, f64::INFINITY);
        body
    }

    /// Cubes that approach each other, of a pair that keeps a gap although they are closer.
    fn met(a: &RigidBody, b: &RigidBody, nearest: f64, node_tests: u64) -> Outcome {
        let mut pair = Pair { nearest: Some(nearest), ..Pair::new(1e-9) };
        fly(a, b, Window::try_new(1.0, 2.0).unwrap(), node_tests, &mut pair).unwrap()
    }

    /// Far from the origin flights end as long as the rounding where the next one begins leaves some of the
    /// distance; bodies that are closer are held.
    #[test]
    fn flights_end_further_apart_than_rounding_moves_bodies() {
        let (mut ended, mut held) = (0, 0);
        for k in 0..200 {
            // In roundings of places at 8: 2⁻⁵⁰.
            let (ulps, speed) = (f64::from(k), DVec3::X * 0.3e-15);
            let distance = 8.0 * f64::EPSILON * ulps;
            let still = flying(DVec3::splat(8.0), Velocity::default());
            let from = DVec3::new(8.0 + 2e-3 + distance, 8.0, 8.0);
            let coming =
                flying(from, Velocity { linear: -speed * (ulps + 1.0) * 7.0, ..Velocity::default() });
            match met(&still, &coming, from.x - 8.0 - 2e-3, 1 << 22) {
                Outcome::Meets { lo, .. } => {
                    let mut there = coming.clone();
                    there.advance(lo, DVec3::ZERO);
                    assert!(there.position.x - 8.0 > 2e-3, "{ulps}");
                    ended += 1;
                }
                Outcome::Stuck => held += 1,
                other => panic!("{ulps}: {other:?}"),
            }
        }

        assert!(ended > 40 && held > 10, "{ended} {held}");
    }

    /// Where little of a gap is left a query needs thousands of node tests, not millions.
    #[test]
    fn what_is_hardly_apart_is_queried_in_no_time() {
        let state = &mut KnuthRandom(1);
        let (mut ended, mut held) = (0, 0);
        for k in 0..400 {
            let mut tumbling = |place: DVec3| {
                let turn = DQuat::from_xyzw(state.signed(), state.signed(), state.signed(), state.signed());
                let velocity = Velocity { linear: state.vector() * 1e-3, angular: state.vector() * 9.0 };
                RigidBody { orientation: turn.normalize(), ..flying(place, velocity) }
            };
            let [mut still, mut coming] = [DVec3::ZERO, DVec3::X * 4e-3].map(&mut tumbling);
            for body in [&mut still, &mut coming] {
                body.fly(body.present_velocity(), f64::INFINITY);
            }
            let poses = [&still, &coming].map(|body| body.pose_at(1.0));
            let found = distance_of([&still, &coming], poses, f64::INFINITY, &mut PairCache::new());
            let (found, nearest) = (found.unwrap().unwrap(), 4e-15 * 2.0f64.powi(k % 8));
            coming.position -= found.normal * (found.lower - nearest);
            // They slide along each other, and approach slowly.
            let at = |body: &RigidBody, point: DVec3| {
                let Velocity { linear, angular } = body.present_velocity();
                linear + angular.cross(point - body.pose_at(1.0).translation)
            };
            let closing = (at(&coming, found.point_b) - at(&still, found.point_a)).dot(found.normal);
            let Velocity { linear, angular } = coming.present_velocity();
            coming.fly(Velocity { linear: linear - found.normal * (closing + 1e-8), angular }, f64::INFINITY);
            match met(&still, &coming, nearest, 1 << 12) {
                Outcome::Meets { .. } => ended += 1,
                Outcome::Stuck => held += 1,
                Outcome::ClearUntil(until) => panic!("{k}: {until}"),
                Outcome::Clear => {}
            }
        }
        assert!(ended > 100 && held > 10, "{ended} {held}");
    }

    /// A pair of spheres that are apart by less than rounding moves bodies on their common way is queried,
    /// whatever the gap is.
    #[test]
    fn what_rounding_could_move_together_is_queried() {
        let fast = Velocity { linear: DVec3::Y * 1e5, ..Velocity::default() };
        let one = flying(DVec3::ZERO, fast);
        let two = |apart: f64| flying(DVec3::X * (2.0 * one.radius + apart), fast);
        assert!(!are_spheres_apart(&one, &two(1e-11), 1.0, 2.0, 1e-300));
        assert!(are_spheres_apart(&one, &two(1e-9), 1.0, 2.0, 1e-300));
    }
}
