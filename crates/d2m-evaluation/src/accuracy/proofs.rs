//! `cargo xtask accuracy verify`: answers of the engine proven again by the verifier, what that costs, and lies that are not proven.
use super::{Outcome, Task};
use crate::bench::Body;
use crate::statistics::Summary;
use crate::trials::{self, Law, Movement};
use d2m::bvh::{Evidence, MeshTree, Moving, QueryOptions, Solid, StartState, TimeOfContact, TriMesh, Window};
use d2m::motion::ConstantTwist;
use d2m::verify::{DEFAULT_STEPS, Reason, Verdict, Verifier};
use d2m::{Contact, time_of_contact};
use d2m_testing::{SmallScene, Xoshiro256 as Random};
use std::time::Instant;

/// What a verdict says of the engine.
pub(super) enum Judgement {
    /// The answer is true.
    Proven,
    /// It is false.
    Refuted(String),
    /// It contradicts itself, or promises less than it should.
    Contradicts(String),
    /// The verifier could not decide.
    Open(Reason),
}

pub(super) fn judgement(verdict: Verdict) -> Judgement {
    match verdict {
        Verdict::Verified { .. } => Judgement::Proven,
        Verdict::Refuted { time, triangles, distance } => {
            Judgement::Refuted(format!("at t = {time:?} triangles {triangles:?} are {distance} apart"))
        }
        Verdict::Unproven { reason, .. } => match reason {
            Reason::Steps
            | Reason::TooClose
            | Reason::TimeResolution
            | Reason::Enclosure
            | Reason::NoMeeting
            // Of needles the verifier does not enclose a distance as tightly as the engine rounds it.
            | Reason::Distance
            | Reason::NotParted
            | Reason::Solid => Judgement::Open(reason),
            _ => Judgement::Contradicts(reason.to_string()),
        },
    }
}

/// Pairs of shapes whose answers are proven again and timed.
const PAIRS: [(&str, &str); 5] = [
    ("gear?triangles=476", "gear?triangles=476"),
    ("torus?triangles=1332", "torus?triangles=3240&tube=0.2"),
    ("screw?triangles=2828", "nut?triangles=2418"),
    ("pebble?triangles=5856", "pebble?triangles=5804&seed=2"),
    ("torus-knot?triangles=70000", "torus-knot?triangles=70000"),
];
/// Units per unit of time.
const SPEEDS: [f64; 2] = [4.0, 512.0];
/// Trials of each pair and speed.
const TRIALS: usize = 32;
/// The best of so many runs counts.
const RUNS: usize = 3;
/// Steps for an answer about a small scene, and for a lie.
pub(super) const STEPS: u64 = 100_000;

pub(super) fn run(task: &Task) -> Outcome {
    let mut outcome = Outcome::default();
    for (a, b) in PAIRS {
        pair(task, [a, b], &mut outcome);
    }
    scenes(task, &mut outcome);
    outcome
}

impl Outcome {
    fn count(&mut self, line: impl Fn() -> String, answer: &TimeOfContact, verdict: Verdict) {
        self.cases += 1;
        self.contacts += usize::from(answer.contact().is_some());
        self.undecided += usize::from(matches!(answer, TimeOfContact::Undecided { .. }));
        match judgement(verdict) {
            Judgement::Proven => {}
            Judgement::Refuted(why) => self.false_negatives.push(format!("{}: {why}", line())),
            Judgement::Contradicts(why) => self.false_alarms.push(format!("{}: {why}", line())),
            Judgement::Open(reason) => *self.unproven.entry(reason).or_default() += 1,
        }
    }
}

/// The answers of one pair of shapes, and a line of what their proofs cost.
fn pair(task: &Task, shapes: [&str; 2], outcome: &mut Outcome) {
    let trees = shapes.map(|shape| MeshTree::new(Body::unit_shape(shape).expect("an embedded shape")));
    let verifier = Verifier::try_new(trees[0].mesh(), trees[1].mesh()).expect("triangles");
    for speed in SPEEDS {
        let law = Law { speed, ..Law::PAPER };
        let (mut steps, mut ratios, mut open) = (Vec::new(), Vec::new(), 0);
        for (index, trial) in trials::generate(&law, task.seed, TRIALS).iter().enumerate() {
            let motion = |m: &Movement| {
                ConstantTwist::try_new(m.position, m.rotation, m.velocity, m.angular_velocity)
                    .expect("finite")
            };
            let motions = [motion(&trial.a), motion(&trial.b)];
            let bodies = [0, 1].map(|k| Moving::new(&trees[k], &motions[k]));
            let options = QueryOptions::default();
            let query =
                || time_of_contact(bodies[0], bodies[1], Window::UNIT, &options).expect("valid input");
            let answer = query();
            let prove = || verifier.time_of_contact(&bodies, Window::UNIT, &options, &answer, DEFAULT_STEPS);
            let verdict = prove();
            ratios.push(best_of(|| _ = prove()) / best_of(|| _ = query()));
            match verdict {
                Verdict::Verified { steps: taken } => steps.push(taken as f64),
                _ => open += 1,
            }
            outcome.count(|| format!("{shapes:?} at {speed}, trial {index}"), &answer, verdict);
        }
        let median = |of: Vec<f64>| Summary::of(of).map_or([f64::NAN; 2], |s| [s.median, s.worst]);
        let ([steps, most_steps], [ratio, most]) = (median(steps), median(ratios));
        println!(
            "  {:<28} speed {speed:>3}: {steps:.0} steps (at most {most_steps:.0}), {ratio:.0} times the query (at most {most:.0}), {open} of {TRIALS} unproven",
            shapes[0]
        );
    }
}

