//! Answers about paths of robots.

use super::leaving::{clear_until, departed};
use super::{MeshFault, Verdict, Verifier};
use crate::{Moving, QueryError, TimeOfContact};
use d2m_bvh::Start;
use d2m_robot::{PathAnswer, PathBodies, PathContact};

/// What became of an answer about a path.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathVerdict {
    /// It is true.
    Verified {
        /// Steps that the proofs of all pairs took.
        steps: u64,
    },
    /// It was not proven, or is false, by what became of this pair: numbers in [`PathBodies`].
    Pair {
        /// The bodies.
        pair: [usize; 2],
        /// What became of the answer about these two: not [`Verdict::Verified`].
        verdict: Verdict,
    },
    /// These two, which are let go while they are in contact from the start, meet again before the answer says so, or never part: found by
    /// a query of the pair alone.
    MeetBefore {
        /// The bodies.
        pair: [usize; 2],
        /// The query's end of what is free.
        clear_until: f64,
    },
    /// Its contact is one of bodies that are not checked, or that have other names.
    OtherBodies,
}

/// A pair that cannot be proven anything about.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("bodies {} and {}: {fault}", pair[0], pair[1])]
#[non_exhaustive]
pub struct PathVerdictFault {
    /// The bodies: numbers in [`PathBodies`].
    pub pair: [usize; 2],
    /// What is wrong with them.
    pub fault: PairFault,
}

/// What is wrong with a pair.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PairFault {
    /// A mesh without triangles.
    #[error(transparent)]
    Mesh(#[from] MeshFault),
    /// Refused by the query of the pair.
    #[error(transparent)]
    Query(#[from] QueryError),
}

/// Proves an answer about a path again, pair by pair: the pair that meets as it was found, all others apart until then. Pairs whose start is
/// [`Start::Leave`] are proven to leave by an answer of [`departure`](crate::departure) of their own, which is proven, too. The steps are for all pairs.
///
/// ```
/// use d2m::robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
/// use d2m::verify::{DEFAULT_STEPS, PathVerdict, verify_path};
/// # let text = r#"<robot name="slide">
/// #   <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
/// #   <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
/// #   <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
/// #   <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
/// #   <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint>
/// # </robot>"#;
/// let robot = Robot::parse("slide.urdf", text, &RobotOptions::new())?;
/// let scene = RobotScene::new(robot.into(), None, d2m::QueryOptions::default())?;
/// let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
/// let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(2.0, 1.0)]);
/// let answer = scene.check_path(&path)?;
/// let verdict = verify_path(&scene.bodies_along(&path)?, &answer, DEFAULT_STEPS)?;
/// assert!(matches!(verdict, PathVerdict::Verified { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A pair that cannot be proven anything about.
pub fn verify_path(
    bodies: &PathBodies<'_>,
    answer: &PathAnswer,
    most_steps: u64,
) -> Result<PathVerdict, PathVerdictFault> {
    if answer.contact().is_some_and(|found| !are_checked(bodies, found)) {
        return Ok(PathVerdict::OtherBodies);
    }
    let mut left = most_steps;
    for &pair in bodies.pairs() {
        let proof = PairOfPath::new(bodies, answer, pair);
        match proof.prove(left).map_err(|fault| PathVerdictFault { pair, fault })? {
            PathVerdict::Verified { steps } => left = left.saturating_sub(steps),
            other => return Ok(other),
        }
    }
    Ok(PathVerdict::Verified { steps: most_steps - left })
}

/// Is this a contact of two bodies that are checked, by their own names?
fn are_checked(bodies: &PathBodies<'_>, found: &PathContact) -> bool {
    let [a, b] = found.bodies;
    bodies.pairs().iter().any(|&pair| pair == [a, b] || pair == [b, a])
        && [bodies.name(a), bodies.name(b)] == [&found.a, &found.b]
}

/// One pair, and what the answer says of it.
struct PairOfPath<'a> {
    bodies: &'a PathBodies<'a>,
    pair: [usize; 2],
    moving: [Moving<'a>; 2],
    until: f64,
    claimed: TimeOfContact,
}

impl<'a> PairOfPath<'a> {
    fn new(bodies: &'a PathBodies<'a>, answer: &PathAnswer, pair: [usize; 2]) -> Self {
        let until = answer.free_until();
        let apart = if until < bodies.window().end() {
            TimeOfContact::Undecided { clear_until: until }
        } else {
            TimeOfContact::Separated
        };
        let met = answer.contact().filter(|found| {
            let [a, b] = found.bodies;
            pair == [a, b] || pair == [b, a]
        });
        let (pair, claimed) =
            met.map_or((pair, apart), |found| (found.bodies, TimeOfContact::Contact(found.contact)));
        Self { bodies, pair, moving: pair.map(|body| bodies.moving(body)), until, claimed }
    }

    fn prove(&self, most_steps: u64) -> Result<PathVerdict, PairFault> {
        let (pair, window) = (self.pair, self.bodies.window());
        let options = self.bodies.pair_options(pair);
        let [a, b] = self.moving.map(|body| body.body.mesh());
        let verifier = Verifier::try_new(a, b)?;
        let verdict = if options.start == Start::Leave {
            let claimed = departed(&self.moving, window, &options, &self.claimed)?;
            let clear_until = clear_until(&claimed.answer, window);
            if clear_until < self.until {
                return Ok(PathVerdict::MeetBefore { pair, clear_until });
            }
            verifier.departure(&self.moving, window, &options, &claimed, most_steps)
        } else {
            verifier.time_of_contact(&self.moving, window, &options, &self.claimed, most_steps)
        };
        Ok(match verdict {
            Verdict::Verified { steps } => PathVerdict::Verified { steps },
            verdict => PathVerdict::Pair { pair, verdict },
        })
    }
}
