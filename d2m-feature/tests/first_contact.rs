//! First contact of feature pairs against an independent oracle of 192 bits, on planted contacts of every kind.
//!
//! The same families with a million queries each: `cargo xtask accuracy`.
mod planted;

#[test]
fn planted_contacts_are_never_missed_and_never_late() {
    let mut rows = 0;
    let total = planted::judge::all(24, 1, |name, tally| {
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
