//! Presses, jaws and rollers that leave little room, or none: what is crushed is proven to be, and all else goes on.

mod ground;

use d2m_bvh::{MeshTree, Solid, TriMesh};
use d2m_dynamics::{Body, Kind, Mass, MassProperties, Simulation, SimulationOptions, StepError};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Keyframes, Pose, RigidMotion, Span, Twist};
use glam::{DMat3, DQuat, DVec3};
use ground::{counted, run, slab, tree};
use std::sync::Arc;

/// Moves by `way` within a second, and stays there.
fn pushed(name: &str, shape: &str, from: DVec3, way: DVec3) -> Body {
    let at = |x: DVec3| Pose { translation: x, ..Pose::IDENTITY };
    let poses = [(0.0, at(from)), (1.0, at(from + way)), (9.0, at(from + way))];
    let motion = Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap());
    Body::new(name, tree(shape)).with_kind(Kind::Kinematic(motion)).with_friction(0.3)
}

/// A press comes down on a box. Where it leaves two fifths of a gap in all, which is less than the two gaps that are asked for, the box takes its
/// place between; where it would go a hundredth of a gap too far it crushes the box, no sooner than it must.
#[test]
fn a_press_crushes_only_what_has_no_room() {
    for (left, is_crushed) in [(4e-4, false), (-1e-5, true)] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&slab(1.0).with_friction(0.3)).unwrap();
        let half = "box?x=0.3&y=0.3&z=0.3";
        let cube = simulation.add(&Body::new("cube", tree(half)).with_position(DVec3::Y * 0.301)).unwrap();
        let press = pushed("press", "box?x=1&y=0.2&z=1", DVec3::Y * 2.2, DVec3::Y * (left - 1.4));
        simulation.add(&press).unwrap();
        let (mut skipped, mut error) = (0.0, None);
        while simulation.time() < 1.5 && error.is_none() {
            match simulation.step() {
                Ok(report) => skipped += report.segments.iter().map(|s| s.skipped).sum::<f64>(),
                Err(found) => error = Some(found),
            }
        }
        assert_eq!(skipped, 0.0);
        if is_crushed {
            let Some(StepError::Crushed { pushing, crushed, time }) = error else { panic!("{error:?}") };
            assert_eq!((pushing.as_str(), crushed.as_str()), ("press", "cube"));
            assert!(time > 1.0 - 1e-5 && time <= 1.0, "{time}");
        } else {
            assert_eq!(error, None);
            let height = simulation.position(cube).y - 0.3;
            assert!(height > 0.2 * left && height < 0.8 * left, "{height}");
        }
    }
}

/// A press on boxes of the same size on each other, that goes a hundredth of a gap too far: they are crushed when no room is left, though the
/// corners of each could slip off those of the next one.
#[test]
fn columns_of_equal_boxes_are_crushed() {
    for count in [2, 3] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&slab(1.0).with_friction(0.3)).unwrap();
        let cube = tree("box?x=0.3&y=0.3&z=0.3");
        for k in 0..count {
            let place = DVec3::Y * (0.301 + 0.601 * f64::from(k));
            simulation.add(&Body::new(format!("box {k}"), Arc::clone(&cube)).with_position(place)).unwrap();
        }
        let high = 0.6 * f64::from(count);
        let press = pushed("press", "box?x=1&y=0.2&z=1", DVec3::Y * (high + 0.7), DVec3::Y * (-0.5 - 1e-5));
        simulation.add(&press).unwrap();
        let error = loop {
            match simulation.step() {
                Ok(report) => assert!(report.segments.iter().all(|segment| segment.skipped == 0.0)),
                Err(error) => break error,
            }
        };
        let StepError::Crushed { time, .. } = error else { panic!("{error:?}") };
        let end = 0.5 / (0.5 + 1e-5);
        assert!(time > end - 1e-8 && time <= end, "{count}: {time}, {end}");
    }
}

