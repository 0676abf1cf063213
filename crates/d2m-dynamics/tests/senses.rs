//! Who touches whom, and what bodies can be besides solid: sensors, belts, of several parts, with locked axes; questions about the present.

mod ground;

use d2m_bvh::{MeshTree, Mode, ProximityOptions, QueryOptions, StartState, TriMesh, Window};
use d2m_dynamics::{
    Body, BodyId, Groups, Joint, Kind, Mass, MassProperties, Part, Presence, RayAnswer, Simulation,
    SimulationError, SimulationOptions, TouchChange,
};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::ConstantTwist;
use d2m_world::{FirstContact, PlannedMotion};
use glam::{BVec3, DMat3, DVec3};
use ground::{at, cube, floor, rest, tree};
use std::sync::Arc;

/// A body that rests has begun to touch once, also while it sleeps; it ends when it is taken away.
#[test]
fn touches_begin_and_end_once() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let ground = simulation.add(&floor()).unwrap();
    let body = simulation.add(&Body::new("cube", cube()).with_position(DVec3::Y)).unwrap();
    let mut events = Vec::new();
    while !simulation.is_asleep(body) {
        events.extend(simulation.step().unwrap().touches);
    }
    for _ in 0..10 {
        events.extend(simulation.step().unwrap().touches);
    }
    assert!(
        matches!(events[..], [event] if event.change == TouchChange::Began && (event.a, event.b) == (ground, body))
    );
    assert!(simulation.touch(body, ground));
    simulation.set_pose(body, at(0.0, 3.0, 0.0)).unwrap();
    let events: Vec<_> = (0..3).flat_map(|_| simulation.step().unwrap().touches).collect();
    assert!(matches!(events[..], [event] if event.change == TouchChange::Ended), "{events:?}");
    rest(&mut simulation, body);
    simulation.remove(body);
    let events = simulation.step().unwrap().touches;
    assert!(
        matches!(events[..], [event] if event.change == TouchChange::Ended && event.b == body),
        "{events:?}"
    );
}

/// Bodies that can no longer collide, as two that have become static, end their touch: their distance is not measured any more.
#[test]
fn what_meets_no_more_touches_no_more() {
    let changes: [fn(&mut Simulation, [BodyId; 2]); 3] = [
        |simulation, [_, body]| simulation.set_kind(body, Kind::Static).unwrap(),
        |simulation, [ground, body]| simulation.ignore(ground, body),
        |simulation, [_, body]| simulation.set_groups(body, Groups { meets: 0, ..Groups::ALL }).unwrap(),
    ];
    for change in changes {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let ground = simulation.add(&floor()).unwrap();
        let body = simulation.add(&Body::new("cube", cube()).with_position(DVec3::Y)).unwrap();
        rest(&mut simulation, body);
        assert!(simulation.touch(ground, body));
        change(&mut simulation, [ground, body]);
        let ended = simulation.step().unwrap().touches;
        assert!(matches!(ended[..], [event] if event.change == TouchChange::Ended), "{ended:?}");
        simulation.set_pose(body, at(0.0, 30.0, 0.0)).unwrap();
        assert!(!simulation.touch(ground, body) && simulation.step().unwrap().touches.is_empty());
    }
}

