//! Joints that leave their limits are warned of, wherever on the path that is.

use d2m_bvh::QueryOptions;
use d2m_robot::{
    Interpolation, LimitKind, LimitWarning, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint,
};
use d2m_testing::{Draw, Random};

/// A cart on the joint j with these limits, and one on k that follows it with a tenth of its way and 0.01.
fn scene([lower, upper]: [f64; 2], velocity: f64, follower: [f64; 2]) -> RobotScene {
    let joint = |name: &str, child: &str, [lower, upper]: [f64; 2], velocity: f64, inside: &str| {
        format!(
            "<joint name=\"{name}\" type=\"prismatic\"><parent link=\"base\"/><child link=\"{child}\"/>\
             <limit lower=\"{lower:?}\" upper=\"{upper:?}\" velocity=\"{velocity:?}\"/>{inside}</joint>"
        )
    };
    let follows = "<mimic joint=\"j\" multiplier=\"0.1\" offset=\"0.01\"/>";
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>\
         <link name=\"cart\"/><link name=\"second\"/>{}{}</robot>",
        joint("j", "cart", [lower, upper], velocity, ""),
        joint("k", "second", follower, 1e9, follows)
    );
    let robot = Robot::parse("r.urdf", &urdf, &RobotOptions::new()).unwrap();
    RobotScene::new(robot.into(), None, QueryOptions::default()).unwrap()
}

const FAR: [f64; 2] = [-1e9, 1e9];

fn line(points: &[[f64; 2]]) -> Trajectory {
    let points = points.iter().map(|&[time, at]| TrajectoryPoint::new(time, vec![at]));
    Trajectory::new(vec!["j".into()], points.collect())
}

fn cubic(points: &[[f64; 3]]) -> Trajectory {
    let point =
        |&[time, at, speed]: &[f64; 3]| TrajectoryPoint::new(time, vec![at]).with_velocities(vec![speed]);
    Trajectory::new(vec!["j".into()], points.iter().map(point).collect())
}

fn only(scene: &RobotScene, path: &Trajectory) -> LimitWarning {
    let mut found = scene.limit_warnings(path).unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
    found.pop().unwrap()
}

/// A joint that rests at its limit, or runs at it, was watched no further.
#[test]
fn a_joint_that_was_at_its_limit_is_watched_on() {
    let grip = scene([-1.0, 0.04], 100.0, FAR);
    let found = only(&grip, &line(&[[0.0, 0.04], [1.0, 0.04], [2.0, 0.06]]));
    assert!(found.kind == LimitKind::Position && found.is_certain && found.point == 1, "{found:?}");
    assert!(found.time > 1.0 && found.time < 1.0 + 1e-5 && found.limit == 0.04, "{found:?}");
    // It comes back: beyond only in between, by 3/8 of the speed times a quarter of the time.
    let found = only(
        &scene([-1.0, 0.04], 1e9, FAR),
        &cubic(&[[0.0, 0.04, 0.0], [1.0, 0.04, 0.0], [2.0, 0.04, 0.0], [3.0, 0.04, -1.0], [4.0, 0.0, 0.0]]),
    );
    assert!(found.point == 2 && found.time < 2.0 + 1e-3, "{found:?}");

    // A second at a speed of exactly 1, then up to 4.
    let drive = scene(FAR, 1.0, FAR);
    for begin in [1.0, 0.1] {
        let path = cubic(&[[0.0, 0.0, 1.0], [begin, begin, 1.0], [begin + 1.0, begin + 3.0, 1.0]]);
        let found = only(&drive, &path);
        assert!(found.kind == LimitKind::Velocity && found.is_certain && found.point == 1, "{found:?}");
        assert!(found.time > begin && found.time < begin + 1e-5, "{found:?}");
    }

    // What follows goes to 0.1, rests there and goes to 0.2.
    let pair = scene(FAR, 100.0, [0.0, 0.1]);
    let found = only(&pair, &line(&[[0.0, 0.0], [0.3, 0.9], [0.6, 0.9], [1.3, 1.9]]));
    assert!(found.joint == "k" && found.point == 2 && found.limit == 0.1, "{found:?}");
    assert!(found.time > 0.6 && found.time < 0.6 + 1e-5, "{found:?}");
}

