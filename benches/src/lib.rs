//! Criterion benchmarks; each judges its answer before it is timed. Here: what several of them share.

pub mod any_motion;
pub mod hard_scenes;
mod processor_time;

pub use processor_time::processor_time;
