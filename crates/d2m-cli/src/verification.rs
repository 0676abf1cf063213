//! Answers proven again by the verifier, which shares nothing with the search.

use crate::engine::{Answer, Further, Pair};
use crate::failure::Failure;
use d2m::bvh::{
    Clearance, ClearanceOptions, Contact, ContactSpan, Departure, MeshTree, Moving, QueryOptions,
    TimeOfContact, Window,
};
use d2m::motion::RigidMotion;
use d2m::verify::{Claim, DEFAULT_STEPS, Mesh, TimeSpan, Verdict, Verifier, mesh, verify, witness_fault};
use d2m_io::{joined_verdict, put_verdict, verdict_sentence};
use serde_json::Value;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// What became of an answer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proof(pub(crate) Verdict);

impl Proof {
    pub(crate) const fn is_verified(&self) -> bool {
        matches!(self.0, Verdict::Verified { .. })
    }

    pub(crate) const fn is_refuted(&self) -> bool {
        matches!(self.0, Verdict::Refuted { .. })
    }

    /// One sentence for a person.
    pub(crate) fn sentence(&self) -> String {
        verdict_sentence(&self.0)
    }

    /// Adds the fields of a JSON answer.
    pub(crate) fn put(&self, object: &mut Value) {
        put_verdict(&self.0, object);
    }

    /// A JSON answer, as it was printed, with the same fields.
    pub(crate) fn put_into(&self, text: &str) -> Result<String, Failure> {
        let mut object: Value = serde_json::from_str(text).map_err(|error| Failure::at("answer", error))?;
        self.put(&mut object);
        Ok(format!("{object}\n"))
    }
}

/// What an answer promises.
pub(crate) enum Promise {
    /// Of `d2m toc`.
    Contact(TimeOfContact),
    /// Of `d2m toc --start leave`.
    Departure(Departure),
    /// Of `d2m toc --clearance`: the ends of the enclosure besides, and when the bodies come as near as its
    /// upper end; not known: at some time.
    Apart { lower: f64, upper: f64, time: Option<f64> },
    /// Of `d2m clearance`; no accuracy: any width.
    Clearance { found: Clearance, accuracy: Option<f64> },
    /// Of `d2m spans`.
    Spans { spans: Vec<ContactSpan>, resolution: f64 },
}

/// All that an answer promises.
pub(crate) fn promises_of(answer: &Answer) -> Vec<Promise> {
    let Further { clearance, departure } = answer.further;
    let contact = departure.map_or(Promise::Contact(answer.verdict), Promise::Departure);
    let clearance = clearance.map(|found| Promise::Clearance { found, accuracy: None });
    std::iter::once(contact).chain(clearance).collect()
}

/// Proves answers about one pair of meshes again.
pub(crate) struct PairVerifier<'p> {
    pub(crate) pair: &'p Pair,
    verifier: Verifier,
    /// Trees of a pair that was prepared for the reference method.
    trees: Option<[MeshTree; 2]>,
}

impl<'p> PairVerifier<'p> {
    pub(crate) fn new(pair: &'p Pair) -> Result<Self, Failure> {
        let verifier = Verifier::try_new(pair.a.mesh(), pair.b.mesh());
        let verifier = verifier.map_err(|error| Failure::at("--verify", error))?;
        let is_prepared = pair.a.tree().is_some() && pair.b.tree().is_some();
        let trees = (!is_prepared).then(|| [&pair.a, &pair.b].map(|body| MeshTree::new(body.mesh().clone())));
        Ok(Self { pair, verifier, trees })
    }

    fn bodies<'m>(&'m self, motions: [&'m dyn RigidMotion; 2]) -> [Moving<'m>; 2] {
        let prepared = self.pair.a.tree().zip(self.pair.b.tree());
        let trees = self.trees.as_ref().map(|[a, b]| [a, b]).or(prepared.map(|(a, b)| [a, b]));
        let Some(trees) = trees else { unreachable!("trees are built where there are none") };
        let Pair { solids, radii, .. } = self.pair;
        [0, 1].map(|k| Moving::new(trees[k], motions[k]).with_solid(solids[k]).with_radius(radii[k]))
    }

