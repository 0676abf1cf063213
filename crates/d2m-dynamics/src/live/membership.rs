//! Adding, replacing and removing bodies, and the one function that forgets what was proven of them.

use crate::body::rigid_body::{RigidBody, Role};
use crate::numbers::check_surface;
use crate::pairs::known::Pair;
use crate::rest::quiet::Quiet;
use crate::{Body, BodyId, Simulation, SimulationError};
use d2m_mesh::Faces;
use std::sync::Arc;

impl Simulation {
    /// Adds a body. If the simulation runs already, the body appears in the segments from the next step on.
    /// The next step checks that it intersects no other one, so that pairs may be ignored until then;
    /// [`Self::add_checked`] checks at once.
    ///
    /// # Errors
    /// Numbers that cannot be used; missing mass properties. Nothing changes then.
    pub fn add(&mut self, body: &Body) -> Result<BodyId, SimulationError> {
        let made = self.made(body)?;
        Ok(self.settle_in(made, None))
    }

    /// Makes a body that has no place yet.
    pub(crate) fn made(&self, body: &Body) -> Result<RigidBody, SimulationError> {
        let same = self.bodies.iter().find(|other| Arc::ptr_eq(&other.tree, &body.tree));
        let faces =
            same.map_or_else(|| Arc::new(Faces::new(body.tree.mesh())), |other| Arc::clone(&other.faces));
        let made = RigidBody::try_new(body, faces, self.time)?;
        check_surface(&body.name, body.surface_velocity, &self.options)?;
        Ok(made)
    }

