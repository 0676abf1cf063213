//! What can be chosen of a clearance, and its answer.

use crate::{Budget, Solid};
use d2m_feature::FeaturePair;
use glam::DVec3;

/// Options of [`clearance`](crate::clearance).
///
/// ```
/// use d2m_bvh::ClearanceOptions;
/// let options = ClearanceOptions::default().with_accuracy(1e-3).with_cutoff(0.5);
/// assert_eq!((options.accuracy, options.cutoff), (1e-3, 0.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ClearanceOptions {
    /// R: the enclosure is at most R times its upper end wide, or four tolerances. Finite and positive.
    pub accuracy: f64,
    /// δ, a distance: as for a time of contact. `None`: 1e-10 of the larger body's radius.
    pub tolerance: Option<f64>,
    /// What the bodies are; a body inside a solid one has the clearance zero.
    pub solid: Solid,
    /// Limits on the work.
    pub budget: Budget,
    /// Clearances above this are of no interest: the enclosure then begins here or above and may be wide.
    pub cutoff: f64,
    /// As [`QueryOptions::parallel`](crate::QueryOptions::parallel).
    pub parallel: bool,
}

/// R if none is given: formats and plots show six digits.
const ACCURACY: f64 = 1e-6;

impl Default for ClearanceOptions {
    fn default() -> Self {
        Self {
            accuracy: ACCURACY,
            tolerance: None,
            solid: Solid::Filled,
            budget: Budget::UNLIMITED,
            cutoff: f64::INFINITY,
            parallel: false,
        }
    }
}

impl ClearanceOptions {
    /// With this relative width of the enclosure.
    pub const fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.accuracy = accuracy;
        self
    }

    /// With this tolerance δ, a distance.
    pub const fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    /// With this meaning of the bodies.
    pub const fn with_solid(mut self, solid: Solid) -> Self {
        self.solid = solid;
        self
    }

    /// With this budget.
    pub const fn with_budget(mut self, budget: Budget) -> Self {
        self.budget = budget;
        self
    }

    /// With this largest clearance of interest.
    pub const fn with_cutoff(mut self, cutoff: f64) -> Self {
        self.cutoff = cutoff;
        self
    }

    /// On all threads of the current rayon pool, or on one.
    pub const fn with_parallel(mut self, parallel: bool) -> Self {
        self.parallel = parallel;
        self
    }
}

/// What is known of a clearance.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Budget, ClearanceOptions, ClearanceStatus, Moving, Window, clearance};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let options = ClearanceOptions::default();
/// assert_eq!(clearance(a, b, Window::UNIT, &options)?.status, ClearanceStatus::Contact);
/// assert_eq!(clearance(a, b, Window::try_new(0.0, 0.2)?, &options)?.status, ClearanceStatus::Clear);
/// let none = options.with_budget(Budget::UNLIMITED.with_node_tests(0));
/// assert_eq!(clearance(a, b, Window::UNIT, &none)?.status, ClearanceStatus::Undecided);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum ClearanceStatus {
    /// Proven: the bodies are apart at every time of the window.
    Clear,
    /// The bodies meet, or come within the tolerance of each other: what [`time_of_contact`](crate::time_of_contact) calls a contact.
    Contact,
    /// The budget ran out, or a motion's enclosures are too wide: the enclosure holds, but is wider than wanted.
    Undecided,
}

/// The least distance of two bodies over a window of time, enclosed, with its time and points.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{ClearanceOptions, Moving, Window, clearance};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// // After a tenth of a unit of time the tips are 0.6 apart, and that is the least.
/// let nearest = clearance(a, b, Window::try_new(0.0, 0.1)?, &ClearanceOptions::default())?;
/// assert!(nearest.lower <= 0.6 && 0.6 <= nearest.upper && nearest.upper - nearest.lower < 1e-6);
/// assert!((nearest.time - 0.1).abs() < 1e-6 && (nearest.normal - DVec3::NEG_Z).length() < 1e-6);
/// assert!((nearest.point_a - nearest.point_b).length() <= nearest.upper + 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub struct Clearance {
    /// Proven: at every time of the window the distance is at least this.
    pub lower: f64,
    /// Proven: at `time` the distance is at most this; `point_a` and `point_b` attain it, to rounding, unless the bodies overlap at the start:
    /// then they are points of triangles that cross, or of a body that the other one holds. Zero only where the bodies meet in the window: they are proven to share a point, or they touch and nobody can say more, since placing them by their poses errs by as
    /// much as is between them: the two triangles are placed no further apart than the sum e of what placing them may be off by (some
    /// 1e-14 of the lengths that enter), so the distance is at most 2e. A time of contact is then the last number before it, with
    /// at most 3.3 `tolerance` left.
    pub upper: f64,
    /// A time of the window at which the distance is at most `upper`; with the status [`Contact`](ClearanceStatus::Contact) the time of
    /// contact.
    pub time: f64,
    /// The point on A at `time`, world frame.
    pub point_a: DVec3,
    /// The point on B at `time`, world frame.
    pub point_b: DVec3,
    /// Unit direction from A to B, world frame; zero where nothing is known of it.
    pub normal: DVec3,
    /// The features that hold the points, by their ids in the meshes.
    pub feature: FeaturePair,
    /// Triangle of A.
    pub triangle_a: u32,
    /// Triangle of B.
    pub triangle_b: u32,
    /// The tolerance δ that was used: that of the options, unless rounding forbids it; of bodies that meet at least that of the contact,
    /// which is what is left at its time where numbers for time are too far apart for less.
    pub tolerance: f64,
    /// What is known.
    pub status: ClearanceStatus,
}
