//! The value of a joint over time: a polynomial, or one polynomial after another.
use crate::ball::up;
use crate::enclosed::{Enclosed, STEP};
use crate::error::{TimesFault, fault, find_times_fault};
use crate::{JointPoints, MotionError};
use d2m_interval::Interval;
use d2m_lanes::{DoubleDouble, two_sum};

/// Largest jump between two pieces that counts as rounding (radians, or units of length).
pub(crate) const LARGEST_JUMP: f64 = 1e-9;

/// What a joint follows: an angle (radians) or a length as a function of time, twice differentiable but for the times at
/// which pieces meet.
///
/// ```
/// use d2m_motion::JointValue;
/// let steady = JointValue::try_polynomial(vec![0.0, 2.0])?; // 2t
/// assert_eq!(steady.value(1.5), 3.0);
/// let pieces = JointValue::try_pieces(vec![0.0, 1.0, 2.0], vec![vec![0.0, 0.0, 1.0], vec![1.0, 2.0]])?;
/// assert_eq!((pieces.value(0.5), pieces.value(1.5), pieces.next_time(0.5)), (0.25, 2.0, Some(1.0)));
/// assert!(JointValue::try_pieces(vec![0.0, 1.0, 2.0], vec![vec![0.0], vec![0.1]]).is_err());
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct JointValue {
    /// Ends of the pieces; none for one polynomial for all times.
    times: Vec<f64>,
    /// Coefficients of each piece in t − its first time (in t itself without times), lowest first, one after the other.
    coefficients: Vec<f64>,
    /// What each coefficient leaves out of the true one; none when all are exact.
    tails: Vec<Tail>,
    /// Where each piece begins among the coefficients, and their number.
    starts: Vec<usize>,
    /// What the pieces pass through, if they were made of that.
    points: Option<Box<JointPoints>>,
    /// Pieces that are given one by one may miss each other by what counts as rounding.
    joins: Joins,
}

/// How pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Joins {
    /// Exactly: the value is continuous.
    Exact,
    /// Within [`LARGEST_JUMP`].
    Jumps,
}

/// The second double of a coefficient, and a bound of what is left out then.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Tail {
    lo: f64,
    radius: f64,
}

/// Value, first and second derivative over a span of time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ValueOverTime {
    pub(crate) value: Enclosed,
    /// Bound of the distance of the value in the middle of the span from the center of `value`.
    pub(crate) middle_radius: f64,
    pub(crate) rate: Enclosed,
    pub(crate) second: Enclosed,
}

