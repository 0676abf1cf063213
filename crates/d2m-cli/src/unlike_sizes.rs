//! Warnings of bodies one of which is probably in another unit.

use crate::output::{digits, note};

/// Diagonals of boxes that differ by more than this are probably in two units.
const UNLIKELY: f64 = 100.0;

/// Warns of two bodies of very unlike sizes.
pub(crate) fn warn_of_sizes(a: f64, b: f64) {
    if let Some(text) = unlike(("A", a), ("B", b)) {
        note(&format!("d2m: warning: {text} (--unit-a, --scale-a)"));
    }
}

/// The same of the smallest and the largest body of a scene file.
pub(crate) fn warn_of_scene_sizes<'n>(place: &str, bodies: impl Iterator<Item = (&'n str, f64)> + Clone) {
    let by_size = |x: &(&str, f64), y: &(&str, f64)| x.1.total_cmp(&y.1);
    let ends = bodies.clone().min_by(by_size).zip(bodies.max_by(by_size));
    if let Some(text) = ends.and_then(|(small, large)| unlike(small, large)) {
        note(&format!("d2m: warning: {place}: {text} (\"scale\")"));
    }
}

/// What is to be said of two bodies of which one is probably in another unit, by their names and sizes.
pub(crate) fn unlike((one, a): (&str, f64), (other, b): (&str, f64)) -> Option<String> {
    let (small, large) = (a.min(b), a.max(b));
    (small > 0.0 && large > UNLIKELY * small).then(|| {
        format!("{one} is {} across and {other} {}: are both in the same unit?", digits(a), digits(b))
    })
}
