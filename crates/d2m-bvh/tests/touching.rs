//! Touching distinguished from overlapping: planted contacts with known normals, exact numbers an ulp apart and an ulp in, twins.

use d2m_bvh::{
    Distance, Evidence, MeshTree, Moving, Posed, Proximity, QueryOptions, Solid, StartState, TriMesh, Window,
    departure, distance, proximities, time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose};
use d2m_testing::{Draw, KnuthRandom, PlantedTouch, Surface, Touch};
use glam::{DQuat, DVec3};

fn tree(surface: Surface) -> MeshTree {
    MeshTree::new(surface.into_mesh(TriMesh::try_new))
}

fn cuboid(low: DVec3, high: DVec3) -> MeshTree {
    tree(Surface::cuboid(low, high))
}

fn shifted(by: DVec3) -> Pose {
    Pose { translation: by, ..Pose::IDENTITY }
}

fn state(a: &MeshTree, b: &MeshTree, by: DVec3) -> Distance {
    distance(Posed::at_rest(a), Posed::new(b, shifted(by)), Solid::Filled).unwrap()
}

/// An open table of squares in the plane z = 0, corners at whole numbers.
fn squares(half: i32) -> MeshTree {
    let corner = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
    let cells = (-half..half).flat_map(|x| (-half..half).map(move |y| (x, y)));
    tree(Surface::soup(cells.flat_map(|(x, y)| {
        let [p, q, r, s] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [p, q, r, p, r, s]
    })))
}

/// A cube on a table at quarter steps: vertices on vertices, on edges and diagonals, edges along edges, faces on faces. The same from
/// above and below, by a distance, by a query of moving bodies, and with the bodies exchanged.
#[test]
fn a_cube_on_a_table_at_quarter_steps() {
    let corner = cuboid(DVec3::ZERO, DVec3::ONE);
    let middle = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let plate = cuboid(DVec3::new(-4.0, -4.0, -1.0), DVec3::new(4.0, 4.0, 0.0));
    let sheet = tree(Surface::soup(
        [(-4, -4), (4, -4), (4, 4), (-4, -4), (4, 4), (-4, 4)]
            .map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0)),
    ));
    let tables = [(&plate, Solid::Filled), (&sheet, Solid::Surface), (&squares(4), Solid::Surface)];
    let mut right = 0;
    for (table, solid) in tables {
        for (cube, height) in [(&corner, 0.0), (&middle, 0.5)] {
            for (i, j) in (-12..=12).flat_map(|i| (-12..=12).map(move |j| (i, j))) {
                let at = DVec3::new(f64::from(i) * 0.25, f64::from(j) * 0.25, height);
                let place = ConstantTwist::REST.with_position(at).with_linear_velocity(DVec3::Z);
                let table_at_rest = Moving::new(table, &ConstantTwist::REST).with_solid(solid);
                let options = QueryOptions::default();
                let lifted = Moving::new(cube, &place);
                let answer = time_of_contact(table_at_rest, lifted, Window::UNIT, &options).unwrap();
                let contact = answer.contact().expect("they touch");
                assert_eq!(contact.start, StartState::Touching, "{at}");
                assert!((contact.normal - DVec3::Z).length() < 1e-9, "{at} {contact:?}");
                assert!(
                    (contact.point_a - contact.point_b).length() < 1e-12 && contact.point_a.z.abs() < 1e-12
                );
                if (i + j) % 5 == 0 {
                    let found =
                        distance(Posed::new(cube, shifted(at)), Posed::at_rest(table), Solid::Surface)
                            .unwrap();
                    assert_eq!((found.state, found.value, found.lower), (StartState::Touching, 0.0, 0.0));
                    assert!((found.normal + DVec3::Z).length() < 1e-9, "{at} {found:?}");
                }
                right += 1;
            }
        }
    }
    assert_eq!(right, 6 * 625);
}

