//! Distances at any distance, and proximities beside them. Meshes, poses and answers go to `.bench/scenes`, for peers.
use super::{Target, figure, least_in_turn, wrong};
use crate::TaskResult;
use crate::bench::body::write_obj;
use d2m::bvh::{Distance, MeshTree, Posed, Solid, StartState, collide, distance, proximities};
use d2m::glam::{DQuat, DVec3};
use d2m::motion::Pose;
use std::fmt::Write as _;
use std::time::Duration;

/// Name, shape A, shape B.
const PAIRS: [(&str, &str, &str); 8] = [
    ("box_pebble", "box", "pebble?triangles=82000"),
    ("pebbles", "pebble?triangles=5000", "pebble?triangles=82000&seed=3"),
    ("knots", "torus-knot?triangles=70000", "torus-knot?triangles=70000"),
    ("gears", "gear", "gear"),
    ("tetrahedron_sphere", "tetrahedron", "icosphere?triangles=80000"),
    ("torus_plate", "torus?triangles=20000", "box?x=5&y=5&z=0.01"),
    ("screw_nut", "screw", "nut"),
    ("wheel_link", "paddle-wheel?triangles=20000", "chain-link?triangles=12000"),
];

/// Distances beyond contact, in sizes of the larger body; the first one is that of near contact.
const GAPS: [f64; 12] = [1e-6, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.2, 0.4, 0.8, 1.5, 3.0, 10.0];
/// Queries a measurement.
const REPEATED: u32 = 20;
/// What is added to a distance, as a part of it, before it is compared with another query.
const SLACK: f64 = 1e-9;

pub(super) fn run(rounds: usize) -> TaskResult {
    let folder = crate::workspace_root().join(".bench").join("scenes");
    std::fs::create_dir_all(&folder)?;
    let mut table = String::from("pair,gap,qw,qx,qy,qz,x,y,z,distance,microseconds\n");
    for (name, first, second) in PAIRS {
        let [a, b] = [first, second].map(|shape| d2m::shapes::mesh(shape).map(MeshTree::new));
        let (a, b) = (a?, b?);
        for (mesh, letter) in [(&a, "a"), (&b, "b")] {
            write_obj(&folder.join(format!("{name}_{letter}.obj")), mesh.mesh())?;
        }
        let rotation = DQuat::from_xyzw(0.1, 0.3, 0.2, 0.9).normalize();
        let pose = |away: f64| {
            let translation = DVec3::new(0.6, 0.64, 0.48) * away;
            Pose { rotation, translation, at: DVec3::ZERO }
        };
        let contact = at_contact(&a, &b, pose)?;
        let size = a.radius().max(b.radius());
        let at = |gap: f64| Posed::new(&a, pose(contact + gap * size));
        let times =
            times_of_all(4 * rounds, |gap| distance(at(gap), Posed::at_rest(&b), Solid::Surface).is_ok());
        let near = times[0];
        let (mut worst, mut worst_gap) = (0.0, 0.0);
        for (gap, time) in GAPS.into_iter().zip(times) {
            let posed = at(gap);
            let found = distance(posed, Posed::at_rest(&b), Solid::Surface)?;
            check(posed, Posed::at_rest(&b), &found)?;
            if time / near > worst {
                (worst, worst_gap) = (time / near, gap);
            }
            let (q, x) = (posed.pose.rotation, posed.pose.translation);
            let _ = writeln!(
                table,
                "{name},{gap},{},{},{},{},{},{},{},{},{time:.2}",
                q.w, q.x, q.y, q.z, x.x, x.y, x.z, found.value
            );
        }
        let what = format!("distance, {name}: near contact {near:.1} µs; worst, at {worst_gap} sizes");
        figure(what, worst, "times", Target::AtMost(3.0));
        // Nearer than the margin by half.
        let posed = (Posed::new(&a, pose(contact + 0.5e-3 * size)), Posed::at_rest(&b));
        let margin = distance(posed.0, posed.1, Solid::Surface)?.upper + 0.5e-3 * size;
        let found = proximities(posed.0, posed.1, margin)?;
        let least = found.first().ok_or_else(|| wrong("no proximity within the distance"))?.distance;
        let exact = distance(posed.0, posed.1, Solid::Surface)?;
        if (least - exact.value).abs() > SLACK * size {
            return Err(wrong("the closest proximity is not at the distance"));
        }
        let mut one = repeated(|| distance(posed.0, posed.1, Solid::Surface).is_ok());
        let mut all = repeated(|| proximities(posed.0, posed.1, margin).is_ok());
        let times = least_in_turn(4 * rounds, || (), &mut [&mut one, &mut all]);
        let (one, all) = (microseconds(times[0]), microseconds(times[1]));
        let what = format!(
            "proximities, {name}: margin {margin:.1e}, {} found, {all:.1} µs, over a distance",
            found.len()
        );
        figure(what, all / one, "times", Target::AtMost(3.0));
    }
    let path = folder.join("distance.csv");
    std::fs::write(&path, table)?;
    println!("FCL on the same pairs: python crates/d2m-evaluation/peers/fcl_distance.py");
    Ok(())
}

/// A query at each distance, in microseconds, all of them in turn.
fn times_of_all(rounds: usize, query: impl Fn(f64) -> bool) -> Vec<f64> {
    let query = &query;
    let mut works = GAPS.map(|gap| repeated(move || query(gap)));
    let mut works: Vec<&mut dyn FnMut(&mut ())> = works.iter_mut().map(|work| work as _).collect();
    least_in_turn(rounds, || (), &mut works).into_iter().map(microseconds).collect()
}

/// As often as a measurement takes.
fn repeated(query: impl Fn() -> bool) -> impl FnMut(&mut ()) {
    move |()| assert!((0..REPEATED).all(|_| query()), "answered before")
}

/// Of one query.
fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6 / f64::from(REPEATED)
}

/// How far A is moved when it has just left B.
fn at_contact(
    a: &MeshTree,
    b: &MeshTree,
    pose: impl Fn(f64) -> Pose,
) -> Result<f64, Box<dyn std::error::Error>> {
    let (mut near, mut far) = (0.0, 2.0 * (a.radius() + b.radius()));
    if collide(Posed::new(a, pose(far)), Posed::at_rest(b), Solid::Surface)? {
        return Err(wrong("bodies that are far apart collide"));
    }
    for _ in 0..48 {
        let middle = 0.5 * (near + far);
        if collide(Posed::new(a, pose(middle)), Posed::at_rest(b), Solid::Surface)? {
            near = middle;
        } else {
            far = middle;
        }
    }
    Ok(far)
}

/// Moved together by a little less than the distance they stay apart, wherever the closest points are; by a little more along the
/// normal they meet.
fn check(a: Posed<'_>, b: Posed<'_>, found: &Distance) -> TaskResult {
    let meets = |by: f64| {
        let pose = Pose { translation: a.pose.translation + found.normal * by, ..a.pose };
        collide(Posed::new(a.body, pose), b, Solid::Surface)
    };
    let room = SLACK * (1.0 + found.upper);
    let right = found.state == StartState::Apart
        && found.lower <= found.upper
        && (found.point_a.distance(found.point_b) - found.value).abs() < room
        && !meets(found.lower - room)?
        && meets(found.upper + room)?;
    if right { Ok(()) } else { Err(wrong(&format!("{found:?}"))) }
}
