use crate::QueryError;

/// The resolution of spans and of partings where none is given, as a part of the window's length.
const RESOLUTION: f64 = 1e-6;

/// A closed span of time [t0, t1], both ends finite, t0 ≤ t1.
///
/// ```
/// use d2m_bvh::Window;
/// let window = Window::try_new(2.0, 3.5).unwrap();
/// assert_eq!(window.length(), 1.5);
/// assert!(Window::try_new(1.0, 0.0).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "[f64; 2]", into = "[f64; 2]"))]
pub struct Window {
    start: f64,
    end: f64,
}

impl Window {
    /// The window [0, 1] of the usual "one step" query.
    pub const UNIT: Self = Self { start: 0.0, end: 1.0 };

    /// The window [start, end].
    ///
    /// # Errors
    /// [`QueryError::BadWindow`] when an end is not finite, when `end < start`, or when `end - start` overflows.
    pub fn try_new(start: f64, end: f64) -> Result<Self, QueryError> {
        if start.is_finite() && end.is_finite() && start <= end && (end - start).is_finite() {
            Ok(Self { start, end })
        } else {
            Err(QueryError::BadWindow { start, end })
        }
    }

    /// First instant.
    pub const fn start(self) -> f64 {
        self.start
    }

    /// Last instant.
    pub const fn end(self) -> f64 {
        self.end
    }

    /// `end - start`, rounded to nearest.
    pub const fn length(self) -> f64 {
        self.end - self.start
    }

    /// The resolution of spans and of partings where none is given: a millionth of the window's length, so zero for a single time.
    ///
    /// ```
    /// use d2m_bvh::Window;
    /// let window = Window::try_new(2.0, 4.0).unwrap();
    /// assert_eq!(window.default_resolution(), 2e-6);
    /// ```
    pub const fn default_resolution(self) -> f64 {
        RESOLUTION * self.length()
    }

    /// Is `time` inside, ends included?
    pub fn contains(self, time: f64) -> bool {
        self.start <= time && time <= self.end
    }
}

/// From [start, end], checked: the serde form, too.
impl TryFrom<[f64; 2]> for Window {
    type Error = QueryError;

    fn try_from([start, end]: [f64; 2]) -> Result<Self, QueryError> {
        Self::try_new(start, end)
    }
}

#[cfg(feature = "serde")]
impl From<Window> for [f64; 2] {
    fn from(window: Window) -> Self {
        [window.start, window.end]
    }
}
