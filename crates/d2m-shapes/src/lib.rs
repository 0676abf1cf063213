#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod bodies;
mod catalog;
mod error;
mod extrusion;
mod grid;
mod shape;
mod sphere;
mod surface;
mod thread;
mod trigonometry;
mod tube;
mod values;

pub use catalog::{COMMON, Parameter, SHAPES, ShapeInfo};
pub use error::ShapeError;
pub use shape::{Shape, mesh};
