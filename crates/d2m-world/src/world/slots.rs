//! The bodies of a world, by place and generation.

use super::BodyId;
use super::pair_state::Versions;
use crate::box_tree::IndexPair;
use crate::{Body, Group};

/// A place for a body.
#[derive(Clone, Debug)]
struct Slot {
    generation: u32,
    /// New whenever the body changes; no two bodies of a world ever have the same.
    version: u64,
    body: Option<Body>,
}

/// All places.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    places: Vec<Slot>,
    free: Vec<u32>,
    last_version: u64,
}

impl Slots {
    pub(super) fn insert(&mut self, body: Body) -> BodyId {
        self.last_version += 1;
        let version = self.last_version;
        if let Some(index) = self.free.pop() {
            let slot = &mut self.places[index as usize];
            (slot.version, slot.body) = (version, Some(body));
            return BodyId { index, generation: slot.generation };
        }
        let index = self.places.len() as u32;
        self.places.push(Slot { generation: 0, version, body: Some(body) });
        BodyId { index, generation: 0 }
    }

    pub(super) fn remove(&mut self, id: BodyId) -> Option<Body> {
        let slot = self.places.get_mut(id.index as usize).filter(|slot| slot.generation == id.generation)?;
        let body = slot.body.take()?;
        slot.generation += 1;
        self.free.push(id.index);
        Some(body)
    }

    pub(super) fn get(&self, id: BodyId) -> Option<&Body> {
        self.places.get(id.index as usize).filter(|slot| slot.generation == id.generation)?.body.as_ref()
    }

    /// Is this body there?
    pub(super) fn holds(&self, id: BodyId) -> bool {
        self.get(id).is_some()
    }

    /// To be changed: gets a new version.
    pub(super) fn get_mut(&mut self, id: BodyId) -> Option<&mut Body> {
        let slot = self.places.get_mut(id.index as usize).filter(|slot| slot.generation == id.generation)?;
        self.last_version += 1;
        slot.version = self.last_version;
        slot.body.as_mut()
    }

    /// How many places there are, empty ones included.
    pub(super) fn places(&self) -> usize {
        self.places.len()
    }

    /// How many bodies there are.
    pub(super) fn count(&self) -> usize {
        self.places.len() - self.free.len()
    }

    pub(super) fn at(&self, place: u32) -> Option<&Body> {
        self.places.get(place as usize)?.body.as_ref()
    }

    pub(super) fn id(&self, place: u32) -> BodyId {
        BodyId { index: place, generation: self.places[place as usize].generation }
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        let used = self.places.iter().enumerate().filter(|(_, slot)| slot.body.is_some());
        used.map(|(index, slot)| BodyId { index: index as u32, generation: slot.generation })
    }

    /// The versions of two bodies; none if one of them is gone.
    #[inline]
    pub(super) fn versions(&self, pair: IndexPair) -> Option<Versions> {
        let version = |place: u32| {
            let slot = self.places.get(place as usize)?;
            slot.body.is_some().then_some(slot.version)
        };
        Some([version(pair[0])?, version(pair[1])?])
    }

    pub(super) fn groups(&self, pair: IndexPair) -> [Option<Group>; 2] {
        pair.map(|place| self.at(place).and_then(Body::group))
    }
}
