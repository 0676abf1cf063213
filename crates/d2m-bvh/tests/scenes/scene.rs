//! Two bodies with what is known of their first contact, and answers held against that.

use d2m_bvh::{Contact, Solid, StartState, TimeOfContact, TriMesh, Window};
use d2m_feature::FeaturePair;
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// What is known about the answer.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Expected {
    /// No contact in the window.
    Separated,
    /// The first contact, with the slack that the truth itself needs (0 where it is exact).
    At { time: f64, slack: f64, normal: Option<DVec3>, kind: Option<Kind> },
    /// The bodies meet at the start.
    Start(StartState),
}

/// Kinds of feature pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    VertexFace,
    FaceVertex,
    EdgeEdge,
}

/// Two bodies, their motions, and what is known of their first contact.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) meshes: [TriMesh; 2],
    pub(crate) motions: [ConstantTwist; 2],
    pub(crate) window: Window,
    pub(crate) solid: Solid,
    pub(crate) expected: Expected,
}

impl Scene {
    pub(super) fn new(
        name: &'static str,
        a: TriMesh,
        b: TriMesh,
        motion_a: ConstantTwist,
        expected: Expected,
    ) -> Self {
        let motions = [motion_a, ConstantTwist::REST];
        Self { name, meshes: [a, b], motions, window: Window::UNIT, solid: Solid::Filled, expected }
    }

    /// The same with bodies exchanged.
    pub(crate) fn exchanged(&self) -> Self {
        let mut other = self.clone();
        other.meshes.reverse();
        other.motions.reverse();
        if let Expected::At { normal, kind, .. } = &mut other.expected {
            *normal = normal.map(|n| -n);
            *kind = kind.map(|k| match k {
                Kind::VertexFace => Kind::FaceVertex,
                Kind::FaceVertex => Kind::VertexFace,
                Kind::EdgeEdge => Kind::EdgeEdge,
            });
        }
        other
    }

    /// The same, everything moved by `offset` and drifting with `velocity`: the answer stays.
    pub(crate) fn carried(&self, offset: DVec3, velocity: DVec3) -> Self {
        let mut other = self.clone();
        for m in &mut other.motions {
            *m = m.with_position(m.position() + offset).with_linear_velocity(m.linear_velocity() + velocity);
        }
        other
    }

    /// Checks an answer to this scene.
    ///
    /// # Panics
    /// If the answer breaks a promise.
    pub(crate) fn check(&self, answer: &TimeOfContact, tolerance: f64) {
        let name = self.name;
        match (self.expected, answer) {
            (Expected::Separated, TimeOfContact::Separated) => {}
            (Expected::Start(state), TimeOfContact::Contact(c)) => {
                assert_eq!(c.start, state, "{name}: {c:?}");
                assert_eq!(c.time_lo, self.window.start(), "{name}");
            }
            (Expected::At { time, slack, normal, kind }, TimeOfContact::Contact(c)) => {
                assert!(c.time_lo <= time + slack, "{name}: late, {:e} after {time}", c.time_lo - time);
                check_separation(name, c, tolerance);
                let early = (time - c.time_lo) * c.closing_speed;
                assert!(
                    early <= 3.4 * c.tolerance.max(tolerance) + slack * c.closing_speed.abs() + 1e-14,
                    "{name}: early by {early:e}: {c:?}"
                );
                assert_eq!(c.start, StartState::Apart, "{name}");
                if let Some(n) = normal {
                    assert!(c.normal.dot(n) > 1.0 - 1e-9, "{name}: normal {} for {n}", c.normal);
                }
                if let Some(kind) = kind {
                    assert_eq!(kind_of(&c.feature), kind, "{name}: {c:?}");
                }
                self.check_witnesses(c);
            }
            (expected, answer) => panic!("{name}: expected {expected:?}, got {answer:?}"),
        }
    }

    /// Witness points are on their triangles, the separation apart, along the normal.
    fn check_witnesses(&self, c: &Contact) {
        use d2m_motion::RigidMotion;
        let sides = [(c.triangle_a, c.barycentric_a, c.point_a), (c.triangle_b, c.barycentric_b, c.point_b)];
        for (body, (triangle, weights, point)) in sides.into_iter().enumerate() {
            let (pose, _) = self.motions[body].pose_and_twist(c.time_lo);
            let corners = self.meshes[body].corners(triangle as usize);
            let sum: DVec3 = (0..3).map(|i| corners[i] * weights[i]).sum();
            let size = point.abs().max_element()
                + corners.iter().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
            let off = (pose.transform_point(sum) - point).length();
            assert!(off <= 1e-13 * (1.0 + size), "{}: witness {off:e} off its triangle", self.name);
            assert!(weights.iter().all(|w| (-1e-12..=1.0 + 1e-12).contains(w)), "{}: {weights:?}", self.name);
        }
        let size = c.point_a.abs().max_element() + 1.0;
        let gap = (c.point_b - c.point_a).dot(c.normal);
        assert!(
            (gap - c.separation).abs() <= 1e-15 * 64.0 * size + 0.5 * c.separation,
            "{}: {gap:e} {:e}",
            self.name,
            c.separation
        );
    }
}

fn check_separation(name: &str, c: &Contact, tolerance: f64) {
    let used = c.tolerance.max(tolerance);
    assert!(
        c.separation > 0.0 && c.separation <= 3.3 * used,
        "{name}: separation {:e} of {used:e}",
        c.separation
    );
    assert!(c.time_hi >= c.time_lo, "{name}");
}

fn kind_of(f: &FeaturePair) -> Kind {
    match f {
        FeaturePair::VertexFace { .. } => Kind::VertexFace,
        FeaturePair::FaceVertex { .. } => Kind::FaceVertex,
        FeaturePair::EdgeEdge { .. } => Kind::EdgeEdge,
    }
}
