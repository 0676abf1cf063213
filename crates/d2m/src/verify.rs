//! Answers of the engine as claims of [`d2m_verify`], which proves them again and shares no search with it.
//!
//! What an answer promises is a few claims at once, with s the minimum separation and δ the reported tolerance:
//!
//! | answer | claims |
//! |---|---|
//! | `Separated` | further apart than s in all of the window |
//! | `Undecided` | further apart than s until `clear_until` |
//! | `Contact`, apart at the start | further apart than s in [start, `time_lo`] |
//! | … touching or apart | its triangles are `separation` apart at `time_lo`, to δ/16, and at most s + 3.3 δ (unless it stopped early) |
//! | … contained | a body holds a part of the other at the start |
//! | … with evidence | within s (`Crossing`) or s + δ (`Near`) at some time of the bracket |
pub use d2m_verify::*;

use crate::{Contact, Mode, Moving, Pose, QueryOptions, StartState, TimeOfContact, TriMesh, Twist, Window};
use d2m_bvh::{self as bvh, Evidence};
use std::sync::Arc;

/// Steps of a proof, if nothing else is said: some seconds.
pub const DEFAULT_STEPS: u64 = 1 << 22;

/// Two meshes as the verifier keeps them, for any number of answers about them.
///
/// ```
/// use d2m::verify::{DEFAULT_STEPS, Verdict, Verifier};
/// use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact};
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let verifier = Verifier::try_new(&mesh, &mesh)?;
/// let tree = MeshTree::new(mesh);
/// let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(-4.0 * DVec3::Z);
/// let bodies = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let options = QueryOptions::default();
/// let answer = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options)?;
/// let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &answer, DEFAULT_STEPS);
/// assert!(matches!(verdict, Verdict::Verified { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Verifier {
    meshes: [Arc<Mesh>; 2],
}

/// The engine's mesh as the verifier keeps it.
///
/// # Errors
/// [`MeshFault`]: a mesh without triangles.
pub fn mesh(mesh: &TriMesh) -> Result<Mesh, MeshFault> {
    Mesh::try_new(mesh.vertices(), mesh.triangles())
}

impl Verifier {
    /// The meshes of A and B.
    ///
    /// # Errors
    /// [`MeshFault`]: a mesh without triangles.
    pub fn try_new(a: &TriMesh, b: &TriMesh) -> Result<Self, MeshFault> {
        Ok(Self::new([Arc::new(mesh(a)?), Arc::new(mesh(b)?)]))
    }

    /// Of meshes that other verifiers use, too.
    pub const fn new(meshes: [Arc<Mesh>; 2]) -> Self {
        Self { meshes }
    }

    /// The query about bodies of these meshes (those that `bodies` name are ignored).
    pub fn query<'a>(
        &'a self,
        bodies: &[Moving<'a>; 2],
        window: Window,
        options: &QueryOptions,
    ) -> Query<'a> {
        let body = |k: usize| Body {
            mesh: &self.meshes[k],
            motion: bodies[k].motion,
            solid: match bodies[k].solid.unwrap_or(options.solid) {
                bvh::Solid::Filled => Solid::Filled,
                bvh::Solid::Surface => Solid::Surface,
            },
            radius: 0.0,
        };
        Query { bodies: [body(0), body(1)], window: TimeSpan { from: window.start(), to: window.end() } }
    }

    /// Proves an answer of [`time_of_contact`](crate::time_of_contact) again, in at most so many steps.
    pub fn time_of_contact(
        &self,
        bodies: &[Moving<'_>; 2],
        window: Window,
        options: &QueryOptions,
        answer: &TimeOfContact,
        most_steps: u64,
    ) -> Verdict {
        let query = self.query(bodies, window, options);
        match claim(bodies, window, options, answer) {
            Ok(claim) => verify(&query, &claim, most_steps),
            Err(reason) => Verdict::Unproven { clear_until: window.start(), reason, pair: None },
        }
    }
}

/// The separation that may be left above s, in tolerances.
const MOST_LEFT: f64 = 3.3;
/// What a reported distance may be off by, in tolerances: its rounding is below a hundredth of the least tolerance.
const OFF: f64 = 1.0 / 16.0;
/// δ if none is asked for, as a part of the larger body.
const DEFAULT_TOLERANCE: f64 = 1e-10;
/// What rounding may need for a tolerance, as a part of the lengths of the scene: 2⁻⁴³, four times what the engine takes.
const ROUNDING: f64 = 1.0 / 8_796_093_022_208.0;

