//! Series: how the time of a query grows with the number of triangles, the accuracy asked for, spin, speed, threads.
use super::Options;
use super::body::{Body, Pair};
use super::method::{Method, Question};
use super::store::Store;
use crate::judge::{Claim, Judge};
use crate::statistics::Summary;
use crate::trials::{self, Law, Trial};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::Instant;

type Error = Box<dyn std::error::Error>;

/// A point of a series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) series: String,
    pub(crate) x: f64,
    pub(crate) summary: Summary,
}

const HEADER: &str = "series,x,count,least,lower,median,upper,worst,mean";

/// The series by name, in the order of the report.
pub(crate) const NAMES: [&str; 9] =
    ["triangles", "build", "tolerance", "left", "spin", "speed", "threads", "order", "instructions"];

/// Groups of series that are measured together.
const TASKS: [&[&str]; 7] = [
    &["triangles", "build"],
    &["tolerance", "left"],
    &["spin"],
    &["speed"],
    &["threads"],
    &["order"],
    &["instructions"],
];

/// How many pieces of work the series are for a progress bar.
pub(super) const STEPS: usize = TASKS.len();

/// Measures the series that the store lacks. Returns what was judged wrong.
///
/// `begin` hears the name of each piece of work before it begins, measured or not.
pub(super) fn run(
    options: &Options,
    store: &Store,
    say: impl Fn(&str),
    begin: impl Fn(&str),
) -> Result<Vec<String>, Error> {
    let mut sweep = Sweep { options, points: Vec::new(), wrong: Vec::new() };
    for names in TASKS {
        begin(names[0]);
        if names.iter().all(|name| store.load_text(&file(name)).is_some()) {
            continue;
        }
        match names[0] {
            "triangles" => sweep.triangles()?,
            "tolerance" => sweep.tolerance()?,
            "spin" => sweep.spin()?,
            "speed" => sweep.speed()?,
            "threads" => sweep.threads()?,
            "order" => sweep.order()?,
            _ => sweep.instructions()?,
        }
        for name in names {
            let points: Vec<Point> =
                sweep.points.iter().filter(|(of, _)| of == name).map(|(_, point)| point.clone()).collect();
            for point in &points {
                let s = point.summary;
                say(&format!(
                    "  {name:<12} {:<22} {:>9.3e}: median {:.4}, worst {:.4}",
                    point.series, point.x, s.median, s.worst
                ));
            }
            store.save_text(&file(name), &write(&points))?;
        }
    }
    Ok(sweep.wrong)
}

fn file(name: &str) -> String {
    format!("sweep-{name}.csv")
}

/// The points of a series that a run left.
pub(crate) fn load(store: &Store, name: &str) -> Vec<Point> {
    store.load_text(&file(name)).map(|text| parse(&text)).unwrap_or_default()
}

/// The points of a table.
pub(crate) fn parse(text: &str) -> Vec<Point> {
    text.lines().skip(1).filter_map(parse_line).collect()
}

pub(crate) fn write(points: &[Point]) -> String {
    let mut text = format!("{HEADER}\n");
    for Point { series, x, summary: s } in points {
        let numbers =
            [s.least, s.lower, s.median, s.upper, s.worst, s.mean].map(|v| format!("{v:.6e}")).join(",");
        let _ = writeln!(text, "{series},{x:?},{},{numbers}", s.count);
    }
    text
}

