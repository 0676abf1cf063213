//! Runs a file of trials: `trials A.obj B.obj TRIALS.csv [RESULTS.csv]`, prints median times.
//! Each line of the file: qA(w,x,y,z), xA, vA, wA, qB, xB, vB, wB; time runs over [0, 1].

use d2m_bvh::{
    MeshTree, Moving, QueryOptions, TimeOfContact, TriMesh, Window, time_of_contact, time_of_contact_counted,
};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::fmt::Write;
use std::time::Instant;

fn load(path: &str) -> MeshTree {
    let text = std::fs::read_to_string(path).expect("readable mesh");
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f64> = words.map(|w| w.parse().expect("number")).collect();
                vertices.push(DVec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let f: Vec<u32> =
                    words.map(|w| w.split('/').next().unwrap().parse::<u32>().expect("index") - 1).collect();
                for k in 1..f.len() - 1 {
                    triangles.push([f[0], f[k], f[k + 1]]);
                }
            }
            _ => {}
        }
    }
    let mesh = TriMesh::try_new(vertices, triangles).expect("good mesh");
    let count = mesh.triangle_count() as f64;
    let clock = Instant::now();
    let tree = MeshTree::new(mesh);
    eprintln!(
        "{path}: {count} triangles, built in {:.2} us a triangle, {:.0} bytes a triangle",
        clock.elapsed().as_secs_f64() * 1e6 / count,
        tree.memory_bytes() as f64 / count
    );
    tree
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (a, b) = (load(&arguments[0]), load(&arguments[1]));
    let text = std::fs::read_to_string(&arguments[2]).expect("readable trials");
    let rounds: usize = std::env::var("ROUNDS").ok().and_then(|r| r.parse().ok()).unwrap_or(5);
    let mut options = QueryOptions::default();
    options.tolerance = Some(1e-10);
    let motion = |c: &[f64]| {
        ConstantTwist::try_new(
            DVec3::new(c[4], c[5], c[6]),
            DQuat::from_xyzw(c[1], c[2], c[3], c[0]),
            DVec3::new(c[7], c[8], c[9]),
            DVec3::new(c[10], c[11], c[12]),
        )
        .expect("good motion")
    };
    let motions: Vec<_> = text
        .lines()
        .map(|line| {
            let c: Vec<f64> = line.split(',').map(|w| w.trim().parse().expect("number")).collect();
            (motion(&c[..13]), motion(&c[13..]))
        })
        .collect();
    let mut best = vec![f64::INFINITY; motions.len()];
    let mut answers = vec![TimeOfContact::Separated; motions.len()];
    for _ in 0..rounds {
        for (trial, (ma, mb)) in motions.iter().enumerate() {
            let clock = Instant::now();
            answers[trial] =
                time_of_contact(Moving::new(&a, ma), Moving::new(&b, mb), Window::UNIT, &options)
                    .expect("good query");
            best[trial] = best[trial].min(clock.elapsed().as_secs_f64() * 1e6);
        }
    }
    let mut out = String::from("trial,toc,separation,microseconds\n");
    for (trial, answer) in answers.iter().enumerate() {
        let (time, separation) = match answer {
            TimeOfContact::Separated => (f64::INFINITY, f64::INFINITY),
            TimeOfContact::Contact(contact) => (contact.time_lo, contact.separation),
            TimeOfContact::Undecided { clear_until } => (-clear_until, 0.0),
        };
        writeln!(out, "{trial},{time:?},{separation:e},{:.2}", best[trial]).unwrap();
    }
    if let Some(path) = arguments.get(3) {
        // A new file only: a path in the wrong place must not cost anybody data.
        let mut file = std::fs::File::create_new(path).expect("results go to a file that does not exist yet");
        std::io::Write::write_all(&mut file, out.as_bytes()).expect("writable results");
    }
    let mut counts: Vec<_> = motions
        .iter()
        .map(|(ma, mb)| {
            let (a, b) = (Moving::new(&a, ma), Moving::new(&b, mb));
            time_of_contact_counted(a, b, Window::UNIT, &options).expect("good query").work
        })
        .collect();
    counts.sort_by_key(|c| c.node_tests + c.triangle_looks);
    println!("{:?}", counts[counts.len() / 2]);
    let mean = |f: fn(&d2m_bvh::SearchCounts) -> u64| counts.iter().map(f).sum::<u64>() / counts.len() as u64;
    println!(
        "means: windows {} frames {} tests {} queued {} looks {}",
        mean(|c| c.windows),
        mean(|c| c.frames),
        mean(|c| c.node_tests),
        mean(|c| c.queued),
        mean(|c| c.triangle_looks)
    );
    best.sort_by(f64::total_cmp);
    println!("median {:.2} us, worst {:.2} us", best[best.len() / 2], best[best.len() - 1]);
}
