//! Which pairs are of interest, how far apart they are to stay, and what counts of those that begin in contact.

use crate::Group;
use crate::box_tree::IndexPair;
use d2m_bvh::Start;
use std::collections::{BTreeMap, BTreeSet};

/// Ignored pairs and groups, and what single pairs have of their own.
#[derive(Clone, Debug, Default)]
pub(super) struct PairFilter {
    pairs: BTreeSet<IndexPair>,
    groups: BTreeSet<[Group; 2]>,
    separations: BTreeMap<IndexPair, f64>,
    starts: BTreeMap<IndexPair, Start>,
}

fn ordered<T: Ord>(a: T, b: T) -> [T; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

impl PairFilter {
    /// Ignores a pair from now on.
    pub(super) fn ignore(&mut self, pair: IndexPair) {
        self.pairs.insert(pair);
    }

    /// No longer ignores a pair by itself; was it ignored?
    pub(super) fn restore(&mut self, pair: IndexPair) -> bool {
        self.pairs.remove(&pair)
    }

    /// Ignores the pairs of two groups from now on.
    pub(super) fn ignore_groups(&mut self, a: Group, b: Group) {
        self.groups.insert(ordered(a, b));
    }

    /// No longer ignores the pairs of two groups; were they ignored?
    pub(super) fn restore_groups(&mut self, a: Group, b: Group) -> bool {
        self.groups.remove(&ordered(a, b))
    }

    /// Is this pair ignored, by itself or by its groups?
    #[inline]
    pub(super) fn ignores(&self, pair: IndexPair, groups: [Option<Group>; 2]) -> bool {
        let by_group = || match groups {
            [Some(a), Some(b)] => self.groups.contains(&ordered(a, b)),
            _ => false,
        };
        (!self.pairs.is_empty() && self.pairs.contains(&pair)) || (!self.groups.is_empty() && by_group())
    }

    /// Sets the separation of a pair, or none of its own.
    pub(super) fn set_separation(&mut self, pair: IndexPair, separation: Option<f64>) {
        match separation {
            Some(distance) => self.separations.insert(pair, distance),
            None => self.separations.remove(&pair),
        };
    }

    /// The separation of a pair, `usual` if it has none of its own.
    #[inline]
    pub(super) fn separation(&self, pair: IndexPair, usual: f64) -> f64 {
        if self.separations.is_empty() {
            return usual;
        }
        self.separations.get(&pair).copied().unwrap_or(usual)
    }

    /// Sets what counts of a pair that begins in contact, or nothing of its own.
    pub(super) fn set_start(&mut self, pair: IndexPair, start: Option<Start>) {
        match start {
            Some(start) => self.starts.insert(pair, start),
            None => self.starts.remove(&pair),
        };
    }

    /// What counts of a pair that begins in contact, `usual` if it has nothing of its own.
    #[inline]
    pub(super) fn start(&self, pair: IndexPair, usual: Start) -> Start {
        self.starts.get(&pair).copied().unwrap_or(usual)
    }

    /// The pairs whose own separation is more than `usual`, or no number: boxes that are only `usual` apart do not
    /// prove them apart.
    pub(super) fn wider_than(&self, usual: f64) -> impl Iterator<Item = (IndexPair, f64)> + '_ {
        let pairs = self.separations.iter().map(|(&pair, &separation)| (pair, separation));
        pairs.filter(move |&(_, separation)| separation.is_nan() || separation > usual)
    }

    /// Forgets what was said about a body.
    pub(super) fn forget(&mut self, body: u32) {
        self.pairs.retain(|pair| !pair.contains(&body));
        self.separations.retain(|pair, _| !pair.contains(&body));
        self.starts.retain(|pair, _| !pair.contains(&body));
    }
}
