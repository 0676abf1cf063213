//! The summary table: a line per pair, speed and method.
use crate::bench::{Method, Row};
use crate::judge::Claim;
use crate::statistics::Summary;

/// What the rows of one pair, speed and method come to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// `all` for the rows of all pairs together.
    pub(super) pair: String,
    pub(super) triangles: [usize; 2],
    pub(super) speed: f64,
    pub(super) method: Method,
    pub(super) queries: usize,
    pub(super) contacts: usize,
    pub(super) undecided: usize,
    /// Answers that the judge refused; their times do not count.
    pub(super) wrong: usize,
    /// Microseconds.
    pub(super) time: Option<Summary>,
    /// Left at `lo`, in units of the models' radius.
    pub(super) separation: Option<Summary>,
}

pub(super) const HEADER: &str = "pair,triangles_a,triangles_b,speed,method,queries,contacts,undecided,wrong,\
    time_least,time_lower,time_median,time_upper,time_worst,time_mean,\
    separation_least,separation_lower,separation_median,separation_upper,separation_worst,separation_mean";

impl Line {
    pub(super) fn of(
        pair: &str,
        triangles: [usize; 2],
        (speed, method): (f64, Method),
        rows: &[Row],
    ) -> Self {
        let count = |test: fn(&Row) -> bool| rows.iter().filter(|row| test(row)).count();
        let right = || rows.iter().filter(|row| row.fault.is_empty());
        Self {
            pair: pair.into(),
            triangles,
            speed,
            method,
            queries: rows.len(),
            contacts: count(|row| matches!(row.claim, Claim::Contact { .. })),
            undecided: count(|row| matches!(row.claim, Claim::Undecided { .. })),
            wrong: count(|row| !row.fault.is_empty()),
            time: Summary::of(right().map(|row| row.microseconds)),
            separation: Summary::of(right().map(|row| row.separation)),
        }
    }

    pub(super) fn write(&self) -> String {
        let numbers = |s: &Option<Summary>| match s {
            Some(s) => {
                [s.least, s.lower, s.median, s.upper, s.worst, s.mean].map(|v| format!("{v:.4e}")).join(",")
            }
            None => ",,,,,".into(),
        };
        let Self { pair, triangles: [a, b], speed, queries, contacts, undecided, wrong, .. } = self;
        let method = self.method.name();
        let (time, separation) = (numbers(&self.time), numbers(&self.separation));
        format!(
            "{pair},{a},{b},{speed},{method},{queries},{contacts},{undecided},{wrong},{time},{separation}"
        )
    }

    pub(super) fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let count = |i: usize| fields.get(i)?.parse::<usize>().ok();
        let summary = |i: usize, count: usize| {
            let n: Vec<f64> = fields.get(i..i + 6)?.iter().filter_map(|f| f.parse().ok()).collect();
            let [least, lower, median, upper, worst, mean] = n[..] else { return None };
            Some(Summary { count, least, lower, median, upper, worst, mean })
        };
        let (queries, contacts, undecided, wrong) = (count(5)?, count(6)?, count(7)?, count(8)?);
        Some(Self {
            pair: (*fields.first()?).into(),
            triangles: [count(1)?, count(2)?],
            speed: fields.get(3)?.parse().ok()?,
            method: Method::ALL.into_iter().find(|method| method.name() == fields[4])?,
            queries,
            contacts,
            undecided,
            wrong,
            time: summary(9, queries - wrong),
            separation: summary(15, contacts),
        })
    }
}

/// The lines of a summary file.
pub(super) fn parse(text: &str) -> Vec<Line> {
    text.lines().skip(1).filter_map(Line::parse).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gives_itself_back() {
        let row = |lo: f64| Row {
            trial: 0,
            claim: Claim::Contact { lo, hi: lo, tolerance: 1e-10 },
            separation: lo,
            parry_separation: f64::NAN,
            microseconds: 10.0 * lo,
            fault: String::new(),
        };
        let mut wrong = row(0.75);
        wrong.fault = "late".into();
        let line = Line::of("a/b", [12, 34], (4.0, Method::Accurate), &[row(0.25), row(0.5), wrong]);
        assert_eq!((line.queries, line.contacts, line.wrong), (3, 3, 1));
        assert_eq!(line.time.unwrap().median, 3.75, "a wrong answer's time does not count");
        let back = Line::parse(&line.write()).unwrap();
        assert_eq!(back.write(), line.write());
        assert_eq!(Line::parse("a,b"), None);
    }
}
