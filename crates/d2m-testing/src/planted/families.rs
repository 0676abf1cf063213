//! Random feature pairs with a planted contact (or a planted gap), by kind and family.
//!
//! Unit features, relative speed about 4, |ω| ≤ 3, t in [0, 1]. The contact is planted at a known time by placing A
//! so that the features meet there; rounding moves the true time by some 1e-16, which the oracle finds.
use crate::{Draw, Random};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use glam::DVec3;

/// Which features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A point of A and a triangle of B.
    PointTriangle,
    /// An edge of A and an edge of B.
    EdgeEdge,
}

/// How close.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Apart by about their size or more.
    Far,
    /// Passing at a gap of 1e-6 to 1e-2.
    Near,
    /// A clean crossing.
    Hit,
    /// Passing the border of a feature at a gap of ±1e-12 to ±1e-4.
    Graze,
    /// Tangential approach: the plane function nearly has a double root, gap ±1e-12 to ±1e-4.
    Tangent,
    /// A crossing at the very border of a feature.
    Boundary,
    /// |ω| up to 300: many roots of the plane function.
    Fast,
    /// Features of aspect 1e3 to 1e6.
    Needle,
    /// Parallel edges, or motion in the plane of the triangle.
    Coplanar,
    /// Contact at the start or the end of a window away from 0.
    Window,
}

/// All families.
pub const FAMILIES: [Family; 10] = [
    Family::Far,
    Family::Near,
    Family::Hit,
    Family::Graze,
    Family::Tangent,
    Family::Boundary,
    Family::Fast,
    Family::Needle,
    Family::Coplanar,
    Family::Window,
];

/// One query.
#[derive(Debug, Clone)]
pub struct Planted {
    /// Which features.
    pub kind: Kind,
    /// How close.
    pub family: Family,
    /// A's vertices: 1 or 2 of them (the other repeats the first).
    pub a: [DVec3; 2],
    /// B's vertices: 3 or 2 of them (the last repeats the second).
    pub b: [DVec3; 3],
    /// Motion of A.
    pub motion_a: ConstantTwist,
    /// Motion of B.
    pub motion_b: ConstantTwist,
    /// Window.
    pub window: (f64, f64),
    /// Where the contact was planted.
    pub time: f64,
    /// Planted gap (0: contact).
    pub gap: f64,
}

