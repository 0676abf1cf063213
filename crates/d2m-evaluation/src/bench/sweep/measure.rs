//! The steps of the series, each of which is stored when it is done.
use super::super::Options;
use super::super::body::{Body, Pair};
use super::super::method::{Method, Question, answers};
use super::super::store::Store;
use super::flights::{Flights, moved, pebbles, slowed};
use super::{FITTED, Growth, NAMES, Point, STEPS, WRONG, file, load, write, wrong};
use crate::judge::{Claim, Judge};
use crate::statistics::Summary;
use crate::trials::{self, Law, Trial};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// A piece of work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// The series that it is for; others may come with it.
    name: &'static str,
    /// Triangles of each body, where the series goes by them.
    size: usize,
    /// About how long it takes.
    pub(crate) seconds: f64,
}

impl std::fmt::Display for Step {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.size > 0 { write!(f, "{} {}", self.name, self.size) } else { f.write_str(self.name) }
    }
}

const fn step(name: &'static str, size: usize, seconds: f64) -> Step {
    Step { name, size, seconds }
}

/// What matters most first; about how long with 128 trials a point, on two quiet cores of 2.5 GHz.
const ALL: [Step; 14] = [
    step("triangles", 1_000, 3.0),
    step("triangles", 4_000, 3.0),
    step("triangles", 16_000, 5.0),
    step("triangles", 64_000, 8.0),
    step("triangles", 256_000, 15.0),
    step("order", 0, 2.0),
    step("threads", 0, 30.0),
    step("tolerance", 0, 20.0),
    step("spin", 0, 40.0),
    step("speed", 0, 30.0),
    step("offset", 0, 20.0),
    step("instructions", 0, 40.0),
    step("triangles", 1_000_000, 30.0),
    step("triangles", 4_000_000, 90.0),
];

/// Triangles at most with `--quick`.
const QUICK_TRIANGLES: usize = 70_000;
/// Trials a point on millions of triangles.
const FEW_TRIALS: usize = 16;

/// The steps that are wanted and that the store lacks.
pub(crate) fn open(options: &Options, store: &Store) -> Result<Vec<Step>, Error> {
    let names = || options.series.iter();
    if let Some(name) = names().find(|name| !NAMES.contains(&name.as_str())) {
        return Err(format!("no series {name}: {}", NAMES.join(", ")).into());
    }
    let done = store.load_text(STEPS).unwrap_or_default();
    let wanted = |step: &Step| {
        let is_named = options.series.is_empty() || names().any(|name| name == step.name);
        let is_small = !options.quick || step.size <= QUICK_TRIANGLES;
        options.wants_series() && is_named && is_small && !done.lines().any(|line| line == step.to_string())
    };
    let pace = if options.quick { 0.15 } else { 1.0 };
    Ok(ALL.into_iter().filter(wanted).map(|s| Step { seconds: pace * s.seconds, ..s }).collect())
}

/// Measures a step and stores its points, and what was judged wrong.
pub(crate) fn measure(
    options: &Options,
    store: &Store,
    step: &Step,
    say: impl Fn(&str),
) -> Result<(), Error> {
    let mut sweep = Sweep { options, points: Vec::new(), wrong: Vec::new() };
    match step.name {
        "triangles" => sweep.triangles(step.size)?,
        "tolerance" => sweep.tolerance()?,
        "spin" => sweep.spin()?,
        "speed" => sweep.speed()?,
        "offset" => sweep.offset()?,
        "threads" => sweep.threads()?,
        "order" => sweep.order()?,
        _ => sweep.instructions()?,
    }
    for name in NAMES {
        let found = sweep.points.iter().filter(|(of, _)| *of == name);
        let mut points: Vec<Point> = found.map(|(_, point)| point.clone()).collect();
        if points.is_empty() {
            continue;
        }
        for Point { series, x, summary: s } in &points {
            say(&format!(
                "  {name:<12} {series:<26} {x:>9.3e}: median {:.4e}, worst {:.4e}",
                s.median, s.worst
            ));
        }
        points.splice(0..0, load(store, name));
        store.save_text(&file(name), &write(&points))?;
        for Growth { series, exponent } in super::exponents(&points).iter().filter(|_| FITTED.contains(&name))
        {
            say(&format!("  {name:<12} {series:<26} fitted exponent {exponent:.3}"));
        }
    }
    let mut faults = wrong(store);
    for line in &sweep.wrong {
        faults += line;
        faults.push('\n');
    }
    store.save_text(WRONG, &faults)?;
    let done = store.load_text(STEPS).unwrap_or_default();
    Ok(store.save_text(STEPS, &format!("{done}{step}\n"))?)
}

struct Sweep<'a> {
    options: &'a Options,
    points: Vec<(&'static str, Point)>,
    wrong: Vec<String>,
}