fn parse_line(line: &str) -> Option<Point> {
    let mut fields = line.split(',');
    let series = fields.next()?.to_string();
    let x = fields.next()?.parse().ok()?;
    let count = fields.next()?.parse().ok()?;
    let n: Vec<f64> = fields.filter_map(|f| f.parse().ok()).collect();
    let [least, lower, median, upper, worst, mean] = n[..] else { return None };
    Some(Point { series, x, summary: Summary { count, least, lower, median, upper, worst, mean } })
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

    /// Least times of the rounds in microseconds and separations left, of judged answers only.
    fn measure(
        &mut self,
        what: &str,
        pair: &Pair,
        trials: &[Trial],
        ask: (Method, f64),
    ) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let (method, tolerance) = ask;
        let questions: Vec<Question<'_>> = trials
            .iter()
            .map(|trial| Question::new(pair, trial, tolerance, 0.0))
            .collect::<Result<_, _>>()?;
        let mut asked = Vec::new();
        for round in 0..self.options.rounds.max(1) {
            for (i, question) in questions.iter().enumerate() {
                let start = Instant::now();
                let claim = std::hint::black_box(question.ask(method));
                let microseconds = start.elapsed().as_secs_f64() * 1e6;
                match round {
                    0 => asked.push((claim, microseconds)),
                    _ => asked[i].1 = f64::min(asked[i].1, microseconds),
                }
            }
        }
        let verdicts: Vec<_> = asked
            .par_iter()
            .zip(trials)
            .map(|((claim, _), trial)| {
                Judge { a: &pair.a.boxes, b: &pair.b.boxes, trial }.check(claim, method.is_exact())
            })
            .collect();
        let (mut times, mut left) = (Vec::new(), Vec::new());
        for (i, ((_, time), verdict)) in asked.iter().zip(verdicts).enumerate() {
            match verdict {
                Ok(separation) => {
                    times.push(*time);
                    left.push(separation);
                }
                Err(fault) => self.wrong.push(format!("{what} {} trial {i}: {fault}", method.name())),
            }
        }
        Ok((times, left))
    }

    /// Two equal knots from a thousand triangles a body to four million; also what their trees cost.
    fn triangles(&mut self) -> Result<(), Error> {
        let single = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let most = if self.options.quick { 70_000 } else { 5_000_000 };
        for count in [1_000, 4_000, 16_000, 64_000, 256_000, 1_000_000, 4_000_000] {
            if count > most {
                break;
            }
            let mesh = super::engine::shape(&format!("torus-knot?triangles={count}"))?;
            let triangles = mesh.triangle_count() as f64;
            let mut seconds = f64::INFINITY;
            let mut bytes = 0;
            for _ in 0..if count > 300_000 { 1 } else { 3 } {
                let mesh = mesh.clone();
                let start = Instant::now();
                let tree = single.install(|| super::engine::build(mesh));
                seconds = seconds.min(start.elapsed().as_secs_f64());
                bytes = tree.memory_bytes();
            }
            self.note("build", "µs per triangle on one thread", triangles, [seconds * 1e6 / triangles]);
            self.note("build", "bytes per triangle", triangles, [bytes as f64 / triangles]);
            let body = Body::new(mesh.vertices(), mesh.triangles().to_vec())?;
            let pair = Pair { name: format!("knot {count}"), a: Arc::clone(&body), b: body };
            for speed in [4.0, 512.0] {
                let trials = trials::generate(&Law { speed, ..Law::PAPER }, self.options.seed, self.count());
                for method in [Method::Accurate, Method::Capoeira] {
                    let what = format!("{count} triangles @{speed}");
                    let times = self.measure(&what, &pair, &trials, (method, self.options.tolerance))?.0;
                    self.note("triangles", &format!("{} at speed {speed}", method.title()), triangles, times);
                }
            }
        }
        Ok(())
    }

    fn pebbles() -> Result<Pair, Error> {
        let (a, b) =
            (Body::embedded("pebble?triangles=5856")?, Body::embedded("pebble?triangles=5804&seed=2")?);
        Ok(Pair { name: "pebble/pebble".into(), a, b })
    }

    fn tolerance(&mut self) -> Result<(), Error> {
        let pair = Self::pebbles()?;
        for exponent in 3..=12 {
            let tolerance = 10f64.powi(-exponent);
            for speed in [4.0, 512.0] {
                let trials = trials::generate(&Law { speed, ..Law::PAPER }, self.options.seed, self.count());
                let what = format!("tolerance {tolerance:e} @{speed}");
                let (times, left) = self.measure(&what, &pair, &trials, (Method::Accurate, tolerance))?;
                let series = format!("d2m accurate at speed {speed}");
                self.note("tolerance", &series, tolerance, times);
                self.note("left", &series, tolerance, left);
            }
        }
        Ok(())
    }

    /// Both bodies turning at exactly this angular speed.
    fn spin(&mut self) -> Result<(), Error> {
        let pair = Self::pebbles()?;
        for spin in [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0] {
            for speed in [4.0, 512.0] {
                let law = Law { speed, spin, fixed_spin: true, ..Law::PAPER };
                let trials = trials::generate(&law, self.options.seed, self.count());
                let ask = (Method::Accurate, self.options.tolerance);
                let times = self.measure(&format!("spin {spin} @{speed}"), &pair, &trials, ask)?.0;
                self.note("spin", &format!("d2m accurate at speed {speed}"), spin, times);
            }
        }
        Ok(())
    }

    fn speed(&mut self) -> Result<(), Error> {
        let pair = Self::pebbles()?;
        for speed in [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0, 16384.0] {
            let trials = trials::generate(&Law { speed, ..Law::PAPER }, self.options.seed, self.count());
            for method in [Method::Accurate, Method::Capoeira] {
                let ask = (method, self.options.tolerance);
                let times = self.measure(&format!("speed {speed}"), &pair, &trials, ask)?.0;
                self.note("speed", method.title(), speed, times);
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
        let pair = Self::pebbles()?;
        let trials =
            trials::generate(&Law::PAPER, self.options.seed, if self.options.quick { 64 } else { 256 });
        let questions: Vec<Question<'_>> = trials
            .iter()
            .map(|trial| Question::new(&pair, trial, self.options.tolerance, 0.0))
            .collect::<Result<_, _>>()?;
        let repeats = if self.options.quick { 20 } else { 200 };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_gives_the_points_back() {
        let summary = Summary::of([1.0, 2.0, 4.0]).unwrap();
        let points = vec![Point { series: "a".into(), x: 1e-12, summary }];
        let mut back = parse(&write(&points));
        back[0].summary.mean = summary.mean;
        assert_eq!(back, points);
    }
}
