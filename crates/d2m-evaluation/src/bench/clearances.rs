//! How near bodies come, against the time of a query that finds only that they do not meet: the pairs of the bench, those of their
//! trials that stay apart. Each answer is held against the judge's distances at many times before its time counts. Beside it stands what
//! one distance at the closest time costs: that is the floor of any clearance, since the closest pair at that time has to be found and
//! all others have to be left out, while a query that finds `Separated` most often compares two spheres.
use super::body::Pair;
use super::engine::{self, Motions};
use super::{Options, catalogue::Entry};
use crate::TaskResult;
use crate::judge::{Hint, separation};
use crate::trials::Trial;
use d2m::bvh::{Clearance, ClearanceStatus, QueryOptions, TimeOfContact};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// What a clearance may cost, in queries that find `Separated`.
const WANTED: f64 = 3.0;
/// Times at which the judge measures the distance, besides the one that is answered.
const SAMPLES: u32 = 24;
/// By how much the judge's distances may be off, in radii of the bodies.
const ROUNDING: f64 = 1e-12;

/// The least times of one trial.
struct Cost {
    separated: Duration,
    /// At the closest time alone.
    distance: Duration,
    clearance: Duration,
}

impl Cost {
    fn ratio(&self) -> f64 {
        self.clearance.as_secs_f64() / self.separated.as_secs_f64()
    }
}

/// `cargo xtask bench --only clearances`.
pub(super) fn run(options: &Options) -> TaskResult {
    println!(
        "a clearance against a time of contact that finds Separated, least of {} rounds; wanted: {WANTED}",
        options.rounds
    );
    for entry in options.entries()? {
        pair(options, &entry)?;
    }
    Ok(())
}

fn pair(options: &Options, entry: &Entry) -> TaskResult {
    let pair = entry.load()?;
    for (speed, trials) in &entry.trials {
        let costs = trials.iter().map(|trial| cost(options, &pair, trial)).collect::<Result<Vec<_>, _>>()?;
        let costs: Vec<Cost> = costs.into_iter().flatten().collect();
        if costs.is_empty() {
            println!("{:<20} @{speed:<4} no trial stays apart", pair.name);
            continue;
        }
        let mut ratios: Vec<f64> = costs.iter().map(Cost::ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let mean = |of: fn(&Cost) -> Duration| {
            1e6 * costs.iter().map(of).sum::<Duration>().as_secs_f64() / costs.len() as f64
        };
        let (separated, clearance) = (mean(|cost| cost.separated), mean(|cost| cost.clearance));
        let distance = mean(|cost| cost.distance);
        let (floor, in_distances) = (distance / separated, clearance / distance);
        let (median, ratio) = (ratios[ratios.len() / 2], clearance / separated);
        println!(
            "{:<20} @{speed:<4} {:>3} trials: separated {separated:>8.1} µs, distance at the closest time \
             {distance:>7.1} µs, clearance {clearance:>9.1} µs, \
             ratio of the means {ratio:>6.1}, median {median:>6.1} {}; floor {floor:>5.1}, in distances {in_distances:>5.1}",
            pair.name,
            costs.len(),
            if ratio <= WANTED { "reached" } else { "MISSED" }
        );
    }
    Ok(())
}

/// The cost of a trial whose bodies stay apart.
fn cost(options: &Options, pair: &Pair, trial: &Trial) -> Result<Option<Cost>, Box<dyn std::error::Error>> {
    let motions = Motions::new(trial)?;
    let query = QueryOptions::default().with_tolerance(options.tolerance).with_solid(engine::solid(pair));
    let ask = || engine::answer(pair, &motions, &query);
    if ask() != TimeOfContact::Separated {
        return Ok(None);
    }
    let near = || engine::clearance(pair, &motions, options.tolerance);
    let found = near();
    check(pair, trial, &found)?;
    let mut least = Cost { separated: Duration::MAX, distance: Duration::MAX, clearance: Duration::MAX };
    for _ in 0..options.rounds {
        let start = Instant::now();
        let _ = black_box(ask());
        least.separated = start.elapsed().min(least.separated);
        let start = Instant::now();
        let _ = black_box(engine::distance(pair, &motions, found.time));
        least.distance = start.elapsed().min(least.distance);
        let start = Instant::now();
        let _ = black_box(near());
        least.clearance = start.elapsed().min(least.clearance);
    }
    Ok(Some(least))
}

/// # Errors
/// An enclosure that is too wide, a distance below it, or a time at which the bodies are not as near as answered.
fn check(pair: &Pair, trial: &Trial, found: &Clearance) -> TaskResult {
    let rounding = ROUNDING * (pair.a.boxes.radius + pair.b.boxes.radius);
    let mut hint = Hint::default();
    let mut at = |time: f64| {
        let [a, b] = trial.places(time);
        separation(&pair.a.boxes, &pair.b.boxes, &a, &b, &mut hint)
    };
    let wide = (1e-6 * found.upper).max(4.0 * found.tolerance);
    let attained = at(found.time);
    let fault = |what: &str| Err(format!("wrong answer, {}: {what}: {found:?}", pair.name).into());
    if found.status != ClearanceStatus::Clear || found.upper - found.lower > wide {
        return fault("not what was asked for");
    }
    if attained > found.upper + rounding {
        return fault(&format!("{attained} at that time"));
    }
    for part in 0..=SAMPLES {
        let distance = at(f64::from(part) / f64::from(SAMPLES));
        if distance < found.lower - rounding {
            return fault(&format!("{distance} at part {part} of {SAMPLES}"));
        }
    }
    Ok(())
}