/// What an answer about these bodies claims.
///
/// # Errors
/// The reason why nothing could prove it: [`Reason::Malformed`], [`Reason::Tolerance`], [`Reason::NothingClaimed`].
pub fn claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
) -> Result<Claim, Reason> {
    let clear = |to: f64| Claim::Clear {
        span: TimeSpan { from: window.start(), to },
        distance: options.min_separation,
    };
    match answer {
        TimeOfContact::Separated => Ok(clear(window.end())),
        // At its end they may touch, and so they may from the start.
        TimeOfContact::Undecided { clear_until } if *clear_until == window.start() => {
            Ok(Claim::All(Vec::new()))
        }
        TimeOfContact::Undecided { clear_until } => Ok(clear(*clear_until)),
        TimeOfContact::Contact(contact) => {
            let honest = honest_tolerance(bodies, window, options, contact.time_lo);
            if !(contact.separation >= 0.0 && contact.time_lo <= contact.time_hi) {
                return Err(Reason::Malformed);
            }
            if !(contact.tolerance >= 0.0 && contact.tolerance <= honest) {
                return Err(Reason::Tolerance);
            }
            if options.mode == Mode::Exists {
                return meeting(contact, options, contact.evidence).ok_or(Reason::NothingClaimed);
            }
            let mut claims = Vec::new();
            match contact.start {
                StartState::Apart => claims.push(clear(contact.time_lo)),
                _ if contact.time_lo != window.start() => return Err(Reason::Malformed),
                StartState::Overlapping | StartState::Contained if contact.separation != 0.0 => {
                    return Err(Reason::Malformed);
                }
                StartState::Contained => return Ok(Claim::Held { time: contact.time_lo }),
                // Triangles that cross as they are placed in floating point are near, to say the least.
                StartState::Overlapping => {
                    let evidence = contact.evidence.max(Evidence::Near);
                    return meeting(contact, options, evidence).ok_or(Reason::NothingClaimed);
                }
                StartState::Touching | StartState::Undecided => {}
            }
            let most = options.min_separation + MOST_LEFT * contact.tolerance;
            if options.mode != Mode::Capoeira && contact.separation > most {
                return Err(Reason::Distance);
            }
            let off = OFF * contact.tolerance;
            claims.push(Claim::Apart {
                time: contact.time_lo,
                triangles: [contact.triangle_a, contact.triangle_b],
                least: contact.separation - off,
                most: contact.separation + off,
            });
            claims.extend(meeting(contact, options, contact.evidence));
            Ok(Claim::All(claims))
        }
    }
}

fn meeting(contact: &Contact, options: &QueryOptions, evidence: Evidence) -> Option<Claim> {
    let above = match evidence {
        Evidence::Crossing => 0.0,
        Evidence::Near => contact.tolerance,
        _ => return None,
    };
    Some(Claim::Within {
        span: TimeSpan { from: contact.time_lo, to: contact.time_hi },
        distance: options.min_separation + above,
        triangles: Some([contact.triangle_a, contact.triangle_b]),
    })
}

/// The largest tolerance that is not a way to be right about anything: what was asked for, what the roundings of the scene's lengths may
/// need, and what the bodies move from one number for a time to the next.
fn honest_tolerance(bodies: &[Moving<'_>; 2], window: Window, options: &QueryOptions, time: f64) -> f64 {
    let radii = bodies.map(|moving| moving.body.radius());
    let states = [window.start(), time].map(|t| bodies.map(|moving| moving.motion.pose_and_twist(t)));
    let reach = |k: usize| {
        let (pose, _) = states[0][k];
        radii[k] + (bodies[k].body.center() - pose.at).length()
    };
    let reaches = [reach(0), reach(1)];
    let apart = |[(a, _), (b, _)]: &[(Pose, Twist); 2]| (a.translation - b.translation).length();
    let speed = |[(_, a), (_, b)]: &[(Pose, Twist); 2]| {
        (a.linear - b.linear).length() + a.angular.length() * reaches[0] + b.angular.length() * reaches[1]
    };
    let travel = speed(&states[0]).max(speed(&states[1])) * window.length();
    let apart = apart(&states[0]).max(apart(&states[1]));
    let lengths = reaches[0] + reaches[1] + apart + travel + options.min_separation;
    let clock = 8.0 * speed(&states[1]) * (time.next_up() - time).max(time - time.next_down());
    let asked = options.tolerance.unwrap_or(DEFAULT_TOLERANCE * radii[0].max(radii[1]));
    (asked * (1.0 + f64::EPSILON)).max(ROUNDING * lengths).max(clock)
}
