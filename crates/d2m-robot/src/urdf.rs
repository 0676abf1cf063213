//! What a URDF file states, as it states it.

use crate::RobotError;
use crate::inertial::{Inertial, JointDynamics};
use crate::xml::{Element, Xml};
use glam::{DMat3, DVec3};

/// The file.
#[derive(Debug)]
pub(crate) struct Urdf {
    pub(crate) name: String,
    pub(crate) links: Vec<UrdfLink>,
    pub(crate) joints: Vec<UrdfJoint>,
}

#[derive(Debug)]
pub(crate) struct UrdfLink {
    pub(crate) name: String,
    pub(crate) line: u32,
    pub(crate) collisions: Vec<UrdfCollision>,
    pub(crate) inertial: Option<Inertial>,
}

/// One `<collision>`.
#[derive(Debug)]
pub(crate) struct UrdfCollision {
    pub(crate) line: u32,
    pub(crate) origin: Origin,
    pub(crate) shape: UrdfShape,
}

/// A frame in another one: `T(xyz)·Rz(yaw)·Ry(pitch)·Rx(roll)`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Origin {
    pub(crate) xyz: DVec3,
    pub(crate) rpy: DVec3,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UrdfShape {
    /// Whole sizes.
    Box(DVec3),
    Sphere {
        radius: f64,
    },
    /// About z.
    Cylinder {
        radius: f64,
        length: f64,
    },
    /// About z; the length is that of the cylinder between the half spheres.
    Capsule {
        radius: f64,
        length: f64,
    },
    Mesh {
        file: String,
        scale: DVec3,
    },
}

