//! The simulation in time: steps, and the rest to be reported at the end.

use crate::body::rigid_body::RigidBody;
use crate::listener::{ContactListener, Nobody};
use crate::step::Step;
use crate::{Segment, Simulation, SimulationError, StepError, StepReport};

/// The most by which the computed number of steps that have passed may be off.
const ROUNDED: u64 = 2;

impl Simulation {
    /// Advances by one step: to the next multiple of [`SimulationOptions::step`](crate::SimulationOptions::step).
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// let report = simulation.step()?;
    /// assert_eq!((simulation.time(), report.events), (simulation.options().step, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError`]; the segments until then are those of [`Self::finish`]. Where nothing has moved, nothing has
    /// changed, however often it is tried. Else velocities have faded and motors have pushed as in the whole step, and
    /// the next step does without that part.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        self.step_with(&mut Nobody)
    }

    /// As [`Self::step`], and passes each contact's impulse to the listener as it acts.
    ///
    /// # Errors
    /// As [`Self::step`].
    ///
    /// ```
    /// # use d2m_dynamics::{Body, ContactImpulse, Kind, Simulation, SimulationOptions};
    /// # use glam::DVec3;
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// # let mut simulation = Simulation::new(SimulationOptions::default())?;
    /// # let floor = Body::new("floor", Arc::clone(&cube)).with_kind(Kind::Static);
    /// # let floor = simulation.add(&floor)?;
    /// let falling = simulation.add(&Body::new("falling", cube).with_position(DVec3::Y * 1.2))?;
    /// let mut first = None;
    /// while simulation.time() < 0.5 {
    ///     simulation.step_with(&mut |contact: &ContactImpulse| {
    ///         assert_eq!((contact.a, contact.b), (floor, falling));
    ///         first.get_or_insert(contact.time);
    ///     })?;
    /// }
    /// // Steps of 10 ms: the velocity of each is that of its middle.
    /// assert!(first.is_some_and(|time| (time - (2.0 * 0.199 / 9.81f64).sqrt()).abs() < 0.01));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_with(&mut self, listener: &mut dyn ContactListener) -> Result<StepReport, StepError> {
        let (step, time) = (self.options.step, self.time);
        // A quotient is off by a rounding, so by less than two steps where their times differ.
        let passed = ((time / step) as u64).saturating_sub(ROUNDED);
        let first = passed.max(self.steps.saturating_add(1));
        let steps = (first..=first.saturating_add(4 * ROUNDED)).find(|&steps| steps as f64 * step > time);
        // Where they do not differ, no end is after the present time.
        let steps = steps.unwrap_or(first);
        let report = self.step_to_with(steps as f64 * self.options.step, listener)?;
        self.steps = steps;
        Ok(report)
    }

    /// Advances to a time, as one step of any length.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// simulation.apply_impulse(body, DVec3::X * 1000.0, DVec3::ZERO)?;
    /// simulation.step_to(0.02)?;
    /// assert!((simulation.position(body).x - 0.02).abs() < 1e-12 && simulation.time() == 0.02);
    /// assert!(simulation.step_to(0.01).is_err(), "time does not go back");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::step`]; also an end that is not after the present time. A motion of a kinematic body that does not cover the
    /// whole step is refused before anything moves.
    pub fn step_to(&mut self, end: f64) -> Result<StepReport, StepError> {
        self.step_to_with(end, &mut Nobody)
    }

    /// As [`Self::step_to`], and passes each contact's impulse to the listener as it acts.
    ///
    /// # Errors
    /// As [`Self::step_to`].
    pub fn step_to_with(
        &mut self,
        end: f64,
        listener: &mut dyn ContactListener,
    ) -> Result<StepReport, StepError> {
        if !(end.is_finite() && end > self.time) {
            let wanted = "after the present time";
            return Err(SimulationError::BadOption { name: "end of the step", value: end, wanted }.into());
        }
        // Where all sleep nothing can move, nor can a step fail before it does.
        let may_move = !self.unchecked.is_empty() || self.bodies.iter().any(RigidBody::is_awake);
        let before = may_move.then(|| self.as_it_is());
        if let Err(error) = self.check_start() {
            if let Some(before) = before {
                *self = before;
            }
            return Err(error);
        }
        Step::new(self, end, listener).run(before)
    }

    /// A copy that goes on with the same bits. Neighbors are not copied: they follow from the flights.
    fn as_it_is(&mut self) -> Self {
        let neighbors = core::mem::take(&mut self.neighbors);
        let copy = self.clone();
        self.neighbors = neighbors;
        copy
    }

    /// The segments that are not reported yet, at the end of a run.
    ///
    /// ```
    /// # use std::sync::Arc;
    /// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
    /// use d2m_dynamics::{Body, Simulation, SimulationOptions};
    /// use glam::DVec3;
    /// let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO))?;
    /// let body = simulation.add(&Body::new("body", cube))?; // 1000 kilograms
    /// let reported = simulation.step()?.segments.len();
    /// let last = simulation.finish();
    /// assert!(reported + last.len() >= 1 && last.last().is_some_and(|segment| segment.end == simulation.time()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn finish(&mut self) -> Vec<Segment> {
        self.recorder.finish()
    }
}
