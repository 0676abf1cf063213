#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`first_zero_of`] finds the first zero of a closure and its derivative, with a proof.
//!
//! ## Any function with a derivative
//! [`first_zero()`] takes a [`Differentiable`] function and [`SearchLimits`], and answers with a
//! [`FirstZero`], whose [`ZeroEvidence`] says what is proven of the zero.
//!
//! ## Functions with two derivatives
//! - [`InclusionFunction`]: all that is known of a function over one piece of time, [`intersect_root_domain`]
//!   what that leaves of the piece; [`Parabola`] is its lower or upper bound.
//! - [`bboi()`] and [`hrfoi()`]: the first root of an [`IntervalFunction`] or a [`SecondOrder`] function for
//!   which [`Gamma`] holds ([`Settled`]); they answer with a [`RootSearch`].
//!
//! ## The isolator behind the feature tests
//! - [`isolate`] asks a [`PieceTest`] about each [`Piece`] of time ([`Verdict`], [`Measurement`]) until an
//!   [`Isolation`] is known: its [`FirstRoot`] with [`Evidence`]. [`IsolatorOptions`] limits it.
//! - [`Quadratic`], [`Cubic`] and [`NearbyQuadratic`] bound the first entry into a [`Band`] from the safe
//!   side.
#![doc(html_root_url = "https://docs.rs/d2m-root")]
#![cfg_attr(docsrs, feature(doc_cfg))]
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
