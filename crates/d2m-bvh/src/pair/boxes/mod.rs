//! A box of one body against the eight boxes of a node of the other: until when are they apart?

pub(crate) mod entry_time;
pub(crate) mod node_scale;
pub(crate) mod node_test;
pub(crate) mod whole_span;
