//! Every shape at several sizes: closed, oriented, of the right genus, of the wanted size, without self-overlap.

use d2m_feature::{triangle_distance, triangles_intersect};
use d2m_mesh::{Topology, TriMesh, Validation};
use d2m_shapes::{SHAPES, Shape, ShapeError, mesh};
use glam::{DQuat, DVec3};

fn euler_characteristic(name: &str) -> i64 {
    match name {
        "torus" | "torus-knot" | "chain-link" | "gear" | "paddle-wheel" | "nut" | "bearing" => 0,
        "hollow-sphere" | "hollow-box" => 4,
        _ => 2,
    }
}

fn check(text: &str) -> TriMesh {
    let shape: Shape = text.parse().unwrap();
    let mesh = shape.build();
    let topology = Topology::new(&mesh);
    assert!(topology.is_oriented_manifold(), "{text}");
    assert_eq!(topology.position_count(), mesh.vertex_count(), "{text}: vertices coincide or are unused");
    assert_eq!(topology.euler_characteristic(), euler_characteristic(shape.info().name), "{text}");
    let validation = Validation::with_topology(&mesh, &topology);
    assert!(validation.signed_volume > 0.0, "{text}: volume {}", validation.signed_volume);
    assert_eq!((validation.degenerate_triangles, validation.duplicate_triangles), (0, 0), "{text}");
    mesh
}

fn farthest(mesh: &TriMesh) -> f64 {
    mesh.vertices().iter().map(|vertex| vertex.length()).fold(0.0, f64::max)
}

#[test]
fn every_shape_is_a_closed_oriented_manifold_of_the_wanted_size() {
    for info in SHAPES {
        let mesh = check(info.name);
        if !["box", "plate", "nut", "shaft", "bearing"].contains(&info.name) {
            assert!((farthest(&mesh) - 1.0).abs() < 1e-12, "{}: {}", info.name, farthest(&mesh));
        }
        let Some(least) = info.parameters.iter().find(|p| p.name == "triangles").map(|p| p.low) else {
            continue;
        };
        for wanted in [least, 1.7 * least, 5.0 * least, 2000.0, 20_000.0, 200_000.0] {
            let wanted = wanted.max(least).round();
            let text = format!("{}?triangles={wanted}", info.name);
            let count = check(&text).triangle_count() as f64;
            // A gear has as many triangles as its teeth need.
            if wanted < 1000.0 && ["gear", "paddle-wheel"].contains(&info.name) {
                continue;
            }
            let allowed = if wanted >= 50.0 * least { 0.15 } else { 1.2 };
            assert!(
                (count / wanted).ln().abs() < f64::ln(1.0 + allowed),
                "{}: {count} for {wanted}",
                info.name
            );
        }
    }
}

#[test]
fn scale_scales() {
    assert!((farthest(&mesh("gear?scale=2.5").unwrap()) - 2.5).abs() < 1e-12);
    assert!((farthest(&mesh("tetrahedron?scale=1e-6").unwrap()) - 1e-6).abs() < 1e-18);
}

#[test]
fn a_million_triangles() {
    for name in ["torus-knot", "screw", "pebble"] {
        let count = mesh(&format!("{name}?triangles=1000000")).unwrap().triangle_count();
        assert!(count.abs_diff(1_000_000) < 40_000, "{name}: {count}");
    }
}

/// Pairs of triangles without a common vertex must not meet. Sorted by x, so that only neighbours are compared.
fn assert_no_self_overlap(text: &str) {
    let mesh = mesh(text).unwrap();
    let boxes: Vec<(DVec3, DVec3)> = (0..mesh.triangle_count())
        .map(|triangle| {
            let [a, b, c] = mesh.corners(triangle);
            (a.min(b).min(c), a.max(b).max(c))
        })
        .collect();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| boxes[i].0.x.total_cmp(&boxes[j].0.x));
    for (place, &i) in order.iter().enumerate() {
        for &j in order[place + 1..].iter().take_while(|&&j| boxes[j].0.x <= boxes[i].1.x) {
            let apart = boxes[i].1.cmplt(boxes[j].0).any() || boxes[j].1.cmplt(boxes[i].0).any();
            let shared = mesh.triangles()[i].iter().any(|vertex| mesh.triangles()[j].contains(vertex));
            if !apart && !shared {
                assert!(
                    !triangles_intersect(&mesh.corners(i), &mesh.corners(j)),
                    "{text}: triangles {i} and {j} overlap"
                );
            }
        }
    }
}

