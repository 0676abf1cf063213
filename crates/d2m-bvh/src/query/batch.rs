//! Many queries at once.

use super::kept_motion::KeptMotions;
use super::time_of_contact::time_of_contact;
use crate::{Moving, QueryError, QueryOptions, TimeOfContact, Window};
use d2m_mesh::parallel::map_in_order;

/// [`time_of_contact`] of many pairs of bodies, in order. On all threads of the current rayon pool with the feature
/// `rayon`; each query runs on one thread, so the answers have the same bits at any number of threads (but for a
/// budget of wall-clock time). What is computed of a motion that several bodies have – the same reference – is kept for all of them. When somebody cancels, the queries that have not begun end undecided, whatever their input.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact_batch};
/// use d2m_motion::ConstantTwist;
/// use glam::{DQuat, DVec3};
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
/// let tree = MeshTree::new(mesh);
/// let falling = [2.0, 20.0].map(|height| {
///     ConstantTwist::try_new(DVec3::Z * height, DQuat::IDENTITY, -DVec3::Z * 4.0, DVec3::ZERO).unwrap()
/// });
/// let rest = ConstantTwist::REST;
/// let pairs: Vec<_> = falling.iter().map(|m| (Moving::new(&tree, m), Moving::new(&tree, &rest))).collect();
/// let answers = time_of_contact_batch(&pairs, Window::UNIT, &QueryOptions::default());
/// assert!(answers[0].unwrap().contact().is_some() && answers[1].unwrap().is_separated());
/// ```
pub fn time_of_contact_batch(
    pairs: &[(Moving<'_>, Moving<'_>)],
    window: Window,
    options: &QueryOptions,
) -> Vec<Result<TimeOfContact, QueryError>> {
    let is_cancelled = || options.budget.cancel.is_some_and(|flag| flag.is_cancelled());
    let one = |&(a, b): &(Moving<'_>, Moving<'_>)| {
        if is_cancelled() {
            return Ok(TimeOfContact::Undecided { clear_until: window.start() });
        }
        time_of_contact(a, b, window, options)
    };
    let kept = KeptMotions::new(pairs);
    map_in_order(&kept.in_pairs(pairs), 1, one)
}