impl Sweep<'_> {
    fn note(&mut self, name: &'static str, series: &str, x: f64, values: impl IntoIterator<Item = f64>) {
        if let Some(summary) = Summary::of(values) {
            self.points.push((name, Point { series: series.into(), x, summary }));
        }
    }

    fn count(&self) -> usize {
        self.options.count().div_ceil(2)
    }

    /// Trials of the bench's law at this speed.
    fn flights<'a>(&self, pair: &'a Pair, speed: f64) -> Flights<'a> {
        Flights::at_speed(pair, speed, self.options.seed, self.count())
    }

    /// Least times of the rounds in microseconds and separations left, of judged answers only.
    fn measure(
        &mut self,
        what: &str,
        flights: &mut Flights<'_>,
        (method, tolerance): (Method, f64),
    ) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let pair = flights.pair;
        let questions: Vec<Question<'_>> = flights
            .trials
            .iter()
            .map(|trial| Question::new(pair, trial, tolerance, 0.0))
            .collect::<Result<_, _>>()?;
        let answers = answers(&questions, method, self.options);
        let verdicts: Vec<_> = answers
            .par_iter()
            .zip(&flights.trials)
            .zip(&flights.known)
            .map(|((answer, trial), &known)| {
                let judge = Judge { a: &pair.a.boxes, b: &pair.b.boxes, trial };
                judge.check_after(known, &answer.claim, method.is_exact())
            })
            .collect();
        drop(questions);
        let (mut times, mut left) = (Vec::new(), Vec::new());
        for (i, (answer, verdict)) in answers.iter().zip(verdicts).enumerate() {
            match verdict {
                Ok(separation) => {
                    times.push(answer.microseconds);
                    left.push(separation);
                    flights.learn(i, &answer.claim);
                }
                Err(fault) => self.wrong.push(format!("{what} {} trial {i}: {fault}", method.name())),
            }
        }
        Ok((times, left))
    }

    /// Two equal knots of about so many triangles; also what their tree costs.
    fn triangles(&mut self, size: usize) -> Result<(), Error> {
        let single = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let mesh = Body::unit_shape(&format!("torus-knot?triangles={size}"))?;
        let triangles = mesh.triangle_count() as f64;
        let build = || {
            let mesh = mesh.clone();
            let start = Instant::now();
            let tree = single.install(|| super::super::built::build(mesh));
            (start.elapsed().as_secs_f64(), tree)
        };
        let (mut seconds, tree) = build();
        for _ in 1..if size > 300_000 { 1 } else { 3 } {
            seconds = seconds.min(build().0);
        }
        self.note("build", "µs per triangle on one thread", triangles, [seconds * 1e6 / triangles]);
        self.note("build", "bytes per triangle", triangles, [tree.memory_bytes() as f64 / triangles]);
        let body = Body::with_tree(tree);
        let pair = Pair { name: format!("knot {size}"), a: Arc::clone(&body), b: body };
        // To judge one answer on millions of triangles takes seconds.
        let count = if size > 500_000 { self.count().min(FEW_TRIALS) } else { self.count() };
        for speed in [4.0, 512.0] {
            let mut flights = Flights::at_speed(&pair, speed, self.options.seed, count);
            for method in [Method::Accurate, Method::Capoeira] {
                let ask = (method, self.options.tolerance);
                let times = self.measure(&format!("{size} triangles @{speed}"), &mut flights, ask)?.0;
                self.note("triangles", &format!("{} at speed {speed}", method.title()), triangles, times);
            }
        }
        Ok(())
    }

    fn tolerance(&mut self) -> Result<(), Error> {
        let pair = pebbles()?;
        for speed in [4.0, 512.0] {
            let mut flights = self.flights(&pair, speed);
            // The finest first: its times are the latest, so what it says to be free need not be judged again.
            for exponent in (3..=12).rev() {
                let tolerance = 10f64.powi(-exponent);
                let what = format!("tolerance {tolerance:e} @{speed}");
                let (times, left) = self.measure(&what, &mut flights, (Method::Accurate, tolerance))?;
                let series = format!("d2m accurate at speed {speed}");
                self.note("tolerance", &series, tolerance, times);
                self.note("left", &series, tolerance, left);
            }
        }
        Ok(())
    }

    /// Both bodies turning at exactly this angular speed.
    fn spin(&mut self) -> Result<(), Error> {
        let pair = pebbles()?;
        for spin in [0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0] {
            for speed in [4.0, 512.0] {
                let law = Law { speed, spin, fixed_spin: true, ..Law::PAPER };
                let trials = trials::generate(&law, self.options.seed, self.count());
                let mut flights = Flights::new(&pair, trials);
                let ask = (Method::Accurate, self.options.tolerance);
                let times = self.measure(&format!("spin {spin} @{speed}"), &mut flights, ask)?.0;
                self.note("spin", &format!("d2m accurate at speed {speed}"), spin, times);
            }
        }
        Ok(())
    }

    /// Below 4: the last part of the flights at 4, slowed so that the bodies still meet within the window.
    fn speed(&mut self) -> Result<(), Error> {
        const FLIGHT: f64 = 4.0;
        let pair = pebbles()?;
        let flights = self.flights(&pair, FLIGHT);
        let questions = flights.trials.iter().map(|t| Question::new(&pair, t, self.options.tolerance, 0.0));
        let meets: Vec<f64> = questions
            .map(|question| match question?.ask(Method::Accurate) {
                Claim::Contact { lo, .. } => Ok(lo),
                _ => Ok(0.5),
            })
            .collect::<Result<_, Error>>()?;
        for exponent in -6..=6 {
            let speed = 10f64.powi(exponent);
            let mut flights = if speed < FLIGHT {
                let factor = speed / FLIGHT;
                let part = |i: usize| 0.05 + 0.75 * (i as f64 + 0.5) / meets.len() as f64;
                let slow = |(i, trial)| slowed(trial, meets[i] - factor * part(i), factor);
                Flights::new(&pair, flights.trials.iter().enumerate().map(slow).collect())
            } else {
                self.flights(&pair, speed)
            };
            for method in [Method::Accurate, Method::Capoeira] {
                let ask = (method, self.options.tolerance);
                let times = self.measure(&format!("speed {speed:e}"), &mut flights, ask)?.0;
                self.note("speed", method.title(), speed, times);
            }
        }
        Ok(())
    }

    /// Both bodies far from the origin of the world.
    fn offset(&mut self) -> Result<(), Error> {
        let pair = pebbles()?;
        for speed in [4.0, 512.0] {
            let near = self.flights(&pair, speed).trials;
            for offset in [0.0, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6] {
                let trials: Vec<Trial> = near.iter().map(|trial| moved(trial, offset)).collect();
                let mut flights = Flights::new(&pair, trials);
                let ask = (Method::Accurate, self.options.tolerance);
                let (times, left) =
                    self.measure(&format!("offset {offset:e} @{speed}"), &mut flights, ask)?;
                let series = format!("d2m accurate at speed {speed}");
                self.note("offset", &series, offset, times);
                self.note("offset-left", &series, offset, left);
            }
        }
        Ok(())
    }

    /// A curved motion cut into n pieces.
    fn order(&mut self) -> Result<(), Error> {
        for row in super::order::errors(if self.options.quick { 64 } else { 1024 })? {
            self.note("order", "poses held", row.pieces as f64, row.held);
            self.note("order", "linear pieces", row.pieces as f64, row.linear);
        }
        Ok(())
    }

    /// The same queries with each instruction set, numbered from the plainest.
    fn instructions(&mut self) -> Result<(), Error> {
        let (found, wrong) = super::variants::measure(self.options, self.count())?;
        self.wrong.extend(wrong);
        for row in found {
            for (set, times) in row.times.into_iter().enumerate() {
                self.note("instructions", &row.name, set as f64, times);
            }
        }
        Ok(())
    }

    /// A batch of independent queries on pools of one thread and more, in turn within each round: queries per second,
    /// and the same answers.
    fn threads(&mut self) -> Result<(), Error> {
        let pair = pebbles()?;
        let trials =
            trials::generate(&Law::PAPER, self.options.seed, if self.options.quick { 64 } else { 256 });
        let questions: Vec<Question<'_>> = trials
            .iter()
            .map(|trial| Question::new(&pair, trial, self.options.tolerance, 0.0))
            .collect::<Result<_, _>>()?;
        let repeats = if self.options.quick { 20 } else { 100 };
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let pools: Vec<rayon::ThreadPool> = (1..=cores)
            .map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build())
            .collect::<Result<_, _>>()?;
        let mut first: Option<Vec<Claim>> = None;
        let mut rates = vec![Vec::new(); cores];
        for _ in 0..self.options.rounds.max(3) {
            for (pool, rates) in pools.iter().zip(&mut rates) {
                let start = Instant::now();
                let claims: Vec<Claim> = pool.install(|| {
                    let ask = |i: usize| questions[i % questions.len()].ask(Method::Accurate);
                    (0..questions.len() * repeats).into_par_iter().map(ask).collect()
                });
                rates.push(claims.len() as f64 / start.elapsed().as_secs_f64());
                if first.get_or_insert_with(|| claims.clone()) != &claims {
                    let threads = pool.current_num_threads();
                    self.wrong.push(format!("{threads} threads give other answers than one"));
                }
            }
        }
        for (index, rates) in rates.into_iter().enumerate() {
            self.note("threads", "d2m accurate", (index + 1) as f64, rates);
        }
        Ok(())
    }
}