/// What is at its limit up to rounding is not beyond, for however long; and a path of thousands of points is searched to its end.
#[test]
fn a_joint_at_its_limit_is_not_warned_of() {
    let grip = scene([0.0, 0.04], 0.04, FAR);
    // To and fro, each second point at a limit, with speeds that are at theirs.
    let ways: Vec<[f64; 2]> =
        (0..4000_u32).map(|index| [f64::from(index), [0.0, 0.04, 0.04, 0.0][index as usize % 4]]).collect();
    assert_eq!(grip.limit_warnings(&line(&ways)).unwrap(), []);
    let mut beyond = ways.clone();
    beyond.push([3999.5, 0.0401]);
    let found = grip.limit_warnings(&line(&beyond)).unwrap();
    assert_eq!(
        found.iter().map(|found| found.kind).collect::<Vec<_>>(),
        [LimitKind::Position, LimitKind::Velocity]
    );
    assert!(found.iter().all(|found| found.point == 3999 && found.is_certain), "{found:?}");
    // From time 0.1 on, times in doubles and the start of a piece are not a double apart.
    let smooth: Vec<[f64; 3]> = ways.iter().map(|&[time, at]| [0.1 + 1.7 * time, at, 0.0]).collect();
    assert_eq!(grip.limit_warnings(&cubic(&smooth)).unwrap(), []);
    // A joint that is locked, and steep ways that end at limits.
    let locked = scene([0.3, 0.3], 0.0, FAR);
    let rest: Vec<[f64; 3]> = (0..9).map(|index| [0.1 + 0.3 * f64::from(index), 0.3, 0.0]).collect();
    assert_eq!(locked.limit_warnings(&cubic(&rest)).unwrap(), []);
    let steep = scene([0.0, 1.0], 1e9, FAR);
    for begin in [0.0, 0.1, 1e6, -7e9] {
        let found = steep.limit_warnings(&cubic(&[
            [begin, 0.0, 1e-3],
            [begin + 0.7, 1.0, 9.0],
            [begin + 1.3, 1.0, -9.0],
        ]));
        // That goes out of its limits, certainly so.
        let found = found.unwrap();
        assert!(
            found.iter().all(|found| found.is_certain && !(0.0..=1.0).contains(&found.value)),
            "{found:?}"
        );
        for path in [line(&[[begin, 0.7], [begin + 0.7, 0.0]]), line(&[[begin, 0.2], [begin + 0.9, 1.0]])] {
            assert_eq!(steep.limit_warnings(&path).unwrap(), []);
        }
    }
}

/// Values that are beyond by no more than a few hundred of their last digits, and for a moment only.
#[test]
fn the_smallest_excess_counts_however_short_it_is() {
    let drive = scene([-1.0, 1.0], 1e9, FAR);
    for part in [3e-14, 1e-13, 1e-12, 1e-9, 1e-6] {
        // 1 + part − 4u² with u from −1/2 to 1/2: beyond for √part.
        let peak = 1.0 + part;
        let path = cubic(&[[0.3, peak - 1.0, 4.0], [1.3, peak - 1.0, -4.0]]);
        let found = only(&drive, &path);
        let expected = 0.8 - 0.5 * f64::sqrt(part);
        assert!(found.is_certain && (found.time - expected).abs() < 3e-6, "{part}: {found:?}");
        let within = cubic(&[[0.3, -part, 4.0], [1.3, -part, -4.0]]);
        assert_eq!(drive.limit_warnings(&within).unwrap(), []);
    }
}

/// Random paths with rests and ways at their limits, against samples.
#[test]
fn no_excess_of_random_paths_is_missed() {
    let mut random = Random::new(20_261_201);
    let mut warned = 0;
    for round in 0..400 {
        let interpolation = [Interpolation::Linear, Interpolation::Cubic, Interpolation::Quintic][round % 3];
        let mut time = 10.0 * random.signed();
        let (mut points, mut at, mut speed) = (Vec::new(), 0.5, 0.0);
        for _ in 0..8 {
            if random.unit() < 0.6 {
                at = [0.5, 1.0, -1.0, 0.99, 1.001 * random.signed()][(random.unit() * 5.0) as usize % 5];
                speed = [0.0, 0.0, 1.0, 0.1 * random.signed()][(random.unit() * 4.0) as usize % 4];
            }
            let point = TrajectoryPoint::new(time, vec![at]).with_velocities(vec![speed]);
            points.push(point.with_accelerations(vec![0.0]));
            time += 0.2 + 3.0 * random.unit();
        }
        let path = Trajectory::new(vec!["j".into()], points).with_interpolation(interpolation);
        let found = scene([-1.0, 1.0], 1e9, FAR).limit_warnings(&path).unwrap();
        assert!(found.iter().all(|found| found.is_certain), "{found:?}");
        let value = &path.joint_values().unwrap()[0];
        let [start, end] = path.times().unwrap();
        let samples = (0..=20_000).map(|index| start + (end - start) * f64::from(index) / 20_000.0);
        let first = samples.into_iter().find(|&time| value.value(time).abs() > 1.0 + 1e-14);
        warned += usize::from(first.is_some());
        match (first, found.first()) {
            (Some(first), Some(found)) => assert!(found.time <= first + (end - start) * 1e-6, "{found:?}"),
            (Some(first), None) => panic!("beyond at {first}: {path:?}"),
            // Between two samples.
            (None, Some(found)) => assert!(value.value(found.time).abs() > 1.0, "{found:?}"),
            (None, None) => {}
        }
    }
    assert!((100..300).contains(&warned), "{warned}");
}
