use super::*;

/// Every family gives contacts and misses, a scene survives its written form, and broken answers are noticed.
#[test]
fn broken_answers_to_hostile_scenes_are_noticed() {
    let count = 10 * families::FAMILIES.len();
    let task = |sabotage| Task { count, seed: 5, lies: 0, sabotage };
    let right = run(&task(None));
    assert_eq!(right.false_negatives, [""; 0], "{right:?}");
    assert_eq!(right.false_alarms, [""; 0], "{right:?}");
    assert!(3 * right.contacts > count && right.contacts < count, "{right:?}");
    for sabotage in [Sabotage::Miss, Sabotage::Late(1e-3)] {
        let broken = run(&task(Some(sabotage)));
        assert!(3 * broken.false_negatives.len() > right.contacts, "{sabotage:?}: {broken:?}");
    }
}

#[test]
fn a_scene_survives_its_written_form() {
    for (k, (name, family)) in families::FAMILIES.iter().enumerate() {
        let scene = family(&mut Random::new(k as u64));
        let read =
            HostileScene::from_json(&serde_json::from_str(&scene.to_json().to_string()).unwrap()).unwrap();
        assert_eq!(format!("{scene:?}"), format!("{read:?}"), "{name}");
        assert_eq!(scene.query_often(1).answer, read.query_often(1).answer, "{name}");
    }
}
