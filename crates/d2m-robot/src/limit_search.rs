//! The search for the first time at which a joint's value, or its rate, is beyond its limits.

use crate::limit_kind::LimitKind;
use d2m_interval::Interval;
use d2m_motion::JointValue;

/// What exceeds a limit by this part of the largest magnitude on its piece, or less, is at the limit.
///
/// Over a span of radius r about its middle a polynomial is enclosed by `b₀ ± Σ |b_k| r^k`, so the magnitude M of the enclosure over
/// the whole piece, of radius R, is at least `Σ |b_k| R^k`, k ≥ 1, and with a degree n ≤ 5 the slope anywhere on it is at most
/// `n·M/R` = 5M/R. A short enough span is enclosed up to two roundings. The difference of its middle and the start of the piece, which
/// is at most 2R, is rounded by 2⁻⁵³·2R, so that the value is off by up to 5M/R·2⁻⁵²·R = 5·2⁻⁵²·M; and the ends of the enclosure, which
/// are doubles, by two of their last digits, 2·2⁻⁵²·M. The radius shrinks with the span, and what it is rounded by. That is less than
/// 16·2⁻⁵²·M = 2⁻⁴⁸·M.
const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

/// Terms of a piece, each of which is a coefficient times as many lengths of the piece as it has powers of time, are off by less than this
/// part of the positions: 2⁻⁸⁰. They are sums of at most six numbers, with factors up to 30, each in pairs of doubles (2⁻¹⁰⁰). For
/// positions that counts for nothing beside [`ROUNDING`]; a rate is off by as much of the positions divided by the length of the piece,
/// also where it is zero.
const ROUNDING_OF_TERMS: f64 = ROUNDING / (1_u64 << 32) as f64;

/// What exceeds by this or less is rounding, however small the value: 2⁻⁴⁹⁸. Both operations that make an interval of a center and a
/// radius add up to 2⁻⁵⁰⁰.
const LEAST_ROUNDING: f64 = f64::from_bits((1023 - 498) << 52);

/// Spans of this part of the path know the time at which the value leaves its limits well enough.
const SHORTEST_PART: f64 = 1.0 / (1 << 20) as f64;

/// Spans that are evaluated on one piece. At each of 60 depths a polynomial that only grazes a limit needs a few of them for each of its
/// (at most five) extrema. Where they are not enough, that is said.
const MOST_STEPS: usize = 5_000;

/// Where the value is beyond a limit, or may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Finding {
    pub(crate) time: f64,
    /// What it is then, or how far beyond it may be.
    pub(crate) value: f64,
    pub(crate) limit: f64,
    /// Proven, or only not decided?
    pub(crate) is_certain: bool,
}

/// Has the value been evaluated where a span begins?
#[derive(Clone, Copy, PartialEq, Eq)]
enum Start {
    New,
    /// As that of the span of which it is the first half.
    Seen,
}

/// A value over time, and its limits.
pub(crate) struct LimitSearch<'a> {
    value: &'a JointValue,
    kind: LimitKind,
    lower: f64,
    upper: f64,
    shortest: f64,
    most_steps: usize,
}

impl<'a> LimitSearch<'a> {
    /// Of the value, or of its rate, along a path of this length.
    pub(crate) fn new(value: &'a JointValue, kind: LimitKind, [lower, upper]: [f64; 2], length: f64) -> Self {
        Self { value, kind, lower, upper, shortest: length * SHORTEST_PART, most_steps: MOST_STEPS }
    }

    fn enclose(&self, span: Interval) -> Interval {
        match self.kind {
            LimitKind::Position => self.value.enclose(span),
            LimitKind::Velocity => self.value.enclose_rate(span),
        }
    }

    /// By how much enclosures on this piece are wider than what they enclose, however short the span is.
    fn rounding(&self, start: f64, end: f64) -> f64 {
        let piece = Interval::new(start, end);
        let of_terms = match self.kind {
            LimitKind::Position => 0.0,
            LimitKind::Velocity => ROUNDING_OF_TERMS * self.value.enclose(piece).mag() / (end - start),
        };
        let rounding = ROUNDING * self.enclose(piece).mag() + of_terms + LEAST_ROUNDING;
        // Of a value that doubles do not hold nothing is known.
        if rounding.is_finite() { rounding } else { 0.0 }
    }

