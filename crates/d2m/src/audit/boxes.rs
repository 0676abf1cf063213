//! Do the boxes of a tree hold what is below them, in real arithmetic?
use super::{StoredBox, Tally, stored_boxes};
use crate::MeshTree;
use d2m_interval::{Interval, IntervalVec3};
use d2m_verify::Reason;
use glam::DVec3;

/// Steps of a cut in one half extent.
const STEPS: f64 = 64.0;
/// The axes whose faces meet in edges.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// What became of the statements about the boxes of a tree: one for each box and vertex below it, and a line for each that is false.
pub(super) fn check(tree: &MeshTree) -> (Tally, Vec<String>) {
    let (mut tally, mut lines) = (Tally::default(), Vec::new());
    let mesh = tree.mesh();
    for stored in stored_boxes(tree) {
        let mut vertices: Vec<u32> =
            stored.triangles.iter().flat_map(|&t| mesh.triangles()[t as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        for vertex in vertices {
            tally.reported += 1;
            tally.judged += 1;
            match holds(tree, &stored, mesh.vertices()[vertex as usize]) {
                Some(true) => tally.verified += 1,
                None => *tally.unproven.entry(Reason::TooClose).or_default() += 1,
                Some(false) => {
                    tally.refuted += 1;
                    lines.push(format!("box {} does not hold vertex {vertex}: {stored:?}", stored.number));
                }
            }
        }
    }
    (tally, lines)
}

/// Is a vertex in the box, its sphere, and what its node and its tree say of all boxes? `None`: not known.
fn holds(tree: &MeshTree, stored: &StoredBox, vertex: DVec3) -> Option<bool> {
    let from_tree = IntervalVec3::point(vertex) - IntervalVec3::point(tree.center());
    // The unit is a power of two.
    let local = from_tree * (1.0 / tree.unit());
    let wide = |v: [f32; 3]| IntervalVec3::point(DVec3::from_array(v.map(f64::from)));
    let from_origin = local - wide(stored.origin);
    let q = from_origin - wide(stored.center);
    let along = stored.axes.map(|axis| wide(axis).dot(q));
    let half = stored.half_extent.map(|h| Interval::point(f64::from(h)));
    let sum = stored.center.iter().fold(Interval::ZERO, |sum, c| sum + Interval::point(f64::from(c.abs())));
    let number = |x: f32| Interval::point(f64::from(x));
    let mut known = vec![
        within(from_tree.norm(), Interval::point(tree.radius())),
        within(q.norm(), number(stored.radius)),
        within(sum + number(stored.radius), number(stored.extent)),
    ];
    known.extend((0..3).map(|i| within(along[i].abs(), half[i])));
    for (pair, [i, j]) in PAIRS.into_iter().enumerate() {
        for (place, &cut) in stored.slabs[pair].iter().enumerate().filter(|(_, cut)| **cut > 0) {
            let signed = |x: Interval, bit: usize| if place & bit == 0 { x } else { -x };
            let reach = signed(along[i], 1) * half[j] + signed(along[j], 2) * half[i];
            let most = half[i] * half[j] * ((2.0 * STEPS - f64::from(cut)) / STEPS);
            known.push(within(reach, most));
        }
    }
    if known.contains(&Some(false)) {
        return Some(false);
    }
    (!known.contains(&None)).then_some(true)
}

fn within(x: Interval, most: Interval) -> Option<bool> {
    if x.hi() <= most.lo() {
        Some(true)
    } else if x.lo() > most.hi() {
        Some(false)
    } else {
        None
    }
}
