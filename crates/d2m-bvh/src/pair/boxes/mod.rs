//! A box of one body against the eight boxes of a node of the other: until when are they apart?

pub(crate) mod entry_time;
mod gap_and_rate;
pub(crate) mod node_scale;
pub(crate) mod node_test;
mod passing;
pub(crate) mod whole_span;
