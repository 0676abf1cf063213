//! Checks of bodies that are added: apart, touching, or intersecting.

use crate::body::rigid_body::RigidBody;
use crate::pairs::clearance::are_spheres_apart;
use crate::pairs::closest_features::measure;
use crate::pairs::known::{Pair, distance_of, held_at, size};
use crate::pairs::neighbors::posed;
use crate::{Simulation, SimulationError, StepError};
use d2m_bvh::{Distance, PairCache, StartState};
use d2m_contact::{Accuracy, Company, ContactPoint, SolverBody, Start, System, Velocity};
use d2m_world::{Aabb, BoxTree};
use glam::{DMat3, DVec3};
use std::collections::BTreeSet;

/// Bodies that touch are moved this far apart before anything flies, as a part of their size, or of their
/// distance from the origin if that is larger: 2⁻³⁶. A query still resolves a half of it with a tolerance of
/// a sixteenth of that, 2⁻⁴¹.
const APART: f64 = 1.0 / (1u64 << 36) as f64;
/// The part of that from which on bodies count as apart. Nearer ones are parted as touching ones are, since
/// no query resolves a half of their distance.
const STILL_APART: f64 = 0.5;
/// The part of the gap that pairs keep at least, 2⁻¹⁶: pairs that start closer part to that. Solutions may be
/// off by a hundred-thousandth of a gap a step, and where a pair has used up the last of its distance
/// friction gives way.
const LEAST_KEPT: f64 = 1.0 / (1u64 << 16) as f64;
/// How far a body is moved on trial, relative to the same size, to see where it can part: 2⁻²⁰.
const TRIAL: f64 = 1.0 / (1u64 << 20) as f64;
/// Overlaps up to this part of the same size are the rounding of poses, and count as touching: 2⁻⁴⁰.
const ROUNDING: f64 = 1.0 / (1u64 << 40) as f64;
/// Rounds in which touching bodies are parted: each may push others together.
const MOST_ROUNDS: u32 = 4;

/// How two bodies lie before anything flies.
enum Placed {
    /// Proven apart; with the distance, if it is less than the gap.
    Apart(Option<f64>),
    Touching(Touch),
}

/// Two bodies that share points.
struct Touch {
    pair: (usize, usize),
    /// The contacts where they touch, with their distances along the normals.
    contacts: Vec<ContactPoint>,
    /// A point that they share, about.
    point: DVec3,
}

impl Simulation {
    /// Checks that bodies which were added or changed from outside since the last step intersect no other.
    /// Touching ones are parted by a rounding, and move on to the gap from there.
    pub(crate) fn check_start(&mut self) -> Result<(), StepError> {
        for round in 0.. {
            let mut touching = Vec::new();
            for (a, b) in self.near_unchecked() {
                match self.placed(a, b)? {
                    Placed::Touching(touch) if round == MOST_ROUNDS => {
                        return Err(self.intersecting((a, b), touch.point).into());
                    }
                    placed => touching.extend(self.admit_placed((a, b), placed)),
                }
            }
            if touching.is_empty() {
                break;
            }
            if !self.is_given_way(&touching) {
                self.part(&touching);
            }
        }
        let unchecked = core::mem::take(&mut self.unchecked);
        if self.recorder.has_begun() {
            for k in unchecked.into_iter().filter(|&k| Some(k) != self.world) {
                self.recorder.change(self.bodies[k].id, self.bodies[k].flight);
            }
        } else {
            let flights = self.ids().map(|id| (id, self.bodies[id.index()].first_flight(self.time)));
            self.recorder.begin(self.time, flights.collect());
        }
        Ok(())
    }

    /// Lets bodies give way against which a body was put that may not be moved: they count as changed from
    /// outside, and are checked again. False: each pair has a body already that may be moved.
    fn is_given_way(&mut self, touching: &[Touch]) -> bool {
        let may_move = |i: usize| self.bodies[i].is_dynamic() && self.unchecked.contains(&i);
        let stuck = touching
            .iter()
            .map(|touch| [touch.pair.0, touch.pair.1])
            .filter(|ends| !ends.iter().any(|&i| may_move(i)));
        let moved: BTreeSet<usize> = stuck.flatten().filter(|&i| self.bodies[i].is_dynamic()).collect();
        for &i in &moved {
            self.wake_place(i);
            self.drop_known(i);
            self.unchecked.insert(i);
        }
        !moved.is_empty()
    }

    /// The pairs with an unchecked body that may be closer than the gap, in the order of the second body.
    fn near_unchecked(&self) -> Vec<(usize, usize)> {
        if self.unchecked.is_empty() {
            return Vec::new();
        }
        self.near_pairs(|a, b| self.unchecked.contains(&a) || self.unchecked.contains(&b))
    }

