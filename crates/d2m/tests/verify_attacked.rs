//! Lies that were proven: found by an adversary. Each is an edit of an honest answer, which is proven.
#![cfg(feature = "verify")]

use d2m::bvh::ClearanceStatus;
use d2m::verify::{Verdict, Verifier};
use d2m::{
    Clearance, ClearanceOptions, ConstantTwist, ContactSpan, Keyframes, MeshTree, Moving, Pose, QueryOptions,
    RigidMotion, Span, SpanStatus, TriMesh, Window, clearance, contact_spans,
};
use glam::DVec3;

const STEPS: u64 = 1 << 20;

fn tetrahedron() -> MeshTree {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap())
}

fn along_x(from: f64, speed: f64) -> ConstantTwist {
    ConstantTwist::REST.with_position(DVec3::X * from).with_linear_velocity(DVec3::X * speed)
}

struct Pair<'a> {
    tree: &'a MeshTree,
    motion: &'a dyn RigidMotion,
}

impl Pair<'_> {
    fn bodies(&self) -> [Moving<'_>; 2] {
        [Moving::new(self.tree, &ConstantTwist::REST), Moving::new(self.tree, self.motion)]
    }

    fn verifier(&self) -> Verifier {
        Verifier::try_new(self.tree.mesh(), self.tree.mesh()).unwrap()
    }

    fn is_proven(&self, spans: &[ContactSpan]) -> bool {
        let options = QueryOptions::default();
        let verdict =
            self.verifier().contact_spans(&self.bodies(), Window::UNIT, &options, None, spans, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }

    fn spans(&self) -> Vec<ContactSpan> {
        let [a, b] = self.bodies();
        contact_spans(a, b, Window::UNIT, &QueryOptions::default(), None).unwrap()
    }

    fn clearance(&self) -> Clearance {
        let [a, b] = self.bodies();
        clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap()
    }

    /// Of an answer whose accuracy nobody asked for.
    fn is_clearance(&self, answer: &Clearance) -> bool {
        let options = ClearanceOptions::default().with_accuracy(f64::INFINITY);
        let verdict = self.verifier().clearance(&self.bodies(), Window::UNIT, &options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }
}

/// Bodies that part for a moment, at no round time: a claim that they are in contact all the time.
#[test]
fn a_moment_in_which_bodies_are_clear_is_found_in_a_long_span_of_contact() {
    let tree = tetrahedron();
    // The tip at x = 1 comes out of the other one's face at x = 0 by 2e-4, and goes in again.
    let aside = DVec3::new(0.0, -0.1, -0.05);
    let at = |time: f64, x: f64| (time, Pose { translation: aside + DVec3::X * x, ..Pose::IDENTITY });
    let (middle, gap) = (0.4987, 2e-4);
    let ends = [at(0.0, 1.0 + gap - middle), at(middle, 1.0 + gap), at(1.0, gap + middle)];
    let bounces = Keyframes::try_new(&ends, Span::Linear).unwrap();
    let pair = Pair { tree: &tree, motion: &bounces };
    let spans = pair.spans();
    assert_eq!(spans.len(), 3, "{spans:?}");
    assert!(spans[1].status == SpanStatus::Clear && pair.is_proven(&spans));
    let mut all = spans[0];
    all.to = spans[2].to;
    assert!(!pair.is_proven(&[all]));
}

#[test]
fn spans_of_contact_in_which_bodies_are_clear_are_not_proven() {
    let tree = tetrahedron();
    // To the side, so that no faces stay in one plane.
    let aside = DVec3::new(3.0, 0.1, 0.05);
    let (apart, through) = (along_x(5.0, 1.0), along_x(3.0, -6.0).with_position(aside));
    let [apart, through] = [&apart, &through].map(|motion| Pair { tree: &tree, motion });
    let (clear, met) = (apart.spans(), through.spans());
    assert!(apart.is_proven(&clear) && through.is_proven(&met));
    let [first, second, third] = met.as_slice() else { panic!("{met:?}") };
    assert_eq!(second.status, SpanStatus::Contact);
    let contact = |from: f64, to: f64| {
        let mut span = *second;
        (span.from, span.to) = (from, to);
        span
    };
    assert!(!apart.is_proven(&[contact(0.0, 1.0)]));
    for lie in
        [vec![contact(0.0, 1.0)], vec![*first, contact(first.to, 1.0)], vec![contact(0.0, second.to), *third]]
    {
        assert!(!through.is_proven(&lie), "{lie:?}");
    }
}

#[test]
fn contact_before_bodies_meet_and_of_bodies_that_never_do_is_not_proven() {
    let tree = tetrahedron();
    let (apart, through) = (along_x(5.0, 1.0), along_x(3.0, -6.0));
    let [apart, through] = [&apart, &through].map(|motion| Pair { tree: &tree, motion });
    let honest = apart.clearance();
    assert!(apart.is_clearance(&honest) && honest.upper > 3.0);
    let mut lie = honest;
    lie.status = ClearanceStatus::Contact;
    assert!(!apart.is_clearance(&lie));
    lie.lower = 0.0;
    assert!(!apart.is_clearance(&lie));
    // True bounds, and yet not those of its points.
    let mut lie = honest;
    lie.upper = 100.0;
    assert!(!apart.is_clearance(&lie));
    let honest = through.clearance();
    assert!(through.is_clearance(&honest) && honest.status == ClearanceStatus::Contact, "{honest:?}");
    for time in [0.0, 0.125, 0.25] {
        // The triangles meet later.
        let mut lie = honest;
        (lie.time, lie.lower, lie.upper) = (time, 0.0, 0.0);
        assert!(!through.is_clearance(&lie), "{time}");
    }
}
