//! Scenes on which both engines are measured, each with the targets of ours.
use super::bound::Bound;
use super::scene::{Error, Expectation, HALF, Scene, options, tree};
use d2m::bvh::MeshTree;
use d2m::motion::ConstantTwist;
use d2m_dynamics::{Body, Joint, JointKind, Kind, SimulationOptions};
use d2m_testing::Xoshiro256;
use glam::{DQuat, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// What holds the gear that is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bearing {
    Joint,
    /// A shaft in its bore, between two plates.
    Pin,
}

/// What falls into a bin: how many in a layer along each way and in all, and by how much they are off the grid at
/// most.
struct Filling {
    shape: Arc<MeshTree>,
    friction: f64,
    side: usize,
    count: usize,
    jitter: f64,
}

impl Scene {
    /// Boxes of 0.5 × 0.7 × 0.4 at random turns that fall into a bin, in layers of a square grid.
    pub(super) fn bin(count: usize, side: usize) -> Result<Self, Error> {
        let shape = tree("box?x=0.25&y=0.35&z=0.2")?;
        let filling = Filling { shape, friction: 0.5, side, count, jitter: 0.05 };
        let mut scene = Self::filled(format!("bin of {count} boxes"), &filling)?;
        (scene.after, scene.bounds) = match count {
            100 => (3.0, vec![Bound::Seconds(2.0), Bound::SettledRealTime(20.0)]),
            1000 => (6.0, vec![Bound::Seconds(25.0), Bound::SettledRealTime(1.0)]),
            _ => (0.0, Vec::new()),
        };
        Ok(scene)
    }

    /// Torus knots of 2000 triangles and a radius of 0.4 at random turns that fall into a bin.
    pub(super) fn knots(count: usize) -> Result<Self, Error> {
        let shape = |scale: f64| tree(&format!("torus-knot?triangles=2000&scale={scale}"));
        let shape = shape(0.4 / shape(1.0)?.radius())?;
        let filling = Filling { shape, friction: 0.3, side: 2, count, jitter: 0.0 };
        let mut scene = Self::filled(format!("knots {count}"), &filling)?;
        scene.bounds = vec![Bound::OfRapier(0.5)];
        Ok(scene)
    }

    /// A grid with a pitch of one in a bin of four walls around it.
    fn filled(name: String, filling: &Filling) -> Result<Self, Error> {
        let mut scene = Self::new(name, options(), 4.0, Expectation::Above(0.0))?;
        let inner = 0.5 * filling.side as f64 + 0.1;
        let (wall, outer) = (0.2, inner + 1.6);
        let held = |name: &str, half: DVec3| -> Result<Body, Error> {
            let shape = tree(&format!("box?x={}&y={}&z={}", half.x, half.y, half.z))?;
            Ok(Body::new(name, shape).with_kind(Kind::Static).with_friction(0.5))
        };
        let floor = held("floor", DVec3::new(2.0 * outer, 0.5, 2.0 * outer))?;
        scene.add(floor.with_position(DVec3::Y * -0.5))?;
        let height = 30.0;
        for (axis, other) in [(DVec3::X, DVec3::Z), (DVec3::Z, DVec3::X)] {
            for side in [-1.0, 1.0] {
                let name = format!("wall towards {}", axis * side);
                let body = held(&name, axis * wall + other * outer + DVec3::Y * height)?;
                let place = axis * (side * (inner + wall)) + DVec3::Y * (height + 0.01);
                scene.add(body.with_position(place))?;
            }
        }
        let mut random = Xoshiro256::new(filling.count as u64);
        let (side, middle) = (filling.side, 0.5 * (filling.side - 1) as f64);
        for k in 0..filling.count {
            let mut off = || random.range(-filling.jitter, filling.jitter);
            let (x, z) = ((k / side % side) as f64 - middle + off(), (k % side) as f64 - middle + off());
            let place = DVec3::new(x, 0.7 + (k / (side * side)) as f64, z);
            let body = Body::new(format!("body {k}"), Arc::clone(&filling.shape));
            let body = body.with_friction(filling.friction).with_orientation(random.rotation());
            scene.add(body.with_position(place))?;
        }
        Ok(scene)
    }

    /// Unit boxes on each other, twice the gap apart.
    pub(super) fn stack(count: usize) -> Result<Self, Error> {
        let clearance = 2.0 * options().gap;
        // As far as the boxes may sink.
        let expectation = Expectation::Stays(clearance * (count + 1) as f64);
        Self::new(format!("stack of {count}"), options(), 4.0, expectation)?.columns(count, count, clearance)
    }

    /// Two bars of one meter that fall from where they are level, as a double pendulum.
    pub(super) fn double_pendulum() -> Result<Self, Error> {
        let options = SimulationOptions::default();
        let mut scene = Self::new("double pendulum on joints", options, 4.0, Expectation::Held)?;
        let shape = tree(&format!("box?x={HALF}&y=0.05&z=0.05"))?;
        let mut bar = |x: f64| -> Result<_, Error> {
            scene.add(Body::new(format!("bar at {x}"), Arc::clone(&shape)).with_position(DVec3::X * x))
        };
        let (a, b) = (bar(HALF)?, bar(3.0 * HALF)?);
        scene.join(Joint::new(JointKind::Revolute, a, None, DVec3::ZERO))?;
        scene.join(Joint::new(JointKind::Revolute, a, Some(b), DVec3::X * (2.0 * HALF)))?;
        scene.bounds = vec![Bound::SecondsPerSimulated(0.01)];
        Ok(scene)
    }