/// Sensors meet nothing in questions about the present either: what is in one is no pair, and rays and plans pass through it.
#[test]
fn sensors_stand_in_nobodys_way() {
    for kind in [Kind::Static, Kind::Driven, Kind::Dynamic] {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        let zone = Body::new("zone", cube()).with_kind(kind).with_presence(Presence::Sensor);
        let zone = simulation.add(&zone).unwrap();
        let small = tree("box?x=0.1&y=0.1&z=0.1");
        let [inside, wall] = [("inside", 0.0), ("wall", 2.0)].map(|(name, x)| {
            let kind = if name == "wall" { Kind::Static } else { Kind::Dynamic };
            let body = Body::new(name, Arc::clone(&small)).with_position(DVec3::X * x).with_kind(kind);
            simulation.add_checked(&body).unwrap()
        });
        simulation.step().unwrap();
        let now = simulation.frozen(QueryOptions::default());
        let near = now.world().proximities(0.0, &ProximityOptions::new(3.0)).unwrap();
        let near: Vec<_> = near.iter().map(|pair| (now.id(pair.a), now.id(pair.b))).collect();
        assert_eq!(near, [(inside, wall)]);
        // Through the zone above what is in it.
        let up = DVec3::Y * 0.3;
        assert_eq!(now.ray(up - DVec3::X * 3.0, DVec3::X * 6.0).unwrap(), RayAnswer::Free);
        let hit = now.ray(DVec3::X * 0.3, DVec3::X * 6.0).unwrap();
        assert!(matches!(hit, RayAnswer::Hit { body, lo, .. } if body == wall && lo > 1.59), "{hit:?}");
        let plan = |x: f64| {
            let body = now.body(inside).unwrap();
            let motion = Arc::new(ConstantTwist::REST.with_linear_velocity(DVec3::X * x));
            now.world().first_contact_of(&[PlannedMotion { body, motion }], Window::UNIT).unwrap()
        };
        assert!(matches!(plan(-3.0), FirstContact::Separated));
        assert!(matches!(plan(3.0), FirstContact::Contact { contact, .. } if contact.time_lo > 0.59));
        // The distance of any two is known nevertheless.
        assert_eq!(now.distance(zone, inside).unwrap().lower, 0.0);
    }
}

/// What a sensor no longer looks for has left it.
#[test]
fn a_sensor_forgets_what_it_does_not_look_for() {
    let changes: [fn(&mut Simulation, [BodyId; 2]); 2] = [
        |simulation, [zone, body]| simulation.ignore(zone, body),
        |simulation, [zone, _]| simulation.set_groups(zone, Groups { meets: 0, ..Groups::ALL }).unwrap(),
    ];
    for change in changes {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        let zone = Body::new("zone", cube()).with_kind(Kind::Static).with_presence(Presence::Sensor);
        let zone = simulation.add(&zone).unwrap();
        let body = simulation.add(&Body::new("body", tree("box?x=0.1&y=0.1&z=0.1"))).unwrap();
        let began = simulation.step().unwrap().touches;
        assert!(matches!(began[..], [event] if event.change == TouchChange::Began), "{began:?}");
        change(&mut simulation, [zone, body]);
        let ended = simulation.step().unwrap().touches;
        assert!(matches!(ended[..], [event] if event.change == TouchChange::Ended), "{ended:?}");
        assert!(!simulation.touch(zone, body) && simulation.step().unwrap().touches.is_empty());
    }
}

