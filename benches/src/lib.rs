//! Criterion benchmarks; each judges its answer before it is timed.
