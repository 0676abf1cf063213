//! Runs at even times: small files to look at.

use d2m::motion::ConstantTwist;
use d2m_dynamics::{BodyId, Segment};

/// Turns the segments of a run into segments of equal length, each with all bodies as they are at its start. What happens in
/// between is left out, so these prove nothing.
pub(crate) struct Thinner {
    every: f64,
    /// The start of the run, and how many segments have begun since.
    origin: Option<f64>,
    begun: u32,
    motions: Vec<(BodyId, ConstantTwist)>,
    /// The segment that is not complete yet.
    open: Option<Segment>,
}

impl Thinner {
    pub(crate) const fn new(every: f64) -> Self {
        Self { every, origin: None, begun: 0, motions: Vec::new(), open: None }
    }

    /// Takes the next segments of the run; the complete ones.
    pub(crate) fn add(&mut self, segments: &[Segment]) -> Vec<Segment> {
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
                let start = origin + f64::from(self.begun) * self.every;
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
            }
            if let Some(open) = &mut self.open {
                open.skipped += segment.skipped;
                open.end = segment.end;
            }
        }
        done
    }

    /// The last segment.
    pub(crate) fn finish(&mut self) -> Option<Segment> {
        self.open.take()
    }
}