#[derive(Debug)]
pub(crate) struct UrdfJoint {
    pub(crate) name: String,
    pub(crate) line: u32,
    pub(crate) kind: UrdfJointKind,
    pub(crate) parent: String,
    pub(crate) child: String,
    pub(crate) origin: Origin,
    pub(crate) axis: DVec3,
    /// Does the file state the axis?
    pub(crate) has_axis: bool,
    pub(crate) limit: Option<UrdfLimit>,
    pub(crate) dynamics: JointDynamics,
    pub(crate) mimic: Option<UrdfMimic>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UrdfJointKind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Planar,
    Floating,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct UrdfLimit {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    pub(crate) velocity: Option<f64>,
}

#[derive(Debug)]
pub(crate) struct UrdfMimic {
    pub(crate) joint: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

impl Urdf {
    pub(crate) fn parse(file: &str, text: &str) -> Result<Self, RobotError> {
        let xml = Xml::parse(file, text)?;
        let root = xml.root("robot")?;
        for element in root.descendants() {
            if element.namespace().is_some_and(|namespace| namespace.contains("xacro")) {
                let reason = format!("<xacro:{}>: this is a xacro file; expand it first", element.name());
                return Err(element.fault(reason));
            }
        }
        let links = root.children("link").map(link).collect::<Result<_, _>>()?;
        let joints = root.children("joint").map(joint).collect::<Result<_, _>>()?;
        Ok(Self { name: root.attribute("name").unwrap_or_default().to_owned(), links, joints })
    }
}

fn origin(element: Element<'_>) -> Result<Origin, RobotError> {
    let Some(origin) = element.child("origin")? else { return Ok(Origin::default()) };
    let part = |key| Ok::<_, RobotError>(origin.vector(key)?.unwrap_or(DVec3::ZERO));
    Ok(Origin { xyz: part("xyz")?, rpy: part("rpy")? })
}

fn link(element: Element<'_>) -> Result<UrdfLink, RobotError> {
    let collisions = element.children("collision").map(collision).collect::<Result<_, _>>()?;
    let inertial = element.child("inertial")?.map(inertial).transpose()?;
    Ok(UrdfLink { name: element.needed("name")?.to_owned(), line: element.line(), collisions, inertial })
}

fn inertial(element: Element<'_>) -> Result<Inertial, RobotError> {
    let Origin { xyz, rpy } = origin(element)?;
    let mass = element.child("mass")?.map(|mass| mass.number("value")).transpose()?.flatten();
    let stated = element.child("inertia")?;
    let part = |key: &str| {
        let value = stated.map(|inertia| inertia.number(key)).transpose()?.flatten();
        Ok::<_, RobotError>(value.unwrap_or(0.0))
    };
    let (xy, xz, yz) = (part("ixy")?, part("ixz")?, part("iyz")?);
    let inertia = DMat3::from_cols(
        DVec3::new(part("ixx")?, xy, xz),
        DVec3::new(xy, part("iyy")?, yz),
        DVec3::new(xz, yz, part("izz")?),
    );
    Ok(Inertial { mass: mass.unwrap_or(0.0), position: xyz, rpy: rpy.to_array(), inertia })
}

fn dynamics(element: Element<'_>) -> Result<JointDynamics, RobotError> {
    let part = |key: &str| Ok::<_, RobotError>(element.number(key)?.unwrap_or(0.0));
    Ok(JointDynamics { damping: part("damping")?, friction: part("friction")? })
}

fn collision(element: Element<'_>) -> Result<UrdfCollision, RobotError> {
    let geometry =
        element.child("geometry")?.ok_or_else(|| element.fault("<collision> has no <geometry>"))?;
    let mut shapes = geometry.elements();
    let shape = shapes.next().ok_or_else(|| geometry.fault("<geometry> of <collision> is empty"))?;
    if let Some(second) = shapes.next() {
        let reason =
            format!("<{}> is a second shape in one <geometry>: each needs a <collision>", second.name());
        return Err(second.fault(reason));
    }
    Ok(UrdfCollision { line: shape.line(), origin: origin(element)?, shape: read_shape(shape)? })
}

fn read_shape(shape: Element<'_>) -> Result<UrdfShape, RobotError> {
    Ok(match shape.name() {
        "box" => {
            let size = shape.vector("size")?.ok_or_else(|| shape.fault("<box> has no size"))?;
            if size.min_element() <= 0.0 {
                let reason = format!("the size of <box> is {:?}: all have to be above zero", size.to_array());
                return Err(shape.fault(reason));
            }
            UrdfShape::Box(size)
        }
        "sphere" => UrdfShape::Sphere { radius: shape.length("radius")? },
        "cylinder" => {
            UrdfShape::Cylinder { radius: shape.length("radius")?, length: shape.length("length")? }
        }
        "capsule" => UrdfShape::Capsule { radius: shape.length("radius")?, length: shape.length("length")? },
        "mesh" => {
            let scale = shape.vector("scale")?.unwrap_or(DVec3::ONE);
            if scale.abs().min_element() == 0.0 {
                let reason = format!("the scale of <mesh> is {:?}: none may be zero", scale.to_array());
                return Err(shape.fault(reason));
            }
            UrdfShape::Mesh { file: shape.needed("filename")?.to_owned(), scale }
        }
        other => {
            let reason = format!("<{other}> is no shape: box, sphere, cylinder, capsule or mesh");
            return Err(shape.fault(reason));
        }
    })
}

fn joint(element: Element<'_>) -> Result<UrdfJoint, RobotError> {
    let name = element.needed("name")?.to_owned();
    let kind = match element.needed("type")? {
        "fixed" => UrdfJointKind::Fixed,
        "revolute" => UrdfJointKind::Revolute,
        "continuous" => UrdfJointKind::Continuous,
        "prismatic" => UrdfJointKind::Prismatic,
        "planar" => UrdfJointKind::Planar,
        "floating" => UrdfJointKind::Floating,
        other => {
            let reason = format!("joint {name:?} has the unknown type {other:?}");
            return Err(element.fault(reason));
        }
    };
    let end = |side: &'static str| {
        let missing = || element.fault(format!("joint {name:?} has no <{side}>"));
        Ok::<_, RobotError>(element.child(side)?.ok_or_else(missing)?.needed("link")?.to_owned())
    };
    let (parent, child) = (end("parent")?, end("child")?);
    let stated = element.child("axis")?.map(|axis| axis.vector("xyz")).transpose()?.flatten();
    let (axis, has_axis) = (stated.unwrap_or(DVec3::X), stated.is_some());
    // Fixed and floating joints have no axis, whatever is written there.
    if !matches!(kind, UrdfJointKind::Fixed | UrdfJointKind::Floating) && axis == DVec3::ZERO {
        return Err(element.fault(format!("joint {name:?}: the axis 0 0 0 has no direction")));
    }
    let limit = element.child("limit")?.map(limit).transpose()?;
    if let Some(UrdfLimit { lower, upper, .. }) = limit
        && lower > upper
        && matches!(kind, UrdfJointKind::Revolute | UrdfJointKind::Prismatic)
    {
        let reason = format!("joint {name:?}: the lower limit {lower:?} is above the upper one, {upper:?}");
        return Err(element.fault(reason));
    }
    let dynamics = element.child("dynamics")?.map(dynamics).transpose()?.unwrap_or_default();
    let mimic = element.child("mimic")?.map(mimic).transpose()?;
    let (line, origin) = (element.line(), origin(element)?);
    Ok(UrdfJoint { name, line, kind, parent, child, origin, axis, has_axis, limit, dynamics, mimic })
}

fn limit(element: Element<'_>) -> Result<UrdfLimit, RobotError> {
    let end = |key| Ok::<_, RobotError>(element.number(key)?.unwrap_or(0.0));
    Ok(UrdfLimit { lower: end("lower")?, upper: end("upper")?, velocity: element.number("velocity")? })
}

fn mimic(element: Element<'_>) -> Result<UrdfMimic, RobotError> {
    Ok(UrdfMimic {
        joint: element.needed("joint")?.to_owned(),
        multiplier: element.number("multiplier")?.unwrap_or(1.0),
        offset: element.number("offset")?.unwrap_or(0.0),
    })
}
