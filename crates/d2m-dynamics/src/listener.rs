//! Listeners, which get the impulses of contacts while a step is computed.

use crate::ContactImpulse;

/// Receives the impulse at each contact, in the order of time: those of events when they happen, those of
/// resting contacts when their flights begin. Closures that take a [`ContactImpulse`] are listeners.
///
/// A listener that panics ends the step as an error does, before the panic goes on: the simulation can be used again.
///
/// The report of the same step holds the bodies' next flights. The impulses in its segments are the same
/// ones; those of the last instant follow one step later.
///
/// ```
/// use d2m_bvh::MeshTree;
/// use d2m_dynamics::{Body, ContactImpulse, ContactListener, Simulation, SimulationOptions};
/// use glam::DVec3;
/// use std::sync::Arc;
///
/// /// Counts hits that are hard enough to be heard.
/// #[derive(Default)]
/// struct Sounds {
///     played: Vec<(f64, f64)>,
/// }
///
/// impl ContactListener for Sounds {
///     fn contact(&mut self, contact: &ContactImpulse) {
///         let strength = contact.impulse.length();
///         if strength > 1.0 {
///             self.played.push((contact.time, strength));
///         }
///     }
/// }
///
/// let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
/// let one = Body::new("one", cube).with_restitution(1.0);
/// let two = one.clone().with_position(DVec3::X * 2.0);
/// let one = simulation.add(&one.with_linear_velocity(DVec3::X * 2.0))?;
/// let two = simulation.add(&two)?;
/// let mut sounds = Sounds::default();
/// while simulation.time() < 1.0 {
///     simulation.step_with(&mut sounds)?;
/// }
/// // They were 1 apart, less at most the gap of 1 mm, at 2 m/s; the cubes weigh 1000 kg and exchange their velocities.
/// let time = sounds.played[0].0;
/// assert!(0.499 < time && time < 0.5);
/// assert!(sounds.played.iter().all(|hit| hit.0 == time));
/// let impulse: f64 = sounds.played.iter().map(|hit| hit.1).sum();
/// assert!((impulse - 2000.0).abs() < 1e-6);
/// # let _ = (one, two);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait ContactListener {
    /// An impulse has acted, with its bodies, place, normal and time.
    fn contact(&mut self, contact: &ContactImpulse);
}

impl<F: FnMut(&ContactImpulse)> ContactListener for F {
    fn contact(&mut self, contact: &ContactImpulse) {
        self(contact);
    }
}

/// The listener that ignores everything.
pub(crate) struct Nobody;

impl ContactListener for Nobody {
    fn contact(&mut self, _: &ContactImpulse) {}
}