/// A zone knows who is in it, to the time: also who passes within a step, who rests in it, who was put into it, and who is gone.
#[test]
fn sensors_know_who_is_in_them() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let zone =
        Body::new("zone", tree("box?x=1&y=2&z=1")).with_kind(Kind::Static).with_presence(Presence::Sensor);
    let zone = simulation.add(&zone.with_position(DVec3::Y * 2.0)).unwrap();
    let small = tree("box?x=0.1&y=0.1&z=0.1");
    let falling = Body::new("falling", Arc::clone(&small)).with_position(DVec3::Y * 6.0);
    let falling = simulation.add(&falling).unwrap();
    let passing = Body::new("passing", small).with_position(DVec3::new(-20.0, 3.0, 0.0));
    let passing = simulation.add(&passing.with_linear_velocity(DVec3::X * 1500.0)).unwrap();
    let mut events = Vec::new();
    while simulation.time() < 2.0 {
        events.extend(simulation.step().unwrap().touches.into_iter().filter(|touch| touch.a == zone));
    }
    let of = |id: BodyId| events.iter().filter(|touch| touch.b == id).collect::<Vec<_>>();
    let passed = of(passing);
    assert_eq!(
        passed.iter().map(|touch| touch.change).collect::<Vec<_>>(),
        [TouchChange::Began, TouchChange::Ended]
    );
    assert!((passed[0].time - 18.9 / 1500.0).abs() < 1e-6 && (passed[1].time - 21.1 / 1500.0).abs() < 1e-6);
    let fell = of(falling);
    // Its lower side is at 4 after a fall of 1.9.
    assert!(fell.len() == 1 && (fell[0].time - (2.0 * 1.9 / 9.81f64).sqrt()).abs() < 0.01, "{fell:?}");
    assert!(simulation.touch(zone, falling) && !simulation.touch(zone, passing));
    let before = simulation.snapshot();
    simulation.set_pose(falling, at(8.0, 3.0, 0.0)).unwrap();
    simulation.step().unwrap();
    assert!(!simulation.touch(zone, falling));
    simulation.restore(&before).unwrap();
    assert!(simulation.touch(zone, falling));
    simulation.remove(zone);
    let touches = simulation.step().unwrap().touches;
    assert!(touches.iter().any(|touch| touch.a == zone && touch.change == TouchChange::Ended));
}

/// Rays meet what is there now, not what is ignored by nothing else; the answers are those of the shapes.
#[test]
fn rays_meet_what_is_there_now() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let near = simulation.add(&Body::new("near", cube()).with_position(DVec3::X * 3.0)).unwrap();
    let far = simulation.add(&Body::new("far", cube()).with_position(DVec3::X * 6.0)).unwrap();
    let hit = |simulation: &Simulation, way: DVec3| {
        simulation.frozen(d2m_bvh::QueryOptions::default()).ray(DVec3::ZERO, way).unwrap()
    };
    let is_at = |answer: RayAnswer, id: BodyId, x: f64| {
        matches!(answer, RayAnswer::Hit { body, lo, hi, normal, .. }
            if body == id && lo <= x && x <= hi + 1e-9 && hi - lo < 1e-6 && (normal + DVec3::X).length() < 1e-6)
    };
    assert!(is_at(hit(&simulation, DVec3::X * 10.0), near, 2.5), "{:?}", hit(&simulation, DVec3::X * 10.0));
    assert_eq!(hit(&simulation, DVec3::X * 2.0), RayAnswer::Free);
    assert_eq!(hit(&simulation, DVec3::Y * 100.0), RayAnswer::Free);
    simulation.set_pose(near, at(3.0, 2.0, 0.0)).unwrap();
    assert!(is_at(hit(&simulation, DVec3::X * 10.0), far, 5.5));
    simulation.remove(far);
    assert_eq!(hit(&simulation, DVec3::X * 10.0), RayAnswer::Free);
    assert!(simulation.frozen(d2m_bvh::QueryOptions::default()).ray(DVec3::NAN, DVec3::X).is_err());
}

/// The length of a way is rounded: what is said to be free of it, and where it has met a body, holds for the true one.
#[test]
fn lengths_along_rays_are_rounded_outward() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    simulation.add(&Body::new("cube", cube()).with_position(DVec3::X * 3.0)).unwrap();
    let now = simulation.frozen(QueryOptions::default());
    let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap()));
    for k in 0..100 {
        let way = DVec3::new(10.0, 0.003 * f64::from(k), 0.2 - 0.0017 * f64::from(k));
        let motion = ConstantTwist::REST.with_linear_velocity(way);
        let mut world = now.world().clone();
        let body = world.add(d2m_world::Body::new(Arc::clone(&point), motion));
        let plan = [PlannedMotion { body, motion: Arc::new(motion) }];
        let found = world.first_contact_of(&plan, Window::UNIT).unwrap();
        let contact = found.contact().unwrap();
        let RayAnswer::Hit { lo, hi, .. } = now.ray(DVec3::ZERO, way).unwrap() else { panic!("{way}") };
        let along = |part: f64| IntervalVec3::point(way).norm() * Interval::point(part);
        assert!(lo <= along(contact.time_lo).lo() && along(contact.time_hi).hi() <= hi, "{way}");
    }
}

