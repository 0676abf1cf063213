//! What is asked of two bodies, what may be claimed of them, and what becomes of a claim.
use crate::Mesh;
use d2m_interval::Interval;
use d2m_motion::RigidMotion;
use glam::DVec3;

/// What belongs to a body.
///
/// ```
/// # use d2m_motion::ConstantTwist;
/// # use d2m_verify::{Claim, Mesh, Query, TimeSpan, Verdict, verify};
/// # use glam::DVec3;
/// use d2m_verify::{Body, Solid};
/// // A small tetrahedron inside a large one: their surfaces are apart, their solids are not.
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let large = Mesh::try_new(&corners, &faces)?;
/// let small = Mesh::try_new(&corners.map(|p| 0.1 * p + DVec3::splat(0.1)), &faces)?;
/// let clear = |solid: Solid| {
///     let body = |mesh| Body { mesh, motion: &ConstantTwist::REST, solid, radius: 0.0 };
///     let window = TimeSpan { from: 0.0, to: 1.0 };
///     let query = Query { bodies: [body(&large), body(&small)], window };
///     verify(&query, &Claim::Clear { span: window, distance: 0.0 }, 10_000)
/// };
/// assert!(matches!(clear(Solid::Surface), Verdict::Verified { .. }));
/// assert!(matches!(clear(Solid::Filled), Verdict::Refuted { .. }));
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// What the mesh encloses: points about which its winding number is not zero, or (where faces disagree about the outside) from
    /// which a ray passes an odd number of faces. Repetitions of a triangle count once.
    Filled,
    /// The triangles alone.
    Surface,
}

/// A body and its motion.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_verify::{Body, Mesh, Solid};
/// use glam::DVec3;
/// let plate = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// // An open surface, rounded by a tenth.
/// let body = Body { mesh: &plate, motion: &ConstantTwist::REST, solid: Solid::Surface, radius: 0.1 };
/// assert_eq!((body.mesh.triangle_count(), body.radius), (1, 0.1));
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Copy)]
pub struct Body<'a> {
    /// The triangles, in body axes.
    pub mesh: &'a Mesh,
    /// How the body moves: its enclosures are trusted.
    pub motion: &'a dyn RigidMotion,
    /// What belongs to the body.
    pub solid: Solid,
    /// And everything within this distance of the mesh.
    pub radius: f64,
}

/// A closed span of time.
///
/// ```
/// use d2m_verify::{Claim, TimeSpan};
/// let first_half = TimeSpan { from: 0.0, to: 0.5 };
/// let claim = Claim::Clear { span: first_half, distance: 0.0 };
/// assert!(matches!(claim, Claim::Clear { span, .. } if span == first_half));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSpan {
    /// First time.
    pub from: f64,
    /// Last time.
    pub to: f64,
}

/// Two bodies in a window of time, about which there may be many claims.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_verify::{Body, Claim, Mesh, Query, Solid, TimeSpan, Verdict, verify};
/// use glam::DVec3;
/// // A plate falls from a height of 2 with a speed of 4 onto another one.
/// let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// let body = |motion| Body { mesh: &mesh, motion, solid: Solid::Surface, radius: 0.0 };
/// let window = TimeSpan { from: 0.0, to: 1.0 };
/// let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window };
/// let clear_until = |to: f64| verify(&query, &Claim::Clear { span: TimeSpan { from: 0.0, to }, distance: 0.0 }, 10_000);
/// assert!(matches!(clear_until(0.49), Verdict::Verified { .. }));
/// assert!(!matches!(clear_until(0.51), Verdict::Verified { .. }));
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Copy)]
pub struct Query<'a> {
    /// A and B.
    pub bodies: [Body<'a>; 2],
    /// All times that a claim is about are in it.
    pub window: TimeSpan,
}

/// What is claimed of two bodies. An answer claims several such things at once.
///
/// ```
/// # use d2m_motion::ConstantTwist;
/// # use d2m_verify::{Body, Mesh, Query, TimeSpan};
/// # use glam::DVec3;
/// # let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let body = |motion| Body { mesh: &mesh, motion, solid: d2m_verify::Solid::Surface, radius: 0.0 };
/// # let window = TimeSpan { from: 0.0, to: 1.0 };
/// # let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window };
/// use d2m_verify::{Claim, Verdict, verify};
/// // They meet at 0.5: apart until 0.4; within 0.5 of each other by then.
/// let span = TimeSpan { from: 0.0, to: 0.4 };
/// let (clear, near) = (Claim::Clear { span, distance: 0.0 }, Claim::Within { span, distance: 0.5, triangles: None });
/// let verdict = verify(&query, &Claim::All(vec![clear, near]), 100_000);
/// assert!(matches!(verdict, Verdict::Verified { .. }), "{verdict:?}");
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Claim {
    /// The bodies are further apart than this at every time of the span.
    Clear {
        /// When.
        span: TimeSpan,
        /// A distance; zero: they share no point.
        distance: f64,
    },
    /// At some time of the span the bodies are at most this far apart.
    Within {
        /// When.
        span: TimeSpan,
        /// A distance; zero: they share a point.
        distance: f64,
        /// Triangles of A and B that are, if it is known: they are tried first.
        triangles: Option<[u32; 2]>,
    },
    /// In every part of the span that is as long as `every`, the bodies are at some time at most this far apart.
    Often {
        /// When.
        span: TimeSpan,
        /// A distance; zero: they share a point.
        distance: f64,
        /// A length of time.
        every: f64,
    },
    /// A triangle of A and one of B (with the bodies' radii) are that far apart at a time.
    Apart {
        /// When.
        time: f64,
        /// Which.
        triangles: [u32; 2],
        /// By no less than this.
        least: f64,
        /// By no more than this.
        most: f64,
    },
    /// A filled body holds a part of the other one, and the surfaces share no point.
    Held {
        /// When.
        time: f64,
    },
    /// The bodies overlap: their insides share a point, or their surfaces pass through each other.
    Overlapping {
        /// When.
        time: f64,
        /// Triangles of A and B that cross, or about which there is such a point.
        triangles: [u32; 2],
    },
    /// The insides of the bodies share no more than a layer of this thickness: they share no point, or none as soon as B is moved along
    /// a direction, by no more than that.
    Parted {
        /// When.
        time: f64,
        /// A unit direction from A to B, world frame.
        along: DVec3,
        /// How far B may be moved.
        most: f64,
    },
    /// All of these.
    All(Vec<Claim>),
}

