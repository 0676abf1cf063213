#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod bboi;
mod first_zero;
mod gamma;
mod hrfoi;
mod inclusion_function;
mod ird;
mod isolator;
mod parabola;

pub use bboi::bboi;
pub use first_zero::{Differentiable, FirstZero, ZeroEvidence, first_zero, first_zero_of};
pub use gamma::{Gamma, IntervalFunction, RootSearch, SearchLimits, SecondOrder, Settled};
pub use hrfoi::hrfoi;
pub use inclusion_function::InclusionFunction;
pub use ird::intersect_root_domain;
pub use isolator::{
    Band, Cubic, Evidence, FirstRoot, Isolation, IsolatorOptions, Measurement, NearbyQuadratic, Piece,
    PieceTest, Quadratic, Verdict, isolate,
};
pub use parabola::Parabola;
