//! Which body holds a part of the other one?
//!
//! Where no two surfaces touch, each connected part of a surface is entirely in the other solid or entirely outside of it, so
//! one vertex of each part decides. If no part of either surface is in the other solid, the solids share no point: a
//! common point would be in a region of one solid whose boundary is in no region of the other, and the other way round.

use super::node_pair::{InversePose, RestingScene};
use super::winding::contains;
use crate::meter::{Exhausted, Meter};
use crate::{MeshTree, Solid};
use glam::DVec3;

/// A part of a body inside the other one.
///
/// ```
/// // Vertex 3 of A is inside of B.
/// let held = d2m_mesh::at_rest::Held { by: 1, vertex: 3 };
/// assert_eq!(1 - held.by, 0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// The body that holds: 0 is A, 1 is B.
    pub by: usize,
    /// A vertex of the other body that is inside.
    pub vertex: u32,
}

/// A vertex of `inner` in the solid `holder`, one of each connected part of its surface. `place`: from the center of
/// `inner`, in its axes, to coordinates from the center of `holder`, in the axes of that. For surfaces that are apart wherever rounding
/// may have placed them.
///
/// ```
/// use d2m_mesh::at_rest::held_vertex;
/// use d2m_mesh::{MeshTree, Meter, TriMesh};
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let solid = MeshTree::new(TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?);
/// let point = MeshTree::new(TriMesh::point(DVec3::splat(0.125))?);
/// // Both frames are the world's.
/// let place = |p: DVec3| p + (point.center() - solid.center());
/// assert_eq!(held_vertex(&solid, &point, place, &mut Meter::unlimited()), Ok(Some(0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Exhausted`] when the meter runs out.
pub fn held_vertex(
    holder: &MeshTree,
    inner: &MeshTree,
    place: impl Fn(DVec3) -> DVec3,
    meter: &mut Meter,
) -> Result<Option<u32>, Exhausted> {
    for &vertex in inner.component_vertices() {
        meter.step()?;
        let p = place(inner.mesh().vertices()[vertex as usize] - inner.center());
        if contains(holder, p, meter)? {
            return Ok(Some(vertex));
        }
    }
    Ok(None)
}

/// Does one body that is filled hold a part of the other? For surfaces whose placed triangles are more than `scene.error` apart: moving
/// every vertex to its placed position is then a motion without contact, so what is inside stays inside.
pub(crate) fn one_holds_the_other(
    scene: &RestingScene<'_>,
    solids: [Solid; 2],
    meter: &mut Meter,
) -> Result<Option<Held>, Exhausted> {
    for by in [0, 1].into_iter().filter(|&by| solids[by] == Solid::Filled) {
        if let Some(vertex) = held_by(scene, by, meter)? {
            return Ok(Some(Held { by, vertex }));
        }
    }
    Ok(None)
}

/// A vertex of the other body that this one holds; for surfaces that are apart, as above.
pub(crate) fn held_by(
    scene: &RestingScene<'_>,
    by: usize,
    meter: &mut Meter,
) -> Result<Option<u32>, Exhausted> {
    let to_b = || InversePose { rotation: scene.pose.rotation, offset: scene.pose.offset };
    let InversePose { rotation: r, offset } = if by == 0 { scene.pose.inverse() } else { to_b() };
    let place = |p: DVec3| r[0] * p.x + r[1] * p.y + r[2] * p.z + offset;
    held_vertex(scene.trees[by], scene.trees[1 - by], place, meter)
}
