//! What a URDF file states of masses and of what brakes joints.

use glam::{DMat3, DVec3};

/// The `<inertial>` of a link.
///
/// ```
/// use d2m_robot::{Robot, RobotOptions};
/// let text = r#"<robot name="stone"><link name="stone">
///   <inertial><origin xyz="0 0 0.1"/><mass value="2.5"/><inertia ixx="0.1" iyy="0.2" izz="0.15" ixy="0.01"/></inertial>
///   <collision><geometry><sphere radius="0.2"/></geometry></collision></link></robot>"#;
/// let robot = Robot::parse("stone.urdf", text, &RobotOptions::new())?;
/// let inertial = robot.inertial(0).expect("the file states it");
/// assert_eq!((inertial.mass, inertial.position.z, inertial.inertia.x_axis.y), (2.5, 0.1, 0.01));
/// # Ok::<(), d2m_robot::RobotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Inertial {
    /// As stated: it is no mass for certain.
    pub mass: f64,
    /// The center of mass, link frame.
    pub position: DVec3,
    /// Roll, pitch, yaw of the axes of the inertia, link frame.
    pub rpy: [f64; 3],
    /// About the center of mass, in those axes.
    pub inertia: DMat3,
}

/// The `<dynamics>` of a joint: zero where the file states none.
///
/// ```
/// assert_eq!(d2m_robot::JointDynamics::default().friction, 0.0);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct JointDynamics {
    /// Torque by angular velocity, or force by velocity.
    pub damping: f64,
    /// Torque or force of dry friction.
    pub friction: f64,
}
