//! What is answered about a path.

use d2m_bvh::Contact;

/// Is a path free of contact, and until when?
#[derive(Debug, Clone, PartialEq)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum PathAnswer {
    /// Certified: no pair meets at any time of the path.
    #[non_exhaustive]
    Free {
        /// The end of the path.
        until: f64,
    },
    /// Certified free before `contact.time_lo`; these two meet by `contact.time_hi`.
    Contact(Box<PathContact>),
    /// The budget ran out. Certified: no pair meets before `free_until`.
    #[non_exhaustive]
    Undecided {
        /// End of the part of the path that is proven free.
        free_until: f64,
        /// The link or body that is undecided first.
        a: String,
        /// The other one of that pair.
        b: String,
    },
}

/// Two links or bodies that meet.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathContact {
    /// The first link or body: A of the contact.
    pub a: String,
    /// The second link or body: B of the contact.
    pub b: String,
    /// Which bodies of them: numbers in [`PathBodies`](crate::PathBodies).
    pub bodies: [usize; 2],
    /// When, where and how; in the world's frame.
    pub contact: Contact,
}

impl PathAnswer {
    /// The end of the part of the path that is proven free: what motion planners call the last valid time.
    #[doc(alias = "last_valid")]
    pub fn free_until(&self) -> f64 {
        match self {
            Self::Free { until } => *until,
            Self::Contact(found) => found.contact.time_lo,
            Self::Undecided { free_until, .. } => *free_until,
        }
    }

    /// Is the whole path proven free?
    pub const fn is_free(&self) -> bool {
        matches!(self, Self::Free { .. })
    }

    /// The contact, if there is one.
    pub fn contact(&self) -> Option<&PathContact> {
        match self {
            Self::Contact(found) => Some(found),
            _ => None,
        }
    }
}
