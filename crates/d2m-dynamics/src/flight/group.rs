//! Islands: bodies that are in contact with each other, and the velocities of their next flights.

use crate::SimulationOptions;
use crate::body::rigid_body::RigidBody;
use crate::flight::account::{Anchor, Entry, LEAST_PART, balance};
use crate::flight::length::Clock;
use crate::flight::problem::Problem;
use crate::flight::rows::{HIT, Span};
use crate::flight::solved_body::{body_at, moves, still, world_inertia};
use crate::joint::rows::Joined;
use d2m_contact::{Company, ContactPoint, Momenta, System, Velocity, add_impulses, impact};
use d2m_mesh::DisjointSets;
use glam::DMat3;
use std::borrow::Cow;

/// From this number of bodies on a simulation is a crowd.
pub(crate) const CROWD: usize = 64;
/// The contacts of one island: bodies that impulses connect, named by their numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Island<'c> {
    pub(crate) contacts: Vec<&'c ContactPoint>,
}

/// The solution of an island: velocities of the next flights and additions to the momenta.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solved {
    pub(crate) bodies: Vec<Push>,
    /// The impulses of restitution, and those of resting contact.
    pub(crate) impacts: Vec<ContactPoint>,
    pub(crate) rests: Vec<ContactPoint>,
    /// The residual: how far the rates are from the law of contact.
    pub(crate) residual: f64,
    /// Joints are torn by more than a gap, even in the shortest flights.
    pub(crate) is_torn: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    pub(crate) body: usize,
    pub(crate) velocity: Velocity,
    pub(crate) horizon: f64,
    pub(crate) lead: f64,
    /// The momenta that impacts add, and those that resting contacts add.
    pub(crate) impact: Momenta,
    pub(crate) rest: Momenta,
    /// The balance of the body's energy account afterwards.
    pub(crate) gained: f64,
}

/// The islands of these contacts, in the order of their first contact. Only bodies that impulses move connect
/// others.
pub(crate) fn islands<'c>(bodies: &[RigidBody], contacts: Vec<&'c ContactPoint>) -> Vec<Island<'c>> {
    let mut joined = DisjointSets::new(bodies.len());
    let moves = |i: usize| moves(&bodies[i]);
    for c in contacts.iter().filter(|c| moves(c.a) && moves(c.b)) {
        joined.join([c.a as u32, c.b as u32]);
    }
    let mut place: Vec<Option<usize>> = vec![None; bodies.len()];
    let mut sizes: Vec<usize> = Vec::new();
    let mut numbers = Vec::with_capacity(contacts.len());
    for c in &contacts {
        let body = if moves(c.a) { c.a } else { c.b };
        let number = *place[joined.root(body as u32) as usize].get_or_insert(sizes.len());
        if number == sizes.len() {
            sizes.push(0);
        }
        sizes[number] += 1;
        numbers.push(number);
    }
    if sizes.len() == 1 {
        return vec![Island { contacts }];
    }
    let mut found: Vec<Island<'_>> =
        sizes.into_iter().map(|size| Island { contacts: Vec::with_capacity(size) }).collect();
    for (contact, number) in contacts.into_iter().zip(numbers) {
        found[number].contacts.push(contact);
    }
    found
}

