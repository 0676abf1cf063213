//! Warm start: the impulses that the contacts of a pair inherit from those before them.

use d2m_contact::ContactPoint;
use glam::DVec3;

/// Rounds over the contacts of a pair. More follow as long as each leaves less than the part [`GAINED`] of
/// the square of what was missing, which is so where no friction cone limits the impulses.
const ROUNDS: u32 = 12;
const GAINED: f64 = 0.9;
/// The part of a push that may be missing: under twenty others a body is pushed off by less than quiet bodies
/// move.
const ENOUGH: f64 = 1.0 / (1u64 << 19) as f64;

/// Contacts of the same features inherit their impulses. Those of features that are gone go to the nearest
/// contacts, new ones first: where faces slide along each other vertices leave and edges cross, but the load
/// stays. Then all contacts share the impulses out, so that together they push and turn as those before. Of
/// two faces now these features are the contacts and now others, and a body that is pushed elsewhere than
/// before has to be solved anew.
pub(crate) fn inherit(contacts: &mut [ContactPoint], old: &[ContactPoint]) {
    let mut is_new = vec![true; contacts.len()];
    let mut gone = Vec::new();
    for before in old {
        match contacts.iter().position(|contact| contact.feature == before.feature) {
            Some(place) => {
                add_to(&mut contacts[place], before.total());
                is_new[place] = false;
            }
            None if before.impulse > 0.0 => gone.push(before),
            None => {}
        }
    }
    for before in gone {
        let far = |k: &usize| (contacts[*k].arm_a - before.arm_a).length_squared();
        let nearest = |among: &mut dyn Iterator<Item = usize>| among.min_by(|i, j| far(i).total_cmp(&far(j)));
        let found = nearest(&mut (0..contacts.len()).filter(|&k| is_new[k]))
            .or_else(|| nearest(&mut (0..contacts.len())));
        if let Some(place) = found {
            add_to(&mut contacts[place], before.total());
            is_new[place] = false;
        }
    }
    share_out(contacts, old);
}

fn add_to(contact: &mut ContactPoint, impulse: DVec3) {
    contact.impulse += impulse.dot(contact.normal).max(0.0);
    // The normal has turned a little: without friction an impulse along it must not act along the tangents.
    if contact.material.friction > 0.0 {
        let [t, u] = contact.tangents;
        contact.sliding = [contact.sliding[0] + impulse.dot(t), contact.sliding[1] + impulse.dot(u)];
    }
}

/// The sum of some impulses at arms, and their moment about a point.
#[derive(Clone, Copy)]
struct Wrench {
    push: DVec3,
    turn: DVec3,
}

impl Wrench {
    fn of(contacts: &[ContactPoint], about: DVec3) -> Self {
        let none = Self { push: DVec3::ZERO, turn: DVec3::ZERO };
        contacts.iter().fold(none, |sum, contact| {
            let push = contact.total();
            Self { push: sum.push + push, turn: sum.turn + (contact.arm_a - about).cross(push) }
        })
    }
}

