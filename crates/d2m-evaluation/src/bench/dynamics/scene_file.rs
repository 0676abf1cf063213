//! Scenes as files, for programs outside of Rust: what `d2m simulate` reads, beside the meshes that it names.
use super::scene::{Error, Scene};
use crate::bench::body::write_obj;
use d2m::bvh::MeshTree;
use d2m_dynamics::{Body, Joint, JointKind, Kind, Mass, MotorTarget};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// A scene's name as that of a file.
pub(super) fn stem(scene: &Scene) -> String {
    scene.name.replace([' ', '/'], "-")
}

/// Writes `NAME.json` and its meshes. What the scenes here have no use of – groups, limits of joints, springs – is not written.
pub(super) fn write(scene: &Scene, folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder)?;
    let stem = stem(scene);
    let mut shapes: Vec<&Arc<MeshTree>> = Vec::new();
    let mut bodies = Vec::new();
    for body in &scene.bodies {
        let known = shapes.iter().position(|shape| Arc::ptr_eq(shape, &body.tree));
        let number = known.unwrap_or(shapes.len());
        let mesh = format!("{stem}-{number}.obj");
        if known.is_none() {
            write_obj(&folder.join(&mesh), body.tree.mesh())?;
            shapes.push(&body.tree);
        }
        bodies.push(body_value(body, &mesh)?);
    }
    for (place, motion) in &scene.motions {
        bodies[*place]["motion"] = serde_json::to_value(motion)?;
    }
    let joints = scene.joints.iter().map(|joint| joint_value(joint, scene)).collect::<Result<Vec<_>, _>>()?;
    let options = scene.simulation.options();
    let text = json!({
        "bodies": bodies,
        "joints": joints,
        "simulation": {
            "gravity": options.gravity.to_array(),
            "step": options.step,
            "gap": options.gap,
            "end": scene.seconds,
            "sleep": options.sleeping,
        },
    });
    Ok(std::fs::write(folder.join(stem + ".json"), serde_json::to_string_pretty(&text)?)?)
}

/// In the order of files: real part first.
fn quaternion(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

/// All but the motion.
fn body_value(body: &Body, mesh: &str) -> Result<Value, Error> {
    let kind = match body.kind {
        Kind::Dynamic => "dynamic",
        Kind::Static => "static",
        Kind::Kinematic(_) => "kinematic",
        Kind::Driven => {
            return Err(format!("{} is driven from outside, which no file does", body.name).into());
        }
    };
    let mut value = json!({
        "name": body.name,
        "mesh": mesh,
        "kind": kind,
        "friction": body.friction,
        "restitution": body.restitution,
    });
    match body.mass {
        Mass::Density(density) => value["density"] = density.into(),
        Mass::Total(mass) => value["mass"] = mass.into(),
        _ => return Err(format!("the inertia of {} is not written", body.name).into()),
    }
    if !matches!(body.kind, Kind::Kinematic(_)) {
        value["pose"] = json!({ "x": body.position.to_array(), "q": quaternion(body.orientation) });
    }
    if (body.linear_velocity, body.angular_velocity) != (DVec3::ZERO, DVec3::ZERO) {
        let [v, w] = [body.linear_velocity, body.angular_velocity].map(|rate| rate.to_array());
        value["velocity"] = json!({ "v": v, "w": w });
    }
    Ok(value)
}

fn joint_value(joint: &Joint, scene: &Scene) -> Result<Value, Error> {
    let kind = match joint.kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
        JointKind::Spherical => "spherical",
        other => return Err(format!("{other:?} joints are not written").into()),
    };
    let name = |id: d2m_dynamics::BodyId| &scene.bodies[id.index()].name;
    let mut value = json!({
        "kind": kind,
        "a": name(joint.a),
        "b": joint.b.map(name),
        "point": joint.point.to_array(),
        "axis": joint.axis.to_array(),
        "collide": joint.collide,
    });
    if let Some(motor) = joint.motor {
        let (key, target) = match motor.target {
            MotorTarget::Velocity(rate) => ("velocity", rate),
            MotorTarget::Position(place) => ("position", place),
            other => return Err(format!("motors with {other:?} are not written").into()),
        };
        value["motor"] = json!({ key: target, "stiffness": motor.stiffness, "damping": motor.damping });
        if motor.most.is_finite() {
            value["motor"]["max"] = motor.most.into();
        }
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::super::compared::Bearing;
    use super::*;
    use std::collections::BTreeSet;

    /// A mesh is written once, a number comes back with all of its bits, and every joint names its bodies.
    #[test]
    fn a_file_has_every_body_and_joint() {
        let folder = std::env::temp_dir().join(format!("d2m-scene-files-{}", std::process::id()));
        for scene in [Scene::double_pendulum(), Scene::bin(30, 3), Scene::fast_gears(Bearing::Joint)] {
            let scene = scene.unwrap();
            write(&scene, &folder).unwrap();
            let path = folder.join(stem(&scene) + ".json");
            let read: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
            let bodies = read["bodies"].as_array().unwrap();
            let names: BTreeSet<_> = bodies.iter().map(|body| body["name"].as_str()).collect();
            assert_eq!(names.len(), bodies.len());
            assert_eq!(bodies.len(), scene.bodies.len());
            for (value, body) in bodies.iter().zip(&scene.bodies) {
                let place = if matches!(body.kind, Kind::Kinematic(_)) { "motion" } else { "pose" };
                let x: DVec3 = serde_json::from_value(value[place]["x"].clone()).unwrap();
                assert_eq!((value["name"].as_str(), x), (Some(body.name.as_str()), body.position), "{value}");
                assert!(folder.join(value["mesh"].as_str().unwrap()).exists(), "{value}");
            }
            assert_eq!(read["joints"].as_array().unwrap().len(), scene.joints.len());
        }
        let meshes = std::fs::read_dir(&folder).unwrap().filter(|entry| {
            entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "obj")
        });
        // A bar; a floor, a wall, another and a box; a gear.
        assert_eq!(meshes.count(), 1 + 6 + 1);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
