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
    #[inline(always)]
    pub(super) fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes one set of those of some numbers.
    #[inline(always)]
    pub(super) fn join<const N: usize>(&mut self, members: [u32; N]) {
        let roots = members.map(|member| self.root(member));
        let least = roots.iter().fold(u32::MAX, |least, &root| least.min(root));
        for root in roots {
            self.parent[root as usize] = least;
        }
    }
}
