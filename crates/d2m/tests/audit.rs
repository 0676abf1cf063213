//! Every conclusion of the engine, proven again: a bound that is too small by a part makes some of them false, however right the answers.

use d2m::audit::{Auditor, Effort, Findings, Place};
use d2m::{MeshTree, Moving, QueryOptions, Solid, TriMesh, Window, time_of_contact};
use d2m_testing::{SharpFamily, SharpScene};

const EFFORT: Effort = Effort { each: 64, most_steps: 1 << 12 };
/// For whole bodies that are close for long.
const MORE_STEPS: Effort = Effort { each: 8, most_steps: 1 << 14 };

fn options(scene: &SharpScene) -> QueryOptions {
    QueryOptions::default()
        .with_solid(Solid::Surface)
        .with_tolerance(scene.tolerance)
        .with_min_separation(scene.separation)
}

/// What the engine concludes in so many scenes of a family.
fn audit(family: SharpFamily, scenes: u64, effort: Effort) -> Findings {
    let auditor = Auditor::new(effort);
    for index in 0..scenes {
        let scene = SharpScene::draw(family, 1, index);
        auditor.begin(&format!("{family:?} {index}"));
        let trees = scene.surfaces.clone().map(|surface| MeshTree::new(surface.into_mesh(TriMesh::try_new)));
        for tree in &trees {
            auditor.check_boxes(tree);
        }
        let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
        let _ = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options(&scene)).unwrap();
    }
    auditor.take()
}

/// Nothing is false, and of these places so many conclusions are proven again.
fn expect(findings: &Findings, places: &[(Place, u64)]) {
    let counts = |place: &Place| findings.places.get(place).cloned().unwrap_or_default();
    assert_eq!(findings.refuted, Vec::<String>::new());
    for (place, least) in places {
        let tally = counts(place);
        assert!(tally.verified >= *least, "{}: {tally:?} {:?}", place.name(), findings.open);
    }
}

#[test]
fn accelerations_are_bounded() {
    let findings = audit(SharpFamily::Accelerations, 150, EFFORT);
    expect(&findings, &[(Place::NodePair, 300), (Place::TrianglePair, 300)]);
}

#[test]
fn turn_rates_are_bounded() {
    let findings = audit(SharpFamily::TurnRates, 150, EFFORT);
    expect(&findings, &[(Place::NodePair, 300), (Place::TrianglePair, 300)]);
}

#[test]
fn fast_turns_are_followed() {
    let findings = audit(SharpFamily::FastTurns, 60, EFFORT);
    expect(&findings, &[(Place::NodePair, 300), (Place::TrianglePair, 300), (Place::WholeSpan, 300)]);
}

#[test]
fn sweeps_stay_apart() {
    let findings = audit(SharpFamily::Sweeps, 24, EFFORT);
    expect(&findings, &[(Place::Sweep, 10)]);
}

#[test]
fn screws_stay_apart() {
    let findings = audit(SharpFamily::Screws, 40, MORE_STEPS);
    expect(&findings, &[(Place::Screw, 10)]);
}

#[test]
fn crowds_are_parted() {
    let findings = audit(SharpFamily::Crowds, 40, MORE_STEPS);
    expect(&findings, &[(Place::Crowd, 10), (Place::Backward, 10)]);
}

#[test]
fn cards_pass_through_each_other() {
    let findings = audit(SharpFamily::Decks, 60, EFFORT);
    expect(&findings, &[(Place::Backward, 100)]);
}
