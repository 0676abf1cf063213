//! Default engine, reference method and slow oracle on random small scenes.

#[test]
fn engine_and_reference_agree() {
    for seed in [101, 102] {
        let report = d2m_bvh::paper::cross_check(120, seed);
        assert!(report.complaints.is_empty(), "{:#?}", report.complaints);
        assert!(report.contacts > 50, "{report:?}");
        assert_eq!(
            (report.undecided[1], report.open_brackets[1], report.loose_brackets[1]),
            (0, 0, 0),
            "{report:?}"
        );
    }
}
