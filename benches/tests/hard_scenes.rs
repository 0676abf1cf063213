//! The hard scenes in small sizes: the engine against brute force over all pairs of features, which shares nothing with
//! its search: closed-form first contacts of each vertex with each face and each edge with each edge.

use d2m::bvh::{Answered, Posed, Window, distance};
use d2m::feature::{ContactOptions, FirstContact, PairMotion};
use d2m::glam::DVec3;
use d2m::motion::RigidMotion;
use d2m::{MeshTree, QueryOptions, Solid, TimeOfContact};
use d2m_benches::hard_scenes::{
    Expected, HardScene, grazing_cube, interlocked_rings, long_screw_in_nut, needles, screw_in_nut,
    shaft_in_bearing, sliding_box, table,
};
use std::collections::HashSet;
use std::f64::consts::PI;

/// Vertices, edges and faces, each once.
struct Features {
    vertices: Vec<DVec3>,
    edges: Vec<[DVec3; 2]>,
    faces: Vec<[DVec3; 3]>,
}

fn features(tree: &MeshTree) -> Features {
    let mesh = tree.mesh();
    let mut edges = HashSet::new();
    for t in mesh.triangles() {
        for k in 0..3 {
            let (p, q) = (t[k], t[(k + 1) % 3]);
            edges.insert([p.min(q), p.max(q)]);
        }
    }
    let mut edges: Vec<_> = edges.into_iter().collect();
    edges.sort_unstable();
    let at = |i: u32| mesh.vertices()[i as usize];
    Features {
        vertices: mesh.vertices().to_vec(),
        edges: edges.into_iter().map(|e| e.map(at)).collect(),
        faces: mesh.triangles().iter().map(|t| t.map(at)).collect(),
    }
}

/// Bracket of the first contact of any two features; none if all are proven clear.
fn brute_force(scene: &HardScene, tolerance: f64) -> Option<(f64, f64)> {
    let [a, b] = [0, 1].map(|k| features(&scene.bodies[k]));
    let window = Window::UNIT;
    let pair = PairMotion::new(&scene.motions[0], &scene.motions[1], window.start(), window.end());
    let options = ContactOptions::new().with_tolerance(tolerance);
    let mut first: Option<(f64, f64)> = None;
    let mut take = |answer: FirstContact| match answer {
        FirstContact::Clear => {}
        FirstContact::Contact(c) => {
            let (lo, hi) = first.unwrap_or((f64::INFINITY, f64::INFINITY));
            first = Some((lo.min(c.lo), hi.min(c.hi)));
        }
        FirstContact::Undecided { .. } => panic!("{}: a pair of features is undecided", scene.name),
    };
    for face in &b.faces {
        let placed = pair.place_triangle(face);
        a.vertices.iter().for_each(|&p| take(pair.point_placed(p, &placed, &options)));
    }
    for face in &a.faces {
        b.vertices.iter().for_each(|&p| take(pair.triangle_point(face, p, &options)));
    }
    for &ea in &a.edges {
        b.edges.iter().for_each(|&eb| take(pair.edge_edge(ea, eb, &options)));
    }
    first
}

fn agree(scene: &HardScene) {
    let tolerance = 1e-10;
    let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(tolerance);
    let answer = scene.ask_with(&options);
    assert_eq!(scene.fault(&answer), None);
    match (answer, brute_force(scene, tolerance)) {
        (TimeOfContact::Separated, None) => {}
        (TimeOfContact::Contact(contact), Some((lo, hi))) => {
            // Neither is later than the other's proof of contact, and both are about as early.
            assert!(contact.time_lo <= hi, "{}: {} after {hi}", scene.name, contact.time_lo);
            assert!((contact.time_lo - lo).abs() < 1e-6, "{}: {} and {lo}", scene.name, contact.time_lo);
        }
        (answer, other) => panic!("{}: {answer:?}, but features say {other:?}", scene.name),
    }
}

#[test]
fn small_scenes_agree_with_all_pairs_of_features() {
    for drift in [0.0, 0.8] {
        for gap in [1e-4, 1e-8, -1e-8, -1e-4] {
            agree(&grazing_cube(12, gap, drift));
        }
    }
    for gap in [1e-9, 1e-3] {
        for turn in [0.0, 1.0, 3.0] {
            agree(&sliding_box(12, gap, turn));
            agree(&sliding_box(48, gap, turn));
        }
    }
    for both in [false, true] {
        agree(&shaft_in_bearing(64, 1e-2, 0.0, both));
        agree(&shaft_in_bearing(64, 1e-6, 0.0, both));
        agree(&shaft_in_bearing(64, 1e-2, 0.02, both));
        agree(&shaft_in_bearing(64, 1e-6, 1e-5, both));
    }
    agree(&interlocked_rings(64, 0.0));
    agree(&interlocked_rings(64, 0.8));
    for spin in [0.0, 3.0, 40.0] {
        agree(&needles(1e6, 1e-9, spin));
        agree(&needles(1e3, -1e-9, spin));
    }
}

/// A screw that drifts off its axis meets the nut within the first sub-windows: it is searched from shortly before that on.
#[test]
fn screws_that_drift_are_skipped_up_to_their_contact() {
    let scene = screw_in_nut(4000, 1e-2, 0.5, 0.1);
    let options = QueryOptions::default().with_solid(Solid::Surface);
    let Answered { answer, work } = scene.ask_counted(&options);
    let TimeOfContact::Contact(contact) = answer else { panic!("{answer:?}") };
    assert!(work.node_tests + work.triangle_looks < 25_000, "{work:?}");
    for k in 0..=64 {
        let time = contact.time_lo * f64::from(k) / 64.0;
        let [a, b] = [0, 1].map(|k| Posed::new(&scene.bodies[k], scene.motions[k].pose_and_twist(time).0));
        let apart = distance(a, b, Solid::Filled).expect("watertight").upper;
        assert!(apart > contact.tolerance, "{apart} at {time}");
    }
}

#[test]
fn the_table_in_small_sizes_is_as_constructed() {
    for scene in table(0.02) {
        assert_eq!(scene.fault(&scene.ask()), None, "{}", scene.name);
    }
}

/// The clearances that scenes of screws claim, by the static distance at times over the whole motion and, densely, over
/// the step from one column of the mesh to the next, after which the same distances come again.
#[test]
fn screws_have_their_clearance() {
    let scenes = [
        long_screw_in_nut(2000, 1e-4),
        screw_in_nut(2000, 1e-4, 0.5, 0.0),
        screw_in_nut(15_360, 1e-4, 0.5, 0.0),
        screw_in_nut(2000, 1e-2, 0.5, 0.0),
    ];
    for scene in scenes {
        let Expected::Clear { clearance } = scene.expected else { panic!("{}", scene.name) };
        let [screw, nut] = &scene.bodies;
        let turns = scene.motions[0].angular_velocity().z / (2.0 * PI);
        // A column is at least a 64th of a turn: both meshes repeat within an eighth.
        let times =
            (0..=40).map(|k| f64::from(k) / 40.0).chain((1..40).map(|k| f64::from(k) / (320.0 * turns)));
        let mut least = f64::INFINITY;
        for t in times {
            let [a, b] = [0, 1].map(|k| scene.motions[k].pose_and_twist(t).0);
            let apart =
                distance(Posed::new(screw, a), Posed::new(nut, b), Solid::Filled).expect("watertight");
            least = least.min(apart.lower);
        }
        assert!(least > clearance && least < 3.0 * clearance + 5e-3, "{}: {least}", scene.name);
    }
}
