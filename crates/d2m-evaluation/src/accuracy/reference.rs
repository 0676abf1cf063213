//! The reference method and the engine on random small scenes, both judged by certified static distances.
use super::{Outcome, Task};
use d2m::bvh::Topology;
use d2m::{QueryOptions, Solid, TriMesh, Window};
use d2m_paper::{CrossCheck, cross_check};
use d2m_testing::{SmallScene, Surface};

pub(super) fn run(task: &Task) -> Outcome {
    let mut found = CrossCheck::default();
    for index in 0..task.count as u64 {
        let scene =
            SmallScene::draw(task.seed, index, |surface| Topology::new(&mesh(surface)).is_watertight());
        let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
        let window = Window::try_new(scene.window[0], scene.window[1]).expect("in order");
        let options = QueryOptions::DEFAULT.with_solid(solid);
        let meshes = scene.surfaces.each_ref().map(mesh);
        found.add(cross_check(&scene.name, meshes, scene.motions, window, &options));
    }
    Outcome {
        cases: found.scenes,
        contacts: found.contacts,
        undecided: found.undecided.iter().sum(),
        false_negatives: found.complaints,
        false_alarms: Vec::new(),
        by_oracle: 0,
        ..Outcome::default()
    }
}

fn mesh(surface: &Surface) -> TriMesh {
    surface.clone().into_mesh(TriMesh::try_new)
}