    /// A gear that is driven at 200 rad/s turns another of its kind.
    pub(super) fn fast_gears(bearing: Bearing) -> Result<Self, Error> {
        const RATE: f64 = 200.0;
        let name = match bearing {
            Bearing::Joint => "gears at 200 rad/s on a joint",
            Bearing::Pin => "gears at 200 rad/s on a pin",
        };
        let mut scene = Self::new(name, SimulationOptions::default(), 0.5, Expectation::Rate(-RATE))?;
        let shape = tree("gear?teeth=16&triangles=5000")?;
        let drive = ConstantTwist::REST.with_angular_velocity(DVec3::Z * RATE);
        let driven = Body::new("driven", Arc::clone(&shape)).with_friction(0.1);
        scene.drive(driven, drive)?;
        // A gap of teeth opposite to a tooth.
        let (place, half_a_tooth) = (DVec3::X * 1.88, DQuat::from_rotation_z(PI / 16.0));
        let turned = Body::new("turned", shape).with_friction(0.1).with_position(place);
        let turned = scene.add(turned.with_orientation(half_a_tooth))?;
        match bearing {
            Bearing::Joint => scene.join(Joint::new(JointKind::Revolute, turned, None, place))?,
            Bearing::Pin => {
                let pin = tree("shaft?scale=0.58&triangles=2000")?;
                scene.add(Body::new("pin", pin).with_kind(Kind::Static).with_position(place))?;
                let plate = tree("box?x=0.6&y=0.6&z=0.05")?;
                for z in [-0.3, 0.3] {
                    let plate =
                        Body::new(format!("plate at {z}"), Arc::clone(&plate)).with_kind(Kind::Static);
                    scene.add(plate.with_position(place + DVec3::Z * z))?;
                }
                scene.bounds = vec![Bound::SecondsPerSimulated(20.0)];
            }
        }
        Ok(scene)
    }

    /// Hollow spheres of 10 000 triangles within each other that spin about different axes; the outermost is static.
    pub(super) fn dolls(count: usize) -> Result<Self, Error> {
        let mut scene =
            Self::new("nested dolls", SimulationOptions::default(), 0.5, Expectation::Within(1.0))?;
        let mut scale = 1.0;
        for k in 0..=count {
            let shape = tree(&format!("hollow-sphere?triangles=10000&wall=0.02&scale={scale}"))?;
            let body = Body::new(format!("doll {k}"), shape);
            scene.add(if k == 0 {
                body.with_kind(Kind::Static)
            } else {
                let way = if k % 2 == 1 { 20.0 } else { -20.0 };
                body.with_friction(0.3).with_angular_velocity(DVec3::new(way, 5.0, 3.0 * (k - 1) as f64))
            })?;
            scale *= 0.97;
        }
        scene.bounds = vec![Bound::SecondsPerSimulated(10.0)];
        Ok(scene)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{judge, peer};
    use super::*;

    /// A heap comes to rest, and what hops on it does not wake it again and again.
    #[test]
    fn a_bin_of_boxes_falls_asleep() {
        let mut scene = Scene::bin(100, 5).unwrap();
        let asleep = |scene: &Scene| scene.ids.iter().all(|&id| scene.simulation.is_asleep(id));
        while !asleep(&scene) {
            scene.simulation.step().unwrap();
            assert!(scene.simulation.time() < scene.seconds + scene.after - 1.0);
        }
        scene.simulation.step_to(scene.simulation.time() + 1.0).unwrap();
        assert!(asleep(&scene));
    }

    /// Every scene has the bodies that it states, and nothing intersects at the start for either engine.
    #[test]
    fn scenes_are_as_stated_and_start_apart_in_both_engines() {
        let scenes = [
            (Scene::bin(100, 5).unwrap(), 105, 100),
            (Scene::knots(20).unwrap(), 25, 20),
            (Scene::stack(30).unwrap(), 31, 30),
            (Scene::double_pendulum().unwrap(), 2, 2),
            (Scene::fast_gears(Bearing::Joint).unwrap(), 2, 1),
            (Scene::fast_gears(Bearing::Pin).unwrap(), 5, 1),
            (Scene::dolls(6).unwrap(), 7, 6),
        ];
        for (scene, bodies, dynamic) in scenes {
            assert_eq!((scene.bodies.len(), scene.ids.len()), (bodies, dynamic), "{}", scene.name);
            let (ours, theirs) = (scene.poses(), peer::Peer::new(&scene).unwrap().poses());
            assert_eq!(judge::intersecting(&scene, &ours), Ok(0), "{}", scene.name);
            assert_eq!(judge::intersecting(&scene, &theirs), Ok(0), "{}", scene.name);
            for (a, b) in ours.iter().zip(&theirs) {
                assert!(a.translation == b.translation, "{}", scene.name);
                assert!(a.rotation.dot(b.rotation).abs() > 1.0 - 1e-12, "{}", scene.name);
            }
        }
    }

    /// The judge counts what intersects: two bodies of a stack in one place, which touch the floor as little as before.
    #[test]
    fn what_intersects_is_counted() {
        let scene = Scene::stack(3).unwrap();
        let mut poses = scene.poses();
        poses[2] = poses[1];
        assert_eq!(judge::intersecting(&scene, &poses), Ok(1));
        poses[1].translation.y = 0.0;
        poses[2].translation.y = 0.0;
        assert_eq!(judge::intersecting(&scene, &poses), Ok(3));
    }
}
