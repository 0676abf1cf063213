use crate::double_double_trig::sin_cos_double;
use crate::sin_cos::{LARGEST_ANGLE, sin_cos, sin_cos_two};
use crate::{
    Ball, ConstantTwist, Keyframes, Kinematics, MotionError, Pose, RigidMotion, ScrewMotion, Span, Twist,
    length,
};
use core::ops::{Add, Mul, Sub};
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::{DoubleDouble, F64x2};
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};

/// A motion with speeds up to about this.
pub(crate) fn random_motion(random: &mut Random, speed: f64) -> ConstantTwist {
    let q = random.quaternion();
    ConstantTwist::try_new(random.vector(), q, random.vector() * speed, random.vector() * speed)
        .unwrap()
        .with_at(random.vector())
        .with_reference_time(random.signed())
}

#[test]
fn sine_and_cosine_are_within_two_units() {
    let mut random = Random(1);
    let mut worst = 0.0_f64;
    for i in 0..200_000 {
        let scale = [1.0, 3.0, 100.0, 1e4, 8e5, LARGEST_ANGLE][i % 6];
        let mut x = random.signed() * scale;
        if i % 7 == 0 {
            // Next to a multiple of π/2.
            x = (x / core::f64::consts::FRAC_PI_2).round() * core::f64::consts::FRAC_PI_2;
        }
        let (sin, cos) = sin_cos(x);
        let other = random.signed() * if i % 3 == 0 { 0.7 } else { scale };
        let (sins, coss) = sin_cos_two(F64x2::pack(x, other));
        let [s0, s1] = sins.to_array();
        let [c0, c1] = coss.to_array();
        assert_eq!([(s0, c0), (s1, c1)], [(sin, cos), sin_cos(other)]);
        // A reduction of its own, for arguments of any size.
        let unit = 0.5 * f64::EPSILON;
        for (mine, theirs) in [sin, cos].into_iter().zip(<[Interval; 2]>::from(Interval::point(x).sin_cos()))
        {
            assert!(mine >= theirs.lo() - 2.0 * unit && mine <= theirs.hi() + 2.0 * unit, "{x}");
        }
        let (s, c) = sin_cos_double(DoubleDouble::from_f64(x));
        worst = worst.max(((s.hi - sin) + s.lo).abs() / unit).max(((c.hi - cos) + c.lo).abs() / unit);
    }
    assert!(worst <= 2.0, "{worst}");
    assert!(worst >= 0.7, "the error was not really measured: {worst}");
    assert!(sin_cos(2e9).0.is_nan() && sin_cos(f64::NAN).1.is_nan() && sin_cos(f64::INFINITY).0.is_nan());
}

#[test]
fn double_double_sine_satisfies_its_identities() {
    let mut random = Random(2);
    for _ in 0..2000 {
        let x = DoubleDouble { hi: random.signed() * 50.0, lo: random.signed() * 1e-16 };
        let (s, c) = sin_cos_double(x);
        let one = s.mul(s).add(c.mul(c)).sub(DoubleDouble::ONE);
        assert!(one.hi.abs() < 1e-29, "{one:?}");
        // sin 2x = 2 sin x cos x
        let (s2, _) = sin_cos_double(x.add(x));
        let d = s2.sub(s.mul(c).mul(2.0));
        assert!(d.hi.abs() < 1e-28, "{d:?}");
        assert!((s.hi - x.hi.sin()).abs() < 1e-14);
    }
}

/// R·Rᵀ = 1 to 2⁻⁹⁴, for quaternions of any length and motions that turn, near their reference time and far from it.
#[test]
fn rotations_in_double_double_are_orthogonal() {
    let mut random = Random(11);
    for i in 0..2000 {
        let motion = random_motion(&mut random, [0.1, 3.0, 300.0][i % 3]);
        let r = motion.rotation_dd(motion.reference_time() + [0.0, 1.0, -40.0][i / 3 % 3] * random.signed());
        for row in 0..3 {
            let mut products = r.apply(r.0[row]);
            products[row] = products[row].sub(DoubleDouble::ONE);
            let rest = products.map(|sum| sum.hi);
            assert!(rest.into_iter().all(|x| x.abs() < 2_f64.powi(-94)), "{i}: {rest:?}");
        }
    }
}

