//! Sets of numbers that are joined: union and find.

/// The number that stands for all that are joined with this one: the least, where the larger root is joined to the smaller one.
pub(crate) fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

/// Joins the sets of two numbers.
pub(crate) fn join(parent: &mut [usize], a: usize, b: usize) {
    let (i, j) = (root(parent, a), root(parent, b));
    parent[i.max(j)] = i.min(j);
}
