//! First contact of feature pairs against an independent oracle of 192 bits, on planted contacts of every kind.
//!
//! The same families with a million queries each: `cargo xtask accuracy`.

use d2m_feature::{ContactBracket, ContactOptions, FirstContact, PairMotion};
use d2m_testing::Random;
use d2m_testing::planted::families::{FAMILIES, Kind, plant};
use d2m_testing::planted::judge::Tally;
use d2m_testing::planted::{oracle, quick};

#[test]
fn planted_contacts_are_never_missed_and_never_late() {
    let mut rows = 0;
    let total = d2m_testing::planted::judge::all(24, 1, |name, tally| {
        rows += 1;
        let (negatives, positives) = (tally.false_negatives.first(), tally.false_positives.first());
        assert!(negatives.is_none(), "{name}: {negatives:?}");
        assert!(positives.is_none(), "{name}: {positives:?}");
        assert_eq!(tally.undecided, 0, "{name}");
    });
    assert_eq!(rows, 56);
    // The families do plant contacts, and the oracle does find them.
    assert!(total.true_contacts > total.queries / 3, "{total:?}");
    assert!(total.hits >= total.true_contacts);
}

/// The quick tier against the oracle, on right answers and on answers made late, early or clear.
#[test]
fn the_quick_tier_says_nothing_that_the_oracle_does_not() {
    let options = ContactOptions::new();
    let mut random = Random::new(77);
    let (mut passed, mut queries, mut faults) = (0, 0, 0);
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in FAMILIES {
            for i in 0..12 {
                let query = plant(kind, family, &mut random);
                let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, query.window.1);
                let right = match kind {
                    Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
                    Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
                };
                let answer = match (i % 4, right) {
                    (1, FirstContact::Contact(c)) => {
                        FirstContact::Contact(ContactBracket { lo: c.lo + 1e-11, hi: c.hi + 1e-11, ..c })
                    }
                    (2, FirstContact::Contact(_)) => FirstContact::Clear,
                    (3, FirstContact::Contact(c)) => {
                        FirstContact::Contact(ContactBracket { lo: c.lo - 1e-6, hi: c.lo - 1e-6, ..c })
                    }
                    (_, right) => right,
                };
                let (exact, near) = (oracle::rigid(&query), quick::rigid(&query));
                let mut tally = Tally::default();
                tally.judge(kind, &query, &exact, answer, query.window);
                let fault = !tally.false_negatives.is_empty() || !tally.false_positives.is_empty();
                let verdict = quick::clearly_right(kind, &near, &answer, query.time, query.window);
                if let Some(contact) = verdict {
                    assert!(!fault, "{answer:?} {query:?}");
                    assert!(!contact || tally.true_contacts == 1, "{answer:?} {query:?}");
                    passed += 1;
                }
                queries += 1;
                faults += usize::from(fault);
            }
        }
    }
    assert!(
        faults > 60 && passed + faults > queries * 8 / 10,
        "{passed} passed, {faults} faults of {queries}"
    );
}
