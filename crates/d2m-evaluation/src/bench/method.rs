//! The methods that are compared, and how each answers one query.
use super::Options;
use super::body::Pair;
use super::engine::{self, Motions};
use super::peers;
use crate::judge::{Claim, Placement, advance, place};
use crate::trials::Trial;
use d2m::bvh::{Budget, Mode, QueryOptions};
use std::time::{Duration, Instant};

/// A row of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Method {
    /// The default engine.
    Accurate,
    /// Its bounded-error mode.
    Capoeira,
    /// The paper's method.
    Paper,
    /// Conservative advancement over our own static distance.
    AdvanceOwn,
    /// The same over parry's distance.
    AdvanceParry,
    /// parry's nonlinear shape cast, in a process of its own so that it can be stopped.
    ParryCast,
    /// One static query at the time of contact: the limit of what any search over the same trees can reach.
    Collide,
    /// The static distance there.
    Distance,
    /// parry's intersection test there.
    ParryIntersection,
    /// parry's distance there.
    ParryDistance,
}

/// What advancement over a plain distance stops at.
pub(crate) const ADVANCE_STOP: f64 = 1e-9;

impl Method {
    pub(crate) const ALL: [Self; 10] = [
        Self::Accurate,
        Self::Capoeira,
        Self::Paper,
        Self::AdvanceOwn,
        Self::AdvanceParry,
        Self::ParryCast,
        Self::Collide,
        Self::Distance,
        Self::ParryIntersection,
        Self::ParryDistance,
    ];

    /// In files and on the command line.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Accurate => "accurate",
            Self::Capoeira => "capoeira",
            Self::Paper => "paper",
            Self::AdvanceOwn => "advance-own",
            Self::AdvanceParry => "advance-parry",
            Self::ParryCast => "parry-cast",
            Self::Collide => "collide",
            Self::Distance => "distance",
            Self::ParryIntersection => "parry-intersection",
            Self::ParryDistance => "parry-distance",
        }
    }

    /// For a reader.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Accurate => "d2m accurate",
            Self::Capoeira => "d2m Capoeira",
            Self::Paper => "paper's method",
            Self::AdvanceOwn => "advancement, d2m distance",
            Self::AdvanceParry => "advancement, parry",
            Self::ParryCast => "parry nonlinear cast",
            Self::Collide => "d2m collide at TOC",
            Self::Distance => "d2m distance at TOC",
            Self::ParryIntersection => "parry intersection at TOC",
            Self::ParryDistance => "parry distance at TOC",
        }
    }

    /// Asked at the time of contact that [`Self::Accurate`] found, rather than over the window.
    pub(crate) const fn is_static(self) -> bool {
        matches!(self, Self::Collide | Self::Distance | Self::ParryIntersection | Self::ParryDistance)
    }

    /// Asked once a trial, until the cap; the others are asked in rounds, and the least time counts.
    pub(crate) const fn is_slow(self) -> bool {
        !matches!(self, Self::Accurate | Self::Capoeira | Self::Collide | Self::Distance)
    }

    /// Promises a separation of at most 3.3 tolerances at `lo`.
    pub(crate) const fn is_exact(self) -> bool {
        matches!(self, Self::Accurate | Self::Paper)
    }

    /// Belongs to this project, so that a fault of it is a failure of the run.
    pub(crate) const fn is_ours(self) -> bool {
        matches!(self, Self::Accurate | Self::Capoeira | Self::Paper | Self::AdvanceOwn)
    }
}

/// One question, ready to be asked again and again.
pub(crate) struct Question<'a> {
    pub(crate) pair: &'a Pair,
    pub(crate) trial: &'a Trial,
    motions: Motions,
    options: QueryOptions,
    cap: Duration,
    /// For static methods: where the bodies are, and when.
    at: f64,
    places: (Placement, Placement),
}

