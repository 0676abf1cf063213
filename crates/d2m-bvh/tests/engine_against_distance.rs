//! The engine on random small scenes, judged by static queries: before the contact the bodies are apart at every time
//! that is sampled, and at the certified time they are apart by (0, 3.3 δ].

use d2m_bvh::{
    MeshTree, Moving, Posed, QueryOptions, Solid, StartState, TimeOfContact, TriMesh, Window, collide,
    distance, time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// Closed: tetrahedron, octahedron, box or ring with stretched axes. Open: some triangles.
fn mesh(random: &mut KnuthRandom, closed: bool) -> TriMesh {
    let stretch = DVec3::new(0.2, 0.6, 1.0) + random.vector().abs();
    let surface = match (closed, random.index(4)) {
        (true, 0) => Surface::tetrahedron([(); 4].map(|()| random.vector())),
        (true, 1) => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            let faces = (0..8).map(|k| [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)]);
            let vertices = axes.iter().flat_map(|&a| [a, -a]).collect();
            Surface { name: "octahedron", vertices, triangles: faces.collect() }
        }
        (true, 2) => Surface::torus(3, 3, 0.4),
        (true, _) => Surface::torus(7, 5, 0.4),
        (false, _) => {
            let count = 1 + random.index(6);
            Surface::soup((0..count).flat_map(|_| {
                let base = random.vector();
                [base, base + random.vector() * 0.5, base + random.vector() * 0.5]
            }))
        }
    };
    surface.map(|p| p * stretch).into_mesh(TriMesh::try_new)
}

fn motion(random: &mut KnuthRandom) -> ConstantTwist {
    let spin = [0.0, 1.0, 4.0, 12.0][random.index(4)];
    let speed = [0.0, 2.0, 6.0, 40.0][random.index(4)];
    let turned = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), random.signed());
    let at = if random.index(3) == 0 { random.vector() } else { DVec3::ZERO };
    let place = random.vector() * 3.0;
    // Usually towards the middle, where the other one is.
    let towards = (random.vector() - place) * (0.3 * speed);
    ConstantTwist::try_new(place, turned, towards, random.vector() * spin).unwrap().with_at(at)
}

/// Counts of what was seen: contacts, separations, meetings at the start.
fn judge(count: usize, seed: u64) -> [usize; 3] {
    let mut random = KnuthRandom(seed);
    let mut seen = [0; 3];
    for scene in 0..count {
        let solid = if random.index(3) == 0 { Solid::Surface } else { Solid::Filled };
        let closed = solid == Solid::Filled;
        let trees = [(); 2].map(|()| MeshTree::new(mesh(&mut random, closed)));
        let motions = [(); 2].map(|()| motion(&mut random));
        let pose = |body: usize, t: f64| -> Pose { motions[body].pose_and_twist(t).0 };
        let posed = |t: f64| [Posed::new(&trees[0], pose(0, t)), Posed::new(&trees[1], pose(1, t))];
        let apart = |t: f64| {
            let [a, b] = posed(t);
            !collide(a, b, solid).unwrap()
        };
        let options = QueryOptions::default().with_solid(solid);
        let answer = time_of_contact(
            Moving::new(&trees[0], &motions[0]),
            Moving::new(&trees[1], &motions[1]),
            Window::UNIT,
            &options,
        )
        .unwrap();
        let what = format!("scene {scene} of seed {seed}: {answer:?}");
        let free_until = match answer {
            TimeOfContact::Separated => {
                seen[1] += 1;
                assert!(apart(1.0), "{what}");
                1.0
            }
            TimeOfContact::Contact(contact) => {
                let [a, b] = posed(contact.time_lo);
                let found = distance(a, b, solid).unwrap();
                if contact.start == StartState::Apart {
                    seen[0] += 1;
                    assert_eq!(found.state, StartState::Apart, "{what} {found:?}");
                    assert!(found.upper <= 3.3 * contact.tolerance, "{what} {found:?}");
                    assert!(
                        (found.value - contact.separation).abs() < 0.1 * contact.tolerance,
                        "{what} {found:?}"
                    );
                    assert!(contact.time_hi >= contact.time_lo && contact.time_lo >= 0.0);
                } else {
                    seen[2] += 1;
                    assert_eq!(contact.time_lo, 0.0);
                    assert!(found.lower <= 3.3 * contact.tolerance, "{what} {found:?}");
                    assert_eq!(
                        contact.start == StartState::Contained,
                        found.state == StartState::Contained,
                        "{what}"
                    );
                }
                contact.time_lo
            }
            TimeOfContact::Undecided { clear_until } => panic!("{what} {clear_until}"),
        };
        for k in 0..30 {
            // Also close to the end, where a late answer would show.
            let part = if k < 24 { f64::from(k) / 24.0 } else { 1.0 - 0.03 * 0.1f64.powi(k - 24) };
            let t = free_until * part;
            assert!(t >= free_until || apart(t), "{what}: met at {t}");
        }
    }
    seen
}

#[test]
fn nothing_before_the_contact_and_little_at_it() {
    let mut seen = [0; 3];
    for seed in 0..4 {
        for (all, new) in seen.iter_mut().zip(judge(2500, seed)) {
            *all += new;
        }
    }
    // Each kind of answer is met often.
    assert!(seen.iter().all(|&n| n > 400), "{seen:?}");
}

/// With a wanted separation d: further apart than d before, and within 3.3 δ of it at the certified time.
#[test]
fn a_wanted_separation_is_kept_until_the_time() {
    let mut random = KnuthRandom(77);
    let mut met = 0;
    for scene in 0..1000 {
        let trees = [(); 2].map(|()| MeshTree::new(mesh(&mut random, true)));
        let motions = [(); 2].map(|()| motion(&mut random));
        let wanted = [1e-6, 0.01, 0.3][scene % 3];
        let between = |t: f64| {
            let [a, b] = [0, 1].map(|body| Posed::new(&trees[body], motions[body].pose_and_twist(t).0));
            distance(a, b, Solid::Filled).unwrap()
        };
        let options = QueryOptions::default().with_min_separation(wanted);
        let [a, b] = [0, 1].map(|body| Moving::new(&trees[body], &motions[body]));
        let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let what = format!("scene {scene}: {answer:?}");
        let free_until = match answer {
            TimeOfContact::Separated => 1.0,
            TimeOfContact::Contact(contact) if contact.start == StartState::Apart => {
                met += 1;
                let found = between(contact.time_lo);
                let above = found.value - wanted;
                assert!(above > 0.0 && above <= 3.3 * contact.tolerance, "{what} {found:?}");
                contact.time_lo
            }
            TimeOfContact::Contact(contact) => {
                assert!(between(0.0).lower <= wanted + 3.3 * contact.tolerance, "{what}");
                0.0
            }
            TimeOfContact::Undecided { .. } => panic!("{what}"),
        };
        for k in 0..24 {
            let t = free_until * f64::from(k) / 24.0;
            assert!(free_until == 0.0 || between(t).value > wanted, "{what}: too close at {t}");
        }
    }
    assert!(met > 150, "{met}");
}