/// Boxes in a row, a gap and a half from each other and from a wall, and a press a hundredth before them that comes with this speed and leaves
/// so much room: none is faster than `fastest`, none stands still.
fn row(count: u32, [friction, restitution]: [f64; 2], speed: f64, left: f64, fastest: f64) {
    let half = "box?x=0.2&y=0.2&z=0.2";
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
    let mut simulation = Simulation::new(options).unwrap();
    let of = |body: Body| body.with_friction(friction).with_restitution(restitution);
    let wall = Body::new("wall", tree("box?x=0.2&y=1&z=1")).with_kind(Kind::Static);
    simulation.add(&of(wall.with_position(DVec3::X * -0.2))).unwrap();
    let place = |k: u32| DVec3::X * (0.2015 + 0.4015 * f64::from(k));
    for k in 0..count {
        simulation.add(&of(Body::new(format!("box {k}"), tree(half)).with_position(place(k)))).unwrap();
    }
    let (from, way) = (place(count) + DVec3::X * 0.0085, 0.01 + 0.0015 * f64::from(count) - left);
    let at = |x: f64| Pose { translation: from - DVec3::X * x, ..Pose::IDENTITY };
    let poses = [(0.0, at(0.0)), (way / speed, at(way)), (9.0, at(way))];
    let kind = Kind::Kinematic(Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap()));
    simulation.add(&of(Body::new("press", tree(half)).with_kind(kind))).unwrap();
    while simulation.time() < way / speed + 0.05 {
        let report = simulation.step().unwrap();
        for segment in &report.segments {
            let speeds = segment.changed.iter().map(|(_, twist)| twist.linear_velocity().length());
            assert!(speeds.fold(0.0, f64::max) < fastest, "{count}, {left}, {friction}: {segment:?}");
            assert_eq!(segment.skipped, 0.0);
        }
    }
}

/// Boxes that bounce, and that all close at once, have nowhere to bounce to: none becomes faster than one that is thrown to and fro. With a
/// restitution of one half what the press throws comes back with a quarter of its speed: 1.5 + 1.5/4 + …
#[test]
fn rows_that_bounce_are_not_thrown() {
    for (left, friction) in [(5e-4, 0.0), (1e-6, 0.0), (1e-6, 0.6)] {
        row(6, [friction, 0.5], 1.0, left, 2.0);
    }
}

/// Boxes make way for a press before it has come, and share what room is left then, too.
#[test]
fn rows_make_way_for_what_is_about_to_come() {
    for (speed, left) in [(1.4, 4e-6), (1.4, 4e-4), (3.0, 4e-6)] {
        row(4, [0.9, 0.0], speed, left, 1.1 * speed);
    }
}

/// Columns of five and ten boxes, each off the others by up to a millionth, end so, too, with what room is left shared by all: no body stands still
/// before, and less than a ten-thousandth of a gap is left.
#[test]
fn columns_that_are_not_straight_are_crushed() {
    (0..8).for_each(|beginning| column_is_crushed(5, 0.3, beginning));
    (8..10).for_each(|beginning| column_is_crushed(10, 0.8, beginning));
}

/// One of so many boxes, with such friction.
fn column_is_crushed(count: u32, friction: f64, beginning: u32) {
    /// Boxes are off the axis by up to a hundred times this.
    const STEP_ASIDE: f64 = 1e-8;
    let cube = tree("box?x=0.3&y=0.3&z=0.3");
    let step = 0.005 + 0.0013 * f64::from(beginning);
    let mut simulation = Simulation::new(SimulationOptions::default().with_step(step)).unwrap();
    simulation.add(&slab(1.0).with_friction(friction)).unwrap();
    for k in 0..count {
        let off = |n: u32| STEP_ASIDE * (f64::from((37 * n * n + 11 * n) % 201) - 100.0);
        let height = 0.301 + 0.601 * f64::from(k);
        let place = DVec3::new(off(10 * beginning + k), height, off(10 * beginning + k + 5));
        let body = Body::new(format!("box {k}"), Arc::clone(&cube)).with_position(place);
        simulation.add(&body.with_friction(friction)).unwrap();
    }
    let high = 0.6 * f64::from(count);
    let press = pushed("press", "box?x=1&y=0.2&z=1", DVec3::Y * (high + 0.7), DVec3::Y * -0.501);
    simulation.add(&press.with_friction(friction)).unwrap();
    let error = loop {
        match simulation.step() {
            Ok(report) => {
                let skipped = report.segments.iter().any(|segment| segment.skipped != 0.0);
                assert!(!skipped, "{count}, {beginning}");
            }
            Err(error) => break error,
        }
    };
    let StepError::Crushed { time, .. } = error else { panic!("{count}, {beginning}: {error:?}") };
    let skipped: f64 = simulation.finish().iter().map(|segment| segment.skipped).sum();
    let left = 0.5 - 0.501 * time;
    assert!(skipped == 0.0 && left > 0.0 && left < 1e-7, "{count}, {beginning}: {left:e}, {skipped:e}");
}

