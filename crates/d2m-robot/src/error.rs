//! Why a robot, a path or a scene could not be used.

use d2m_bvh::{MeshError, QueryError};
use d2m_io::IoError;
use d2m_motion::MotionError;

/// Bad input: which file, link or joint, where in it, and the value found. One line each.
///
/// ```
/// use d2m_robot::{Robot, RobotError, RobotOptions};
/// let text = "<robot name=\"r\">\n <link name=\"a\"/>\n <joint name=\"j\" type=\"swings\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>";
/// let error = Robot::parse("arm.urdf", text, &RobotOptions::new()).unwrap_err();
/// assert!(matches!(error, RobotError::Xml { line: 3, .. }));
/// assert!(error.to_string().starts_with("arm.urdf, line 3: "));
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotError {
    /// A file cannot be read at all.
    #[error("{file}: {source}")]
    File {
        /// Its name.
        file: String,
        /// Why not.
        source: std::io::Error,
    },
    /// Something in a URDF or SRDF file is not as it should be.
    #[error("{file}, line {line}: {reason}")]
    Xml {
        /// The name of the file.
        file: String,
        /// The line, from 1.
        line: u32,
        /// What is wrong, with element, name and value.
        reason: String,
    },
    /// The robot as a whole makes no sense: no link, two roots, no geometry.
    #[error("{file}: {reason}")]
    Robot {
        /// The name of the file.
        file: String,
        /// What is wrong, with names.
        reason: String,
    },
    /// A mesh of a link cannot be read.
    #[error("{file}, line {line}: link {link:?}: {source}")]
    MeshFile {
        /// The name of the URDF file.
        file: String,
        /// The line that names the mesh.
        line: u32,
        /// The link.
        link: String,
        /// What is wrong with the mesh file.
        source: Box<IoError>,
    },
    /// A shape of a link is no usable mesh.
    #[error("{file}, line {line}: link {link:?}: {source}")]
    Shape {
        /// The name of the URDF file.
        file: String,
        /// The line of the shape.
        line: u32,
        /// The link.
        link: String,
        /// What is wrong with it.
        source: MeshError,
    },
    /// A path, edge or named joint that makes no sense.
    #[error("{place}: {reason}")]
    Path {
        /// Which point or joint of it.
        place: String,
        /// What is wrong with it, with the value.
        reason: String,
    },
    /// The motion of a joint or link.
    #[error("{0}")]
    Motion(#[from] MotionError),
    /// A body of the scene.
    #[error("{name:?}: {reason}")]
    Body {
        /// Its name.
        name: String,
        /// What is wrong with it, with the value.
        reason: String,
    },
    /// A query of two bodies is refused.
    #[error("{a:?} and {b:?}: {source}")]
    Query {
        /// The first body or link.
        a: String,
        /// The second body or link.
        b: String,
        /// Why.
        source: QueryError,
    },
}

impl RobotError {
    pub(crate) fn path(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Path { place: place.into(), reason: reason.into() }
    }
}
