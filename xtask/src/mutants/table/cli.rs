//! Deliberate faults in the files that the command reads, and in trees as bytes.
use super::{Mutant, patch};

pub(super) const MUTANTS: &[Mutant] = &[
    patch(
        "coordinates of texts in single precision",
        "crates/d2m-cli/src/load/mod.rs",
        "        check_coordinate(axis, value)?;\n        Ok(value)",
        "        check_coordinate(axis, value)?;\n        Ok(f64::from(value as f32))",
        "crates/d2m-cli/src/load/tests.rs::texts_are_read_as_the_nearest_doubles",
    ),
    patch(
        "every polygon is a fan",
        "crates/d2m-cli/src/load/polygon.rs",
        "if is_fan {",
        "if is_fan || n > 3 {",
        "crates/d2m-cli/src/load/polygon/tests.rs::concave_polygons_are_covered_once",
    ),
    patch(
        "ears that hold a corner",
        "crates/d2m-cli/src/load/polygon.rs",
        "Greater => self.is_ear(corner),",
        "Greater => self.is_ear(corner) || true,",
        "crates/d2m-cli/src/load/polygon/tests.rs::concave_polygons_are_covered_once",
    ),
    patch(
        "a tree as bytes that is not validated",
        "crates/d2m-bvh/src/tree/parts.rs",
        "    checked?;\n",
        "    let _ = checked;\n",
        "crates/d2m-bvh/src/tree/file/tests.rs::forged_bytes_are_refused_or_valid",
    ),
    patch(
        "a checksum that skips every second word",
        "crates/d2m-bvh/src/tree/file.rs",
        "words.iter().fold(",
        "words.iter().step_by(2).fold(",
        "crates/d2m-bvh/src/tree/file/tests.rs::every_damaged_byte_is_noticed",
    ),
    patch(
        "boxes are checked against the first triangle below them only",
        "crates/d2m-bvh/src/tree/enclosures.rs",
        "taken.truncate(kept);",
        "taken.truncate(kept.min(before + 3));",
        "crates/d2m-bvh/src/tree/tests.rs::any_shrunk_or_broken_tree_is_refused",
    ),
    patch(
        "vertices that another box has are not checked again",
        "crates/d2m-bvh/src/tree/enclosures.rs",
        "corner.earlier <= start",
        "corner.earlier == 0",
        "crates/d2m-bvh/src/tree/tests.rs::each_box_is_checked_against_each_vertex_below_it",
    ),
];