/// A press that stops just where a box has no room left: rounding decides, and no proof is found. Nothing is claimed then.
#[test]
fn what_rounding_decides_is_not_called_crushed() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_friction(0.3)).unwrap();
    let half = "box?x=0.3&y=0.3&z=0.3";
    simulation.add(&Body::new("cube", tree(half)).with_position(DVec3::Y * 0.301)).unwrap();
    let press = pushed("press", "box?x=1&y=0.2&z=1", DVec3::Y * 2.2, DVec3::Y * -1.4);
    simulation.add(&press).unwrap();
    let error = loop {
        match simulation.step() {
            Ok(_) => assert!(simulation.time() < 1.5),
            Err(error) => break error,
        }
    };
    let StepError::Cornered { pushing, cornered, time } = error else { panic!("{error:?}") };
    assert_eq!((pushing.as_str(), cornered.as_str()), ("press", "cube"));
    assert!(time > 1.0 - 1e-9 && time <= 1.0, "{time}");
}

/// Comes down, turns back where it leaves so much room at a time, and goes up again.
struct Crank {
    low: f64,
    time: f64,
}

impl Crank {
    const ACCELERATION: f64 = 4.0;
}

impl RigidMotion for Crank {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let since = t - self.time;
        let height = self.low + 0.5 * Self::ACCELERATION * since * since;
        let twist = Twist { linear: DVec3::Y * (Self::ACCELERATION * since), ..Twist::ZERO };
        (Pose { translation: DVec3::Y * height, ..Pose::IDENTITY }, twist)
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let since = t - Interval::point(self.time);
        let y = Interval::point(self.low) + Interval::point(0.5 * Self::ACCELERATION) * (since * since);
        IntervalPose { translation: IntervalVec3 { y, ..IntervalVec3::ZERO }, ..IntervalPose::IDENTITY }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let y = Interval::point(Self::ACCELERATION) * (t - Interval::point(self.time));
        IntervalTwist { linear: IntervalVec3 { y, ..IntervalVec3::ZERO }, angular: IntervalVec3::ZERO }
    }

    fn enclose_twist_rate(&self, _: Interval) -> IntervalTwist {
        let y = Interval::point(Self::ACCELERATION);
        IntervalTwist { linear: IntervalVec3 { y, ..IntervalVec3::ZERO }, angular: IntervalVec3::ZERO }
    }
}

/// A press that turns back at the end of a step in which less room is left than queries resolve, or a table that leaves then, or within the step:
/// nothing is crushed.
#[test]
fn what_turns_back_crushes_nothing() {
    let (left, cube) = (1e-12, tree("box?x=0.3&y=0.3&z=0.3"));
    let time = (0..20).fold(0.0, |time, _| time + 0.01);
    let at = |y: f64| Pose { translation: DVec3::Y * y, ..Pose::IDENTITY };
    let along =
        |poses: &[(f64, Pose)]| Kind::Kinematic(Arc::new(Keyframes::try_new(poses, Span::Linear).unwrap()));
    let rests = along(&[(0.0, at(-1.0)), (9.0, at(-1.0))]);
    let leaves = |time: f64| along(&[(0.0, at(-1.0)), (time, at(-1.0)), (1.0, at(-5.0))]);
    let comes = |time: f64| {
        let high = ConstantTwist::REST.with_position(DVec3::Y * (0.8 + left));
        let motion = high.with_linear_velocity(DVec3::Y * -0.5).with_reference_time(time);
        Kind::Kinematic(Arc::new(motion))
    };
    let turns = Kind::Kinematic(Arc::new(Crank { low: 0.8 + left, time }));
    let within = time + 0.003;
    for (table, press) in [(rests, turns), (leaves(time), comes(time)), (leaves(within), comes(within))] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&Body::new("table", tree("box?x=10&y=1&z=10")).with_kind(table)).unwrap();
        simulation.add(&Body::new("cube", Arc::clone(&cube)).with_position(DVec3::Y * 0.3005)).unwrap();
        simulation.add(&Body::new("press", tree("box?x=1&y=0.2&z=1")).with_kind(press)).unwrap();
        let error = loop {
            match simulation.step() {
                Ok(_) if simulation.time() < 0.3 => {}
                outcome => break outcome.err(),
            }
        };
        assert!(!matches!(error, Some(StepError::Crushed { .. })), "{error:?}");
    }
}

