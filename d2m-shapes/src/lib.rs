//! Procedural watertight triangle meshes: box, icosphere, torus, torus knot, gear, screw and nut, and more.
//!
//! Every shape is closed, a manifold, oriented outwards, free of self-overlap, and the same to the last bit on every
//! platform (its trigonometry is the project's own). A shape is named by a line of text, which the command line also
//! takes:
//!
//! ```
//! let knot = d2m_shapes::mesh("torus-knot?triangles=70000&tube=0.3")?;
//! assert!(knot.triangle_count().abs_diff(70_000) < 700);
//!
//! let message = d2m_shapes::mesh("torus-knot?triangles=70k").unwrap_err().to_string();
//! assert_eq!(message, "shape torus-knot: triangles=70k is not a number");
//! # Ok::<(), d2m_shapes::ShapeError>(())
//! ```
//!
//! [`SHAPES`] lists names, parameters, defaults and ranges; every shape also takes a `scale`.
//!
//! **Invariant.** This crate knows meshes but no motions, trees or queries.

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
