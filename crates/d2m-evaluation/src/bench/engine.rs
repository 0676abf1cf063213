//! The only place where the bench queries the product: one adapter per query.
use super::body::{Body, Pair};
use crate::judge::Claim;
use crate::trials::{Movement, Trial};
use d2m::bvh::{
    self, Clearance, ClearanceOptions, Moving, Posed, QueryOptions, Solid, TimeOfContact, Window,
};
use d2m::motion::{ConstantTwist, RigidMotion};

type Error = Box<dyn std::error::Error>;

/// Both bodies' motions over [0, 1].
pub(crate) struct Motions {
    a: ConstantTwist,
    b: ConstantTwist,
}

impl Motions {
    pub(crate) fn new(trial: &Trial) -> Result<Self, Error> {
        let motion =
            |m: &Movement| ConstantTwist::try_new(m.position, m.rotation, m.velocity, m.angular_velocity);
        Ok(Self { a: motion(&trial.a)?, b: motion(&trial.b)? })
    }
}

/// Filled solids where both meshes close, surfaces otherwise.
pub(crate) fn solid(pair: &Pair) -> Solid {
    let closed = |body: &Body| body.tree.is_watertight();
    if closed(&pair.a) && closed(&pair.b) { Solid::Filled } else { Solid::Surface }
}

/// The default engine's time of contact.
pub(crate) fn time_of_contact(pair: &Pair, motions: &Motions, options: &QueryOptions) -> Claim {
    let (a, b) = (Moving::new(&pair.a.tree, &motions.a), Moving::new(&pair.b.tree, &motions.b));
    claim(bvh::time_of_contact(a, b, Window::UNIT, options))
}

/// The same as the engine gives it.
pub(crate) fn answer(pair: &Pair, motions: &Motions, options: &QueryOptions) -> TimeOfContact {
    let (a, b) = (Moving::new(&pair.a.tree, &motions.a), Moving::new(&pair.b.tree, &motions.b));
    bvh::time_of_contact(a, b, Window::UNIT, options).expect("trials are valid input")
}

/// How near the bodies come, with the default accuracy.
pub(crate) fn clearance(pair: &Pair, motions: &Motions, tolerance: f64) -> Clearance {
    let (a, b) = (Moving::new(&pair.a.tree, &motions.a), Moving::new(&pair.b.tree, &motions.b));
    let options = ClearanceOptions::default().with_tolerance(tolerance).with_solid(solid(pair));
    bvh::clearance(a, b, Window::UNIT, &options).expect("trials are valid input")
}

/// The reference method's.
pub(crate) fn paper(pair: &Pair, motions: &Motions, options: &QueryOptions) -> Claim {
    let a = Moving::new(pair.a.spheres(), &motions.a);
    let b = Moving::new(pair.b.spheres(), &motions.b);
    claim(d2m_paper::time_of_contact(a, b, Window::UNIT, options))
}

fn posed<'a>(pair: &'a Pair, motions: &Motions, t: f64) -> [Posed<'a>; 2] {
    let posed = |body: &'a Body, motion: &ConstantTwist| Posed::new(&body.tree, motion.pose_and_twist(t).0);
    [posed(&pair.a, &motions.a), posed(&pair.b, &motions.b)]
}

/// The static test at a time, surfaces only as the peers do.
pub(crate) fn collide(pair: &Pair, motions: &Motions, t: f64) -> bool {
    let [a, b] = posed(pair, motions, t);
    bvh::collide(a, b, Solid::Surface).expect("trials are valid input")
}

/// The static distance at a time.
pub(crate) fn distance(pair: &Pair, motions: &Motions, t: f64) -> f64 {
    let [a, b] = posed(pair, motions, t);
    bvh::distance(a, b, Solid::Surface).expect("trials are valid input").lower
}

fn claim(answer: Result<TimeOfContact, bvh::QueryError>) -> Claim {
    match answer.expect("trials are valid input") {
        TimeOfContact::Separated => Claim::Separated,
        TimeOfContact::Contact(c) => Claim::Contact { lo: c.time_lo, hi: c.time_hi, tolerance: c.tolerance },
        TimeOfContact::Undecided { clear_until } => Claim::Undecided { clear_until },
    }
}

/// A deliberate fault, put on right answers to see whether the judge notices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sabotage {
    /// Contacts are reported this much too late.
    Late(f64),
    /// Contacts are reported as "separated".
    Miss,
}

impl std::str::FromStr for Sabotage {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            None if text == "miss" => Ok(Self::Miss),
            Some(("late", by)) => by.parse().map(Self::Late).map_err(|_| format!("no number: {by}")),
            _ => Err("late=1e-6 or miss".into()),
        }
    }
}

impl Sabotage {
    /// The same of a whole answer.
    pub(crate) fn spoil_answer(self, answer: TimeOfContact, window: Window) -> TimeOfContact {
        match (self, answer) {
            (Self::Late(by), TimeOfContact::Contact(mut contact)) => {
                contact.time_lo = (contact.time_lo + by).min(window.end());
                contact.time_hi = (contact.time_hi + by).min(window.end());
                TimeOfContact::Contact(contact)
            }
            (Self::Miss, TimeOfContact::Contact(_)) => TimeOfContact::Separated,
            (_, answer) => answer,
        }
    }

    pub(crate) fn spoil(self, claim: Claim) -> Claim {
        match (self, claim) {
            (Self::Late(by), Claim::Contact { lo, hi, tolerance }) => {
                Claim::Contact { lo: (lo + by).min(1.0), hi: (hi + by).min(1.0), tolerance }
            }
            (Self::Miss, Claim::Contact { .. }) => Claim::Separated,
            _ => claim,
        }
    }
}