/// A press comes down with its rim on the top of a stone, which could turn out from under it: nothing is crushed. With what lies well below the
/// stone's top it does crush it.
#[test]
fn what_could_turn_out_at_a_rim_is_not_crushed() {
    for (over, is_crushed) in [(0.0, false), (1e-6, false), (0.3, true)] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&slab(1.0).with_friction(0.3)).unwrap();
        let stone = Body::new("stone", tree("icosphere?triangles=80&scale=0.3"));
        simulation.add(&stone.with_position(DVec3::Y * 0.3)).unwrap();
        let from = DVec3::new(1.0 - over, 1.0, 0.0);
        simulation.add(&pushed("press", "box?x=1&y=0.2&z=1", from, DVec3::Y * -0.4)).unwrap();
        let error = loop {
            match simulation.step() {
                Ok(_) => assert!(simulation.time() < 1.5),
                Err(error) => break error,
            }
        };
        let is_right = match &error {
            StepError::Crushed { crushed, .. } => is_crushed && crushed == "stone",
            StepError::Cornered { cornered, .. } => !is_crushed && cornered == "stone",
            _ => false,
        };
        assert!(is_right, "{over}: {error}");
    }
}

/// Two plates close in on spheres in one line, which could roll out of it: the way out does not show in the velocities at the start.
#[test]
fn spheres_in_a_row_are_not_crushed() {
    let mut simulation =
        Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(1e-4)).unwrap();
    let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap()));
    let mass = MassProperties::try_new(1.0, DVec3::ZERO, DMat3::IDENTITY * 0.03).unwrap();
    for k in 0..3 {
        let place = DVec3::X * (0.3001 + 0.6001 * f64::from(k));
        let sphere = Body::new(format!("sphere {k}"), Arc::clone(&point)).with_solid(Solid::Surface);
        simulation
            .add(
                &sphere.with_radius(0.3).with_position(place).with_mass(Mass::Given(mass)).with_friction(1.0),
            )
            .unwrap();
    }
    for (name, x, way) in [("left", -0.1, 0.1), ("right", 1.9004, -0.1)] {
        simulation.add(&pushed(name, "box?x=0.1&y=1&z=1", DVec3::X * x, DVec3::X * way)).unwrap();
    }
    let error = loop {
        match simulation.step() {
            Ok(_) => assert!(simulation.time() < 0.5),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, StepError::Cornered { .. }), "{error:?}");
}

/// A press stops a thousandth of a gap above three boxes, which lean a little: friction locks them for as long as there is room, and slips then.
#[test]
fn boxes_share_what_a_press_leaves() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_friction(0.5)).unwrap();
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let boxes = [0.501, 1.502, 2.503].map(|height| {
        let body = Body::new(format!("at {height}"), Arc::clone(&cube)).with_position(DVec3::Y * height);
        simulation.add(&body.with_friction(0.5)).unwrap()
    });
    let press = pushed("press", "box?x=1.5&y=0.1&z=1.5", DVec3::Y * 3.5, DVec3::Y * (1e-6 - 0.4));
    simulation.add(&press.with_friction(0.5)).unwrap();
    assert_eq!(run(&mut simulation, 1.2), 0.0);
    let top = simulation.position(boxes[2]).y - 2.5;
    assert!(top > 0.0 && top < 1e-6, "{top}");
}