    /// The first field of a contact that is not that of its triangles.
    pub(crate) fn witness_fault(
        &self,
        motions: [&dyn RigidMotion; 2],
        window: Window,
        contact: &Contact,
    ) -> Option<&'static str> {
        witness_fault(&self.bodies(motions), window, self.pair.options(), contact)
    }

    pub(crate) fn prove(&self, motions: [&dyn RigidMotion; 2], window: Window, answer: &Promise) -> Proof {
        let (bodies, options, most) = (self.bodies(motions), self.pair.options(), DEFAULT_STEPS);
        let verifier = &self.verifier;
        Proof(match answer {
            Promise::Contact(answer) => verifier.time_of_contact(&bodies, window, options, answer, most),
            Promise::Departure(answer) => verifier.departure(&bodies, window, options, answer, most),
            Promise::Clearance { found, accuracy } => {
                let mut wanted = ClearanceOptions::default().with_accuracy(accuracy.unwrap_or(f64::INFINITY));
                wanted.tolerance = options.tolerance;
                verifier.clearance(&bodies, window, &wanted, found, most)
            }
            Promise::Spans { spans, resolution } => {
                verifier.contact_spans(&bodies, window, options, Some(*resolution), spans, most)
            }
            Promise::Apart { lower, upper, time } => {
                let span = TimeSpan { from: window.start(), to: window.end() };
                let clear = Claim::Clear { span, distance: lower.next_down() };
                let nearest = time.map_or(span, |time| TimeSpan { from: time, to: time });
                let within = Claim::Within { span: nearest, distance: *upper, triangles: None };
                verify(&verifier.query(&bodies, window, options), &Claim::All(vec![clear, within]), most)
            }
        })
    }
}

/// Many bodies, and what is claimed of each pair of them.
///
/// Scenes and robots are proven so: pair by pair.
pub(crate) struct Bodies<'b> {
    bodies: Vec<Moving<'b>>,
    meshes: Vec<Arc<Mesh>>,
}

impl<'b> Bodies<'b> {
    pub(crate) fn new(bodies: Vec<Moving<'b>>) -> Result<Self, Failure> {
        let mut known = HashMap::new();
        let mut meshes = Vec::with_capacity(bodies.len());
        for moving in &bodies {
            // Bodies of one tree share what the verifier keeps of it.
            let key = std::ptr::from_ref(moving.body);
            let kept = match known.entry(key) {
                Entry::Occupied(kept) => Arc::clone(kept.get()),
                Entry::Vacant(place) => {
                    let built = mesh(moving.body.mesh()).map_err(|error| Failure::at("--verify", error))?;
                    Arc::clone(place.insert(Arc::new(built)))
                }
            };
            meshes.push(kept);
        }
        Ok(Self { bodies, meshes })
    }

    fn pair(&self, [a, b]: [usize; 2]) -> (Verifier, [Moving<'b>; 2]) {
        let verifier = Verifier::new([Arc::clone(&self.meshes[a]), Arc::clone(&self.meshes[b])]);
        (verifier, [self.bodies[a], self.bodies[b]])
    }

    /// Proves an answer about two of the bodies, by their numbers.
    pub(crate) fn prove(
        &self,
        pair: [usize; 2],
        window: Window,
        options: &QueryOptions,
        answer: &TimeOfContact,
    ) -> Proof {
        let (verifier, bodies) = self.pair(pair);
        Proof(verifier.time_of_contact(&bodies, window, options, answer, DEFAULT_STEPS))
    }

    /// The same of how near two of the bodies come.
    pub(crate) fn prove_clearance(
        &self,
        pair: [usize; 2],
        window: Window,
        options: &ClearanceOptions,
        answer: &Clearance,
    ) -> Proof {
        let (verifier, bodies) = self.pair(pair);
        Proof(verifier.clearance(&bodies, window, options, answer, DEFAULT_STEPS))
    }

    /// The same of which times of the window are clear.
    pub(crate) fn prove_spans(
        &self,
        pair: [usize; 2],
        window: Window,
        options: &QueryOptions,
        (spans, resolution): (&[ContactSpan], f64),
    ) -> Proof {
        let (verifier, bodies) = self.pair(pair);
        Proof(verifier.contact_spans(&bodies, window, options, Some(resolution), spans, DEFAULT_STEPS))
    }

    /// Proves that two of the bodies are at least this far apart all the time, however they meet.
    pub(crate) fn prove_apart(&self, pair: [usize; 2], window: Window, distance: f64) -> Proof {
        let (verifier, bodies) = self.pair(pair);
        let span = TimeSpan { from: window.start(), to: window.end() };
        // The claim is of more than a distance.
        let claim = Claim::Clear { span, distance: distance.next_down() };
        Proof(verify(&verifier.query(&bodies, window, &QueryOptions::default()), &claim, DEFAULT_STEPS))
    }
}

/// What of several proofs counts: a refutation, else what is not proven, else all steps.
pub(crate) fn joined(proofs: impl IntoIterator<Item = Proof>) -> Proof {
    Proof(joined_verdict(proofs.into_iter().map(|proof| proof.0)))
}