/// What became of a claim.
///
/// ```
/// # use d2m_motion::ConstantTwist;
/// # use d2m_verify::{Body, Mesh, Query, TimeSpan};
/// # use glam::DVec3;
/// # let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let body = |motion| Body { mesh: &mesh, motion, solid: d2m_verify::Solid::Surface, radius: 0.0 };
/// # let window = TimeSpan { from: 0.0, to: 1.0 };
/// # let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window };
/// use d2m_verify::{Claim, Verdict, verify};
/// let clear_all_the_time = Claim::Clear { span: window, distance: 0.0 };
/// match verify(&query, &clear_all_the_time, 100_000) {
///     Verdict::Verified { steps } => panic!("a lie, proven in {steps} steps"),
///     Verdict::Refuted { time, distance, .. } => assert!(time >= 0.5 && distance.lo() <= 0.0),
///     Verdict::Unproven { clear_until, .. } => assert!(clear_until <= 0.5),
/// }
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum Verdict {
    /// It is true.
    Verified {
        /// Steps that the proof took.
        steps: u64,
    },
    /// It is false: two triangles, with the bodies' radii, are certainly so far apart at this time. A distance of zero of triangles that
    /// are not near: one body holds the other.
    Refuted {
        /// When.
        time: f64,
        /// The triangle of A and that of B.
        triangles: [u32; 2],
        /// Encloses their distance.
        distance: Interval,
    },
    /// Neither was proven.
    Unproven {
        /// What was claimed to be clear is, before this time.
        clear_until: f64,
        /// Why it was not proven.
        reason: Reason,
        /// Where: a triangle of A and one of B.
        pair: Option<[u32; 2]>,
    },
}

/// Why a claim was not proven.
///
/// ```
/// # use d2m_motion::ConstantTwist;
/// # use d2m_verify::{Body, Mesh, Query, TimeSpan};
/// # use glam::DVec3;
/// # let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let body = |motion| Body { mesh: &mesh, motion, solid: d2m_verify::Solid::Surface, radius: 0.0 };
/// # let window = TimeSpan { from: 0.0, to: 1.0 };
/// # let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window };
/// use d2m_verify::{Claim, Reason, Verdict, verify};
/// let clear = Claim::Clear { span: TimeSpan { from: 0.0, to: 0.2 }, distance: 0.0 };
/// let Verdict::Unproven { reason, .. } = verify(&query, &clear, 0) else { panic!("no steps were allowed") };
/// assert_eq!((reason, reason.to_string().as_str()), (Reason::Steps, "the budget of steps ran out"));
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// A budget ended it: the bodies are close for long.
    #[error("the budget of steps ran out")]
    Steps,
    /// Enclosures of poses are wider than what the bodies are above the claimed distance.
    #[error("the bodies are closer to the claimed distance than their poses are known")]
    TooClose,
    /// Two numbers for times have none between them.
    #[error("no number for a time lies between two that are too far apart")]
    TimeResolution,
    /// Enclosures that are empty, unbounded or no numbers prove nothing.
    #[error("a motion's enclosures are empty, unbounded or no numbers")]
    Enclosure,
    /// A piece of a motion ends before it begins.
    #[error("a motion's pieces do not advance")]
    Pieces,
    /// The motion is not defined in all of the window.
    #[error("the window leaves the times of a motion")]
    OutsideMotion,
    /// Not a claim about this window and these meshes: numbers out of order or out of range.
    #[error("the answer is not one about these bodies and this window")]
    Malformed,
    /// The triangles are not proven to be as far apart as is claimed.
    #[error("the triangles are not as far apart as the answer says")]
    Distance,
    /// No triangles were found to be near.
    #[error("the claimed meeting was not found")]
    NoMeeting,
    /// A filled surface does not close, or no ray distinguishes inside from outside.
    #[error("inside and outside of a solid could not be distinguished")]
    Solid,
    /// Bodies that are said to touch do not part along the normal of the answer.
    #[error("the bodies were not found to part along the normal of the answer")]
    NotParted,
    /// Bodies that are in contact at the start, which was to be let go, had not parted as the answer says.
    #[error("bodies in contact at the start were not found to part before that")]
    NotLeft,
    /// No point was found inside of both bodies that are said to overlap.
    #[error("the bodies were not found to overlap")]
    NotOverlapping,
    /// A tolerance larger than what was asked for and what rounding needs would make any answer right.
    #[error("the tolerance of the answer is larger than what was asked for")]
    Tolerance,
    /// Points, weights, normal, features or speed are not those of the answer's triangles at its time.
    #[error("points, normal or features of the answer are not those of its triangles at its time")]
    Witness,
    /// The answer promises nothing.
    #[error("the answer promises nothing")]
    NothingClaimed,
}