impl JointValue {
    /// Never changes.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn try_constant(value: f64) -> Result<Self, MotionError> {
        Self::try_polynomial(vec![value])
    }

    /// `c[0] + c[1]·t + c[2]·t² + …`, t the time itself.
    ///
    /// # Errors
    /// No coefficient, or one that is not finite.
    pub fn try_polynomial(coefficients: Vec<f64>) -> Result<Self, MotionError> {
        check_coefficients("value", &coefficients)?;
        let starts = vec![0, coefficients.len()];
        Ok(Self {
            times: Vec::new(),
            coefficients,
            tails: Vec::new(),
            starts,
            points: None,
            joins: Joins::Exact,
        })
    }

    /// From `times[i]` to `times[i + 1]` the polynomial `pieces[i]` in `t − times[i]`.
    ///
    /// # Errors
    /// Times that are not finite or do not increase, not one more time than pieces, a piece without coefficients or with
    /// one that is not finite, or where two pieces meet a jump of more than 1e-9 or a value that doubles cannot hold.
    #[expect(clippy::needless_pass_by_value, reason = "as its sister, and as every caller has it")]
    pub fn try_pieces(times: Vec<f64>, pieces: Vec<Vec<f64>>) -> Result<Self, MotionError> {
        if let Some(TimesFault { index, reason }) = find_times_fault(&times) {
            return Err(fault(format!("value, times[{index}]"), reason));
        }
        if times.len() != pieces.len() + 1 {
            let reason = format!("{} times for {} pieces: one more is needed", times.len(), pieces.len());
            return Err(fault("value, times".into(), reason));
        }
        let mut starts = vec![0];
        let mut coefficients = Vec::new();
        for (index, piece) in pieces.iter().enumerate() {
            check_coefficients(&format!("value, pieces[{index}]"), piece)?;
            coefficients.extend_from_slice(piece);
            starts.push(coefficients.len());
        }
        let joins = if pieces.len() > 1 { Joins::Jumps } else { Joins::Exact };
        let value = Self { times, coefficients, tails: Vec::new(), starts, points: None, joins };
        for index in 1..pieces.len() {
            let time = value.times[index];
            let (before, after) =
                (value.over_piece(index - 1, time, time), value.over_piece(index, time, time));
            let jump = (before.value.center - after.value.center).hi.abs();
            let rounding = before.value.radius + after.value.radius;
            if !rounding.is_finite() {
                let reason =
                    format!("the value at the time {time:?} is beyond the numbers: nothing is known of it");
                return Err(fault(format!("value, pieces[{index}]"), reason));
            }
            // Also what is no number is a jump.
            if jump.is_nan() || jump > LARGEST_JUMP + rounding {
                let reason =
                    format!("the value jumps by {jump:?} at the time {time:?} (at most {LARGEST_JUMP:?})");
                return Err(fault(format!("value, pieces[{index}]"), reason));
            }
        }
        Ok(value)
    }

    /// Through points: [`JointPoints`] says how.
    ///
    /// What is enclosed is the true polynomial through the given doubles, not the one with rounded coefficients: these are pairs
    /// of doubles, and what their rounding leaves out counts. So the value is continuous, and its velocity too
    /// where velocities are given.
    ///
    /// # Errors
    /// Fewer than two times, times that are not finite, do not increase, or are less than 1e-50 or more than 1e50 apart, lists of
    /// different lengths, numbers that are not finite, accelerations without velocities, or numbers so large that a coefficient
    /// is not finite.
    pub fn through(points: JointPoints) -> Result<Self, MotionError> {
        points.check()?;
        let pieces = (0..points.times().len() - 1)
            .map(|piece| {
                let [from, to] = [points.times()[piece], points.times()[piece + 1]];
                points.coefficients(piece).ok_or_else(|| {
                    let reason =
                        format!("from {from:?} to {to:?} the polynomial's coefficients are no doubles");
                    fault(format!("value, pieces[{piece}]"), reason)
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self::from_enclosed(points.times().to_vec(), &pieces, Some(points)))
    }

    /// From enclosures of the coefficients of each piece, true values of which meet exactly.
    pub(crate) fn from_enclosed(
        times: Vec<f64>,
        pieces: &[Vec<Enclosed>],
        points: Option<JointPoints>,
    ) -> Self {
        let mut starts = vec![0];
        let (mut coefficients, mut tails) = (Vec::new(), Vec::new());
        for piece in pieces {
            coefficients.extend(piece.iter().map(|c| c.center.hi));
            tails.extend(piece.iter().map(|c| Tail { lo: c.center.lo, radius: c.radius }));
            starts.push(coefficients.len());
        }
        let points = points.map(Box::new);
        Self { times, coefficients, tails, starts, points, joins: Joins::Exact }
    }

    /// `multiplier` times this value plus `offset`: what a joint follows that mimics another one. What the coefficients'
    /// rounding leaves out counts.
    ///
    /// # Errors
    /// A coefficient that is not finite, with piece and index.
    pub fn scaled(&self, multiplier: f64, offset: f64) -> Result<Self, MotionError> {
        let scale = |piece: usize, index: usize| {
            let scaled = self.coefficient(piece, index) * multiplier;
            let moved = if index == 0 { scaled + Enclosed::exact(offset) } else { scaled };
            moved.if_finite().ok_or_else(|| {
                let reason = format!("{multiplier:?} times it, plus {offset:?}, is not finite");
                fault(format!("value, pieces[{piece}][{index}]"), reason)
            })
        };
        let pieces = (0..self.starts.len() - 1).map(|piece| {
            let count = self.starts[piece + 1] - self.starts[piece];
            (0..count).map(|index| scale(piece, index)).collect::<Result<Vec<_>, _>>()
        });
        let scaled = Self::from_enclosed(self.times.clone(), &pieces.collect::<Result<Vec<_>, _>>()?, None);
        Ok(Self { joins: self.joins, ..scaled })
    }

    /// Is the value continuous from `lo` to `hi`, so that it changes by no more than its rates say?
    pub(crate) fn is_continuous(&self, lo: f64, hi: f64) -> bool {
        self.joins == Joins::Exact || self.next_time(lo).is_none_or(|time| time >= hi)
    }

    fn coefficient(&self, piece: usize, index: usize) -> Enclosed {
        let at = self.starts[piece] + index;
        let Tail { lo, radius } = self.tails.get(at).copied().unwrap_or_default();
        Enclosed { center: DoubleDouble { hi: self.coefficients[at], lo }, radius }
    }

    /// What the pieces pass through, if the value was made of that.
    pub fn points(&self) -> Option<&JointPoints> {
        self.points.as_deref()
    }

    /// The ends of the pieces; none for a polynomial for all times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Coefficients of the pieces, each the double nearest to it.
    pub fn pieces(&self) -> impl Iterator<Item = &[f64]> {
        self.starts.windows(2).map(|ends| &self.coefficients[ends[0]..ends[1]])
    }

    /// The times at which it is given.
    pub fn domain(&self) -> Interval {
        match (self.times.first(), self.times.last()) {
            (Some(&first), Some(&last)) => Interval::new(first, last),
            _ => Interval::ENTIRE,
        }
    }

    /// The first time after `t` at which pieces meet; `None` when there is none.
    pub fn next_time(&self, t: f64) -> Option<f64> {
        let last = self.times.len().checked_sub(1)?;
        let index = self.times.partition_point(|&time| time <= t).max(1);
        (index < last).then(|| self.times[index])
    }

    /// The value at one time, rounded.
    pub fn value(&self, t: f64) -> f64 {
        self.over_piece(self.piece_from(t), t, t).value.center.hi
    }

    /// Encloses the value over an interval of time.
    pub fn enclose(&self, t: Interval) -> Interval {
        self.over(t.lo(), t.hi()).value.to_interval()
    }

    /// Encloses the rate of the value over an interval of time; where pieces meet inside, the rates of both.
    pub fn enclose_rate(&self, t: Interval) -> Interval {
        self.over(t.lo(), t.hi()).rate.to_interval()
    }

    /// The piece that begins at or before `t` (the first one before, the last one after all).
    fn piece_from(&self, t: f64) -> usize {
        let count = self.starts.len() - 1;
        self.times.partition_point(|&time| time <= t).saturating_sub(1).min(count - 1)
    }

    /// The piece that ends at or after `t`.
    fn piece_until(&self, t: f64) -> usize {
        let count = self.starts.len() - 1;
        self.times.partition_point(|&time| time < t).saturating_sub(1).min(count - 1)
    }

    /// Value and derivatives from `lo` to `hi`; where pieces meet inside, the derivatives of both.
    ///
    /// At one time the piece that begins there counts, over a span those that have a part of it.
    pub(crate) fn over(&self, lo: f64, hi: f64) -> ValueOverTime {
        let first = self.piece_from(lo);
        let last = if lo < hi { self.piece_until(hi).max(first) } else { first };
        if first == last {
            return self.over_piece(first, lo, hi);
        }
        let mut whole = self.over_piece(first, lo, self.times[first + 1]);
        for piece in first + 1..=last {
            let (from, to) = (self.times[piece], if piece == last { hi } else { self.times[piece + 1] });
            let part = self.over_piece(piece, from, to);
            let value = whole.value.hull(part.value);
            whole = ValueOverTime {
                value,
                middle_radius: value.radius,
                rate: whole.rate.hull(part.rate),
                second: whole.second.hull(part.second),
            };
        }
        whole
    }

    /// Taylor's expansion about the middle: `p(m + x) = Σ b_k x^k`, so `|p − b_0| ≤ Σ |b_k| r^k`, and likewise for the
    /// derivatives.
    fn over_piece(&self, piece: usize, lo: f64, hi: f64) -> ValueOverTime {
        let coefficients = &self.coefficients[self.starts[piece]..self.starts[piece + 1]];
        let origin = if self.times.is_empty() { 0.0 } else { self.times[piece] };
        // No span at all, of which nothing is known.
        let Ok(middle) = Interval::try_new(lo, hi).map(Interval::mid) else { return ValueOverTime::ANY };
        let (s, lost) = two_sum(middle, -origin);
        // The middle relative to the piece's start is off by what the difference lost.
        let half = if lo < hi { (hi - middle).max(middle - lo) * (1.0 + 2.0 * f64::EPSILON) } else { 0.0 };
        let r = up(half + lost.abs());
        let mut few = [(DoubleDouble::ZERO, 0.0); 8];
        let mut many;
        let terms = if let Some(terms) = few.get_mut(..coefficients.len()) {
            terms
        } else {
            many = vec![(DoubleDouble::ZERO, 0.0); coefficients.len()];
            &mut many[..]
        };
        let tails = self.tails.get(self.starts[piece]..self.starts[piece + 1]).unwrap_or_default();
        taylor(coefficients, tails, s, terms);
        let term = |k: usize| terms.get(k).copied().unwrap_or((DoubleDouble::ZERO, 0.0));
        // Horner on the magnitudes of what lies beyond the k-th derivative's own term: factors k!/(k − d)!.
        let beyond = |derivative: usize, r: f64| {
            if r == 0.0 {
                return 0.0;
            }
            let mut sum = 0.0;
            for k in (derivative + 1..terms.len()).rev() {
                let power = k as f64;
                let factor = [1.0, power, power * (power - 1.0)][derivative];
                sum = up(sum * r + up(terms[k].0.hi.abs() + terms[k].1) * factor);
            }
            up(sum * r)
        };
        // 1 or 2: exact.
        let part = |derivative: usize, factor: f64| {
            let (b, error) = term(derivative);
            let center = b.scaled(factor);
            let radius = up(error * factor + beyond(derivative, r));
            let known = center.hi.is_finite() && center.lo.is_finite() && radius < f64::INFINITY;
            if known { Enclosed { center, radius } } else { Enclosed::ANY }
        };
        let value = part(0, 1.0);
        let middle_radius = up(term(0).1 + beyond(0, lost.abs())).min(value.radius);
        ValueOverTime { value, middle_radius, rate: part(1, 1.0), second: part(2, 2.0) }
    }
}

impl ValueOverTime {
    /// Nothing is known.
    const ANY: Self = Self {
        value: Enclosed::ANY,
        middle_radius: f64::INFINITY,
        rate: Enclosed::ANY,
        second: Enclosed::ANY,
    };

    pub(crate) fn rate_magnitude(&self) -> f64 {
        self.rate.magnitude()
    }
}

/// The coefficients about `s`, each with a bound of its error: repeated division by t − s.
///
/// Row after row `b_j ← b_j + s·b_{j+1}`; the same with magnitudes bounds what was added, and each of the at most n steps
/// that a coefficient goes through in each of n rows adds [`STEP`] of that. An error of a coefficient goes the way of a
/// magnitude: it counts as one that is larger by the inverse of the steps.
fn taylor(coefficients: &[f64], tails: &[Tail], s: f64, terms: &mut [(DoubleDouble, f64)]) {
    let n = coefficients.len();
    let steps = (n * n) as f64 * STEP;
    for (k, (term, &c)) in terms.iter_mut().zip(coefficients).enumerate() {
        let Tail { lo, radius } = tails.get(k).copied().unwrap_or_default();
        let size = if s == 0.0 { radius } else { up(c.abs() + up(radius / steps)) };
        *term = (DoubleDouble { hi: c, lo }, size);
    }
    if s == 0.0 {
        return;
    }
    for row in 0..n {
        let Some((last, lower)) = terms[row..n].split_last_mut() else { break };
        let (mut next, mut size) = *last;
        for term in lower.iter_mut().rev() {
            (next, size) = (term.0 + next * s, up(term.1 + size * s.abs()));
            *term = (next, size);
        }
    }
    for term in terms.iter_mut().take(n) {
        // Products below the smallest normal number lose at most that, each step.
        term.1 = up(term.1 * steps) + (n * n) as f64 * f64::MIN_POSITIVE;
    }
}

fn check_coefficients(place: &str, coefficients: &[f64]) -> Result<(), MotionError> {
    if coefficients.is_empty() {
        return Err(fault(place.to_owned(), "a polynomial needs at least one coefficient".to_owned()));
    }
    match coefficients.iter().position(|c| !c.is_finite()) {
        Some(index) => {
            Err(fault(format!("{place}[{index}]"), format!("{} is not finite", coefficients[index])))
        }
        None => Ok(()),
    }
}
