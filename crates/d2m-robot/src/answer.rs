//! What is answered about a path.

use d2m_bvh::Contact;

/// Is a path free of contact, and until when?
///
/// ```
/// # let urdf = r#"<robot name="two">
/// #   <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
/// #   <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
/// #   <link name="wall"><collision><origin xyz="0 0.7 0"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
/// #   <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
/// #     <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="base"/><child link="wall"/></joint>
/// # </robot>"#;
/// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// # let robot = Robot::parse("two.urdf", urdf, &RobotOptions::new())?;
/// # let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// # let to = |angle: f64, time: f64| {
/// #     let points = vec![TrajectoryPoint::new(0.0, vec![0.0]), TrajectoryPoint::new(time, vec![angle])];
/// #     Trajectory::new(vec!["turn".into()], points)
/// # };
/// use d2m_robot::PathAnswer;
/// match scene.check_path(&to(2.0, 4.0))? {
///     PathAnswer::Contact(found) => assert!(found.contact.time_lo > 2.5), // into the wall
///     other => panic!("{other:?}"),
/// }
/// assert!(scene.check_path(&to(0.5, 1.0))?.is_free());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub enum PathAnswer {
    /// Certified: no pair meets at any time of the path. With [`Start::Leave`](d2m_bvh::Start::Leave) that holds of pairs in contact at the start from
    /// the time on at which they are proven to have parted, here and below.
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
///
/// ```
/// # let urdf = r#"<robot name="two">
/// #   <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
/// #   <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
/// #   <link name="wall"><collision><origin xyz="0 0.7 0"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
/// #   <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
/// #     <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="base"/><child link="wall"/></joint>
/// # </robot>"#;
/// # use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// # let robot = Robot::parse("two.urdf", urdf, &RobotOptions::new())?;
/// # let scene = RobotScene::new(robot.into(), None, d2m_bvh::QueryOptions::default())?;
/// # let to = |angle: f64, time: f64| {
/// #     let points = vec![TrajectoryPoint::new(0.0, vec![0.0]), TrajectoryPoint::new(time, vec![angle])];
/// #     Trajectory::new(vec!["turn".into()], points)
/// # };
/// let answer = scene.check_path(&to(2.0, 4.0))?;
/// let found = answer.contact().expect("the arm sweeps into the wall");
/// assert_eq!([found.a.as_str(), found.b.as_str()], ["arm", "wall"]);
/// assert_eq!(found.contact.time_lo, answer.free_until());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
