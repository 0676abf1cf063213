//! Series: how the time of a query grows with the number of triangles, the accuracy asked for, spin, speed, distance
//! from the origin, threads.
mod flights;
mod measure;
mod order;
mod point;
pub(crate) mod variants;

pub(crate) use measure::{Step, measure, open};
pub(crate) use point::{Growth, Point, exponents, parse, series, write};

use super::store::Store;

/// The series by name, in the order of the report.
pub(crate) const NAMES: [&str; 11] = [
    "triangles",
    "build",
    "tolerance",
    "left",
    "spin",
    "speed",
    "offset",
    "offset-left",
    "threads",
    "order",
    "instructions",
];

/// Series with a power law worth fitting.
pub(crate) const FITTED: [&str; 2] = ["triangles", "order"];

/// Steps that are done, and answers that were wrong, a line each.
const STEPS: &str = "sweep-steps.txt";
const WRONG: &str = "sweep-wrong.txt";

fn file(name: &str) -> String {
    format!("sweep-{name}.csv")
}

/// The points of a series that a run left.
pub(crate) fn load(store: &Store, name: &str) -> Vec<Point> {
    store.load_text(&file(name)).map(|text| parse(&text)).unwrap_or_default()
}

/// Answers of the series that were judged wrong, a line each.
pub(crate) fn wrong(store: &Store) -> String {
    store.load_text(WRONG).unwrap_or_default()
}