    /// The pairs that meet, are wanted, and may be closer than the gap, in the order of the second body.
    fn near_pairs(&self, wanted: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
        let gap = self.options.gap;
        let boxes: Vec<Aabb> = self.bodies.iter().map(|body| posed(body, self.time, gap)).collect();
        let (mut tree, mut near) = (BoxTree::default(), Vec::new());
        tree.fit(&boxes);
        tree.pairs(&boxes, 0.0, |[a, b]| {
            let (a, b) = (a as usize, b as usize);
            if wanted(a, b) && self.meets(a, b) {
                near.push((b, a));
            }
        });
        near.sort_unstable();
        near.into_iter().map(|(b, a)| (a, b)).collect()
    }

    /// Checks that this body intersects no other. It may touch them.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`], with the body that it intersects.
    pub(crate) fn check_place(&self, place: usize) -> Result<(), SimulationError> {
        let mut others = (0..self.bodies.len()).filter(|other| *other != place);
        others.try_for_each(|other| self.check_pair(place, other))
    }

    /// Checks that two bodies do not intersect, if they meet. They may touch.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`].
    pub(crate) fn check_pair(&self, a: usize, b: usize) -> Result<(), SimulationError> {
        let (gap, now) = (self.options.gap, self.time);
        let (one, two) = (&self.bodies[a], &self.bodies[b]);
        let is_near = self.meets(a, b)
            && !are_spheres_apart(one, two, now, now, gap)
            && posed(one, now, gap).may_meet(&posed(two, now, gap), 0.0);
        if is_near { self.placed(a.min(b), a.max(b)).map(|_| ()) } else { Ok(()) }
    }

    /// Checks that no two checked bodies intersect. The next step checks the others.
    ///
    /// # Errors
    /// [`SimulationError::Intersecting`].
    pub(crate) fn check_all(&self) -> Result<(), SimulationError> {
        let is_checked = |a: usize, b: usize| !(self.unchecked.contains(&a) || self.unchecked.contains(&b));
        self.near_pairs(is_checked).into_iter().try_for_each(|(a, b)| self.placed(a, b).map(|_| ()))
    }

    /// Makes the pair: one that starts closer than the gap keeps its distance, or [`LEAST_KEPT`]. Returns it
    /// if it touches.
    fn admit_placed(&mut self, (a, b): (usize, usize), placed: Placed) -> Option<Touch> {
        match placed {
            Placed::Apart(within) => {
                // A pair that has been parted goes on to the gap.
                if let Some(distance) = within
                    && !self.pairs.contains_key(&(a, b))
                {
                    let kept = distance.max(LEAST_KEPT * self.options.gap);
                    self.pairs.insert((a, b), Box::new(Pair::new(kept)));
                }
                None
            }
            Placed::Touching(touch) => {
                self.pairs.insert((a, b), Box::new(Pair::new(self.options.gap)));
                Some(touch)
            }
        }
    }

    /// Finds how two bodies lie.
    fn placed(&self, a: usize, b: usize) -> Result<Placed, SimulationError> {
        let gap = self.options.gap;
        let (one, two) = (&self.bodies[a], &self.bodies[b]);
        let poses = [one, two].map(|body| body.pose_at(self.time));
        let found = distance_of([one, two], poses, gap, &mut PairCache::new());
        let found = found.map_err(|error| one.query_error(two, error))?;
        // For round bodies that touch, rounding decides whether they are apart.
        let rounded = ROUNDING * (one.rounding + two.rounding);
        let is_apart = |found: &Distance| found.state == StartState::Apart && found.lower >= rounded;
        let apart = found.as_ref().filter(|found| is_apart(found)).map(|found| found.lower);
        let placed_apart = || match held_at([one, two], poses, apart.unwrap_or(gap)) {
            Ok(Some(point)) => Err(self.intersecting((a, b), point)),
            Ok(None) => Ok(Placed::Apart(apart.filter(|lower| *lower < gap))),
            Err(error) => Err(one.query_error(two, error)),
        };
        let resolved = STILL_APART * APART * size([one, two]);
        let Some(found) = found.filter(|_| apart.is_none_or(|lower| lower < resolved)) else {
            return placed_apart();
        };
        let point = 0.5 * (found.point_a + found.point_b);
        let contacts = if found.state == StartState::Contained { None } else { self.touch_contacts(a, b) };
        match contacts {
            Some(contacts) => Ok(Placed::Touching(Touch { pair: (a, b), contacts, point })),
            None if apart.is_some() => placed_apart(),
            None => Err(self.intersecting((a, b), point)),
        }
    }

    fn intersecting(&self, (a, b): (usize, usize), point: DVec3) -> SimulationError {
        let depth = self.depth(a, b);
        let (a, b) = (self.bodies[a].name.to_string(), self.bodies[b].name.to_string());
        SimulationError::Intersecting { a, b, depth, point }
    }

