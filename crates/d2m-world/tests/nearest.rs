//! The nearest pair of a world, the pairs below a limit and the spans of all, against each pair by itself.

use d2m_bvh::{
    ClearanceOptions, ContactSpan, MeshTree, QueryOptions, Solid, SpanStatus, TriMesh, Window, clearance,
    contact_spans,
};
use d2m_motion::{ConstantTwist, Keyframes, Pose, Span};
use d2m_testing::{Draw, KnuthRandom};
use d2m_world::{Body, Group, PlannedMotion, World, join_spans};
use glam::{DQuat, DVec3};
use std::sync::Arc;

fn world(random: &mut KnuthRandom, count: usize) -> World {
    let mesh = |shape: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()));
    let trees = [
        mesh("box?x=0.3&y=0.2&z=0.5"),
        mesh("torus?triangles=300"),
        Arc::new(MeshTree::new(TriMesh::segment(-DVec3::Y, DVec3::Y).unwrap())),
    ];
    let mut world = World::new(QueryOptions::default().with_min_separation(0.05));
    for k in 0..count {
        let body = |random: &mut KnuthRandom| {
            let (place, turn) = (random.vector() * 4.0, DQuat::from_scaled_axis(random.vector() * 2.0));
            let motion = ConstantTwist::try_new(place, turn, random.vector() * 3.0, random.vector() * 2.0);
            Body::new(Arc::clone(&trees[k % 3]), motion.unwrap())
        };
        let radius = if k % 3 == 2 { 0.25 } else { 0.0 };
        let body = body(random).with_radius(radius).with_solid(d2m_bvh::Solid::Surface);
        world.add(if k % 4 == 0 { body.with_group(Group(1)) } else { body });
    }
    world.ignore_groups(Group(1), Group(1), true);
    world
}

#[test]
fn as_all_pairs_one_by_one() {
    let mut random = KnuthRandom(29);
    let options = ClearanceOptions::default().with_accuracy(1e-4);
    let (mut met, mut apart) = (0, 0);
    for round in 0..24 {
        let world = world(&mut random, 4 + round % 5);
        let ids: Vec<_> = world.ids().collect();
        let ignored = |a: usize, b: usize| a.is_multiple_of(4) && b.is_multiple_of(4);
        let pairs = (0..ids.len()).flat_map(|a| (a + 1..ids.len()).map(move |b| [a, b]));
        let pairs: Vec<_> = pairs.filter(|[a, b]| !ignored(*a, *b)).collect();
        let each = |[a, b]: [usize; 2]| {
            let [a, b] = [a, b].map(|k| world.body(ids[k]).moving());
            clearance(a, b, Window::UNIT, &options).unwrap()
        };
        let all: Vec<_> = pairs.iter().map(|&pair| (pair, each(pair))).collect();
        let least = |end: fn(&d2m_bvh::Clearance) -> f64| {
            all.iter().map(|(_, c)| end(c)).fold(f64::INFINITY, f64::min)
        };
        let (lower, upper) = (least(|c| c.lower), least(|c| c.upper));
        let found = world.nearest_pair(Window::UNIT, &options).unwrap().expect("there are pairs");
        // Both enclose the same number, and the pair attains its upper end.
        let nearest = found.clearance;
        assert!(nearest.lower <= upper && lower <= nearest.upper, "round {round}: {nearest:?}");
        assert!(nearest.upper - nearest.lower <= 1e-4 * nearest.upper + 1e-8, "round {round}: {nearest:?}");
        let of_pair =
            all.iter().find(|([a, b], _)| [ids[*a], ids[*b]] == [found.a, found.b]).expect("not ignored");
        assert!(of_pair.1.lower <= nearest.upper && nearest.lower <= of_pair.1.upper, "round {round}");
        met += u32::from(nearest.upper == 0.0);
        apart += u32::from(nearest.lower > 0.1);
        // Pairs below a limit: none is left out, and none is in that is proven above.
        let below = world.clearances_below(1.0, Window::UNIT, &options).unwrap();
        for ([a, b], of) in &all {
            let is_listed = below.iter().any(|found| [found.a, found.b] == [ids[*a], ids[*b]]);
            assert!(is_listed || of.upper >= 1.0, "round {round}: {a} {b} {of:?}");
            assert!(!is_listed || of.lower <= 1.0, "round {round}: {a} {b} {of:?}");
        }
        assert!(below.windows(2).all(|two| two[0].clearance.upper <= two[1].clearance.upper));
        // Of a plan only the pairs of its bodies count.
        let plan = [PlannedMotion { body: ids[1], motion: world.body(ids[1]).shared_motion() }];
        let planned = world.nearest_pair_of(&plan, Window::UNIT, &options).unwrap().expect("it has pairs");
        let least = all
            .iter()
            .filter(|(pair, _)| pair.contains(&1))
            .map(|(_, c)| c.upper)
            .fold(f64::INFINITY, f64::min);
        assert!(planned.a == ids[1] || planned.b == ids[1]);
        assert!(planned.clearance.lower <= least && least <= planned.clearance.upper * (1.0 + 1e-3) + 1e-8);
    }
    assert!(met > 3 && apart > 3, "{met} {apart}");
}

