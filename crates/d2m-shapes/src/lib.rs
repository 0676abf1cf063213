#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`mesh()`] makes a mesh of a text such as `gear?teeth=24`.
//!
//! ## Shapes
//! - [`Shape`]: a shape with its parameters, not yet built.
//! - [`SHAPES`]: all of them, each a [`ShapeInfo`] with its [`Parameter`]s; [`COMMON`]: the parameters of
//!   all.
//!
//! ## Round bodies
//! [`Tessellation`]: cylinders, cones and half-spaces as meshes that enclose them or lie within them ([`Fit`]), and by how much. (Spheres,
//! capsules and rounded boxes are exact: points, segments and boxes with a radius.)
//!
//! ## Errors
//! [`ShapeError`]: no such shape or parameter, or a value out of range.
#![doc(html_root_url = "https://docs.rs/d2m-shapes")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod bodies;
mod catalog;
mod error;
mod extrusion;
mod grid;
mod shape;
mod sphere;
mod surface;
mod tessellation;
mod thread;
mod trigonometry;
mod tube;
mod values;

pub use catalog::{COMMON, Parameter, SHAPES, ShapeInfo};
pub use error::ShapeError;
pub use shape::{Shape, mesh};
pub use tessellation::{Fit, Tessellation};
