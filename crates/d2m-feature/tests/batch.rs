//! The batch rejections against the single tests: what they reject is clear, and they reject most of what is far.
mod planted;

use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use planted::families::{FAMILIES, Family, Kind, Random, plant};

#[test]
fn what_the_batch_rejects_is_clear() {
    let mut random = Random::new(5);
    let options = ContactOptions::new();
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in FAMILIES {
            let (mut rejected, mut clear) = (0, 0);
            for _ in 0..400 {
                let query = plant(kind, family, &mut random);
                // A short window, as a traversal asks: over a long one a single look decides little.
                let end = query.window.1.min(query.window.0 + 0.1);
                let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, end);
                let other = [0, 1, 2].map(|_| [random.ball() * 3.0, random.ball() * 3.0]);
                let mine = [query.a, other[0], other[1], other[2]];
                let theirs = [query.b[0], query.b[1]];
                let answers = match kind {
                    Kind::PointTriangle => {
                        let points = pair.place_points(&mine.map(|edge| edge[0]));
                        let triangles = pair.place_triangles(&[query.b; 4]);
                        assert_eq!(
                            pair.reject_points(&points, &triangles, 1e4),
                            [false; 4],
                            "everything is within 1e4 units"
                        );
                        pair.reject_points(&points, &triangles, 0.0)
                    }
                    Kind::EdgeEdge => {
                        let (a, b) = (pair.place_edges_a(&mine), pair.place_edges_b(&[theirs; 4]));
                        assert_eq!(pair.reject_edges(&a, &b, 1e4), [false; 4]);
                        pair.reject_edges(&a, &b, 0.0)
                    }
                };
                for (edge, rejects) in mine.into_iter().zip(answers) {
                    let single = match kind {
                        Kind::PointTriangle => pair.point_triangle(edge[0], &query.b, &options),
                        Kind::EdgeEdge => pair.edge_edge(edge, theirs, &options),
                    };
                    assert!(!rejects || single == FirstContact::Clear, "{edge:?} {single:?} {query:?}");
                    rejected += usize::from(rejects);
                    clear += usize::from(single == FirstContact::Clear);
                }
            }
            if family == Family::Far {
                assert!(rejected * 2 > clear, "{kind:?}: {rejected} of {clear}");
            }
        }
    }
}