/// Vertex on face, face on face, edge on face, edge across edge, of turned bodies whose numbers are rounded: touching, with the normal that
/// was planted; pushed in by a millionth of their size they overlap, and pulled apart they are apart.
#[test]
fn planted_touches_have_their_normals() {
    let mut random = KnuthRandom(2027);
    let mut counts = [0; 4];
    for round in 0..400 {
        let kind = round % 4;
        // Planted only where the plane truly is between both.
        let Some(PlantedTouch { bodies: [a, b], shift, normal, size }) =
            PlantedTouch::draw(&mut random, Touch::ALL[kind])
        else {
            continue;
        };
        // Both in a frame that is turned, so that no number is exact.
        let frame = random.moderate_turn().normalize();
        let in_frame = Pose { rotation: frame, ..Pose::IDENTITY };
        let (first, second) = (tree(a), tree(b));
        let pose = |depth: f64| Pose { translation: frame * (shift - normal * depth), ..in_frame };
        let posed = |depth: f64| [Posed::new(&first, in_frame), Posed::new(&second, pose(depth))];
        let found = |depth: f64| {
            let [a, b] = posed(depth);
            distance(a, b, Solid::Filled).unwrap()
        };
        let normal = frame * normal;
        let touching = found(0.0);
        assert_eq!(touching.state, StartState::Touching, "{round} {kind} {touching:?}");
        assert!(touching.upper <= 1e-12 * size, "{round} {kind} {touching:?}");
        assert!((touching.normal - normal).length() < 1e-6, "{round} {kind} {normal} {touching:?}");
        counts[kind] += 1;
        assert_eq!(found(1e-6 * size).state, StartState::Overlapping, "{round} {kind}");
        assert_eq!(found(-1e-6 * size).state, StartState::Apart, "{round} {kind}");
        let [a, b] = posed(0.0);
        let near = proximities(a, b, 1e-3 * size).unwrap();
        let is_touch = |p: &Proximity| p.distance <= 1e-12 * size && (p.normal - normal).length() < 1e-6;
        assert!(near.iter().any(is_touch), "{round} {kind}");
    }
    assert!(counts.iter().all(|count| *count >= 25), "{counts:?}");
}

/// Exact numbers: an ulp apart, touching, an ulp in. Half turns and far places are exact, too.
#[test]
fn exact_numbers_are_judged_exactly() {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE);
    let post = tree(
        Surface::tetrahedron([
            DVec3::ZERO,
            DVec3::new(-0.25, -0.25, 1.0),
            DVec3::new(0.5, -0.25, 1.0),
            DVec3::new(-0.25, 0.5, 1.0),
        ])
        .inverted(),
    );
    let on = DVec3::new(0.5, 0.25, 1.0);
    let touching = state(&cube, &post, on);
    assert_eq!(touching.state, StartState::Touching);
    assert!((touching.normal - DVec3::Z).length() < 1e-9);
    let height = |ulps: i64| f64::from_bits((1.0_f64.to_bits() as i64 + ulps) as u64);
    for ulps in 1..4 {
        assert_eq!(state(&cube, &post, on.with_z(height(-ulps))).state, StartState::Overlapping, "{ulps}");
        let above = state(&cube, &post, on.with_z(height(ulps)));
        assert_ne!(above.state, StartState::Overlapping);
    }
    // The deepest point of a shift that no double holds.
    let deep = state(&cube, &post, on - DVec3::Z * 1e-16);
    assert_eq!((on - DVec3::Z * 1e-16).z, height(-1));
    assert_eq!(deep.state, StartState::Overlapping);
    let turned = Pose {
        rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0),
        translation: DVec3::new(0.5, 0.75, 0.0),
        at: DVec3::ZERO,
    };
    for (z, expected) in
        [(0.0, StartState::Touching), (1e-17, StartState::Overlapping), (5e-324, StartState::Overlapping)]
    {
        let pose = Pose { translation: turned.translation.with_z(z), ..turned };
        let found = distance(Posed::at_rest(&cube), Posed::new(&post, pose), Solid::Filled).unwrap();
        assert_eq!(found.state, expected, "{z}");
    }
    for far in [1e6, 1e9] {
        let far = DVec3::splat(far);
        let found =
            distance(Posed::new(&cube, shifted(far)), Posed::new(&post, shifted(far + on)), Solid::Filled)
                .unwrap();
        assert_eq!(found.state, StartState::Touching, "{far}");
        assert!((found.normal - DVec3::Z).length() < 1e-9);
    }
}

