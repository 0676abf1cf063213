use core::fmt;

/// What a [`Contact`](crate::Contact) proves about the meeting itself, besides that nothing meets before `time_lo`.
///
/// Ordered by strength: `Early < Near < Crossing`.
///
/// ```
/// use d2m_bvh::Evidence;
/// assert!(Evidence::Early < Evidence::Near && Evidence::Near < Evidence::Crossing);
/// assert_eq!(Evidence::Crossing.to_string(), "crossing");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Evidence {
    /// Only "nothing before `time_lo`" is proven; there may be no contact at all. The usual case of
    /// [`Mode::Capoeira`](crate::Mode::Capoeira). In the other modes it is rare: bodies that pass each other, or part
    /// from the start, at a distance a little above `min_separation` + `tolerance`, and times so large that no number
    /// lies between near and crossed.
    Early,
    /// At a time of [`time_lo`, `time_hi`] the distance is proven to be at most `min_separation` + `tolerance`.
    Near,
    /// At a time of [`time_lo`, `time_hi`] the bodies are proven to share a point.
    Crossing,
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Early => "early",
            Self::Near => "near",
            Self::Crossing => "crossing",
        })
    }
}
