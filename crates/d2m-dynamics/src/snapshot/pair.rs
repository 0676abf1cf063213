//! The state of a pair of bodies in a snapshot: all that the next step reads of it.

use crate::SimulationError;
use crate::body::rigid_body::{RigidBody, Target};
use crate::numbers::{UNUSABLE, is_small, is_turn, is_unit, material_fault};
use crate::pairs::clearance::Clearance;
use crate::pairs::known::{Attempts, Pair, distance_of};
use crate::shown::shown;
use crate::snapshot::contents::{Held, Source};
use d2m_bvh::PairCache;
use d2m_contact::{ContactPoint, Material, Momenta};
use d2m_feature::FeaturePair;
use d2m_motion::Pose;
use glam::DVec3;

/// Failed proofs count, too: a query begins where the last proof has ended, and has other last bits
/// otherwise.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PairState {
    pub(crate) bodies: [usize; 2],
    gap: f64,
    nearest: Option<f64>,
    measured: Option<f64>,
    reach: f64,
    normal: Option<DVec3>,
    apart: f64,
    axes: Attempts,
    borne: [Momenta; 2],
    owed: [Momenta; 2],
    clearance: Option<ClearanceState>,
    contacts: Vec<ContactState>,
    #[cfg_attr(feature = "serde", serde(skip))]
    cache: Held<Box<PairCache>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct ClearanceState {
    places: [Target; 2],
    distance: f64,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct ContactState {
    feature: FeaturePair,
    normal: DVec3,
    distance: f64,
    arm_a: DVec3,
    arm_b: DVec3,
    point: DVec3,
    restitution: f64,
    friction: f64,
    running: [f64; 2],
    impulse: f64,
    sliding: [f64; 2],
}

impl PairState {
    pub(crate) fn of(bodies: [usize; 2], pair: &Pair) -> Self {
        let place = |pose: Pose| Target { position: pose.translation, orientation: pose.rotation };
        Self {
            bodies,
            gap: pair.gap,
            nearest: pair.nearest,
            measured: pair.measured,
            reach: pair.reach,
            normal: pair.normal,
            apart: pair.apart,
            axes: pair.axes,
            borne: pair.borne,
            owed: pair.owed,
            clearance: pair
                .clearance
                .map(|known| ClearanceState { places: known.poses.map(place), distance: known.distance }),
            contacts: pair.contacts.iter().map(ContactState::of).collect(),
            cache: Held(Some(pair.cache.clone())),
        }
    }

    /// The pair in this state. A distance that was not proven for these bodies is computed again.
    pub(crate) fn restored(&self, bodies: [&RigidBody; 2], source: Source) -> Result<Pair, SimulationError> {
        if let Some((name, value)) = self.fault() {
            let [a, b] = bodies.map(|body| body.name.to_string());
            return Err(SimulationError::BadPair { a, b, name, value, reason: UNUSABLE });
        }
        let mut cache = match source {
            Source::Held => self.cache.0.clone().unwrap_or_default(),
            Source::Read => Box::default(),
        };
        let clearance = self.clearance.and_then(|known| {
            let poses = [0, 1].map(|k| {
                let Target { position, orientation } = known.places[k];
                Pose { translation: position, rotation: orientation, at: bodies[k].center }
            });
            let distance = match source {
                Source::Held => Some(known.distance),
                Source::Read => distance_of(bodies, poses, f64::INFINITY, &mut cache)
                    .ok()
                    .flatten()
                    .map(|found| found.lower),
            };
            distance.map(|distance| Clearance { poses, distance })
        });
        let [a, b] = self.bodies;
        Ok(Pair {
            cache,
            gap: self.gap,
            contacts: self.contacts.iter().map(|contact| contact.restored(a, b, self.gap)).collect(),
            nearest: self.nearest,
            measured: self.measured,
            reach: self.reach,
            clearance,
            normal: self.normal,
            apart: self.apart,
            axes: self.axes,
            borne: self.borne,
            owed: self.owed,
        })
    }

    /// The name of a number that cannot be used, and the number.
    fn fault(&self) -> Option<(&'static str, String)> {
        let is_way = |x: &f64| x.is_finite() && *x > 0.0;
        let is_place = |place: &Target| is_small(place.position) && is_turn(place.orientation);
        if !is_way(&self.gap) {
            return Some(("gap", shown([self.gap])));
        }
        if let Some(nearest) = self.nearest.filter(|nearest| !is_way(nearest)) {
            return Some(("least distance", shown([nearest])));
        }
        if let Some(measured) = self.measured.filter(|measured| !measured.is_finite()) {
            return Some(("time of the last measurement", shown([measured])));
        }
        if !(self.reach > 0.0 && self.reach <= 1.0) {
            return Some(("reach", shown([self.reach])));
        }
        if let Some(normal) = self.normal.filter(|normal| !is_unit(*normal)) {
            return Some(("normal", shown(normal.to_array())));
        }
        if !(self.apart >= 0.0 && self.apart.is_finite()) {
            return Some(("distance", shown([self.apart])));
        }
        if !self.axes.is_counted() {
            return Some(("attempts", format!("{:?}", self.axes)));
        }
        let borne = self.borne.iter().chain(&self.owed).flat_map(|borne| [borne.linear, borne.angular]);
        if let Some(borne) = borne.into_iter().find(|borne| !is_small(*borne)) {
            return Some(("what bodies that sleep bear", shown(borne.to_array())));
        }
        let place = self.clearance.iter().flat_map(|known| &known.places).find(|place| !is_place(place));
        if let Some(place) = place {
            return Some(("place", format!("{place:?}")));
        }
        self.contacts.iter().find_map(ContactState::fault)
    }
}

impl ContactState {
    fn fault(&self) -> Option<(&'static str, String)> {
        if !self.normal.is_normalized() {
            return Some(("normal of a contact", shown(self.normal.to_array())));
        }
        if let Some(fault) = material_fault(self.restitution, self.friction) {
            return Some((fault.name, shown([fault.value])));
        }
        let vectors = [
            ("distance of a contact", DVec3::splat(self.distance)),
            ("arm of a contact", self.arm_a),
            ("arm of a contact", self.arm_b),
            ("point of a contact", self.point),
            ("surface velocity of a contact", DVec3::new(self.running[0], self.running[1], 0.0)),
            ("impulse of a contact", DVec3::new(self.sliding[0], self.sliding[1], self.impulse)),
        ];
        let (name, value) = vectors.into_iter().find(|(_, vector)| !is_small(*vector))?;
        Some((name, shown(value.to_array())))
    }

    fn of(contact: &ContactPoint) -> Self {
        Self {
            feature: contact.feature,
            normal: contact.normal,
            distance: contact.distance,
            arm_a: contact.arm_a,
            arm_b: contact.arm_b,
            point: contact.point,
            restitution: contact.material.restitution,
            friction: contact.material.friction,
            running: contact.running,
            impulse: contact.impulse,
            sliding: contact.sliding,
        }
    }

    fn restored(&self, a: usize, b: usize, gap: f64) -> ContactPoint {
        let material = Material::new(self.restitution, self.friction);
        ContactPoint {
            feature: self.feature,
            distance: self.distance,
            gap,
            point: self.point,
            running: self.running,
            impulse: self.impulse,
            sliding: self.sliding,
            ..ContactPoint::new([a, b], [self.arm_a, self.arm_b], self.normal, material)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use crate::pairs::closest_features::measure;
    use d2m_bvh::MeshTree;
    use d2m_mesh::Faces;
    use std::sync::Arc;

    type Change = &'static dyn Fn(&mut PairState);

    /// Two cubes that are a gap apart, and what is known of the pair.
    fn near() -> (Vec<RigidBody>, Pair) {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        let faces = Arc::new(Faces::new(tree.mesh()));
        let at = |x: f64| Body::new(format!("at {x}"), Arc::clone(&tree)).with_position(DVec3::X * x);
        let bodies: Vec<RigidBody> =
            [0.0, 1.001].map(|x| RigidBody::try_new(&at(x), Arc::clone(&faces), 0.0).unwrap()).into();
        let material = Material::new(0.0, 0.5);
        let mut pair = Pair::new(1e-3);
        pair.keep(measure(&bodies, (0, 1), 0.0, 2e-3, 1e-3, material, &[]).unwrap(), 0.0, 1e-3);
        let poses = [0, 1].map(|k| bodies[k].pose_at(0.0));
        let found = distance_of([&bodies[0], &bodies[1]], poses, 1.0, &mut pair.cache).unwrap().unwrap();
        pair.clearance = Some(Clearance { poses, distance: found.lower });
        (bodies, pair)
    }

    /// A distance that is read is no proof: it is computed again, to the same bits.
    #[test]
    fn distances_of_a_file_prove_nothing() {
        let (bodies, pair) = near();
        let bodies = [&bodies[0], &bodies[1]];
        let mut state = PairState::of([0, 1], &pair);
        let restored = |state: &PairState, source: Source| state.restored(bodies, source).unwrap();
        for source in [Source::Held, Source::Read] {
            assert_eq!(PairState::of([0, 1], &restored(&state, source)), state);
        }
        let proven = pair.clearance.unwrap().distance;
        state.clearance.as_mut().unwrap().distance = 1e9;
        assert_eq!(restored(&state, Source::Read).clearance.unwrap().distance, proven);
    }

    #[test]
    fn numbers_that_no_pair_has_are_refused_by_their_names() {
        let (bodies, pair) = near();
        let changes: [(&str, Change); 18] = [
            ("gap", &|s| s.gap = -1.0),
            ("least distance", &|s| s.nearest = Some(0.0)),
            ("time of the last measurement", &|s| s.measured = Some(f64::NAN)),
            ("reach", &|s| s.reach = 2.0),
            ("normal", &|s| s.normal = Some(DVec3::X * 1.001)),
            ("distance", &|s| s.apart = f64::INFINITY),
            ("attempts", &|s| s.axes = Attempts { failed: u32::MAX, ..s.axes }),
            ("what bodies that sleep bear", &|s| s.borne[0].linear = DVec3::NAN),
            ("what bodies that sleep bear", &|s| s.owed[1].angular.y = 1e160),
            ("place", &|s| s.clearance.as_mut().unwrap().places[0].position = DVec3::NAN),
            ("normal of a contact", &|s| s.contacts[0].normal = DVec3::ZERO),
            ("restitution", &|s| s.contacts[0].restitution = 2.0),
            ("friction", &|s| s.contacts[0].friction = -1.0),
            ("distance of a contact", &|s| s.contacts[0].distance = f64::NAN),
            ("arm of a contact", &|s| s.contacts[0].arm_b = DVec3::NAN),
            ("point of a contact", &|s| s.contacts[0].point = DVec3::NAN),
            ("surface velocity of a contact", &|s| s.contacts[0].running[0] = 1e160),
            ("impulse of a contact", &|s| s.contacts[0].impulse = 1e160),
        ];
        for (name, change) in changes {
            let mut state = PairState::of([0, 1], &pair);
            change(&mut state);
            let said = state.restored([&bodies[0], &bodies[1]], Source::Held).unwrap_err().to_string();
            assert!(said.starts_with(&format!("pair of at 0 and at 1.001: {name} ")), "{name}: {said}");
        }
    }
}
