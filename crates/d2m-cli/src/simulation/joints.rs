//! Joints of scene files.

use super::fields::Fields;
use crate::failure::Failure;
use crate::output::note;
use d2m_dynamics::{BodyId, Joint, JointKind, Motor, MotorTarget, Simulation, Spring};
use serde_json::Value;

const KEYS: &[&str] =
    &["name", "kind", "a", "b", "point", "axis", "limits", "motor", "spring", "friction", "collide"];

/// Adds the joints of a scene.
pub(crate) fn joints(
    scene: &Fields<'_>,
    names: &[String],
    ids: &[BodyId],
    simulation: &mut Simulation,
) -> Result<(), Failure> {
    let Some(list) = scene.list("joints")? else { return Ok(()) };
    for (index, value) in list.iter().enumerate() {
        let place = format!("{}, joints, entry {index}", scene.place());
        let fields = Fields::new(place, value, KEYS)?;
        let joint = joint(&fields, names, ids)?;
        simulation.add_joint(&joint).map_err(|error| Failure::at(fields.place(), error))?;
    }
    Ok(())
}

fn joint(fields: &Fields<'_>, names: &[String], ids: &[BodyId]) -> Result<Joint, Failure> {
    let body = |key: &str| -> Result<BodyId, Failure> {
        fields.required(key)?;
        let name = fields.text(key)?.unwrap_or_default();
        let found = names.iter().position(|other| other == name);
        found.map(|k| ids[k]).ok_or_else(|| fields.fault(key, format!("no body {name:?}")))
    };
    fields.required("kind")?;
    let kind = match fields.text("kind")?.unwrap_or_default() {
        "fixed" => JointKind::Fixed,
        "revolute" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "spherical" => JointKind::Spherical,
        other => {
            let reason = format!("{other:?} is not fixed, revolute, prismatic or spherical");
            return Err(fields.fault("kind", reason));
        }
    };
    let is_world = fields.get("b").is_none_or(Value::is_null);
    let b = if is_world { None } else { Some(body("b")?) };
    fields.required("point")?;
    let mut joint = Joint::new(kind, body("a")?, b, fields.vector("point")?.unwrap_or_default());
    let has_value = matches!(kind, JointKind::Revolute | JointKind::Prismatic);
    if has_value {
        fields.required("axis")?;
    } else if let Some(key) =
        ["limits", "motor", "spring", "friction"].into_iter().find(|key| fields.get(key).is_some())
    {
        return Err(fields.fault(key, "only revolute and prismatic joints have one"));
    }
    if let Some(axis) = fields.vector("axis")? {
        joint = joint.with_axis(axis);
    }
    if let Some(limits) = fields.numbers::<2>("limits")? {
        let [lo, hi] = limits;
        if lo <= hi && !(lo..=hi).contains(&0.0) {
            note(&format!(
                "d2m: warning: {}: limits: {limits:?} do not hold at the start, where the value is 0: the bodies are driven there at once",
                fields.place()
            ));
        }
        joint = joint.with_limits(limits);
    }
    if let Some(fields) = fields.object("motor", &["velocity", "position", "max", "stiffness", "damping"])? {
        joint = joint.with_motor(motor(&fields)?);
    }
    if let Some(spring) = fields.object("spring", &["stiffness", "damping", "rest"])? {
        let number = |key: &str| -> Result<f64, Failure> { Ok(spring.number(key)?.unwrap_or(0.0)) };
        joint = joint.with_spring(Spring::new(number("stiffness")?, number("damping")?, number("rest")?));
    }
    if let Some(collide) = fields.flag("collide")? {
        joint = joint.with_collide(collide);
    }
    Ok(joint.with_friction(fields.number("friction")?.unwrap_or(0.0)))
}

fn motor(fields: &Fields<'_>) -> Result<Motor, Failure> {
    let target = match (fields.number("velocity")?, fields.number("position")?) {
        (Some(rate), None) => MotorTarget::Velocity(rate),
        (None, Some(place)) => MotorTarget::Position(place),
        _ => return Err(fields.fault("velocity", "a motor has a velocity or a position, one of the two")),
    };
    let mut motor = Motor::new(target);
    motor.most = fields.number("max")?.unwrap_or(f64::INFINITY);
    motor.stiffness = fields.number("stiffness")?.unwrap_or(0.0);
    motor.damping = fields.number("damping")?.unwrap_or(0.0);
    Ok(motor)
}
