//! `collide` and `distance` at rest, against all pairs of triangles.
use super::mesh::{Shape, shape};
use super::{Outcome, Task};
use crate::judge::{BoxTree, Hint, Placement, separation};
use d2m::bvh::{MeshTree, Posed, Solid, TriMesh, collide, distance};
use d2m::motion::Pose;
use d2m_testing::Xoshiro256 as Random;
use glam::DVec3;

/// Of the scene's size: what the judge's own rounding explains.
const ROUNDING: f64 = 1e-12;

pub(super) fn run(task: &Task) -> Outcome {
    let mut outcome = Outcome::default();
    for index in 0..task.count {
        let mut random = Random::new(task.seed.wrapping_mul(0x51ed_2701).wrapping_add(index as u64));
        let shapes = [shape(&mut random), shape(&mut random)];
        let trees = shapes.each_ref().map(|s| BoxTree::build(&s.surface.vertices, &s.surface.triangles));
        let reach = trees[0].radius + trees[1].radius;
        let poses = [DVec3::ZERO, random.direction() * reach * random.range(0.0, 1.2)].map(|position| Pose {
            rotation: random.rotation(),
            translation: position,
            at: DVec3::ZERO,
        });
        let at = poses.map(|pose| Placement::new(pose.rotation, pose.translation));
        let least = separation(&trees[0], &trees[1], &at[0], &at[1], &mut Hint::default());

        let tree = |s: &Shape| MeshTree::new(s.surface.clone().into_mesh(TriMesh::try_new));
        let ours = shapes.each_ref().map(tree);
        let posed = || (Posed::new(&ours[0], poses[0]), Posed::new(&ours[1], poses[1]));
        let (a, b) = posed();
        let hit = collide(a, b, Solid::Surface).expect("valid input");
        let found = distance(a, b, Solid::Surface).expect("valid input");
        outcome.cases += 1;
        outcome.contacts += usize::from(least == 0.0);
        let line = |words: &str| format!("seed {} case {index}: {words}: {least:e}, {found:?}", task.seed);
        if least == 0.0 && !hit {
            outcome.false_negatives.push(line("surfaces cross, collide denies it"));
        }
        if least > ROUNDING * reach && hit {
            outcome.false_alarms.push(line("surfaces are apart, collide denies it"));
        }
        if found.lower > least + ROUNDING * reach {
            outcome.false_negatives.push(line("the distance is smaller than its lower bound"));
        }
        if found.upper < least - ROUNDING * reach {
            outcome.false_alarms.push(line("the distance is larger than its upper bound"));
        }
    }
    outcome
}
