/// What a query of a pair of bodies leaves for the next one: the triangles that were closest, or met.
///
/// Bodies that move little between two queries meet again near the same place, so looking there first gives an upper
/// bound before the search starts. Promise: a cache never changes an answer, not in one bit; a cache from other bodies
/// is useless but harmless.
///
/// ```
/// let mut cache = d2m_bvh::PairCache::new();
/// assert_eq!(cache.triangles(), None);
/// cache.remember([3, 7]);
/// assert_eq!(cache.triangles(), Some([3, 7]));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PairCache {
    triangles: Option<[u32; 2]>,
}

impl PairCache {
    /// Knows nothing yet.
    pub const fn new() -> Self {
        Self { triangles: None }
    }

    /// The remembered triangles, of A and of B.
    pub const fn triangles(&self) -> Option<[u32; 2]> {
        self.triangles
    }

    /// Remembers the triangles of A and of B.
    pub const fn remember(&mut self, triangles: [u32; 2]) {
        self.triangles = Some(triangles);
    }

    /// Forgets everything.
    pub const fn clear(&mut self) {
        self.triangles = None;
    }

    /// The remembered triangles if bodies with these numbers of triangles have them.
    pub(crate) fn within(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        self.triangles.filter(|t| (t[0] as usize) < counts[0] && (t[1] as usize) < counts[1])
    }
}