/// Faces that are flush, in every way that two boxes can be.
#[test]
fn flush_boxes() {
    let cube = cuboid(DVec3::ZERO, DVec3::ONE);
    for (low, high, expected) in [
        // Side by side with common planes; on an edge; on a corner.
        ([1.0, 0.0, 0.0], [2.0, 1.0, 1.0], StartState::Touching),
        ([1.0, 1.0, 0.0], [2.0, 2.0, 1.0], StartState::Touching),
        ([1.0, 1.0, 1.0], [2.0, 2.0, 2.0], StartState::Touching),
        ([1.0, 0.25, 0.25], [2.0, 0.75, 0.75], StartState::Touching),
        // The same, a corner inside, a common plane, common planes all around, through and through.
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], StartState::Overlapping),
        ([0.5, 0.5, 0.5], [2.0, 2.0, 2.0], StartState::Overlapping),
        ([0.5, 0.5, 0.0], [2.0, 2.0, 1.0], StartState::Overlapping),
        ([0.5, 0.0, 0.0], [1.5, 1.0, 1.0], StartState::Overlapping),
        ([-1.0, 0.0, 0.0], [2.0, 1.0, 1.0], StartState::Overlapping),
        ([-1.0, 0.25, 0.25], [2.0, 0.75, 0.75], StartState::Overlapping),
        // Inside, with a common face.
        ([0.25, 0.25, 0.0], [0.75, 0.75, 0.5], StartState::Overlapping),
        ([0.0, 0.0, 0.0], [0.5, 0.5, 0.5], StartState::Overlapping),
    ] {
        let other = cuboid(DVec3::from_array(low), DVec3::from_array(high));
        let [forth, back] = [state(&cube, &other, DVec3::ZERO), state(&other, &cube, DVec3::ZERO)];
        assert_eq!((forth.state, back.state), (expected, expected), "{low:?} {high:?}");
        if expected == StartState::Touching {
            assert!((forth.normal + back.normal).length() < 1e-9);
            let way = DVec3::from_array(low).map(|x| f64::from(x >= 1.0));
            assert!(
                forth.normal.dot(way) > 0.5 && (low[1] > 0.5 || (forth.normal - DVec3::X).length() < 1e-9),
                "{forth:?}"
            );
        }
    }
}