/// Changes the impulses so that their sums come nearer to those before: each contact in turn takes what is
/// missing along its own directions, as far as the law of friction allows.
///
/// ```text
/// least   |Σ λᵢ − p|² + |Σ rᵢ × λᵢ − m|² / ρ²      λᵢ in Coulomb's cone
/// ```
///
/// p and m: push and moment before, about the middle of the contacts; rᵢ: from there; ρ: the distance of the
/// contacts from the center of one of the bodies, in the quadratic mean. (Their distance from their middle is
/// no measure: contacts that are close together would push against each other.)
fn share_out(contacts: &mut [ContactPoint], old: &[ContactPoint]) {
    if contacts.len() < 2 || old.iter().all(|before| before.impulse == 0.0) {
        return;
    }
    let count = contacts.len() as f64;
    let about = contacts.iter().map(|contact| contact.arm_a).sum::<DVec3>() / count;
    let square_of = |arm: fn(&ContactPoint) -> DVec3| {
        contacts.iter().map(|contact| arm(contact).length_squared()).sum::<f64>() / count
    };
    let far = square_of(|contact| contact.arm_a).min(square_of(|contact| contact.arm_b));
    let weight = if far > 0.0 { 1.0 / far } else { 0.0 };
    let (before, now) = (Wrench::of(old, about), Wrench::of(contacts, about));
    let mut missing = Wrench { push: before.push - now.push, turn: before.turn - now.turn };
    let square = |w: &Wrench| w.push.length_squared() + w.turn.length_squared() * weight;
    let (enough, mut last) = (ENOUGH * ENOUGH * square(&before), f64::INFINITY);
    for round in 0.. {
        let left = square(&missing);
        if left <= enough || round >= ROUNDS && left > GAINED * last {
            return;
        }
        last = left;
        for contact in contacts.iter_mut() {
            let arm = contact.arm_a - about;
            let wanted = |along: DVec3, missing: &Wrench| {
                let turn = arm.cross(along);
                let wanted = along.dot(missing.push) + turn.dot(missing.turn) * weight;
                wanted / (1.0 + turn.length_squared() * weight)
            };
            let own = contact.total();
            contact.impulse = (contact.impulse + wanted(contact.normal, &missing)).max(0.0);
            if contact.material.friction > 0.0 {
                let [t, u] = contact.tangents.map(|tangent| wanted(tangent, &missing));
                let slides = [contact.sliding[0] + t, contact.sliding[1] + u];
                let length = (slides[0] * slides[0] + slides[1] * slides[1]).sqrt();
                let most = contact.material.friction * contact.impulse;
                contact.sliding = slides.map(|x| if length > most { x * (most / length) } else { x });
            }
            let taken = contact.total() - own;
            missing.push -= taken;
            missing.turn -= arm.cross(taken);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::rows::upright;
    use d2m_contact::Material;
    use d2m_feature::FeaturePair;

    /// A contact below a body at this place of its face, half of its width below its center.
    fn at(vertex: u32, x: f64, z: f64, impulse: [f64; 3]) -> ContactPoint {
        let arm = DVec3::new(x, 0.5, z);
        ContactPoint {
            feature: FeaturePair::VertexFace { vertex, face: 0 },
            arm_a: arm,
            arm_b: arm - DVec3::Y,
            point: arm,
            material: Material::new(0.0, 0.5),
            impulse: impulse[0],
            sliding: [impulse[1], impulse[2]],
            ..upright([0, 1])
        }
    }

    fn off(contacts: &[ContactPoint], old: &[ContactPoint]) -> f64 {
        let [one, other] = [contacts, old].map(|contacts| Wrench::of(contacts, DVec3::ZERO));
        ((one.push - other.push).length() + (one.turn - other.turn).length()) / other.push.length()
    }

    /// Four corners bear a body, one most of it; then a corner and the crossings of edges around another one
    /// do.
    #[test]
    fn what_other_features_bear_pushes_and_turns_as_before() {
        let none = [0.0; 3];
        let old = [
            at(0, -0.5, -0.5, [9.0, 1.0, 2.0]),
            at(1, 0.5, -0.5, [2.0, 0.5, 0.0]),
            at(2, 0.5, 0.5, [1.0, 0.0, 0.2]),
            at(3, -0.5, 0.5, [4.0, -1.0, 0.0]),
        ];
        let mut same = old.map(|contact| ContactPoint { impulse: 0.0, sliding: [0.0; 2], ..contact });
        inherit(&mut same, &old);
        assert!((0..4).all(|k| same[k].impulses() == old[k].impulses()), "{same:?}");
        let mut others = [
            at(4, -0.5, -0.4, none),
            at(5, -0.3, -0.5, none),
            at(1, 0.5, -0.5, none),
            at(6, 0.4, 0.5, none),
            at(7, -0.5, 0.3, none),
        ];
        inherit(&mut others, &old);
        assert!(off(&others, &old) < 1e-5, "{others:?}");
        for contact in others {
            let [t, u] = contact.sliding;
            assert!(
                contact.impulse >= 0.0 && t.hypot(u) <= 0.5 * contact.impulse * (1.0 + 1e-12),
                "{contact:?}"
            );
        }
    }

    /// Contacts that are close together cannot turn a body as those did that were far apart: they do not push
    /// harder for it.
    #[test]
    fn contacts_that_are_close_together_do_not_push_against_each_other() {
        let old = [at(0, 0.2, 0.0, [5.0, -0.3, -2.0]), at(1, 0.25, 0.1, [1.0, 0.1, 0.0])];
        let none = [0.0; 3];
        let mut close = [at(2, -0.2, 0.001, none), at(3, -0.201, 0.0, none)];
        inherit(&mut close, &old);
        let load: f64 = close.iter().map(|contact| contact.impulse).sum();
        assert!((3.0..=6.6).contains(&load), "{close:?}");
    }
}
