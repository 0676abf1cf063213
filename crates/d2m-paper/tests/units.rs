//! Twins of planted contacts, with lengths and times multiplied by powers of two.

use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use d2m_interval::Interval;
use d2m_paper::{PaperOptions, RelativeMotion, edge_edge, point_triangle};
use d2m_root::{Evidence, RootSearch};
use d2m_testing::Random;
use d2m_testing::planted::families::{Family, Kind, Planted, plant};
use d2m_testing::planted::twins::{SCALES, scaled, scaled_query};

fn rigid(query: &Planted) -> FirstContact {
    let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, query.window.1);
    let options = ContactOptions::new();
    match query.kind {
        Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
        Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
    }
}

/// The reference method works in the units of the input with intervals of an absolute width of 2⁻⁵⁰⁰: it may say less there,
/// but never that there is no contact where there is one.
#[test]
fn the_reference_method_misses_nothing_in_any_unit() {
    let mut random = Random::new(8);
    let mut hits = 0;
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in [Family::Hit, Family::Boundary, Family::Window] {
            for _ in 0..3 {
                let query = plant(kind, family, &mut random);
                let FirstContact::Contact(contact) = rigid(&query) else { continue };
                if contact.evidence != Evidence::Crossing {
                    continue;
                }
                for (length, time) in SCALES {
                    let Some(twin) = scaled_query(&query, length, time) else { continue };
                    let motion = RelativeMotion::new(&twin.motion_a, &twin.motion_b);
                    let window = Interval::new(twin.window.0, twin.window.1);
                    let tolerance = scaled(1e-10, length).unwrap();
                    let options = PaperOptions::DEFAULT.with_tolerance(tolerance).with_evaluations(2000);
                    let found = match kind {
                        Kind::PointTriangle => point_triangle(&motion, twin.a[0], &twin.b, window, &options),
                        Kind::EdgeEdge => {
                            edge_edge(&motion, &twin.a, &[twin.b[0], twin.b[1]], window, &options)
                        }
                    };
                    let hi = scaled(contact.hi, time).unwrap();
                    match found {
                        RootSearch::Bracket(bracket) => assert!(bracket.lo() <= hi, "2^{length} 2^{time}"),
                        RootSearch::Undecided { clear_until } => {
                            assert!(clear_until <= hi, "2^{length} 2^{time}: {clear_until}");
                        }
                        RootSearch::None => panic!("2^{length} 2^{time}: missed {query:?}"),
                    }
                    hits += 1;
                }
            }
        }
    }
    assert!(hits > 200, "{hits}");
}
