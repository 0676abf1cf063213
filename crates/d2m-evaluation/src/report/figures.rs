//! The figures of one result folder.
use super::table::{self, Line};
use super::text;
use crate::bench::Method;
use crate::figure::{BoxPlot, BoxRow, Group};
use crate::statistics::Summary;
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
    super::series::draw(folder)
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
