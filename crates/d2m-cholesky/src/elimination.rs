//! In which order bodies are eliminated from a system that is sparse by pairs.

use std::collections::BTreeSet;

/// All bodies, each with those that share rows with it when it is eliminated, ascending. First goes what then shares rows with the fewest, and of several the
/// first one (minimum degree): what goes leaves all of its neighbors sharing rows with each other.
pub(crate) fn eliminate(bodies: usize, pairs: &[[usize; 2]]) -> Vec<(usize, Vec<usize>)> {
    let mut neighbors: Vec<Vec<usize>> = vec![Vec::new(); bodies];
    for &[i, j] in pairs {
        neighbors[i].push(j);
        neighbors[j].push(i);
    }
    for list in &mut neighbors {
        list.sort_unstable();
    }
    let mut waiting: BTreeSet<(usize, usize)> =
        neighbors.iter().enumerate().map(|(body, list)| (list.len(), body)).collect();
    let mut columns = Vec::with_capacity(bodies);
    while let Some((_, body)) = waiting.pop_first() {
        let own = core::mem::take(&mut neighbors[body]);
        for &other in &own {
            let list = &mut neighbors[other];
            waiting.remove(&(list.len(), other));
            list.extend(&own);
            list.sort_unstable();
            list.dedup();
            list.retain(|&one| one != body && one != other);
            waiting.insert((list.len(), other));
        }
        columns.push((body, own));
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a ring that a star is tied to: leaves go first, then the ring one after the other, which ties the neighbors of each.
    #[test]
    fn what_has_the_fewest_neighbors_goes_first() {
        let found = eliminate(6, &[[0, 1], [0, 2], [0, 4], [2, 3], [3, 5], [4, 5]]);
        let wanted =
            [(1, vec![0]), (0, vec![2, 4]), (2, vec![3, 4]), (3, vec![4, 5]), (4, vec![5]), (5, vec![])];
        assert_eq!(found, wanted);
    }
}
