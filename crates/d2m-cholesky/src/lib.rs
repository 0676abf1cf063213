#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Names
//! A [`Factor`] is filled with [`Square`]s and solves for right sides.
#![doc(html_root_url = "https://docs.rs/d2m-cholesky")]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod elimination;
mod factor;

pub use factor::{Factor, Square};