/// A ray that passes above a body, asked of searches that may stop early: what stops has met nothing.
#[test]
fn a_ray_that_stops_early_hits_nothing() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    simulation.add(&Body::new("cube", cube()).with_position(DVec3::X * 3.0)).unwrap();
    let now = simulation.frozen(QueryOptions::default().with_mode(Mode::Capoeira));
    let mut stopped = 0;
    for exponent in -26..0 {
        let origin = DVec3::Y * (0.5 + f64::from(exponent).exp2());
        match now.ray(origin, DVec3::new(10.0, 0.0, 0.1)).unwrap() {
            RayAnswer::Undecided { free_until } if free_until > 2.4 && free_until < 3.6 => stopped += 1,
            answer => assert_eq!(answer, RayAnswer::Free, "{exponent}"),
        }
    }
    assert!(stopped > 3, "{stopped}");
}

/// A belt takes along what lies on it, and on an awake island the one beside is not moved.
#[test]
fn belts_take_along_what_lies_on_them() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let belt = floor().with_surface_velocity(DVec3::X * 0.5);
    let belt = simulation.add(&belt).unwrap();
    let low =
        simulation.add(&Body::new("low", cube()).with_friction(0.5).with_position(DVec3::Y * 0.501)).unwrap();
    let high = simulation
        .add(&Body::new("high", cube()).with_friction(0.5).with_position(DVec3::Y * 1.502))
        .unwrap();
    while simulation.time() < 2.0 {
        let report = simulation.step().unwrap();
        assert!(report.residual < 1e-3, "{}", report.residual);
    }
    for body in [low, high] {
        assert!((simulation.linear_velocity(body) - DVec3::X * 0.5).length() < 1e-3);
        assert!(!simulation.is_asleep(body));
    }
    simulation.set_surface_velocity(belt, DVec3::ZERO).unwrap();
    rest(&mut simulation, low);
}

/// Ways and turns that are locked stay as they are, whatever pushes; the others are free.
#[test]
fn locked_axes_stay() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let body = Body::new("flat", cube()).with_position(DVec3::Y * 2.0).with_friction(0.5);
    let body =
        body.with_angular_velocity(DVec3::new(0.0, 0.0, 2.0)).with_linear_velocity(DVec3::new(1.0, 0.0, 2.0));
    let flat = simulation.add(&body).unwrap();
    let hit = simulation
        .add(&Body::new("hit", cube()).with_position(DVec3::new(3.0, 0.501, 0.3)).with_friction(0.5))
        .unwrap();
    let lock = BVec3::new(false, false, true);
    simulation.add_joint(&Joint::locks(flat, lock, !lock)).unwrap();
    let single = simulation.add(&Body::new("top", cube()).with_position(DVec3::new(-5.0, 3.0, 0.0))).unwrap();
    simulation.set_velocity(single, DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0)).unwrap();
    simulation.add_joint(&Joint::locks(single, BVec3::TRUE, BVec3::new(true, false, false))).unwrap();
    while simulation.time() < 2.0 {
        simulation.step().unwrap();
        let place = simulation.position(flat);
        let turn = simulation.orientation(flat);
        assert!(simulation.time() > 0.4 || (place.x - simulation.time()).abs() < 1e-9, "{place}");
        assert!(place.z.abs() < 1e-7 && turn.x.abs() < 1e-7 && turn.y.abs() < 1e-7, "{place} {turn}");
        assert!((simulation.position(single) - DVec3::new(-5.0, 3.0, 0.0)).length() < 1e-9);
        assert!(simulation.angular_velocity(single).x.abs() < 1e-6);
    }
    let place = simulation.position(flat);
    assert!(place.y < 1.3, "{place}");
    assert!(simulation.angular_velocity(single).y.abs() > 1.0);
    let _ = hit;
}

