//! The bodies of a robot among obstacles, and the pairs of them that are checked.

use crate::RobotError;
use crate::body_box::BodyBox;
use d2m_motion::{CertifiedState, Chain, ConstantTwist, Joint, RigidMotion};
use d2m_world::{Body, BodyId};

/// A pair that is checked and may move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingPair {
    /// Places of its parts.
    pub(crate) parts: [usize; 2],
    /// At which it counts as in contact; radii of both are part of it.
    pub(crate) separation: f64,
    /// The link of the arm that both are seen from: the last that carries both. None: the world.
    pub(crate) seen_from: Option<usize>,
}

/// A body of the world.
#[derive(Clone)]
pub(crate) struct Part {
    pub(crate) id: BodyId,
    pub(crate) name: String,
    pub(crate) owner: Owner,
    /// The body is everything within this distance of its mesh.
    pub(crate) radius: f64,
    /// Of the mesh: in the frame of the link that carries it, or of the world where it is at rest; else its own.
    pub(crate) body_box: BodyBox,
}

/// What a body belongs to.
#[derive(Clone)]
pub(crate) enum Owner {
    /// A collision body of a link, in this frame of it.
    Link { link: usize, frame: Option<Joint> },
    /// Carried by a link, in this frame of it.
    Attached { link: usize, frame: Joint },
    /// Not the robot's.
    Obstacle { is_at_rest: bool },
}

impl Part {
    /// The link that carries it.
    pub(crate) fn carrier(&self) -> Option<usize> {
        match self.owner {
            Owner::Link { link, .. } | Owner::Attached { link, .. } => Some(link),
            Owner::Obstacle { .. } => None,
        }
    }
}

impl Owner {
    /// How the mesh of a body stands in the frame of what carries it.
    pub(crate) fn place_of(&self, body: &Body) -> Result<CertifiedState, RobotError> {
        Ok(match self {
            Self::Link { frame: Some(frame), .. } | Self::Attached { frame, .. } => {
                Chain::try_new(vec![frame.clone()])?.enclose_state(0.0)
            }
            Self::Obstacle { is_at_rest: true } => body.motion().enclose_state(0.0),
            Self::Link { frame: None, .. } | Self::Obstacle { is_at_rest: false } => {
                ConstantTwist::REST.enclose_state(0.0)
            }
        })
    }
}
