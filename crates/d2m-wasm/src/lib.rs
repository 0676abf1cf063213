#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod boundary;
mod clock;
mod mesh;
mod options;
mod pose;
mod query;

pub use boundary::{clearance, contact_spans, distance, shapes, time_of_contact};
pub use mesh::Mesh;
