#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Names
//! A [`Factor`] is filled with [`Square`]s and solves for right sides. What solutions are iterated for, [`Anderson`] accelerates.
#![doc(html_root_url = "https://docs.rs/d2m-cholesky")]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod anderson;
mod elimination;
mod factor;

pub use anderson::Anderson;
pub use factor::{Factor, Square};