    /// Where it first cannot be decided, if that is well before the second, and where the value is first beyond a limit.
    ///
    /// The pieces of the value meet at `times`, each is a polynomial: every one of them has steps of its own, so that none that lies
    /// at its limit takes those of a later one.
    pub(crate) fn run(&self, times: &[f64]) -> [Option<Finding>; 2] {
        let mut open = None;
        let pieces = times.windows(2).find_map(|piece| self.first_beyond(piece[0], piece[1], &mut open));
        // From inside, the end is seen with a span before it.
        let end = || times.last().and_then(|&end| self.at(Interval::point(end), end));
        let beyond = pieces.or_else(end);
        // On the way beyond there is a last span on which that is not known yet.
        let open = open.filter(|open: &Finding| {
            beyond.is_none_or(|beyond| beyond.time - open.time > 2.0 * self.shortest)
        });
        [open, beyond]
    }

    /// The first time on one piece at which the value is certainly beyond its limits, halving spans in which it may be by more than
    /// rounding.
    fn first_beyond(&self, start: f64, end: f64, open: &mut Option<Finding>) -> Option<Finding> {
        let rounding = self.rounding(start, end);
        let (lower, upper) = (self.lower - rounding, self.upper + rounding);
        let mut left = self.most_steps;
        let mut spans = vec![(start, end, Start::New)];
        while let Some((lo, hi, begins)) = spans.pop() {
            if begins == Start::New
                && let Some(beyond) = self.at(Interval::point(lo), lo)
            {
                return Some(beyond);
            }
            let over = self.enclose(Interval::new(lo, hi));
            if lower <= over.lo() && over.hi() <= upper {
                continue;
            }
            let middle = Interval::new(lo, hi).mid();
            let can_be_halved = lo < middle && middle < hi;
            if hi - lo <= self.shortest || !can_be_halved || left == 0 {
                // The end as seen from inside: the rate may jump there.
                let last = Interval::new(middle.max(lo), hi);
                if let Some(beyond) = self.at(last, hi) {
                    return Some(beyond);
                }
            }
            if !can_be_halved || left == 0 {
                open.get_or_insert_with(|| self.undecided(over, lo));
                continue;
            }
            left -= 1;
            spans.push((middle, hi, Start::New));
            spans.push((lo, middle, Start::Seen));
        }
        None
    }

    /// Is the value certainly beyond on the whole span? `time` is that of it which is said.
    fn at(&self, span: Interval, time: f64) -> Option<Finding> {
        let value = self.enclose(span);
        let limit = if value.hi() < self.lower {
            self.lower
        } else if value.lo() > self.upper {
            self.upper
        } else {
            return None;
        };
        Some(Finding { time, value: value.mid(), limit, is_certain: true })
    }

    /// It may be beyond by as much as this enclosure is.
    fn undecided(&self, over: Interval, time: f64) -> Finding {
        let (below, above) = (self.lower - over.lo(), over.hi() - self.upper);
        let (value, limit) = if below > above { (over.lo(), self.lower) } else { (over.hi(), self.upper) };
        Finding { time, value, limit, is_certain: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A search that ends without a decision says so, and goes on behind that.
    #[test]
    fn what_is_not_decided_is_said() {
        // A peak of 1/64 between two times, then a way beyond.
        let pieces = vec![vec![0.0, 1.0 / 16.0, -1.0 / 16.0], vec![0.0], vec![0.0, 1.0]];
        let value = JointValue::try_pieces(vec![0.0, 1.0, 2.0, 3.0], pieces).unwrap();
        let search = |upper: f64, most_steps: usize| {
            let search = LimitSearch::new(&value, LimitKind::Position, [-1.0, upper], 3.0);
            LimitSearch { most_steps, ..search }.run(&[0.0, 1.0, 2.0])
        };
        let peak = 1.0 / 64.0;
        assert_eq!(search(peak, MOST_STEPS), [None, None]);
        assert_eq!(search(peak + 1e-6, MOST_STEPS), [None, None]);
        let [open, beyond] = search(peak - 1e-6, MOST_STEPS);
        assert!(open.is_none() && beyond.is_some_and(|found| found.is_certain && found.time < 0.5));
        let [open, beyond] = search(peak + 1e-6, 1);
        assert!(open.is_some_and(|found| !found.is_certain && found.value > peak), "{open:?}");
        assert_eq!(beyond, None);
        let search = LimitSearch {
            most_steps: 1,
            ..LimitSearch::new(&value, LimitKind::Position, [-1.0, peak + 1e-6], 3.0)
        };
        let [open, beyond] = search.run(&[0.0, 1.0, 2.0, 3.0]);
        assert!(open.is_some_and(|found| !found.is_certain && found.time < 1.0), "{open:?}");
        assert!(beyond.is_some_and(|found| found.is_certain && found.time > 2.0), "{beyond:?}");
    }
}