    /// As [`Self::add`], but a body that intersects another one that it meets is refused at once.
    ///
    /// # Errors
    /// Those of [`Self::add`], and [`SimulationError::Intersecting`], which says with which body, about how
    /// deep, and where. Bodies that touch up to rounding are accepted, and parted by the next step. Nothing
    /// changes then.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationError, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let first = Body::new("first", cube);
    /// simulation.add_checked(&first)?;
    /// let second = Body::new("second", first.tree.clone()).with_position(DVec3::X * 0.9);
    /// match simulation.add_checked(&second) {
    ///     Err(SimulationError::Intersecting { depth, point, .. }) => {
    ///         assert!((depth - 0.1).abs() < 1e-3 && (0.4..=0.5).contains(&point.x));
    ///     }
    ///     other => panic!("{other:?}"),
    /// }
    /// assert_eq!(simulation.len(), 1);
    /// simulation.add_checked(&second.with_position(DVec3::X * 1.1))?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_checked(&mut self, body: &Body) -> Result<BodyId, SimulationError> {
        let id = self.add(body)?;
        match self.check_place(id.index()) {
            Ok(()) => Ok(id),
            Err(error) => {
                // Nobody has got its name yet.
                self.clear_out(id.index());
                Err(error)
            }
        }
    }

    /// Removes a body, with its joints; false if it is not there any more. Bodies that rested on it, or hung
    /// on it, are awake. Its name never means another body.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Kind, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let shelf = simulation.add(&Body::new("shelf", Arc::clone(&cube)).with_kind(Kind::Static))?;
    /// let vase = simulation.add(&Body::new("vase", cube).with_position(DVec3::Y * 1.001))?;
    /// while !simulation.is_asleep(vase) {
    ///     simulation.step()?;
    /// }
    /// assert!(simulation.remove(shelf) && !simulation.remove(shelf));
    /// simulation.step()?;
    /// assert!(simulation.linear_velocity(vase).y < 0.0 && simulation.ids().eq([vase]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn remove(&mut self, body: BodyId) -> bool {
        if !self.contains(body) {
            return false;
        }
        let place = body.index();
        self.end_touches_of(place);
        self.clear_out(place);
        self.generations[place] += 1;
        self.recorder.remove(body);
        true
    }

    /// Is this body there?
    pub fn contains(&self, body: BodyId) -> bool {
        self.bodies.get(body.index()).is_some_and(|own| own.role.is_named() && own.id == body)
    }

    /// The place that the next added body gets, its [`BodyId::index`]: the first free one.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Joint, JointKind, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// let hung = simulation.add(&Body::new("hung", Arc::clone(&cube)))?;
    /// assert_eq!(simulation.next_index(), 1);
    /// // Joints with the world take a place for it.
    /// simulation.add_joint(&Joint::new(JointKind::Spherical, hung, None, DVec3::Y))?;
    /// let next = simulation.next_index();
    /// assert_eq!((next, simulation.add(&Body::new("next", cube))?.index()), (2, 2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn next_index(&self) -> usize {
        let vacant = self.bodies.iter().position(|body| body.role == Role::Vacant);
        vacant.unwrap_or(self.bodies.len())
    }

    /// The place of a body.
    ///
    /// # Panics
    /// If it was removed, or its name belongs to another simulation.
    pub(crate) fn place(&self, body: BodyId) -> usize {
        assert!(self.contains(body), "{body:?} is not in this simulation");
        body.index()
    }

    /// Gives a body the first free place, or the wanted one if it is free.
    pub(crate) fn settle_in(&mut self, body: RigidBody, wanted: Option<usize>) -> BodyId {
        let is_free = |place: &usize| self.bodies.get(*place).is_none_or(|body| body.role == Role::Vacant);
        let place = wanted.filter(is_free).unwrap_or_else(|| self.next_index());
        // Places before it that were given up come back.
        while self.bodies.len() < place {
            let mut vacant = body.clone();
            vacant.vacate();
            self.bodies.push(vacant);
        }
        if place >= self.generations.len() {
            self.generations.resize(place + 1, 0);
        }
        let id = BodyId { place: place as u32, generation: self.generations[place] };
        // The number of flights goes on, so that no flight of an earlier body of the place had the same one.
        let version = self.bodies.get(place).map_or(0, |before| before.version + 1);
        let body = RigidBody { id, version, ..body };
        if place < self.bodies.len() {
            self.bodies[place] = body;
        } else {
            self.bodies.push(body);
        }
        self.drop_known(place);
        self.unchecked.insert(place);
        id
    }

    /// Frees a place and forgets all about its body. Free places at the end are given up.
    pub(crate) fn clear_out(&mut self, place: usize) {
        self.drop_known(place);
        for joined in self.joints.iter_mut().filter(|joined| joined.has(place)) {
            joined.take_out();
        }
        self.unchecked.remove(&place);
        self.ignored.retain(|&(a, b)| a != place && b != place);
        self.materials.retain(|&(a, b), _| a != place && b != place);
        self.touching.retain(|&(a, b)| a != place && b != place);
        self.bodies[place].vacate();
        while self.bodies.last().is_some_and(|body| body.role == Role::Vacant) {
            self.bodies.pop();
        }
    }

    /// **Every change from outside goes through here**: of a body's place, of its properties, of the bodies
    /// that it may meet. Everything that was proven or measured of its pairs, the box about its flight and
    /// its neighbors are forgotten. Its flight ends, and bodies that rest on it or are joined to it wake: its
    /// next flight is proven from nothing.
    pub(crate) fn drop_known(&mut self, place: usize) {
        let touches = |pair: &Pair| !pair.contacts.is_empty();
        let near = self.pairs.iter().filter(|((a, b), pair)| (*a == place || *b == place) && touches(pair));
        let joined = self.joints.iter().filter(|joined| joined.has(place));
        let others: Vec<usize> =
            near.flat_map(|(&(a, b), _)| [a, b]).chain(joined.flat_map(|joined| joined.bodies)).collect();
        for other in others {
            self.wake_place(other);
        }
        self.pairs.retain(|&(a, b), _| a != place && b != place);
        self.neighbors.forget(place);
        self.bodies[place].renew(self.time);
    }

    /// Puts another body at a place, if it intersects none that it meets; else everything is as before.
    pub(crate) fn replace(&mut self, place: usize, body: RigidBody) -> Result<(), SimulationError> {
        let before = core::mem::replace(&mut self.bodies[place], body);
        if let Err(error) = self.check_place(place) {
            self.bodies[place] = before;
            return Err(error);
        }
        let moved = before.center - self.bodies[place].center;
        for joined in &mut self.joints {
            joined.center_moved(place, -moved);
        }
        self.drop_known(place);
        self.unchecked.insert(place);
        Ok(())
    }

    /// Wakes the body of a place if it sleeps, and counts its quiet time anew.
    pub(crate) fn wake_place(&mut self, place: usize) {
        let body = &mut self.bodies[place];
        body.wake(self.time);
        body.quiet = Quiet::default();
    }
}