/// Squares of rates below 1e-162 are lost to underflow, the turns of long times are not: of no angle nothing is said, and of one that is too
/// large to be known that it is.
#[test]
fn a_slow_turn_over_a_long_time_is_enclosed() {
    for rate in [1e-150, 1e-170, 1e-200, 1e-300] {
        let motion = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.6, 0.0, 0.8) * rate);
        let whole = Interval::new(-1.0 / rate, 1.0 / rate);
        let over = [motion.enclose_pose(whole), motion.enclose_kinematics(whole).to_pose()];
        for k in -8..=8 {
            let place = motion.pose_and_twist(f64::from(k) / (8.0 * rate)).0.rotation * DVec3::Y;
            for enclosed in over {
                let seen = enclosed.rotation.mul_vec(IntervalVec3::point(DVec3::Y));
                let seen = [seen.x, seen.y, seen.z].map(|x| x + Interval::new(-1e-14, 1e-14));
                assert!((0..3).all(|i| seen[i].contains(place[i])), "{rate:e} {k}: {place} {seen:?}");
            }
        }
        let late = 1e20 / rate.max(1e-280);
        let state = motion.enclose_state(late);
        assert!(state.rotation.is_finite() && state.rotation_radius >= 1.0 || rate < 1e-280, "{state:?}");
        assert!(
            motion.enclose_pose(Interval::point(late)).rotation.rows()[0].x.contains(0.0) || rate < 1e-280
        );
    }
}

#[test]
fn enclosures_of_a_constant_twist_contain_it() {
    let mut random = Random(3);
    for i in 0..3000 {
        let motion = random_motion(&mut random, [0.1, 3.0, 300.0][i % 3]);
        let start = random.signed() * [1.0, 100.0][i % 2];
        let width = random.unit() * [0.0, 1e-9, 1e-2, 1.0][i % 4];
        let window = Interval::new(start, start + width);
        let pose = motion.enclose_pose(window);
        for j in 0..5 {
            let t = if j == 4 { window.hi() } else { (start + width * 0.25 * f64::from(j)).min(window.hi()) };
            let x = motion.position_dd(t);
            let r = motion.rotation_dd(t).to_mat3();
            for (k, enclosure) in
                [pose.translation.x, pose.translation.y, pose.translation.z].iter().enumerate()
            {
                assert!(contains_dd(*enclosure, x[k]), "{motion:?} {t} {enclosure:?}");
            }
            for (row, enclosure) in pose.rotation.rows().iter().enumerate() {
                for (column, e) in [enclosure.x, enclosure.y, enclosure.z].iter().enumerate() {
                    let value = motion.rotation_dd(t).0[row][column];
                    assert!(contains_dd(*e, value), "{motion:?} {t} {e:?} {value:?} {r:?}");
                }
            }
            let point = random.vector();
            let (plain, _) = motion.pose_and_twist(t);
            let enclosed = pose.enclose_point(point);
            let p = plain.transform_point(point);
            let slack = 1e-12 * (1.0 + x[0].hi.abs() + x[1].hi.abs() + x[2].hi.abs());
            assert!(enclosed.x.lo() - slack <= p.x && p.x <= enclosed.x.hi() + slack, "{motion:?} {t}");
            let back = plain.inverse_transform_point(p);
            assert!((back - point).length() < slack);
        }
    }
}

fn contains_dd(e: Interval, x: DoubleDouble) -> bool {
    // hi + lo lies in [e.lo, e.hi]
    let above = DoubleDouble::from_f64(e.hi()).sub(x);
    let below = x.sub(DoubleDouble::from_f64(e.lo()));
    above.hi >= 0.0 && below.hi >= 0.0
}

