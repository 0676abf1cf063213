//! Answers of the engine as claims of [`d2m_verify`], which proves them again and shares no search with it.
//!
//! What an answer promises is a few claims at once, with s the minimum separation and δ the reported tolerance:
//!
//! | answer | claims |
//! |---|---|
//! | `Separated` | further apart than s in all of the window |
//! | `Undecided` | further apart than s until `clear_until` |
//! | `Contact`, apart at the start | further apart than s in [start, `time_lo`] |
//! | … touching or apart | its triangles are `separation` apart at `time_lo`, to rounding, and at most s + 3.3 δ (unless it stopped early) |
//! | … touching at the start | they share no point, or none when B is moved along the normal by no more than 2¹⁰ roundings of the lengths of that time |
//! | … overlapping at the start | within δ of each other then (`Crossing`: they share a point) |
//! | … contained | a body holds a part of the other at the start |
//! | … with evidence | within s (`Crossing`) or s + δ (`Near`) at some time of the bracket |
//! | [`Departure`] | within s + δ at the start and at `left.lo`, further apart at `left.hi`, and its answer from there on; until then (or the end of the window) within s + 13 δ at times no more than 1e-6 of the window apart |
//! | … overlapping or touching at the start | as a `Contact` at the start is, of the triangles that the search finds there |
//! | … contained at the start | a body holds a part of the other then |
//! | … apart at the start | further apart than s then, where the answer begins |
//! | any answer to [`Start::Leave`] | that it is the end of a departure: the bodies parted when a `Contact` says, else when the search finds them to |
//! | [`Clearance`] | nowhere below `lower`, at most `upper` at `time`, and no wider than was asked for; bodies that meet are as near at `time` as at a time of contact |
//! | [`ContactSpan`]s | clear spans are clear; spans of contact begin and end within the resolution of a time within s + δ, and hold one in each part as long as the resolution |
//!
//! Bodies with a radius are everything within it of their meshes. Worlds are proven pair by pair, each with a claim of its own, and so are
//! paths of robots (`verify_path`, with the feature `robot`).
//! Points, normals and features certify nothing; [`witness_fault`] compares them with the reported triangles. docs/theory/proofs.md.
mod claims;
mod leaving;
#[cfg(feature = "robot")]
mod path;
mod rounding;
mod witness;

pub use claims::{clearance_claim, spans_claim};
pub use d2m_verify::{Body, Claim, Mesh, MeshFault, Query, Reason, Solid, TimeSpan, Verdict, verify};
pub use leaving::departure_claim;
#[cfg(feature = "robot")]
pub use path::{PairFault, PathVerdict, PathVerdictFault, verify_path};
pub use witness::witness_fault;

use crate::{Clearance, ClearanceOptions, ContactSpan, Departure};
use crate::{Moving, QueryOptions, Start, TimeOfContact, TriMesh, Window};
use claims::contact_claim;
use d2m_bvh as bvh;
use leaving::leaving_claim;
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

/// What an answer of [`time_of_contact`](crate::time_of_contact) about these bodies claims. Where a contact at the start was to be let go
/// ([`Start::Leave`]): what the [`departure`](crate::departure) claims that ends so.
///
/// # Errors
/// The reason why nothing could prove it: [`Reason::Malformed`], [`Reason::Tolerance`], [`Reason::Witness`], [`Reason::Distance`],
/// [`Reason::NothingClaimed`], [`Reason::NotLeft`].
pub fn claim(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    answer: &TimeOfContact,
) -> Result<Claim, Reason> {
    if options.start == Start::Leave {
        leaving_claim(bodies, window, options, answer)
    } else {
        contact_claim(bodies, window, options, answer, None)
    }
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
            radius: bodies[k].radius,
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
        judge(&query, claim(bodies, window, options, answer), most_steps)
    }

    /// Proves an answer of [`departure`](crate::departure) again.
    pub fn departure(
        &self,
        bodies: &[Moving<'_>; 2],
        window: Window,
        options: &QueryOptions,
        answer: &Departure,
        most_steps: u64,
    ) -> Verdict {
        let query = self.query(bodies, window, options);
        judge(&query, departure_claim(bodies, window, options, answer), most_steps)
    }

    /// Proves an answer of [`clearance`](crate::clearance) again.
    pub fn clearance(
        &self,
        bodies: &[Moving<'_>; 2],
        window: Window,
        options: &ClearanceOptions,
        answer: &Clearance,
        most_steps: u64,
    ) -> Verdict {
        let query = self.query(bodies, window, &QueryOptions::default().with_solid(options.solid));
        judge(&query, clearance_claim(bodies, window, options, answer), most_steps)
    }

    /// Proves an answer of [`contact_spans`](crate::contact_spans) with this resolution again.
    pub fn contact_spans(
        &self,
        bodies: &[Moving<'_>; 2],
        window: Window,
        options: &QueryOptions,
        resolution: Option<f64>,
        answer: &[ContactSpan],
        most_steps: u64,
    ) -> Verdict {
        let query = self.query(bodies, window, options);
        judge(&query, spans_claim(bodies, window, options, resolution, answer), most_steps)
    }
}

fn judge(query: &Query<'_>, claim: Result<Claim, Reason>, most_steps: u64) -> Verdict {
    match claim {
        Ok(claim) => verify(query, &claim, most_steps),
        Err(reason) => Verdict::Unproven { clear_until: query.window.from, reason, pair: None },
    }
}
