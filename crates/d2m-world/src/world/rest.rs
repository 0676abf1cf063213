//! All bodies at one time.

use super::schedule::Uncovered;
use super::{PairProximities, World, WorldError};
use crate::batches::{BOXES, PAIRS};
use crate::box_tree::BoxTree;
use crate::swept_bounds::CoveredBody;
use crate::{Aabb, Body};
use d2m_bvh::{Posed, Proximity, ProximityOptions, QueryError, proximities_with};
use d2m_mesh::parallel::map_in_order;

impl World {
    /// The locally closest features of all pairs at one time, ascending by places: [`d2m_bvh::proximities_with`] of every pair
    /// within the margin that is not ignored.
    ///
    /// ```
    /// use glam::DVec3;
    /// use d2m_bvh::{MeshTree, ProximityOptions, QueryOptions};
    /// use d2m_motion::ConstantTwist;
    /// use d2m_world::{Body, World};
    /// use std::sync::Arc;
    /// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// let mut world = World::new(QueryOptions::default());
    /// for k in 0..5 {
    ///     let height = DVec3::Z * (1.001 * f64::from(k));
    ///     world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(height)));
    /// }
    /// let near = world.proximities(0.0, &ProximityOptions::new(0.01))?;
    /// assert_eq!(near.len(), 4);
    /// assert!(near.iter().all(|pair| d2m_bvh::reduce_proximities(&pair.proximities, 0.1).len() == 4));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A motion that does not cover the time. Bad input of a pair, with its names; bodies that are not apart are that here ([`d2m_bvh::QueryError::NotApart`]).
    pub fn proximities(
        &self,
        time: f64,
        options: &ProximityOptions,
    ) -> Result<Vec<PairProximities>, WorldError> {
        let places: Vec<u32> = (0..self.slots.places() as u32).collect();
        let boxes = map_in_order(&places, BOXES, |&place| {
            let Some(body) = self.slots.at(place) else { return Ok(Aabb::EMPTY) };
            let covered = CoveredBody::try_new(body, time, time);
            covered.map(CoveredBody::swept).map_err(|outside| self.uncovered(Uncovered { place, outside }))
        });
        let boxes = boxes.into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut tree = BoxTree::default();
        tree.fit(&boxes);
        let mut pairs = Vec::new();
        tree.pairs(&boxes, options.margin, |pair| {
            if !self.filter.ignores(pair, self.slots.groups(pair)) {
                pairs.push(pair);
            }
        });
        pairs.sort_unstable();
        let found = map_in_order(&pairs, PAIRS, |&pair| {
            let [Some(a), Some(b)] = pair.map(|place| self.slots.at(place)) else { return Ok(Vec::new()) };
            of_pair([a, b], time, options)
        });
        let mut near = Vec::new();
        for (pair, found) in pairs.into_iter().zip(found) {
            let [a, b] = pair.map(|place| self.slots.id(place));
            let proximities = found.map_err(|error| WorldError::Pair { a, b, error })?;
            if !proximities.is_empty() {
                near.push(PairProximities { a, b, proximities });
            }
        }
        Ok(near)
    }
}

/// The locally closest features of two bodies: those of their meshes, moved to the surfaces that their radii make.
fn of_pair(bodies: [&Body; 2], time: f64, options: &ProximityOptions) -> Result<Vec<Proximity>, QueryError> {
    let [a, b] = bodies.map(|body| Posed::new(body.tree(), body.motion().pose_and_twist(time).0));
    let radii = bodies.map(Body::radius);
    if let Some(body) = radii.iter().position(|radius| !(radius.is_finite() && *radius >= 0.0)) {
        return Err(QueryError::BadRadius { body, value: radii[body] });
    }
    let both = radii[0] + radii[1];
    if both == 0.0 {
        return proximities_with(a, b, options);
    }
    let mut wide = *options;
    wide.margin = (options.margin + both).next_up();
    let mut found = proximities_with(a, b, &wide)?;
    for near in &mut found {
        *near = near.with_radii(radii);
    }
    if let Some(&Proximity { triangle_a, triangle_b, .. }) = found.iter().find(|near| near.distance <= 0.0) {
        return Err(QueryError::NotApart { triangle_a, triangle_b });
    }
    found.retain(|near| near.distance <= options.margin);
    Ok(found)
}
