//! The engine's answers proven again, and lies that are not.
#![cfg(feature = "verify")]

use d2m::bvh::{Evidence, StartState};
use d2m::verify::{Reason, Verdict, Verifier};
use d2m::{
    Contact, MeshTree, Mode, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact,
};
use d2m_testing::{Draw, KnuthRandom, SmallScene, Surface};

const STEPS: u64 = 100_000;

fn mesh(surface: &Surface) -> TriMesh {
    surface.clone().into_mesh(TriMesh::try_new)
}

/// A scene with the engine's answer.
struct Answered {
    scene: SmallScene,
    trees: [MeshTree; 2],
    verifier: Verifier,
    window: Window,
    options: QueryOptions,
    answer: TimeOfContact,
}

impl Answered {
    fn draw(index: u64) -> Self {
        let scene = SmallScene::draw(7, index, |surface| MeshTree::new(mesh(surface)).is_watertight());
        let trees = [0, 1].map(|k| MeshTree::new(mesh(&scene.surfaces[k])));
        let verifier = Verifier::try_new(trees[0].mesh(), trees[1].mesh()).unwrap();
        let window = Window::try_new(scene.window[0], scene.window[1]).unwrap();
        let mode = if index % 4 == 3 { Mode::Capoeira } else { Mode::Accurate };
        let separation = if index % 3 == 2 { 0.0625 } else { 0.0 };
        let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
        let options =
            QueryOptions::default().with_mode(mode).with_min_separation(separation).with_solid(solid);
        let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
        let answer = time_of_contact(bodies[0], bodies[1], window, &options).unwrap();
        Self { scene, trees, verifier, window, options, answer }
    }

    fn verdict(&self, answer: &TimeOfContact) -> Verdict {
        let bodies = [0, 1].map(|k| Moving::new(&self.trees[k], &self.scene.motions[k]));
        self.verifier.time_of_contact(&bodies, self.window, &self.options, answer, STEPS)
    }
}

const SCENES: u64 = 1500;

/// Hard small scenes: grazing, coplanar sliding, needles, fast spin, contacts at either end.
#[test]
fn answers_of_hard_scenes_are_proven_again() {
    let (mut verified, mut open) = (0, Vec::new());
    for index in 0..SCENES {
        let answered = Answered::draw(index);
        match answered.verdict(&answered.answer) {
            Verdict::Verified { .. } => verified += 1,
            Verdict::Refuted { time, triangles, distance } => panic!(
                "{}: refuted at {time}, {triangles:?}, {distance}: {:?}",
                answered.scene.name, answered.answer
            ),
            Verdict::Unproven { reason, .. } => open.push((answered.scene.name, reason, answered.answer)),
        }
    }
    let show =
        |(name, reason, answer): &(String, Reason, TimeOfContact)| format!("{name}: {reason}: {answer:?}");
    let shown: Vec<String> = open.iter().map(show).collect();
    assert!(verified as f64 > 0.995 * SCENES as f64, "{verified}\n{}", shown.join("\n"));
}

/// A time that is later, "separated" for a contact, another separation, other triangles, another tolerance, another start.
#[test]
fn lies_are_not_verified() {
    let mut random = KnuthRandom(5);
    let (mut lies, mut refuted) = (0, 0);
    for index in 0..SCENES {
        let answered = Answered::draw(index);
        let TimeOfContact::Contact(contact) = answered.answer else { continue };
        let mut told = vec![("separated", TimeOfContact::Separated)];
        let mut edited = |name, edit: &dyn Fn(&mut Contact)| {
            let mut lie = contact;
            edit(&mut lie);
            told.push((name, TimeOfContact::Contact(lie)));
        };
        let apart = contact.start == StartState::Apart;
        if apart {
            for exponent in [-9, -6, -3] {
                let later = contact.time_lo + 10f64.powi(exponent) * (1.0 + random.signed().abs());
                // Grazing so slowly that the bodies are as far apart then would be no lie.
                if contact.closing_speed * (later - contact.time_lo) > contact.tolerance {
                    edited("later", &|lie| (lie.time_lo, lie.time_hi) = (later, lie.time_hi.max(later)));
                }
            }
        }
        if contact.start != StartState::Contained {
            for factor in [0.5, 2.0] {
                let separation = contact.separation * factor + f64::from(u8::from(contact.separation == 0.0));
                edited("separation", &|lie| lie.separation = separation);
            }
            edited("wide", &|lie| lie.tolerance *= 1e3);
        }
        if apart {
            edited("no such triangle", &|lie| lie.triangle_a = 1 << 20);
            edited("no number", &|lie| lie.time_lo = f64::NAN);
            edited("reversed", &|lie| lie.time_hi = lie.time_lo.next_down());
            edited("before", &|lie| lie.time_lo = answered.window.start() - 1.0);
        }
        for (name, lie) in told {
            let verdict = answered.verdict(&lie);
            lies += 1;
            refuted += u32::from(matches!(verdict, Verdict::Refuted { .. }));
            let is_verified = matches!(verdict, Verdict::Verified { .. });
            // Not a lie: bodies that come within the tolerance of each other and share no point.
            let is_true = name == "separated" && contact.evidence < Evidence::Crossing;
            assert!(!is_verified || is_true, "{name}: {}: {lie:?} for {contact:?}", answered.scene.name);
        }
    }
    assert!(lies > 3000 && refuted > lies / 4, "{lies}, {refuted} refuted");
}