#[test]
fn spans_are_clear_where_all_pairs_are() {
    let mut random = KnuthRandom(31);
    let (mut clear, mut contact) = (0, 0);
    for round in 0..12 {
        let world = world(&mut random, 4 + round % 4);
        let ids: Vec<_> = world.ids().collect();
        let listed = world.contact_spans(Window::UNIT, Some(1e-3)).unwrap();
        let joined = join_spans(Window::UNIT, &listed);
        assert!((joined[0].from, joined.last().unwrap().to) == (0.0, 1.0), "{joined:?}");
        assert!(joined.windows(2).all(|two| two[0].to == two[1].from && two[0].status != two[1].status));
        let holding = |spans: &[ContactSpan], time: f64| -> Vec<SpanStatus> {
            spans.iter().filter(|span| span.from <= time && time <= span.to).map(|span| span.status).collect()
        };
        let options = world.options().with_min_separation(0.05);
        for a in 0..ids.len() {
            for b in (a + 1..ids.len()).filter(|b| !(a.is_multiple_of(4) && b.is_multiple_of(4))) {
                let [one, two] = [a, b].map(|k| world.body(ids[k]).moving());
                let own = contact_spans(one, two, Window::UNIT, &options, Some(1e-3)).unwrap();
                let is_listed = listed.iter().any(|pair| [pair.a, pair.b] == [ids[a], ids[b]]);
                assert_eq!(
                    is_listed,
                    own.iter().any(|span| span.status != SpanStatus::Clear),
                    "{round}: {a} {b}"
                );
                for k in 0..=200 {
                    let time = f64::from(k) / 200.0;
                    let is_clear = holding(&joined, time).contains(&SpanStatus::Clear);
                    assert!(
                        !is_clear || holding(&own, time).contains(&SpanStatus::Clear),
                        "{round}: {a} {b} at {time}"
                    );
                }
            }
        }
        clear += joined.iter().filter(|span| span.status == SpanStatus::Clear).count();
        contact += joined.iter().filter(|span| span.status == SpanStatus::Contact).count();
    }
    assert!(clear > 5 && contact > 5, "{clear} {contact}");
}

/// What a body is that does not say so, the options of the world say, also for clearances, whatever those are asked with.
#[test]
fn clearances_take_bodies_for_what_the_world_takes_them_for() {
    let tree = |half: f64| {
        Arc::new(MeshTree::new(d2m_shapes::mesh(&format!("box?x={half}&y={half}&z={half}")).unwrap()))
    };
    for (solid, is_met) in [(Solid::Filled, true), (Solid::Surface, false)] {
        let mut world = World::new(QueryOptions::default().with_solid(solid));
        for half in [1.0, 0.25] {
            world.add(Body::new(tree(half), ConstantTwist::REST));
        }
        assert_eq!(world.contacts(Window::UNIT).unwrap().len() == 1, is_met);
        for asked in [Solid::Filled, Solid::Surface] {
            let options = ClearanceOptions::default().with_solid(asked);
            let nearest = world.nearest_pair(Window::UNIT, &options).unwrap().unwrap();
            assert_eq!(nearest.clearance.lower == 0.0, is_met, "{nearest:?}");
            let below = world.clearances_below(0.5, Window::UNIT, &options).unwrap();
            assert_eq!(below.len() == 1, is_met);
        }
    }
}

#[test]
fn motions_that_do_not_cover_the_window_are_named() {
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box").unwrap()));
    let mut world = World::new(QueryOptions::default());
    world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    let short = Keyframes::try_new(&[(0.0, Pose::IDENTITY), (0.5, Pose::IDENTITY)], Span::Linear).unwrap();
    world.add(Body::new(cube, short));
    let options = ClearanceOptions::default();
    assert!(world.nearest_pair(Window::UNIT, &options).unwrap_err().to_string().starts_with("body 1: "));
    assert!(world.clearances_below(1.0, Window::UNIT, &options).is_err());
    assert!(world.contact_spans(Window::UNIT, None).unwrap_err().to_string().starts_with("body 1: "));
    let half = Window::try_new(0.0, 0.5).unwrap();
    assert!(
        world.contact_spans(half, Some(0.0)).is_err()
            && world.nearest_pair(half, &options.with_accuracy(0.0)).is_err()
    );
}