impl<'a> Question<'a> {
    pub(crate) fn new(
        pair: &'a Pair,
        trial: &'a Trial,
        tolerance: f64,
        at: f64,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let places = (place(&trial.a, at), place(&trial.b, at));
        let options = QueryOptions::default().with_tolerance(tolerance).with_solid(engine::solid(pair));
        Ok(Self { pair, trial, motions: Motions::new(trial)?, options, cap: Duration::MAX, at, places })
    }

    /// The reference method gives up after this many seconds.
    pub(crate) fn with_cap(mut self, seconds: f64) -> Self {
        self.cap = Duration::from_secs_f64(seconds);
        self
    }

    /// Asks once. A static method answers "contact at the asked time" or "separated".
    pub(crate) fn ask(&self, method: Method) -> Claim {
        let (a, b) = (&self.pair.a, &self.pair.b);
        let still = |distance: f64| {
            if distance < f64::INFINITY { contact(self.at, ADVANCE_STOP) } else { Claim::Separated }
        };
        match method {
            Method::Accurate => engine::time_of_contact(self.pair, &self.motions, &self.options),
            Method::Capoeira => {
                engine::time_of_contact(self.pair, &self.motions, &self.options.with_mode(Mode::Capoeira))
            }
            Method::Paper => {
                let budget = Budget::UNLIMITED.with_wall_clock(self.cap);
                engine::paper(self.pair, &self.motions, &self.options.with_budget(budget))
            }
            Method::AdvanceOwn => self.advance(|t| engine::distance(self.pair, &self.motions, t)),
            Method::AdvanceParry => {
                let (ma, mb) = (a.parry(), b.parry());
                self.advance(|t| peers::distance(ma, mb, &place(&self.trial.a, t), &place(&self.trial.b, t)))
            }
            Method::ParryCast => unreachable!("asked in a process of its own: bench/stopped.rs"),
            Method::Collide => {
                if engine::collide(self.pair, &self.motions, self.at) {
                    still(0.0)
                } else {
                    Claim::Separated
                }
            }
            Method::Distance => still(engine::distance(self.pair, &self.motions, self.at)),
            Method::ParryIntersection => {
                let hit = peers::intersect(a.parry(), b.parry(), &self.places.0, &self.places.1);
                if hit { still(0.0) } else { Claim::Separated }
            }
            Method::ParryDistance => {
                still(peers::distance(a.parry(), b.parry(), &self.places.0, &self.places.1))
            }
        }
    }

    /// Conservative advancement over this distance, until near enough.
    fn advance(&self, separation: impl FnMut(f64) -> f64) -> Claim {
        let radii = [self.pair.a.boxes.radius, self.pair.b.boxes.radius];
        let t = advance(self.trial, radii, [0.0, 1.0], ADVANCE_STOP, separation);
        if t < 1.0 { contact(t, ADVANCE_STOP) } else { Claim::Separated }
    }
}

/// An answer, and the least time in which it was given.
pub(crate) struct Answer {
    pub(crate) claim: Claim,
    pub(crate) microseconds: f64,
}

/// Asks the questions in turn, round by round; a slow method has one round, until its cap.
pub(crate) fn answers(questions: &[Question<'_>], method: Method, options: &Options) -> Vec<Answer> {
    let rounds = if method.is_slow() { 1 } else { options.rounds.max(1) };
    let begin = Instant::now();
    let mut answers: Vec<Answer> = Vec::with_capacity(questions.len());
    for round in 0..rounds {
        for (place, question) in questions.iter().enumerate() {
            if method.is_slow() && begin.elapsed().as_secs_f64() > options.cap() {
                break;
            }
            let start = Instant::now();
            let claim = std::hint::black_box(question.ask(method));
            let microseconds = start.elapsed().as_secs_f64() * 1e6;
            if round == 0 {
                answers.push(Answer { claim, microseconds });
            } else {
                answers[place].microseconds = answers[place].microseconds.min(microseconds);
            }
        }
    }
    answers
}

fn contact(t: f64, tolerance: f64) -> Claim {
    Claim::Contact { lo: t, hi: t, tolerance }
}
