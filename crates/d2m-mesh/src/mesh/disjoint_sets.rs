//! Union–find.

/// Sets of the numbers 0 to n - 1 that are joined step by step: parts of a mesh that hang together, bodies that touch.
///
/// The root of a set is its smallest member, whatever order its members were joined in. Paths are halved as they are followed (R. E. Tarjan and
/// J. van Leeuwen, DOI 10.1145/62.2160).
///
/// ```
/// use d2m_mesh::DisjointSets;
/// let mut sets = DisjointSets::new(5);
/// sets.join([3, 1]);
/// sets.join([4, 3]);
/// assert_eq!([0, 1, 2, 3, 4].map(|k| sets.root(k)), [0, 1, 2, 1, 1]);
/// ```
#[derive(Clone, Debug)]
pub struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Each number below `count` is a set by itself.
    ///
    /// ```
    /// assert_eq!(d2m_mesh::DisjointSets::new(3).root(2), 2);
    /// ```
    ///
    /// # Panics
    /// If there are more than 2³² numbers.
    #[must_use]
    pub fn new(count: usize) -> Self {
        assert!(count as u64 <= 1 << 32, "{count} numbers are more than 2³²");
        Self { parent: (0..count).map(|member| member as u32).collect() }
    }

    /// Each number is in the set of its parent, which is no larger.
    pub(super) const fn from_parents(parent: Vec<u32>) -> Self {
        Self { parent }
    }

    /// The smallest member of the set of a number.
    ///
    /// ```
    /// let mut sets = d2m_mesh::DisjointSets::new(3);
    /// sets.join([2, 1]);
    /// assert_eq!(sets.root(2), 1);
    /// ```
    ///
    /// # Panics
    /// If the number is not below the count.
    #[inline(always)]
    pub fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes one set of those of some numbers.
    ///
    /// ```
    /// let mut sets = d2m_mesh::DisjointSets::new(4);
    /// sets.join([3, 2, 1]);
    /// assert_eq!([0, 1, 2, 3].map(|k| sets.root(k)), [0, 1, 1, 1]);
    /// ```
    ///
    /// # Panics
    /// If a number is not below the count.
    #[inline(always)]
    pub fn join<const N: usize>(&mut self, members: [u32; N]) {
        let roots = members.map(|member| self.root(member));
        let least = roots.iter().fold(u32::MAX, |least, &root| least.min(root));
        for root in roots {
            self.parent[root as usize] = least;
        }
    }
}
