//! The impulses of a step, as they are reported and heard.

use super::Step;
use crate::ContactImpulse;
use glam::DVec3;

impl Step<'_> {
    /// Reports the impulses of the present instant, as those of the segment that ends here.
    pub(super) fn report_impulses(&mut self) {
        let [first, last] = [&mut self.impulses, &mut self.undoable].map(core::mem::take);
        let impulses = || first.iter().chain(&last);
        for contact in impulses().filter(|contact| contact.row.is_some_and(|row| row.is_motor)) {
            if let Some(number) = contact.joint() {
                *self.spent.entry(number).or_default() += contact.impulse;
            }
        }
        let mut heard = Vec::new();
        for contact in impulses().filter(|contact| contact.row.is_none()) {
            let impulse = contact.total();
            if impulse != DVec3::ZERO {
                let impulse = ContactImpulse {
                    a: self.sim.bodies[contact.a].id,
                    b: self.sim.bodies[contact.b].id,
                    point: contact.point,
                    normal: contact.normal,
                    impulse: -impulse,
                    time: self.sim.time,
                };
                self.sim.recorder.contact(impulse);
                let pressed = self.pressed.entry((contact.a, contact.b)).or_default();
                for (on, pressed) in pressed.iter_mut().enumerate() {
                    *pressed = *pressed + contact.exerted(on);
                }
                self.sim.begin_touch((contact.a, contact.b), impulse.time);
                heard.push(impulse);
            }
        }
        self.unheard.append(&mut heard);
        if self.sim.time > self.start {
            self.tell();
        }
    }

    /// Tells the listener of impulses. It hears those of the start of a step once something has moved: where
    /// nothing does they have not acted.
    pub(super) fn tell(&mut self) {
        for impulse in core::mem::take(&mut self.unheard) {
            self.listener.contact(&impulse);
        }
    }

    /// A motor has its largest force for the time that is flown. Where the step ends early it owes the impulse
    /// that it had beyond that: it begins the next step with it.
    pub(super) fn settle_motors(&mut self, time: f64) {
        let flown = time - self.start;
        for (number, joined) in self.sim.joints.iter_mut().enumerate() {
            let spent = self.spent.get(&number).copied().filter(|_| time < self.end);
            joined.owed = match (joined.joint.motor, spent) {
                (Some(motor), Some(spent)) => {
                    let most = motor.most * flown;
                    spent - spent.max(-most).min(most)
                }
                _ => 0.0,
            };
        }
    }
}
