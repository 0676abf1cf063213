//! Trees that were built, refitted, written and broken.

use super::node::{Below, WIDTH};
use super::slabs::{PAIRS, STEPS};
use super::*;
use crate::TriMesh;
use crate::margin::UNIT_F64;
use d2m_lanes::two_sum;
use d2m_testing::{Draw, KnuthRandom};
use glam::DVec3;

/// A closed torus-like surface of 2·across·around triangles with some noise.
pub(crate) fn torus(across: u32, around: u32, noise: f64, map: impl Fn(DVec3) -> DVec3) -> TriMesh {
    let mut random = KnuthRandom(u64::from(across));
    let noisy = d2m_testing::Surface::torus(across, around, 0.4).map(|p| map(p + random.vector() * noise));
    noisy.into_mesh(TriMesh::try_new)
}

fn hard_meshes() -> Vec<TriMesh> {
    let mut random = KnuthRandom(11);
    let one = |corners: Vec<DVec3>| d2m_testing::Surface::soup(corners).into_mesh(TriMesh::try_new);
    let shift = DVec3::splat(1e6);
    vec![
        torus(40, 20, 0.01, |p| p),
        torus(90, 60, 0.0, |p| p * 1e-6),
        torus(12, 9, 0.1, |p| p * 1e6 + shift),
        torus(30, 20, 0.0, |p| p * DVec3::new(1.0, 1e-6, 1e3)),
        torus(9, 5, 0.0, |p| p * 1e-250),
        one(vec![DVec3::ZERO; 3]),
        one(vec![DVec3::splat(0.1); 30]),
        one((0..300).map(|i| DVec3::X * f64::from(i)).collect()),
        one((0..300).map(|_| random.vector() * 1e50).collect()),
        one((0..27).map(|i| random.vector() * 10f64.powi(-i)).collect()),
    ]
}

#[test]
fn built_and_refitted_trees_are_valid() {
    let mut random = KnuthRandom(4);
    for (index, mesh) in hard_meshes().into_iter().enumerate() {
        let mut tree = MeshTree::new(mesh);
        assert_eq!(tree.validate(), Ok(()), "mesh {index}");
        let moved = tree.mesh().vertices().iter().map(|&p| p + random.vector() * 0.3 * p.length()).collect();
        tree.refit(moved).unwrap();
        assert_eq!(tree.validate(), Ok(()), "mesh {index} refitted");
        let before = tree.clone();
        assert!(tree.refit(vec![DVec3::NAN; 3]).is_err());
        assert_eq!(tree.mesh(), before.mesh());
        assert_eq!(tree.validate(), Ok(()));
    }
}

/// Boxes against vertices in twice the precision: sums of two doubles, errors below 2⁻⁹⁸ of the terms.
#[test]
fn boxes_enclose_in_more_than_double_precision() {
    fn add(a: (f64, f64), b: f64) -> (f64, f64) {
        let s = two_sum(a.0, b);
        two_sum(s.0, s.1 + a.1)
    }
    // A double with at most 24 bits times another double: split it so that both products are exact.
    fn mul24(a: (f64, f64), b: f64) -> (f64, f64) {
        let high = f64::from(a.0 as f32);
        let (rest, low) = (a.0 - high, a.1);
        add(two_sum(high * b, rest * b), low * b)
    }
    let mut tightest = f64::INFINITY;
    // Of what is cut off the edges: how many, and how near it comes.
    let (mut cut_off, mut nearest) = (0, f64::INFINITY);
    for mesh in hard_meshes().into_iter().take(4) {
        let tree = MeshTree::new(mesh);
        for leaf in &tree.nodes {
            for lane in 0..leaf.used as usize {
                let Below::Triangle(triangle) = leaf.below(lane) else { continue };
                for corner in tree.mesh.corners(triangle as usize) {
                    let (mut node, mut lane) = (leaf, lane);
                    loop {
                        let boxed = node.oriented_box(lane);
                        let q = [0, 1, 2].map(|k| {
                            let (high, low) = two_sum(corner[k], -tree.center[k]);
                            let local = (high / tree.unit, low / tree.unit);
                            add(add(local, -f64::from(node.origin[k])), -f64::from(boxed.center[k]))
                        });
                        let mut along = [0.0; 3];
                        for (i, place) in along.iter_mut().enumerate() {
                            let mut sum = (0.0, 0.0);
                            for (k, part) in q.iter().enumerate() {
                                let term = mul24(*part, f64::from(boxed.axes[i][k]));
                                sum = add(add(sum, term.0), term.1);
                            }
                            *place = sum.0;
                            let left = f64::from(boxed.half_extent[i]) - sum.0.abs();
                            assert!(left > 0.0, "{left:e}");
                            tightest = tightest.min(left);
                        }
                        for (&(i, j), cuts) in PAIRS.iter().zip(&boxed.slabs) {
                            let half = [i, j].map(|k| f64::from(boxed.half_extent[k]));
                            for (place, &cut) in cuts.iter().enumerate().filter(|(_, cut)| **cut > 0) {
                                let sign = |bit: usize| if place & bit == 0 { 1.0 } else { -1.0 };
                                let at = sign(1) * along[i] / half[0] + sign(2) * along[j] / half[1];
                                let room = (2.0 - f64::from(cut) / f64::from(STEPS)) - at;
                                // Errors of this sum are below 1e-15.
                                assert!(room > 1e-12, "{room:e}");
                                (cut_off, nearest) = (cut_off + 1, nearest.min(room));
                            }
                        }
                        if std::ptr::eq(node, &raw const tree.nodes[0]) {
                            break;
                        }
                        let parent = node.parent as usize;
                        (node, lane) = (&tree.nodes[parent / WIDTH], parent % WIDTH);
                    }
                }
            }
        }
    }
    // Boxes are not too wide: somewhere only the slack is left.
    assert!(tightest < 64.0 * UNIT_F64, "{tightest:e}");
    assert!(cut_off > 1000 && nearest < 1e-4, "{cut_off} {nearest:e}");
}

