//! Scenes with a known answer, for every query that claims to find the first contact.
//!
//! Times and places are dyadic wherever that is possible, so that "never late" can be checked to the last bit.
#![allow(dead_code, reason = "each test binary uses a part of the scenes")]

mod bodies;
mod scene;

pub(crate) use bodies::{cube, frame, hollow_cube, plank, soup, two_cubes};
pub(crate) use scene::{Expected, Kind, Scene};

use d2m_bvh::{Solid, StartState, Window};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3, dvec3};

fn at(time: f64) -> Expected {
    Expected::At { time, slack: 0.0, normal: None, kind: None }
}

fn about(time: f64, normal: DVec3, kind: Kind) -> Expected {
    Expected::At { time, slack: 1e-13, normal: Some(normal), kind: Some(kind) }
}

fn from(position: DVec3, velocity: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_position(position).with_linear_velocity(velocity)
}

/// All scenes.
pub(crate) fn all() -> Vec<Scene> {
    let mut scenes = vec![];
    resting_and_cubes(&mut scenes);
    rotating(&mut scenes);
    fast_and_thin(&mut scenes);
    inside_and_linked(&mut scenes);
    windows(&mut scenes);
    scales(&mut scenes);
    scenes
}

fn resting_and_cubes(scenes: &mut Vec<Scene>) {
    let unit = || cube(DVec3::ZERO, 1.0);
    let down = dvec3(0.0, 0.0, -4.0);
    let mut falling =
        Scene::new("cube on cube, face on face", unit(), unit(), from(dvec3(0.0, 0.0, 3.0), down), at(0.5));
    falling.expected = Expected::At { time: 0.5, slack: 0.0, normal: Some(-DVec3::Z), kind: None };
    scenes.push(falling.exchanged());
    scenes.push(falling.carried(dvec3(1048576.0, -524288.0, 0.0), dvec3(16.0, 8.0, -4.0)));
    scenes.push(falling);
    scenes.push(Scene::new(
        "cube on cube, shifted faces",
        unit(),
        unit(),
        from(dvec3(0.5, 0.25, 3.0), down),
        at(0.5),
    ));
    scenes.push(Scene::new(
        "cube on cube, faces share a side only",
        unit(),
        unit(),
        from(dvec3(1.0, 0.25, 3.0), down),
        at(0.5),
    ));
    scenes.push(Scene::new(
        "cube on cube, faces share a corner only",
        unit(),
        unit(),
        from(dvec3(1.0, 1.0, 3.0), down),
        at(0.5),
    ));
    scenes.push(Scene::new(
        "cube passes cube by 1e-6",
        unit(),
        unit(),
        from(dvec3(1.0 + 1e-6, 0.0, 3.0), 4.0 * down),
        Expected::Separated,
    ));
    scenes.push(Scene::new(
        "cube slides 2e-9 above a cube",
        unit(),
        unit(),
        from(dvec3(-3.0, 0.25, 1.0 + 2e-9), dvec3(6.0, 0.0, 0.0)),
        Expected::Separated,
    ));
    scenes.push(Scene::new(
        "cubes at rest, apart",
        unit(),
        unit(),
        from(dvec3(1.5, 0.0, 0.0), DVec3::ZERO),
        Expected::Separated,
    ));
    scenes.push(
        Scene::new(
            "cubes move together, apart",
            unit(),
            unit(),
            from(dvec3(1.5, 0.0, 0.0), DVec3::ZERO),
            Expected::Separated,
        )
        .carried(DVec3::ZERO, dvec3(100.0, 0.0, 0.0)),
    );
    scenes.push(Scene::new(
        "cube touches cube at the start",
        unit(),
        unit(),
        from(dvec3(0.25, 0.25, 1.0), down),
        Expected::Start(StartState::Touching),
    ));
    scenes.push(Scene::new(
        "cubes overlap at the start",
        unit(),
        unit(),
        from(dvec3(0.5, 0.375, 0.625), -down),
        Expected::Start(StartState::Overlapping),
    ));

    // The corner (1,1,1) of A points down: half the diagonal below its center.
    let corner_down = DQuat::from_rotation_arc(DVec3::ONE.normalize(), -DVec3::Z);
    let half = 3f64.sqrt() / 2.0;
    let centered = || cube(DVec3::splat(-0.5), 1.0);
    let tip =
        from(dvec3(0.125, 0.0625, 0.5 + half + 1.0), dvec3(0.0, 0.0, -2.0)).with_orientation(corner_down);
    scenes.push(Scene::new(
        "corner of a cube on a face",
        centered(),
        centered(),
        tip,
        about(0.5, -DVec3::Z, Kind::VertexFace),
    ));
    // Edge along x below A, edge along y on top of B.
    let turned = |axis: DVec3| DQuat::from_axis_angle(axis, core::f64::consts::FRAC_PI_4);
    let side = 2f64.sqrt() / 2.0;
    let mut edges = Scene::new(
        "edge of a cube on an edge",
        centered(),
        centered(),
        from(dvec3(0.0625, 0.125, 2.0 * side + 1.0), dvec3(0.0, 0.0, -2.0))
            .with_orientation(turned(DVec3::X)),
        about(0.5, -DVec3::Z, Kind::EdgeEdge),
    );
    edges.motions[1] = ConstantTwist::REST.with_orientation(turned(DVec3::Y));
    scenes.push(edges.exchanged());
    scenes.push(edges);
    // Parallel edges meet along their length.
    let mut parallel = Scene::new(
        "edge of a cube on a parallel edge",
        centered(),
        centered(),
        from(dvec3(0.25, 0.0, 2.0 * side + 1.0), dvec3(0.0, 0.0, -2.0)).with_orientation(turned(DVec3::X)),
        Expected::At { time: 0.5, slack: 1e-13, normal: None, kind: None },
    );
    parallel.motions[1] = ConstantTwist::REST.with_orientation(turned(DVec3::X));
    scenes.push(parallel);
}

