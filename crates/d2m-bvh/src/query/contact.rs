use d2m_feature::FeaturePair;
use glam::DVec3;

/// How the bodies stand at the first instant of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StartState {
    /// Disjoint, and further apart than the tolerance certifies.
    #[default]
    Apart,
    /// Within the tolerance of each other; disjoint or just touching.
    Touching,
    /// The surfaces cross.
    Overlapping,
    /// The surfaces do not cross and one body lies inside the other (only with `Solid::Filled`).
    Contained,
}

/// The first contact of two moving bodies A and B.
///
/// Certified: no contact in [window start, `time_lo`), and the bodies are disjoint at `time_lo`, unless `start` is
/// not [`StartState::Apart`], and then `time_lo` is the start of the window. Some time in [`time_lo`, `time_hi`] has
/// a distance of at most `tolerance`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// Certified free until here.
    pub time_lo: f64,
    /// By here the bodies were within `tolerance` (and `min_separation`) of each other. Equal to `time_lo` when that
    /// could not be shown: a pass that grazes at a distance between one tolerance and `separation`, and modes other
    /// than accurate.
    pub time_hi: f64,
    /// Separation left at `time_lo`: a distance in (0, 3.3 `tolerance`], 0 when the bodies meet at the start.
    pub separation: f64,
    /// The tolerance δ that was used: the one asked for unless rounding errors of the scene forbid it; at least 1e-100.
    pub tolerance: f64,
    /// Unit normal at `time_lo`, world frame, from A to B.
    pub normal: DVec3,
    /// Witness point on A at `time_lo`, world frame.
    pub point_a: DVec3,
    /// Witness point on B at `time_lo`, world frame.
    pub point_b: DVec3,
    /// The features that meet, by their ids in the meshes.
    pub feature: FeaturePair,
    /// Triangle of A.
    pub triangle_a: u32,
    /// Triangle of B.
    pub triangle_b: u32,
    /// `point_a` in the corners of `triangle_a`; not negative, sum one.
    pub barycentric_a: [f64; 3],
    /// `point_b` in the corners of `triangle_b`.
    pub barycentric_b: [f64; 3],
    /// Relative speed of the witness points along the normal at `time_lo`; positive when they close.
    pub closing_speed: f64,
    /// How the bodies stood at the start of the window.
    pub start: StartState,
}

/// Answer of a time-of-contact query. Aliases: time of impact, TOI.
#[doc(alias = "time_of_impact")]
#[doc(alias = "toi")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeOfContact {
    /// Certified: no contact anywhere in the window.
    Separated,
    /// The first contact.
    Contact(Contact),
    /// The budget ran out. Certified: no contact in [start of the window, `clear_until`).
    Undecided {
        /// End of the part of the window that is proven free.
        clear_until: f64,
    },
}

impl TimeOfContact {
    /// The contact, if the answer is one.
    pub const fn contact(&self) -> Option<&Contact> {
        match self {
            Self::Contact(contact) => Some(contact),
            _ => None,
        }
    }

    /// Is the window proven free?
    pub const fn is_separated(&self) -> bool {
        matches!(self, Self::Separated)
    }
}
