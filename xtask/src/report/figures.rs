//! The figures of one result folder.
use super::table::{self, Line};
use super::text;
use crate::bench::{Method, sweep};
use crate::figure::{Axis, BoxPlot, BoxRow, Group, LinePlot, Series};
use crate::statistics::{Summary, exponent};
use std::path::Path;

type DrawResult = Result<(), Box<dyn std::error::Error>>;

const TIME: &str = "time of one query, µs";
const SEPARATION: &str = "separation left at the time of contact, in radii of the models";

/// Draws all that the tables allow.
pub(super) fn draw(folder: &Path) -> DrawResult {
    let lines = table::parse(&text(folder, "summary.csv"));
    let timed = |method: Method| lines.iter().any(|l| l.method == method);
    let methods: Vec<Method> = Method::ALL.into_iter().filter(|&m| timed(m)).collect();
    let answering: Vec<Method> = methods.iter().copied().filter(|m| !m.is_static()).collect();
    overall(
        &lines,
        &methods,
        |l| l.time,
        ("Time per query, all pairs", TIME),
        &folder.join("overall-time.svg"),
    )?;
    let words = ("Separation at the time of contact, all pairs", SEPARATION);
    overall(&lines, &answering, |l| l.separation, words, &folder.join("overall-separation.svg"))?;
    let words = ("Separation at the time of contact, by pair", SEPARATION);
    by_pair(&lines, |l| l.separation, words, &folder.join("pairs-separation.svg"))?;
    by_pair(&lines, |l| l.time, ("Time per query, by pair", TIME), &folder.join("pairs-time.svg"))?;
    for name in sweep::NAMES.into_iter().filter(|name| *name != "instructions") {
        series(folder, name)?;
    }
    Ok(())
}

fn speeds(lines: &[Line]) -> Vec<f64> {
    let mut speeds: Vec<f64> = lines.iter().map(|l| l.speed).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    speeds
}

/// A group per method, a row per speed.
fn overall(
    lines: &[Line],
    methods: &[Method],
    value: impl Fn(&Line) -> Option<Summary>,
    (title, axis): (&str, &str),
    path: &Path,
) -> DrawResult {
    let speeds = speeds(lines);
    let mut groups = Vec::new();
    for &method in methods {
        let of_method = lines.iter().filter(|l| l.pair == "all" && l.method == method);
        let mut rows = Vec::new();
        let mut count = 0;
        for line in of_method {
            if let (Some(summary), Some(kind)) = (value(line), speeds.iter().position(|&s| s == line.speed)) {
                count += summary.count;
                rows.push(BoxRow { kind, summary });
            }
        }
        if !rows.is_empty() {
            groups.push(Group { name: method.title().into(), note: format!("{count} queries"), rows });
        }
    }
    let legend = speeds.iter().map(|s| format!("relative speed {s}")).collect();
    plot(title, axis, legend, groups, path)
}

/// A group per pair, a row per method of the engine and speed.
fn by_pair(
    lines: &[Line],
    value: impl Fn(&Line) -> Option<Summary>,
    (title, axis): (&str, &str),
    path: &Path,
) -> DrawResult {
    let kinds: Vec<(Method, f64)> = [Method::Accurate, Method::Capoeira]
        .iter()
        .flat_map(|&m| speeds(lines).into_iter().map(move |s| (m, s)))
        .collect();
    let mut groups: Vec<Group> = Vec::new();
    for line in lines.iter().filter(|l| l.pair != "all") {
        let kind = kinds.iter().position(|&(m, s)| m == line.method && s == line.speed);
        let (Some(summary), Some(kind)) = (value(line), kind) else { continue };
        if groups.last().is_none_or(|g| g.name != line.pair) {
            let [a, b] = line.triangles;
            groups.push(Group {
                name: line.pair.clone(),
                note: format!("{a} + {b} triangles"),
                rows: Vec::new(),
            });
        }
        let rows = &mut groups.last_mut().expect("pushed above").rows;
        rows.push(BoxRow { kind, summary });
        rows.sort_by_key(|row| row.kind);
    }
    let legend = kinds.iter().map(|(m, s)| format!("{} at speed {s}", m.title())).collect();
    plot(title, axis, legend, groups, path)
}

fn plot(title: &str, axis: &str, legend: Vec<String>, groups: Vec<Group>, path: &Path) -> DrawResult {
    if groups.is_empty() {
        return Ok(());
    }
    BoxPlot { title: title.into(), axis: axis.into(), legend, groups }.draw(path)
}

/// Title and axes of a series.
fn words(name: &str) -> (&'static str, &'static str, &'static str) {
    match name {
        "triangles" => {
            ("Time against size: two torus knots", "triangles of each body", "median time of one query, µs")
        }
        "build" => ("Cost of a tree", "triangles of the body", "µs or bytes per triangle"),
        "tolerance" => {
            ("Time against accuracy: two pebbles", "tolerance, in radii", "median time of one query, µs")
        }
        "left" => (
            "What the tolerance leaves",
            "tolerance, in radii",
            "separation at the time of contact, in radii",
        ),
        "spin" => (
            "Time against spin: two pebbles",
            "|ω| of each body, rad per unit of time",
            "median time of one query, µs",
        ),
        "speed" => (
            "Time against speed: two pebbles",
            "relative speed, radii per unit of time",
            "median time of one query, µs",
        ),
        "order" => {
            ("A curved motion cut into n pieces", "pieces n", "error of the time of contact, in windows")
        }
        _ => ("A batch of queries on several threads: two pebbles", "threads", "queries per second"),
    }
}

fn series(folder: &Path, name: &str) -> DrawResult {
    let points = sweep::parse(&text(folder, &format!("series-{name}.csv")));
    if points.is_empty() {
        return Ok(());
    }
    let mut drawn: Vec<Series> = Vec::new();
    for point in &points {
        if drawn.last().is_none_or(|s| s.name != point.series) {
            if let Some(place) = drawn.iter().position(|s| s.name == point.series) {
                let found = drawn.remove(place);
                drawn.push(found);
            } else {
                drawn.push(Series { name: point.series.clone(), points: Vec::new(), spread: Vec::new() });
            }
        }
        let series = drawn.last_mut().expect("pushed above");
        series.points.push((point.x, point.summary.median));
        series.spread.push((point.summary.lower, point.summary.upper));
    }
    drawn.sort_by(|s, t| s.name.cmp(&t.name));
    let (title, x, y) = words(name);
    let all = || {
        drawn
            .iter()
            .flat_map(|s| s.points.iter().map(|p| p.1).chain(s.spread.iter().flat_map(|p| [p.0, p.1])))
    };
    let y = if name == "threads" { Axis::linear(y, all()) } else { Axis::decades(y, all()) };
    let xs = points.iter().map(|p| p.x);
    let x = if name == "threads" { Axis::counts(x, xs) } else { Axis::decades(x, xs) };
    if ["triangles", "order"].contains(&name) {
        for series in &mut drawn {
            if let Some(e) = exponent(&series.points) {
                series.name = format!("{}: exponent {e:.2}", series.name);
            }
        }
    }
    LinePlot { title: title.into(), x, y, series: drawn }.draw(&folder.join(format!("series-{name}.svg")))
}
