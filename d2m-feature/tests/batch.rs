//! The batch rejection against the single test: what it rejects is clear, and it rejects most of what is far.
mod planted;

use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use planted::families::{FAMILIES, Family, Kind, Random, plant};

#[test]
fn what_the_batch_rejects_is_clear() {
    let mut random = Random::new(5);
    let options = ContactOptions::new();
    for family in FAMILIES {
        let (mut rejected, mut clear) = (0, 0);
        for _ in 0..400 {
            let query = plant(Kind::PointTriangle, family, &mut random);
            // A short window, as a traversal asks: over a long one a single look decides little.
            let end = query.window.1.min(query.window.0 + 0.1);
            let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, end);
            let others = [0, 1, 2].map(|_| random.ball() * 3.0);
            let points = [query.a[0], others[0], others[1], others[2]];
            let triangle = pair.place_triangle(&query.b);
            let answers = pair.reject_points(&points, [&triangle; 4], 0.0);
            for (point, rejects) in points.into_iter().zip(answers) {
                let single = pair.point_placed(point, &triangle, &options);
                assert!(!rejects || single == FirstContact::Clear, "{point} {single:?} {query:?}");
                rejected += usize::from(rejects);
                clear += usize::from(single == FirstContact::Clear);
            }
            let apart = pair.reject_points(&points, [&triangle; 4], 100.0);
            assert_eq!(apart, [false; 4], "everything is within 100 units");
        }
        if family == Family::Far {
            assert!(rejected * 2 > clear, "{rejected} of {clear}");
        }
    }
}
