//! The series of a result folder: a figure, a table and, where a power law fits, its exponent for each.
use super::parts::{figure, round};
use super::text;
use crate::bench::sweep::{self, Point};
use crate::figure::{Axis, LinePlot, Series};
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

/// What a series shows.
struct Words {
    name: &'static str,
    title: &'static str,
    x: &'static str,
    y: &'static str,
    /// For a reader who asks how it was measured; empty if the title says it.
    note: &'static str,
}

/// In the order of the page. Threads and instruction sets have sections of their own.
const SERIES: [Words; 9] = [
    Words {
        name: "triangles",
        title: "Time against size: two torus knots",
        x: "triangles of each body",
        y: "median time of one query, µs",
        note: "",
    },
    Words {
        name: "build",
        title: "Cost of a tree",
        x: "triangles of the body",
        y: "µs or bytes per triangle",
        note: "",
    },
    Words {
        name: "tolerance",
        title: "Time against accuracy: two pebbles",
        x: "tolerance, in radii",
        y: "median time of one query, µs",
        note: "",
    },
    Words {
        name: "left",
        title: "What the tolerance leaves",
        x: "tolerance, in radii",
        y: "separation at the time of contact, in radii",
        note: "",
    },
    Words {
        name: "spin",
        title: "Time against spin: two pebbles",
        x: "|ω| of each body, rad per unit of time",
        y: "median time of one query, µs",
        note: "",
    },
    Words {
        name: "speed",
        title: "Time against speed: two pebbles",
        x: "relative speed, radii per unit of time",
        y: "median time of one query, µs",
        note: "Below 4 these are the last parts of the flights at speed 4 with a slower clock (spins too), so that the \
            bodies still meet within the window.",
    },
    Words {
        name: "offset",
        title: "Time against distance from the origin: two pebbles",
        x: "offset of both bodies in the world, in radii",
        y: "median time of one query, µs",
        note: "",
    },
    Words {
        name: "offset-left",
        title: "What is left far from the origin",
        x: "offset of both bodies in the world, in radii",
        y: "separation at the time of contact, in radii",
        note: "A tolerance below what doubles resolve at the scene's size is raised, and the answer says to what.",
    },
    Words {
        name: "order",
        title: "First-order accuracy: a curved motion cut into n pieces",
        x: "pieces n",
        y: "error of the time of contact, in windows",
        note: "Against a 30-digit solution; 24 heights. Motions held between poses are of order 1 in the length of a \
            piece, linear pieces (the paper's motions) of order 2.",
    },
];

const THREADS: Words = Words {
    name: "threads",
    title: "A batch of queries on several threads: two pebbles",
    x: "threads",
    y: "queries per second",
    note: "",
};

fn points(folder: &Path, name: &str) -> Vec<Point> {
    sweep::parse(&text(folder, &format!("series-{name}.csv")))
}

/// Draws those that were measured.
pub(super) fn draw(folder: &Path) -> Result<(), Error> {
    for words in SERIES.iter().chain([&THREADS]) {
        let points = points(folder, words.name);
        if !points.is_empty() {
            plot(folder, words, &points)?;
        }
    }
    Ok(())
}

fn plot(folder: &Path, words: &Words, points: &[Point]) -> Result<(), Error> {
    let exponents = if sweep::FITTED.contains(&words.name) { sweep::exponents(points) } else { Vec::new() };
    let series = sweep::series(points).into_iter().map(|name| {
        let mut of_name: Vec<&Point> = points.iter().filter(|p| p.series == name).collect();
        of_name.sort_by(|p, q| p.x.total_cmp(&q.x));
        let exponent = exponents.iter().find(|growth| growth.series == name);
        Series {
            name: exponent.map_or(name.into(), |growth| format!("{name}: exponent {:.2}", growth.exponent)),
            points: of_name.iter().map(|p| (p.x, p.summary.median)).collect(),
            spread: of_name.iter().map(|p| (p.summary.lower, p.summary.upper)).collect(),
        }
    });
    let ys = points.iter().flat_map(|p| [p.summary.lower, p.summary.median, p.summary.upper]);
    let xs = points.iter().map(|p| p.x);
    let (x, y) = if words.name == THREADS.name {
        (Axis::counts(words.x, xs), Axis::linear(words.y, ys))
    } else {
        (Axis::decades_and_zero(words.x, xs), Axis::decades(words.y, ys))
    };
    let path = folder.join(format!("series-{}.svg", words.name));
    LinePlot { title: words.title.into(), x, y, series: series.collect() }.draw(&path)
}

