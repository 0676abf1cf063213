//! Union–find.

/// Sets of numbers, with path halving; the root of a set is its smallest member.
pub(super) struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Each number is a set by itself.
    pub(super) fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// Each number is in the set of its parent, which is no larger.
    pub(super) const fn from_parents(parent: Vec<u32>) -> Self {
        Self { parent }
    }

    /// The smallest member of the set.
    pub(super) fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes one set of two.
    pub(super) fn join(&mut self, first: u32, second: u32) {
        let (first, second) = (self.root(first), self.root(second));
        self.parent[first.max(second) as usize] = first.min(second);
    }
}
