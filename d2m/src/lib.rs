//! Certified continuous collision detection of rigid bodies.
pub use d2m_bvh as bvh;
pub use d2m_feature as feature;
pub use d2m_interval as interval;
pub use d2m_motion as motion;
pub use d2m_root as root;
pub use d2m_shapes as shapes;
