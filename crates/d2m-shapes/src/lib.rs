#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod bodies;
mod catalog;
mod error;
mod extrusion;
mod grid;
mod sphere;
mod surface;
mod thread;
mod trigonometry;
mod tube;

pub use catalog::{COMMON, Parameter, SHAPES, Shape, ShapeInfo, mesh};
pub use error::ShapeError;