/// Solves the impacts of an island, then the velocities of the flights that begin now. The solver starts with
/// the impulses of the contacts.
pub(crate) fn solve(
    bodies: &[RigidBody],
    island: &Island<'_>,
    clock: Clock,
    options: &SimulationOptions,
    joints: &[Joined],
    company: Company,
) -> Solved {
    let mut members: Vec<usize> = island.contacts.iter().flat_map(|c| [c.a, c.b]).collect();
    members.sort_unstable();
    members.dedup();
    let place = |body: usize| members.binary_search(&body).unwrap_or_default();
    let mut states: Vec<Cow<'_, RigidBody>> = members.iter().map(|&i| bodies[i].at(clock.now)).collect();
    let Impacts { contacts: hits, momenta: impacts } = impacts_of(&states, island, options, place);
    for (state, added) in states.iter_mut().zip(&impacts) {
        if *added != Momenta::default() && moves(state) {
            state.to_mut().push(*added);
        }
    }

    let problem =
        Problem { members: &members, states: &states, contacts: &island.contacts, options, joints, company };
    let mut attempt = problem.solve(clock);
    let (end, residual) = (attempt.end, attempt.found.residual);
    let is_torn = problem.is_torn(&attempt);
    let inertia: Vec<(f64, DMat3)> = states.iter().map(|s| world_inertia(s)).collect();
    // Springs and motors may do work. The work of joints alone is balanced by the midpoint rule, not by
    // accounts.
    let driven = states.iter().any(|s| !moves(s) && !s.stands_still())
        || island.contacts.iter().any(|c| c.row.is_some() || c.running != [0.0; 2]);
    let mut rests = vec![Momenta::default(); members.len()];
    add_impulses(&attempt.found.contacts, &mut rests, place);
    // The velocity that restores the gap, or makes room for rotation, acts in this flight and leaves no
    // momentum.
    let velocities = |system: &System| system.bodies.iter().map(|body| body.velocity).collect::<Vec<_>>();
    let mut physical = velocities(&attempt.system);
    let span = attempt.span;
    if let Some(gained) = attempt.make_room(&inertia) {
        let is_limited = attempt.limit_room(&physical, &inertia, problem.speed());
        // What accounts may hold, and the energy of the speed that covers a gap in a step.
        let speed = options.gap / options.step;
        let held = |s: &Cow<'_, RigidBody>| {
            s.energy_limit(options.gravity, options.step, options.gap) + 0.5 * s.mass * speed * speed
        };
        let most: f64 = states.iter().filter(|s| moves(s)).map(held).sum();
        if !problem.ends_with_energy_of_turning(&attempt) {
            // Room would turn a thin body so far that its momenta had another energy: shorter flights will
            // make it.
            for (body, velocity) in attempt.system.bodies.iter_mut().zip(&physical) {
                body.velocity = *velocity;
            }
        } else if !is_limited && gained.abs() > most {
            // Then impulses make the room, as other impulses do, and the account sees to their energy.
            attempt.store(&members);
            rests.fill(Momenta::default());
            add_impulses(&attempt.found.contacts, &mut rests, place);
            physical = velocities(&attempt.system);
        }
    }
    let outcome = |k: usize| Outcome {
        body: members[k],
        state: &states[k],
        inertia: inertia[k].1,
        before: bodies[members[k]].momenta(),
        impact: impacts[k],
        rest: rests[k],
        physical: physical[k],
        velocity: attempt.system.bodies[k].velocity,
        lead: states[k].lead.unwrap_or(0.5 * span.remaining),
    };
    let outcomes: Vec<Outcome<'_>> = (0..states.len()).filter(|&k| moves(&states[k])).map(outcome).collect();
    // Kinematic bodies may do work.
    let anchor = match (driven, outcomes.len() < states.len()) {
        (true, _) => None,
        (false, true) => Some(Anchor::World),
        (false, false) => Some(Anchor::Bodies),
    };
    let indices: Vec<usize> = outcomes.iter().map(|outcome| outcome.body).collect();
    // Contacts with hardly any room left open by a part of their rates in any case, as room is made in any case.
    let most = |braking: &[Velocity]| {
        let braked =
            |body: usize| indices.binary_search(&body).map_or_else(|_| Velocity::default(), |k| braking[k]);
        attempt.most_of(braked, LEAST_PART)
    };
    let bodies = settle(&outcomes, anchor, end, span, options, most);
    Solved { bodies, impacts: hits, rests: attempt.found.contacts, residual, is_torn }
}

/// The impulses of restitution, and what they add to the momenta of each body.
struct Impacts {
    contacts: Vec<ContactPoint>,
    momenta: Vec<Momenta>,
}