/// Three columns of three boxes that are turned against each other, and a press that meets no resistance: it crushes one where a ten-thousandth of
/// a gap is left of all, and no sooner. Where friction locks some boxes with the last of their room, others would have to take all.
#[test]
fn a_heap_shares_its_room_to_the_end() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_friction(0.5)).unwrap();
    let cube = tree("box?x=0.2&y=0.2&z=0.2");
    for k in 0..9u8 {
        let (column, row) = (f64::from(k % 3), f64::from(k / 3));
        let place = DVec3::new(0.5 * column - 0.6, 0.201 + 0.45 * row, 0.1 * f64::from(k % 2));
        let turn = DQuat::from_rotation_y(0.2 * f64::from(k));
        let body =
            Body::new(format!("box {k}"), Arc::clone(&cube)).with_position(place).with_orientation(turn);
        simulation.add(&body.with_friction(0.4)).unwrap();
    }
    let comes = ConstantTwist::REST.with_position(DVec3::Y * 2.0).with_linear_velocity(DVec3::Y * -0.5);
    let press = Body::new("press", tree("box?x=1.5&y=0.1&z=1.5")).with_kind(Kind::Kinematic(Arc::new(comes)));
    simulation.add(&press.with_friction(0.4)).unwrap();
    let error = loop {
        if let Err(error) = simulation.step() {
            break error;
        }
    };
    let StepError::Crushed { time, .. } = error else { panic!("{error:?}") };
    // After 1.4 nothing is left of all gaps.
    let left = 0.5 * (1.4 - time);
    assert!(left > 0.0 && left < 1e-4 * simulation.options().gap, "{left:e}");
}

/// A stone that is wider at its foot, by seven degrees, and four plates along its sides that close in to two fifths of a gap each and rise: with
/// friction of 0.3 it is locked between them, and lifted.
#[test]
fn wedges_lift_a_stone_that_friction_holds() {
    let tilt = 7.0f64.to_radians();
    // One high: the tangent of seven degrees less.
    let (wide, narrow) = (0.5, 0.5 - 0.122_784_560_902_904_6);
    let ring = |half: f64, y: f64| {
        [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| DVec3::new(half * x, y, half * z))
    };
    let vertices = [ring(wide, -0.5), ring(narrow, 0.5)].concat();
    let faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let stone = Arc::new(MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap()));
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&slab(1.0).with_friction(0.3)).unwrap();
    let stone = Body::new("stone", stone).with_position(DVec3::Y * 0.501).with_friction(0.3);
    let stone = simulation.add(&stone).unwrap();
    for (name, out) in [("right", DVec3::X), ("left", -DVec3::X), ("front", DVec3::Z), ("back", -DVec3::Z)] {
        let rotation = DQuat::from_axis_angle(DVec3::Y.cross(out), -tilt);
        let far = 0.5 * (wide + narrow) + 0.101 / tilt.cos();
        let at = |away: f64, height: f64| Pose {
            translation: out * away + DVec3::Y * height,
            rotation,
            ..Pose::IDENTITY
        };
        let poses = [
            (0.0, at(far + 0.2, 0.501)),
            (0.5, at(far - 0.0006, 0.501)),
            (1.0, at(far - 0.0006, 0.751)),
            (2.0, at(far - 0.0006, 0.751)),
        ];
        let motion = Arc::new(Keyframes::try_new(&poses, Span::Linear).unwrap());
        let size = if out.x == 0.0 { "box?x=0.25&y=0.3&z=0.1" } else { "box?x=0.1&y=0.3&z=0.25" };
        simulation
            .add(&Body::new(name, tree(size)).with_kind(Kind::Kinematic(motion)).with_friction(0.3))
            .unwrap();
    }
    let start = simulation.position(stone).y;
    assert_eq!(run(&mut simulation, 1.3), 0.0);
    assert!(simulation.position(stone).y > start + 0.24, "{}", simulation.position(stone));
}

