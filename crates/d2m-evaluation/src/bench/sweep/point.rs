//! The points of the series, and their tables in files.
use crate::statistics::{Summary, exponent};
use std::fmt::Write as _;

/// A point of a series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) series: String,
    pub(crate) x: f64,
    pub(crate) summary: Summary,
}

const HEADER: &str = "series,x,count,least,lower,median,upper,worst,mean";

/// The points of a table.
pub(crate) fn parse(text: &str) -> Vec<Point> {
    text.lines().skip(1).filter_map(parse_line).collect()
}

/// A table of points.
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

/// The names of the series, each once, in alphabetical order (of capitals and small letters alike).
pub(crate) fn series(points: &[Point]) -> Vec<&str> {
    let mut names: Vec<&str> = points.iter().map(|p| p.series.as_str()).collect();
    names.sort_unstable_by_key(|name| name.to_lowercase());
    names.dedup();
    names
}

/// How a series grows with x.
#[derive(Debug)]
pub(crate) struct Growth {
    pub(crate) series: String,
    pub(crate) exponent: f64,
}

/// The exponent that fits the medians of each series of two points or more best, by its name.
pub(crate) fn exponents(points: &[Point]) -> Vec<Growth> {
    let fit = |name: &str| {
        let of_name = points.iter().filter(|p| p.series == name);
        let places: Vec<(f64, f64)> = of_name.map(|p| (p.x, p.summary.median)).collect();
        Some(Growth { series: name.to_string(), exponent: exponent(&places)? })
    };
    series(points).into_iter().filter_map(fit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(series: &str, x: f64, median: f64) -> Point {
        Point {
            series: series.into(),
            x,
            summary: Summary::of([0.5 * median, median, 4.0 * median]).unwrap(),
        }
    }

    #[test]
    fn a_table_gives_the_points_back() {
        let points = vec![point("a", 1e-12, 2.0), point("b", 0.0, 4.0)];
        let mut back = parse(&write(&points));
        for (back, point) in back.iter_mut().zip(&points) {
            back.summary.mean = point.summary.mean;
        }
        assert_eq!(back, points);
    }

    #[test]
    fn exponents_of_medians() {
        let points = [point("b", 1.0, 3.0), point("a", 1.0, 3.0), point("b", 100.0, 30.0)];
        assert_eq!(series(&points), ["a", "b"]);
        let found = exponents(&points);
        assert_eq!(found.len(), 1, "one point has no exponent");
        assert!(found[0].series == "b" && (found[0].exponent - 0.5).abs() < 1e-12, "{found:?}");
    }
}
