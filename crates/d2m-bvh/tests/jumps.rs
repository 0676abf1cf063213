//! Pieces of a motion that do not quite meet: nothing is jumped over.

use d2m_bvh::{MeshTree, Mode, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact};
use d2m_motion::{Chain, ConstantTwist, Joint, JointKind, JointValue, Keyframes, RigidMotion};
use d2m_testing::Opaque;
use glam::{DQuat, DVec3};

/// One triangle across the x-axis.
fn sheet(size: f64) -> MeshTree {
    let corners = [DVec3::new(0.0, -1.0, -1.0), DVec3::new(0.0, 1.0, -1.0), DVec3::new(0.0, 0.0, 1.0)];
    MeshTree::new(TriMesh::try_new(corners.map(|p| p * size).to_vec(), vec![[0, 1, 2]]).unwrap())
}

/// Along x to −`half`, at time 1 on to `half`, and away.
fn motions(half: f64, far: f64) -> Vec<(&'static str, Box<dyn RigidMotion + Send>)> {
    let pieces = vec![vec![-far, far - half], vec![half, far]];
    let value = JointValue::try_pieces(vec![0.0, 1.0, 2.0], pieces).unwrap();
    let kind = JointKind::Prismatic { axis: DVec3::X, value };
    let chain = Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap();
    let flight = |x: f64, v: f64, t: f64| {
        let flight = ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * v);
        flight.with_reference_time(t)
    };
    let mut all: Vec<(&'static str, Box<dyn RigidMotion + Send>)> =
        vec![("chain", Box::new(chain.clone())), ("own", Box::new(Opaque(chain)))];
    let spans = vec![flight(-far, far - half, 0.0), flight(half, far, 1.0)];
    if let Ok(keyframes) = Keyframes::try_from_spans(vec![0.0, 1.0, 2.0], spans) {
        all.push(("keyframes", Box::new(keyframes)));
    }
    all
}

#[test]
fn nothing_is_jumped_over() {
    let rest = ConstantTwist::REST;
    let mut met = 0;
    for size in [1e-6, 1.0] {
        let sheet = sheet(size);
        for half in [4e-10, 1e-11, 1e-12] {
            for (name, motion) in motions(half, 3.0 * size) {
                let bodies = [Moving::new(&sheet, &*motion), Moving::new(&sheet, &rest)];
                for [a, b] in [bodies, [bodies[1], bodies[0]]] {
                    for mode in [Mode::Accurate, Mode::Exists] {
                        let options = QueryOptions::default()
                            .with_mode(mode)
                            .with_solid(Solid::Surface)
                            .with_tolerance(1e-13);
                        for end in [1.0, 1.5, 2.0] {
                            let window = Window::try_new(0.0, end).unwrap();
                            let answer = time_of_contact(a, b, window, &options).unwrap();
                            let TimeOfContact::Contact(contact) = answer else {
                                panic!("{name} {size:e} {half:e} {end}: {answer:?}")
                            };
                            assert!((contact.time_lo - 1.0).abs() < 1e-2, "{name} {half:e}: {contact:?}");
                            assert!(contact.separation <= 3.3 * contact.tolerance, "{name}: {contact:?}");
                            assert!(contact.tolerance <= 8.0 * half.max(1e-13), "{name}: {contact:?}");
                            met += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(met > 100, "{met}");
    // What is beside is not met.
    let away = ConstantTwist::REST.with_position(DVec3::Y * 1e-5);
    let small = sheet(1e-6);
    for (name, motion) in motions(4e-10, 3e-6) {
        let (a, b) = (Moving::new(&small, &*motion), Moving::new(&small, &away));
        let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(1e-13);
        let answer = time_of_contact(a, b, Window::try_new(0.0, 2.0).unwrap(), &options).unwrap();
        assert!(answer.is_separated(), "{name}: {answer:?}");
    }
}