/// A box falls on two rollers that turn towards each other. Friction draws it in where it hits them, and locks; without friction it would
/// have a way out, so it is not crushed.
#[test]
fn friction_alone_crushes_nothing() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let roller = tree("shaft?triangles=400");
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let motion = ConstantTwist::REST
            .with_position(DVec3::new(0.62 * side, 1.0, 0.0))
            .with_angular_velocity(DVec3::Z * (3.0 * side));
        let roller = Body::new(name, Arc::clone(&roller)).with_kind(Kind::Kinematic(Arc::new(motion)));
        simulation.add(&roller.with_friction(0.5)).unwrap();
    }
    let cube = Body::new("box", tree("box?x=0.2&y=0.2&z=0.3")).with_position(DVec3::Y * 1.75);
    let cube = simulation.add(&cube.with_friction(0.5)).unwrap();
    assert_eq!(run(&mut simulation, 0.6), 0.0);
    assert!(simulation.position(cube).y > 1.2, "{}", simulation.position(cube));
}

/// The lower edge of a bar that moves over the floor meets stones from above, where friction with both locks them. Without friction they could
/// slip out ahead, or below: nothing is crushed, and nothing given up. What friction locks shares its room for as long as there is some: it
/// meets about a hundred times, and about four hundred times where velocities are off the law instead. Where no velocities obey it, as in one of
/// ten beginnings of the last stone, friction gives way before there is no room left.
#[test]
fn stones_slip_out_from_under_an_edge() {
    let mut events = [0; 8];
    let stones = [(0, 0.17, 0.4), (0, 0.17, 0.6), (1, 0.14, 0.6), (2, 0.14, 0.6)];
    for (k, (seed, height, friction)) in (0..events.len()).flat_map(|k| stones.map(|stone| (k, stone))) {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&slab(1.0).with_friction(friction)).unwrap();
        let motion = ConstantTwist::REST
            .with_position(DVec3::new(0.0, height + 0.1, -0.5))
            .with_linear_velocity(DVec3::Z);
        let bar =
            Body::new("bar", tree("box?x=0.5&y=0.1&z=0.04")).with_kind(Kind::Kinematic(Arc::new(motion)));
        simulation.add(&bar.with_friction(friction)).unwrap();
        let stone = tree(&format!("pebble?triangles=100&seed={seed}&scale=0.13"));
        let place = DVec3::new(1e-9 * k as f64, 0.16, -0.1);
        let stone = Body::new("stone", stone).with_position(place).with_friction(friction);
        simulation.add(&stone).unwrap();
        let run = counted(&mut simulation, 1.0);
        assert_eq!(run.skipped, 0.0, "{seed}");
        events[k] += run.events;
    }
    assert!(events.iter().all(|&events| events < 200), "{events:?}");
}

/// A prism of eight sides along z.
fn octagonal_prism(radius: f64, half_length: f64) -> Arc<MeshTree> {
    let corner = |k: u32| {
        let angle = (f64::from(k % 8) - 1.5) * std::f64::consts::FRAC_PI_4;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), if k < 8 { -half_length } else { half_length })
    };
    let ends = (1..7).flat_map(|k| [[0, k + 1, k], [8, 8 + k, 9 + k]]);
    let sides = (0..8).flat_map(|k| [[k, (k + 1) % 8, 8 + (k + 1) % 8], [k, 8 + (k + 1) % 8, 8 + k]]);
    let mesh = TriMesh::try_new((0..16).map(corner).collect(), ends.chain(sides).collect()).unwrap();
    Arc::new(MeshTree::new(mesh))
}

