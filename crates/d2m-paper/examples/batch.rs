//! Runs the reference method over a file of trials and prints one CSV line a trial.
//!
//! `cargo run --release -p d2m-bvh --example paper_batch -- A.obj B.obj TRIALS.csv [LIMIT] [capoeira] > RESULTS.csv`
//!
//! Trials: qA(w,x,y,z), xA, vA, wA, qB, xB, vB, wB; t in [0, 1].

use d2m_bvh::{Mode, QueryOptions, TimeOfContact, TriMesh, Window};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::time::Instant;

fn load(path: &str) -> TriMesh {
    let text = std::fs::read_to_string(path).expect("a readable OBJ file");
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f64> = words.map(|w| w.parse().expect("a coordinate")).collect();
                vertices.push(DVec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let index = |w: &str| w.split('/').next().unwrap().parse::<u32>().expect("an index") - 1;
                let f: Vec<u32> = words.map(index).collect();
                triangles.extend((1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]]));
            }
            _ => {}
        }
    }
    TriMesh::try_new(vertices, triangles).expect("a mesh")
}

fn motion(c: &[f64]) -> ConstantTwist {
    let v = |i: usize| DVec3::new(c[i], c[i + 1], c[i + 2]);
    ConstantTwist::try_new(v(4), DQuat::from_xyzw(c[1], c[2], c[3], c[0]), v(7), v(10)).expect("a motion")
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let started = Instant::now();
    let tree_a = d2m_paper::SphereTree::new(load(&args[0]));
    let tree_b = if args[1] == args[0] { tree_a.clone() } else { d2m_paper::SphereTree::new(load(&args[1])) };
    eprintln!(
        "trees built in {:.3} s: {} and {} leaves",
        started.elapsed().as_secs_f64(),
        tree_a.leaf_count(),
        tree_b.leaf_count()
    );
    let limit = args.iter().find_map(|a| a.parse::<usize>().ok()).unwrap_or(usize::MAX);
    let mode = if args.iter().any(|a| a == "capoeira") { Mode::Capoeira } else { Mode::Accurate };
    let options = QueryOptions::default().with_mode(mode);
    println!(
        "trial,status,toc,toc_hi,separation,microseconds,normal_x,normal_y,normal_z,point_x,point_y,point_z,feature,triangle_a,triangle_b"
    );
    let trials = std::fs::read_to_string(&args[2]).expect("a readable file of trials");
    let mut times = vec![];
    for (trial, line) in trials.lines().take(limit).enumerate() {
        let c: Vec<f64> = line.split(',').map(|w| w.trim().parse().expect("a number")).collect();
        let (a, b) = (motion(&c[..13]), motion(&c[13..]));
        let started = Instant::now();
        let answer = d2m_paper::time_of_contact(
            d2m_paper::Moving::new(&tree_a, &a),
            d2m_paper::Moving::new(&tree_b, &b),
            Window::UNIT,
            &options,
        )
        .expect("good input");
        let us = started.elapsed().as_secs_f64() * 1e6;
        times.push(us);
        match answer {
            TimeOfContact::Separated => println!("{trial},separated,inf,inf,,{us:.1},,,,,,,,,"),
            TimeOfContact::Undecided { clear_until } => {
                println!("{trial},undecided,{clear_until:?},1,,{us:.1},,,,,,,,,");
            }
            TimeOfContact::Contact(k) => println!(
                "{trial},contact,{:?},{:?},{:?},{us:.1},{:?},{:?},{:?},{:?},{:?},{:?},{},{},{}",
                k.time_lo,
                k.time_hi,
                k.separation,
                k.normal.x,
                k.normal.y,
                k.normal.z,
                k.point_a.x,
                k.point_a.y,
                k.point_a.z,
                feature(&k.feature),
                k.triangle_a,
                k.triangle_b
            ),
        }
    }
    times.sort_by(f64::total_cmp);
    let n = times.len();
    if n > 0 {
        eprintln!(
            "{n} trials, microseconds: median {:.0}, mean {:.0}, max {:.0}",
            times[n / 2],
            times.iter().sum::<f64>() / n as f64,
            times[n - 1]
        );
    }
}

fn feature(f: &d2m_feature::FeaturePair) -> String {
    format!("{f:?}").replace([',', ' '], "_")
}