    /// The distance of two bodies with the second one moved by this; none: they are not proven apart.
    fn distance_after(&self, a: usize, b: usize, moved: DVec3) -> Option<f64> {
        let (one, two) = (&self.bodies[a], &self.bodies[b]);
        let mut pose = two.pose_at(self.time);
        pose.translation += moved;
        let poses = [one.pose_at(self.time), pose];
        let found = distance_of([one, two], poses, f64::INFINITY, &mut PairCache::new()).ok()??;
        let is_apart =
            found.state == StartState::Apart && held_at([one, two], poses, found.lower) == Ok(None);
        is_apart.then_some(found.lower)
    }

    /// The contacts of two bodies that touch up to rounding; none: they overlap.
    fn touch_contacts(&self, a: usize, b: usize) -> Option<Vec<ContactPoint>> {
        let bodies = [&self.bodies[a], &self.bodies[b]];
        let trial = TRIAL * size(bodies);
        // The direction in which it comes furthest away.
        let away = |way: &DVec3| self.distance_after(a, b, *way * trial).map(|distance| (distance, *way));
        let (_, way) = ways(bodies).iter().filter_map(away).reduce(|x, y| if y.0 > x.0 { y } else { x })?;
        let mut moved = bodies[1].clone();
        moved.flight = moved.flight.with_position(moved.flight.position() + way * trial);
        let pair = [bodies[0].clone(), moved];
        let found = measure(&pair, (0, 1), self.time, 2.0 * trial, trial, self.material(a, b), &[]).ok()?;
        let back = |c: &ContactPoint| {
            let distance = c.distance - c.normal.dot(way) * trial;
            let mut contact = ContactPoint { a, b, distance, ..*c };
            contact.material.friction = 0.0;
            contact
        };
        let contacts: Vec<ContactPoint> = found.contacts.iter().map(back).collect();
        let deepest = contacts.iter().map(|c| -c.distance).fold(f64::NEG_INFINITY, f64::max);
        let is_touch = !contacts.is_empty() && deepest <= ROUNDING * size(bodies);
        is_touch.then_some(contacts)
    }

    /// About how far the second body would have to be moved to be free, along the best of some directions.
    fn depth(&self, a: usize, b: usize) -> f64 {
        let bodies = [&self.bodies[a], &self.bodies[b]];
        let most = bodies[0].radius + bodies[1].radius;
        let far = bodies[0].pose_at(self.time).translation.distance(bodies[1].pose_at(self.time).translation);
        let along = |way: &DVec3| {
            let (mut low, mut high) = (0.0, 2.0 * most + far);
            for _ in 0..20 {
                let middle = 0.5 * (low + high);
                if self.distance_after(a, b, *way * middle).is_some() {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            high
        };
        ways(bodies).iter().map(along).fold(f64::INFINITY, f64::min)
    }

    /// Moves unchecked bodies by the least that parts touching ones: the solution of their contacts, with
    /// displacements in place of velocities.
    fn part(&mut self, touching: &[Touch]) {
        let contacts: Vec<ContactPoint> =
            touching.iter().flat_map(|touch| touch.contacts.iter().copied()).collect();
        let body = |(i, body): (usize, &RigidBody)| {
            let is_free = self.unchecked.contains(&i) && body.is_dynamic();
            let inverse_mass = if is_free { body.inverse_mass } else { 0.0 };
            let inverse_inertia =
                if is_free { body.inverse_inertia_at(body.orientation) } else { DMat3::ZERO };
            SolverBody { inverse_mass, inverse_inertia, velocity: Velocity::default() }
        };
        let bodies = self.bodies.iter().enumerate().map(body).collect();
        let wanted = |touch: &Touch| APART * size([touch.pair.0, touch.pair.1].map(|i| &self.bodies[i]));
        let target = |touch: &Touch| {
            let wanted = wanted(touch);
            touch.contacts.iter().map(move |c| wanted - c.distance).collect::<Vec<f64>>()
        };
        let targets: Vec<f64> = touching.iter().flat_map(target).collect();
        let precision = touching.iter().map(wanted).fold(f64::INFINITY, f64::min) / 16.0;
        let mut system = System::new(bodies, &contacts, |body| body);
        let (relative, aim, company, slow) = (0.0, 1.0, Company::Few, f64::INFINITY);
        let accuracy =
            Accuracy { precision, relative, aim, company, slow, still: None, beside_sleepers: false };
        system.solve(&targets, accuracy, Start::Sticking);
        for &i in &self.unchecked {
            let body = &mut self.bodies[i];
            if body.is_dynamic() {
                body.shift(system.bodies[i].velocity);
            }
        }
    }
}

/// Directions in which the second body may come free of the first one: from center to center, the axes, and
/// halfway between them.
fn ways([a, b]: [&RigidBody; 2]) -> Vec<DVec3> {
    let mut ways = vec![(b.position - a.position).normalize_or_zero()];
    let steps = [0.0, 1.0, -1.0];
    for x in steps {
        for y in steps {
            for z in steps {
                ways.push(DVec3::new(x, y, z).normalize_or_zero());
            }
        }
    }
    ways.retain(|way| *way != DVec3::ZERO);
    ways
}
