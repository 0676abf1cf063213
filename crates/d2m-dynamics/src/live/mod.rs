//! Changes and queries between two steps.
pub(crate) mod changes;
pub(crate) mod forces;
pub(crate) mod frozen;
pub(crate) mod joints;
pub(crate) mod membership;
pub(crate) mod rebuilt;
pub(crate) mod start;