fn rotating(scenes: &mut Vec<Scene>) {
    // A bar turns about z until the corner of its end meets a wall at y ≥ 1/2.
    let h = 0.0625;
    let bar = || plank(dvec3(-1.0, -h, -h), dvec3(1.0, h, h));
    let wall = || plank(dvec3(-4.0, 0.5, -2.0), dvec3(4.0, 1.0, 2.0));
    let reach = (1.0 + h * h).sqrt();
    let angle = (0.5 / reach).asin() - h.atan();
    let turning = |w: f64| ConstantTwist::REST.with_angular_velocity(dvec3(0.0, 0.0, w));
    let meets = |w: f64| Expected::At { time: angle / w, slack: 1e-13, normal: Some(DVec3::Y), kind: None };
    scenes.push(Scene::new("a bar turns into a wall", bar(), wall(), turning(1.0), meets(1.0)));
    scenes.push(Scene::new("a bar turns fast into a wall", bar(), wall(), turning(64.0), meets(64.0)));
    // Too far for the tip.
    let far = plank(dvec3(-4.0, reach + 1e-4, -2.0), dvec3(4.0, 2.0, 2.0));
    scenes.push(Scene::new(
        "a bar turns 1e-4 below a wall",
        bar(),
        far.clone(),
        turning(20.0),
        Expected::Separated,
    ));
    // Both turn alike: at rest relative to each other although everything moves.
    let mut together =
        Scene::new("two bodies turn together", bar(), wall(), turning(3.0), Expected::Separated);
    together.motions[1] = turning(3.0);
    scenes.push(together);
    // Grazing: the tip's circle reaches 1e-3 into the wall at its highest point only.
    let low = plank(dvec3(-4.0, reach - 1e-3, -2.0), dvec3(4.0, 2.0, 2.0));
    let high = ((reach - 1e-3) / reach).asin() - h.atan();
    scenes.push(Scene::new(
        "a tip dips 1e-3 into a wall",
        bar(),
        low,
        turning(2.0),
        Expected::At { time: high / 2.0, slack: 1e-12, normal: None, kind: None },
    ));
    scenes.push(second_root());
}

/// A tip on a circle dips through the plane of a face, beside it, and comes up through it from below: the plane has two
/// roots within one stretch of the reference method, and the first one is no contact.
///
/// ```text
///  tip ╲                ╱
///  ─ ─ ─╲─ ─ ─ ══════╱═══════   the face begins between the roots
///        ╲________.·╱
/// ```
fn second_root() -> Scene {
    let (spin, root) = (0.01, 0.0025f64);
    let height = -root.cos();
    // The body hangs outside of the tip's circle, so that nothing else comes near the face.
    let hanging = soup(&[[dvec3(0.0, -1.0, 0.0), dvec3(0.1, -2.0, 0.1), dvec3(-0.1, -2.0, -0.1)]]);
    let face = soup(&[[dvec3(0.001, height, -0.5), dvec3(0.001, height, 0.5), dvec3(0.5, height, 0.0)]]);
    let turning = ConstantTwist::REST
        .with_orientation(DQuat::from_rotation_z(-0.5 * spin))
        .with_angular_velocity(DVec3::Z * spin);
    let expected =
        Expected::At { time: 0.75, slack: 1e-10, normal: Some(DVec3::Y), kind: Some(Kind::VertexFace) };
    let name = "a tip dips beside a face and comes up through it";
    Scene { solid: Solid::Surface, ..Scene::new(name, hanging, face, turning, expected) }
}