/// A section with figure and table for each that was measured.
pub(super) fn write(page: &mut String, folder: &Path) -> Result<(), Error> {
    for words in &SERIES {
        let points = points(folder, words.name);
        if points.is_empty() {
            continue;
        }
        writeln!(page, "### {}\n", words.title)?;
        if !words.note.is_empty() {
            writeln!(page, "{}\n", words.note)?;
        }
        figure(page, folder, &format!("series-{}", words.name), words.title)?;
        page.push_str(&table(words, &points));
        if sweep::FITTED.contains(&words.name) {
            for sweep::Growth { series, exponent } in sweep::exponents(&points) {
                writeln!(page, "- fitted exponent, {series}: {exponent:.3}")?;
            }
            writeln!(page)?;
        }
    }
    Ok(())
}

/// A row per x, a column per series: median and, in brackets, the worst.
fn table(words: &Words, points: &[Point]) -> String {
    let names = sweep::series(points);
    let mut xs: Vec<f64> = points.iter().map(|p| p.x).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    // Vertical bars would end the cell.
    let mut text = format!("| {} | {} |\n|---|", words.x.replace('|', "\\|"), names.join(" | "));
    text += &"---|".repeat(names.len());
    text.push('\n');
    let is_small = points.iter().any(|p| p.summary.median < 0.01);
    let number = |v: f64| if is_small { format!("{v:.2e}") } else { round(v) };
    for x in xs {
        let cell = |name: &&str| {
            points.iter().find(|p| p.x == x && p.series == *name).map_or("–".into(), |p| {
                let s = p.summary;
                let worst = if s.count > 1 { format!(" ({})", number(s.worst)) } else { String::new() };
                format!("{}{worst}", number(s.median))
            })
        };
        let cells: Vec<String> = names.iter().map(cell).collect();
        let _ = writeln!(text, "| {} | {} |", plain(x), cells.join(" | "));
    }
    text + "\n"
}

/// Powers of ten far from 1 as such.
fn plain(x: f64) -> String {
    if x == 0.0 || (0.01..1e7).contains(&x) { format!("{x}") } else { format!("{x:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Summary;

    #[test]
    fn tables_are_sorted_and_show_gaps() {
        let point = |series: &str, x: f64, values: &[f64]| Point {
            series: series.into(),
            x,
            summary: Summary::of(values.iter().copied()).unwrap(),
        };
        let points =
            [point("b", 300.0, &[1.0, 2.0, 9.0]), point("a", 0.0, &[4.0]), point("b", 0.0, &[5.0, 5.0])];
        let text = table(&SERIES[4], &points);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "| \\|ω\\| of each body, rad per unit of time | a | b |");
        assert_eq!(lines[2..4], ["| 0 | 4.00 | 5.00 (5.00) |", "| 300 | – | 2.00 (9.00) |"]);
        assert_eq!((plain(1e-12), plain(1e6)), ("1e-12".into(), "1000000".into()));
    }

    #[test]
    fn every_series_of_the_bench_has_words() {
        for name in sweep::NAMES {
            let has_own_section = [THREADS.name, "instructions"].contains(&name);
            assert!(has_own_section || SERIES.iter().any(|words| words.name == name), "{name}");
        }
    }
}