/// Bodies that touch in several places at once: a corner of three walls, a slot; and a peg that fits its hole on all sides, which parts
/// nowhere and overlaps nowhere.
#[test]
fn several_contacts_at_once() {
    let wall =
        |low: [f64; 3], high: [f64; 3]| Surface::cuboid(DVec3::from_array(low), DVec3::from_array(high));
    let cube = cuboid(DVec3::ZERO, DVec3::ONE);
    let three = wall([-1.0, 0.0, 0.0], [0.0, 2.0, 2.0])
        .with(&wall([0.0, -1.0, 0.0], [2.0, 0.0, 2.0]))
        .with(&wall([0.0, 0.0, -1.0], [2.0, 2.0, 0.0]));
    let corner = state(&tree(three), &cube, DVec3::ZERO);
    assert_eq!(corner.state, StartState::Touching);
    assert!((corner.normal - DVec3::ONE.normalize()).length() < 1e-6, "{corner:?}");
    let floor_and_wall =
        wall([-1.0, 0.0, 0.0], [0.0, 2.0, 2.0]).with(&wall([0.0, 0.0, -1.0], [2.0, 2.0, 0.0]));
    let two = state(&tree(floor_and_wall), &cube, DVec3::Y * 0.5);
    assert_eq!(two.state, StartState::Touching);
    assert!((two.normal - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6, "{two:?}");
    let slot = wall([-1.0, 0.0, 0.0], [0.0, 1.0, 1.0]).with(&wall([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]));
    assert_eq!(state(&tree(slot), &cube, DVec3::Z * 0.25).state, StartState::Undecided);
}

/// Exchanged, renumbered, shifted by whole numbers, and in other units: the same answer.
#[test]
fn twins_agree() {
    let mut random = KnuthRandom(7);
    for round in 0..60 {
        let whole = |random: &mut KnuthRandom, most: f64| (random.vector() * most).round() * 0.25;
        let half = (
            whole(&mut random, 4.0).abs() + DVec3::splat(0.25),
            whole(&mut random, 4.0).abs() + DVec3::splat(0.25),
        );
        let (a, b) = (Surface::cuboid(-half.0, half.0), Surface::cuboid(-half.1, half.1));
        let by = whole(&mut random, 8.0);
        let expected = {
            let room = by.abs() - half.0 - half.1;
            match room.max_element() {
                gap if gap > 0.0 => StartState::Apart,
                0.0 => StartState::Touching,
                _ => StartState::Overlapping,
            }
        };
        let inside = (by.abs() - half.0 + half.1).max_element() < 0.0
            || (by.abs() - half.1 + half.0).max_element() < 0.0;
        let expected = if inside { StartState::Contained } else { expected };
        let known = state(&tree(a.clone()), &tree(b.clone()), by);
        assert_eq!(known.state, expected, "{round} {half:?} {by}");
        let swapped = distance(
            Posed::new(&tree(b.clone()), shifted(by)),
            Posed::at_rest(&tree(a.clone())),
            Solid::Filled,
        )
        .unwrap();
        assert_eq!(swapped.state, expected, "{round}");
        assert!((swapped.normal + known.normal).length() < 1e-9);
        let mut reversed = b.clone();
        reversed.triangles.reverse();
        let renumbered = state(&tree(a.clone()), &tree(reversed), by);
        assert_eq!(renumbered.state, expected, "{round}");
        assert!(
            (renumbered.normal - known.normal).length() < 1e-9,
            "{round} {} {}",
            renumbered.normal,
            known.normal
        );
        for unit in [2.0_f64.powi(-30), 2.0_f64.powi(30), 2.0_f64.powi(-300) * 8.0] {
            let scaled = |surface: &Surface| tree(surface.clone().map(|p| p * unit));
            let found = state(&scaled(&a), &scaled(&b), by * unit);
            if unit > 1e-50 {
                assert_eq!(found.state, expected, "{round} {unit:e}");
                assert!((found.normal - known.normal).length() < 1e-9, "{round} {unit:e}");
            }
        }
    }
}

/// A solid that is inside out is the same solid.
#[test]
fn solids_inside_out() {
    let cube = Surface::cube(0.5);
    for (a, b) in [
        (cube.clone().inverted(), cube.clone()),
        (cube.clone(), cube.clone().inverted()),
        (cube.clone().inverted(), cube.clone().inverted()),
    ] {
        let found = state(&tree(a), &tree(b), DVec3::new(0.25, 0.0, 1.0));
        assert_eq!(found.state, StartState::Touching);
        assert!((found.normal - DVec3::Z).length() < 1e-9);
    }
}

/// What holds at the start of moving bodies: lifted, slid, turned away; with `Start::Leave` the way they begin is reported, too.
#[test]
fn moving_starts_are_judged() {
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let rest = ConstantTwist::REST;
    for (at, expected) in
        [(1.0, StartState::Touching), (0.75, StartState::Overlapping), (1.5, StartState::Apart)]
    {
        let lifted = rest.with_position(DVec3::new(0.25, 0.0, at)).with_linear_velocity(DVec3::Z);
        let [a, b] = [Moving::new(&cube, &rest), Moving::new(&cube, &lifted)];
        let parting = departure(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
        assert_eq!(parting.start, expected);
        assert!(parting.answer.is_separated());
        let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
        assert_eq!(answer.contact().map(|contact| contact.start), (at < 1.25).then_some(expected));
        if let Some(contact) = answer.contact().filter(|contact| contact.start == StartState::Overlapping) {
            assert!(contact.separation == 0.0 && contact.evidence >= Evidence::Near);
        }
    }
    // Rounded points: spheres that touch, and spheres that overlap.
    let point = MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap());
    for (at, expected) in [(1.0, StartState::Touching), (0.9, StartState::Overlapping)] {
        let beside = rest.with_position(DVec3::X * at);
        let [a, b] =
            [Moving::new(&point, &rest).with_radius(0.5), Moving::new(&point, &beside).with_radius(0.5)];
        let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
        let contact = answer.contact().unwrap();
        assert_eq!(contact.start, expected);
        assert!((contact.normal - DVec3::X).length() < 1e-9);
    }
}

/// In units so small that underflow takes a part of all lengths it is not known whether bodies within a minimum separation of each other touch
/// or overlap, and nothing else is said: half of one of these boxes is in the other.
#[test]
fn what_underflow_takes_a_part_of_is_undecided() {
    let turned = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.1));
    for (power, expected) in [(-400, StartState::Overlapping), (-498, StartState::Undecided)] {
        let unit = 2f64.powi(power);
        let half = DVec3::new(0.5, 0.3, 0.4) * unit;
        let boxed = cuboid(-half, half);
        let place = DVec3::new(0.45, 0.2, 0.05) * unit;
        let other = ConstantTwist::REST.with_position(place).with_orientation(turned);
        let options = QueryOptions::default().with_tolerance(1e-9 * unit).with_min_separation(0.08 * unit);
        let bodies = [Moving::new(&boxed, &ConstantTwist::REST), Moving::new(&boxed, &other)];
        let answer = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options).unwrap();
        assert_eq!(answer.contact().unwrap().start, expected, "{answer:?}");
    }
}