#[test]
fn rebasing_keeps_the_motion_at_far_times() {
    let mut random = Random(4);
    for _ in 0..300 {
        let motion = random_motion(&mut random, 2.0);
        let t0 = 1e5 * random.signed();
        let near = motion.rebase(t0);
        let t = t0 + random.unit();
        let (x, y) = (motion.position_dd(t), near.position_dd(t));
        assert!((x[0].hi - y[0].hi).abs() <= 4.0 * f64::EPSILON * (1.0 + x[0].hi.abs()));
        let (a, b) = (motion.rotation_dd(t).to_mat3(), near.rotation_dd(t).to_mat3());
        assert!((a - b).to_cols_array().iter().all(|d| d.abs() < 4e-15), "{motion:?}");
    }
}

#[test]
fn accelerations_are_bounded() {
    let mut random = Random(5);
    for _ in 0..200 {
        let motion = random_motion(&mut random, 3.0);
        let window = Interval::new(0.0, 1.0);
        let bound = motion.bound_acceleration(window, 1.0);
        let w = motion.angular_velocity();
        let arm = random.vector().normalize();
        assert!(w.cross(w.cross(arm)).length() <= bound && bound <= w.length_squared() * (1.0 + 1e-12));
    }
}

/// However slow a turn is, it counts over a time that is as long.
#[test]
fn screws_turn_at_any_rate() {
    for rate in [1e-318, 1e-300, 1e-160, 1e-154, 1.0, 1e100, 1e150] {
        // An axis through (-1, 0, 0), and a slide of three along it.
        let twist = Twist { angular: DVec3::Z * rate, linear: DVec3::new(0.0, rate, 3.0 * rate) };
        let screw = ScrewMotion::try_from_twist(Pose::IDENTITY, twist, 0.0).unwrap();
        let pitch = screw.pitch().unwrap();
        let exact = rate > 1e-308;
        assert!((pitch - 3.0).abs() < if exact { 1e-14 } else { 1e-3 }, "{rate:e}: {pitch}");
        assert!((screw.axis_point() + DVec3::X).length() < if exact { 1e-14 } else { 1e-3 }, "{rate:e}");
        let quarter = core::f64::consts::FRAC_PI_2 / rate;
        if quarter.is_finite() {
            let (pose, _) = screw.pose_and_twist(quarter);
            let expected = DVec3::new(-1.0, 1.0, 1.5 * core::f64::consts::PI);
            assert!((pose.transform_point(DVec3::ZERO) - expected).length() < 1e-13, "{rate:e}: {pose:?}");
        }
    }
    let far = Twist { angular: DVec3::Z * 1e-300, linear: DVec3::X * 1e10 };
    assert!(ScrewMotion::try_from_twist(Pose::IDENTITY, far, 0.0).is_err());
}

#[test]
fn screws_join_poses_and_keep_twists() {
    let mut random = Random(6);
    for _ in 0..500 {
        let a = random_motion(&mut random, 1.0).pose_and_twist(0.0).0;
        let b = random_motion(&mut random, 1.0).pose_and_twist(0.0).0;
        let screw = ScrewMotion::try_from_poses(a, b, -1.0, 2.0).unwrap();
        let end = screw.pose_and_twist(2.0).0;
        for point in [DVec3::ZERO, DVec3::X, DVec3::Y] {
            assert!((end.transform_point(point) - b.transform_point(point)).length() < 1e-11, "{a:?} {b:?}");
        }
        let (v, w) =
            (screw.as_constant_twist().linear_velocity(), screw.as_constant_twist().angular_velocity());
        assert!(v.cross(w).length() < 1e-13);
        let twist = Twist { linear: random.vector(), angular: random.vector() };
        let moved = ScrewMotion::try_from_twist(a, twist, 0.5).unwrap();
        let (pose, now) = moved.pose_and_twist(0.5);
        assert!((pose.transform_point(a.at) - a.translation).length() < 1e-11);
        let arm = a.translation - pose.translation;
        assert!((now.velocity_of(arm) - twist.linear).length() < 1e-12);
        assert!(ScrewMotion::try_from_constant_twist(*moved.as_constant_twist()).is_ok());
    }
    let slide = ScrewMotion::try_from_twist(Pose::IDENTITY, Twist { linear: DVec3::X, ..Twist::ZERO }, 0.0);
    assert_eq!(slide.as_ref().unwrap().pitch(), None);
    assert_eq!(slide.unwrap().axis_direction(), DVec3::X);
    assert!(ScrewMotion::try_from_poses(Pose::IDENTITY, Pose::IDENTITY, 1.0, 1.0).is_err());
}