/// Seconds of the fastest run.
fn best_of(mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..RUNS).map(time).fold(f64::INFINITY, f64::min)
}

/// Hard small scenes, in every mode and with a minimum separation; and so many lies about them as are wanted.
fn scenes(task: &Task, outcome: &mut Outcome) {
    let mut lies = Lies { random: Random::new(task.seed), tried: 0, refuted: 0, wanted: task.lies };
    let mut index = 0;
    while index < task.count as u64 || lies.tried < lies.wanted {
        let tree =
            |surface: &d2m_testing::Surface| MeshTree::new(surface.clone().into_mesh(TriMesh::try_new));
        let scene = SmallScene::draw(task.seed, index, |surface| tree(surface).is_watertight());
        let trees = scene.surfaces.each_ref().map(tree);
        let window = Window::try_new(scene.window[0], scene.window[1]).expect("in order");
        let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
        let separation = if index % 3 == 2 { 0.0625 } else { 0.0 };
        let mode = if index % 4 == 3 { d2m::Mode::Capoeira } else { d2m::Mode::Accurate };
        let options =
            QueryOptions::default().with_solid(solid).with_min_separation(separation).with_mode(mode);
        let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
        let answer = time_of_contact(bodies[0], bodies[1], window, &options).expect("valid input");
        let verifier = Verifier::try_new(trees[0].mesh(), trees[1].mesh()).expect("triangles");
        let verify =
            |answer: &TimeOfContact| verifier.time_of_contact(&bodies, window, &options, answer, STEPS);
        if index < task.count as u64 {
            outcome.count(|| format!("{}: {answer:?}", scene.name), &answer, verify(&answer));
        }
        if let TimeOfContact::Contact(contact) = &answer {
            for (name, lie) in lies.about(contact) {
                let verdict = verify(&lie);
                lies.tried += 1;
                lies.refuted += usize::from(matches!(verdict, Verdict::Refuted { .. }));
                if matches!(verdict, Verdict::Verified { .. }) {
                    outcome
                        .false_negatives
                        .push(format!("{}: a lie was verified ({name}): {lie:?}", scene.name));
                }
            }
        }
        index += 1;
    }
    println!("  {} lies tried, {} refuted, the others not proven", lies.tried, lies.refuted);
}

struct Lies {
    random: Random,
    tried: usize,
    refuted: usize,
    wanted: usize,
}

impl Lies {
    /// What is certainly false of this contact.
    fn about(&mut self, contact: &Contact) -> Vec<(&'static str, TimeOfContact)> {
        let mut lies = Vec::new();
        if self.tried >= self.wanted {
            return lies;
        }
        let mut edited = |name, edit: &dyn Fn(&mut Contact)| {
            let mut lie = *contact;
            edit(&mut lie);
            lies.push((name, TimeOfContact::Contact(lie)));
        };
        if contact.start == StartState::Apart {
            for exponent in [-9, -8, -7, -6, -5, -4, -3] {
                let later = contact.time_lo + 10f64.powi(exponent) * self.random.range(1.0, 10.0);
                // As far apart then as the tolerance does not resolve: no lie.
                if contact.closing_speed * (later - contact.time_lo) > contact.tolerance {
                    edited("a later time", &|lie| {
                        (lie.time_lo, lie.time_hi) = (later, lie.time_hi.max(later));
                    });
                }
            }
        }
        if contact.start != StartState::Contained {
            for factor in [0.5, 0.99, 1.01, 2.0] {
                let change = contact.separation * (factor - 1.0);
                if change.abs() > 0.5 * contact.tolerance {
                    edited("another separation", &|lie| lie.separation += change);
                }
            }
            if contact.separation > 1e-3 {
                let aside = contact.normal.any_orthonormal_vector() * self.random.range(1e-3, 1.0);
                edited("a shifted normal", &|lie| lie.normal = (lie.normal + aside).normalize());
            }
        }
        // Bodies that come within the tolerance of each other may share no point.
        if contact.evidence == Evidence::Crossing {
            lies.push(("separated", TimeOfContact::Separated));
        }
        lies
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The command's family, reduced: hard scenes and lies.
    #[test]
    fn answers_are_proven_and_lies_are_not() {
        let mut outcome = Outcome::default();
        scenes(&Task { count: 300, seed: 3, lies: 2000, sabotage: None }, &mut outcome);
        assert!(outcome.false_negatives.is_empty() && outcome.false_alarms.is_empty(), "{outcome:?}");
        assert!(outcome.cases == 300 && outcome.contacts > 100, "{outcome:?}");
        assert!(outcome.unproven.values().sum::<usize>() <= 3, "{outcome:?}");
    }
}