/// The impacts at the contacts of an island that bounce and have been hit, solved with the equations of its
/// joints. So joints pass impacts on without a loss of energy, as the rod of a pendulum does.
fn impacts_of(
    states: &[Cow<'_, RigidBody>],
    island: &Island<'_>,
    options: &SimulationOptions,
    place: impl Fn(usize) -> usize + Copy,
) -> Impacts {
    let mut momenta = vec![Momenta::default(); states.len()];
    let is_hit = |c: &ContactPoint| c.material.restitution > 0.0 && c.distance <= HIT * c.gap;
    let hit: Vec<ContactPoint> = island.contacts.iter().copied().filter(|c| is_hit(c)).copied().collect();
    if hit.is_empty() {
        return Impacts { contacts: hit, momenta };
    }
    let equations = island.contacts.iter().copied().filter(|c| c.row.is_some_and(|row| row.is_equation()));
    let hit: Vec<ContactPoint> = hit.into_iter().chain(equations.copied()).collect();
    let inertia: Vec<(f64, DMat3)> = states.iter().map(|s| world_inertia(s)).collect();
    let start = |s: &Cow<'_, RigidBody>| {
        if moves(s) { body_at(s, s.velocity(), s.inverse_inertia_at(s.orientation)) } else { still(s) }
    };
    let mut system = System::new(states.iter().map(start).collect(), &hit, place);
    let contacts = impact(&mut system, &hit, &inertia, options.resting_speed());
    add_impulses(&contacts, &mut momenta, place);
    Impacts { contacts, momenta }
}

/// The solution of an island for one of its bodies.
struct Outcome<'s> {
    body: usize,
    /// The body with the impacts.
    state: &'s RigidBody,
    /// In world axes.
    inertia: DMat3,
    before: Momenta,
    impact: Momenta,
    rest: Momenta,
    /// The velocity of the momenta, and that of the flight, which also makes room.
    physical: Velocity,
    velocity: Velocity,
    lead: f64,
}

/// Balances the energy accounts where nothing else does work (`anchor`). Returns the velocities of the
/// flights until `end`.
fn settle(
    outcomes: &[Outcome<'_>],
    anchor: Option<Anchor>,
    end: f64,
    span: Span,
    options: &SimulationOptions,
    most: impl Fn(&[Velocity]) -> f64,
) -> Vec<Push> {
    let entry = |o: &Outcome<'_>| Entry {
        mass: o.state.mass,
        inertia: o.inertia,
        inverse_inertia: o.state.inverse_inertia_at(o.state.orientation),
        position: o.state.position,
        force: o.state.force_with(options.gravity),
        torque: o.state.torque,
        gained: o.state.gained,
        limit: o.state.energy_limit(options.gravity, options.step, options.gap),
        before: o.before,
        after: o.before + o.impact + o.rest,
        lead: o.lead,
        room: o.velocity - o.physical,
    };
    let entries: Vec<Entry> = outcomes.iter().map(entry).collect();
    let mass: f64 = entries.iter().map(|e| e.mass).sum();
    let sheet = anchor.map(|anchor| balance(&entries, anchor, span.remaining, most));
    let push = |(place, (o, e)): (usize, (&Outcome<'_>, &Entry))| {
        let mut push = Push {
            body: o.body,
            velocity: o.velocity,
            horizon: end,
            lead: o.lead,
            impact: o.impact,
            rest: o.rest,
            gained: e.gained,
        };
        if let Some(sheet) = &sheet {
            push.gained = sheet.gained * e.mass / mass;
            if let Some(braking) = &sheet.braking {
                let braked = braking[place];
                push.velocity = o.physical + braked + e.room * sheet.part;
                push.rest.linear += braked.linear * e.mass;
                push.rest.angular += e.inertia * braked.angular;
            }
        }
        push
    };
    outcomes.iter().zip(&entries).enumerate().map(push).collect()
}