/// One query of a family.
///
/// # Panics
/// Never: all numbers drawn are finite.
pub fn plant(kind: Kind, family: Family, random: &mut Random) -> Planted {
    let fast = if family == Family::Fast { random.between(60.0, 300.0) } else { 3.0 };
    let (w_a, w_b) = match family {
        Family::Fast => (random.direction() * fast, random.ball() * 3.0),
        Family::Coplanar => (DVec3::ZERO, DVec3::ZERO),
        _ => (random.ball() * fast, random.ball() * fast),
    };
    let mut a = [random.ball(), random.ball()];
    let mut b = [random.ball(), random.ball(), random.ball()];
    if kind == Kind::PointTriangle {
        a[1] = a[0];
    } else {
        b[2] = b[1];
    }
    if family == Family::Needle {
        let aspect = random.log_between(1e3, 1e6);
        let along = random.between(0.2, 0.8);
        b[2] = if kind == Kind::PointTriangle {
            b[0] + (b[1] - b[0]) * along + random.ball() / aspect
        } else {
            b[1]
        };
        if kind == Kind::EdgeEdge {
            a[1] = a[0] + (a[1] - a[0]) / aspect;
        }
    }
    let window = match family {
        Family::Window => {
            let start = random.between(-1000.0, 1000.0);
            (start, start + random.log_between(1e-3, 3.0))
        }
        _ => (0.0, 1.0),
    };
    let at_end = match family {
        Family::Window => [0.0, 0.5, 1.0][(random.unit() * 3.0) as usize],
        _ => random.between(0.02, 0.98),
    };
    let time = (window.0 + (window.1 - window.0) * at_end).clamp(window.0, window.1);
    let gap = match family {
        Family::Far => random.between(0.7, 2.0),
        Family::Near => random.log_between(1e-6, 1e-2),
        Family::Graze | Family::Tangent => {
            random.log_between(1e-12, 1e-4) * if random.unit() < 0.5 { 1.0 } else { -1.0 }
        }
        _ => 0.0,
    };
    let motion_b = ConstantTwist::try_new(random.ball(), random.turn(), random.ball(), w_b).expect("finite");
    let mut start_a = ConstantTwist::try_new(DVec3::ZERO, random.turn(), DVec3::ZERO, w_a).expect("finite");
    if family == Family::Coplanar && random.unit() < 0.5 {
        start_a = start_a.with_orientation(motion_b.orientation());
    }

    // Poses at the planted time (A still without its place).
    let (pose_b, twist_b) = motion_b.pose_and_twist(time);
    let (turn_a, _) = start_a.pose_and_twist(time);
    let world_b = b.map(|p| pose_b.transform_point(p));
    let arms = a.map(|p| turn_a.transform_vector(p));
    let inner = |random: &mut Random| {
        if family == Family::Boundary { edge_of(random) } else { random.between(0.05, 0.95) }
    };
    let beside = matches!(family, Family::Near | Family::Graze);
    let (meet, arm, normal, outward) = match kind {
        Kind::PointTriangle => {
            let (mut u, mut v) = (inner(random), inner(random));
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let meet = world_b[0] + (world_b[1] - world_b[0]) * u + (world_b[2] - world_b[0]) * v;
            let normal = (world_b[1] - world_b[0]).cross(world_b[2] - world_b[0]).normalize_or_zero();
            // For a near miss: beside the middle of the first side, in the plane.
            let side = (world_b[1] - world_b[0]).cross(normal).normalize_or_zero();
            let on_side = world_b[0] + (world_b[1] - world_b[0]) * u.clamp(0.1, 0.9);
            (if beside { on_side } else { meet }, arms[0], normal, side)
        }
        Kind::EdgeEdge => {
            let (s, t) = (inner(random), inner(random));
            let meet = world_b[0] + (world_b[1] - world_b[0]) * t;
            let arm = arms[0] + (arms[1] - arms[0]) * s;
            let normal = (arms[1] - arms[0]).cross(world_b[1] - world_b[0]).normalize_or_zero();
            if beside {
                // Beyond the first end of B's edge.
                let outward = (world_b[0] - world_b[1]).normalize_or_zero();
                (world_b[0], arm, normal, outward)
            } else {
                (meet, arm, normal, normal)
            }
        }
    };
    let mut velocity = random.direction() * 4.0;
    let offset = match family {
        Family::Near | Family::Graze => outward * gap,
        Family::Far => normal * gap + outward * gap,
        _ => normal * gap,
    };
    // Relative velocity of the meeting points without A's translation.
    let carried = twist_b.velocity_of(meet - pose_b.translation) - w_a.cross(arm);
    match family {
        Family::Tangent | Family::Coplanar => velocity -= normal * normal.dot(velocity),
        // Not too tangential.
        Family::Hit | Family::Near | Family::Graze | Family::Fast | Family::Window
            if normal.dot(velocity).abs() < 0.5 =>
        {
            velocity += normal * (1.0_f64).copysign(normal.dot(velocity));
        }
        _ => {}
    }
    let v_a = carried + velocity;
    let x_a = meet + offset - arm - v_a * time;
    let motion_a = start_a.with_position(x_a).with_linear_velocity(v_a);
    Planted { kind, family, a, b, motion_a, motion_b, window, time, gap }
}

/// 0, 1 or next to them.
fn edge_of(random: &mut Random) -> f64 {
    let off = if random.unit() < 0.5 { 0.0 } else { random.log_between(1e-16, 1e-6) };
    if random.unit() < 0.5 { off } else { 1.0 - off }
}

impl Planted {
    /// World positions of all vertices at a time, in plain floating point: A's two, B's three.
    pub fn world(&self, time: f64) -> ([DVec3; 2], [DVec3; 3]) {
        let place = |pose: Pose, p: DVec3| pose.transform_point(p);
        let (pose_a, pose_b) = (self.motion_a.pose_and_twist(time).0, self.motion_b.pose_and_twist(time).0);
        (self.a.map(|p| place(pose_a, p)), self.b.map(|p| place(pose_b, p)))
    }

    /// The four paths of the same query with straight vertex paths: start and end points.
    pub fn straight(&self) -> ([DVec3; 4], [DVec3; 4]) {
        let four = |time: f64| {
            let (a, b) = self.world(time);
            match self.kind {
                Kind::PointTriangle => [a[0], b[0], b[1], b[2]],
                Kind::EdgeEdge => [a[0], a[1], b[0], b[1]],
            }
        };
        // Tangents at the planted time, so that the planted contact stays (to second order).
        let (now, step) = (four(self.time), 1e-3);
        let later = four(self.time + step);
        let velocity = [0, 1, 2, 3].map(|i| (later[i] - now[i]) / step);
        let at = |t: f64| [0, 1, 2, 3].map(|i| now[i] + velocity[i] * (t - self.time));
        (at(0.0), at(1.0))
    }
}