#[test]
fn no_shape_overlaps_itself() {
    for info in SHAPES {
        assert_no_self_overlap(info.name);
    }
    for text in [
        "torus-knot?triangles=3000&p=3&q=2&tube=0.3",
        "torus-knot?triangles=3000&p=2&q=5&tube=0.18",
        "torus-knot?triangles=3000&p=5&q=2&tube=0.18",
        "torus-knot?triangles=6000&p=7&q=6&tube=0.128",
        "torus-knot?triangles=3000&p=1&q=7&tube=0.128",
        "torus-knot?triangles=3000&p=7&q=1&tube=0.128",
        "pebble?roughness=1&seed=7",
        "chain-link?tube=0.9&straight=0.01",
        "gear?teeth=4&depth=0.5&bore=0.45",
        "gear?teeth=100&thickness=0.01&triangles=8000",
        "paddle-wheel?blades=24",
        "paddle-wheel?blades=3",
        "nut?clearance=0.03",
    ] {
        check(text);
        assert_no_self_overlap(text);
    }
}

/// The smallest distance of two meshes by trying all pairs whose boxes are near.
fn distance(a: &TriMesh, b: &TriMesh, cutoff: f64) -> f64 {
    let mut best = cutoff;
    for i in 0..a.triangle_count() {
        let s = a.corners(i);
        let (low, high) = (s[0].min(s[1]).min(s[2]) - best, s[0].max(s[1]).max(s[2]) + best);
        for j in 0..b.triangle_count() {
            let t = b.corners(j);
            let (t_low, t_high) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
            if !(high.cmplt(t_low).any() || t_high.cmplt(low).any()) {
                best = best.min(triangle_distance(&s, &t).lower);
            }
        }
    }
    best
}

/// Turning the nut by any angle while it climbs pitch·angle/2π keeps the threads apart by nearly the clearance.
#[test]
fn the_nut_really_screws() {
    let screw = mesh("screw?triangles=2000").unwrap();
    let pitch = 0.2 / (0.85_f64 * 0.85 + 0.36).sqrt();
    for clearance in [0.01, 1e-3, 1e-4] {
        let nut = mesh(&format!("nut?triangles=1000&clearance={clearance}")).unwrap();
        let requested = clearance / (0.85_f64 * 0.85 + 0.36).sqrt();
        for angle in [0.0, 0.05, 0.13, 0.2, 0.37, -1.0, std::f64::consts::PI / 12.0] {
            let turn = DQuat::from_rotation_z(angle);
            let climb = DVec3::Z * (pitch * angle / std::f64::consts::TAU);
            let vertices = nut.vertices().iter().map(|&vertex| turn * vertex + climb).collect();
            let turned = TriMesh::try_new(vertices, nut.triangles().to_vec()).unwrap();
            let gap = distance(&screw, &turned, 0.02);
            // Twelve columns: where vertices face vertices the play is larger by the height of a chord; where they
            // face the middles of chords it is what was requested, less the slope of the flanks.
            let chord = if angle > 0.2 && angle < 0.3 { 0.001 } else { 0.01 };
            assert!(
                gap > 0.5 * requested && gap < requested + chord,
                "clearance {requested}, angle {angle}: gap {gap}"
            );
        }
        // Turning without climbing runs the flanks into each other.
        let turn = DQuat::from_rotation_z(std::f64::consts::PI);
        let vertices = nut.vertices().iter().map(|&vertex| turn * vertex).collect();
        let stuck = TriMesh::try_new(vertices, nut.triangles().to_vec()).unwrap();
        assert_eq!(distance(&screw, &stuck, 0.02), 0.0);
    }
}