fn fast_and_thin(scenes: &mut Vec<Scene>) {
    let plate = || plank(dvec3(-1.0, -1.0, 0.0), dvec3(1.0, 1.0, 1e-4));
    let bullet = || cube(DVec3::splat(-0.001953125), 0.00390625);
    let speed = 131_072.0;
    let shot = from(dvec3(0.25, 0.125, -1.0 - 0.001953125), dvec3(0.0, 0.0, speed));
    scenes.push(Scene::new("a bullet through a thin plate", bullet(), plate(), shot, at(1.0 / speed)));
    let spinning = shot.with_angular_velocity(dvec3(0.0, 0.0, 300.0));
    scenes.push(Scene::new("a spinning bullet", bullet(), plate(), spinning, at(1.0 / speed)));
    let beside = from(dvec3(1.0 + 0.002, 0.125, -1.0), dvec3(0.0, 0.0, speed));
    scenes.push(Scene::new("a bullet past the plate", bullet(), plate(), beside, Expected::Separated));
    // Open meshes: a corner through a single triangle, and a triangle whose plane function is zero all the time.
    let sheet = soup(&[[dvec3(-1.0, -1.0, 0.0), dvec3(3.0, -1.0, 0.0), dvec3(-1.0, 3.0, 0.0)]]);
    let dart = soup(&[[dvec3(0.0, 0.0, 0.0), dvec3(0.25, 0.0, 1.0), dvec3(-0.25, 0.125, 1.0)]]);
    let mut open = Scene::new(
        "a dart through a sheet",
        dart.clone(),
        sheet.clone(),
        from(dvec3(0.0, 0.0, 1.0), dvec3(0.0, 0.0, -2.0)),
        at(0.5),
    );
    open.solid = Solid::Surface;
    open.expected =
        Expected::At { time: 0.5, slack: 0.0, normal: Some(-DVec3::Z), kind: Some(Kind::VertexFace) };
    scenes.push(open.exchanged());
    scenes.push(open);
    // Coplanar sliding: f ≡ 0 for every vertex and the sheet, contact when the outlines meet at x = −1.
    let flat = soup(&[[dvec3(0.0, 0.0, 0.0), dvec3(-1.0, 0.25, 0.0), dvec3(-1.0, -0.25, 0.0)]]);
    let mut coplanar = Scene::new(
        "coplanar triangles slide into each other",
        flat.clone(),
        sheet.clone(),
        from(dvec3(-3.0, 0.0, 0.0), dvec3(4.0, 0.0, 0.0)),
        at(0.5),
    );
    coplanar.solid = Solid::Surface;
    scenes.push(coplanar.clone());
    coplanar.name = "coplanar triangles slide past each other";
    coplanar.motions[0] = from(dvec3(-3.0, -1.5, 0.0), dvec3(6.0, 0.0, 0.0));
    coplanar.expected = Expected::Separated;
    scenes.push(coplanar);
    // Coplanar edges: the flat triangle's side meets the sheet's side, parallel and in one plane.
    let mut edge_on = Scene::new(
        "coplanar parallel edges meet",
        soup(&[[dvec3(0.0, -0.25, 0.0), dvec3(0.0, 0.25, 0.0), dvec3(-1.0, 0.0, 0.5)]]),
        sheet,
        from(dvec3(-3.0, 0.0, 0.0), dvec3(4.0, 0.0, 0.0)),
        at(0.5),
    );
    edge_on.solid = Solid::Surface;
    scenes.push(edge_on);
}

