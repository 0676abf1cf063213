use crate::{Moving, QueryError, Window};
use d2m_motion::CoveredMotion;

/// Two moving bodies and a window that both motions cover: what every query of moving bodies begins with, so that none can
/// go past a motion's times.
#[derive(Clone, Copy)]
pub(crate) struct CoveredPair<'a> {
    bodies: [Moving<'a>; 2],
    window: Window,
}

impl<'a> CoveredPair<'a> {
    /// The two bodies over a window.
    ///
    /// # Errors
    /// [`QueryError::OutsideMotion`].
    pub(crate) fn try_new(bodies: [Moving<'a>; 2], window: Window) -> Result<Self, QueryError> {
        for (body, moving) in bodies.iter().enumerate() {
            let covered = CoveredMotion::try_new(moving.motion, window.start(), window.end());
            if let Err(outside) = covered {
                return Err(QueryError::OutsideMotion { body, outside });
            }
        }
        Ok(Self { bodies, window })
    }

    /// The bodies.
    pub(crate) const fn bodies(&self) -> &[Moving<'a>; 2] {
        &self.bodies
    }

    /// The window.
    pub(crate) const fn window(&self) -> Window {
        self.window
    }
}
