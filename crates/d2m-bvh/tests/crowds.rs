//! Many pairs of triangles that come together at the same time: the work does not grow with their number.

use d2m_bvh::{
    Answered, Budget, MeshTree, Mode, Moving, QueryOptions, Solid, StartState, TimeOfContact, TriMesh,
    Window, time_of_contact_counted,
};
use d2m_motion::ConstantTwist;
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::DVec3;

/// Node tests and tests of triangle pairs of one query, at most.
const MOST_WORK: u64 = 200_000;

fn tree(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> MeshTree {
    MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap())
}

/// Apex at the origin, base circle at z = up, closed.
fn cone(n: u32, up: f64) -> MeshTree {
    MeshTree::new(Surface::cone(n, 1.0, up).into_mesh(TriMesh::try_new))
}

/// Bodies that touch at the start: 2¹² steps for each part of the decision whether they do, a plane between the whole bodies among them, and few
/// for the search.
const MOST_AT_THE_START: u64 = 1 << 15;

/// Slivers from the origin in all directions of a half-space; their ends deviate from it by up to a thousandth.
fn spikes(random: &mut KnuthRandom, n: u32, up: f64) -> MeshTree {
    let (mut vertices, mut triangles) = (vec![DVec3::ZERO], Vec::new());
    for _ in 0..n {
        let d = random.vector().normalize();
        let first = vertices.len() as u32;
        vertices.push(DVec3::new(d.x, d.y, d.z.abs() * up));
        vertices.push(vertices[first as usize] + random.vector() * 1e-3);
        triangles.push([0, first, first + 1]);
    }
    tree(vertices, triangles)
}

/// One triangle many times.
fn copies(n: u32) -> MeshTree {
    tree(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]; n as usize])
}

fn query(
    a: &MeshTree,
    b: &MeshTree,
    motion: &ConstantTwist,
    options: &QueryOptions,
) -> Answered<TimeOfContact> {
    let options = options.with_budget(Budget::UNLIMITED.with_node_tests(20 * MOST_WORK));
    time_of_contact_counted(
        Moving::new(a, motion),
        Moving::new(b, &ConstantTwist::REST),
        Window::UNIT,
        &options,
    )
    .unwrap()
}

fn falling(place: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_position(place).with_linear_velocity(-DVec3::Z)
}

#[track_caller]
fn meets_at(Answered { answer, work }: &Answered<TimeOfContact>, time: f64) {
    let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?} {work:?}"));
    assert!(contact.time_lo <= time && contact.time_lo > time - 4.0 * contact.tolerance, "{contact:?}");
    assert!(contact.separation <= 3.3 * contact.tolerance, "{contact:?}");
    assert!(work.node_tests + work.triangle_looks + work.swept_pairs < MOST_WORK, "{work:?}");
}

#[test]
fn fans_meet_at_their_apexes() {
    let options = QueryOptions::default();
    for n in [400, 1500] {
        let (a, b) = (cone(n, 1.0), cone(n, -1.0));
        meets_at(&query(&a, &b, &falling(DVec3::Z * 0.5), &options), 0.5);
        // Obliquely: the line between the apexes separates nothing else.
        let oblique = DVec3::new(0.25, 0.125, 0.5);
        let motion = ConstantTwist::REST.with_position(oblique).with_linear_velocity(-oblique);
        meets_at(&query(&a, &b, &motion, &options), 1.0);
        let touching = query(&a, &b, &ConstantTwist::REST, &options);
        assert_eq!(touching.answer.contact().unwrap().start, StartState::Touching);
        assert!(touching.work.work() < MOST_AT_THE_START, "{touching:?}");
    }
}

/// One apex passes above the other: all pairs come near at the same time and none meets. Only the plane between the two
/// crowds separates them, over the whole span.
#[test]
fn fans_pass_each_other() {
    for n in [400, 1500] {
        let (a, b) = (cone(n, 1.0), cone(n, -1.0));
        for gap in [1e-3, 1e-6, 1e-8] {
            let place = DVec3::new(-0.5, 0.0, gap);
            let passing = ConstantTwist::REST.with_position(place).with_linear_velocity(DVec3::X);
            for mode in [Mode::Accurate, Mode::Exists, Mode::Capoeira] {
                let options = QueryOptions::default().with_mode(mode);
                let Answered { answer, work } = query(&a, &b, &passing, &options);
                if mode != Mode::Capoeira {
                    assert!(answer.is_separated(), "{n} {gap} {mode:?} {answer:?} {work:?}");
                }
                assert!(work.node_tests + work.triangle_looks + work.swept_pairs < MOST_WORK, "{work:?}");
            }
        }
    }
}

/// An early stop in a crowd: the search follows one pair instead of all that may come first.
#[test]
fn crowds_stop_early() {
    let options = QueryOptions::default().with_mode(Mode::Capoeira);
    for n in [400, 1500] {
        let (a, b) = (cone(n, 1.0), cone(n, -1.0));
        let Answered { answer, work } = query(&a, &b, &falling(DVec3::Z * 0.5), &options);
        let contact = answer.contact().unwrap();
        assert!(contact.time_lo <= 0.5, "{contact:?}");
        assert!(work.node_tests + work.triangle_looks < 10_000, "{work:?}");
    }
}

#[test]
fn stars_meet_at_their_centers() {
    let mut random = KnuthRandom(5);
    // No plane parts all of the larger ones: their ends deviate.
    for n in [1500, 3000, 7000, 10_000] {
        let (a, b) = (spikes(&mut random, n, 1.0), spikes(&mut random, n, -1.0));
        let surfaces = QueryOptions::default().with_solid(Solid::Surface);
        meets_at(&query(&a, &b, &falling(DVec3::Z * 0.5), &surfaces), 0.5);
    }
}

#[test]
fn copies_of_a_face_meet() {
    let (a, b) = (copies(700), copies(700));
    let surfaces = QueryOptions::default().with_solid(Solid::Surface);
    meets_at(&query(&a, &b, &falling(DVec3::Z * 0.5), &surfaces), 0.5);
    let same = query(&a, &b, &ConstantTwist::REST, &surfaces);
    // Sheets that lie in each other touch: one is lifted off the other.
    assert_eq!(same.answer.contact().unwrap().start, StartState::Touching);
    assert!(same.work.work() < MOST_AT_THE_START, "{same:?}");
    // Past each other at a thousandth of a tolerance more than the search needs: no contact.
    let passing =
        ConstantTwist::REST.with_position(DVec3::new(-2.0, 0.0, 1e-6)).with_linear_velocity(DVec3::X * 4.0);
    assert!(query(&a, &b, &passing, &surfaces).answer.is_separated());
}
