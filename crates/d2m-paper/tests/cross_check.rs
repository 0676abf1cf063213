//! Default engine, reference method and slow oracle on random small scenes.

use d2m_bvh::{QueryOptions, Solid, Topology, TriMesh, Window};
use d2m_paper::{CrossCheck, cross_check};
use d2m_testing::{SmallScene, Surface};

fn mesh(surface: &Surface) -> TriMesh {
    surface.clone().into_mesh(TriMesh::try_new)
}

#[test]
fn engine_and_reference_agree() {
    for seed in [101, 102] {
        let mut report = CrossCheck::default();
        for index in 0..120 {
            let scene =
                SmallScene::draw(seed, index, |surface| Topology::new(&mesh(surface)).is_watertight());
            let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
            let window = Window::try_new(scene.window[0], scene.window[1]).expect("in order");
            let meshes = scene.surfaces.each_ref().map(mesh);
            let options = QueryOptions::DEFAULT.with_solid(solid);
            report.add(cross_check(&scene.name, meshes, scene.motions, window, &options));
        }
        assert!(report.complaints.is_empty(), "{:#?}", report.complaints);
        assert!(report.contacts > 50, "{report:?}");
        assert_eq!(
            (report.undecided[1], report.open_brackets[1], report.loose_brackets[1]),
            (0, 0, 0),
            "{report:?}"
        );
    }
}