#[test]
fn the_shaft_turns_in_its_bearing() {
    let shaft = mesh("shaft?triangles=500").unwrap();
    for clearance in [1e-2, 1e-6] {
        let bearing = mesh(&format!("bearing?triangles=400&clearance={clearance}")).unwrap();
        for angle in [0.0, 0.1, 0.77] {
            let turn = DQuat::from_rotation_z(angle);
            let vertices = shaft.vertices().iter().map(|&vertex| turn * vertex).collect();
            let turned = TriMesh::try_new(vertices, shaft.triangles().to_vec()).unwrap();
            let gap = distance(&turned, &bearing, 0.1);
            assert!(gap > 0.99 * clearance - 1e-14 && gap < clearance + 0.03, "angle {angle}: gap {gap}");
        }
    }
}

#[test]
fn the_same_bits_every_time_and_everywhere() {
    // FNV-1a over all coordinates and indices: a change of these numbers is a change of the shapes.
    let mut found = Vec::new();
    for (text, _) in GOLDEN {
        let mesh = mesh(text).unwrap();
        let coordinates = mesh.vertices().iter().flat_map(glam::DVec3::to_array).map(f64::to_bits);
        let indices = mesh.triangles().iter().flatten().map(|&vertex| u64::from(vertex));
        let hash = coordinates.chain(indices).fold(0xcbf2_9ce4_8422_2325_u64, |hash, word| {
            word.to_le_bytes()
                .iter()
                .fold(hash, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
        });
        found.push((text, hash));
    }
    assert_eq!(found, GOLDEN, "{found:#x?}");
}

const GOLDEN: [(&str, u64); 6] = [
    ("icosphere", 0xa19d_6d35_efc2_33a4),
    ("torus-knot", 0xe2bc_1bf1_37e3_f461),
    ("gear", 0x64a3_6119_21f9_71b1),
    ("screw", 0x0015_d399_43d4_30ec),
    ("nut", 0x098c_a5e1_8a69_d3a7),
    ("pebble?seed=3", 0x6b0e_c655_812a_22e2),
];

#[test]
fn refusals_say_what_is_wrong() {
    let message = |text: &str| mesh(text).unwrap_err().to_string();
    assert!(message("sfere").starts_with("there is no shape \"sfere\"; shapes are box, tetrahedron, "));
    assert!(message("").starts_with("there is no shape \"\"; shapes are "));
    for (name, meant) in
        [("cube", "box"), ("Sphere", "icosphere"), ("tours", "torus"), ("GEAR", "gear"), ("nutt", "nut")]
    {
        let hint = format!("there is no shape {name:?}; is {meant} meant? shapes are box, ");
        assert!(message(name).starts_with(&hint), "{}", message(name));
    }
    assert_eq!(
        message("torus?radius=2"),
        "shape torus: there is no parameter \"radius\"; it has triangles, tube, scale"
    );
    assert_eq!(message("torus?triangles"), "shape torus: \"triangles\" should be parameter=value");
    assert_eq!(message("torus?triangles="), "shape torus: triangles= is not a number");
    assert_eq!(message("torus?triangles=20&triangles=20"), "shape torus: triangles is given twice");
    assert_eq!(
        message("torus?triangles=20.5"),
        "shape torus: triangles=20.5 is out of range, it must be a whole number from 18 to 20000000"
    );
    assert!(message("gear?teeth=1e300").starts_with("shape gear: teeth=1e300 is out of range"));
    for value in ["nan", "inf", "-1", "1e300"] {
        assert!(
            matches!(mesh(&format!("torus?tube={value}")), Err(ShapeError::OutOfRange { .. })),
            "{value}"
        );
    }
    assert_eq!(message("torus-knot?p=2&q=4"), "shape torus-knot: p=2 and q=4 have the common divisor 2");
    assert!(message("torus-knot?q=5&tube=0.4").contains("too thick"));
    assert_eq!(message("tetrahedron?x=1"), "shape tetrahedron: there is no parameter \"x\"; it has scale");
}