fn inside_and_linked(scenes: &mut Vec<Scene>) {
    let small = || cube(DVec3::splat(-0.25), 0.5);
    let right = |v: f64| from(DVec3::ZERO, dvec3(v, 0.0, 0.0));
    let hit_inside = Expected::At { time: 0.75, slack: 0.0, normal: Some(DVec3::X), kind: None };
    scenes.push(Scene::new(
        "a body inside a hollow body",
        small(),
        hollow_cube(2.0, 1.0),
        right(1.0),
        hit_inside,
    ));
    scenes.push(Scene::new(
        "a body at rest inside a hollow body",
        small(),
        hollow_cube(2.0, 1.0),
        right(0.0),
        Expected::Separated,
    ));
    let solid = || cube(DVec3::splat(-1.0), 2.0);
    let contained = Scene::new(
        "a body inside a body",
        small(),
        solid(),
        right(1.0),
        Expected::Start(StartState::Contained),
    );
    scenes.push(contained.exchanged());
    scenes.push(contained);
    let in_the_wall = from(dvec3(1.5, 0.0, 0.0), DVec3::ZERO);
    scenes.push(Scene::new(
        "a body in the wall of a hollow body",
        small(),
        hollow_cube(2.0, 1.0),
        in_the_wall,
        Expected::Start(StartState::Contained),
    ));
    let mut shell = Scene::new("a body inside a shell", small(), solid(), right(1.0), hit_inside);
    shell.solid = Solid::Surface;
    scenes.push(shell);
    // Two square rings, linked: half a unit of play along x.
    let ring = frame(false);
    let other = frame(true);
    let mut linked = Scene::new(
        "linked rings",
        ring,
        other,
        right(-1.0),
        Expected::At { time: 0.5, slack: 0.0, normal: Some(-DVec3::X), kind: None },
    );
    linked.motions[1] = from(dvec3(1.5, 0.0, 0.0), DVec3::ZERO);
    scenes.push(linked.exchanged());
    scenes.push(linked.clone());
    linked.name = "linked rings at rest";
    linked.motions[0] = right(0.0);
    linked.expected = Expected::Separated;
    scenes.push(linked);
    // Two components: the second one, further away, is the one that is hit.
    let pair = two_cubes(dvec3(4.0, 0.0, 0.0));
    scenes.push(Scene::new(
        "the second component is hit",
        cube(DVec3::ZERO, 1.0),
        pair,
        from(dvec3(4.0, 0.0, 3.0), dvec3(0.0, 0.0, -4.0)),
        at(0.5),
    ));
}

fn windows(scenes: &mut Vec<Scene>) {
    let unit = || cube(DVec3::ZERO, 1.0);
    let falling = from(dvec3(0.25, 0.125, 3.0), dvec3(0.0, 0.0, -4.0));
    let mut scene = Scene::new("the contact is at the end of the window", unit(), unit(), falling, at(0.5));
    let mut push = |name, (t0, t1), expected| {
        scene.name = name;
        scene.window = Window::try_new(t0, t1).unwrap();
        scene.expected = expected;
        scenes.push(scene.clone());
    };
    push("the contact is at the end of the window", (0.0, 0.5), at(0.5));
    push("the window ends before the contact", (0.0, 0.5 - 1e-8), Expected::Separated);
    push("a window before time zero", (-2.0, 0.25), Expected::Separated);
    push("a long window", (-64.0, 64.0), at(0.5));
    push("the window is one instant, apart", (0.25, 0.25), Expected::Separated);
    push("the window is one instant, touching", (0.5, 0.5), Expected::Start(StartState::Touching));
    push("the window starts inside", (0.5625, 0.75), Expected::Start(StartState::Overlapping));
    push("the window starts behind", (4.0, 5.0), Expected::Separated);
    let late = 131_072.0;
    scene.motions = [falling.with_reference_time(late), ConstantTwist::REST.with_reference_time(late)];
    scene.name = "a window far from time zero";
    scene.window = Window::try_new(late, late + 1.0).unwrap();
    scene.expected = at(late + 0.5);
    scenes.push(scene);
}

fn scales(scenes: &mut Vec<Scene>) {
    for (name, scale) in [("a small scene", 1.0 / 1048576.0), ("a large scene", 1048576.0)] {
        let body = || cube(DVec3::ZERO, scale);
        let falling = from(dvec3(0.25, 0.125, 3.0) * scale, dvec3(0.0, 0.0, -4.0) * scale);
        scenes.push(Scene::new(name, body(), body(), falling, at(0.5)));
    }
    // Far off the body's own origin.
    let off = dvec3(4096.0, -8192.0, 2048.0);
    let falling = from(dvec3(0.25, 0.125, 3.0) - off, dvec3(0.0, 0.0, -4.0));
    scenes.push(Scene::new(
        "a body far from its own origin",
        cube(off, 1.0),
        cube(DVec3::ZERO, 1.0),
        falling,
        at(0.5),
    ));
}