/// Cuts one step more off an edge of the first box of a node.
fn cut_more(tree: &mut MeshTree, node: usize) {
    let bits = tree.nodes[node].slabs[0][0].to_bits();
    tree.nodes[node].slabs[0][0] = f32::from_bits(bits + 1);
}

#[test]
fn any_shrunk_or_broken_tree_is_refused() {
    let tree = MeshTree::new(torus(20, 10, 0.01, |p| p));
    type Damage = fn(&mut MeshTree);
    let damages: [(&str, Damage); 20] = [
        ("half extent", |t| t.nodes[3].half_extent[1][2] *= 0.999),
        ("half extent of the root", |t| t.nodes[0].half_extent[0][0] *= 1.0 - 1e-6),
        ("edge of a part", |t| cut_more(t, 2)),
        ("edge of a triangle", |t| {
            let leaf = t.nodes.iter().position(|n| matches!(n.below(1), Below::Triangle(_))).unwrap();
            cut_more(t, leaf);
        }),
        ("radius", |t| t.nodes[2].radius[0] *= 0.999),
        ("center", |t| t.nodes[5].center[0][1] += 1e-3),
        ("axis", |t| t.nodes[5].axes[0][0][1] *= 1.000_001),
        ("not a number", |t| t.nodes[5].axes[1][0][1] = f32::NAN),
        ("origin", |t| t.nodes[4].origin[1] += 1e-3),
        ("extent", |t| t.nodes[4].extent *= 0.9),
        ("link", |t| t.nodes[1].child[0] = 1),
        ("node beyond the end", |t| t.nodes[1].child[0] = 1 << 20),
        ("parent", |t| t.nodes[3].parent += 1),
        ("repeated triangle", |t| {
            let leaf = t.nodes.iter().position(|n| matches!(n.below(1), Below::Triangle(_))).unwrap();
            t.nodes[leaf].child[0] = t.nodes[leaf].child[1];
        }),
        ("tree radius", |t| t.radius *= 0.9),
        ("huge tree radius", |t| t.radius = t.unit * 8.0),
        ("all in units of eight times the body", |t| {
            (t.radius, t.unit) = (t.unit * 8.0, t.unit * 8.0);
            for node in &mut t.nodes {
                let used = node.used as usize;
                node.origin = node.origin.map(|x| x / 8.0);
                node.extent /= 8.0;
                node.radius[..used].iter_mut().for_each(|x| *x /= 8.0);
                for row in node.center.iter_mut().chain(&mut node.half_extent) {
                    row[..used].iter_mut().for_each(|x| *x /= 8.0);
                }
            }
        }),
        ("huge box", |t| {
            for k in 0..3 {
                t.nodes[0].half_extent[k][0] = 1e20;
            }
            (t.nodes[0].radius[0], t.nodes[0].extent) = (2e20, 4e20);
        }),
        ("distant origin", |t| {
            let node = &mut t.nodes[0];
            (node.origin[0], node.center[0][0]) = (node.origin[0] + 64.0, node.center[0][0] - 64.0);
            (node.half_extent[0][0], node.radius[0], node.extent) = (2.0, 3.0, 70.0);
        }),
        ("lane that is not used", |t| {
            t.nodes[0].center[0][3] = 0.0;
        }),
    ];
    assert_eq!(tree.validate(), Ok(()));
    for (what, damage) in damages {
        let mut broken = tree.clone();
        damage(&mut broken);
        assert!(broken.validate().is_err(), "{what}");
    }
}

