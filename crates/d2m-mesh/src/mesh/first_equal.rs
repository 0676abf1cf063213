//! The first of equal vertices, and of equal triangles.

use glam::DVec3;

/// For each vertex the lowest vertex with equal coordinates (−0 = 0).
pub(super) fn first_at_position(vertices: &[DVec3]) -> Vec<u32> {
    let bits = |p: &DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    first_equal(vertices, bits)
}

/// Have no two vertices equal coordinates (−0 = 0)?
pub(super) fn are_distinct(vertices: &[DVec3]) -> bool {
    (0..).zip(first_at_position(vertices)).all(|(vertex, first)| vertex == first)
}

/// For each item the lowest one with the same key: a table of twice the items, searched slot by slot.
pub(super) fn first_equal<T>(items: &[T], key: impl Fn(&T) -> [u64; 3]) -> Vec<u32> {
    const EMPTY: u32 = u32::MAX;
    let mask = (2 * items.len()).next_power_of_two() - 1;
    let mut table = vec![EMPTY; mask + 1];
    let slot_of = |[x, y, z]: [u64; 3]| {
        let mix = |h: u64, word: u64| (h ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        (mix(mix(mix(0, x), y), z) >> 7) as usize & mask
    };
    let mut first = Vec::with_capacity(items.len());
    for (i, item) in items.iter().enumerate() {
        let own = key(item);
        let mut slot = slot_of(own);
        while table[slot] != EMPTY && key(&items[table[slot] as usize]) != own {
            slot = (slot + 1) & mask;
        }
        if table[slot] == EMPTY {
            table[slot] = i as u32;
        }
        first.push(table[slot]);
    }
    first
}
