//! Runs at even times: small files to look at.

use d2m::motion::ConstantTwist;
use d2m_dynamics::{BodyId, Segment};

/// Segments that are handed on at once: of a step that is longer than they are there may be more than memory holds.
const MOST_AT_ONCE: usize = 1024;

/// Turns the segments of a run into segments of equal length, each with all bodies as they are at its start. What happens in
/// between is left out, so these prove nothing.
pub(crate) struct Thinner {
    every: f64,
    /// The start of the run, and how many segments have begun since.
    origin: Option<f64>,
    begun: u64,
    motions: Vec<(BodyId, ConstantTwist)>,
    /// The segment that is not complete yet.
    open: Option<Segment>,
}

impl Thinner {
    pub(crate) const fn new(every: f64) -> Self {
        Self { every, origin: None, begun: 0, motions: Vec::new(), open: None }
    }

    /// Takes the next segments of the run; hands on those that are complete.
    ///
    /// # Errors
    /// Those of what takes them.
    pub(crate) fn add<E>(
        &mut self,
        segments: &[Segment],
        mut take: impl FnMut(&[Segment]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut done = Vec::new();
        for segment in segments {
            let origin = *self.origin.get_or_insert(segment.start);
            for &(id, motion) in &segment.changed {
                match self.motions.iter_mut().find(|(known, _)| *known == id) {
                    Some(known) => known.1 = motion,
                    None => self.motions.push((id, motion)),
                }
            }
            loop {
                let start = origin + self.begun as f64 * self.every;
                if start >= segment.end {
                    break;
                }
                self.begun += 1;
                let mut next = segment.clone();
                (next.start, next.end, next.skipped) = (start, start, 0.0);
                next.changed = self.motions.iter().map(|&(id, motion)| (id, motion.rebase(start))).collect();
                next.contacts.clear();
                if let Some(mut open) = self.open.replace(next) {
                    open.end = start;
                    done.push(open);
                }
                if done.len() >= MOST_AT_ONCE {
                    take(&done)?;
                    done.clear();
                }
            }
            if let Some(open) = &mut self.open {
                open.skipped += segment.skipped;
                open.end = segment.end;
            }
        }
        take(&done)
    }

    /// The last segment.
    pub(crate) fn finish(&mut self) -> Option<Segment> {
        self.open.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_dynamics::{Body, Simulation, SimulationOptions};
    use std::sync::Arc;

    /// However short segments are, no more than some of them are held at once.
    #[test]
    fn short_segments_are_handed_on_in_parts() {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let cube = Arc::new(d2m::MeshTree::new(d2m::shapes::mesh("box").unwrap()));
        simulation.add(&Body::new("cube", cube)).unwrap();
        simulation.step().unwrap();
        let run = simulation.finish();
        let (mut thinner, mut ends) = (Thinner::new(0.01 / 8192.0), Vec::new());
        let taken: Result<(), ()> = thinner.add(&run, |done| {
            assert!(done.len() <= MOST_AT_ONCE);
            ends.extend(done.iter().map(|segment| segment.end));
            Ok(())
        });
        taken.unwrap();
        assert_eq!((ends.len(), ends.last().copied()), (8191, Some(8191.0 * (0.01 / 8192.0))));
    }
}
