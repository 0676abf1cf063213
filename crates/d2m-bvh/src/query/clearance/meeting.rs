//! Are bodies that come within the tolerance of each other proven to share a point?

use super::Descent;
use crate::Contact;
use crate::query::at_start::meeting_at;
use d2m_mesh::at_rest::Meeting;

/// Parts of what is left of the window after a contact, each half of the one before, after which the bodies are looked at: those that go
/// on into each other are found at the first one, those that part again soon at one of the last.
const LOOKS: i32 = 16;

impl Descent<'_> {
    /// Do they at the times of this contact, or at one of a few times later?
    pub(super) fn share_a_point_from(&mut self, contact: &Contact) -> bool {
        let (from, end) = (contact.time_hi, self.sampler.window.end());
        let later = (0..LOOKS).map(|k| (from + (end - from) * 0.5_f64.powi(k)).min(end));
        [contact.time_lo, from].into_iter().chain(later).any(|time| self.share_a_point_at(time))
    }

    fn share_a_point_at(&mut self, time: f64) -> bool {
        let bodies = self.sampler.bodies;
        let solids = bodies.map(|body| body.solid.unwrap_or(self.options.solid));
        // Each look has the patience that a start has, as far as the budget goes.
        match meeting_at(&bodies, solids, time, &mut self.meter) {
            Ok(Some(Meeting::Overlapping(_) | Meeting::Holding(_))) => true,
            // Parting says that no more than some roundings are between them. Those are a distance, unless it is that of placing them.
            Ok(Some(Meeting::Touching(touch))) => {
                self.sampler.pair_at(touch.triangles, time).is_of_rounding()
            }
            _ => false,
        }
    }
}
