//! The rows of the table of motions in small sizes: every answer is right.

use d2m_benches::any_motion::{Bodies, measure};

#[test]
fn the_rows_in_small_sizes_are_answered_right() {
    let bodies = Bodies::new(0.05);
    for rows in bodies.groups(6) {
        let times = measure(&rows, 1).unwrap_or_else(|fault| panic!("{fault}"));
        assert_eq!(times.len(), rows.len());
        for (row, time) in rows.iter().zip(times) {
            assert!(time.median.is_finite() && time.worst >= time.median, "{}", row.name);
        }
    }
}
