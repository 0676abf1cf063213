//! The first of equal vertices, and of equal triangles.

use glam::DVec3;

/// For each vertex the lowest vertex with equal coordinates (−0 = 0).
pub(super) fn first_at_position(vertices: &[DVec3]) -> Vec<u32> {
    first_equal(vertices, bits)
}

/// Have no two vertices equal coordinates (−0 = 0)?
pub(super) fn are_distinct(vertices: &[DVec3]) -> bool {
    let mut table = Table::new(vertices, bits);
    (0..vertices.len()).all(|vertex| table.first(vertex) as usize == vertex)
}

fn bits(p: &DVec3) -> [u64; 3] {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

/// For each item the lowest one with the same key.
pub(super) fn first_equal<T>(items: &[T], key: impl Fn(&T) -> [u64; 3]) -> Vec<u32> {
    let mut table = Table::new(items, key);
    (0..items.len()).map(|item| table.first(item)).collect()
}

/// The items that have been seen: a table of twice as many, searched slot by slot.
struct Table<'a, T, K> {
    items: &'a [T],
    key: K,
    slots: Vec<u32>,
}

impl<'a, T, K: Fn(&T) -> [u64; 3]> Table<'a, T, K> {
    const EMPTY: u32 = u32::MAX;

    fn new(items: &'a [T], key: K) -> Self {
        Self { items, key, slots: vec![Self::EMPTY; (2 * items.len()).next_power_of_two()] }
    }

    /// The first one with the key of this item, which has its place from then on.
    fn first(&mut self, item: usize) -> u32 {
        let mask = self.slots.len() - 1;
        let own = (self.key)(&self.items[item]);
        let mix = |h: u64, word: u64| (h ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        let [x, y, z] = own;
        let mut slot = (mix(mix(mix(0, x), y), z) >> 7) as usize & mask;
        while self.slots[slot] != Self::EMPTY && (self.key)(&self.items[self.slots[slot] as usize]) != own {
            slot = (slot + 1) & mask;
        }
        if self.slots[slot] == Self::EMPTY {
            self.slots[slot] = item as u32;
        }
        self.slots[slot]
    }
}
