//! A limit on the instruction set changes no bit of any answer.

mod scenes;

use d2m_bvh::{
    InstructionSet, MeshTree, Mode, Moving, Posed, QueryOptions, Solid, collide, distance, time_of_contact,
};
use d2m_motion::RigidMotion;

/// Every answer to every scene, as text that shows all bits.
fn answers() -> Vec<String> {
    let mut found = vec![];
    for scene in scenes::all() {
        let trees = scene.meshes.clone().map(MeshTree::new);
        let moving = |i: usize| Moving::new(&trees[i], &scene.motions[i]);
        for mode in [Mode::Accurate, Mode::Capoeira] {
            let options = QueryOptions::DEFAULT.with_solid(scene.solid).with_mode(mode);
            found.push(format!("{:?}", time_of_contact(moving(0), moving(1), scene.window, &options)));
        }
        let posed = |i: usize| Posed::new(&trees[i], scene.motions[i].pose_and_twist(scene.window.start()).0);
        found.push(format!("{:?}", collide(posed(0), posed(1), Solid::Surface)));
        found.push(format!("{:?}", distance(posed(0), posed(1), Solid::Surface)));
    }
    found
}

#[test]
fn a_limit_changes_no_bit_of_any_answer() {
    let sets = InstructionSet::available();
    assert_eq!(sets[0], InstructionSet::Portable);
    assert_eq!(InstructionSet::in_use(), sets[sets.len() - 1], "the best one unless limited");
    let best = answers();
    for set in sets {
        set.limit();
        assert_eq!(InstructionSet::in_use(), set);
        assert_eq!(answers(), best, "{set:?}");
    }
    InstructionSet::Avx512.limit();
}
