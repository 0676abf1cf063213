/// Why a pair of numbers is not an interval.
///
/// ```
/// use d2m_interval::{Interval, IntervalError};
/// assert_eq!(Interval::try_new(2.0, 1.0), Err(IntervalError::Order { lo: 2.0, hi: 1.0 }));
/// assert!(matches!(Interval::try_new(f64::NAN, 1.0), Err(IntervalError::Nan { .. })));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntervalError {
    /// An end point is NaN.
    #[error("an interval end point is NaN: [{lo}, {hi}]")]
    Nan {
        /// Lower end point as given.
        lo: f64,
        /// Upper end point as given.
        hi: f64,
    },
    /// The lower end point exceeds the upper one, or the pair holds no real number.
    #[error("not an interval: lower end point {lo}, upper end point {hi}")]
    Order {
        /// Lower end point as given.
        lo: f64,
        /// Upper end point as given.
        hi: f64,
    },
}

/// Why a text is not an interval.
///
/// ```
/// use d2m_interval::{Interval, ParseIntervalError};
/// assert_eq!("[2, 1]".parse::<Interval>(), Err(ParseIntervalError::Order));
/// assert_eq!("one".parse::<Interval>(), Err(ParseIntervalError::Syntax));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseIntervalError {
    /// The text has none of the forms that [`Interval`](crate::Interval)'s `from_str` lists.
    #[error("not an interval literal")]
    Syntax,
    /// The lower end point exceeds the upper one, or the interval would hold no real number.
    #[error("interval literal with end points in the wrong order, or without a real number")]
    Order,
}
