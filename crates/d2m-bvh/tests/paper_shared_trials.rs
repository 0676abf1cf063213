//! The reference method on real meshes, where they are at hand (`../shared` beside the workspace).

use d2m_bvh::paper::{Moving, SphereTree, time_of_contact};
use d2m_bvh::{QueryOptions, TimeOfContact, TriMesh, Window};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::path::Path;

const TRIALS: usize = 6;

fn load(path: &Path) -> TriMesh {
    let text = std::fs::read_to_string(path).unwrap();
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let index = |w: &str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
        match words.first() {
            Some(&"v") => {
                let c = |i: usize| words[i].parse().unwrap();
                vertices.push(DVec3::new(c(1), c(2), c(3)));
            }
            Some(&"f") => {
                let f: Vec<u32> = words[1..].iter().map(|w| index(w)).collect();
                triangles.extend((1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]]));
            }
            _ => {}
        }
    }
    TriMesh::try_new(vertices, triangles).unwrap()
}

fn numbers(path: &Path, skip: usize) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(skip).map(|l| l.split(',').map(|w| w.trim().parse().unwrap()).collect()).collect()
}

fn motion(c: &[f64]) -> ConstantTwist {
    let v = |i: usize| DVec3::new(c[i], c[i + 1], c[i + 2]);
    ConstantTwist::try_new(v(4), DQuat::from_xyzw(c[1], c[2], c[3], c[0]), v(7), v(10)).unwrap()
}

#[test]
fn times_agree_with_the_reference_times() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    if !shared.join("trials/reference").is_dir() {
        return;
    }
    for (a, b) in
        [("spot", "cow"), ("torus1", "torus2"), ("screw-big", "nut-big"), ("gear-solid", "gear-solid")]
    {
        let trees = [a, b].map(|n| SphereTree::new(load(&shared.join(format!("models/{n}.obj")))));
        for speed in ["4", "512"] {
            let file = format!("{a}__{b}__{speed}.csv");
            let trials = numbers(&shared.join("trials").join(&file), 0);
            let truth = numbers(&shared.join("trials/reference").join(&file), 1);
            for (row, known) in trials.iter().zip(&truth).take(TRIALS) {
                let motions = [motion(&row[..13]), motion(&row[13..])];
                let [x, y] = core::array::from_fn(|i| {
                    Moving::new(&trees[i], &motions[i] as &dyn d2m_motion::RigidMotion)
                });
                let answer = time_of_contact(x, y, Window::UNIT, &QueryOptions::DEFAULT).unwrap();
                match answer {
                    TimeOfContact::Separated => assert!(known[1].is_infinite(), "{file} {}", known[0]),
                    TimeOfContact::Contact(c) => {
                        assert!(c.separation > 0.0 && c.separation <= 3.3e-10, "{file} {}: {c:?}", known[0]);
                        let later = c.time_lo - known[1];
                        // Earlier only by what our larger separation takes; later by what their separation takes,
                        // and in grazing approaches that is long.
                        assert!(
                            later > -1e-8 && (later >= -1e-12 || c.separation > known[2]),
                            "{file} {}: {later:e}",
                            known[0]
                        );
                        assert!(later < 1e-6, "{file} {}: {later:e}", known[0]);
                    }
                    TimeOfContact::Undecided { .. } => panic!("{file} {}: undecided", known[0]),
                }
            }
        }
    }
}