/// A hundred-thousandth less than what was rounded up by one part in ten million is too little, in every direction.
#[test]
fn each_box_is_checked_against_each_vertex_below_it() {
    let mut tree = MeshTree::new(torus(14, 9, 0.02, |p| p));
    for node in 0..tree.nodes.len() {
        for lane in 0..tree.nodes[node].used as usize {
            for axis in 0..3 {
                let half = tree.nodes[node].half_extent[axis][lane];
                tree.nodes[node].half_extent[axis][lane] = half * (1.0 - 1e-5);
                let found = tree.validate();
                assert!(
                    matches!(found, Err(TreeError::Enclosure { node: n, lane: l, .. }) if (n, l) == (node, lane)),
                    "axis {axis} of box {lane} of node {node}: {found:?}"
                );
                tree.nodes[node].half_extent[axis][lane] = half;
            }
        }
    }
    assert_eq!(tree.validate(), Ok(()));
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    let mesh = torus(150, 60, 0.01, |p| p);
    let bits = |tree: &MeshTree| format!("{:?}", tree.nodes);
    let tree = MeshTree::new(mesh.clone());
    assert_eq!(tree.validate(), Ok(()));
    #[cfg(feature = "rayon")]
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert!(bits(&tree) == bits(&pool.install(|| MeshTree::new(mesh.clone()))), "{threads} threads");
    }
    let most = std::sync::atomic::AtomicUsize::new(0);
    let reported = MeshTree::with_progress(mesh, &|done, all| {
        assert_eq!(all, 18_000);
        most.fetch_max(done, std::sync::atomic::Ordering::Relaxed);
    });
    assert_eq!(most.into_inner(), 18_000);
    assert!(bits(&tree) == bits(&reported));
    assert!(tree.memory_bytes() <= 110 * 18_000, "{}", tree.memory_bytes() / 18_000);
}

#[test]
fn moved_surfaces_keep_their_order() {
    // A part of one triangle has its own axes: the box of a leaf is flat.
    let mesh = torus(6, 5, 0.0, |p| p);
    let tree = MeshTree::new(mesh.clone());
    for node in &tree.nodes {
        for lane in 0..node.used as usize {
            let boxed = node.oriented_box(lane);
            if let Below::Triangle(_) = node.below(lane) {
                assert!(boxed.half_extent[2] < 1e-6 && boxed.half_extent[0] > 0.05, "{boxed:?}");
            }
        }
    }
    let mut same = tree.clone();
    same.refit(mesh.vertices().to_vec()).unwrap();
    assert_eq!(same.nodes.len(), tree.nodes.len());
    for (x, y) in same.nodes.iter().zip(&tree.nodes) {
        assert_eq!((x.child, x.used, x.parent), (y.child, y.used, y.parent));
    }
}

#[test]
fn vertices_that_come_together_or_part_close_and_open_a_moved_surface() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let together: Vec<DVec3> =
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].into_iter().flatten().map(|i| corners[i]).collect();
    let apart: Vec<DVec3> = (0..).zip(&together).map(|(i, p)| p + DVec3::X * (1e-3 * f64::from(i))).collect();
    let mut tree = MeshTree::new(d2m_testing::Surface::soup(apart.clone()).into_mesh(TriMesh::try_new));
    assert!(!tree.is_watertight() && tree.components.len() == 4);
    for _ in 0..2 {
        tree.refit(together.clone()).unwrap();
        assert!(tree.is_watertight() && tree.components.len() == 1);
        tree.refit(apart.clone()).unwrap();
        assert!(!tree.is_watertight() && tree.components.len() == 4);
        tree.refit(apart.iter().map(|p| p * 2.0).collect()).unwrap();
        assert!(!tree.is_watertight() && tree.components.len() == 4);
    }
}

/// A JSON library that reads and writes numbers with fifteen digits (or as `f32`, or one off in the last place) changes
/// nothing that was written.
#[cfg(feature = "serde")]
#[test]
fn a_written_tree_holds_no_number_that_a_json_library_may_round() {
    fn is_kept(value: &serde_json::Value) -> bool {
        match value {
            serde_json::Value::Number(number) => number.as_u64().is_some_and(|number| number < 1 << 53),
            serde_json::Value::Array(values) => values.iter().all(is_kept),
            serde_json::Value::Object(values) => values.values().all(is_kept),
            _ => true,
        }
    }
    let tree = MeshTree::new(torus(30, 12, 0.01, |p| p));
    assert!(is_kept(&serde_json::to_value(&tree).unwrap()));
    assert!(is_kept(&serde_json::to_value(tree.mesh()).unwrap()));
    let read: TriMesh = serde_json::from_str(
        r#"{"vertices": [[0, -1, 0.5], ["1e-300", "0.1", "2"], [1, 1, 1]], "triangles": [[0, 1, 2]]}"#,
    )
    .unwrap();
    assert_eq!(read.vertices()[..2], [DVec3::new(0.0, -1.0, 0.5), DVec3::new(1e-300, 0.1, 2.0)]);
    let refused = |number: &str| {
        let text = format!(r#"{{"vertices": [["{number}", 0, 0]], "triangles": [[0, 0, 0]]}}"#);
        serde_json::from_str::<TriMesh>(&text).unwrap_err().to_string()
    };
    assert!(refused("inf").contains("not a finite number"), "{}", refused("inf"));
    assert!(refused("one").contains("one"), "{}", refused("one"));
}
