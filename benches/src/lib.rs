//! Criterion benchmarks; each judges its answer before it is timed. Here: the scenes that several of them share.

pub mod any_motion;
pub mod hard_scenes;