#[test]
fn keyframes_pass_through_their_poses() {
    let mut random = Random(7);
    for span in [Span::Linear, Span::Screw] {
        let frames: Vec<(f64, Pose)> = (0..6)
            .map(|i| (f64::from(i) * 0.5, random_motion(&mut random, 1.0).pose_and_twist(0.0).0))
            .collect();
        let path = Keyframes::try_new(&frames, span).unwrap();
        for (span, pair) in path.spans().zip(frames.windows(2)) {
            for (t, pose) in [(span.start, pair[0].1), (span.end, pair[1].1)] {
                let got = span.motion.pose_and_twist(t).0;
                assert!((got.transform_point(DVec3::Y) - pose.transform_point(DVec3::Y)).length() < 1e-11);
            }
        }
        assert!(path.span_at(-0.1).is_none() && path.span_at(2.6).is_none() && path.span_at(2.5).is_some());
    }
    let still = (0.0, Pose::IDENTITY);
    assert!(Keyframes::try_new(&[still], Span::Linear).is_err());
    assert!(matches!(
        Keyframes::try_new(&[still, still], Span::Linear),
        Err(MotionError::Keyframes { index: 1, .. })
    ));
}

/// Spans that turn by anything from far less than the angle below which they are linear: held against the screw as rotated
/// chords, (sin sθ/2 : sin θ/2)·exp([k](s − 1)θ/2) of the way across the axis, which needs no axis far away.
#[test]
fn screws_of_small_turns_stay_by_their_chords() {
    let mut random = Random(12);
    let mut worst = 0.0_f64;
    for round in 0..4000 {
        let angle = 10f64.powf(-12.0 + 12.0 * f64::from(round % 1000) / 1000.0);
        let axis = random.vector().normalize();
        let start = random_motion(&mut random, 1.0).pose_and_twist(0.0).0;
        let way = random.vector();
        let along = axis * axis.dot(way);
        let turn = DQuat::from_axis_angle(axis, angle);
        let arrival = start.translation + way;
        let end = Pose { rotation: turn * start.rotation, translation: arrival, at: start.at };
        let path = Keyframes::try_new(&[(0.0, start), (1.0, end)], Span::Screw).unwrap();
        for k in 0..=8 {
            let s = f64::from(k) / 8.0;
            let back = DQuat::from_axis_angle(axis, (s - 1.0) * angle / 2.0);
            let part = (s * angle / 2.0).sin() / (angle / 2.0).sin();
            let exact = start.translation + along * s + back * (way - along) * part;
            let (pose, _) = path.pose_and_twist(s);
            let off = (pose.transform_point(start.at) - exact).length() - 1e-14;
            let chord = way.length();
            worst = worst.max(off / chord);
            assert!(off <= 5e-8 * chord, "{angle:e}, {s}: {off:e}");
            assert!(angle < 1e-4 || off <= 5e-11 * chord, "{angle:e}, {s}: {off:e}");
        }
    }
    // The promise is not far from what happens.
    assert!(worst > 5e-9, "{worst:e}");
}

