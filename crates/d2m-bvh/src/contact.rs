use crate::{Evidence, StartState};
use d2m_feature::FeaturePair;
use glam::DVec3;

/// The first contact of two moving bodies A and B: the first time at which their distance is at most
/// `min_separation` (of the [`QueryOptions`](crate::QueryOptions); zero: they touch), up to the tolerance δ.
///
/// Certified, in every mode but [`Mode::Exists`](crate::Mode::Exists): the distance is above `min_separation` everywhere
/// in [window start, `time_lo`], unless `start` is not [`StartState::Apart`], and then `time_lo` is the start of the
/// window. What is proven of the meeting itself is said by `evidence`:
///
/// | `evidence` | some time in [`time_lo`, `time_hi`] |
/// |---|---|
/// | [`Crossing`](Evidence::Crossing) | the bodies share a point |
/// | [`Near`](Evidence::Near) | the distance is at most `min_separation` + `tolerance` |
/// | [`Early`](Evidence::Early) | nothing is known of the meeting |
///
/// The bracket is about the distance `min_separation` + `tolerance`: bodies that close slowly share a point (or come as
/// near as `min_separation`) later than `time_hi`, by up to `tolerance` over the closing speed, or never.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Contact, Evidence, Moving, QueryOptions, StartState, Window, time_of_contact};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default())?;
/// let contact = answer.contact().expect("they meet");
/// assert!(contact.time_lo <= 0.25 && contact.time_hi - contact.time_lo < 1e-9); // in the motions' unit of time
/// assert!(contact.evidence >= Evidence::Near && contact.start == StartState::Apart);
/// assert!(0.0 < contact.separation && contact.separation <= Contact::MOST_LEFT * contact.tolerance); // in the meshes' unit of length
/// // In the world: from A to B, on A and on B.
/// assert!((contact.normal - DVec3::NEG_Z).length() < 1e-9 && (contact.closing_speed - 4.0).abs() < 1e-9);
/// assert!((contact.point_a - contact.point_b).length() < 1e-9 && (contact.point_b - DVec3::Z).length() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Contact {
    /// Certified free until here.
    pub time_lo: f64,
    /// By here the bodies had met in the sense of `evidence`. Equal to `time_lo` where nothing could be shown
    /// ([`Evidence::Early`]), and where the bodies meet at the start already.
    pub time_hi: f64,
    /// What is proven of the meeting.
    pub evidence: Evidence,
    /// Separation left at `time_lo`: a distance above `min_separation` by at most [`Self::MOST_LEFT`] tolerances, 0 when the surfaces
    /// cross at the start. With [`Mode::Capoeira`](crate::Mode::Capoeira) as large as the boxes of the two triangles.
    ///
    /// It is the distance of the reported triangles, to rounding, so the bodies are at most that far apart. Others may be nearer
    /// to each other at that time – above `min_separation`, too – and come within the tolerance later: where several pairs meet at
    /// about the same time, the reported pair is the one with the least certified time, not the one with the least distance.
    pub separation: f64,
    /// The tolerance δ that was used: that of the options, unless rounding errors of the scene forbid it (then larger: 256
    /// units of 2⁻⁵³ of its largest length), or numbers for time are so far apart that the bodies move by more than that
    /// from one to the next (then what is left at `time_lo`). Every promise holds for this δ.
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
    /// Barycentric coordinates of `point_a` in `triangle_a`; not negative, sum one.
    pub barycentric_a: [f64; 3],
    /// Barycentric coordinates of `point_b` in `triangle_b`.
    pub barycentric_b: [f64; 3],
    /// Relative speed of the witness points along the normal at `time_lo`; positive when they close.
    pub closing_speed: f64,
    /// How the bodies stood at the start of the window.
    pub start: StartState,
    /// Of a query with [`Start::Leave`](crate::Start::Leave): when the bodies had parted before.
    #[cfg_attr(feature = "serde", serde(default))]
    pub left: Option<TimeBracket>,
}

