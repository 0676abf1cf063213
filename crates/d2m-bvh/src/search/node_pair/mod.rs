//! A box of one body against the eight boxes of a node of the other: until when are they apart?

mod discriminant;
pub(crate) mod entry_time;
pub(crate) mod expansion;
pub(crate) mod node_scale;
pub(crate) mod node_test;
pub(crate) mod whole_span;
