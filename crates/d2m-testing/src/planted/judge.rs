//! Compares the library's answers with the oracle's and states what is wrong.
use super::families::{FAMILIES, Family, Kind, Planted, plant};
use super::oracle::{Vertices, big, distance, rigid, straight, true_contact};
use super::quick::{self, QuickVertices};
use crate::Random;
use crate::{Opaque, OpaqueWithState};
use d2m_feature::{ContactOptions, FirstContact, PairMotion, StraightPaths};

/// What a run saw.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    /// Queries that were judged.
    pub queries: u64,
    /// True contacts that the oracle proved.
    pub true_contacts: u64,
    /// Contacts reported.
    pub hits: u64,
    /// Contact missed or reported late: never allowed.
    pub false_negatives: Vec<String>,
    /// Contact reported although no time of the bracket is close: beyond 1e-9 in unit families.
    pub false_positives: Vec<String>,
    /// Queries that the quick tier left to the 192 bits.
    pub by_oracle: u64,
    /// Queries left undecided.
    pub undecided: u64,
}

/// Distance that a reported contact may be wrong by.
const FALSE_POSITIVE: f64 = 1e-9;

impl Tally {
    /// Judges one answer: by the quick tier if it is clearly right, by the oracle otherwise.
    pub fn judge_in_tiers(
        &mut self,
        query: &Planted,
        quick: &QuickVertices,
        vertices: &Vertices,
        answer: FirstContact,
        window: (f64, f64),
    ) {
        let clear = quick::clearly_right(query.kind, quick, &answer, query.time, window);
        if let Some(contact) = clear {
            self.queries += 1;
            self.true_contacts += u64::from(contact);
            self.hits += u64::from(matches!(answer, FirstContact::Contact(_)));
        } else {
            self.by_oracle += 1;
            self.judge(query.kind, query, vertices, answer, window);
        }
    }

    /// Judges one answer by the oracle.
    pub fn judge(
        &mut self,
        kind: Kind,
        query: &Planted,
        vertices: &Vertices,
        answer: FirstContact,
        window: (f64, f64),
    ) {
        self.queries += 1;
        let truth = true_contact(kind, vertices, query.time, window);
        self.true_contacts += u64::from(truth.is_some());
        let wrong = |what: &str| format!("{what}: {answer:?} truth {truth:?} {query:?}");
        match answer {
            FirstContact::Clear => {
                if truth.is_some() {
                    self.false_negatives.push(wrong("missed"));
                }
            }
            FirstContact::Contact(contact) => {
                self.hits += 1;
                if !(window.0 <= contact.lo && contact.lo <= contact.hi && contact.hi <= window.1) {
                    self.false_negatives.push(wrong("bracket outside the window"));
                }
                if truth.as_ref().is_some_and(|truth| big(contact.lo) > *truth) {
                    self.false_negatives.push(wrong("late"));
                }
                let near = [contact.lo, contact.hi].map(|t| distance(kind, vertices, t));
                if near[0].min(near[1]) > FALSE_POSITIVE {
                    self.false_positives.push(wrong(&format!("apart by {near:?}")));
                }
            }
            FirstContact::Undecided { clear_until } => {
                self.undecided += 1;
                if truth.as_ref().is_some_and(|truth| big(clear_until) > *truth) {
                    self.false_negatives.push(wrong("clear too long"));
                }
            }
        }
    }

    fn add(&mut self, other: Self) {
        self.queries += other.queries;
        self.true_contacts += other.true_contacts;
        self.hits += other.hits;
        self.undecided += other.undecided;
        self.by_oracle += other.by_oracle;
        self.false_negatives.extend(other.false_negatives);
        self.false_positives.extend(other.false_positives);
    }
}

/// Rigid queries of one family.
pub fn rigid_family(kind: Kind, family: Family, count: u64, seed: u64) -> Tally {
    let mut tally = Tally::default();
    let mut random = Random::new(seed);
    let options = ContactOptions::new();
    for _ in 0..count {
        let query = plant(kind, family, &mut random);
        let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, query.window.1);
        let answer = match kind {
            Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
            Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
        };
        tally.judge_in_tiers(&query, &quick::rigid(&query), &rigid(&query), answer, query.window);
    }
    tally
}

/// The same queries of motions that do not say that their twists are constant: every other one with nothing but the enclosures
/// that a motion must give.
pub fn enclosed_family(kind: Kind, family: Family, count: u64, seed: u64) -> Tally {
    let mut tally = Tally::default();
    let mut random = Random::new(seed);
    let options = ContactOptions::new();
    for i in 0..count {
        let query = plant(kind, family, &mut random);
        let (a, b, (t0, t1)) = (&query.motion_a, &query.motion_b, query.window);
        let (opaque_a, opaque_b) = (Opaque(*a), Opaque(*b));
        let (state_a, state_b) = (OpaqueWithState(*a), OpaqueWithState(*b));
        let pair = if i % 2 == 0 {
            PairMotion::new(&state_a, &state_b, t0, t1)
        } else {
            PairMotion::new(&opaque_a, &opaque_b, t0, t1)
        };
        let answer = match kind {
            Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
            Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
        };
        tally.judge_in_tiers(&query, &quick::rigid(&query), &rigid(&query), answer, query.window);
    }
    tally
}

/// Straight paths through the vertices of one family.
pub fn straight_family(kind: Kind, family: Family, count: u64, seed: u64) -> Tally {
    let mut tally = Tally::default();
    let mut random = Random::new(seed);
    let options = ContactOptions::new();
    for _ in 0..count {
        let query = plant(kind, family, &mut random);
        let (start, end) = query.straight();
        let paths = StraightPaths::new(start, end);
        let answer = match kind {
            Kind::PointTriangle => paths.point_triangle(&options),
            Kind::EdgeEdge => paths.edge_edge(&options),
        };
        tally.judge_in_tiers(&query, &quick::straight(start, end), &straight(start, end), answer, (0.0, 1.0));
    }
    tally
}

/// Every family, kind and form, `count` queries each; calls `report` after each.
pub fn all(count: u64, seed: u64, mut report: impl FnMut(&str, &Tally)) -> Tally {
    let mut total = Tally::default();
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for (index, family) in FAMILIES.into_iter().enumerate() {
            let seed = seed.wrapping_mul(64).wrapping_add(index as u64);
            let tally = rigid_family(kind, family, count, seed);
            report(&format!("rigid {kind:?} {family:?}"), &tally);
            total.add(tally);
            let tally = enclosed_family(kind, family, count, seed);
            report(&format!("enclosed {kind:?} {family:?}"), &tally);
            total.add(tally);
            // A spinning body's tangents and far windows have no straight twin worth asking.
            if !matches!(family, Family::Window | Family::Fast) {
                let tally = straight_family(kind, family, count, seed);
                report(&format!("straight {kind:?} {family:?}"), &tally);
                total.add(tally);
            }
        }
    }
    total
}