#[test]
fn text_round_trips_and_errors_name_the_key() {
    let mut random = Random(8);
    for _ in 0..100 {
        let motion = random_motion(&mut random, 1.0);
        assert_eq!(motion.to_string().parse::<ConstantTwist>(), Ok(motion));
    }
    for (text, expected) in [
        ("x=1,2", "x: expected 3"),
        ("x=1,2,z", "\"z\" is not a number"),
        ("x=1,2,nan", "not finite"),
        ("spin=1", "spin: unknown key"),
        ("v=1,2,3;v=1,2,3", "v: given twice"),
        ("hello", "expected key=value"),
        ("q=0,0,0,0", "cannot be normalised"),
    ] {
        let message = text.parse::<ConstantTwist>().unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    assert_eq!(" x = 1, 0,0 ; ".parse::<ConstantTwist>(), Ok(ConstantTwist::REST.with_position(DVec3::X)));
}

#[cfg(feature = "serde")]
#[test]
fn serde_forms_are_checked() {
    let motion: ConstantTwist = serde_json::from_str(r#"{"x":[1,2,3],"q":[2,0,0,0],"w":[0,0,1]}"#).unwrap();
    assert_eq!(motion.orientation().w, 2.0);
    let text = serde_json::to_string(&motion).unwrap();
    assert_eq!(serde_json::from_str::<ConstantTwist>(&text).unwrap(), motion);
    assert!(serde_json::from_str::<ConstantTwist>(r#"{"q":[0,0,0,0]}"#).is_err());
    assert!(serde_json::from_str::<ConstantTwist>(r#"{"position":[0,0,0]}"#).is_err());
    assert!(serde_json::from_str::<ScrewMotion>(r#"{"v":[1,0,0],"w":[0,0,1]}"#).is_err());
    let keys = r#"{"times":[0,1],"spans":[{"v":[1,0,0]}]}"#;
    let path: Keyframes = serde_json::from_str(keys).unwrap();
    assert_eq!(path.motions().len(), 1);
    assert!(serde_json::from_str::<Keyframes>(r#"{"times":[1,0],"spans":[{}]}"#).is_err());
}

#[test]
fn poses_at_far_times_are_finite_and_near_ones_exact() {
    let motion = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.3, -1.1, 2.0));
    for t in [1e2, 1e5, 947_324.7, 1e8, 1e12, 1e30, -1e57] {
        let (pose, _) = motion.pose_and_twist(t);
        assert!(pose.rotation.is_finite() && (pose.rotation.length() - 1.0).abs() < 1e-12, "{t}: {pose:?}");
    }
    // 100 000 full turns of a quarter turn a unit of time: back where it was, up to what π/2 as a double misses.
    let quarter = ConstantTwist::REST.with_angular_velocity(DVec3::Z * core::f64::consts::FRAC_PI_2);
    let (pose, _) = quarter.pose_and_twist(400_000.0);
    assert!((pose.transform_vector(DVec3::X) - DVec3::X).length() < 1e-10, "{pose:?}");
}

/// The JSON form of a spline gives the same motion to the last bit, with velocities that follow from the neighbors and with given ones.
#[cfg(feature = "serde")]
#[test]
fn splines_in_json() {
    use crate::{AnyMotion, Spline, SplineDegree};
    let text = r#"{"times": [0, 1, 2.5], "join": "JOIN", "poses": [{}, {"x": [1, 0.5, 0], "q": [0.9, 0.1, 0, 0.3]}, {"x": [2, 0, 1]}]TWISTS}"#;
    let given = r#", "twists": [{}, {"v": [1, 0, 0.25], "w": [0, 0.5, 0]}, {"v": [0, 0, 1]}]"#;
    for (join, degree) in [("cubic", SplineDegree::Cubic), ("quintic", SplineDegree::Quintic)] {
        for twists in ["", given] {
            let text = text.replace("JOIN", join).replace("TWISTS", twists);
            let read: AnyMotion = serde_json::from_str(&text).unwrap();
            let AnyMotion::Spline(spline) = &read else { panic!("{read:?}") };
            assert_eq!((spline.degree(), spline.times()), (degree, &[0.0, 1.0, 2.5][..]));
            let written = serde_json::to_string(&read).unwrap();
            assert_eq!(serde_json::from_str::<AnyMotion>(&written).unwrap(), read);
            assert_eq!(&serde_json::from_str::<Spline>(&written).unwrap(), spline);
            let (pose, twist) = read.pose_and_twist(1.0);
            assert!((pose.translation - DVec3::new(1.0, 0.5, 0.0)).length() < 1e-14);
            if !twists.is_empty() {
                assert!((twist.linear - DVec3::new(1.0, 0.0, 0.25)).length() < 1e-12, "{twist:?}");
                assert!((twist.angular - DVec3::new(0.0, 0.5, 0.0)).length() < 1e-12, "{twist:?}");
            }
        }
    }
    for (from, to, reason) in [
        ("JOINT", "", ""),
        ("\"join\": \"JOIN\"", "\"join\": \"bent\"", "\"bent\" is unknown: linear, screw, cubic or quintic"),
        ("\"join\": \"JOIN\"", "\"join\": \"linear\"", "twists: they belong to splines"),
        ("\"JOIN\", \"poses\"", "\"cubic\", \"spans\"", "join: it belongs to poses"),
        ("\"times\": [0, 1, 2.5]", "\"times\": [0, 1]", "2 times for 3 poses"),
        ("{\"v\": [0, 0, 1]}]", "{}, {}]", "4 twists for 3 poses"),
        ("\"times\": [0, 1, 2.5]", "\"times\": [0, 3, 2.5]", "times must increase"),
    ] {
        let text = text.replace("TWISTS", given).replace(from, to).replace("JOIN", "cubic");
        let found =
            serde_json::from_str::<AnyMotion>(&text).err().map_or(String::new(), |error| error.to_string());
        assert!(found.contains(reason) && found.is_empty() == reason.is_empty(), "{to}: {found}");
    }
}

/// What underflows to zero is not exactly zero, and rounding of what is multiplied by the least numbers counts.
#[test]
fn balls_hold_what_underflows() {
    let (slow, pace) = (2f64.powi(-565), 2f64.powi(-565));
    let found = Ball::point(DVec3::new(5.0 * slow, 0.0, 0.0)).times(pace, 0.0);
    assert!(found.center == DVec3::ZERO && found.radius > 0.0, "{found:?}");
    assert_eq!(Ball::ZERO.times(pace, 0.0), Ball::ZERO);
    // 3·2⁻¹⁰⁷⁴ times 1/3 of 2¹⁰⁰⁰, and of its neighbor: products that are no doubles.
    let least = DVec3::new(0.0, 0.0, 3.0 * f64::from_bits(1));
    for far in [2f64.powi(1000) / 3.0, 2f64.powi(1000) * 0.7] {
        let found = Ball::point(least).cross(Ball::point(DVec3::X * far));
        assert!(found.radius >= 0.25 * f64::EPSILON * found.center.length(), "{found:?}");
    }
}

/// Velocities by another clock, and accelerations, are in their balls; a negative radius says nothing.
#[test]
fn kinematics_are_enclosed_in_any_unit_of_time() {
    let mut random = Random(31);
    for round in 0..2000 {
        let size = 2f64.powi([0, -500, 500, -900][round % 4]);
        let unit = random.signed() * 2f64.powi([0, -530, 250, -30][round / 4 % 4]);
        let error = if round % 3 == 0 { 0.0 } else { unit.abs() * 1e-3 };
        let mut ball = || Ball::new(random.vector() * size, random.unit() * size * 1e-2);
        let known = Kinematics {
            linear: ball(),
            angular: ball(),
            linear_rate: ball(),
            angular_rate: ball(),
            ..Kinematics::REST
        };
        let found = known.in_unit_of_time(unit, error);
        assert_eq!((found.position, found.rotation), (known.position, known.rotation));
        let pairs = [
            (known.linear, found.linear, 1),
            (known.angular, found.angular, 1),
            (known.linear_rate, found.linear_rate, 2),
            (known.angular_rate, found.angular_rate, 2),
        ];
        for (before, after, power) in pairs {
            let by = unit + error * random.signed();
            let vector = before.center + random.ball() * before.radius;
            // In a unit near one: exact.
            let wanted = (0..power).fold(vector / size, |v, _| v * by);
            let most = after.radius / size * (1.0 + 1e-9) + 1e-15 * length(wanted) + f64::MIN_POSITIVE;
            assert!(length(after.center / size - wanted) <= most, "{round}: {before:?} {unit:e} {after:?}");
        }
        let wrong = Kinematics { linear: Ball { center: DVec3::X, radius: -1e-3 }, ..Kinematics::REST };
        assert_eq!(wrong.in_unit_of_time(1.0, 0.0).linear.radius, f64::INFINITY);
    }
}

/// In another unit of length the same vectors, exactly but for what underflows, and nothing where the factor is no power of two.
#[test]
fn sets_in_another_unit_of_length_are_the_same() {
    let mut random = Random(91);
    for round in 0..400 {
        let size = 2f64.powi([0, -500, 180, -1020][round % 4]);
        let factor = 2f64.powi([3, 600, -400, -60, 1000][round % 5]);
        let mut ball = |part: f64| Ball::new(random.vector() * size, random.unit() * size * part);
        let known = Kinematics {
            position: ball(1e-2),
            position_tail: ball(0.0).center * 1e-17,
            linear: ball(0.0),
            linear_rate: ball(1e-3),
            angular: Ball::point(DVec3::X),
            ..Kinematics::REST
        };
        let found = known.in_unit_of_length(factor);
        assert_eq!((found.angular, found.angular_rate), (known.angular, known.angular_rate));
        // Halves of both powers, so that neither over- nor underflows.
        let back = |ball: Ball, tail: DVec3| {
            let near = |v: DVec3| if factor > 1.0 { v } else { v / factor };
            (near(ball.center), near(tail), if factor > 1.0 { ball.radius } else { ball.radius / factor })
        };
        let pairs = [
            (known.position, known.position_tail, found.position, found.position_tail),
            (known.linear, DVec3::ZERO, found.linear, DVec3::ZERO),
            (known.linear_rate, DVec3::ZERO, found.linear_rate, DVec3::ZERO),
        ];
        for (before, tail, after, after_tail) in pairs {
            if after.radius == f64::INFINITY {
                assert!(length(before.center) * factor > 1e300, "{round}: {before:?} {factor:e}");
                continue;
            }
            let by = if factor > 1.0 { factor } else { 1.0 };
            let (center, after_tail, radius) = back(after, after_tail);
            let off = length((center - before.center * by) + (after_tail - tail * by));
            assert!(
                off + before.radius * by <= radius * (1.0 + 1e-15),
                "{round}: {before:?} {factor:e} {after:?}"
            );
            assert!(
                radius
                    <= before.radius * by * (1.0 + 1e-9)
                        + 1e-15 * size * by
                        + 4.0 * f64::MIN_POSITIVE / factor.min(1.0)
            );
        }
        assert_eq!(known.in_unit_of_length(factor * 1.5).position.radius, f64::INFINITY);
    }
    let off_center = Kinematics { at: DVec3::X * f64::MIN_POSITIVE * 1.25, ..Kinematics::REST };
    assert_eq!(off_center.in_unit_of_length(2f64.powi(-60)).position.radius, f64::INFINITY);
}