/// Stones without friction or weight under the edge of a press, which turn out from under it, many times in a step while they are in touch: as fast as
/// wedges are driven out, a few thousand times as fast as the press, and not faster with each contact.
#[test]
fn stones_that_are_wedged_out_are_not_thrown() {
    // Half sizes and place of the floor, sizes and place of the stone, half sizes and place of the press, with turns and tilts of these two.
    type Placed = ([f64; 2], f64, [f64; 2], [f64; 3]);
    let scenes: [([f64; 3], Placed, Placed, f64); 3] = [
        (
            [0.16, 0.28, 0.05],
            ([0.07, 0.44], 5.53, [-0.07, 0.05], [-0.18, 0.09753219809292277, -0.15]),
            ([0.18, 0.65], 2.09, [0.07, -0.09], [-0.13, 0.46333220744298514, -0.22]),
            0.23,
        ),
        (
            [0.41, 0.39, 0.25],
            ([0.06, 0.46], 2.52, [0.23, 0.13], [-0.07, 0.16203320378799724, 0.18]),
            ([0.32, 0.47], 0.55, [0.0, 0.0], [0.5, 0.5320664075759944, -0.02]),
            0.81,
        ),
        (
            [0.28, 2.06, 0.0],
            ([0.06, 0.31], 2.27, [0.12, 0.05], [0.04, 0.0942051521862033, 0.02]),
            ([0.62, 0.69], 1.82, [0.07, 0.01], [-0.29, 0.4503651073571693, 0.12]),
            0.92,
        ),
    ];
    let turned = |turn: f64, [x, z]: [f64; 2]| {
        DQuat::from_rotation_y(turn) * DQuat::from_scaled_axis(DVec3::new(x, 0.0, z))
    };
    for ([x, z, lateral], stone, press, speed) in scenes {
        let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
        let mut simulation = Simulation::new(options).unwrap();
        let floor = Body::new("floor", tree(&format!("box?x={x}&y=0.5&z={z}"))).with_kind(Kind::Static);
        let place = DVec3::new(lateral, -0.5, 0.0);
        simulation.add(&floor.with_position(place).with_friction(0.0)).unwrap();
        let ([radius, half_length], turn, tilt, place) = stone;
        let body = Body::new("stone", octagonal_prism(radius, half_length)).with_friction(0.0);
        let body = body.with_orientation(turned(turn, tilt)).with_position(DVec3::from(place));
        let stone = simulation.add(&body).unwrap();
        let ([x, z], turn, tilt, place) = press;
        let motion = ConstantTwist::REST.with_position(DVec3::from(place));
        let motion = motion.with_orientation(turned(turn, tilt)).with_linear_velocity(DVec3::NEG_Y * speed);
        let press = Body::new("press", tree(&format!("box?x={x}&y=0.2&z={z}")));
        let press = press.with_kind(Kind::Kinematic(Arc::new(motion)));
        simulation.add(&press.with_friction(0.0)).unwrap();
        while simulation.time() < 1.0 {
            simulation.step().unwrap();
            let speeds =
                [simulation.linear_velocity(stone), simulation.angular_velocity(stone) * half_length];
            assert!(speeds.iter().all(|v| v.length() < 1e4 * speed), "{}: {speeds:?}", simulation.time());
        }
    }
}

/// A box that a paddle pushes against a wall, at a gap of a hundred-thousandth: it stays away from the paddle by the gap until it meets the wall, and is
/// crushed there, not before.
#[test]
fn what_is_pushed_against_a_wall_is_crushed_there() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gap(1e-5)).unwrap();
    simulation.add(&slab(1.0).with_friction(0.2)).unwrap();
    let half = "box?x=0.2&y=0.2&z=0.2";
    simulation
        .add(&Body::new("box", tree(half)).with_position(DVec3::Y * 0.2001).with_friction(0.2))
        .unwrap();
    let wall = Body::new("wall", tree(half)).with_position(DVec3::new(1.0, 0.2001, 0.0));
    simulation.add(&wall.with_kind(Kind::Static)).unwrap();
    let paddle = pushed("paddle", half, DVec3::new(-0.6, 0.2001, 0.0), DVec3::X * 1.3);
    simulation.add(&paddle).unwrap();
    let error = loop {
        match simulation.step() {
            Ok(report) => assert!(report.segments.iter().all(|segment| segment.skipped == 0.0)),
            Err(error) => break error,
        }
    };
    let StepError::Crushed { time, .. } = error else { panic!("{error:?}") };
    let end = 0.8 / 1.3;
    assert!(time > end - 1e-6 && time <= end, "{time}, {end}");
}
