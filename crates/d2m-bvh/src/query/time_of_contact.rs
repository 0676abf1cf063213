//! The query for the first contact of two bodies.

use super::at_start::judged;
use super::carried_pair::CarriedPair;
use super::leave::of_departing;
use super::meshes::of_meshes;
use super::rounded::Rounded;
use crate::covered_pair::CoveredPair;
use crate::{Answered, Meter, Moving, QueryError, QueryOptions, Start, TimeOfContact, Window};

/// First time in `window` at which the two bodies touch.
///
/// Constant twists (screw motions too) are searched as they are, keyframes span by span. Any other motion is
/// approximated by constant twists on spans of time, with a proven deviation that is taken from the gap: usually three to
/// five searches, most of them over short spans. Bodies that one motion carries together – the same reference, chains or twists with
/// equal numbers – are seen from it, and links of one arm from the last joint that they have in common, in this query and all others of
/// moving bodies: how fast that is does not matter.
///
/// Promise: never a missed contact, never a late one. See [`TimeOfContact`] and [`Contact`](crate::Contact) for what
/// each answer certifies, and [`QueryOptions`] for what can be chosen.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact};
/// use d2m_motion::ConstantTwist;
/// use glam::{DQuat, DVec3};
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
/// let tree = MeshTree::new(mesh);
/// let falling = ConstantTwist::try_new(DVec3::Z * 2.0, DQuat::IDENTITY, -DVec3::Z * 4.0, DVec3::ZERO).unwrap();
/// let answer = time_of_contact(
///     Moving::new(&tree, &falling),
///     Moving::new(&tree, &ConstantTwist::REST),
///     Window::UNIT,
///     &QueryOptions::default(),
/// ).unwrap();
/// let contact = answer.contact().unwrap();
/// assert!(contact.time_lo <= 0.25 && contact.time_lo > 0.25 - 1e-10);
/// assert!((contact.closing_speed - 4.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// Bad input only: a tolerance, separation or motion that is not finite, a filled solid that does not close, a window that
/// leaves a motion's times.
pub fn time_of_contact(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
) -> Result<TimeOfContact, QueryError> {
    Ok(time_of_contact_counted(a, b, window, options)?.answer)
}

/// As [`time_of_contact`], and what was done to find the answer.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, Window, time_of_contact, time_of_contact_counted};
/// # use d2m_motion::ConstantTwist;
/// # // Falls by 4 from a height of 2 onto the tip of the other one, which is at height 1: they meet at 0.25.
/// # let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// # let [a, b] = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let options = QueryOptions::default();
/// let counted = time_of_contact_counted(a, b, Window::UNIT, &options)?;
/// assert_eq!(counted.answer, time_of_contact(a, b, Window::UNIT, &options)?);
/// assert!(counted.work.node_tests > 0); // the same on every machine
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`time_of_contact`].
pub fn time_of_contact_counted(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
) -> Result<Answered<TimeOfContact>, QueryError> {
    let rounded = Rounded::try_new([&a, &b])?;
    let options = rounded.options([a.body, b.body], options)?;
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let [a, b] = carried.seen();
    let Answered { answer, work } = match options.start {
        Start::Leave => {
            let Answered { answer, work } = of_departing([a, b], window, &options)?;
            Answered { answer: answer.answer, work }
        }
        Start::Report => {
            let meter = Meter::new(&options.budget);
            let found = of_meshes([a, b], window, &options)?;
            // Of the same time.
            judged(&found, &[a, b], window, &options.with_budget(meter.rest()))?
        }
    };
    Ok(Answered { answer: rounded.answer(carried.in_world(answer)?), work })
}