/// A body of several meshes meets others with each of them, and lies where its weight has it.
#[test]
fn bodies_of_parts_meet_with_each_of_them() {
    let (plate, leg) =
        (d2m_shapes::mesh("box?x=1&y=0.1&z=1").unwrap(), d2m_shapes::mesh("box?x=0.1&y=0.5&z=0.1").unwrap());
    let legs = [-0.8, 0.8].into_iter().flat_map(|x| [-0.8, 0.8].map(|z| DVec3::new(x, -0.7, z)));
    let mut parts = vec![Part::new(&plate)];
    parts.extend(legs.map(|position| Part { position, ..Part::new(&leg) }));
    let table = Body::of_parts("table", &parts).unwrap().with_friction(0.5).with_position(DVec3::Y * 1.3);
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let table = simulation.add_checked(&table).unwrap();
    // Under the table, beside its legs.
    let below = Body::new("below", tree("box?x=0.3&y=0.3&z=0.3")).with_position(DVec3::Y * 0.31);
    let below = simulation.add_checked(&below).unwrap();
    rest(&mut simulation, table);
    let bottom = simulation.pose(table).transform_point(DVec3::Y * -1.2);
    assert!((bottom.y - 1e-3).abs() < 1e-4 && simulation.position(below).y < 0.302, "{bottom}");
    let mass = simulation.mass_properties(table).unwrap().mass;
    assert!((mass - 1000.0 * (0.8 + 4.0 * 0.04)).abs() < 1e-9, "{mass}");
}

/// What a solid holds is in it, also a mere surface: it is sensed there, and may not begin there.
#[test]
fn surfaces_inside_of_solids_are_in_them() {
    let sheet = || {
        let leaf =
            TriMesh::try_new(vec![DVec3::ZERO, DVec3::X * 0.1, DVec3::Y * 0.1], vec![[0, 1, 2]]).unwrap();
        let mass = MassProperties::try_new(1.0, DVec3::ZERO, DMat3::IDENTITY).unwrap();
        Body::new("sheet", Arc::new(MeshTree::new(leaf))).with_mass(Mass::Given(mass))
    };
    for speed in [0.0, 1.0] {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        let zone = Body::new("zone", cube()).with_kind(Kind::Static).with_presence(Presence::Sensor);
        let zone = simulation.add(&zone).unwrap();
        let sheet = simulation.add(&sheet().with_linear_velocity(DVec3::Z * speed)).unwrap();
        let between = simulation.frozen(QueryOptions::default()).distance(zone, sheet).unwrap();
        assert!((between.lower, between.state) == (0.0, StartState::Contained), "{between:?}");
        let mut left = None;
        while simulation.time() < 0.8 {
            for touch in simulation.step().unwrap().touches {
                assert_eq!((touch.a, touch.b), (zone, sheet));
                left = (touch.change == TouchChange::Ended).then_some(touch.time);
            }
            assert!(simulation.touch(zone, sheet) == left.is_none(), "{left:?} at {}", simulation.time());
        }
        // It leaves the cube's side at half a unit of time.
        assert!(
            left.is_none() == (speed == 0.0) && left.is_none_or(|time| (time - 0.5).abs() < 1e-6),
            "{left:?}"
        );
    }
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&Body::new("cube", cube())).unwrap();
    let refused = simulation.add_checked(&sheet());
    assert!(
        matches!(refused, Err(SimulationError::Intersecting { depth, .. }) if depth > 0.3),
        "{refused:?}"
    );
    let beside = sheet().with_position(DVec3::X * 0.6);
    let beside = simulation.add_checked(&beside).unwrap();
    assert!(simulation.set_pose(beside, at(0.1, 0.1, 0.1)).is_err() || simulation.step().is_err());
}