impl Contact {
    /// What a search leaves above `min_separation` at most, in tolerances. The pair that ends it is within 2.5 of them when
    /// it is found (L + δ + γ in docs/theory/engine.md); the rest is for times that round to before that.
    pub const MOST_LEFT: f64 = 3.3;
}

/// A span of time in which something happens.
///
/// ```
/// let bracket = d2m_bvh::TimeBracket { lo: 0.25, hi: 0.5 };
/// assert_eq!(<[f64; 2]>::from(bracket), [0.25, 0.5]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "[f64; 2]", into = "[f64; 2]"))]
pub struct TimeBracket {
    /// Not before this.
    pub lo: f64,
    /// Not after this.
    pub hi: f64,
}

impl From<[f64; 2]> for TimeBracket {
    fn from([lo, hi]: [f64; 2]) -> Self {
        Self { lo, hi }
    }
}

impl From<TimeBracket> for [f64; 2] {
    fn from(bracket: TimeBracket) -> Self {
        [bracket.lo, bracket.hi]
    }
}

impl Contact {
    /// A contact at a time of which only the features and the triangles of A and B are known, for methods of one's own to fill in.
    /// Nothing is claimed: no bracket, no evidence ([`Evidence::Early`]), a separation and a tolerance of zero.
    ///
    /// ```
    /// use d2m_bvh::{Contact, Evidence};
    /// use d2m_feature::FeaturePair;
    /// let contact = Contact::unproven(0.5, FeaturePair::VertexFace { vertex: 3, face: 7 }, [2, 7]);
    /// assert_eq!((contact.time_lo, contact.time_hi, contact.evidence), (0.5, 0.5, Evidence::Early));
    /// ```
    pub const fn unproven(time: f64, feature: FeaturePair, triangles: [u32; 2]) -> Self {
        Self {
            time_lo: time,
            time_hi: time,
            evidence: Evidence::Early,
            separation: 0.0,
            tolerance: 0.0,
            normal: DVec3::X,
            point_a: DVec3::ZERO,
            point_b: DVec3::ZERO,
            feature,
            triangle_a: triangles[0],
            triangle_b: triangles[1],
            barycentric_a: [1.0, 0.0, 0.0],
            barycentric_b: [1.0, 0.0, 0.0],
            closing_speed: 0.0,
            start: StartState::Apart,
            left: None,
        }
    }
}

/// Answer of a time-of-contact query. Aliases: time of impact, TOI.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, TimeOfContact, Window, time_of_contact};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// match time_of_contact(a, b, Window::UNIT, &QueryOptions::default())? {
///     TimeOfContact::Separated => panic!("proven free, which would be wrong here"),
///     TimeOfContact::Contact(contact) => assert!(contact.time_lo <= 0.25 && 0.25 - 1e-9 < contact.time_lo),
///     TimeOfContact::Undecided { clear_until } => panic!("only with a budget; free until {clear_until}"),
/// }
/// // At twice the distance they do not meet in time.
/// let higher = falling.with_position(DVec3::Z * 6.0);
/// let far = time_of_contact(Moving::new(&tree, &higher), b, Window::UNIT, &QueryOptions::default())?;
/// assert!(far.is_separated() && far.contact().is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias = "time_of_impact")]
#[doc(alias = "toi")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(tag = "status", rename_all = "lowercase")
)]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
#[expect(
    clippy::large_enum_variant,
    reason = "one answer at a time, which is copied and taken apart at once"
)]
pub enum TimeOfContact {
    /// Certified: no contact anywhere in the window.
    Separated,
    /// The first contact.
    Contact(Contact),
    /// The budget ran out, or a hard cap that holds without one ([`Budget`](crate::Budget)), or the enclosures of a
    /// motion are too wide. Certified: no contact in [start of the window, `clear_until`).
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
