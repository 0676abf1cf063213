/// Why a pair of numbers is not an interval.
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
